"""Two ways to compile the functions of the reference models."""

from numba import njit

compiled = njit(cache=True, error_model="numpy", no_cfunc_wrapper=True)
"""What Python calls, too."""
within = njit(error_model="numpy", no_cfunc_wrapper=True, no_cpython_wrapper=True)
"""What compiled functions alone call: a way in from Python takes longer to compile than most do."""
