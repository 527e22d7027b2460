"""Declarations of the arguments of commands; this module imports no large library."""

from argparse import ArgumentTypeError
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, Final

PICTURES: Final = "a picture, in the format of its ending: .png, .svg or .pdf"


@dataclass(frozen=True)
class CommandArgument:
    """One argument of a command."""

    names: tuple[str, ...]  # as typed
    settings: dict[str, Any]  # further arguments of :meth:`argparse.ArgumentParser.add_argument`
    of_files: bool = False  # whether it names a file

    @property
    def attribute(self) -> str:
        """Name of its value among the arguments as they are parsed."""
        return self.names[-1].removeprefix("--").replace("-", "_")


@dataclass(frozen=True)
class Command:
    """One command."""

    name: str  # as typed, and of the module that runs it
    words: str  # what it does, in one line
    story: str  # what it does, in its help
    examples: str  # lines to copy
    arguments: Sequence[CommandArgument]


def path(*names: str, **settings: Any) -> CommandArgument:
    """Declare an argument that names a file."""
    return CommandArgument(names, settings, of_files=True)


def word(*names: str, **settings: Any) -> CommandArgument:
    """Declare any other argument."""
    return CommandArgument(names, settings)


def number_option(name: str, metavar: str, words: str) -> CommandArgument:
    """Declare an option that is a number."""
    return word(name, type=_reads(float, "a number such as 1.5"), metavar=metavar, help=words)


def whole_option(name: str, words: str, usual: int | None = None) -> CommandArgument:
    """Declare an option that is a whole number."""
    read = _reads(int, "a whole number such as 100")
    return word(name, type=read, metavar="N", help=words, default=usual)


def _reads(kind: type[float], expected: str) -> Callable[[str], float]:
    """Return a function that reads an argument that is a number."""

    def read(typed: str) -> float:
        try:
            return kind(typed)
        except ValueError:
            words = f"expected {expected}, got {typed!r}"
            raise ArgumentTypeError(words) from None

    return read


EVERYWHERE: Final = (
    word(
        "-q",
        "--quiet",
        action="store_true",
        help="print the answer only, without warnings and progress",
    ),
    word("-v", "--verbose", action="store_true", help="print all numbers of the answer too"),
    word("--json", action="store_true", help="print the answer as JSON, for programs"),
    word("--debug", action="store_true", help="show the whole traceback of an error"),
)
"""Options of all commands, before or after the name of the command."""
SCENE: Final = path(
    "scene", metavar="scene.toml", help="the scene; 'template' writes one; - for standard input"
)
DATASET: Final = path(
    "dataset", metavar="out.nc", help="a result that another command wrote with -o; or -"
)
OVERWRITE: Final = word(
    "--overwrite",
    action="store_true",
    help="replace existing files, also those that rockframe did not write; never a file that is "
    "read",
)
UNITS: Final = word(
    "--units",
    nargs="+",
    metavar="NAME=UNIT",
    help="units of all numbers, such as force=kN angle=deg acceleration=g_0",
)
RESULT: Final = path(
    "-o", "--output", metavar="out.nc", help="write all results to this file; - for standard output"
)
PICTURE: Final = path("--picture", metavar="x.png", help=f"write {PICTURES}")
FROM_FILES: Final = (
    word("--unit", help="unit of the samples, such as g or cm/s^2, where the file has none"),
    word(
        "--time-step", metavar="TIME", help="time step of samples without times, such as '0.01 s'"
    ),
)
READING: Final = (
    word("--component", metavar="NAME", help="component of a record that has several, such as NS"),
    *FROM_FILES,
)
ACCURACY: Final = word(
    "--accuracy",
    metavar="LEVEL",
    help="fast, standard, reference, or a tolerance such as 1e-6; for fragility, ida and map also "
    "screen",
)
LENGTH: Final = (
    word(
        "--free-vibration",
        metavar="TIME",
        help="time after the motion with the ground at rest, such as '20 s'",
    ),
    word("--duration", metavar="TIME", help="duration of the run, independent of the motion's"),
)
RUNNING: Final = (
    path("-m", "--motion", metavar="FILE", help="a record, instead of the motion of the scene"),
    *READING,
    number_option("--scale", "FACTOR", "multiply the motion by this"),
    ACCURACY,
    *LENGTH,
)
INTENSITY: Final = (
    word(
        "--intensity",
        metavar="MEASURE",
        help="intensity measure of the motion: PGA, PGV, PGD, CAV, SA (with --period) or a name "
        "that 'motion' lists (default: PGA)",
    ),
    word("--period", metavar="TIME", help="period of the oscillator of SA, such as '0.5 s'"),
)
STORE: Final = path(
    "--store", metavar="FOLDER", help="keep finished cases in this folder, and reuse them"
)
OVER_MOTIONS: Final = (
    path("scene", metavar="scene.toml", help="a scene, or a study with motions and axes; or -"),
    path("records", nargs="*", metavar="RECORD", help="records, archives or folders"),
    *FROM_FILES,
    word(
        "--scales",
        metavar="VALUES",
        help="scale factors of the motions, such as 0.5,1,2, or from:to:step, such as 0.25:4:0.25",
    ),
    *INTENSITY,
    word(
        "--limits",
        metavar="STATES",
        help="limit states besides overturning: uplift, a rotation divided by the overturning "
        "angle, or a variable of runs, such as uplift,0.5,'peak_slip=5 cm'",
    ),
    ACCURACY,
    *LENGTH,
    STORE,
    RESULT,
    PICTURE,
)
"""Arguments of analyses of one scene under many motions."""
