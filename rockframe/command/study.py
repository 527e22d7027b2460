"""``rockframe study``: many runs of a scene."""

import argparse
import shlex
from pathlib import Path
from typing import Final

from rockframe.command.answer import Answer
from rockframe.command.files.studies import read_study
from rockframe.command.main import INTERRUPTED
from rockframe.command.run import finished
from rockframe.command.shared import (
    STUDY,
    Outputs,
    analysed,
    store_from,
    system_words,
    table_kind,
)
from rockframe.command.streams import tell
from rockframe.errors import StudyError
from rockframe.results.table import table
from rockframe.results.variables.runs import RunStatus
from rockframe.studies import sweep

_SHOWN: Final = ("status", "peak_relative_rotation", "overturned")
"""Variables of each case in the printed table."""
_TABLE: Final = table_kind("the table of a study", "status", "overturned", "peak_rotation")


def execute(arguments: argparse.Namespace, answer: Answer) -> int:
    """Run a study, or the rest of an interrupted one."""
    found = read_study(arguments.study)
    if arguments.output is None and found.output is not None:
        arguments.output = str(found.output)
    outputs = Outputs(arguments, found.files, answer, output=STUDY, csv=_TABLE)
    store = store_from(arguments) or found.store
    answer.subject("Scene", system_words(found.system))
    try:
        given = {"store": store, **found.arguments}
        runs = analysed(sweep, found, found.motions, given, arguments)
        answer.says("Verdict", runs.attrs["verdict"])
        answer.numbers(runs)
        values = table(runs)
        answer.table(values[[head for head in values if str(head).split(" [")[0] in _SHOWN]])
        outputs.table(values)
        outputs.result(runs)
    except StudyError as problem:
        raise found.at_lines(problem) from problem
    except KeyboardInterrupt:
        _print_how_to_continue(store, arguments.typed)
        raise
    if (runs["status"] == RunStatus.NOT_RUN).any():
        _print_how_to_continue(store, arguments.typed)
        return INTERRUPTED
    return 0 if finished(runs) else 1


def _print_how_to_continue(store: Path | None, typed: list[str]) -> None:
    """Print the command that continues an interrupted study."""
    words = ["rockframe", *typed]
    text = "this command continues it"
    if store is None:
        words += ["--store", "study"]
        text = "without a store all has to be run again; with a store it could continue"
    tell("rockframe study", f"interrupted; {text}: {shlex.join(words)}")
