"""How far a sweep has come, by tqdm where that is installed."""

import sys
from typing import Any, Final, Protocol

from rockframe.errors import ComponentError, shown
from rockframe.studies.sweeps.axes import OWNER

_DELAY: Final = 1.0
"""What takes no longer shows no bar, unless one is asked for [s]."""


class Progress(Protocol):
    """A bar."""

    def update(self, n: int) -> Any:
        """Add cases that are done."""
        ...

    def close(self) -> Any:
        """Show it no longer as going on."""
        ...


class _Silent:
    def update(self, n: int) -> None:
        """Show nothing."""

    def close(self) -> None:
        """Show nothing."""


def progress_of(given: object, *, total: int, done: int) -> Progress:
    """Give the bar of a sweep.

    Parameters
    ----------
    given : bool or None
        Whether there is one; where it can be seen and tqdm is installed if None.
    total, done : int
        Cases; those that were there before.

    Returns
    -------
    Progress

    Raises
    ------
    ComponentError
        Neither True, False nor None; or True, and tqdm is not installed.
    """
    if given is not None and not isinstance(given, bool):
        msg = f"{OWNER}: progress must be True, False or None, got {shown(given)}"
        raise ComponentError(msg)
    if given is False:
        return _Silent()
    try:
        from tqdm import auto
    except ImportError as problem:
        if given is None:
            return _Silent()
        msg = f"{OWNER}: progress=True needs tqdm (pip install 'rockframe[progress]')"
        raise ComponentError(msg) from problem
    bar: Any = auto.tqdm
    in_a_notebook = any("notebook" in kind.__module__ for kind in bar.__mro__)
    if given is None and not (in_a_notebook or sys.stderr.isatty()):
        return _Silent()
    delay = _DELAY if given is None else 0.0
    return bar(total=total, initial=done, unit="case", desc=OWNER, delay=delay)
