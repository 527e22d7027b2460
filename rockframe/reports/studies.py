"""The sections of a report on many runs, or on what was read from them."""

import warnings
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, Final

import numpy as np
import xarray as xr

from rockframe import plot
from rockframe.errors import RockframeError, RockframeWarning, SchemaError
from rockframe.motion import GroundMotion
from rockframe.plot._checks import drawn_by
from rockframe.reports import page
from rockframe.reports.figures import figure_of
from rockframe.reports.project import Project
from rockframe.reports.values import column_head, number_in, powers_in_html, table_of, value_of
from rockframe.results.outcome import overturned_by
from rockframe.simulation.system import System
from rockframe.studies import case
from rockframe.studies.sweeps.words import cases_verdict
from rockframe.units.shown import ReaderUnits

MOST_ROWS: Final = 300
"""Of the table of cases; of more, those that are worst."""
_COLUMNS: Final = (
    "peak_rotation",
    "peak_relative_rotation",
    "impact_count",
    "first_uplift_time",
    "peak_friction_demand",
    "peak_slip",
    "residual_slip",
    "peak_base_shear",
    "peak_restrainer_force",
    "broken_restrainer_count",
    "peak_ground_acceleration",
    "peak_ground_velocity",
)
"""Variables of a sweep that its table shows where it holds them, in this order."""


def verdict_sections(
    dataset: xr.Dataset, about: Project, units: ReaderUnits, by_codes: Sequence[str] = ()
) -> Iterator[str]:
    """Give what became of all cases, what codes say, their figure and their numbers."""
    sentence = cases_verdict(dataset)
    verdict = [*about.conclusions()]
    if sentence:
        verdict.append(_banner(dataset, sentence))
    yield page.section("Verdict", [*verdict, *by_codes])
    figure = _figure(dataset)
    if figure:
        yield page.section("Figure", [figure])
    if _is_sweep(dataset):
        yield page.section("Cases", _cases(dataset, units))
    scalars = table_of(dataset, units=units)
    if scalars:
        yield page.section("Numbers", [page.rows(scalars)])
    limits = _of_limit_states(dataset, units)
    if limits:
        yield page.section("Limit states", limits)


def worst_case(
    dataset: xr.Dataset, motions: Mapping[str, GroundMotion]
) -> tuple[str, xr.Dataset, System] | None:
    """Simulate the case of a sweep that comes nearest to overturning, or overturns first."""
    if not _is_sweep(dataset):
        return None
    order = _from_worst(dataset)
    if not order.size:
        return None
    labels = _labels_at(dataset, int(order[0]))
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", RockframeWarning)  # they stand in the dataset
            found = case(dataset, motions=motions or None, **labels)
            run = found.simulate(outputs=())
    except RockframeError:  # such as of a function of another process, or without its motions
        return None
    named = ", ".join(
        f"{name.replace('_', ' ')} {_written(value)}" for name, value in labels.items()
    )
    system = found.system if found.motion is None else under(found.system, found.motion)
    return f"Simulated again: {named}." if named else "Simulated again.", run, system


def under(system: System, motion: GroundMotion) -> System:
    """Give a system with a motion of its own."""
    options: dict[str, Any] = dict(system.options.to_dict())
    return System(*system.parts.structural(), motion, **options)


def is_study(dataset: xr.Dataset) -> bool:
    """Tell many runs, and what was read from them."""
    try:
        return _is_sweep(dataset) or drawn_by(dataset) != "response"
    except SchemaError:
        return False


def _is_sweep(dataset: xr.Dataset) -> bool:
    needed = ("status", "peak_relative_rotation", "overturning_time")
    return all(name in dataset and dataset[name].dims for name in needed)


def _banner(dataset: xr.Dataset, sentence: str) -> str:
    if "status" not in dataset:
        return page.banner("Result", powers_in_html(sentence), "")
    fallen = overturned_by(dataset["status"].to_numpy())
    if (fallen == 1.0).any():
        return page.banner("Some cases overturned", sentence, "bad")
    if (fallen == 0.0).all():
        return page.banner("No case overturned", sentence, "good")
    return page.banner("Not all cases have a result", sentence, "doubt")


