"""``rockframe study``: many runs of a scene."""

import argparse
import shlex
from pathlib import Path
from typing import Any, Final

import numpy as np

from rockframe.command.answer import Answer
from rockframe.command.files.studies import DescribedStudy, read_study
from rockframe.command.main import INTERRUPTED
from rockframe.command.run import FINISHED
from rockframe.command.shared import STUDY, Outputs, printed, system_words, table_kind, with_project
from rockframe.command.streams import bar_for, tell
from rockframe.errors import FileError, StudyError
from rockframe.results.table import table
from rockframe.results.variables.runs import RunStatus
from rockframe.studies import sweep

_SHOWN: Final = ("status", "peak_relative_rotation", "overturned")
"""What the printed table has of each case."""
_TABLE: Final = table_kind("the table of a study", "status", "overturned", "peak_rotation")
_MOST_SHOWN: Final = 40
"""Rows up to which the table is printed."""


def execute(arguments: argparse.Namespace, answer: Answer) -> int:
    """Carry out a study, or what is left of it."""
    found = read_study(arguments.study)
    if arguments.output is None and found.output is not None:
        arguments.output = str(found.output)
    outputs = Outputs(arguments, found.files, answer)
    outputs.check(arguments.output, STUDY)
    outputs.check(arguments.csv, _TABLE)
    if arguments.store == "":
        words = "found no name of a folder after --store; expected one, such as --store kept"
        raise FileError(arguments.study, [(None, words)])
    store = found.store if arguments.store is None else Path(arguments.store).expanduser()
    answer.subject("Scene", system_words(found.system))
    try:
        return _carried_out(found, store, arguments, outputs, answer)
    except KeyboardInterrupt:
        _say_how_to_go_on(store, arguments.typed)
        raise


def _carried_out(
    found: DescribedStudy,
    store: Path | None,
    arguments: argparse.Namespace,
    outputs: Outputs,
    answer: Answer,
) -> int:
    try:
        with bar_for("study", quiet=arguments.quiet) as bar:
            given: dict[str, Any] = {"store": store, "progress": bar, **found.arguments}
            runs = sweep(found.system, found.motions, **given)
    except StudyError as problem:
        raise found.at_lines(problem) from problem
    runs = with_project(runs, found.project)
    answer.says("Verdict", runs.attrs["verdict"])
    answer.numbers(runs)
    values = table(runs)
    if len(values) <= _MOST_SHOWN:
        wanted = [head for head in values if str(head).split(" [")[0] in _SHOWN]
        answer.text(printed(values[wanted]))
    outputs.table(arguments.csv, _TABLE, values)
    outputs.result(arguments.output, STUDY, runs)
    status = runs["status"].to_numpy()
    if (status == RunStatus.NOT_RUN).any():
        _say_how_to_go_on(store, arguments.typed)
        return INTERRUPTED
    return 0 if np.isin(status, FINISHED).all() else 1


def _say_how_to_go_on(store: Path | None, typed: list[str]) -> None:
    """Say how a study that was interrupted goes on."""
    words = ["rockframe", *typed]
    told = "this goes on with it"
    if store is None:
        words += ["--store", "study"]
        told = "it has no store, so that all has to be run again; with one it could go on"
    tell("rockframe study", f"interrupted; {told}: {shlex.join(words)}")
