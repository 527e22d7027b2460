"""``rockframe run``: simulates a scene under a motion."""

import argparse
from typing import Final

import numpy as np
import xarray as xr

from rockframe.command.answer import Answer
from rockframe.command.shared import RUN_KIND, Outputs, part_names, scene_from, simulate_scene
from rockframe.results.variables.runs import RunStatus
from rockframe.simulation.provenance import motion_words

_FINISHED_STATUSES: Final = (RunStatus.COMPLETED, RunStatus.OVERTURNED, RunStatus.TOPPLED)


def execute(arguments: argparse.Namespace, answer: Answer) -> int:
    """Simulate, and report the verdict."""
    found = scene_from(arguments)
    outputs = Outputs(arguments, found.files, answer, output=RUN_KIND)
    response = simulate_scene(found)
    answer.add_context("Scene", f"{part_names(found.system)} ({response.attrs['model']})")
    answer.add_context("Motion", motion_words(response.attrs))
    answer.add_result("Verdict", response.attrs["verdict"])
    for name in ("certificate", "proof"):
        if name in response.attrs:
            answer.add_result(name.capitalize(), response.attrs[name])
    answer.add_numbers(response)
    outputs.write_result(response)
    return 0 if is_finished(response) else 1


def is_finished(response: xr.Dataset) -> bool:
    """Whether a run, or each run of a study, was finished."""
    return bool(np.isin(response["status"], _FINISHED_STATUSES).all())
