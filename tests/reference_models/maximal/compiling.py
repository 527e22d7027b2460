"""Two ways to compile the functions of the reference models."""

from numba import njit

compiled = njit(cache=True, error_model="numpy", no_cfunc_wrapper=True)
"""For functions that Python also calls."""
within = njit(error_model="numpy", no_cfunc_wrapper=True, no_cpython_wrapper=True)
"""For functions called by compiled ones only: an entry from Python would cost most compile time."""
