"""Impacts of a set of states, each at its own instant; and the coming to rest by many of them."""

from typing import NamedTuple

from rockframe.proof.balls import (
    ONE,
    UNIT,
    WITHIN_ONE,
    ZERO,
    Ball,
    Matrix,
    Row,
    ball,
    hull,
    times,
    upper,
)
from rockframe.proof.flow import nearly_still, sweep
from rockframe.proof.problem import CornerNumbers, GroundPiece, Problem, Undecided, acceleration
from rockframe.proof.states import SetOfStates


class Struck(NamedTuple):
    """A set after its impacts, as if all of it had struck now."""

    states: SetOfStates
    at: Ball  # when its members strike, from now [s]
    speed: Ball  # bound of their speeds, and of those with which they leave the ground


class _Reset(NamedTuple):
    state: Row
    matrix: Matrix
    kick: Row  # derivative by the restitution
    at: Ball
    leaving: Ball


def struck(
    states: SetOfStates,
    old: CornerNumbers,
    new: CornerNumbers,
    before: GroundPiece,
    after: GroundPiece,
) -> Struck:
    """Enclose a set after its impacts.

    Every member has its impact at its own instant near now, enclosed by a step of Newton's method
    :eq:`eq-proof-impact`; it flows there, is reset, and flows back by the equations of its new
    side. The ground is that of the intervals on either side of now, which may be one.
    """
    middle = new._replace(restitution=new.restitution.mid())
    centre = _reset(states.centre, old, middle, before, after)
    whole = _reset(states.box(), old, new, before, after)
    # the uncertain inputs are the restitutions of the left corner and of the right one
    here = [new.sign < 0, new.sign > 0] if states.uncertain else []
    free = [[each if struck_on else ZERO for struck_on in here] for each in whole.kick]
    image = states.image(centre.state, whole.matrix, free)
    return Struck(image, whole.at, upper(whole.leaving.union(image.box()[1])))


def _reset(
    state: Row, old: CornerNumbers, new: CornerNumbers, before: GroundPiece, after: GroundPiece
) -> _Reset:
    """Enclose states after impact, with derivatives."""
    rotation, rate = state
    if not rate * old.sign < 0:
        message = "an impact that hardly touches the ground"
        raise Undecided(message)
    reach = 2 * upper(rotation) / ball(rate.abs_lower()) + ball(2) ** -400
    window = upper(reach) * WITHIN_ONE
    one, other = before.at(window), after.at(window)
    ground = GroundPiece(
        [one.along[0].union(other.along[0])], [one.weight[0].union(other.weight[0])]
    )
    there = sweep(state, old, ground, window)
    at = -rotation / there.rate
    if not (there.rate * old.sign < 0 and window.contains(at)):
        message = "an impact whose instant is not enclosed"
        raise Undecided(message)
    arriving = rate + there.acceleration * UNIT * at
    leaving = new.restitution * arriving
    back = sweep([ZERO, leaving], new, ground, -UNIT * at)
    if not back.rate * old.sign < 0:
        message = "a rebound without speed"
        raise Undecided(message)
    end = [-leaving * at + back.acceleration * at * at / 2, leaving - back.acceleration * at]
    jump = (back.acceleration - new.restitution * there.acceleration) / arriving
    reset = [[new.restitution, ZERO], [jump, new.restitution]]
    flow_back = nearly_still(back, new, ground, at)
    matrix = times(flow_back, times(reset, nearly_still(there, old, ground, at)))
    kick = [row[1] * arriving for row in flow_back]
    return _Reset(end, matrix, kick, at, leaving)


def resting_after(impact: Struck, problem: Problem, number: int, after: Ball) -> Ball | None:
    """Give a time within which a block that has just struck is at rest; None if not sure.

    The lemma of coming to rest, :eq:`eq-proof-rest`: while the ground lets neither corner lift,
    every excursion is slower than the last by a fixed factor.
    """
    span = ZERO
    for _ in range(4):
        ground = problem.ground_over(number, after, span)
        found = _bounces([impact.states.box()[0], impact.speed], problem, ground)
        if found is None:
            return None
        found += upper(impact.at)
        if found <= span:
            return span
        span = upper(found * 5 / 4)
    return None


def _bounces(box: Row, problem: Problem, ground: GroundPiece) -> Ball | None:
    """Bound the time of all bounces under a ground, if it is what it is for as long."""
    height, speed = (upper(one) for one in box)
    corners = problem.right, problem.left
    starts = [-acceleration(ZERO, one, ground) * one.sign for one in corners]
    if not all(one > 0 for one in starts):
        return None
    weakest = min((ball(one.lower()) for one in starts), key=float)
    # a guess of the highest excursion, which is then held to be one
    highest = upper(2 * height + speed * speed / weakest)
    pulls = [-acceleration(UNIT * highest * one.sign, one, ground) * one.sign for one in corners]
    if not all(one > 0 for one in pulls):
        return None
    lows, highs = [one.lower() for one in pulls], [one.upper() for one in pulls]
    restitution = upper(problem.right.restitution.union(problem.left.restitution))
    ratios = [high / low for low, high in zip(lows, highs, strict=True)]
    factor = restitution * upper(ratios[0].union(ratios[1])).sqrt()
    rises = [height + speed * speed / (2 * low) for low in lows]
    arriving = [(2 * high * rise).sqrt() for high, rise in zip(highs, rises, strict=True)]
    kept = restitution * upper(arriving[0].union(arriving[1]))
    safe = factor < 1 and all(
        rise < highest and kept * kept / (2 * low) < highest < one.limit
        for rise, low, one in zip(rises, lows, corners, strict=True)
    )
    if not safe:
        return None
    firsts = [speed / low + (2 * rise / low).sqrt() for low, rise in zip(lows, rises, strict=True)]
    longest = [2 * kept / low / (ONE - factor) for low in lows]
    return upper(hull(firsts)) + upper(hull(longest))
