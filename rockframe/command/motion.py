"""``rockframe motion``: what is in files of ground motions."""

import argparse
from collections.abc import Mapping
from pathlib import Path
from typing import Final

from rockframe.command.given import check_folder, motion_from, printed
from rockframe.command.plot import save
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
_MOST_SHOWN: Final = 10
"""Motions of which all is told; of more there is only the table."""


def execute(arguments: argparse.Namespace) -> int:
    """Tell what files hold."""
    check_folder(arguments.picture)
    check_folder(arguments.csv)
    motions = _read(arguments)
    measures = intensity_measures(motions)
    values = table(measures)
    if len(motions) <= _MOST_SHOWN:
        for name, motion in motions.items():
            print("\n".join(_told(name, motion)))
            for head, value in values.loc[name].items():
                print(f"  {str(head).replace('_', ' '):<52} {value:.4g}")
    else:
        print(printed(values))
    if arguments.csv is not None:
        values.to_csv(Path(arguments.csv).expanduser())
        print(f"Table: {arguments.csv}")
    if arguments.picture is not None:
        for number, motion in enumerate(motions.values(), 1):
            path = Path(arguments.picture)
            numbered = path.with_stem(f"{path.stem}-{number}") if len(motions) > 1 else path
            save(figure_of(draw(motion)), numbered)
    return 0


def _read(arguments: argparse.Namespace) -> Mapping[str, GroundMotion]:
    """Read one component where one is named, else all that there are."""
    if arguments.component is not None:
        found = [motion_from(path, arguments) for path in arguments.files]
        return {f"{number}: {one.name}": one for number, one in enumerate(found, 1)}
    suite = read_suite(arguments.files, unit=arguments.unit, time_step=arguments.time_step)
    return dict(suite.items())


def _told(name: str, motion: GroundMotion) -> list[str]:
    peak = motion.peak_acceleration.to("m/s^2").magnitude
    lines = [
        name,
        f"  {len(motion)} samples at {motion.si.time_step:g} s, {motion.si.duration:g} s long, "
        f"peak {peak:.4g} m/s^2 ({peak / STANDARD_GRAVITY:.3g} g)",
    ]
    metadata = motion.metadata
    lines += [f"  {words}: {metadata[key]}" for key, words in _ABOUT if metadata.get(key)]
    return lines
