"""``rockframe motion``: what is in files of ground motions."""

import argparse
from collections.abc import Mapping
from pathlib import Path
from typing import Final

from rockframe.command.plot import PICTURE, save
from rockframe.command.shared import Outputs, motion_from, printed, table_kind
from rockframe.constants import STANDARD_GRAVITY
from rockframe.measures import intensity_measures
from rockframe.motion import GroundMotion
from rockframe.plot import motion as draw
from rockframe.reports.figures import figure_of
from rockframe.results.table import table
from rockframe.suites import read_suite

_ABOUT: Final = (
    # (in the metadata, in words)
    ("event", "event"),
    ("station", "station"),
    ("component", "component"),
    ("format", "format"),
    ("unit_as_read", "unit"),
)
_TABLE: Final = table_kind(
    "a table of measures", "motion", "peak_ground_acceleration", "arias_intensity"
)
_MOST_SHOWN: Final = 10
"""Motions of which all is told; of more there is only the table."""


def execute(arguments: argparse.Namespace) -> int:
    """Tell what files hold."""
    outputs = Outputs(arguments, arguments.files)
    outputs.check(arguments.csv, _TABLE)
    motions = _read(arguments)
    pictures = _numbered(arguments.picture, len(motions))
    for path in pictures:
        outputs.check(path, PICTURE)
    measures = intensity_measures(motions)
    values = table(measures)
    if len(motions) <= _MOST_SHOWN:
        for name, motion in motions.items():
            print("\n".join(_motion_lines(name, motion)))
            for head, value in values.loc[name].items():
                print(f"  {str(head).replace('_', ' '):<52} {value:.4g}")
    else:
        print(printed(values))
    outputs.table(arguments.csv, _TABLE, values)
    for path, motion in zip(pictures, motions.values(), strict=bool(pictures)):
        save(figure_of(draw(motion)), path, outputs)
    return 0


def _numbered(picture: str | None, count: int) -> list[Path]:
    """Give the names of pictures, with numbers where there are several."""
    if picture is None:
        return []
    path = Path(picture)
    if count == 1 or not path.name:
        return [path]
    return [path.with_stem(f"{path.stem}-{number}") for number in range(1, count + 1)]


def _read(arguments: argparse.Namespace) -> Mapping[str, GroundMotion]:
    """Read one component where one is named, else all that there are."""
    if arguments.component is not None:
        found = [motion_from(path, arguments) for path in arguments.files]
        return {f"{number}: {one.name}": one for number, one in enumerate(found, 1)}
    suite = read_suite(arguments.files, unit=arguments.unit, time_step=arguments.time_step)
    return dict(suite.items())


def _motion_lines(name: str, motion: GroundMotion) -> list[str]:
    peak = motion.peak_acceleration.to("m/s^2").magnitude
    lines = [
        name,
        f"  {len(motion)} samples at {motion.si.time_step:g} s, {motion.si.duration:g} s long, "
        f"peak {peak:.4g} m/s^2 ({peak / STANDARD_GRAVITY:.3g} g)",
    ]
    metadata = motion.metadata
    lines += [f"  {words}: {metadata[key]}" for key, words in _ABOUT if metadata.get(key)]
    return lines
