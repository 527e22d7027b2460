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
from rockframe.solve.workspace import Span, UnpackedMode, Workspace, ground_in_step


class Crossing(NamedTuple):
    """Where a guard falls through zero, as fractions of a step."""

    guard: int  # number of the guard; -1 if none falls
    fraction: float  # where it is zero
    negative_fraction: float  # where, behind that, it is negative


@kernel
def quintic_coefficients(
    x0: float, v0: float, a0: float, x1: float, v1: float, a1: float
) -> tuple[float, float, float, float, float, float]:
    """Return the coefficients of the quintic in u = t/h, from values and derivatives by u."""
    dx = x1 - x0 - v0 - 0.5 * a0
    dv = v1 - v0 - a0
    da = a1 - a0
    return (
        x0,
        v0,
        0.5 * a0,
        10.0 * dx - 4.0 * dv + 0.5 * da,
        -15.0 * dx + 7.0 * dv - da,
        6.0 * dx - 3.0 * dv + 0.5 * da,
    )


@kernel
def cubic_value_and_rate(
    x0: float, v0: float, x1: float, v1: float, u: float
) -> tuple[float, float]:
    """Return value and rate per u of the cubic through values and rates at u = 0 and 1."""
    dx, dv = x1 - x0 - v0, v1 - v0
    c2, c3 = 3.0 * dx - dv, dv - 2.0 * dx
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
            w.inner_state[i] = w.state[i]
            w.inner_state[j] = w.state[j]
            w.inner_slope[i] = 0.0
            continue
        c0, c1, c2, c3, c4, c5 = quintic_coefficients(
            w.state[i],
            h * w.state[j],
            h * h * w.slope[i],
            w.new_state[i],
            h * w.new_state[j],
            h * h * w.new_slope[i],
        )
        w.inner_state[i] = c0 + u * (c1 + u * (c2 + u * (c3 + u * (c4 + u * c5))))
        rate = c1 + u * (2.0 * c2 + u * (3.0 * c3 + u * (4.0 * c4 + u * 5.0 * c5)))
        acceleration = 2.0 * c2 + u * (6.0 * c3 + u * (12.0 * c4 + u * 20.0 * c5))
        w.inner_state[j] = rate / h
        w.inner_slope[i] = acceleration / (h * h)
    for i in range(size, size + equations.variable_count):
        j = size + i
        value, rate = cubic_value_and_rate(
            w.state[j], h * w.slope[i], w.new_state[j], h * w.new_slope[i], u
        )
        w.inner_state[j], w.inner_slope[i] = value, rate / h


@kernel
def quintic_extremum(x0: float, v0: float, a0: float, x1: float, v1: float, a1: float) -> float:
    """Return the extremum of a quintic whose slope changes sign; arguments as above."""
    c0, c1, c2, c3, c4, c5 = quintic_coefficients(x0, v0, a0, x1, v1, a1)
    low = 0.0
    high = 1.0
    u = v0 / (v0 - v1)
    for _ in range(60):
        rate = c1 + u * (2.0 * c2 + u * (3.0 * c3 + u * (4.0 * c4 + u * 5.0 * c5)))
        if (rate > 0.0) == (v0 > 0.0):
            low = u
        else:
            high = u
        acceleration = 2.0 * c2 + u * (6.0 * c3 + u * (12.0 * c4 + u * 20.0 * c5))
        trial = u - rate / acceleration if acceleration != 0.0 else 0.5 * (low + high)
        if not low < trial < high:
            trial = 0.5 * (low + high)
        if abs(trial - u) <= 1e-12:
            u = trial
            break
        u = trial
    return c0 + u * (c1 + u * (c2 + u * (c3 + u * (c4 + u * c5))))


ROOT_TOLERANCE: Final = 1e-13
"""Width of the bracket, as a share of the step, at which the search for a root ends."""
MAX_ROOT_EVALUATIONS: Final = 100
"""Most evaluations of the guards in that search; bisection alone takes 44."""
MAX_DIP_EVALUATIONS: Final = 40
"""Most evaluations of the guards in the search of a dip; each halves its bracket."""
GOLDEN: Final = 0.5 * (math.sqrt(5.0) - 1.0)
"""Ratio of the golden section, by which a bracket of the least value at rest shrinks."""
CUBIC_ITERATIONS: Final = 5
"""Newton's corrections of the root of the cubic, from which the search for a root begins."""
NEWTON_TOLERANCE: Final = 1e-7
"""Newton's correction, as a share of the step, after which no other is needed: its square, the
size of the next one, is rounding."""


