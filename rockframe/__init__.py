"""Rocking blocks and frames on rigid ground, viscoelastic pads and soil.

Assemble components into a :class:`System`, simulate it under a
:class:`GroundMotion`, and get a labelled :class:`xarray.Dataset` that netCDF
can hold.
"""

import os
import sys
from importlib import import_module
from itertools import pairwise
from typing import Any


def _is_command_line() -> bool:
    """Whether this process is the command line: ``rockframe`` or ``python -m rockframe``."""
    program = "".join(sys.argv[:1])
    if program == "-m":  # Python has not yet found the module that it will run
        return ("-m", __name__) in pairwise(sys.orig_argv)
    return os.path.basename(program) in (__name__, f"{__name__}.exe")


# Every scene needs these two, and they take most of the import time. They are loaded here so that
# the first simulation does not wait for them. The help of the command line needs neither.
if not _is_command_line():
    for _library in ("pint", "xarray"):
        import_module(_library)
    import_module(f"{__name__}.accessor")  # so that every dataset has it

_STUB = __loader__.get_data(os.path.join(os.path.dirname(__file__), "__init__.pyi")).decode()
_HOMES = {
    name: home
    for home, _, name in (
        words.replace("(", " ").split()[:3] for words in _STUB.split("\nfrom ")[1:]
    )
}
"""Module from which each public name is imported, read from the stub of this file."""

__all__ = list(_HOMES)  # pyright: ignore[reportUnsupportedDunderAll]


def __getattr__(name: str) -> Any:
    # The rest is imported on its first use: a script that only reads records never waits for
    # the integrator. A script with the name of the command line gets here, too, without the
    # accessor of datasets, which is imported first.
    home = _HOMES.get(name)
    if home is None:
        if name.startswith("__"):
            raise AttributeError(name)
        return import_module(f"{__name__}.deprecated").deprecated_object(name, __all__)
    if home == __name__:
        value = import_module(f"{__name__}.{name}")
    else:
        import_module(f"{__name__}.accessor")
        value = getattr(import_module(home), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted(__all__)
