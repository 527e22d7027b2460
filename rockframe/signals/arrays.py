"""Arrays of accelerations: checked for shape and finite values, and copied read-only."""

from typing import Any, Final, TypeAlias

import numpy as np
from numpy.typing import NDArray

from rockframe.errors import ComponentError

Array: TypeAlias = NDArray[np.float64]
AnyArray: TypeAlias = NDArray[Any]

OWNER: Final = "GroundMotion"
"""Name of the class that messages speak of."""


def readonly_array(values: object, name: str, shape: tuple[int, ...] | None = None) -> Array:
    """Copy values to an array that is read-only and contiguous, or refuse them."""
    array = np.array(values, dtype=np.float64, order="C", copy=True)
    if (array.ndim != 1) if shape is None else (array.shape != shape):
        expected = "one dimension" if shape is None else f"the shape {shape}"
        msg = f"{OWNER}: {name} needs {expected}, got the shape {array.shape}"
        raise ComponentError(msg)
    flat = array.reshape(-1)
    wrong = np.flatnonzero(~np.isfinite(flat))
    if wrong.size:
        where = int(wrong[0])
        msg = f"{OWNER}: {name} must be finite, got {flat[where]} at index {where}"
        raise ComponentError(msg)
    array.setflags(write=False)
    return array
