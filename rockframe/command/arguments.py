"""What commands take, as they are declared; nothing here loads a library."""

from argparse import ArgumentTypeError
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Final

PICTURES: Final = "a picture; its ending tells the format: .png, .svg, .pdf"


@dataclass(frozen=True)
class CommandArgument:
    """One argument of a command."""

    names: tuple[str, ...]  # as it is typed
    settings: dict[str, Any]  # as :meth:`argparse.ArgumentParser.add_argument` takes them
    of_files: bool = False  # whether it names a file


@dataclass(frozen=True)
class Command:
    """One command."""

    name: str  # as it is typed; the module of that name carries it out
    words: str  # what it does, in a line
    story: str  # what it does, for those who ask for help
    examples: str  # lines to copy
    arguments: Sequence[CommandArgument]  # what it takes


def path(*names: str, **settings: Any) -> CommandArgument:
    """Declare an argument that names a file."""
    return CommandArgument(names, settings, of_files=True)


def word(*names: str, **settings: Any) -> CommandArgument:
    """Declare any other argument."""
    return CommandArgument(names, settings)


def number_option(name: str, metavar: str, words: str) -> CommandArgument:
    """Declare an option that is a number."""
    return word(name, type=_number_typed, metavar=metavar, help=words)


def whole_option(name: str, words: str, usual: int | None = None) -> CommandArgument:
    """Declare an option that is a whole number."""
    return word(name, type=_whole_typed, metavar="N", help=words, default=usual)


def _number_typed(typed: str) -> float:
    """Read an argument that is a number."""
    try:
        return float(typed)
    except ValueError:
        words = f"expected a number such as 1.5, got {typed!r}"
        raise ArgumentTypeError(words) from None


def _whole_typed(typed: str) -> int:
    """Read an argument that is a whole number."""
    try:
        return int(typed)
    except ValueError:
        words = f"expected a whole number such as 100, got {typed!r}"
        raise ArgumentTypeError(words) from None


EVERYWHERE: Final = (
    word("-q", "--quiet", action="store_true", help="only the answer: no warnings, no progress"),
    word("-v", "--verbose", action="store_true", help="all numbers of the answer too"),
    word("--json", action="store_true", help="the answer as JSON, for programs"),
    word("--debug", action="store_true", help="show the whole traceback of an error"),
)
"""What all commands take, before their name or behind it."""
SCENE: Final = path(
    "scene", metavar="scene.toml", help="the scene; 'template' writes one; - is standard input"
)
DATASET: Final = path(
    "dataset", metavar="out.nc", help="what another command has written with -o; or -"
)
OVERWRITE: Final = word(
    "--overwrite",
    action="store_true",
    help="replace files that are there, also such as rockframe did not write; never one that is "
    "read",
)
UNITS: Final = word(
    "--units",
    nargs="+",
    metavar="NAME=UNIT",
    help="units of all numbers, such as force=kN angle=deg acceleration=g_0",
)
RESULT: Final = path(
    "-o", "--output", metavar="out.nc", help="write all results to this file; - is standard output"
)
PICTURE: Final = path("--picture", metavar="x.png", help=f"write {PICTURES}")
FROM_FILES: Final = (
    word("--unit", help="unit of the samples, where the file does not say, such as g or cm/s^2"),
    word("--time-step", metavar="TIME", help="of a column of samples without times: '0.01 s'"),
)
READING: Final = (
    word("--component", metavar="NAME", help="component of a record that has several, such as NS"),
    *FROM_FILES,
)
ACCURACY: Final = word(
    "--accuracy",
    metavar="LEVEL",
    help="fast, standard, reference, or a tolerance such as 1e-6; of fragility, ida and map also "
    "screen",
)
LENGTH: Final = (
    word("--free-vibration", metavar="TIME", help="still ground after the motion, such as '20 s'"),
    word("--duration", metavar="TIME", help="length of the run, whatever that of the motion"),
)
RUNNING: Final = (
    path("-m", "--motion", metavar="FILE", help="a record, in the place of the scene's motion"),
    *READING,
    number_option("--scale", "FACTOR", "multiply the motion by this"),
    ACCURACY,
    *LENGTH,
)
INTENSITY: Final = (
    word(
        "--intensity",
        metavar="MEASURE",
        help="of the shaking: PGA, PGV, PGD, CAV, SA (with --period) or a name of 'motion' "
        "(default: PGA)",
    ),
    word("--period", metavar="TIME", help="of the oscillator of SA, such as '0.5 s'"),
)
STORE: Final = path(
    "--store", metavar="FOLDER", help="keep what has been run here, and go on with it"
)
OVER_MOTIONS: Final = (
    path("scene", metavar="scene.toml", help="a scene, or a study with motions and axes; or -"),
    path("records", nargs="*", metavar="RECORD", help="records, archives or folders"),
    *FROM_FILES,
    word(
        "--scales",
        metavar="VALUES",
        help="factors of the motions: 0.5,1,2, or from:to:step, 0.25:4:0.25",
    ),
    *INTENSITY,
    word(
        "--limits",
        metavar="STATES",
        help="limit states beside overturning: uplift, rotations over the overturning angle, "
        "or a variable of runs: uplift,0.5,'peak_slip=5 cm'",
    ),
    ACCURACY,
    *LENGTH,
    STORE,
    RESULT,
    PICTURE,
)
"""Of analyses of one scene under many motions."""