@kernel
def earliest_crossing(
    equations: BoundEquations, unpacked: UnpackedMode, span: Span, tolerance: Vector, w: Workspace
) -> Crossing:
    """Return the guard that falls through zero first.

    A guard is evaluated at the end of the step and, where its cubic dips towards zero, in that
    dip, whether it begins positive or at zero. Where nothing moves, guards have no rates, and a
    dip is found by their values.
    """
    guard, fraction, negative = -1, 2.0, 1.0
    for i in range(len(tolerance)):
        end_change = span.h * w.new_guards[len(tolerance) + i]
        c0, c1, c2, c3 = _guard_cubic(i, span.h, tolerance, w)
        if unpacked.moving > 0 and not may_dip(c0, c1, w.new_guards[i], end_change):
            continue
        below = -1.0
        minimum, low, high = _cubic_minimum(c1, c2, c3)
        depth = c0 + minimum * (c1 + minimum * (c2 + minimum * c3))
        if unpacked.moving == 0:
            below = _point_below_zero_at_rest(equations, i, unpacked, span, tolerance, w)
        elif 0.0 < minimum < 1.0 and depth < DIP_MARGIN * (abs(c1) + abs(end_change)):
            below = _point_below_zero(
                equations, i, minimum, low, high, unpacked, span, tolerance, w
            )
        # a guard that starts at zero, within its rounding noise, falls only if it goes below that
        if below < 0.0 and w.new_guards[i] < (0.0 if w.guards[i] > tolerance[i] else -tolerance[i]):
            below = 1.0
        if below >= 0.0:
            root = _first_root(equations, i, below, unpacked, span, tolerance, w)
            if root < fraction:
                guard, fraction, negative = i, root, below
    return Crossing(guard, fraction, negative)


@kernel
def _guard_cubic(
    guard: int, h: float, tolerance: Vector, w: Workspace
) -> tuple[float, float, float, float]:
    """Return the coefficients of the cubic through a guard's values and rates at both ends."""
    count = len(tolerance)
    start, c1 = w.guards[guard], h * w.guards[count + guard]
    dx, dv = w.new_guards[guard] - start - c1, h * w.new_guards[count + guard] - c1
    return start, c1, 3.0 * dx - dv, dv - 2.0 * dx


@kernel
def _cubic_minimum(c1: float, c2: float, c3: float) -> tuple[float, float, float]:
    """Return the place of a cubic's minimum, and a bracket of it inside the step.

    Without a minimum, the place where the falling cubic is flattest. Without that either, a place
    outside the step.
    """
    root = math.sqrt(max(c2 * c2 - 3.0 * c3 * c1, 0.0))
    minimum = 2.0
    if c2 >= 0.0 > c1 and c2 + root > 0.0:
        minimum = -c1 / (c2 + root)
    elif c2 < 0.0 < c3:
        minimum = (root - c2) / (3.0 * c3)
    low, high = 0.0, 1.0
    if c3 != 0.0:
        maximum = -2.0 * c2 / (3.0 * c3) - minimum
        if c3 > 0.0:
            low = max(min(maximum, minimum), low)
        else:
            high = min(max(maximum, minimum), high)
    return minimum, low, high


@kernel
def _guard_inside(
    equations: BoundEquations, guard: int, fraction: float, unpacked: UnpackedMode, span: Span,
    w: Workspace,
) -> float:  # fmt: skip
    """Return a guard's value at a fraction of the step, from the dense solution."""
    interpolate(equations, unpacked.moving, fraction, span.h, w)
    ground = ground_in_step(fraction, span, w.ground)
    equations.guards.call(
        unpacked.mode, w.inner_state, w.inner_slope, ground.x, ground.y, w.limits, w.inner_guards,
        equations.numbers,
    )  # fmt: skip
    return w.inner_guards[guard]


@kernel
def _point_below_zero(
    equations: BoundEquations, guard: int, fraction: float, low: float, high: float,
    unpacked: UnpackedMode, span: Span, tolerance: Vector, w: Workspace,
) -> float:  # fmt: skip
    """Return a place in a predicted dip at which a guard is negative; -1 if there is none.

    Bisection by the guard's rate. For a guard that starts at zero, within its rounding noise,
    values must be below that noise.
    """
    start, noise = w.guards[guard], tolerance[guard]
    zero = 0.0 if start > noise else min(start, 0.0) - noise
    for _ in range(MAX_DIP_EVALUATIONS):
        g = _guard_inside(equations, guard, fraction, unpacked, span, w)
        if g < zero:
            return fraction
        rate = span.h * w.inner_guards[len(tolerance) + guard]
        if g - zero > abs(rate) * (high - low):  # convex: no value in the bracket is negative
            break
        if rate > 0.0:
            high = fraction
        else:
            low = fraction
        fraction = 0.5 * (low + high)
    return -1.0


