"""The entry: reads the command line, carries out the command, and tells what went wrong."""

import os
import sys
import traceback
import warnings
from collections.abc import Sequence
from contextlib import redirect_stdout
from importlib import import_module
from io import StringIO
from typing import Final

from rockframe.command.parser import build_parser
from rockframe.errors import RockframeError, RockframeWarning, SolverError

DONE: Final = 0
UNFINISHED: Final = 1
WRONG_INPUT: Final = 2
INTERRUPTED: Final = 130


def main(given: Sequence[str] | None = None) -> int:
    """Carry out what was typed."""
    parser = build_parser()
    try:
        arguments = parser.parse_args(given)
    except SystemExit as left:  # help, version, or a wrong command line
        return left.code if isinstance(left.code, int) else WRONG_INPUT
    if arguments.command is None:
        parser.print_help()
        return WRONG_INPUT
    arguments.typed = list(sys.argv[1:] if given is None else given)
    who = f"rockframe {arguments.command}"
    with warnings.catch_warnings():
        warnings.simplefilter("default", RockframeWarning)
        warnings.showwarning = _say_warning(who)
        # what is said is printed once all files are written: whoever reads it may stop early
        told = StringIO()
        try:
            with redirect_stdout(told):
                code = _execute(arguments)
        except KeyboardInterrupt:
            _print(told.getvalue(), who)
            print(f"{who}: interrupted", file=sys.stderr)
            return INTERRUPTED
        except (RockframeError, OSError) as problem:
            _print(told.getvalue(), who)
            if getattr(arguments, "debug", False):
                traceback.print_exc()
            else:
                print(f"{who}: {problem}", file=sys.stderr)
            return UNFINISHED if isinstance(problem, SolverError) else WRONG_INPUT
        return code if _print(told.getvalue(), who) else WRONG_INPUT


def _print(told: str, who: str) -> bool:
    """Print what a command said; tell whether that went well, or nobody wants to read more."""
    try:
        encoding = sys.stdout.encoding or "utf-8"
        print(told.encode(encoding, "replace").decode(encoding), end="", flush=True)
    except OSError as problem:
        # or Python would try again at its end, and tell of it
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        if isinstance(problem, BrokenPipeError):
            return True
        print(f"{who}: the output cannot be written ({problem.strerror})", file=sys.stderr)
        return False
    return True


def _execute(arguments: object) -> int:
    """Call the module of the command, which loads what it needs."""
    name = arguments.command  # type: ignore[attr-defined]
    return import_module(f"rockframe.command.{name}").execute(arguments)


def _say_warning(who: str) -> object:
    def say(message: object, category: type[Warning], *_: object, **__: object) -> None:
        if issubclass(category, RockframeWarning):
            print(f"{who}: warning: {message}", file=sys.stderr)

    return say
