"""The schema, one table of all variables of results: name, unit, dimensions and meaning.

Also the labelled dataset that is built from it; all datasets of results are built here.
"""

from collections.abc import Mapping
from datetime import UTC, datetime
from typing import Any, Final, TypeAlias

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from rockframe.constants import CONVENTIONS, PAPER_TITLE
from rockframe.errors import SchemaError
from rockframe.results.variables import analyses, bodies, motions, requests, runs, studies
from rockframe.results.variables.variable import Variable
from rockframe.signals.arrays import AnyArray
from rockframe.units import Measure, Unit, decimal_products, read_number
from rockframe.version import __version__

_TABLES: Final = (
    runs.HISTORIES,
    runs.HELD,
    runs.MODES,
    requests.POINT_LABELS,
    runs.MOTION_AFTER_END,
    runs.ENERGY_HISTORIES,
    bodies.BODIES,
    bodies.RESTRAINERS,
    bodies.RESTRAINER_SCALARS,
    requests.ACCELERATIONS,
    requests.REACTIONS,
    requests.OTHERS,
    requests.IMPULSES,
    requests.POINTS,
    requests.POINT_PEAKS,
    requests.SLIPS,
    runs.EVENTS_AND_SCALARS,
    requests.FORCE_SCALARS,
    runs.CERTIFICATE,
    runs.PROOF,
    runs.REST,
    motions.MEASURES,
    motions.DIRECTIONS,
    motions.RECORDS,
    motions.TARGETS,
    studies.COMPARISON,
    studies.CRITICAL_SCALE,
    studies.SWEEP,
    analyses.CLOUD,
    analyses.DYNAMIC_ANALYSIS,
    analyses.FRACTILES,
    analyses.FRAGILITY,
    analyses.MEASURE_COMPARISON,
    analyses.OVERTURNING_MAP,
    analyses.SPECTRA,
    analyses.PROBABILITY,
    analyses.SUBSETS,
    analyses.ENSEMBLE,
    analyses.HAZARD,
    analyses.SEQUENCES,
    studies.FREE_DECAY,
)

SCHEMA: Final = {row.name: row for table in _TABLES for row in table}
"""All variables by name, including those that users have registered."""


def schema_row(name: str) -> Variable:
    """Return the row of a variable."""
    row = SCHEMA.get(name)
    if row is None:
        msg = f"{name!r} is not in the schema of results"
        raise SchemaError(msg)
    return row


LABELS: Final = ("point_x", "point_y", studies.MESSAGE, "rotation_limit")
"""Further coordinates: variables that label a case, or a dimension of another name. Arithmetic on
datasets leaves coordinates alone."""

ENERGIES: Final = tuple(row.name for row in runs.ENERGY_HISTORIES)
"""Histories that are integrated only on request."""

GROUPS: Final = {
    "energy": ENERGIES,
    "acceleration": tuple(row.name for row in requests.ACCELERATIONS),
    "reaction": tuple(row.name for row in requests.REACTIONS),
    "impulse": tuple(row.name for row in requests.IMPULSES),
}
"""Names in `outputs` that stand for several variables."""

ON_REQUEST: Final = (
    *(name for group in GROUPS.values() for name in group),
    *(row.name for row in requests.OTHERS),
)
"""All variables that are given only on request."""

SCHEMA_VERSION: Final = 3

Results: TypeAlias = Mapping[str, AnyArray | float | int | bool]
"""Results by their names in the schema."""

SOURCE: Final = "event-driven integration"
"""Method by which the numbers of runs are computed, in the attribute `source`."""


