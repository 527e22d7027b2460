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
from typing import Any, Final

from rockframe.command.answer import Answer
from rockframe.command.parser import (
    UsageError,
    build_parser,
    rewrite_for_command_line,
    unknown_word_message,
)
from rockframe.command.streams import StandardInput, print_message, replace_closed_streams
from rockframe.errors import RockframeError, RockframeWarning, SolverError

UNFINISHED: Final = 1
WRONG_INPUT: Final = 2
INTERRUPTED: Final = 130


def main(values: Sequence[str] | None = None) -> int:
    """Run the command line, and give its exit code."""
    typed = list(sys.argv[1:] if values is None else values)
    StandardInput.read_as = ""
    replace_closed_streams()
    parser = build_parser()
    try:
        unknown = unknown_word_message(typed)
        if unknown is not None:
            program, _, words = unknown.partition(": ")
            print_message(program, words)
            raise UsageError(words)
        unset = Namespace(quiet=False, verbose=False, json=False, debug=False)
        arguments = parser.parse_args(typed, unset)
    except UsageError as problem:
        if "--json" in typed:
            name = next((word for word in typed if not word.startswith("-")), "")
            answer = Answer(name, quiet=True, verbose=False, as_json=True)
            _print_answer(answer, WRONG_INPUT, str(problem), "rockframe")
        return WRONG_INPUT
    except SystemExit:  # after help or version
        return 0
    if arguments.command is None:
        parser.print_help()
        return WRONG_INPUT
    arguments.typed = typed
    program = f"rockframe {arguments.command}"
    with _recorded_interrupts() as interrupts:
        try:
            return _run_command(arguments, program, interrupts)
        except KeyboardInterrupt:  # also while libraries are loaded
            print_message(program, "interrupted")
            return INTERRUPTED


def _run_command(arguments: Namespace, program: str, interrupts: list[int]) -> int:
    """Run a command, and print its results once all of its files are written."""
    answer = Answer(
        arguments.command,
        quiet=arguments.quiet,
        verbose=arguments.verbose,
        as_json=arguments.json,
    )
    error = ""
    with warnings.catch_warnings():
        warnings.simplefilter("default", RockframeWarning)
        warnings.showwarning = _warning_printer(program, answer)
        try:
            # each command imports the libraries it needs only when it runs
            module = import_module(f"rockframe.command.{arguments.module}")
            code = int(getattr(module, f"execute_{arguments.command}")(arguments, answer))
            if interrupts:  # the results up to the interruption are in the answer
                code = INTERRUPTED
        except KeyboardInterrupt:
            code, error = INTERRUPTED, "interrupted"
        except (RockframeError, OSError, MemoryError) as problem:
            code = UNFINISHED if isinstance(problem, SolverError) else WRONG_INPUT
            error = (
                rewrite_for_command_line(str(problem), arguments.command)
                or "there is not enough memory"
            )
            if arguments.debug:
                traceback.print_exc()
        written = _print_answer(answer, code, error, program)
    if error and not arguments.debug:
        print_message(program, error)
    return code if written or error else WRONG_INPUT


def _print_answer(answer: Answer, code: int, error: str, program: str) -> bool:
    """Print the results of a command; false where they could not be written."""
    text = answer.as_json_text(code, error) if answer.as_json else answer.as_text(error)
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
        print_message(program, f"the output cannot be written ({problem.strerror})")
        return False
    return True


@contextmanager
def _recorded_interrupts() -> Generator[list[int]]:
    """Record Ctrl-C, also where an analysis then returns its results so far."""
    interrupts: list[int] = []
    if threading.current_thread() is not threading.main_thread():
        yield interrupts
        return

    def handler(number: int, frame: FrameType | None) -> None:
        interrupts.append(number)
        signal.default_int_handler(number, frame)

    before = signal.signal(signal.SIGINT, handler)
    try:
        yield interrupts
    finally:
        signal.signal(signal.SIGINT, before)


def _warning_printer(program: str, answer: Answer) -> Any:
    def say(message: object, category: type[Warning], *_: object, **__: object) -> None:
        if not issubclass(category, RockframeWarning):
            return
        words = rewrite_for_command_line(str(message), program.split()[-1])
        answer.add_warning(words)
        if not answer.quiet:
            print_message(program, f"warning: {words}", "warning")

    return say
