"""Entry point: reads the command line, runs the command and reports errors."""

import os
import signal
import sys
import threading
import traceback
import warnings
from argparse import Namespace
from collections.abc import Generator, Sequence
from contextlib import contextmanager
from importlib import import_module
from types import FrameType
from typing import TYPE_CHECKING, Any, Final

from rockframe.command.parser import WrongLineError, as_typed, build_parser, misspelt
from rockframe.command.streams import StandardInput, tell
from rockframe.errors import RockframeError, RockframeWarning, SolverError

if TYPE_CHECKING:
    from rockframe.command.answer import Answer

UNFINISHED: Final = 1
WRONG_INPUT: Final = 2
INTERRUPTED: Final = 130


def main(values: Sequence[str] | None = None) -> int:
    """Run the command line, and give its exit code."""
    typed = list(sys.argv[1:] if values is None else values)
    StandardInput.taken_by = ""
    problem = misspelt(typed)
    if problem is not None:
        who, _, words = problem.partition(": ")
        tell(who, words)
        return _wrong(typed, words)
    parser = build_parser()
    try:
        arguments = parser.parse_args(typed)
    except WrongLineError as problem:
        return _wrong(typed, str(problem))
    except SystemExit:  # after help or version
        return 0
    if arguments.command is None:
        parser.print_help()
        return WRONG_INPUT
    arguments.typed = typed
    for name in ("quiet", "verbose", "json", "debug"):
        setattr(arguments, name, getattr(arguments, name, False))
    who = f"rockframe {arguments.command}"
    with _interrupts() as heard:
        try:
            return _carried_out(arguments, who, heard)
        except KeyboardInterrupt:  # also while libraries are loaded
            tell(who, "interrupted")
            return INTERRUPTED


def _wrong(typed: Sequence[str], words: str) -> int:
    """Report a wrong command line as JSON as well, where that is required."""
    if "--json" in typed:
        from rockframe.command.answer import Answer

        name = next((word for word in typed if not word.startswith("-")), "")
        answer = Answer(name, quiet=True, verbose=False, as_json=True)
        _print(answer, WRONG_INPUT, words, "rockframe")
    return WRONG_INPUT


def _carried_out(arguments: Namespace, who: str, heard: list[int]) -> int:
    """Run a command, and print its results once all of its files are written."""
    from rockframe.command.answer import Answer

    answer = Answer(
        arguments.command,
        quiet=arguments.quiet,
        verbose=arguments.verbose,
        as_json=arguments.json,
    )
    error = ""
    with warnings.catch_warnings():
        warnings.simplefilter("default", RockframeWarning)
        warnings.showwarning = _say_warning(who, answer)
        try:
            # each command imports the libraries it needs only when it runs
            module: Any = import_module(f"rockframe.command.{arguments.command}")
            code = int(module.execute(arguments, answer))
            if heard:  # the results up to the interruption are in the answer
                code = INTERRUPTED
        except KeyboardInterrupt:
            code, error = INTERRUPTED, "interrupted"
        except (RockframeError, OSError, MemoryError) as problem:
            code = UNFINISHED if isinstance(problem, SolverError) else WRONG_INPUT
            error = as_typed(str(problem), arguments.command) or "there is not enough memory"
            if arguments.debug:
                traceback.print_exc()
        written = _print(answer, code, error, who)
    if error and not arguments.debug:
        tell(who, error)
    return code if written or error else WRONG_INPUT


def _print(answer: "Answer", code: int, error: str, who: str) -> bool:
    """Print the results of a command; false where they could not be written."""
    text = answer.json(code, error) if answer.as_json else answer.printed(error)
    if sys.stdout is None:  # closed before the command began
        return True
    try:
        if answer.data is not None:  # the file takes the standard output, so text goes to the other
            sys.stdout.buffer.write(answer.data)
            sys.stdout.flush()
            print(text, end="", file=sys.stderr)
            return True
        encoding = sys.stdout.encoding or "utf-8"
        print(text.encode(encoding, "replace").decode(encoding), end="", flush=True)
    except OSError as problem:
        # otherwise Python writes again when it exits, and reports the error a second time
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        if isinstance(problem, BrokenPipeError):
            return True
        tell(who, f"the output cannot be written ({problem.strerror})")
        return False
    return True


@contextmanager
def _interrupts() -> Generator[list[int]]:
    """Record Ctrl-C, also where an analysis then returns its results so far."""
    heard: list[int] = []
    if threading.current_thread() is not threading.main_thread():
        yield heard
        return

    def hear(number: int, frame: FrameType | None) -> None:
        heard.append(number)
        signal.default_int_handler(number, frame)

    before = signal.signal(signal.SIGINT, hear)
    try:
        yield heard
    finally:
        signal.signal(signal.SIGINT, before)


def _say_warning(who: str, answer: "Answer") -> Any:
    def say(message: object, category: type[Warning], *_: object, **__: object) -> None:
        if not issubclass(category, RockframeWarning):
            return
        words = as_typed(str(message), who.split()[-1])
        answer.warned(words)
        if not answer.quiet:
            tell(who, f"warning: {words}", "warning")

    return say
