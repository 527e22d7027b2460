"""Building the labelled dataset; the only maker of result datasets."""

from collections.abc import Mapping
from datetime import UTC, datetime
from typing import Any, Final

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from rockframe.constants import CONVENTIONS, PAPER_TITLE
from rockframe.errors import SchemaError
from rockframe.results.outcome import Values
from rockframe.results.schema import COORDINATES, SCHEMA_VERSION, schema_row
from rockframe.version import __version__

SOURCE: Final = "event-driven integration"
"""Where the numbers of runs are from, beside the version."""


def build_dataset(
    values: Values,
    attributes: Mapping[str, str | float | int],
    *,
    over: tuple[str, ...] = (),
    title: str = "Rocking response",
    source: str = SOURCE,
) -> xr.Dataset:
    """Label values by the schema and add the provenance every result carries."""
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
    own = [name for name in variables if schema_row(name).dims == (name,)]  # labels
    names = dict.fromkeys((*COORDINATES, *own))
    coordinates = {name: variables.pop(name) for name in names if name in variables}
    dataset = xr.Dataset(
        variables,
        coords=coordinates,
        attrs={
            "Conventions": CONVENTIONS,
            "title": title,
            "history": dated("computed"),
            "source": f"rockframe {__version__}, {source}",
            "references": PAPER_TITLE,
            "rockframe_version": __version__,
            "schema_version": SCHEMA_VERSION,
            **attributes,
        },
    )
    # labelled in place, since xarray copies each variable that it is handed with attributes
    for name, label in labels.items():
        dataset.variables[name].attrs = label
    for name in coordinates:
        # a coordinate has no missing values, so it needs no fill value (CF 2.5.1)
        dataset.variables[name].encoding["_FillValue"] = None
    return dataset


def fitting(values: Mapping[str, Any], sizes: Mapping[str, int]) -> dict[str, NDArray[Any]]:
    """Give values that users' own functions gave, where their shapes are those of the schema."""
    sizes, found = dict(sizes), {name: np.asarray(value) for name, value in values.items()}
    for name, data in found.items():
        dims = schema_row(name).dims
        wanted = tuple(sizes.setdefault(*each) for each in zip(dims, data.shape, strict=False))
        if data.ndim != len(dims) or data.shape != wanted:
            msg = f"{name!r} over {dims} has the shape {data.shape}"
            raise SchemaError(f"{msg}, expected {wanted}" if len(wanted) == len(dims) else msg)
    return found


def dated(done: str) -> str:
    """Give a line of a dataset's history: when, and what was done by which version."""
    now = datetime.now(UTC).strftime("%Y-%m-%dT%H:%M:%SZ")
    return f"{now} {done} by rockframe {__version__}"
