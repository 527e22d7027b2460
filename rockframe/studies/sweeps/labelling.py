"""The dataset of a sweep: its cases, as far as they have been run, with labels."""

import json
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any, Final

import numpy as np
import xarray as xr

from rockframe.results.joining import CASE_COUNT
from rockframe.results.points import BodyPoint, point_labels
from rockframe.results.schema import SCHEMA, build_dataset, with_variables, without_fill_values
from rockframe.results.variables.bodies import BODY, RESTRAINER
from rockframe.results.variables.requests import POINT_PEAKS
from rockframe.results.variables.runs import EVENTS_AND_SCALARS
from rockframe.results.variables.studies import CASE, MESSAGE, MOTION
from rockframe.results.variables.variable import TIME
from rockframe.signals.arrays import AnyArray
from rockframe.studies.sweeps.axes import Grid
from rockframe.studies.sweeps.chunk import DRIVER, SCREEN, CaseResults, CollectedResults, Driver
from rockframe.studies.sweeps.scenes import SystemScene
from rockframe.studies.sweeps.study import Histories, Study
from rockframe.studies.sweeps.words import SCREENING_VARIABLES, merge_similar_texts, whole_verdict

COMMON_SCALARS: Final = tuple(
    row.name for row in EVENTS_AND_SCALARS if not row.dims and row.name != "status"
)
"""Scalars that every run has."""
ALONE: Final = "each case alone"
SIDE_BY_SIDE: Final = (
    "cases side by side in lanes; alone those that are not finished, or whose energies, friction "
    "or ground need a closer look"
)
"""How cases were run."""


@dataclass(frozen=True, eq=False)
class SweepLabels:
    """All that describes a sweep except its results."""

    grid: Grid  # the cases
    motions: tuple[str, ...]  # names
    histories: Histories | None  # what is kept beside scalars
    points: tuple[BodyPoint, ...]  # at which there are peaks, and histories if they are kept
    attributes: Mapping[str, str | float | int]  # of the dataset


def sweep_labels(study: Study) -> SweepLabels:
    """Return the labels of a sweep."""
    arguments = study.arguments
    scene, grid = study.scene, study.grid
    attributes: dict[str, str | float | int] = {
        "accuracy": SCREEN if study.screened else arguments.accuracy_name,
        "run_json": json.dumps(arguments.to_dict()),
        "axes_json": json.dumps([axis.to_dict() for axis in (*grid.axes, *grid.columns)]),
        "motions_json": json.dumps(
            [None if motion is None else motion.to_dict() for motion in study.motions.values()]
        ),
        "motion_names": json.dumps(list(study.motions)),
        "study_sha256": study.digest,
    }
    if names := study.restrainers:
        attributes["restrainer_names"] = json.dumps(names)
    if study.period is not None:
        attributes["spectral_period"] = study.period
    if isinstance(scene, SystemScene):
        attributes["model"] = scene.assembly.setting.model
        attributes["system_json"] = scene.assembly.json
    else:
        attributes["function"] = scene.name
    return SweepLabels(grid, tuple(study.motions), study.histories, arguments.points, attributes)