def build_dataset(
    values: Results,
    attributes: Mapping[str, str | float | int],
    *,
    over: tuple[str, ...] = (),
    title: str = "Rocking response",
    source: str = SOURCE,
) -> xr.Dataset:
    """Label values by the schema and add the provenance that every result has.

    The dimensions `over` stand before those of the schema, as for the axes of a sweep.
    """
    variables: dict[str, tuple[tuple[str, ...], NDArray[Any]]] = {}
    labels: dict[str, dict[str, Any]] = {}
    for name, value in values.items():
        row = schema_row(name)
        data = np.asarray(value)
        gaps = data.dtype.kind == "f" and row.dtype != "float64" and bool(np.isnan(data).any())
        data = data if gaps else np.asarray(data, dtype=row.dtype)
        dims = (*over, *row.dims)
        if data.ndim != len(dims):
            msg = f"{name!r} needs the dimensions {dims}, got an array of shape {data.shape}"
            raise SchemaError(msg)
        variables[name] = (dims, data)
        labels[name] = row.attributes("float64" if gaps else None)
    names = [name for name in variables if SCHEMA[name].dims == (name,) or name in LABELS]
    coordinates = {name: variables.pop(name) for name in sorted(names, key=[*SCHEMA].index)}
    dataset = xr.Dataset(
        variables,
        coords=coordinates,
        attrs={
            "Conventions": CONVENTIONS,
            "title": title,
            "history": history_line("computed"),
            "source": f"rockframe {__version__}, {source}",
            "references": PAPER_TITLE,
            "rockframe_version": __version__,
            "schema_version": SCHEMA_VERSION,
            **attributes,
        },
    )
    # labelled in place, since xarray copies each variable that is given to it with attributes
    for name, label in labels.items():
        dataset.variables[name].attrs = label
    return without_fill_values(dataset)


def with_variables(
    dataset: xr.Dataset, values: Results, *, over: tuple[str, ...] = ()
) -> xr.Dataset:
    """Add variables, labelled by the schema, to a dataset; its attributes stay."""
    added = build_dataset(values, {}, over=over)
    return dataset.assign(added.data_vars).assign_coords(added.coords)


def with_labels(dataset: xr.Dataset, labels: Mapping[str, Any]) -> xr.Dataset:
    """Add coordinates that have their own attributes, such as axes, to a dataset."""
    return without_fill_values(dataset.assign_coords(labels))


def without_fill_values(dataset: xr.Dataset) -> xr.Dataset:
    """Mark coordinates as without fill value: they have no missing values (CF 2.5.1)."""
    for name in dataset.coords:
        dataset.variables[name].encoding["_FillValue"] = None
    return dataset


def labels_in_unit(labels: xr.DataArray, unit: str | None, *, owner: str) -> xr.DataArray:
    """Return the labels of an axis in its unit, if a user has converted them to another one."""
    current = labels.attrs.get("units")
    if unit is None or current in (None, unit):
        return labels
    measure = Measure("a value", Unit(unit), f"1 {unit}")
    factor = read_number(f"1 {current}", measure, owner=owner, name=str(labels.name))
    numbers = decimal_products(np.ravel(labels).astype(float).tolist(), factor)
    converted, attributes = np.reshape(numbers, labels.shape), {**labels.attrs, "units": unit}
    return xr.DataArray(converted, labels.coords, labels.dims, labels.name, attributes)


def in_units_of_schema(dataset: xr.Dataset, *, owner: str) -> xr.Dataset:
    """Return variables in their units, if a user has converted them, for example for a figure."""
    converted = {
        name: labels_in_unit(dataset[name], SCHEMA[str(name)].unit, owner=owner).variable
        for name in dataset.variables
        if name in SCHEMA and name not in dataset.indexes
    }
    # such as the places of points
    coords = {name: converted.pop(name) for name in list(converted) if name in dataset.coords}
    return dataset.assign(converted).assign_coords(coords)


def checked_results(values: Mapping[str, Any], sizes: Mapping[str, int]) -> dict[str, NDArray[Any]]:
    """Return results of users' functions as arrays; refuse shapes that differ from the schema."""
    sizes, results = dict(sizes), {name: np.asarray(value) for name, value in values.items()}
    for name, data in results.items():
        dims = schema_row(name).dims
        expected = tuple(sizes.setdefault(*size) for size in zip(dims, data.shape, strict=False))
        if data.ndim != len(dims) or data.shape != expected:
            msg = f"{name!r} over {dims} has the shape {data.shape}"
            raise SchemaError(f"{msg}, expected {expected}" if len(expected) == len(dims) else msg)
    return results


def history_line(done: str) -> str:
    """Return a line for a dataset's history: when something was done, and by which version."""
    now = datetime.now(UTC).strftime("%Y-%m-%dT%H:%M:%SZ")
    return f"{now} {done} by rockframe {__version__}"
