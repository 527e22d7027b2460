"""``rockframe motion``: the contents of files of ground motions."""

import argparse
from pathlib import Path
from typing import Final

from rockframe.command.answer import Answer, format_table
from rockframe.command.plot import PICTURE_KIND, save_figure
from rockframe.command.shared import Outputs, motions_from, table_kind
from rockframe.constants import STANDARD_GRAVITY
from rockframe.measures import intensity_measures
from rockframe.motion import GroundMotion
from rockframe.plot import motion as draw
from rockframe.plot._fonts import warn_of_letters_once
from rockframe.results.table import table

_METADATA_LABELS: Final = (
    # (key of the metadata, label)
    ("event", "event"),
    ("station", "station"),
    ("component", "component"),
    ("format", "format"),
    ("unit_as_read", "unit"),
)
_TABLE_KIND: Final = table_kind(
    "a table of measures", "motion", "peak_ground_acceleration", "arias_intensity"
)
_MAX_PRINTED: Final = 10
"""Largest number of motions that are printed in full; of more only a table is printed."""


@warn_of_letters_once
def execute(arguments: argparse.Namespace, answer: Answer) -> int:
    """Print the contents of files."""
    outputs = Outputs(arguments, arguments.files, answer, csv=_TABLE_KIND)
    motions = motions_from(arguments)
    pictures = _picture_paths(arguments.picture, len(motions))
    for path in pictures:
        outputs.check(path, PICTURE_KIND)
    measures = intensity_measures(motions)
    values = table(measures)
    if len(motions) <= _MAX_PRINTED:
        for name, motion in motions.items():
            answer.add_text("\n".join(_motion_lines(name, motion)))
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
    if count == 1 or not path.name:
        return [path]
    return [path.with_stem(f"{path.stem}-{number}") for number in range(1, count + 1)]


def motion_summary(motion: GroundMotion) -> str:
    """Write the number of samples, the time step, the length and the peak of a motion."""
    peak = motion.peak_acceleration.to("m/s^2").magnitude
    return (
        f"{len(motion)} samples at {motion.si.time_step:g} s, {motion.si.duration:g} s long, "
        f"peak {peak:.4g} m/s^2 ({peak / STANDARD_GRAVITY:.3g} g)"
    )


def _motion_lines(name: str, motion: GroundMotion) -> list[str]:
    lines = [name, f"  {motion_summary(motion)}"]
    metadata = motion.metadata
    lines += [f"  {words}: {metadata[key]}" for key, words in _METADATA_LABELS if metadata.get(key)]
    return lines
