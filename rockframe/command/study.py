"""``rockframe study``: many runs of a scene."""

import argparse
import sys
from pathlib import Path
from typing import Final

import numpy as np
import xarray as xr

from rockframe.command.files.studies import DescribedStudy, read_study
from rockframe.command.given import check_folder, printed, system_words, written
from rockframe.command.run import FINISHED
from rockframe.errors import FileError, StudyError
from rockframe.results.table import table
from rockframe.results.variables.runs import RunStatus
from rockframe.studies import sweep

_SHOWN: Final = ("status", "peak_relative_rotation", "overturned")
"""What the printed table has of each case."""
_MOST_SHOWN: Final = 40
"""Rows up to which the table is printed."""


def execute(arguments: argparse.Namespace) -> int:
    """Carry out a study, or what is left of it."""
    check_folder(arguments.output)
    check_folder(arguments.csv)
    found = read_study(arguments.study)
    store = found.store if arguments.store is None else Path(arguments.store).expanduser()
    print(f"Scene:   {system_words(found.system)}")
    try:
        runs = sweep(found.system, found.motions, store=store, **found.arguments)
    except StudyError as problem:
        raise FileError(arguments.study, [(None, str(problem))]) from problem
    print(f"Verdict: {runs.attrs['verdict']}")
    values = table(runs)
    if len(values) <= _MOST_SHOWN:
        wanted = [head for head in values if str(head).split(" [")[0] in _SHOWN]
        print(printed(values[wanted]))
    if arguments.csv is not None:
        values.to_csv(Path(arguments.csv).expanduser())
        print(f"Table: {arguments.csv}")
    _write(runs, arguments.output, found)
    return _judged(runs, arguments.study, store)


def _write(runs: xr.Dataset, path: str | None, found: DescribedStudy) -> None:
    named = path if path is not None else found.output
    written(runs, None if named is None else str(named))


def _judged(runs: xr.Dataset, study: str, store: Path | None) -> int:
    """Give the exit code, and say how a study that was interrupted goes on."""
    status = runs["status"].to_numpy()
    if (status == RunStatus.NOT_RUN).any():
        again = f"'rockframe study {study}' goes on with it"
        lost = "it has no store, so that all has to be run again"
        print(f"rockframe study: {lost if store is None else again}", file=sys.stderr)
    return 0 if np.isin(status, FINISHED).all() else 1
