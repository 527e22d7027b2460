"""Machine code in memory: read from disk, or made when it is not there.

Loading needs LLVM alone: a process whose code is on disk never imports numba,
which would take most of a second.
"""

import logging
from collections.abc import Callable
from functools import cache
from threading import RLock
from typing import TYPE_CHECKING, Any, Final

from rockframe.compiled import store
from rockframe.compiled.registry import name_of

if TYPE_CHECKING:
    import llvmlite.binding as llvm

SYMBOL: Final = "rockframe_routine"
"""Name of the function that an object file defines."""

_logger = logging.getLogger("rockframe")
_lock: Final = RLock()
_addresses: Final[dict[Callable[..., Any], int]] = {}
_engines: Final[list[Any]] = []
_announced: Final[list[bool]] = []


def load(function: Callable[..., Any], translate: Callable[[], bytes]) -> int:
    """Give the address of a function's machine code.

    Parameters
    ----------
    function : callable
        Its source.
    translate : callable
        Makes the object file that defines it as ``SYMBOL``, where none is on disk.

    Returns
    -------
    int

    Raises
    ------
    RuntimeError
        It could not be made.
    """
    address = _addresses.get(function)
    if address is not None:
        return address
    with _lock:
        if function not in _addresses:
            code = _stored_or_made(function, translate)
            _addresses[function] = _into_memory(code)
        return _addresses[function]


@cache
def target_machine() -> "llvm.TargetMachine":
    """Give LLVM's description of this machine."""
    import llvmlite.binding as llvm

    llvm.initialize_native_target()
    llvm.initialize_native_asmprinter()
    target = llvm.Target.from_triple(llvm.get_process_triple())
    return target.create_target_machine(
        cpu=llvm.get_host_cpu_name(),
        features=_features(),
        opt=3,
        # code made for the memory that it is loaded into, as numba has it made
        reloc="static" if target.name.startswith("x86") else "default",
        codemodel="jitdefault",
        jit=True,
    )


def _features() -> str:
    import llvmlite.binding as llvm

    try:
        return llvm.get_host_cpu_features().flatten()
    except RuntimeError:  # not known for this sort of processor
        return ""


def _stored_or_made(function: Callable[..., Any], translate: Callable[[], bytes]) -> bytes:
    if not store.knows(function.__code__.co_filename):
        return _made(function, translate)
    name, maker = name_of(function), _maker()
    code = store.read(name, maker)
    if code is None:
        code = _made(function, translate)
        store.write(name, maker, code)
    return code


def _made(function: Callable[..., Any], translate: Callable[[], bytes]) -> bytes:
    if not _announced:
        _announced.append(True)
        _logger.warning(
            "rockframe compiles what this needs for this machine, once: the integrator takes some "
            "15 s, a model or a spectrum some 5 s"
        )
    try:
        return translate()
    except Exception as error:
        msg = f"{name_of(function)} could not be compiled; ROCKFRAME_COMPILE=0 does without"
        raise RuntimeError(msg) from error


def _maker() -> str:
    import llvmlite.binding as llvm

    version = ".".join(map(str, llvm.llvm_version_info))
    return f"{version} {target_machine().triple} {llvm.get_host_cpu_name()} {_features()}"


def _into_memory(code: bytes) -> int:
    import llvmlite.binding as llvm

    # one engine each: all files give their function the same name
    engine = llvm.create_mcjit_compiler(llvm.parse_assembly(""), target_machine())
    engine.add_object_file(llvm.ObjectFileRef.from_data(code))
    engine.finalize_object()
    _engines.append(engine)
    return int(engine.get_function_address(SYMBOL))
