"""What people see a motion called: its name, and by how much it was scaled.

The name alone says where a motion comes from; it stays when the motion is scaled.
"""

import math
import re
from collections.abc import Iterable
from typing import Final

_SCALED: Final = re.compile(r"scaled by (\S+)(?: to .*)?")


def shown_name(name: str, history: Iterable[str]) -> str:
    """Put the factor of a scaled motion before its name."""
    steps = [_SCALED.fullmatch(step) for step in history]
    factor = math.prod(float(step[1]) for step in steps if step is not None)
    return name if factor == 1.0 else f"{factor:.6g} times {name}"
