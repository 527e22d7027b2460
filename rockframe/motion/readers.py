"""Old name of :mod:`rockframe.records`."""

import warnings
from typing import Any

from rockframe import records


def __getattr__(name: str) -> Any:
    if name not in records.__all__:
        msg = f"module {__name__!r} has no attribute {name!r}"
        raise AttributeError(msg)
    text = f"{__name__} has become rockframe.records: import {name} from there"
    warnings.warn(text, FutureWarning, stacklevel=2)
    return getattr(records, name)
