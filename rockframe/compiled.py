"""One source, two speeds: compiled by numba where it is installed, plain Python where not.

Modules that use this one are imported on the first simulation, so that
``import rockframe`` never loads numba. ``ROCKFRAME_COMPILE=0`` in the
environment keeps to plain Python.
"""

import logging
import os
from collections.abc import Callable
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from typing import Annotated, Any, Final, TypeVar, get_args, get_type_hints

import numpy as np
from numpy.typing import NDArray

Vector = Annotated[NDArray[np.float64], "vector"]
Matrix = Annotated[NDArray[np.float64], "matrix"]
Integers = Annotated[NDArray[np.int64], "integers"]
IntegerMatrix = Annotated[NDArray[np.int64], "integer_matrix"]
Codes = Annotated[NDArray[np.int16], "codes"]
FrozenVector = Annotated[NDArray[np.float64], "frozen_vector"]
FrozenMatrix = Annotated[NDArray[np.float64], "frozen_matrix"]

Function = TypeVar("Function", bound=Callable[..., Any])

_logger = logging.getLogger("rockframe")


def _load_numba() -> Any:
    if os.environ.get("ROCKFRAME_COMPILE", "1") == "0" or find_spec("numba") is None:
        return None
    return import_module("numba")


def _drop_stale_code() -> None:
    """Delete compiled kernels if any kernel's source has changed.

    numba watches only the file of the function it compiles, not the files of
    the functions that this one calls.
    """
    root = Path(__file__).parent
    sources = [Path(__file__), *root.glob("dynamics/*.py"), *root.glob("solve/*.py")]
    stamp = "\n".join(
        f"{path.name} {path.stat().st_mtime_ns} {path.stat().st_size}" for path in sorted(sources)
    )
    note = root / "__pycache__" / "kernels.stamp"
    try:
        if note.is_file() and note.read_text() == stamp:
            return
        for index in root.rglob("__pycache__/*.nbi"):
            index.unlink()
        note.parent.mkdir(exist_ok=True)
        note.write_text(stamp)
    except OSError:
        return  # installed where nothing can be written: nothing is edited there either


_numba: Any = _load_numba()
if _numba is not None:
    _drop_stale_code()
COMPILED: Final = _numba is not None
"""Whether the kernels are compiled."""

# The types that cross the kernels' interfaces, by name.
_TYPES: dict[str, Any] = {}
if _numba is not None:
    _f, _i = _numba.float64, _numba.int64
    _TYPES.update(
        none=_numba.void,
        real=_f,
        integer=_i,
        vector=_f[::1],
        matrix=_f[:, ::1],
        integers=_i[::1],
        integer_matrix=_i[:, ::1],
        codes=_numba.int16[::1],
        frozen_vector=_numba.types.Array(_f, 1, "C", readonly=True),
        frozen_matrix=_numba.types.Array(_f, 2, "C", readonly=True),
    )

# The kernels allocate nothing: without numba's reference counting, taking an
# array out of a tuple costs nothing (it was a quarter of the run time).
_OPTIONS: Final = {"cache": True, "error_model": "numpy", "_nrt": False}


class Signature:
    """Fixed signature of a callback, by which the integrator can call any model.

    Parameters
    ----------
    result : str
        Type of the result.
    *arguments : str
        Types of the arguments.
    """

    def __init__(self, result: str, *arguments: str) -> None:
        self._types = (result, *arguments)

    @property
    def numba(self) -> Any:
        """The signature in numba's terms."""
        result, *arguments = (_TYPES[name] for name in self._types)
        return result(*arguments)


def kernel(function: Function) -> Function:
    """Compile a helper function on its first use."""
    if _numba is None:
        return function
    return _numba.njit(**_OPTIONS, nogil=True)(function)


def inlined(function: Function) -> Function:
    """Compile a helper function of every step into its caller.

    A tuple of arrays is passed word by word, a hundred words a call; the few
    functions that every step calls are spared that.
    """
    if _numba is None:
        return function
    return _numba.njit(**_OPTIONS, nogil=True, forceinline=True)(function)


def callback(signature: Signature) -> Callable[[Function], Function]:
    """Compile a function to a pointer of a fixed signature, cached on disk."""

    def compile_callback(function: Function) -> Function:
        if _numba is None:
            return function
        _announce(function)
        return _numba.cfunc(signature.numba, **_OPTIONS)(function)

    return compile_callback


def entry(result: str, *arguments: str | Signature | type) -> Callable[[Function], Function]:
    """Compile a function called from Python, with all its types fixed beforehand.

    Parameters
    ----------
    result : str
        Type of the result.
    *arguments : str, Signature or type
        Types of the arguments; a signature stands for a callback, a class for a
        named tuple whose fields are annotated with the array types above.
    """

    def compile_entry(function: Function) -> Function:
        if _numba is None:
            return function
        _announce(function)
        signature = _TYPES[result](*(_numba_type(argument) for argument in arguments))
        return _numba.njit(signature, **_OPTIONS, nogil=True)(function)

    return compile_entry


def _numba_type(argument: str | Signature | type) -> Any:
    if isinstance(argument, str):
        return _TYPES[argument]
    if isinstance(argument, Signature):
        return _numba.types.FunctionType(argument.numba)
    plain = {int: "integer", float: "real"}
    hints = get_type_hints(argument, include_extras=True).values()
    fields = [_TYPES[plain.get(hint) or get_args(hint)[1]] for hint in hints]
    return _numba.types.NamedTuple(fields, argument)


_announced: list[bool] = []


def _announce(function: Callable[..., Any]) -> None:
    """Say once that a compilation is under way, unless the machine code is on disk."""
    if _announced:
        return
    source = Path(function.__code__.co_filename)
    pattern = f"{source.stem}.{function.__qualname__}-*.nbi"
    folders = [source.parent / "__pycache__"]
    if "NUMBA_CACHE_DIR" in os.environ:
        folders.append(Path(os.environ["NUMBA_CACHE_DIR"]))
    if any(next(folder.rglob(pattern), None) for folder in folders if folder.is_dir()):
        return
    _announced.append(True)
    _logger.warning(
        "rockframe compiles its integrator for this machine: once, for about half a minute"
    )
