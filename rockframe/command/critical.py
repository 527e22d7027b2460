"""``rockframe critical``: the least scale of a motion at which a scene overturns."""

import argparse
from typing import Any, Final

from rockframe.command.answer import Answer
from rockframe.command.plot import PICTURE_KIND, finish_analysis
from rockframe.command.shared import (
    Outputs,
    analysis_kind,
    arguments_accepted_by,
    intensity_text,
    part_names,
    run_analysis,
    scene_from,
    typed_options,
)
from rockframe.simulation.provenance import motion_words
from rockframe.studies import critical_scale

_RESULT_KIND: Final = analysis_kind(
    "the result of a critical scale", "critical_scale", "scale_above"
)
_DEFAULT_INTENSITY: Final = "PGA"
_MAX_FIRST_SCALES: Final = 80
"""Largest number of scales that are tried first."""


def execute(arguments: argparse.Namespace, answer: Answer) -> int:
    """Find the least scale that overturns, and report the intensity at this scale."""
    found = scene_from(arguments, needs_motion=True)
    outputs = Outputs(arguments, found.files, answer, output=_RESULT_KIND, picture=PICTURE_KIND)
    values: dict[str, Any] = {
        "intensity": _DEFAULT_INTENSITY,
        **typed_options(arguments, "largest", "runs", "intensity", "period"),
        **arguments_accepted_by(critical_scale, found.run),
    }
    if arguments.runs is not None:
        values["scales"] = max(2, min(arguments.runs, _MAX_FIRST_SCALES))
    dataset = run_analysis(critical_scale, found, found.motion, values, arguments)
    answer.add_context("Scene", f"{part_names(found.system)} ({dataset.attrs['model']})")
    answer.add_context("Motion", motion_words(dataset.attrs))
    answer.add_result("Verdict", dataset.attrs["verdict"])
    measure = dataset[dataset.attrs["intensity"]]
    if bool(measure.notnull()):
        answer.add_result("Shaking", f"{intensity_text(measure, dataset)} at the critical scale")
    return finish_analysis(dataset, arguments, answer, outputs)
