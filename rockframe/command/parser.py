"""What can be typed; nothing here loads a library, so that help and completion come at once."""

import argparse
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Final

from rockframe.version import __version__

EXIT_CODES: Final = """\
exit codes:
  0    done; that a body overturns is a result, not a failure
  1    a run could not be finished, or a case of a study has no result
  2    the command line or a file is wrong; the message says what, and where
  130  interrupted (Ctrl-C)
"""
PICTURES: Final = "a picture; its ending tells the format: .png, .svg, .pdf"


@dataclass(frozen=True)
class CommandArgument:
    """One argument of a command."""

    names: tuple[str, ...]  # as it is typed
    settings: dict[str, Any]  # as :meth:`argparse.ArgumentParser.add_argument` takes them
    of_files: bool = False  # whether it names a file


def _path(*names: str, **settings: Any) -> CommandArgument:
    return CommandArgument(names, settings, of_files=True)


def _word(*names: str, **settings: Any) -> CommandArgument:
    return CommandArgument(names, settings)


@dataclass(frozen=True)
class Command:
    """One command."""

    name: str  # as it is typed; the module of that name carries it out
    words: str  # what it does, in a line
    story: str  # what it does, for those who ask for help
    examples: str  # lines to copy
    arguments: Sequence[CommandArgument]  # what it takes


_SCENE: Final = _path("scene", metavar="scene.toml", help="the scene; 'template' writes one")
_DATASET: Final = _path("dataset", metavar="out.nc", help="what 'run' or 'study' has written")
_OVERWRITE: Final = _word(
    "--overwrite",
    action="store_true",
    help="replace files that are there, also such as rockframe did not write; never one that is "
    "read",
)
_READING: Final = (
    _word("--component", metavar="NAME", help="component of a record that has several, such as NS"),
    _word("--unit", help="unit of the samples, where the file does not say, such as g or cm/s^2"),
    _word("--time-step", metavar="TIME", help="of a column of samples without times: '0.01 s'"),
)
_RUNNING: Final = (
    _path("-m", "--motion", metavar="FILE", help="a record, in the place of the scene's motion"),
    *_READING,
    _word("--scale", type=float, metavar="FACTOR", help="multiply the motion by this"),
    _word(
        "--accuracy",
        metavar="LEVEL",
        help="fast, standard, reference, or a tolerance such as 1e-6",
    ),
    _word("--free-vibration", metavar="TIME", help="still ground after the motion, such as '20 s'"),
    _word("--duration", metavar="TIME", help="length of the run, whatever that of the motion"),
)