@kernel
def _point_below_zero_at_rest(
    equations: BoundEquations, guard: int, unpacked: UnpackedMode, span: Span, tolerance: Vector,
    w: Workspace,
) -> float:  # fmt: skip
    """Return a place inside a step without motion at which a guard is negative, or -1.

    The guard follows the ground alone. Its least value is searched where the parabola through three
    of its values comes near zero, by golden section.
    """
    start, end, noise = w.guards[guard], w.new_guards[guard], tolerance[guard]
    zero = 0.0 if start > noise else min(start, 0.0) - noise
    middle = _guard_inside(equations, guard, 0.5, unpacked, span, w)
    c1, c2 = 4.0 * middle - 3.0 * start - end, 2.0 * (start + end - 2.0 * middle)
    lowest = start - 0.25 * c1 * c1 / c2 if c2 > 0.0 else math.inf
    if lowest - zero > DIP_MARGIN * (abs(c1) + abs(c1 + 2.0 * c2)):
        return -1.0
    low, high = 0.0, 1.0
    left, right = 1.0 - GOLDEN, GOLDEN
    at_left = _guard_inside(equations, guard, left, unpacked, span, w)
    at_right = _guard_inside(equations, guard, right, unpacked, span, w)
    for _ in range(MAX_DIP_EVALUATIONS):
        if at_left < zero or at_right < zero:
            return left if at_left < zero else right
        if at_left < at_right:
            high, right, at_right = right, left, at_left
            left = high - GOLDEN * (high - low)
            at_left = _guard_inside(equations, guard, left, unpacked, span, w)
        else:
            low, left, at_left = left, right, at_right
            right = low + GOLDEN * (high - low)
            at_right = _guard_inside(equations, guard, right, unpacked, span, w)
    return -1.0


@kernel
def _root_of_cubic(c0: float, c1: float, c2: float, c3: float, end: float) -> float:
    """Return a place before `end` at which a cubic that is positive at 0 falls through zero."""
    low, high, fraction = 0.0, end, 0.5 * end
    for _ in range(CUBIC_ITERATIONS):
        value = c0 + fraction * (c1 + fraction * (c2 + fraction * c3))
        if value > 0.0:
            low = fraction
        else:
            high = fraction
        rate = c1 + fraction * (2.0 * c2 + fraction * 3.0 * c3)
        trial = fraction - value / rate if rate < 0.0 else high
        fraction = trial if low < trial < high else 0.5 * (low + high)
    return fraction


@kernel
def _first_root(
    equations: BoundEquations, guard: int, end: float, unpacked: UnpackedMode, span: Span,
    tolerance: Vector, w: Workspace,
) -> float:  # fmt: skip
    """Return the first root of a guard before `end`, where it is negative.

    Newton's method from the root of the cubic through the guard's values and rates at both ends
    of the step, kept inside its bracket by bisection. A guard that starts at zero, within its
    rounding noise, may rise before it falls: then the root after its rise is returned, that of the
    cubic divided by u. Otherwise a corner that has just lifted off would seem to land at once.
    """
    count = len(tolerance)
    start, c1, c2, c3 = _guard_cubic(guard, span.h, tolerance, w)
    if start > tolerance[guard]:
        fraction = _root_of_cubic(start, c1, c2, c3, end)
    elif c1 > 0.0:
        fraction = _root_of_cubic(c1, c2, c3, 0.0, end)
    else:
        fraction = 0.5 * end
    low, high, last = 0.0, end, math.inf
    for _ in range(MAX_ROOT_EVALUATIONS):
        g = _guard_inside(equations, guard, fraction, unpacked, span, w)
        if g > 0.0:
            low = fraction
        else:
            high = fraction
        rate, trial = span.h * w.inner_guards[count + guard], 0.5 * (low + high)
        if rate < 0.0 and abs(g) < 0.5 * last:
            corrected = fraction - g / rate
            if low <= corrected <= high:
                trial = corrected
                if abs(trial - fraction) <= NEWTON_TOLERANCE:
                    return trial
        if high - low <= ROOT_TOLERANCE:
            break
        fraction, last = trial, abs(g)
    return fraction
