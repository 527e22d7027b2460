"""Impulses along and normal to a base in an impact with dry friction, :eq:`eq-slide-impact`."""

import math
from typing import NamedTuple

from rockframe.compiled import inlined


class ImpulseResponse(NamedTuple):
    """Changes of the striking point's velocities by unit impulses."""

    normal_by_normal: float
    normal_by_along: float
    along_by_normal: float
    along_by_along: float


@inlined
def coulomb_impulse(
    response: ImpulseResponse, slip: float, normal_velocity: float, friction: float
) -> tuple[float, float]:
    """Return impulses along and normal to the base that stop a point's normal velocity.

    `normal_velocity` is negative. The normal impulse grows until the point no longer approaches;
    friction opposes the slip by `friction` times the normal impulse. The slip may end, and reverse,
    within the impact. An infinite coefficient holds the point that strikes.
    """
    normal_by_normal, normal_by_along, along_by_normal, along_by_along = response
    determinant = normal_by_normal * along_by_along - normal_by_along * along_by_normal
    along = normal = 0.0
    if slip != 0.0 and friction < math.inf:
        ratio = -math.copysign(friction, slip)
        slip_rate = along_by_normal + ratio * along_by_along
        normal_rate = normal_by_normal + ratio * normal_by_along
        normal_at_stick = -slip / slip_rate if slip * slip_rate < 0.0 else math.inf
        normal_at_end = -normal_velocity / normal_rate if normal_rate > 0.0 else math.inf
        if normal_at_end < math.inf and normal_at_end <= normal_at_stick:
            return ratio * normal_at_end, normal_at_end
        if normal_at_stick < math.inf:
            normal, along = normal_at_stick, ratio * normal_at_stick
            slip, normal_velocity = 0.0, normal_velocity + normal_rate * normal_at_stick
    sticking_normal = (slip * normal_by_along - normal_velocity * along_by_along) / determinant
    sticking_along = -(slip + along_by_normal * sticking_normal) / along_by_along
    if friction == math.inf and sticking_normal < 0.0:
        # the impulse that stops the slip throws the point up
        return -slip / along_by_along, 0.0
    if friction < math.inf and abs(sticking_along) > friction * sticking_normal:
        ratio = math.copysign(friction, sticking_along)
        normal_rate = normal_by_normal + ratio * normal_by_along
        if normal_rate > 0.0:
            sticking_normal = -normal_velocity / normal_rate
            sticking_along = ratio * sticking_normal
    return along + sticking_along, normal + sticking_normal
