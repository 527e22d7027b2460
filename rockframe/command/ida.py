"""``rockframe ida``: records that are scaled until a scene overturns."""

import argparse
from typing import Any, Final

from rockframe.command.analysis_inputs import SCALE, scene_and_motions, typed_intensity
from rockframe.command.answer import Answer
from rockframe.command.files.studies import AXES, CASES, KNOWN
from rockframe.command.plot import PICTURE_KIND, finish_analysis
from rockframe.command.shared import (
    Outputs,
    analysis_kind,
    arguments_accepted_by,
    part_names,
    run_analysis,
    table_kind,
    typed_options,
)
from rockframe.errors import FileError
from rockframe.results.table import table
from rockframe.studies import fragility, incremental_dynamic_analysis

_RESULT_KIND: Final = analysis_kind(
    "the result of a dynamic analysis", "capacity_scale", "flip_count"
)
_TABLE_KIND: Final = table_kind("a table of capacities", "limit_state", "motion", "capacity_scale")
_PRINTED_VARIABLES: Final = ("capacity_scale", "flip_count")
"""Variables that are printed for each record."""
_DEFAULT_INTENSITY: Final = "PGA"


def execute(arguments: argparse.Namespace, answer: Answer) -> int:
    """Scale motions until they overturn, and report the capacity under each."""
    found = scene_and_motions(arguments)
    kinds = {"output": _RESULT_KIND, "picture": PICTURE_KIND, "csv": _TABLE_KIND}
    outputs = Outputs(arguments, found.files, answer, **kinds)
    axes = {**found.arguments.get(AXES, {})}
    if CASES in found.arguments:
        words = "a dynamic analysis has axes, and no table of cases"
        raise FileError(arguments.scene, f"{words}; 'fragility' fits each structure")
    if KNOWN in found.arguments:
        raise FileError(arguments.scene, f"a dynamic analysis takes no {KNOWN!r} stores")
    values: dict[str, Any] = {
        "intensity": _DEFAULT_INTENSITY,
        "store": found.store,
        **arguments_accepted_by(incremental_dynamic_analysis, found.arguments),
        **({SCALE: axes.pop(SCALE)} if SCALE in axes else {}),
        AXES: axes,
        **typed_intensity(arguments, incremental_dynamic_analysis),
    }
    dataset = run_analysis(incremental_dynamic_analysis, found, found.motions, values, arguments)
    answer.add_result("Verdict", dataset.attrs["verdict"])
    answer.add_context("Scene", part_names(found.system))
    fitted = fragility(dataset, dataset.attrs["intensity"], trials="capacities",
                       **typed_options(arguments, "period"))  # fmt: skip
    answer.add_result("Fit", fitted.attrs["verdict"])
    capacities = table(dataset[list(_PRINTED_VARIABLES)].drop_vars("rotation_limit"))
    answer.add_table(capacities)
    outputs.write_table(capacities)
    return finish_analysis(dataset, arguments, answer, outputs)
