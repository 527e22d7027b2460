"""One source, two speeds: compiled by numba where it is installed, plain Python where not.

Kernels and callbacks are marked, and stay Python functions; the few entries run as
machine code, kept on disk. ``ROCKFRAME_COMPILE=0`` in the environment keeps to plain
Python; ``ROCKFRAME_CACHE_DIR`` names another folder for the machine code.
"""

from rockframe.compiled.arrays import Codes as Codes
from rockframe.compiled.arrays import FrozenMatrix as FrozenMatrix
from rockframe.compiled.arrays import FrozenVector as FrozenVector
from rockframe.compiled.arrays import IntegerMatrix as IntegerMatrix
from rockframe.compiled.arrays import Integers as Integers
from rockframe.compiled.arrays import Matrix as Matrix
from rockframe.compiled.arrays import Vector as Vector
from rockframe.compiled.entries import COMPILED as COMPILED
from rockframe.compiled.entries import entry as entry
from rockframe.compiled.registry import Signature as Signature
from rockframe.compiled.registry import callback as callback
from rockframe.compiled.registry import inlined as inlined
from rockframe.compiled.registry import kernel as kernel
