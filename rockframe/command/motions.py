"""``rockframe motion`` and ``convert``: contents of files of motions, and other formats."""

import argparse
import re
from collections.abc import Mapping
from pathlib import Path
from typing import Final

from rockframe.command.answer import Answer, format_table
from rockframe.command.figures import PICTURE_KIND, save_figure
from rockframe.command.shared import Outputs, dataset_kind, motion_summary, motions_from, table_kind
from rockframe.command.streams import STREAM
from rockframe.errors import FileError, RockframeWarning, warn
from rockframe.measures import intensity_measures
from rockframe.motion import GroundMotion
from rockframe.motion.operations.writing import AT2_KIND
from rockframe.plot import motion as draw
from rockframe.plot._fonts import warn_of_letters_once
from rockframe.results.table import table
from rockframe.suites import MotionSuite
from rockframe.units import Unit

_METADATA_LABELS: Final = (
    # (key of the metadata, label)
    ("event", "event"),
    ("station", "station"),
    ("component", "component"),
    ("format", "format"),
    ("unit_as_read", "unit"),
)
_MEASURES_KIND: Final = table_kind(
    "a table of measures", "motion", "peak_ground_acceleration", "arias_intensity"
)
_MAX_PRINTED: Final = 10
"""Largest number of motions that are printed in full; of more only a table is printed."""


@warn_of_letters_once
def execute_motion(arguments: argparse.Namespace, answer: Answer) -> int:
    """Print the contents of files."""
    outputs = Outputs(arguments, arguments.files, answer, csv=_MEASURES_KIND)
    motions = motions_from(arguments)
    pictures = _picture_paths(arguments.picture, len(motions))
    for path in pictures:
        outputs.check(path, PICTURE_KIND)
    measures = intensity_measures(motions)
    values = table(measures)
    if len(motions) <= _MAX_PRINTED:
        for name, motion in motions.items():
            answer.add_text(f"{name}\n  {motion_summary(motion)}")
            for key, words in _METADATA_LABELS:
                if motion.metadata.get(key):
                    answer.add_text(f"  {words}: {motion.metadata[key]}")
            for head, value in values.loc[name].items():
                answer.add_text(f"  {str(head).replace('_', ' '):<52} {value:.4g}")
    else:
        answer.add_text(format_table(values))
    answer.add_numbers(measures)
    outputs.write_table(values)
    for path, motion in zip(pictures, motions.values(), strict=bool(pictures)):
        save_figure(draw(motion), path, outputs)
    return 0


def _picture_paths(picture: str | None, count: int) -> list[Path]:
    """Return the names of pictures, numbered if there are several."""
    if picture is None:
        return []
    path = Path(picture)
    if picture == STREAM and count > 1:
        words = f"{count} pictures do not fit into it; name one motion, or a file ending in .png"
        raise FileError(STREAM, words)
    if count == 1 or not path.name:
        return [path]
    return [path.with_stem(f"{path.stem}-{number}") for number in range(1, count + 1)]


_ENDINGS: Final = {"at2": ".AT2", "csv": ".csv", "nc": ".nc"}
_MOTION_TABLE_KIND: Final = table_kind(
    "a motion as a table",
    also=(f"time [{Unit.SECOND}]", f"acceleration [{Unit.METRE_PER_SECOND_SQUARED}]"),
)
_NETCDF_KIND: Final = dataset_kind(
    "a motion or a set of motions",
    lambda dataset: "motion_sha256" in {*dataset.attrs, *dataset.variables},
)
_KINDS: Final = {"at2": AT2_KIND, "csv": _MOTION_TABLE_KIND, "nc": _NETCDF_KIND}
_UNSAFE_CHARACTERS: Final = re.compile(r"[^\w.+-]+")
_MAX_LISTED: Final = 8


def execute_convert(arguments: argparse.Namespace, answer: Answer) -> int:
    """Read records, and write them."""
    outputs = Outputs(arguments, arguments.files, answer)
    target = Path(arguments.output).expanduser()
    file_format = arguments.to or _format_from_ending(arguments.output)
    into_folder = arguments.output != STREAM and (
        target.is_dir() or target.suffix.lower() not in map(str.lower, _ENDINGS.values())
    )
    if not into_folder:
        outputs.check(arguments.output, _KINDS[file_format])
    motions = motions_from(arguments)
    if into_folder:
        _make_folder(target, arguments.output)
        for name, path in _file_names(motions, target, _ENDINGS[file_format]).items():
            _write(motions[name], file_format, path, outputs, arguments)
    elif file_format == "nc" and len(motions) > 1:
        suite = motions if isinstance(motions, MotionSuite) else MotionSuite(motions)
        outputs.write(arguments.output, _NETCDF_KIND, "Motions", suite.to_dataset().to_netcdf)
    elif len(motions) > 1:
        words = (
            f"{len(motions)} motions do not fit into one file of this format: "
            f"{_motion_list(motions)}; name one with --component, or a folder with --to, or a file "
            "ending in .nc"
        )
        raise FileError(arguments.output, words)
    else:
        (motion,) = motions.values()
        _write(motion, file_format, arguments.output, outputs, arguments)
    answer.add_context("Motions", _motion_list(motions))
    return 0


def _format_from_ending(output: str) -> str:
    """Return the format by the ending of a file."""
    ending = Path(output).suffix.lower()
    chosen = next((form for form, suffix in _ENDINGS.items() if suffix.lower() == ending), None)
    if chosen is None:
        known = ", ".join(_ENDINGS.values())
        words = (
            f"the ending gives no format; expected {known}, or a folder and a format such as "
            "--to at2"
        )
        raise FileError(output, words)
    return chosen


def _make_folder(folder: Path, named: str) -> None:
    try:
        folder.mkdir(exist_ok=True)
    except OSError as problem:
        words = f"this folder cannot be made ({problem.strerror})"
        raise FileError(named, words) from problem


def _file_names(motions: Mapping[str, GroundMotion], folder: Path, ending: str) -> dict[str, Path]:
    """Give each motion a path of its own."""
    paths: dict[str, Path] = {}
    for name in motions:
        stem = _UNSAFE_CHARACTERS.sub("_", name).strip("._") or "motion"
        taken = {path.stem.casefold() for path in paths.values()}
        number = 1
        unique = stem
        while unique.casefold() in taken:
            number += 1
            unique = f"{stem}_{number}"
        paths[name] = folder / f"{unique}{ending}"
    return paths


def _motion_list(motions: Mapping[str, GroundMotion]) -> str:
    more = "" if len(motions) <= _MAX_LISTED else f" and {len(motions) - _MAX_LISTED} more"
    return f"{', '.join(list(motions)[:_MAX_LISTED])}{more}"


def _write(
    motion: GroundMotion,
    file_format: str,
    path: str | Path,
    outputs: Outputs,
    arguments: argparse.Namespace,
) -> None:
    """Write one motion."""
    if file_format == "nc":
        outputs.write(path, _NETCDF_KIND, "Motion", motion.to_dataset().to_netcdf)
    elif file_format == "csv":
        values = table(motion.to_dataset(), "histories")
        outputs.write(path, _MOTION_TABLE_KIND, "Motion", lambda part: values.to_csv(part))
    else:
        if motion.si.vertical is not None:
            words = "the vertical component is left out; a file ending in .nc or .csv has it"
            warn(f"{path}: {words}", RockframeWarning)
        outputs.save_by(
            path, AT2_KIND, _ENDINGS[file_format], "Motion",
            lambda place: motion.to_at2(place, overwrite=arguments.overwrite),
        )  # fmt: skip
