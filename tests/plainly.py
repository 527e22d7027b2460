"""Runs as plain Python in a process that compiles.

For short runs of models that nothing else compiles: a compiler takes a hundred times as long.
"""

from collections.abc import Iterator
from contextlib import contextmanager

import pytest

from rockframe.compiled.entries import Entry


@contextmanager
def plainly() -> Iterator[None]:
    """Have nothing compiled, and call no machine code, as long as this lasts."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(Entry, "__call__", lambda entry, *arguments: entry._plain(*arguments))
        yield
