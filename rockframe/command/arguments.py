"""Declarations of the arguments of commands; this module imports no large library."""

from argparse import ArgumentTypeError
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any, Final

PICTURE_HELP: Final = "a picture, in the format of its ending: .png, .svg or .pdf"


class CommandArgument:
    """One argument of a command; its settings are those of ``add_argument`` of argparse."""

    def __init__(self, *names: str, is_file: bool = False, **settings: Any) -> None:
        self.names, self.is_file, self.settings = names, is_file, settings
        self.name = names[-1]  # its long name, as typed
        self.attribute = self.name.removeprefix("--").replace("-", "_")  # once it is parsed


argument: Final = CommandArgument
file_argument: Final = partial(CommandArgument, is_file=True)


@dataclass(frozen=True)
class Command:
    """One command."""

    name: str  # as typed
    module: str  # which runs it, by its function ``execute_`` and the name
    summary: str  # what it does, in one line
    description: str  # what it does, in its help
    examples: str  # lines to copy
    arguments: Sequence[CommandArgument]


def number_option(name: str, metavar: str, words: str) -> CommandArgument:
    """Declare an option that is a number."""
    return argument(
        name, type=_number_reader(float, "a number such as 1.5"), metavar=metavar, help=words
    )


def integer_option(name: str, words: str, default: int | None = None) -> CommandArgument:
    """Declare an option that is a whole number."""
    read = _number_reader(int, "a whole number such as 100")
    return argument(name, type=read, metavar="N", help=words, default=default)


def _number_reader(kind: type[float], expected: str) -> Callable[[str], float]:
    """Return a function that reads an argument that is a number."""

    def read(typed: str) -> float:
        try:
            return kind(typed)
        except ValueError:
            words = f"expected {expected}, got {typed!r}"
            raise ArgumentTypeError(words) from None

    return read


COMMON_OPTIONS: Final = (
    argument(
        "-q",
        "--quiet",
        action="store_true",
        help="print the answer only, without warnings and progress",
    ),
    argument("-v", "--verbose", action="store_true", help="print all numbers of the answer too"),
    argument("--json", action="store_true", help="print the answer as JSON, for programs"),
    argument("--debug", action="store_true", help="show the whole traceback of an error"),
)
"""Options of all commands, before or after the name of the command."""
SCENE_FILE: Final = file_argument(
    "scene", metavar="scene.toml", help="the scene; 'template' writes one; - for standard input"
)
RESULT_FILE: Final = file_argument(
    "dataset", metavar="out.nc", help="a result that another command wrote with -o; or -"
)
MOTION_FILES: Final = file_argument(
    "files", nargs="+", metavar="FILE", help="records, archives or folders; or -"
)
OVERWRITE_OPTION: Final = argument(
    "--overwrite",
    action="store_true",
    help="replace existing files, also those that rockframe did not write; never a file that is "
    "read",
)
UNITS_OPTION: Final = argument(
    "--units",
    nargs="+",
    metavar="NAME=UNIT",
    help="units of all numbers, such as force=kN angle=deg acceleration=g_0",
)
OUTPUT_OPTION: Final = file_argument(
    "-o", "--output", metavar="out.nc", help="write all results to this file; - for standard output"
)
PICTURE_OPTION: Final = file_argument("--picture", metavar="x.png", help=f"write {PICTURE_HELP}")
SAMPLE_OPTIONS: Final = (
    argument("--unit", help="unit of the samples, such as g or cm/s^2, where the file has none"),
    argument(
        "--time-step", metavar="TIME", help="time step of samples without times, such as '0.01 s'"
    ),
)
READING_OPTIONS: Final = (
    argument(
        "--component", metavar="NAME", help="component of a record that has several, such as NS"
    ),
    *SAMPLE_OPTIONS,
)
ACCURACY_OPTION, SWEEP_ACCURACY_OPTION = (
    argument(
        "--accuracy",
        metavar="LEVEL",
        help=f"fast, standard, reference{further}, or a tolerance such as 1e-6",
    )
    for further in ("", ", screen")
)
DURATION_OPTIONS: Final = (
    argument(
        "--free-vibration",
        metavar="TIME",
        help="time after the motion with the ground at rest, such as '20 s'",
    ),
    argument("--duration", metavar="TIME", help="duration of the run, independent of the motion's"),
)
RUN_OPTIONS: Final = (
    file_argument(
        "-m", "--motion", metavar="FILE", help="a record, instead of the motion of the scene"
    ),
    *READING_OPTIONS,
    number_option("--scale", "FACTOR", "multiply the motion by this"),
    ACCURACY_OPTION,
    *DURATION_OPTIONS,
)
INTENSITY_OPTIONS: Final = (
    argument(
        "--intensity",
        metavar="MEASURE",
        help="intensity measure of the motion: PGA, PGV, PGD, CAV, SA (with --period) or a name "
        "that 'motion' lists (default: PGA)",
    ),
    argument("--period", metavar="TIME", help="period of the oscillator of SA, such as '0.5 s'"),
)
STORE_OPTION: Final = file_argument(
    "--store", metavar="FOLDER", help="keep finished cases in this folder, and reuse them"
)
ANALYSIS_ARGUMENTS: Final = (
    file_argument(
        "scene", metavar="scene.toml", help="a scene, or a study with motions and axes; or -"
    ),
    file_argument("records", nargs="*", metavar="RECORD", help="records, archives or folders"),
    *SAMPLE_OPTIONS,
    argument(
        "--scales",
        metavar="VALUES",
        help="scale factors of the motions, such as 0.5,1,2, or from:to:step, such as 0.25:4:0.25",
    ),
    *INTENSITY_OPTIONS,
    argument(
        "--limits",
        metavar="STATES",
        help="limit states besides overturning: uplift, a rotation divided by the overturning "
        "angle, or a variable of runs, such as uplift,0.5,'peak_slip=5 cm'",
    ),
    SWEEP_ACCURACY_OPTION,
    *DURATION_OPTIONS,
    STORE_OPTION,
    OUTPUT_OPTION,
    PICTURE_OPTION,
)
"""Arguments of analyses of one scene under many motions."""
