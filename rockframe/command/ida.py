"""``rockframe ida``: records that are scaled until a scene overturns."""

import argparse
from typing import Any, Final

from rockframe.command.answer import Answer
from rockframe.command.files.studies import AXES, CASES, KNOWN
from rockframe.command.over_motions import SCALE, scene_and_motions, typed_intensity
from rockframe.command.plot import PICTURE, concluded
from rockframe.command.run import finished
from rockframe.command.shared import (
    Outputs,
    analysed,
    analysis_kind,
    printed,
    system_words,
    table_kind,
    taken_by,
    typed_options,
)
from rockframe.errors import FileError
from rockframe.results.table import table
from rockframe.studies import fragility, incremental_dynamic_analysis

_RESULT: Final = analysis_kind("the result of a dynamic analysis", "capacity_scale", "flip_count")
_TABLE: Final = table_kind("a table of capacities", "limit_state", "motion", "capacity_scale")
_SHOWN: Final = ("capacity_scale", "flip_count")
"""Variables that are printed for each record."""
_MOST_SHOWN: Final = 40
"""Largest number of rows of a table that is printed."""
_USUAL: Final = "PGA"


def execute(arguments: argparse.Namespace, answer: Answer) -> int:
    """Scale motions until they overturn, and report the capacity under each."""
    found = scene_and_motions(arguments)
    kinds = {"output": _RESULT, "picture": PICTURE, "csv": _TABLE}
    outputs = Outputs(arguments, found.files, answer, **kinds)
    axes = {**found.arguments.get(AXES, {})}
    if CASES in found.arguments:
        words = "a dynamic analysis has axes, and no table of cases"
        raise FileError(arguments.scene, f"{words}; 'fragility' fits each structure")
    if KNOWN in found.arguments:
        raise FileError(arguments.scene, f"a dynamic analysis takes no {KNOWN!r} stores")
    values: dict[str, Any] = {
        "intensity": _USUAL,
        "store": found.store,
        **taken_by(incremental_dynamic_analysis, found.arguments),
        **({SCALE: axes.pop(SCALE)} if SCALE in axes else {}),
        AXES: axes,
        **typed_intensity(arguments, incremental_dynamic_analysis),
    }
    dataset = analysed(incremental_dynamic_analysis, found, found.motions, values, arguments)
    answer.says("Verdict", dataset.attrs["verdict"])
    answer.subject("Scene", system_words(found.system))
    fitted = fragility(dataset, dataset.attrs["intensity"], trials="capacities",
                       **typed_options(arguments, "period"))  # fmt: skip
    answer.says("Fit", fitted.attrs["verdict"])
    capacities = table(dataset[list(_SHOWN)].drop_vars("rotation_limit"))
    if len(capacities) <= _MOST_SHOWN:
        answer.text(printed(capacities))
    outputs.table(capacities)
    concluded(dataset, arguments, answer, outputs)
    return 0 if finished(dataset) else 1
