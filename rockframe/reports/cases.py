"""Tables of the cases of a study: the verdict on each, and its largest forces."""

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any, Final

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from rockframe.reports import page
from rockframe.reports.values import column_title, format_number, format_value
from rockframe.results.outcome import overturned_from_status
from rockframe.results.variables.runs import RunStatus
from rockframe.results.variables.studies import MESSAGE
from rockframe.results.variables.variable import TIME
from rockframe.simulation.run import NONE
from rockframe.units import Unit
from rockframe.units.display import DisplayUnits, unit_suffix, with_superscripts

MAX_ROWS: Final = 300
"""Largest number of rows of a table of cases; of more cases it has the worst ones."""
_MOTION_VARIABLES: Final = (
    "peak_rotation",
    "peak_relative_rotation",
    "peak_body_rotation",
    "impact_count",
    "first_uplift_time",
    "peak_friction_demand",
    "peak_slip",
    "residual_slip",
    "peak_body_slip",
    "peak_cap_slip",
    "peak_ground_acceleration",
    "peak_ground_velocity",
)
_FORCE_VARIABLES: Final = (
    "peak_base_shear",
    "peak_restrainer_force",
    "broken_restrainer_count",
    "left_reaction",
    "right_reaction",
    "soil_reaction",
    "vertical_reaction",
    "horizontal_reaction",
    "base_overturning_moment",
    "toe_pressure",
    "peak_point_horizontal_displacement",
    "peak_point_vertical_displacement",
    "peak_point_horizontal_acceleration",
    "peak_point_vertical_acceleration",
)
COLUMNS: Final = (*_MOTION_VARIABLES, *_FORCE_VARIABLES)
"""Variables that the tables show if a study has them, in this order.

Of histories, such as reactions, the largest absolute value at the samples is shown.
"""
_CAPACITY_VARIABLES: Final = ("capacity_scale", "capacity_resolution", "flip_count")
"""Variables of a dynamic analysis along its limit states and motions."""
_MAX_COLUMNS: Final = 8
"""Largest number of columns besides the labels of a case, on a sheet of A4."""
_STATISTICS: Final = (("mean", np.mean), ("largest", np.max))


@dataclass(frozen=True)
class _Column:
    """Numbers of all cases, in SI units."""

    head: str
    unit: str
    values: NDArray[np.float64]  # shape (cases,)


def case_tables(dataset: xr.Dataset, units: DisplayUnits) -> Iterator[str]:
    """Return a row for each case, or for the worst ones if there are too many, and the extremes."""
    count = dataset["status"].size
    order = np.arange(count)
    if count > MAX_ROWS:
        order = order_from_worst(dataset)[:MAX_ROWS]
        yield page.paragraph(f"The {order.size} worst of {count} cases.", kind="soft")
    for columns in _split_columns(_columns(dataset, _MOTION_VARIABLES, units)):
        yield _table(dataset, order, columns, units, with_verdict=True)
    forces = _split_columns(_columns(dataset, _FORCE_VARIABLES, units))
    if forces:
        yield page.subtitle("Forces, and motion of points")
    for columns in forces:
        yield _table(dataset, order, columns, units, with_verdict=False)


