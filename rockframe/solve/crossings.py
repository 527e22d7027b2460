"""Dense solution inside a step, and the search for zero crossings of guards in it.

A coordinate follows the quintic through position, rate and acceleration at the ends of the step,
:eq:`eq-hermite`; its error is of sixth order in the step. A variable of first order follows the
cubic through value and rate.
"""

import math
from typing import Final, NamedTuple

from rockframe.compiled import Vector, kernel
from rockframe.solve.equations import BoundEquations
from rockframe.solve.march import DIP_MARGIN, may_dip
from rockframe.solve.workspace import KnownMode, Span, Workspace, ground_in


class Crossing(NamedTuple):
    """Where a guard falls through zero, as fractions of a step."""

    guard: int  # number of the guard; -1 if none falls
    place: float  # where it is zero
    negative: float  # where, behind that, it is negative


@kernel
def quintic(
    x0: float, v0: float, a0: float, x1: float, v1: float, a1: float
) -> tuple[float, float, float, float, float, float]:
    """Return the coefficients of the quintic in u = t/h, from values and derivatives by u."""
    rise = x1 - x0 - v0 - 0.5 * a0
    change = v1 - v0 - a0
    bend = a1 - a0
    return (
        x0,
        v0,
        0.5 * a0,
        10.0 * rise - 4.0 * change + 0.5 * bend,
        -15.0 * rise + 7.0 * change - bend,
        6.0 * rise - 3.0 * change + 0.5 * bend,
    )


@kernel
def cubic(x0: float, v0: float, x1: float, v1: float, u: float) -> tuple[float, float]:
    """Return value and rate per u of the cubic through values and rates at u = 0 and 1."""
    rise, bend = x1 - x0 - v0, v1 - v0
    c2, c3 = 3.0 * rise - bend, bend - 2.0 * rise
    return x0 + u * (v0 + u * (c2 + u * c3)), v0 + u * (2.0 * c2 + u * 3.0 * c3)


@kernel
def interpolate(
    equations: BoundEquations, count: int, fraction: float, h: float, w: Workspace
) -> None:
    """Fill the scratch state and its rates at a fraction of a step of length h [s].

    Coordinates beyond the first `count` do not move and are copied.
    """
    size, u = equations.coordinate_count, fraction
    for i in range(size):
        j = size + i
        if i >= count:
            w.scratch[i] = w.state[i]
            w.scratch[j] = w.state[j]
            w.scratch_rates[i] = 0.0
            continue
        c0, c1, c2, c3, c4, c5 = quintic(
            w.state[i],
            h * w.state[j],
            h * h * w.first[i],
            w.new[i],
            h * w.new[j],
            h * h * w.last[i],
        )
        w.scratch[i] = c0 + u * (c1 + u * (c2 + u * (c3 + u * (c4 + u * c5))))
        slope = c1 + u * (2.0 * c2 + u * (3.0 * c3 + u * (4.0 * c4 + u * 5.0 * c5)))
        curve = 2.0 * c2 + u * (6.0 * c3 + u * (12.0 * c4 + u * 20.0 * c5))
        w.scratch[j] = slope / h
        w.scratch_rates[i] = curve / (h * h)
    for i in range(size, size + equations.variable_count):
        j = size + i
        value, rate = cubic(w.state[j], h * w.first[i], w.new[j], h * w.last[i], u)
        w.scratch[j], w.scratch_rates[i] = value, rate / h


@kernel
def extremum(x0: float, v0: float, a0: float, x1: float, v1: float, a1: float) -> float:
    """Return the extremum of a quintic whose slope changes sign (arguments as of `quintic`)."""
    c0, c1, c2, c3, c4, c5 = quintic(x0, v0, a0, x1, v1, a1)
    low = 0.0
    high = 1.0
    u = v0 / (v0 - v1)
    for _ in range(60):
        slope = c1 + u * (2.0 * c2 + u * (3.0 * c3 + u * (4.0 * c4 + u * 5.0 * c5)))
        if (slope > 0.0) == (v0 > 0.0):
            low = u
        else:
            high = u
        curve = 2.0 * c2 + u * (6.0 * c3 + u * (12.0 * c4 + u * 20.0 * c5))
        trial = u - slope / curve if curve != 0.0 else 0.5 * (low + high)
        if not low < trial < high:
            trial = 0.5 * (low + high)
        if abs(trial - u) <= 1e-12:
            u = trial
            break
        u = trial
    return c0 + u * (c1 + u * (c2 + u * (c3 + u * (c4 + u * c5))))