def sweep_dataset(labels: SweepLabels, results: Iterable[tuple[range, CaseResults]]) -> xr.Dataset:
    """Label the results."""
    grid = labels.grid
    collected = CollectedResults(grid.count)  # in the order of running, with gaps
    for cases, part in results:
        collected.put_rows(slice(cases.start, cases.stop), part)
    rows = collected.rows()
    few, message = merge_similar_texts(rows.texts, rows.message)
    gaps = np.full((grid.count, len(labels.points)), np.nan)
    scalars = {
        name: gaps if SCHEMA[name].dims else np.full(grid.count, np.nan)
        for name in scalar_names(labels)
    }
    driver = _driver_words(rows.scalars.get(DRIVER, np.empty(0)))
    scalars |= rows.scalars
    rows.scalars.clear()  # arranged values need not be in memory twice
    values = {
        name: grid.in_dimension_order(scalars.pop(name)) for name in SCHEMA if name in scalars
    }
    values["status"] = grid.in_dimension_order(rows.status)
    # as objects, each text is stored once
    texts = np.array(few, dtype=object)[grid.in_dimension_order(message)]
    messages = xr.Variable(tuple(grid.sizes), texts, SCHEMA[MESSAGE].attributes())
    runs = build_dataset(values, {}, over=tuple(grid.sizes))
    attributes = {
        "verdict": whole_verdict(runs),
        CASE_COUNT: grid.count,
        "driver": driver,
        **labels.attributes,
    }
    dataset = dataset_without_results(labels, attributes).assign(runs.data_vars)
    if rows.histories:
        histories = {
            name: grid.in_dimension_order(rows.histories.pop(name))
            for name in SCHEMA
            if name in rows.histories
        }
        dataset = with_variables(dataset, histories, over=tuple(grid.sizes))
    return with_coordinates(dataset, labels, messages)


def scalar_names(labels: SweepLabels) -> tuple[str, ...]:
    """Return scalars, and peaks at points, that all cases have, also before any has been run."""
    screened = SCREENING_VARIABLES if labels.attributes["accuracy"] == SCREEN else ()
    peaks = tuple(row.name for row in POINT_PEAKS) if labels.points else ()
    return COMMON_SCALARS + screened + peaks


def dataset_without_results(
    labels: SweepLabels, attributes: Mapping[str, str | float | int]
) -> xr.Dataset:
    """Return the dataset of a sweep without its results."""
    sizes = labels.grid.sizes
    around: dict[str, Any] = {}
    if MOTION in sizes:
        around[MOTION] = np.array(labels.motions, dtype=object)
    if CASE in sizes:
        around[CASE] = np.arange(sizes[CASE])
    if labels.histories is not None:
        around[TIME[0]] = labels.histories.step * np.arange(labels.histories.count)
    if labels.points:
        around |= point_labels(labels.points)
    return build_dataset(around, attributes, title="Sweep of a rocking system")


def with_coordinates(dataset: xr.Dataset, labels: SweepLabels, message: xr.Variable) -> xr.Dataset:
    """Add the axes, and the messages of the cases."""
    dataset = dataset.assign_coords({**_coordinates(labels), MESSAGE: message})
    # the numbers of bodies, and the names of restrainers, that results are of
    coordinates: dict[str, Any] = {}
    if (count := dataset.sizes.get(BODY[0])) is not None:
        coordinates[BODY[0]] = 1 + np.arange(count)
    if (count := dataset.sizes.get(RESTRAINER[0])) is not None:
        names = json.loads(str(labels.attributes.get("restrainer_names", "[]")))
        if len(names) != count:
            names = [str(k + 1) for k in range(count)]
        coordinates[RESTRAINER[0]] = np.array(names, dtype=object)
    return without_fill_values(with_variables(dataset, coordinates))


def _coordinates(labels: SweepLabels) -> dict[str, xr.Variable]:
    grid = labels.grid
    coordinates: dict[str, xr.Variable] = {}
    for axis in (*grid.axes, *grid.columns):
        words = axis.values.dtype.kind == "U"
        values = axis.values.astype(object) if words else axis.values
        dim = axis.name if axis in grid.axes else CASE
        coordinates[axis.name] = xr.Variable(dim, values, axis.attributes())
    if grid.motion_column is not None:
        names = np.array(labels.motions, dtype=object)[grid.motion_column]
        coordinates[MOTION] = xr.Variable(CASE, names, SCHEMA[MOTION].attributes())
    return coordinates


def _driver_words(drivers: AnyArray) -> str:
    """Say how cases were run, from a `Driver` for each; NaN for those without a result."""
    words = SIDE_BY_SIDE if (drivers == Driver.IN_LANES).any() else ALONE
    as_python = int((drivers == Driver.AS_PYTHON).sum())
    if not as_python:
        return words
    which = "" if as_python == int(np.isfinite(drivers).sum()) else f" {as_python} of them"
    return f"{words},{which} in plain Python"
