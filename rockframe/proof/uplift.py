"""A block at rest on rigid ground: whether a corner lifts under a motion, and when."""

from itertools import zip_longest

from rockframe.proof.balls import ZERO, Ball, Row, derivative_of, polynomial_value
from rockframe.proof.problem import GroundPiece, Problem, Undecided, require

_HALVINGS = 50
_NEWTON_STEPS = 12
_VERGE = "a ground that comes to the verge of uplift"


def find_uplift(
    problem: Problem, interval: int, ground: GroundPiece, left: Ball
) -> tuple[Ball, int] | None:
    """Return when it lifts in the rest of an interval [s], and the sign of its rotation; or None.

    If some members of a set lift before the sample at its end and some after it, the time encloses
    both.
    """
    try:
        times = {side: first_zero(uplift_guard(problem, ground, side), left) for side in (1, -1)}
    except Undecided:
        if not problem.is_continuous_after(interval):
            raise
        following, length = (of(interval + 1) for of in (problem.ground, problem.length))
        uplift = _uplift_about_sample(problem, ground, left, following, length)
        return None if uplift is None or uplift[0] > left else uplift
    return _earlier_uplift(times)


def _uplift_about_sample(
    problem: Problem, ground: GroundPiece, left: Ball, following: GroundPiece, length: Ball
) -> tuple[Ball, int] | None:
    times = dict[int, Ball | None]()
    for side in (1, -1):
        guard, next_guard = (uplift_guard(problem, piece, side) for piece in (ground, following))
        if next_guard[0] > 0:
            times[side] = first_zero(guard, left)
            if times[side] is None:
                after = first_zero(next_guard, length)
                times[side] = None if after is None else left + after
        else:
            times[side] = _zero_about_sample(guard, left, next_guard, length)
    return _earlier_uplift(times)


def uplift_guard(problem: Problem, ground: GroundPiece, side: int) -> Row:
    """Return the guard of uplift to a side: a polynomial, positive while it does not lift."""
    tangent = problem.corner(side).angle.tan()
    pairs = zip_longest(ground.normal, ground.along, fillvalue=ZERO)
    return [normal * tangent + side * along for normal, along in pairs]


def _zero_about_sample(before: Row, left: Ball, after: Row, length: Ball) -> Ball:
    """Enclose the zero of a guard near a sample; polynomials before and after it are given."""
    low, high = left, length
    for _ in range(_HALVINGS):
        low = (low / 2).mid()
        falls = polynomial_value(derivative_of(before), (left - low).union(left)) < 0
        if (
            polynomial_value(before, left - low) > 0
            and falls
            and first_zero(before, left - low) is None
        ):
            break
    else:
        raise Undecided(_VERGE)
    for _ in range(_HALVINGS):
        if not polynomial_value(after, high / 2) < 0:
            break
        high = (high / 2).mid()
    if not (
        polynomial_value(after, high) < 0
        and polynomial_value(derivative_of(after), ZERO.union(high)) < 0
    ):
        raise Undecided(_VERGE)
    return (left - low).union(left + high)


def _earlier_uplift(times: dict[int, Ball | None]) -> tuple[Ball, int] | None:
    uplifts = [(at, side) for side, at in times.items() if at is not None]
    if len(uplifts) < 2:
        return uplifts[0] if uplifts else None
    first, second = uplifts
    if first[0] < second[0]:
        return first
    if second[0] < first[0]:
        return second
    message = "the ground falls away under the block"
    raise Undecided(message)


def first_zero(guard: list[Ball], left: Ball) -> Ball | None:
    """Enclose the first time from 0 to `left` at which a polynomial is not positive."""
    if guard[0] < 0:
        return ZERO
    require(guard[0] > 0, "a block at rest on the verge of uplift")
    return _first_zero(guard, derivative_of(guard), ZERO, left, _HALVINGS)


def _first_zero(
    guard: list[Ball], rate: list[Ball], low: Ball, high: Ball, halvings: int
) -> Ball | None:
    """Enclose the first zero between two times; the polynomial is positive at the first."""
    span = low.union(high)
    if polynomial_value(guard, span) > 0:
        return None
    rates, last = polynomial_value(rate, span), polynomial_value(guard, high)
    if rates > 0 or (rates < 0 and last > 0):
        return None
    if rates < 0 and last < 0:
        for _ in range(_NEWTON_STEPS):
            middle = span.mid()
            span = span.intersection(
                middle - polynomial_value(guard, middle) / polynomial_value(rate, span)
            )
        return span
    middle = ((low * 5 + high * 4) / 9).mid()
    value = polynomial_value(guard, middle)
    if halvings == 0 or not (value > 0 or value < 0):
        raise Undecided(_VERGE)
    zero = _first_zero(guard, rate, low, middle, halvings - 1)
    if zero is None and value > 0:
        zero = _first_zero(guard, rate, middle, high, halvings - 1)
    return zero
