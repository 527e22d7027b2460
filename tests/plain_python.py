"""Runs as plain Python in a process that compiles.

For short runs of models that nothing else compiles: a compiler takes a hundred times as long.
"""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

import pytest

from rockframe.compiled.bound import BoundFunction
from rockframe.compiled.entries import Entry


@contextmanager
def plain_python(*entries: Callable[..., Any]) -> Iterator[None]:
    """Run in plain Python, without compilation, as long as this context.

    With `entries` only these: with :func:`rockframe.solve.driver.advance` the run is plain Python
    and its observation is compiled, which takes a fifth of the time of compiling both.
    """
    called = Entry.__call__

    def call_python(function: BoundFunction, *arguments: Any) -> Any:
        return function.source.function(function._bundle, *arguments[:-1])

    def call(entry: Entry, *arguments: Any) -> Any:
        if entries and entry not in entries:
            return called(entry, *arguments)
        return entry._plain(*arguments)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(Entry, "__call__", call)
        patch.setattr(BoundFunction, "call", call_python)
        yield
