"""``rockframe study``: many runs of a scene."""

import argparse
import shlex
from pathlib import Path
from typing import Final

from rockframe.command.answer import Answer
from rockframe.command.files.studies import read_study
from rockframe.command.main import INTERRUPTED
from rockframe.command.run import is_finished
from rockframe.command.shared import (
    STUDY_KIND,
    Outputs,
    part_names,
    run_analysis,
    store_from,
    table_kind,
)
from rockframe.command.streams import print_message
from rockframe.errors import StudyError
from rockframe.results.table import table
from rockframe.results.variables.runs import RunStatus
from rockframe.studies import sweep

_PRINTED_VARIABLES: Final = ("status", "peak_relative_rotation", "overturned")
"""Variables of each case in the printed table."""
_TABLE_KIND: Final = table_kind("the table of a study", "status", "overturned", "peak_rotation")


def execute(arguments: argparse.Namespace, answer: Answer) -> int:
    """Run a study, or the rest of an interrupted one."""
    found = read_study(arguments.study)
    if arguments.output is None and found.output is not None:
        arguments.output = str(found.output)
    outputs = Outputs(arguments, found.files, answer, output=STUDY_KIND, csv=_TABLE_KIND)
    store = store_from(arguments) or found.store
    answer.add_context("Scene", part_names(found.system))
    try:
        given = {"store": store, **found.arguments}
        runs = run_analysis(sweep, found, found.motions, given, arguments)
        answer.add_result("Verdict", runs.attrs["verdict"])
        answer.add_numbers(runs)
        values = table(runs)
        answer.add_table(
            values[[head for head in values if str(head).split(" [")[0] in _PRINTED_VARIABLES]]
        )
        outputs.write_table(values)
        outputs.write_result(runs)
    except StudyError as problem:
        raise found.at_lines(problem) from problem
    except KeyboardInterrupt:
        _print_how_to_continue(store, arguments.typed)
        raise
    if (runs["status"] == RunStatus.NOT_RUN).any():
        _print_how_to_continue(store, arguments.typed)
        return INTERRUPTED
    return 0 if is_finished(runs) else 1


def _print_how_to_continue(store: Path | None, typed: list[str]) -> None:
    """Print the command that continues an interrupted study."""
    words = ["rockframe", *typed]
    text = "this command continues it"
    if store is None:
        words += ["--store", "study"]
        text = "without a store all has to be run again; with a store it could continue"
    print_message("rockframe study", f"interrupted; {text}: {shlex.join(words)}")
