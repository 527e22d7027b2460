"""Units of axes, in the words of users."""

from dataclasses import dataclass
from typing import Final

import numpy as np
import numpy.typing as npt
import xarray as xr

from rockframe.errors import ComponentError, shown
from rockframe.units import Measure, to_si

RELATIVE: Final = "relative"
"""The word for values that are made relative to a scale of the body."""
_WRITTEN: Final = {"g_0": "g", "deg": "°", "degree": "°", "degrees": "°"}


@dataclass(frozen=True)
class Shown:
    """A unit that an axis has."""

    words: str  # as it is written beside the axis
    size: float  # in the SI unit

    def of(self, values: "xr.DataArray | npt.ArrayLike") -> npt.NDArray[np.float64]:
        """Give values, in SI units, in this one."""
        return np.asarray(values, np.float64) / self.size


def unit_of(given: object, measure: Measure, *, function: str, name: str) -> Shown:
    """Read the unit of an axis."""
    owner = f"rf.plot.{function}"
    if not isinstance(given, str):
        msg = f"{owner}: {name} must be a unit, such as {str(measure.unit)!r}, got {shown(given)}"
        raise ComponentError(msg)
    size = to_si(f"1 {given}", measure, owner=owner, name=name)
    return Shown(_WRITTEN.get(given, given).replace("*", " "), size)
