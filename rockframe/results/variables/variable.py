"""A row of the table of variables (the schema), and the dimensions that rows have."""

import re
from collections.abc import Mapping
from dataclasses import dataclass
from enum import IntEnum
from typing import Any, Final

import numpy as np

from rockframe.suggestions import suggests_names
from rockframe.units import Unit
from rockframe.units.display import unit_suffix

TIME: Final = ("time",)
EVENT: Final = ("event",)
AFTER_END: Final = ("sample_after_end",)
ANGLE: Final = ("angle",)
MODE: Final = ("mode",)
OSCILLATOR: Final = ("damping_ratio", "period")
PERIOD: Final = ("period",)
FREQUENCY: Final = ("frequency",)
FLIP: Final = ("flip",)
SCALE: Final = ("scale",)

TRUTH: Final = ("false", "true")
"""Meanings of the flags 0 and 1, by which truth values are stored in files."""


@suggests_names
@dataclass(frozen=True)
class Variable:
    """A row of the table.

    Parameters
    ----------
    name : str
        Name in the dataset.
    dims : tuple of str
        Dimensions, such as ``("time",)``; none for a scalar.
    unit : Unit, str or None
        Unit of the values; None for flags and truth values.
    long_name : str
        Meaning, in words.
    flags : type of IntEnum, optional
        Values and meanings of an integer flag.
    dtype : str
        Type in the dataset.
    """

    name: str
    dims: tuple[str, ...]
    unit: Unit | str | None
    long_name: str
    flags: type[IntEnum] | None = None
    dtype: str = "float64"

    def attributes(self, dtype: str | None = None) -> dict[str, Any]:
        """Return the CF attributes.

        Parameters
        ----------
        dtype : str, optional
            Type of the values, where it differs since gaps have made them floats.

        Returns
        -------
        dict
        """
        attributes: dict[str, Any] = {"long_name": self.long_name}
        if self.unit is not None:
            attributes["units"] = str(self.unit)
        if self.flags is not None:
            members = sorted(self.flags, key=int)
            attributes["flag_values"] = np.array(
                [int(m) for m in members], dtype=dtype or self.dtype
            )
            attributes["flag_meanings"] = " ".join(m.name.lower() for m in members)
        if self.dtype == "bool":
            # in a file they are bytes (CF 3.5)
            attributes["flag_values"] = np.array([0, 1], dtype=dtype or "int8")
            attributes["flag_meanings"] = " ".join(TRUTH)
        return attributes


def unit_of(attributes: Mapping[Any, Any]) -> str:
    """Return the unit of values; 1 where their attributes have none."""
    return str(attributes.get("units", Unit.ONE))


def unit_suffix_of(attributes: Mapping[Any, Any]) -> str:
    """Return the unit of values as it follows a number; empty where it is 1."""
    return unit_suffix(unit_of(attributes))


def flag_words(attributes: Mapping[Any, Any]) -> dict[Any, str]:
    """Return the words of a variable's flags, by their values; none for other variables."""
    values = np.atleast_1d(attributes.get("flag_values", ())).tolist()
    return dict(zip(values, str(attributes.get("flag_meanings", "")).split(), strict=True))


def rows_over(dims: tuple[str, ...], /, **meanings: str | tuple[str, type]) -> tuple[Variable, ...]:
    """Make rows of variables over some dimensions, from their names and meanings.

    The meaning of a real number ends with its unit in brackets, unless that is 1. For anything else
    give the meaning and the type: bool, int, str, or the :class:`~enum.IntEnum` of a flag.
    """
    return tuple(_row(name, dims, meaning) for name, meaning in meanings.items())


_WITH_UNIT: Final = re.compile(r"(.*) \[([^\[]*)\]", re.DOTALL)
_DTYPES: Final = {bool: "bool", int: "int64", str: "str"}


def _row(name: str, dims: tuple[str, ...], meaning: str | tuple[str, type]) -> Variable:
    if isinstance(meaning, str):
        match = _WITH_UNIT.fullmatch(meaning)
        words, unit = (meaning, Unit.ONE) if match is None else (match[1], Unit(match[2]))
        return Variable(name, dims, unit, words)
    words, kind = meaning
    if issubclass(kind, IntEnum):
        return Variable(name, dims, None, words, kind, "int8")
    return Variable(name, dims, Unit.ONE if kind is int else None, words, dtype=_DTYPES[kind])


def bounds(name: str, words: str) -> dict[str, str]:
    """Return the meanings of a lower and an upper bound: ``{}`` in `words` becomes either word."""
    return {f"{name}_{end}_bound": words.format(end) for end in ("lower", "upper")}
