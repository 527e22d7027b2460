"""``rockframe motion``: the contents of files of ground motions."""

import argparse
from pathlib import Path
from typing import Final

from rockframe.command.answer import Answer, printed
from rockframe.command.plot import PICTURE, save
from rockframe.command.shared import Outputs, motions_from, table_kind
from rockframe.constants import STANDARD_GRAVITY
from rockframe.measures import intensity_measures
from rockframe.motion import GroundMotion
from rockframe.plot import motion as draw
from rockframe.plot._fonts import warning_once
from rockframe.results.table import table

_ABOUT: Final = (
    # (key of the metadata, label)
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
"""Largest number of motions that are printed in full; of more only a table is printed."""


@warning_once
def execute(arguments: argparse.Namespace, answer: Answer) -> int:
    """Print the contents of files."""
    outputs = Outputs(arguments, arguments.files, answer, csv=_TABLE)
    motions = motions_from(arguments)
    pictures = _numbered(arguments.picture, len(motions))
    for path in pictures:
        outputs.check(path, PICTURE)
    measures = intensity_measures(motions)
    values = table(measures)
    if len(motions) <= _MOST_SHOWN:
        for name, motion in motions.items():
            answer.text("\n".join(_motion_lines(name, motion)))
            for head, value in values.loc[name].items():
                answer.text(f"  {str(head).replace('_', ' '):<52} {value:.4g}")
    else:
        answer.text(printed(values))
    answer.numbers(measures)
    outputs.table(values)
    for path, motion in zip(pictures, motions.values(), strict=bool(pictures)):
        save(draw(motion), path, outputs)
    return 0


def _numbered(picture: str | None, count: int) -> list[Path]:
    """Return the names of pictures, numbered if there are several."""
    if picture is None:
        return []
    path = Path(picture)
    if count == 1 or not path.name:
        return [path]
    return [path.with_stem(f"{path.stem}-{number}") for number in range(1, count + 1)]


def words_of_motion(motion: GroundMotion) -> str:
    """Write the number of samples, the time step, the length and the peak of a motion."""
    peak = motion.peak_acceleration.to("m/s^2").magnitude
    return (
        f"{len(motion)} samples at {motion.si.time_step:g} s, {motion.si.duration:g} s long, "
        f"peak {peak:.4g} m/s^2 ({peak / STANDARD_GRAVITY:.3g} g)"
    )


def _motion_lines(name: str, motion: GroundMotion) -> list[str]:
    lines = [name, f"  {words_of_motion(motion)}"]
    metadata = motion.metadata
    lines += [f"  {words}: {metadata[key]}" for key, words in _ABOUT if metadata.get(key)]
    return lines
