"""One way to compile all functions of the reference model."""

from numba import njit

compiled = njit(cache=True, error_model="numpy")
