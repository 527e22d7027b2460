"""``rockframe critical``: the least scale of a motion at which a scene overturns."""

import argparse
from typing import Any, Final

from rockframe.command.answer import Answer
from rockframe.command.plot import PICTURE, concluded
from rockframe.command.shared import (
    Outputs,
    analysed,
    analysis_kind,
    in_words,
    scene_from,
    system_words,
    taken_by,
    typed_options,
)
from rockframe.simulation.provenance import motion_words
from rockframe.studies import critical_scale

_RESULT: Final = analysis_kind("the result of a critical scale", "critical_scale", "scale_above")
_USUAL: Final = "PGA"
_FIRST: Final = 80
"""Largest number of scales that are tried first."""


def execute(arguments: argparse.Namespace, answer: Answer) -> int:
    """Find the least scale that overturns, and report the intensity at this scale."""
    found = scene_from(arguments, moved=True)
    outputs = Outputs(arguments, found.files, answer, output=_RESULT, picture=PICTURE)
    values: dict[str, Any] = {
        "intensity": _USUAL,
        **typed_options(arguments, "largest", "runs", "intensity", "period"),
        **taken_by(critical_scale, found.run),
    }
    if arguments.runs is not None:
        values["scales"] = max(2, min(arguments.runs, _FIRST))
    dataset = analysed(critical_scale, found, found.motion, values, arguments)
    answer.subject("Scene", f"{system_words(found.system)} ({dataset.attrs['model']})")
    answer.subject("Motion", motion_words(dataset.attrs))
    answer.says("Verdict", dataset.attrs["verdict"])
    measure = dataset[dataset.attrs["intensity"]]
    if bool(measure.notnull()):
        answer.says("Shaking", f"{in_words(measure, dataset)} at the critical scale")
    return concluded(dataset, arguments, answer, outputs)
