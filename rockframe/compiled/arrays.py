"""The array types of compiled functions."""

from typing import Annotated, TypeAlias

import numpy as np
from numpy.typing import NDArray

Vector: TypeAlias = NDArray[np.float64]
Matrix: TypeAlias = NDArray[np.float64]
ReadOnlyMatrix: TypeAlias = Annotated[NDArray[np.float64], "not written to"]
Integers: TypeAlias = NDArray[np.int64]
IntegerMatrix: TypeAlias = NDArray[np.int64]
