"""The entry: reads the command line, carries out the command, and tells what went wrong."""

import os
import sys
import traceback
import warnings
from collections.abc import Sequence
from importlib import import_module
from typing import Final

from rockframe.command.parser import build_parser
from rockframe.errors import RockframeError, RockframeWarning, SolverError

DONE: Final = 0
UNFINISHED: Final = 1
WRONG_INPUT: Final = 2
INTERRUPTED: Final = 130


def main(given: Sequence[str] | None = None) -> int:
    """Carry out what was typed.

    Parameters
    ----------
    given : sequence of str, optional
        Words after the name of the program; those of this process unless given.

    Returns
    -------
    int
        Exit code.
    """
    parser = build_parser()
    try:
        arguments = parser.parse_args(given)
    except SystemExit as left:  # help, version, or a wrong command line
        return left.code if isinstance(left.code, int) else WRONG_INPUT
    if arguments.command is None:
        parser.print_help()
        return WRONG_INPUT
    who = f"rockframe {arguments.command}"
    with warnings.catch_warnings():
        warnings.simplefilter("default", RockframeWarning)
        warnings.showwarning = _say_warning(who)
        try:
            code = _execute(arguments)
            sys.stdout.flush()
        except KeyboardInterrupt:
            print(f"{who}: interrupted", file=sys.stderr)
            return INTERRUPTED
        except BrokenPipeError:  # whoever read has read enough
            os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
            return DONE
        except (RockframeError, OSError) as problem:
            if getattr(arguments, "debug", False):
                traceback.print_exc()
            else:
                print(f"{who}: {problem}", file=sys.stderr)
            return UNFINISHED if isinstance(problem, SolverError) else WRONG_INPUT
    return code


def _execute(arguments: object) -> int:
    """Call the module of the command, which loads what it needs."""
    name = arguments.command  # type: ignore[attr-defined]
    return import_module(f"rockframe.command.{name}").execute(arguments)


def _say_warning(who: str) -> object:
    def say(message: object, category: type[Warning], *_: object, **__: object) -> None:
        if issubclass(category, RockframeWarning):
            print(f"{who}: warning: {message}", file=sys.stderr)

    return say