def _figure(dataset: xr.Dataset) -> str:
    """Draw a dataset with the function that draws its kind, where there is one."""
    try:
        drawn = getattr(plot, drawn_by(dataset))(dataset)
    except RockframeError:
        return ""
    return page.picture(figure_of(drawn), str(dataset.attrs.get("title", "The study")) + ".")


def _cases(dataset: xr.Dataset, units: ReaderUnits) -> Iterator[str]:
    """Give a row for each case, worst first where there are too many, and what all have."""
    dims = [str(dim) for dim in dataset["status"].dims]
    names = [name for name in _COLUMNS
             if name in dataset and set(dataset[name].dims) <= set(dims)
             and dataset[name].notnull().any()]  # fmt: skip
    flat = dataset[[*names, "status"]].broadcast_like(dataset["status"]).stack(_row=dims)
    count = flat.sizes["_row"]
    order = np.arange(count)
    if count > MOST_ROWS:
        order = _from_worst(dataset)[:MOST_ROWS]
        yield page.paragraph(f"The {order.size} worst of {count} cases.", kind="soft")
    heads = [column_head(name, _unit_of(dataset[name]), units) for name in names]
    rows = [_row(dataset, flat, int(place), names, units) for place in order]
    for words, over in (("mean", np.nanmean), ("largest", np.nanmax)):
        values = (float(over(dataset[name].to_numpy())) for name in names)
        numbers = (
            number_in(value, _unit_of(dataset[name]), units)
            for name, value in zip(names, values, strict=True)
        )
        rows.append([f"{words} of {count}", *[""] * len(dims[1:]), "", *numbers])
    yield page.columns(rows, [*(dim.replace("_", " ") for dim in dims), "verdict", *heads])


def _row(
    dataset: xr.Dataset, flat: xr.Dataset, place: int, names: list[str], units: ReaderUnits
) -> list[str]:
    labels = [_written(value) for value in _labels_at(dataset, place).values()]
    status = dataset["status"].isel(dict.fromkeys(dataset["status"].dims, 0)).copy()
    status.values = flat["status"].to_numpy()[place]
    values = (float(flat[name].to_numpy()[place]) for name in names)
    numbers = (
        number_in(value, _unit_of(dataset[name]), units)
        for name, value in zip(names, values, strict=True)
    )
    return [*labels, value_of(status), *numbers]


def _unit_of(values: xr.DataArray) -> str:
    return str(values.attrs.get("units", "1"))


def _from_worst(dataset: xr.Dataset) -> np.ndarray:
    """Order cases with a result: those that overturn, the first before the later ones; the rest."""
    share = dataset["peak_relative_rotation"].to_numpy().ravel()
    when = np.nan_to_num(dataset["overturning_time"].to_numpy().ravel(), nan=np.inf)
    fallen = overturned_by(dataset["status"].to_numpy().ravel()) == 1.0
    order = np.lexsort((-np.nan_to_num(share, nan=-1.0), when, ~fallen))
    return order[np.isfinite(share[order])]


def _labels_at(dataset: xr.Dataset, place: int) -> dict[str, Any]:
    """Give the labels of a case by its place."""
    status = dataset["status"]
    places = np.unravel_index(place, status.shape)
    return {str(dim): status[dim].to_numpy()[k].item() if dim in status.coords else int(k)
            for dim, k in zip(status.dims, places, strict=True)}  # fmt: skip


def _written(value: object) -> str:
    return f"{value:.6g}" if isinstance(value, float) else str(value)


def _of_limit_states(dataset: xr.Dataset, units: ReaderUnits) -> list[str]:
    """Give all numbers of a fragility, a row for each and a column for each limit state."""
    dim = "limit_state"
    if dim not in dataset.dims:
        return []
    rows = list[list[str]]()
    for name, values in dataset.data_vars.items():
        if values.dims == (dim,):
            words = str(values.attrs.get("long_name", name))
            rows.append([words, *(value_of(values.isel({dim: k}), units)
                                  for k in range(dataset.sizes[dim]))])  # fmt: skip
    return [page.columns(rows, ["", *map(str, dataset[dim].to_numpy())])]
