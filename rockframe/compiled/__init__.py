"""Compilation of equations by numba where it is installed; plain Python where it is not.

Functions and methods that can be compiled are marked, and can still be called from Python;
the few entries run as machine code, which numba stores on disk. ``ROCKFRAME_COMPILE=0`` in
the environment turns compilation off; ``ROCKFRAME_CACHE_DIR`` names another folder for the
machine code.
"""

from rockframe.compiled.bound import BoundFunction as BoundFunction
from rockframe.compiled.bound import bind as bind
from rockframe.compiled.bound import bind_in_lanes as bind_in_lanes
from rockframe.compiled.bound import numbers_in as numbers_in
from rockframe.compiled.entries import COMPILED as COMPILED
from rockframe.compiled.entries import after_each_call as after_each_call
from rockframe.compiled.entries import background_entry as background_entry
from rockframe.compiled.entries import compiled_within as compiled_within
from rockframe.compiled.entries import compiling_for as compiling_for
from rockframe.compiled.entries import entry as entry
from rockframe.compiled.entries import expecting_remaining as expecting_remaining
from rockframe.compiled.entries import is_worth_calling as is_worth_calling
from rockframe.compiled.entries import python_seconds as python_seconds
from rockframe.compiled.entries import table as table
from rockframe.compiled.entries import warn_of_slow_run as warn_of_slow_run
from rockframe.compiled.language import LANES as LANES
from rockframe.compiled.language import IntegerMatrix as IntegerMatrix
from rockframe.compiled.language import Integers as Integers
from rockframe.compiled.language import Matrix as Matrix
from rockframe.compiled.language import ReadOnlyMatrix as ReadOnlyMatrix
from rockframe.compiled.language import Vector as Vector
from rockframe.compiled.language import as_integers as as_integers
from rockframe.compiled.language import call_of_either as call_of_either
from rockframe.compiled.language import constant as constant
from rockframe.compiled.language import filled as filled
from rockframe.compiled.language import inlined as inlined
from rockframe.compiled.language import kernel as kernel
from rockframe.compiled.language import lane_of as lane_of
from rockframe.compiled.language import processors as processors
from rockframe.compiled.language import put as put
from rockframe.compiled.language import view_from as view_from
from rockframe.compiled.language import view_of as view_of
from rockframe.compiled.language import widest_registers as widest_registers
from rockframe.compiled.language import with_numbers as with_numbers
