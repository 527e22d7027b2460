"""Impacts of a set of states, each at its own instant."""

from typing import NamedTuple

from rockframe.proof.balls import (
    UNIT,
    WITHIN_ONE,
    ZERO,
    Ball,
    Matrix,
    Row,
    ball,
    times,
    total,
    upper,
)
from rockframe.proof.flow import nearly_still, sweep
from rockframe.proof.problem import (
    CornerNumbers,
    Deviations,
    GroundPiece,
    Undecided,
)
from rockframe.proof.states import SetOfStates


class Struck(NamedTuple):
    """A set after its impacts, as if all members had struck now."""

    states: SetOfStates
    at: Ball  # times at which its members strike, from now [s]
    height: Ball  # bound of the rotations now, of members that have not struck yet, too
    speed: Ball  # likewise of the rates


class _Reset(NamedTuple):
    state: Row  # after impact
    matrix: Matrix  # derivative by the state before
    free: Matrix  # derivative by the uncertain inputs
    at: Ball  # times of impact, from now [s]
    coming: Ball  # rates before the impact


def struck(
    states: SetOfStates,
    old: CornerNumbers,
    new: CornerNumbers,
    before: GroundPiece,
    after: GroundPiece,
) -> Struck:
    """Enclose a set after its impacts.

    Each member has its impact at its own time near now, which a step of Newton's method encloses,
    :eq:`eq-proof-impact`. It follows the equations of the old side to that time, is reset, and then
    follows the equations of the new side back to now. `before` and `after` are the ground of the
    intervals on either side of now, or of the same one.
    """
    centre = _reset(states.centre, old.middle(), new.middle(), before.middle, after.middle)
    whole = _reset(states.box(), old, new, before, after)
    image = states.image(centre.state, whole.matrix, whole.free if states.uncertain else [[], []])
    rotation, rate = image.box()
    coming = whole.coming
    height = upper(rotation.union(coming * upper(whole.at)))
    return Struck(image, whole.at, height, upper(rate.union(coming)))


def _reset(
    state: Row, old: CornerNumbers, new: CornerNumbers, before: GroundPiece, after: GroundPiece
) -> _Reset:
    """Enclose the states after an impact, with their derivatives."""
    rotation, rate = state
    if not rate * old.sign < 0:
        message = "an impact that hardly touches the ground"
        raise Undecided(message)
    reach = 2 * upper(rotation) / ball(rate.abs_lower()) + ball(2) ** -400
    window = upper(reach) * WITHIN_ONE
    one, other = before.at(window), after.at(window)
    ground = one.united(other)
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
    come, go = nearly_still(there, old, ground, at), nearly_still(back, new, ground, at)
    turned = times(go.matrix, reset)
    free = [
        list(
            Deviations.of(
                new.sign,
                restitution=back_row[1] * arriving,
                angle=go.angle,
                other_angle=total(row, [come.angle] * 2),
                scale=total(row, [come.scale] * 2) + go.scale,
            )
        )
        for back_row, row in zip(go.matrix, turned, strict=True)
    ]
    return _Reset(end, times(turned, come.matrix), free, at, there.rate)
