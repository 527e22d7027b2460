"""All guards of a step: those of the system, and the limit of the rotation."""

from typing import Final

from rockframe.compiled import Vector, inlined, put, some_negative, some_reversed
from rockframe.dynamics.protocol import Ground, System

LEFT_LIMIT: Final = 0
RIGHT_LIMIT: Final = 1
"""Places of the limits of the rotation; the weights of the coordinates in it stand behind."""
WEIGHTS: Final = 2


@inlined
def guards_at(
    system: System, mode: int, state: Vector, slope: Vector, ground: Ground, limits: Vector,
    before: Vector, after: Vector,
) -> int:  # fmt: skip
    """Write the guards, then their rates; the last is the distance of the rotation from its limit.

    Gives whether one is negative, or falls in `before` and rises now.
    """
    found = system.guards_in(mode, state, slope, ground)
    size, last = system.coordinates(), system.guards()
    rotation = rate = 0.0
    for i in range(size):
        rotation += limits[WEIGHTS + i] * state[i]
        rate += limits[WEIGHTS + i] * state[size + i]
    left = rotation <= 0.0
    gap = limits[LEFT_LIMIT] + rotation if left else limits[RIGHT_LIMIT] - rotation
    opening = rate if left else -rate
    put(found.values, 0, after)
    put(found.changes, last + 1, after)
    after[last], after[2 * last + 1] = gap, opening
    turns = some_reversed(before, last + 1, found.changes)
    limit = gap < 0.0 or (before[2 * last + 1] < 0.0 and opening > 0.0)
    return int(some_negative(found.values) or turns or limit)
