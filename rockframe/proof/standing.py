"""A block that stands: whether it goes on standing under a motion, or when a corner lifts."""

from itertools import zip_longest

from rockframe.proof.balls import ZERO, Ball, slope, value
from rockframe.proof.problem import GroundPiece, Problem, Undecided

_HALVINGS = 50
_NEWTON_STEPS = 12


def lifts(problem: Problem, ground: GroundPiece, left: Ball) -> tuple[Ball, int] | None:
    """Give when it lifts within a time, and the sign of its rotation; None if it stands."""
    found: list[tuple[Ball, int]] = []
    for side in (1, -1):
        tangent = problem.corner(side).angle.tan()
        pairs = zip_longest(ground.weight, ground.along, fillvalue=ZERO)
        guard = [weight * tangent + side * along for weight, along in pairs]
        at = first_zero(guard, left)
        if at is not None:
            found.append((at, side))
    if len(found) < 2:
        return found[0] if found else None
    one, other = found
    if one[0] < other[0]:
        return one
    if other[0] < one[0]:
        return other
    message = "the ground falls away under the block"
    raise Undecided(message)


def first_zero(guard: list[Ball], left: Ball) -> Ball | None:
    """Enclose the first time from 0 to `left` at which a polynomial is not positive."""
    if guard[0] < 0:
        return ZERO
    if not guard[0] > 0:
        message = "a block at rest on the verge of uplift"
        raise Undecided(message)
    return _first_zero(guard, slope(guard), ZERO, left, _HALVINGS)


def _first_zero(
    guard: list[Ball], rate: list[Ball], low: Ball, high: Ball, halvings: int
) -> Ball | None:
    """Look between two times, at the first of which the polynomial is positive."""
    span = low.union(high)
    if value(guard, span) > 0:
        return None
    rates, last = value(rate, span), value(guard, high)
    if rates > 0 or (rates < 0 and last > 0):
        return None
    if rates < 0 and last < 0:
        for _ in range(_NEWTON_STEPS):
            middle = span.mid()
            span = span.intersection(middle - value(guard, middle) / value(rate, span))
        return span
    middle = ((low * 5 + high * 4) / 9).mid()
    there = value(guard, middle)
    if halvings == 0 or not (there > 0 or there < 0):
        message = "a ground that comes to the verge of uplift"
        raise Undecided(message)
    found = _first_zero(guard, rate, low, middle, halvings - 1)
    if found is None and there > 0:
        found = _first_zero(guard, rate, middle, high, halvings - 1)
    return found
