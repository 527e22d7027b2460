"""Finding where a guard falls through zero inside a step."""

import math
from typing import Final

from rockframe.compiled import kernel
from rockframe.solve.equations import Equations, write_guards
from rockframe.solve.guards import DIP_MARGIN
from rockframe.solve.hermite import interpolate
from rockframe.solve.workspace import Span, Tables, Workspace

HALVINGS: Final = 40
"""Halvings of a step in which a guard that rises from zero and falls again is looked for."""

ROOT_TOLERANCE: Final = 1e-13
"""Width of the bracket, as a share of the step, at which the search for a root ends."""


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
def _positive_place(
    equations: Equations,
    which: int,
    end: float,
    mode: int,
    count: int,
    span: Span,
    tables: Tables,
    w: Workspace,
) -> float:
    """Give a place before `end` where a guard that rises from zero is positive.

    The way back from the end is halved until it is; 0 if it never is.
    """
    place = end
    for _ in range(HALVINGS):
        place *= 0.5
        if _guard_inside(equations, which, place, mode, count, span, tables, w) > 0.0:
            return place
    return 0.0


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

    Illinois' variant of false position, kept inside its bracket by bisection. A guard that
    starts at its limit, within its rounding noise, may rise before it falls: the search
    then begins where it is positive. Otherwise only bisection can tell: a corner that has
    just left is not about to land.
    """
    low, high = 0.0, end
    g_low = _guard_inside(equations, which, low, mode, count, span, tables, w)
    g_high = _guard_inside(equations, which, high, mode, count, span, tables, w)
    if g_high >= 0.0:
        return high
    rise = span.h * w.before[len(tables.tolerance) + which]
    tolerance = tables.tolerance[which]
    if g_low <= tolerance and rise > 0.0:
        low = _positive_place(equations, which, end, mode, count, span, tables, w)
        g_low = _guard_inside(equations, which, low, mode, count, span, tables, w)
    last = 0
    for _ in range(100):
        if high - low <= ROOT_TOLERANCE:
            break
        middle = 0.5 * (low + high)
        if g_low > tolerance:
            trial = (low * g_high - high * g_low) / (g_high - g_low)
            if low < trial < high:
                middle = trial
        g = _guard_inside(equations, which, middle, mode, count, span, tables, w)
        if g == 0.0:
            return middle
        if g > 0.0:
            low, g_low = middle, g
            if last == 1:
                g_high *= 0.5
            last = 1
        else:
            high, g_high = middle, g
            if last == -1:
                g_low *= 0.5
            last = -1
    return high
