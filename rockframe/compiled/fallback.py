"""Arrays as plain Python reads and writes them fastest: memory views, of its own numbers."""

from typing import Any, cast

import numpy as np


def viewed(argument: Any) -> Any:
    """Give an argument of an entry with memory views in place of its arrays."""
    if isinstance(argument, np.ndarray):
        return memoryview(cast("Any", argument))
    if isinstance(argument, tuple):
        kind = type(cast("tuple[Any, ...]", argument))
        return kind(*(viewed(part) for part in cast("tuple[Any, ...]", argument)))
    return argument
