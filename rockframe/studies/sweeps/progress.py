"""How far sweeps have come, by tqdm where that is installed."""

import sys
from collections.abc import Generator
from contextlib import contextmanager
from typing import Any, Final, Protocol

from rockframe.errors import ComponentError, shown

_DELAY: Final = 1.0
"""What takes no longer shows no bar, unless one is asked for [s]."""
_GROWS: Final = "total grows"
"""What is said where more cases are to come than are known by now."""


class ProgressBar(Protocol):
    """A bar over the cases of one sweep, or of several that follow one another."""

    def name(self, part: str) -> None:
        """Say which part of the whole comes next; how many there will be is not known."""
        ...

    def expect(self, count: int, done: int = 0) -> None:
        """Add cases to the total, of which some were done before."""
        ...

    def update(self, count: int) -> None:
        """Add cases that are done."""
        ...


class _Silent:
    def name(self, part: str) -> None:
        """Show nothing."""

    def expect(self, count: int, done: int = 0) -> None:
        """Show nothing."""

    def update(self, count: int) -> None:
        """Show nothing."""


class _Bar:
    """A bar of tqdm, begun when the first cases are known."""

    def __init__(self, kind: Any, owner: str, unit: str, delay: float) -> None:
        self._kind = kind
        self._owner = self._words = owner
        self._unit, self._delay = unit, delay
        self._bar: Any = None

    def name(self, part: str) -> None:
        """Say which part comes next, and that the total grows."""
        self._words = f"{self._owner}, {part} ({_GROWS})"
        if self._bar is not None:
            self._bar.set_description_str(self._words, refresh=False)

    def expect(self, count: int, done: int = 0) -> None:
        """Begin the bar, or let its total grow."""
        if self._bar is None:
            self._bar = self._kind(
                total=count, initial=done, unit=self._unit, desc=self._words, delay=self._delay
            )
            return
        self._bar.total += count
        # what was there before does not count for the rate
        self._bar.initial += done
        self._bar.n += done
        widgets = getattr(self._bar, "container", None)
        if widgets is not None:  # in notebooks the total is that of a widget too
            widgets.children[1].max = self._bar.total

    def update(self, count: int) -> None:
        """Add cases that are done."""
        self._bar.update(count)

    def close(self) -> None:
        """Show the whole, which grows no longer."""
        if self._bar is not None:
            self._bar.set_description_str(self._owner, refresh=False)
            self._bar.close()


@contextmanager
def bar_of(given: object, *, owner: str, unit: str = "case") -> Generator[ProgressBar]:
    """Show a bar while something is done."""
    bar = _made(given, owner, unit)
    try:
        yield bar
    finally:
        if isinstance(bar, _Bar):
            bar.close()


def _made(given: object, owner: str, unit: str) -> _Bar | _Silent:
    if given is not None and not isinstance(given, bool):
        msg = f"{owner}: progress must be True, False or None, got {shown(given)}"
        raise ComponentError(msg)
    if given is False:
        return _Silent()
    try:
        from tqdm import auto
    except ImportError as problem:
        if given is None:
            return _Silent()
        msg = f"{owner}: progress=True needs tqdm (pip install 'rockframe[progress]')"
        raise ComponentError(msg) from problem
    kind: Any = auto.tqdm
    in_a_notebook = any("notebook" in one.__module__ for one in kind.__mro__)
    if given is None and not (in_a_notebook or sys.stderr.isatty()):
        return _Silent()
    return _Bar(kind, owner, unit, _DELAY if given is None else 0.0)
