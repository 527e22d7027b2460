"""Numbers of datasets in words."""

import math
import re
from collections.abc import Iterable
from typing import Any, Final

import xarray as xr

from rockframe.results.variables.variable import flag_words
from rockframe.units import Unit, degrees_text
from rockframe.units.display import DisplayUnits, unit_suffix, with_superscripts

_YES_NO: Final = {"true": "yes", "false": "no"}
_NAN_NOTE: Final = re.compile(r", NaN if .*$")
"""Words on missing numbers in their meanings; reports write "none" for these."""


def format_value(variable: xr.DataArray, units: DisplayUnits | None = None) -> str:
    """Write a scalar with its unit, and flags and truth values as words."""
    value: Any = variable.item()
    if words := flag_words(variable.attrs):
        word = words.get(value, str(value))
        return _YES_NO.get(word, word.replace("_", " "))
    if variable.dtype == bool:
        return _YES_NO[str(value).lower()]
    if isinstance(value, str):
        return value
    if isinstance(value, float) and not math.isfinite(value):
        return "none" if math.isnan(value) else "infinite"
    unit = (units or DisplayUnits()).of(str(variable.attrs.get("units", Unit.ONE)))
    number = f"{value / unit.size + 0.0:.4g}"  # no negative zero
    if unit.words == Unit.RADIAN:
        return f"{number} rad ({degrees_text(value, 3)})"
    return f"{number}{unit_suffix(with_superscripts(unit.words))}"


def format_number(value: float, unit: str, units: DisplayUnits) -> str:
    """Write a number of an SI unit in the reader's unit, without the unit."""
    return "-" if math.isnan(value) else f"{value / units.of(unit).size + 0.0:.4g}"


def column_title(name: str, unit: str, units: DisplayUnits) -> str:
    """Write the name of a variable with the reader's unit, above a column."""
    words, shown_in = name.replace("_", " "), units.of(unit).words
    return words if shown_in == Unit.ONE else f"{words} [{with_superscripts(shown_in)}]"


def scalar_rows(
    dataset: xr.Dataset, names: list[str] | None = None, units: DisplayUnits | None = None
) -> list[tuple[str, str]]:
    """Return the meaning and the value of scalars."""
    chosen = [str(name) for name in dataset.data_vars] if names is None else names
    return [
        (
            _NAN_NOTE.sub("", str(dataset[name].attrs.get("long_name", name))),
            format_value(dataset[name], units),
        )
        for name in chosen
        if name in dataset and not dataset[name].dims
    ]


def extreme_rows(
    dataset: xr.Dataset, names: Iterable[str], units: DisplayUnits
) -> list[tuple[str, str, str, str]]:
    """Return the name, unit, least and largest value of histories, at each of several points."""
    rows = list[tuple[str, str, str, str]]()
    for name in names:
        values = dataset[name]
        unit = units.of(str(values.attrs.get("units", Unit.ONE)))
        first = str(values.dims[0])
        for row in values if values.ndim > 1 else [values]:
            of_point = f" ({row[first].item()})" if values.ndim > 1 and first in row.coords else ""
            ends = unit.of([float(row.min()), float(row.max())])
            least, greatest = (f"{end + 0.0:.4g}" for end in ends)
            words = "" if unit.words == Unit.ONE else with_superscripts(unit.words)
            rows.append((name.replace("_", " ") + of_point, words, least, greatest))
    return rows
