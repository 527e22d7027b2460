"""Numbers of datasets in words."""

import math
import re
from typing import Any, Final

import numpy as np
import xarray as xr

from rockframe.units import Unit

_TRUTH: Final = {"true": "yes", "false": "no"}
_GAP: Final = re.compile(r", NaN if .*$")
"""What a number says where there is none; here it is the word "none"."""
_POWER: Final = re.compile(r"\^(-?\d+)")
_ABOVE: Final = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


def value_of(variable: xr.DataArray) -> str:
    """Write a scalar with its unit; flags and truth values as words."""
    value: Any = variable.item()
    if "flag_values" in variable.attrs:
        places = np.atleast_1d(variable.attrs["flag_values"]).tolist()
        words = str(variable.attrs["flag_meanings"]).split()
        word = words[places.index(value)] if value in places else str(value)
        return _TRUTH.get(word, word.replace("_", " "))
    if variable.dtype == bool:
        return _TRUTH[str(value).lower()]
    if isinstance(value, str):
        return value
    if isinstance(value, float) and math.isnan(value):
        return "none"
    unit = str(variable.attrs.get("units", Unit.ONE))
    number = f"{value + 0.0:.4g}"  # no negative zero
    if unit == Unit.RADIAN:
        return f"{number} rad ({math.degrees(value):.3g}°)"
    return number if unit == Unit.ONE else f"{number} {powers_in_html(unit)}"


def powers_in_html(unit: str) -> str:
    """Write the powers of a unit above the line."""
    return _POWER.sub(lambda power: power[1].translate(_ABOVE), unit)


def table_of(dataset: xr.Dataset, names: list[str] | None = None) -> list[tuple[str, str]]:
    """Give the meaning and the value of scalars."""
    chosen = [str(name) for name in dataset.data_vars] if names is None else names
    return [
        (_GAP.sub("", str(dataset[name].attrs.get("long_name", name))), value_of(dataset[name]))
        for name in chosen
        if name in dataset and not dataset[name].dims
    ]
