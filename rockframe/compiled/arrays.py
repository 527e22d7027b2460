"""The array types of the kernels: annotations by which a compiler knows them."""

from typing import Annotated, Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

Vector = Annotated[NDArray[np.float64], "vector"]
Matrix = Annotated[NDArray[np.float64], "matrix"]
Integers = Annotated[NDArray[np.int64], "integers"]
IntegerMatrix = Annotated[NDArray[np.int64], "integer_matrix"]
Codes = Annotated[NDArray[np.int16], "codes"]
FrozenVector = Annotated[NDArray[np.float64], "frozen_vector"]
FrozenMatrix = Annotated[NDArray[np.float64], "frozen_matrix"]


class ArrayKind(NamedTuple):
    """What an array of a named type must be, beside contiguous in C order."""

    dtype: np.dtype[np.generic]
    dimensions: int
    read_only: bool = False


_REAL: Final = np.dtype(np.float64)
_INTEGER: Final = np.dtype(np.int64)

ARRAY_KINDS: Final = {
    "vector": ArrayKind(_REAL, 1),
    "matrix": ArrayKind(_REAL, 2),
    "integers": ArrayKind(_INTEGER, 1),
    "integer_matrix": ArrayKind(_INTEGER, 2),
    "codes": ArrayKind(np.dtype(np.int16), 1),
    "frozen_vector": ArrayKind(_REAL, 1, read_only=True),
    "frozen_matrix": ArrayKind(_REAL, 2, read_only=True),
}
"""By the names in the annotations above; `read_only` takes arrays of both sorts."""
