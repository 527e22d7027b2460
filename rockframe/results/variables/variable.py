"""A row of the table of variables, and the shapes that rows have."""

from collections.abc import Mapping
from dataclasses import dataclass
from enum import IntEnum
from typing import Any, Final

import numpy as np

from rockframe.proposals import proposing
from rockframe.units import Unit

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
"""Meanings of 0 and 1, as which files hold truth values."""


@proposing
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
        None for flags and truth values.
    long_name : str
        Meaning.
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
        """Give the CF attributes.

        Parameters
        ----------
        dtype : str, optional
            Of the values, where gaps among them leave no other than floats.

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


def unit_behind(attributes: Mapping[Any, Any]) -> str:
    """Write the unit of values as it stands behind a number of them; nothing where it is 1."""
    unit = str(attributes.get("units", Unit.ONE))
    return "" if unit == Unit.ONE else f" {unit}"


def flag(name: str, dims: tuple[str, ...], words: str, kind: type[IntEnum]) -> Variable:
    """Make the row of a flag."""
    return Variable(name, dims, None, words, kind, "int8")


def number(name: str, words: str, dims: tuple[str, ...] = ()) -> Variable:
    """Make the row of a pure number, or of one whose unit is that of what a dataset is of."""
    return Variable(name, dims, Unit.ONE, words)


def whether(name: str, words: str, dims: tuple[str, ...] = ()) -> Variable:
    """Make the row of a truth value."""
    return Variable(name, dims, None, words, dtype="bool")


def count(name: str, words: str) -> Variable:
    """Make the row of a scalar count."""
    return Variable(name, (), Unit.ONE, words, dtype="int64")


def counting(name: str, words: str) -> Variable:
    """Make the row of a coordinate that counts."""
    return Variable(name, (name,), Unit.ONE, words, dtype="int64")


def bounds(name: str, words: str, dims: tuple[str, ...] = ()) -> tuple[Variable, ...]:
    """Make the rows of a lower and an upper bound of a ratio, whose words say which at ``{}``."""
    ends = ("lower", "upper")
    return tuple(number(f"{name}_{end}_bound", words.format(end), dims) for end in ends)
