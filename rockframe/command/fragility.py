"""``rockframe fragility``: the probability that a scene overturns at an intensity."""

import argparse
from pathlib import Path
from typing import Any, Final

import xarray as xr

from rockframe.command.analysis_inputs import SCALE, scene_and_motions, typed_intensity
from rockframe.command.answer import Answer
from rockframe.command.files.studies import AXES, CASES
from rockframe.command.plot import PICTURE_KIND, finish_analysis
from rockframe.command.shared import (
    Outputs,
    amount_text,
    analysis_kind,
    is_result,
    part_names,
    read_result,
    run_analysis,
    with_project,
)
from rockframe.errors import FileError, StudyError
from rockframe.reports.project import PROJECT_ATTRIBUTE
from rockframe.results.variables.analyses import FragilityStatus
from rockframe.results.variables.variable import flag_words
from rockframe.studies import fragility, open_study, sweep
from rockframe.studies.sweeps.case import NOT_GIVEN

_RESULT_KIND: Final = analysis_kind("a fragility", "exceedance_probability", "fragility_status")
_MOTION_MISSING: Final = (
    "is not in this result; name the store of the study, which keeps its records, instead of the "
    "result, or run it again with --store"
)
_DEFAULT_SCALES: Final = [0.25 * k for k in range(1, 17)]
"""Scales of the motions, if neither the file nor the command line has any."""


def execute(arguments: argparse.Namespace, answer: Answer) -> int:
    """Run a scene under many motions, or read finished runs, and fit fragilities."""
    known = is_result(arguments.scene)
    found = None if known else scene_and_motions(arguments)
    read = [arguments.scene, *arguments.records] if found is None else found.files
    outputs = Outputs(arguments, read, answer, output=_RESULT_KIND, picture=PICTURE_KIND)
    if found is None:
        runs = _runs_of_study(arguments)
    else:
        values: dict[str, Any] = {"store": found.store, **found.arguments}
        if AXES not in values and CASES not in values:
            values[AXES] = {SCALE: _DEFAULT_SCALES}
        try:
            runs = run_analysis(sweep, found, found.motions, values, arguments)
        except StudyError as problem:
            raise found.at_lines(problem) from problem
    try:
        dataset = fragility(runs, **typed_intensity(arguments, fragility))
    except StudyError as problem:
        if not known or NOT_GIVEN not in str(problem):
            raise
        words = (
            str(problem).removeprefix(f"{fragility.__name__}: ").replace(NOT_GIVEN, _MOTION_MISSING)
        )
        raise FileError(arguments.scene, words) from problem
    dataset = with_project(dataset, str(runs.attrs.get(PROJECT_ATTRIBUTE, "")))
    answer.add_result("Verdict", dataset.attrs["verdict"])
    if "median_intensity" in dataset and dataset["median_intensity"].dims == ("limit_state",):
        for state, row in dataset.groupby("limit_state", squeeze=False):
            answer.add_text(_limit_state_line(str(state), row.squeeze("limit_state")))
    if found is not None:
        answer.add_context("Scene", part_names(found.system))
    answer.add_context("Runs", str(runs.attrs["verdict"]))
    return finish_analysis(dataset, arguments, answer, outputs, runs)


def _runs_of_study(arguments: argparse.Namespace) -> xr.Dataset:
    """Read the runs of a study, from its file or its store."""
    more = (
        "records", "unit", "time_step", "scales", "store", "accuracy", "free_vibration", "duration",
    )  # fmt: skip
    if any(getattr(arguments, name) for name in more):
        words = "its runs are finished; records, scales, a store or durations go with a scene"
        raise FileError(arguments.scene, f"this is a result: {words}")
    if Path(arguments.scene).expanduser().is_dir():
        return open_study(arguments.scene)
    return read_result(arguments.scene)


def _limit_state_line(state: str, row: xr.Dataset) -> str:
    """Write the median and dispersion of a limit state."""
    median = row["median_intensity"]
    status = row["fragility_status"]
    words = flag_words(status.attrs)[int(status)].replace("_", " ")
    if bool(median.isnull()):
        return f"  {state}: no fit, {words}"
    if int(status) != FragilityStatus.FITTED:
        return f"  {state}: median about {amount_text(float(median), median.attrs)}, {words}"
    dispersion = float(row["dispersion"])
    return (
        f"  {state}: median {amount_text(float(median), median.attrs)}, dispersion {dispersion:.3g}"
    )
