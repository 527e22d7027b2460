"""Parser of the command line, with proposals for misspelt words."""

import argparse
import re
from collections.abc import Sequence
from typing import Any, Final, NoReturn

from rockframe.command.arguments import COMMON_OPTIONS, Command
from rockframe.command.commands import COMMANDS
from rockframe.command.streams import STREAM
from rockframe.shared_arguments import suggestion
from rockframe.version import __version__

_HYPHENED_VALUE: Final = re.compile(r"-[\d.]|-.* ")
"""Values that begin with a hyphen: a number, or a quantity with its unit."""
_KEYWORD_EXAMPLE: Final = re.compile(r"\b(\w+)=(?:'([^']*)'|\(([^()]*)\))")
_FUNCTION_PREFIX: Final = re.compile(
    r"^(case|critical_scale|fragility|incremental_dynamic_analysis|overturning_map|report|sweep|"
    r"simulate|serve|rf\.plot\.\w+): "
)
"""Names of functions at the head of messages, which do not help on the command line."""
_PYTHON_HINT: Final = re.compile(r"; suite\.\w+ lists all|; give a function of amplitude .*")
"""What only Python has: where it holds what a message does not list, and functions."""
_SCENE_ARGUMENT: Final = "scene"
"""Argument of the commands that read the file of a scene."""
_INVALID_CHOICE: Final = re.compile(r"invalid choice: '(.*?)'")

EXIT_CODES: Final = """\
exit codes:
  0    done; that a body overturns is a result, not a failure
  1    a run could not be finished, or a case of a study has no result
  2    the command line or a file is wrong; the message says what is wrong, and where
  130  interrupted (Ctrl-C)
"""
_DESCRIPTION: Final = """\
Simulate rigid blocks and frames that rock on the ground, on pads or on soil.

A scene is a text file with units:

  rockframe template > scene.toml
  rockframe describe scene.toml
  rockframe run scene.toml --motion record.AT2 -o out.nc
  rockframe plot out.nc -o out.png
  rockframe report out.nc

Questions:

  rockframe critical scene.toml --motion record.AT2             which scale overturns it?
  rockframe fragility scene.toml records --picture curve.png    how probable is it?
  rockframe certify scene.toml --motion record.AT2              how certain is the verdict?
"""


def build_parser() -> argparse.ArgumentParser:
    """Build the parser of the whole command line."""
    everywhere = argparse.ArgumentParser(add_help=False)
    for option in COMMON_OPTIONS:
        everywhere.add_argument(*option.names, **option.settings, default=argparse.SUPPRESS)
    parser = _Parser(
        prog="rockframe",
        description=_DESCRIPTION,
        epilog=f"'rockframe COMMAND --help' explains a command, with examples.\n\n{EXIT_CODES}",
        formatter_class=argparse.RawDescriptionHelpFormatter,
        parents=[everywhere],
        allow_abbrev=False,
    )
    parser.add_argument("--version", action="version", version=f"rockframe {__version__}")
    commands: Any = parser.add_subparsers(
        dest="command", metavar="COMMAND", title="commands", parser_class=_CommandParser
    )
    for command in COMMANDS:
        subparser = commands.add_parser(
            command.name,
            help=command.summary,
            description=command.description,
            epilog=f"examples:\n{command.examples}\n\n{EXIT_CODES}",
            formatter_class=_Formatter,
            parents=[everywhere],
            allow_abbrev=False,
        )
        for argument in command.arguments:
            subparser.add_argument(*argument.names, **argument.settings)
        subparser.set_defaults(module=command.module)
    return parser


def unknown_word_message(typed: Sequence[str]) -> str | None:
    """Return a message on a word that is neither a command nor an option, with a proposal."""
    known = {command.name: command for command in COMMANDS}
    position = next((k for k, word in enumerate(typed) if not word.startswith("-")), len(typed))
    first = typed[position] if position < len(typed) else None
    unknown = [word for word in typed[:position] if not _is_option(word, _options(None))]
    if unknown:
        return _unknown_option_message(unknown[0].split("=")[0], None, _options(None))
    if first is not None and first not in known:
        proposal = suggestion(first, known)
        listed = ", ".join(known)
        return f"rockframe: invalid choice: {first!r} is no command{proposal} There are {listed}"
    command = None if first is None else known[first]
    options = _options(command)
    for word in typed[position + 1 :]:
        if word == "--":
            break
        # neither a number, nor a value with a unit, nor the standard input
        option = word.startswith("-") and word != STREAM and not _HYPHENED_VALUE.match(word)
        if option and not _is_option(word, options):
            return _unknown_option_message(word.split("=")[0], command, options)
    return None


