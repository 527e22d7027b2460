"""``rockframe run``: simulates a scene under a motion."""

import argparse
from typing import Final

import numpy as np
import xarray as xr

from rockframe.command.answer import Answer
from rockframe.command.shared import RUN, Outputs, scene_from, simulated, system_words
from rockframe.results.variables.runs import RunStatus
from rockframe.simulation.provenance import motion_words

_FINISHED: Final = (RunStatus.COMPLETED, RunStatus.OVERTURNED, RunStatus.TOPPLED)


def execute(arguments: argparse.Namespace, answer: Answer) -> int:
    """Simulate, and report the verdict."""
    found = scene_from(arguments)
    outputs = Outputs(arguments, found.files, answer, output=RUN)
    response = simulated(found)
    answer.subject("Scene", f"{system_words(found.system)} ({response.attrs['model']})")
    answer.subject("Motion", motion_words(response.attrs))
    answer.says("Verdict", response.attrs["verdict"])
    for name in ("certificate", "proof"):
        if name in response.attrs:
            answer.says(name.capitalize(), response.attrs[name])
    answer.numbers(response)
    outputs.result(response)
    return 0 if finished(response) else 1


def finished(response: xr.Dataset) -> bool:
    """Whether a run, or each run of a study, was finished."""
    return bool(np.isin(response["status"], _FINISHED).all())
