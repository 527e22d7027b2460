"""Finding where a guard falls through zero inside a step."""

import math
from typing import Final

from rockframe.compiled import kernel
from rockframe.solve.equations import Equations, write_guards
from rockframe.solve.guards import DIP_MARGIN
from rockframe.solve.hermite import interpolate
from rockframe.solve.workspace import Span, Tables, Workspace

ROOT_TOLERANCE: Final = 1e-13
"""Width of the bracket, as a share of the step, at which the search for a root ends."""
SEARCHING: Final = 100
"""Most guards evaluated in that search; halving alone takes 44."""
GUESSING: Final = 5
"""Corrections of the guess with which it begins."""
CONVERGED: Final = 1e-7
"""Correction, as a share of the step, whose square is rounding: the last one of Newton's method."""


@kernel
def earliest_crossing(
    equations: Equations,
    mode: int,
    count: int,
    span: Span,
    tables: Tables,
    w: Workspace,
) -> tuple[int, float]:
    """Give the guard that falls through zero first, and where (a fraction of the step).

    Looks at the step's end and, where a guard falls at first and rises at last,
    for a dip in between. Gives -1 if no guard crosses.
    """
    guards = len(tables.tolerance)
    found = -1
    place = 2.0
    for i in range(guards):
        armed = w.before[i] > tables.tolerance[i]
        end = -1.0
        if w.after[i] < 0.0:
            end = 1.0
        elif armed and w.before[guards + i] < 0.0 and w.after[guards + i] > 0.0:
            fall = span.h * w.before[guards + i]
            rise = span.h * w.after[guards + i]
            bottom, depth = _dip(w.before[i], fall, w.after[i], rise)
            if depth < DIP_MARGIN * (rise - fall):
                end = _point_below_zero(equations, i, bottom, mode, count, span, tables, w)
        if end >= 0.0:
            root = _first_root(equations, i, end, mode, count, span, tables, w)
            if root < place:
                found = i
                place = root
    return found, place


@kernel
def _dip(g0: float, fall: float, g1: float, rise: float) -> tuple[float, float]:
    """Give place and depth of the lowest point of a cubic that falls at 0 and rises at 1."""
    c2 = 3.0 * (g1 - g0) - 2.0 * fall - rise
    c3 = 2.0 * (g0 - g1) + fall + rise
    u = -fall / (c2 + math.sqrt(max(c2 * c2 - 3.0 * c3 * fall, 0.0)))
    u = min(max(u, 0.0), 1.0)
    return u, g0 + u * (fall + u * (c2 + u * c3))


@kernel
def _guard_inside(
    equations: Equations,
    which: int,
    fraction: float,
    mode: int,
    count: int,
    span: Span,
    tables: Tables,
    w: Workspace,
) -> float:
    """Give a guard's value at a fraction of the step, from the dense solution."""
    interpolate(equations, count, fraction, span.h, w)
    write_guards(equations, mode, w.scratch, w.scratch_rates, fraction, span, w.inside, w)
    return w.inside[which]


@kernel
def _point_below_zero(
    equations: Equations,
    which: int,
    bottom: float,
    mode: int,
    count: int,
    span: Span,
    tables: Tables,
    w: Workspace,
) -> float:
    """Search around a predicted dip (golden section); -1 if the guard stays positive."""
    low = max(bottom - 0.25, 0.0)
    high = min(bottom + 0.25, 1.0)
    for _ in range(40):
        left = low + 0.381966 * (high - low)
        right = low + 0.618034 * (high - low)
        g_left = _guard_inside(equations, which, left, mode, count, span, tables, w)
        if g_left < 0.0:
            return left
        g_right = _guard_inside(equations, which, right, mode, count, span, tables, w)
        if g_right < 0.0:
            return right
        if g_left < g_right:
            high = right
        else:
            low = left
    return -1.0


@kernel
def _root_of_cubic(c0: float, c1: float, c2: float, c3: float, end: float) -> float:
    """Give a place before `end` at which a cubic that is positive at 0 falls through zero."""
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
    equations: Equations,
    which: int,
    end: float,
    mode: int,
    count: int,
    span: Span,
    tables: Tables,
    w: Workspace,
) -> float:
    """Give the first root between the step's start and `end` (negative).

    Newton's method from the root of the cubic through the guard's values and rates at both ends
    of the step, kept inside its bracket by bisection. A guard that starts at its limit, within
    its rounding noise, may rise before it falls: the root sought is then the one behind its
    rise, of the cubic without its root at the start. A corner that has just left is not about
    to land.
    """
    guards = len(tables.tolerance)
    start, c1 = w.before[which], span.h * w.before[guards + which]
    rise, bend = w.after[which] - start - c1, span.h * w.after[guards + which] - c1
    c2, c3 = 3.0 * rise - bend, bend - 2.0 * rise
    if start > tables.tolerance[which]:
        place = _root_of_cubic(start, c1, c2, c3, end)
    elif c1 > 0.0:
        place = _root_of_cubic(c1, c2, c3, 0.0, end)
    else:
        place = 0.5 * end
    low, high, last = 0.0, end, math.inf
    for _ in range(SEARCHING):
        g = _guard_inside(equations, which, place, mode, count, span, tables, w)
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