def rewrite_for_command_line(words: str, name: str) -> str:
    """Rewrite a message of a Python function for the command line and the file of a scene."""
    command = next(candidate for candidate in COMMANDS if candidate.name == name)
    options = _options(command)

    def typed(match: re.Match[str]) -> str:
        option = f"--{match[1].replace('_', '-')}"
        value = f"'{match[2]}'" if match[3] is None else match[3].replace(",", "")
        return f"{option} {value}" if option in options else match[0]

    words = _KEYWORD_EXAMPLE.sub(typed, _FUNCTION_PREFIX.sub("", _PYTHON_HINT.sub("", words)))
    if not any(_SCENE_ARGUMENT in argument.names for argument in command.arguments):
        return words
    from rockframe.command.files.tables import in_toml

    return in_toml(words)


def _options(command: Command | None) -> list[str]:
    """Return all options of a command, or those that are allowed before the command."""
    declared = [*COMMON_OPTIONS, *(() if command is None else command.arguments)]
    names = [name for argument in declared for name in argument.names if name.startswith("-")]
    return [*names, "-h", "--help", *(["--version"] if command is None else [])]


def _is_option(word: str, options: Sequence[str]) -> bool:
    # a value may follow -o without a space, and short options may be joined
    return word.split("=")[0] in options or (word[1] != "-" and word[:2] in options)


def _unknown_option_message(word: str, command: Command | None, options: Sequence[str]) -> str:
    program = "rockframe" if command is None else f"rockframe {command.name}"
    also = [candidate.name for candidate in COMMANDS if word in _options(candidate)]
    if also:
        place = "before the command" if command is None else "here"
        verb = "takes" if len(also) == 1 else "take"
        words = f" {place}; {', '.join(also)} {verb} it."
    else:
        names = [name[2:].replace("-", "_") for name in options if name.startswith("--")]
        near = suggestion(word[2:].replace("-", "_"), names)
        words = re.sub("'(.*?)'", lambda name: f"'--{name[1].replace('_', '-')}'", near)
    return f"{program}: there is no option {word}{words} '{program} --help' lists all"


class UsageError(Exception):
    """A wrong command line; the message has been written."""


class _Parser(argparse.ArgumentParser):
    """Raises its message on a wrong command line, for the answer in JSON."""

    def error(self, message: str) -> NoReturn:
        """Write usage and message, and raise the message."""
        try:
            super().error(message)
        except SystemExit as left:
            raise UsageError(message) from left


class _CommandParser(_Parser):
    """Parser of one command: files and options in any order, proposals for wrong choices."""

    _within = False

    def parse_known_args(  # pyright: ignore[reportIncompatibleMethodOverride]
        self, args: Any = None, namespace: Any = None
    ) -> Any:
        """Parse with options anywhere among several files."""
        if self._within:
            return super().parse_known_args(args, namespace)
        self._within = True
        try:
            return self.parse_known_intermixed_args(args, namespace)
        finally:
            self._within = False

    def error(self, message: str) -> NoReturn:
        """Add the choice that was probably meant to the message."""
        match = _INVALID_CHOICE.search(message)
        if match is not None:
            choices = [
                choice for action in self._actions for choice in action.choices or ()
            ]  # the message does not always list the choices of its argument
            near = suggestion(match[1], [str(choice) for choice in choices])
            message += near if near != "." else ""
        super().error(message)


class _Formatter(argparse.RawDescriptionHelpFormatter):
    """Wraps the description, and leaves the examples as they are."""

    def _fill_text(self, text: str, width: int, indent: str) -> str:
        if "\n" in text:
            return super()._fill_text(text, width, indent)
        return argparse.HelpFormatter._fill_text(self, text, width, indent)