ROOT_TOLERANCE: Final = 1e-13
"""Width of the bracket, as a share of the step, at which the search for a root ends."""
SEARCHING: Final = 100
"""Most evaluations of the guards in that search; bisection alone takes 44."""
LOOKING: Final = 40
"""Most evaluations of the guards in the search of a dip; each halves its bracket."""
GOLDEN: Final = 0.5 * (math.sqrt(5.0) - 1.0)
"""Ratio of the golden section, by which a bracket of the least value at rest shrinks."""
GUESSING: Final = 5
"""Newton's corrections of the root of the cubic, from which the search for a root begins."""
CONVERGED: Final = 1e-7
"""Newton's correction, as a share of the step, after which no other is needed: its square, the
size of the next one, is rounding."""


@kernel
def earliest_crossing(
    equations: BoundEquations, known: KnownMode, span: Span, tolerance: Vector, w: Workspace
) -> Crossing:
    """Return the guard that falls through zero first.

    A guard is evaluated at the end of the step and, where its cubic dips towards zero, in that
    dip, whether it begins positive or at zero. Where nothing moves, guards have no rates, and a
    dip is found by their values.
    """
    found, place, negative = -1, 2.0, 1.0
    for i in range(len(tolerance)):
        end_change = span.h * w.after[len(tolerance) + i]
        c0, c1, c2, c3 = _cubic_of(i, span.h, tolerance, w)
        if known.moving > 0 and not may_dip(c0, c1, w.after[i], end_change):
            continue
        end = -1.0
        bottom, low, high = _dip(c1, c2, c3)
        depth = c0 + bottom * (c1 + bottom * (c2 + bottom * c3))
        if known.moving == 0:
            end = _point_below_zero_at_rest(equations, i, known, span, tolerance, w)
        elif 0.0 < bottom < 1.0 and depth < DIP_MARGIN * (abs(c1) + abs(end_change)):
            end = _point_below_zero(equations, i, bottom, low, high, known, span, tolerance, w)
        # a guard that starts at zero, within its rounding noise, falls only if it goes below that
        if end < 0.0 and w.after[i] < (0.0 if w.before[i] > tolerance[i] else -tolerance[i]):
            end = 1.0
        if end >= 0.0:
            root = _first_root(equations, i, end, known, span, tolerance, w)
            if root < place:
                found, place, negative = i, root, end
    return Crossing(found, place, negative)


@kernel
def _cubic_of(
    which: int, h: float, tolerance: Vector, w: Workspace
) -> tuple[float, float, float, float]:
    """Return the coefficients of the cubic through a guard's values and rates at both ends."""
    guards = len(tolerance)
    start, c1 = w.before[which], h * w.before[guards + which]
    rise, bend = w.after[which] - start - c1, h * w.after[guards + which] - c1
    return start, c1, 3.0 * rise - bend, bend - 2.0 * rise


@kernel
def _dip(c1: float, c2: float, c3: float) -> tuple[float, float, float]:
    """Return the place of a cubic's minimum, and a bracket of it inside the step.

    Without a minimum, the place where the falling cubic is flattest. Without that either, a place
    outside the step.
    """
    root = math.sqrt(max(c2 * c2 - 3.0 * c3 * c1, 0.0))
    bottom = 2.0
    if c2 >= 0.0 > c1 and c2 + root > 0.0:
        bottom = -c1 / (c2 + root)
    elif c2 < 0.0 < c3:
        bottom = (root - c2) / (3.0 * c3)
    low, high = 0.0, 1.0
    if c3 != 0.0:
        top = -2.0 * c2 / (3.0 * c3) - bottom
        if c3 > 0.0:
            low = max(min(top, bottom), low)
        else:
            high = min(max(top, bottom), high)
    return bottom, low, high


@kernel
def _guard_inside(
    equations: BoundEquations, which: int, fraction: float, known: KnownMode, span: Span,
    w: Workspace,
) -> float:  # fmt: skip
    """Return a guard's value at a fraction of the step, from the dense solution."""
    interpolate(equations, known.moving, fraction, span.h, w)
    ground = ground_in(fraction, span, w.ground)
    equations.guarding.call(
        known.mode, w.scratch, w.scratch_rates, ground.x, ground.y, w.limits, w.inside,
        equations.numbers,
    )  # fmt: skip
    return w.inside[which]


