"""Runs as plain Python in a process that compiles.

For short runs of models that nothing else compiles: a compiler takes a hundred times as long.
"""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

import pytest

from rockframe.compiled.entries import Entry


@contextmanager
def plainly(*entries: Callable[..., Any]) -> Iterator[None]:
    """Have nothing compiled, and call no machine code, as long as this lasts.

    Of the entries given alone: with :func:`rockframe.solve.driver.advance` the run is one in plain
    Python, and what is observed along it is compiled, which takes a fifth of the time of both.
    """
    called = Entry.__call__

    def call(entry: Entry, *arguments: Any) -> Any:
        if entries and entry not in entries:
            return called(entry, *arguments)
        return entry._plain(*arguments)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(Entry, "__call__", call)
        yield