COMMANDS: Final = (
    Command(
        "template",
        "write a scene or a study to begin with",
        "Write a file to begin with. Change its numbers, which carry their units, and run it.",
        """\
  rockframe template > scene.toml            a block on rigid ground
  rockframe template stack > scene.toml      a frame on pads, cap and soil
  rockframe template study > study.toml      many runs of one scene
  rockframe template all                     every table and every key, with its meaning""",
        (
            _word(
                "kind",
                nargs="?",
                default="block",
                choices=("block", "pads", "soil", "stack", "study", "all"),
                help="which one (default: block)",
            ),
        ),
    ),
    Command(
        "describe",
        "tell which model a scene makes, and its numbers",
        "Check the file of a scene, and tell the model, its equations, its frequencies and what "
        "it leaves out. Nothing is simulated.",
        "  rockframe describe scene.toml",
        (_SCENE,),
    ),
    Command(
        "motion",
        "tell what is in files of ground motions",
        "List the components of files, archives and folders as agencies give them out, with "
        "their intensity measures.",
        """\
  rockframe motion record.AT2
  rockframe motion record.AT2 --picture record.png
  rockframe motion PEERNGARecords.zip --csv measures.csv""",
        (
            _path("files", nargs="+", metavar="FILE", help="records, archives or folders"),
            *_READING,
            _path(
                "--picture",
                metavar="x.png",
                help=f"write {PICTURES}; of several motions one for each, numbered",
            ),
            _path("--csv", metavar="x.csv", help="write the table of measures, for a spreadsheet"),
            _OVERWRITE,
        ),
    ),
    Command(
        "run",
        "simulate a scene under a motion",
        "Simulate a scene, say what becomes of it, and write all results to a netCDF file, which "
        "'plot', 'report', xarray, MATLAB and many others read.",
        """\
  rockframe run scene.toml                                 the motion is in the scene
  rockframe run scene.toml --motion record.AT2 -o out.nc
  rockframe run scene.toml --motion record.AT2 --scale 1.5 --accuracy fast""",
        (
            _SCENE,
            *_RUNNING,
            _path("-o", "--output", metavar="out.nc", help="write all results to this file"),
            _OVERWRITE,
        ),
    ),
    Command(
        "certify",
        "tell how sure the verdict of a run is",
        "Simulate a scene, and then a hundred times more: by finer means, with parameters changed "
        "a little, and under the scaled motion. Tell whether the verdict stays.",
        """\
  rockframe certify scene.toml --motion record.AT2
  rockframe certify scene.toml --motion record.AT2 --nudge 0.01 -o out.nc
  rockframe certify scene.toml --motion record.AT2 --proved""",
        (
            _SCENE,
            *_RUNNING,
            _word(
                "--nudge",
                type=float,
                metavar="SHARE",
                help="largest relative change of each parameter (default: 0.001)",
            ),
            _word(
                "--reach",
                type=float,
                metavar="SHARE",
                help="largest relative change of the scale (default: 0.5)",
            ),
            _word(
                "--proved",
                action="store_true",
                help="prove the verdict instead (of a block alone; needs python-flint)",
            ),
            _word(
                "--runs", type=int, metavar="N", help="most runs beside the first (default: 200)"
            ),
            _path("-o", "--output", metavar="out.nc", help="write all results to this file"),
            _OVERWRITE,
        ),
    ),
    Command(
        "study",
        "run a scene at many values",
        "Run a scene at all combinations of values, or at all rows of a table, under one motion "
        "or many. With a store, a folder, what has been run is kept: the same command goes on "
        "where it was interrupted.",
        """\
  rockframe study study.toml
  rockframe study study.toml --store kept -o runs.nc
  rockframe study study.toml --csv runs.csv""",
        (
            _path("study", metavar="study.toml", help="the study; 'template study' writes one"),
            _path(
                "--store", metavar="FOLDER", help="keep what has been run here, and go on with it"
            ),
            _path("-o", "--output", metavar="runs.nc", help="write all results to this file"),
            _path("--csv", metavar="x.csv", help="write a table with a row for each case"),
            _OVERWRITE,
        ),
    ),
    Command(
        "plot",
        "draw a result",
        "Draw what a file holds: a run along time, or the figure of a study.",
        """\
  rockframe plot out.nc -o out.png
  rockframe plot map.nc -o map.pdf --title 'A pulse on blocks of marble'""",
        (
            _DATASET,
            _path("-o", "--output", required=True, metavar="x.png", help=f"write {PICTURES}"),
            _OVERWRITE,
            _word("--title", help="above the figure, in the place of the verdict"),
        ),
    ),
    Command(
        "report",
        "write a page on a run or a study, to file or to print",
        "Write one HTML file that needs no other: the scene, the motion and its measures, the "
        "verdict and its certificate, figures, limits of validity, and where it all comes from. "
        "A run without certificate is certified first, where the file holds its motion. Of a study "
        "it has all cases in a table and the worst one in full, or the one that --case names.",
        """\
  rockframe report out.nc
  rockframe report out.nc -o tower.html --title 'Clock tower, record 12'
  rockframe report runs.nc --units force=kN angle=deg
  rockframe report runs.nc --case scale=2 'width=0.7 m' -o case.html""",
        (
            _DATASET,
            _path("-o", "--output", metavar="x.html", help="the file (default: beside the result)"),
            _OVERWRITE,
            _word(
                "--case",
                nargs="+",
                metavar="NAME=VALUE",
                help="of a study: which case, by its place along every axis of several values",
            ),
            _word("--title", help="of the page"),
            _word(
                "--units",
                nargs="+",
                metavar="NAME=UNIT",
                help="units of all numbers, such as force=kN angle=deg acceleration=g_0",
            ),
            _path(
                "--motion",
                metavar="RECORD",
                help="the record of the run, for its certificate where the result does not hold it",
            ),
            _word(
                "--no-certificate",
                action="store_true",
                help="do not certify a run that is not yet certified",
            ),
        ),
    ),
    Command(
        "completion",
        "write what a shell needs to complete commands",
        "Write a script with which a shell completes commands, options and names of files.",
        """\
  bash   source <(rockframe completion bash)         in ~/.bashrc
  zsh    source <(rockframe completion zsh)          in ~/.zshrc
  fish   rockframe completion fish | source          in ~/.config/fish/config.fish""",
        (_word("shell", choices=("bash", "zsh", "fish"), help="which shell"),),
    ),
)

_STORY: Final = """\
Simulate rigid blocks and frames that rock on the ground, on pads or on soil.

A scene is a text file with units:

  rockframe template > scene.toml
  rockframe describe scene.toml
  rockframe run scene.toml --motion record.AT2 -o out.nc
  rockframe plot out.nc -o out.png
  rockframe report out.nc
"""


def build_parser() -> argparse.ArgumentParser:
    """Build the parser of the whole command line."""
    everywhere = argparse.ArgumentParser(add_help=False)
    everywhere.add_argument(
        "--debug",
        action="store_true",
        default=argparse.SUPPRESS,
        help="show the whole traceback of an error",
    )
    parser = argparse.ArgumentParser(
        prog="rockframe",
        description=_STORY,
        epilog=f"'rockframe COMMAND --help' tells more, with examples.\n\n{EXIT_CODES}",
        formatter_class=argparse.RawDescriptionHelpFormatter,
        parents=[everywhere],
        allow_abbrev=False,
    )
    parser.add_argument("--version", action="version", version=f"rockframe {__version__}")
    commands = parser.add_subparsers(dest="command", metavar="COMMAND", title="commands")
    for command in COMMANDS:
        one = commands.add_parser(
            command.name,
            help=command.words,
            description=command.story,
            epilog=f"examples:\n{command.examples}\n\n{EXIT_CODES}",
            formatter_class=_Formatter,
            parents=[everywhere],
            allow_abbrev=False,
        )
        for argument in command.arguments:
            one.add_argument(*argument.names, **argument.settings)
    return parser


class _Formatter(argparse.RawDescriptionHelpFormatter):
    """Fills the description, and leaves the examples as they are."""

    def _fill_text(self, text: str, width: int, indent: str) -> str:
        if "\n" in text:
            return super()._fill_text(text, width, indent)
        return argparse.HelpFormatter._fill_text(self, text, width, indent)
