"""Labelling answers that have axes of their own: oscillators and frequencies."""

from collections.abc import Mapping
from typing import TYPE_CHECKING

import xarray as xr

from rockframe.results.dataset import build_dataset
from rockframe.results.schema import SCHEMA

if TYPE_CHECKING:
    from rockframe.signals.arrays import Array


def build_over(
    axes: "Mapping[str, tuple[Array, str]]",
    values: "Mapping[str, Array]",
    attributes: Mapping[str, str | float | int],
    *,
    over: tuple[str, ...] = (),
    title: str,
    source: str,
) -> xr.Dataset:
    """Label values, and give their dimensions coordinates.

    The axes have the names and units of the schema's rows for a system's modes, where
    these are variables over ``mode``.

    Parameters
    ----------
    axes : mapping
        Coordinate and its meaning, by the dimension's name.
    values : mapping
        Arrays by their names in the schema.
    attributes : mapping
        Strings and numbers.
    over : tuple of str, optional
        Dimensions that all values have before their own.
    title, source : str
        What the dataset holds, and how it was computed.

    Returns
    -------
    xarray.Dataset
    """
    dataset = build_dataset(values, attributes, over=over, title=title, source=source)
    for name, (axis, meaning) in axes.items():
        labels = {**SCHEMA[name].attributes(), "long_name": meaning}
        dataset = dataset.assign_coords({name: (name, axis.copy(), labels)})
        # a coordinate has no missing values, so it needs no fill value (CF 2.5.1)
        dataset[name].encoding["_FillValue"] = None
    return dataset
