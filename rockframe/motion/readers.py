"""Where the readers of records stood before :mod:`rockframe.records`."""

import warnings
from typing import Any

from rockframe import records


def __getattr__(name: str) -> Any:
    found = getattr(records, name)
    text = f"rockframe.motion.readers has become rockframe.records: import {name} from there"
    warnings.warn(text, FutureWarning, stacklevel=2)
    return found
