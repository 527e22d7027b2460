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
    answers: ImpulseResponse, slip: float, sinking: float, friction: float
) -> tuple[float, float]:
    """Return impulses along and normal to the base that change the normal velocity by -`sinking`.

    `sinking` is negative. The normal impulse grows until this change is reached; friction opposes
    the slip by `friction` times the normal impulse. The slip may end, and reverse, within the
    impact. An infinite coefficient holds the point that strikes.
    """
    normal_by_normal, normal_by_along, along_by_normal, along_by_along = answers
    both = normal_by_normal * along_by_along - normal_by_along * along_by_normal
    along = normal = 0.0
    if slip != 0.0 and friction < math.inf:
        ratio = -math.copysign(friction, slip)
        change = along_by_normal + ratio * along_by_along
        slowing = normal_by_normal + ratio * normal_by_along
        stops = -slip / change if slip * change < 0.0 else math.inf
        ends = -sinking / slowing if slowing > 0.0 else math.inf
        if ends < math.inf and ends <= stops:
            return ratio * ends, ends
        if stops < math.inf:
            normal, along = stops, ratio * stops
            slip, sinking = 0.0, sinking + slowing * stops
    pushed = (slip * normal_by_along - sinking * along_by_along) / both
    held = -(slip + along_by_normal * pushed) / along_by_along
    if friction == math.inf and pushed < 0.0:  # the impulse that stops the slip throws the point up
        return -slip / along_by_along, 0.0
    if friction < math.inf and abs(held) > friction * pushed:
        ratio = math.copysign(friction, held)
        across = normal_by_normal + ratio * normal_by_along
        if across > 0.0:
            pushed = -sinking / across
            held = ratio * pushed
    return along + held, normal + pushed