def _split_columns(columns: Iterable[_Column]) -> list[list[_Column]]:
    """Divide columns evenly among tables that fit on a sheet."""
    several = list(columns)
    tables = -(-len(several) // _MAX_COLUMNS)
    size = -(-len(several) // max(1, tables))
    return [several[k : k + size] for k in range(0, len(several), max(1, size))]


def _verdict(dataset: xr.Dataset, place: int) -> str:
    """Return the verdict on a case, or the status of an unfinished run."""
    at = _indices(dataset["status"], place)
    status = dataset["status"].isel(at)
    overturned = bool(overturned_from_status(status.to_numpy()) == 1.0)
    if status.item() == RunStatus.COMPLETED:
        overturned = bool(dataset["overturned"].isel(at) == 1)
    elif not overturned:
        return format_value(status)
    care = MESSAGE in dataset.coords and dataset[MESSAGE].isel(at, missing_dims="ignore") != NONE
    return f"{'overturned' if overturned else 'did not overturn'}{', with care' * bool(care)}"


def _table(
    dataset: xr.Dataset,
    order: NDArray[np.intp],
    columns: Sequence[_Column],
    units: DisplayUnits,
    *,
    with_verdict: bool,
) -> str:
    """Return a table of columns, with their mean and largest values in the last rows."""
    status = dataset["status"]
    rows = list[list[str]]()
    for place in order.tolist():
        labels = [*label_texts(dataset, place, units).values()]
        if with_verdict:
            labels.append(_verdict(dataset, place))
        numbers = [
            format_number(float(column.values[place]), column.unit, units) for column in columns
        ]
        rows.append([*labels, *numbers])
    blanks = [""] * (len(status.dims) - 1 + with_verdict)
    for words, function in _STATISTICS:
        numbers = [_statistic(function, column, units) for column in columns]
        rows.append([f"{words} of {status.size}", *blanks, *numbers])
    titles = [str(dim).replace("_", " ") for dim in status.dims]
    verdict = ["verdict"] if with_verdict else []
    return page.number_table(rows, [*titles, *verdict, *(column.head for column in columns)])


def _statistic(function: Callable[..., Any], column: _Column, units: DisplayUnits) -> str:
    """Write a number of all cases, and of how many it is where some have none."""
    finite = column.values[~np.isnan(column.values)]
    number = format_number(float(function(finite)), column.unit, units)
    return number if finite.size == column.values.size else f"{number} (of {finite.size})"


def _columns(dataset: xr.Dataset, names: Sequence[str], units: DisplayUnits) -> Iterator[_Column]:
    """Return the columns of the variables that any case has; one for each of several bodies."""
    status = dataset["status"]
    for name in names:
        if name not in dataset or not set(status.dims) & set(dataset[name].dims):
            continue
        array, words = dataset[name], name
        if TIME[0] in array.dims:
            array, words = abs(array).max(TIME[0]), f"largest {name}"
        other_dims = [dim for dim in array.dims if dim not in status.dims]
        unit = str(dataset[name].attrs.get("units", Unit.ONE))
        for series in (
            array.stack(_other=other_dims).transpose("_other", ...) if other_dims else [array]
        ):
            values = series.drop_vars([*other_dims, "_other"], errors="ignore").broadcast_like(
                status
            )
            flat = values.transpose(*status.dims).to_numpy().astype(np.float64).ravel()
            if np.isfinite(flat).any():
                whose = "".join(
                    f" ({format_label(series[dim].item())})"
                    if dim in dataset.coords
                    else f" ({dim} {1 + series[dim].item()})"
                    for dim in other_dims
                )
                yield _Column(column_title(f"{words}{whose}", unit, units), unit, flat)


def capacity_table(dataset: xr.Dataset, units: DisplayUnits) -> Iterator[str]:
    """Return a row for each capacity of a dynamic analysis, or for the least if there are many."""
    name = _CAPACITY_VARIABLES[0]
    if name not in dataset:
        return
    capacity = dataset[name]
    order = np.arange(capacity.size)
    if capacity.size > MAX_ROWS:
        order = np.argsort(capacity.to_numpy().ravel(), kind="stable")[:MAX_ROWS]
        yield page.paragraph(f"The {order.size} least of {capacity.size} capacities.", kind="soft")
    flat = {
        variable: dataset[variable].broadcast_like(capacity).transpose(*capacity.dims)
        for variable in _CAPACITY_VARIABLES
        if variable in dataset
    }
    rows = list[list[str]]()
    for place in order.tolist():
        at = _indices(capacity, place)
        numbers = [format_value(values.isel(at), units) for values in flat.values()]
        rows.append([*label_texts(dataset, place, units, name).values(), *numbers])
    heads = [str(head).replace("_", " ") for head in (*capacity.dims, *flat)]
    yield page.number_table(rows, heads)
    meanings = "; ".join(
        f"{variable.replace('_', ' ')}: {dataset[variable].attrs['long_name']}" for variable in flat
    )
    yield page.paragraph(f"{meanings}.", kind="soft")


def order_from_worst(dataset: xr.Dataset) -> np.ndarray:
    """Order cases with a result: by time of overturning, then by decreasing peak rotation."""
    peak = dataset["peak_relative_rotation"].to_numpy().ravel()
    time = np.nan_to_num(dataset["overturning_time"].to_numpy().ravel(), nan=np.inf)
    overturned = overturned_from_status(dataset["status"].to_numpy().ravel()) == 1.0
    order = np.lexsort((-np.nan_to_num(peak, nan=-1.0), time, ~overturned))
    return order[np.isfinite(peak[order])]


def label_values(dataset: xr.Dataset, place: int, of: str = "status") -> dict[str, Any]:
    """Return the labels of a value of a variable by its place; usually those of a case."""
    values = dataset[of]
    return {
        dim: values[dim][k].item() if dim in values.coords else k
        for dim, k in _indices(values, place).items()
    }


def _indices(values: xr.DataArray, place: int) -> dict[str, int]:
    """Return the indices of a value of an array by its place."""
    indices = map(int, np.unravel_index(place, values.shape))
    return dict(zip(map(str, values.dims), indices, strict=True))


def label_texts(
    dataset: xr.Dataset, place: int, units: DisplayUnits, of: str = "status"
) -> dict[str, str]:
    """Write the labels of a value, usually those of a case, numbers with their units."""
    texts: dict[str, str] = {}
    for name, value in label_values(dataset, place, of).items():
        unit = units.of(str(dataset[name].attrs.get("units", Unit.ONE)) if name in dataset else "1")
        number = value / unit.size if isinstance(value, float) else value
        texts[name] = f"{format_label(number)}{unit_suffix(with_superscripts(unit.words))}"
    return texts


def format_label(value: object) -> str:
    """Write the label of a case."""
    return f"{value:.6g}" if isinstance(value, float) else str(value)