@kernel
def _point_below_zero(
    equations: BoundEquations, which: int, bottom: float, low: float, high: float,
    known: KnownMode, span: Span, tolerance: Vector, w: Workspace,
) -> float:  # fmt: skip
    """Return a place in a predicted dip at which a guard is negative; -1 if there is none.

    Bisection by the guard's rate. For a guard that starts at zero, within its rounding noise,
    values must be below that noise.
    """
    start, noise = w.before[which], tolerance[which]
    zero = 0.0 if start > noise else min(start, 0.0) - noise
    for _ in range(LOOKING):
        g = _guard_inside(equations, which, bottom, known, span, w)
        if g < zero:
            return bottom
        rate = span.h * w.inside[len(tolerance) + which]
        if g - zero > abs(rate) * (high - low):  # convex: no value in the bracket is negative
            break
        if rate > 0.0:
            high = bottom
        else:
            low = bottom
        bottom = 0.5 * (low + high)
    return -1.0


@kernel
def _point_below_zero_at_rest(
    equations: BoundEquations, which: int, known: KnownMode, span: Span, tolerance: Vector,
    w: Workspace,
) -> float:  # fmt: skip
    """Return a place inside a step without motion at which a guard is negative, or -1.

    The guard follows the ground alone. Its least value is searched where the parabola through three
    of its values comes near zero, by golden section.
    """
    start, end, noise = w.before[which], w.after[which], tolerance[which]
    zero = 0.0 if start > noise else min(start, 0.0) - noise
    middle = _guard_inside(equations, which, 0.5, known, span, w)
    c1, c2 = 4.0 * middle - 3.0 * start - end, 2.0 * (start + end - 2.0 * middle)
    lowest = start - 0.25 * c1 * c1 / c2 if c2 > 0.0 else math.inf
    if lowest - zero > DIP_MARGIN * (abs(c1) + abs(c1 + 2.0 * c2)):
        return -1.0
    low, high = 0.0, 1.0
    left, right = 1.0 - GOLDEN, GOLDEN
    at_left = _guard_inside(equations, which, left, known, span, w)
    at_right = _guard_inside(equations, which, right, known, span, w)
    for _ in range(LOOKING):
        if at_left < zero or at_right < zero:
            return left if at_left < zero else right
        if at_left < at_right:
            high, right, at_right = right, left, at_left
            left = high - GOLDEN * (high - low)
            at_left = _guard_inside(equations, which, left, known, span, w)
        else:
            low, left, at_left = left, right, at_right
            right = low + GOLDEN * (high - low)
            at_right = _guard_inside(equations, which, right, known, span, w)
    return -1.0


@kernel
def _root_of_cubic(c0: float, c1: float, c2: float, c3: float, end: float) -> float:
    """Return a place before `end` at which a cubic that is positive at 0 falls through zero."""
    low, high, place = 0.0, end, 0.5 * end
    for _ in range(GUESSING):
        value = c0 + place * (c1 + place * (c2 + place * c3))
        if value > 0.0:
            low = place
        else:
            high = place
        rate = c1 + place * (2.0 * c2 + place * 3.0 * c3)
        trial = place - value / rate if rate < 0.0 else high
        place = trial if low < trial < high else 0.5 * (low + high)
    return place


@kernel
def _first_root(
    equations: BoundEquations, which: int, end: float, known: KnownMode, span: Span,
    tolerance: Vector, w: Workspace,
) -> float:  # fmt: skip
    """Return the first root of a guard before `end`, where it is negative.

    Newton's method from the root of the cubic through the guard's values and rates at both ends
    of the step, kept inside its bracket by bisection. A guard that starts at zero, within its
    rounding noise, may rise before it falls: then the root after its rise is returned, that of the
    cubic divided by u. Otherwise a corner that has just lifted off would seem to land at once.
    """
    guards = len(tolerance)
    start, c1, c2, c3 = _cubic_of(which, span.h, tolerance, w)
    if start > tolerance[which]:
        place = _root_of_cubic(start, c1, c2, c3, end)
    elif c1 > 0.0:
        place = _root_of_cubic(c1, c2, c3, 0.0, end)
    else:
        place = 0.5 * end
    low, high, last = 0.0, end, math.inf
    for _ in range(SEARCHING):
        g = _guard_inside(equations, which, place, known, span, w)
        if g > 0.0:
            low = place
        else:
            high = place
        rate, trial = span.h * w.inside[guards + which], 0.5 * (low + high)
        if rate < 0.0 and abs(g) < 0.5 * last:
            corrected = place - g / rate
            if low <= corrected <= high:
                trial = corrected
                if abs(trial - place) <= CONVERGED:
                    return trial
        if high - low <= ROOT_TOLERANCE:
            break
        place, last = trial, abs(g)
    return place
