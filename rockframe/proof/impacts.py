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
    dot,
    magnitude,
    matrix_product,
)
from rockframe.proof.flow import SetOfStates, bound_motion, short_flow
from rockframe.proof.problem import CornerNumbers, Deviations, GroundPiece, require


class ImpactEnclosure(NamedTuple):
    """A set after its impacts, as if all members had struck now."""

    states: SetOfStates
    at: Ball  # times at which its members strike, from now [s]
    height: Ball  # bound of the rotations now, of members that have not struck yet, too
    speed: Ball  # likewise of the rates


class _Reset(NamedTuple):
    state: Row  # after impact
    matrix: Matrix  # derivative by the state before
    by_inputs: Matrix  # derivative by the uncertain inputs
    at: Ball  # times of impact, from now [s]
    approach_rate: Ball  # rates before the impact


def enclose_impact(
    states: SetOfStates,
    old: CornerNumbers,
    new: CornerNumbers,
    before: GroundPiece,
    after: GroundPiece,
) -> ImpactEnclosure:
    """Enclose a set after its impacts.

    Each member has its impact at its own time near now, which a step of Newton's method encloses,
    :eq:`eq-proof-impact`. It follows the equations of the old side to that time, is reset, and then
    follows the equations of the new side back to now. `before` and `after` are the ground of the
    intervals on either side of now, or of the same one.
    """
    centre = _reset(states.centre, old.middle(), new.middle(), before.middle, after.middle)
    reset = _reset(states.box(), old, new, before, after)
    image = states.image(
        centre.state, reset.matrix, reset.by_inputs if states.uncertain else [[], []]
    )
    rotation, rate = image.box()
    approach_rate = reset.approach_rate
    height = magnitude(rotation.union(approach_rate * magnitude(reset.at)))
    return ImpactEnclosure(image, reset.at, height, magnitude(rate.union(approach_rate)))


def _reset(
    state: Row, old: CornerNumbers, new: CornerNumbers, before: GroundPiece, after: GroundPiece
) -> _Reset:
    """Enclose the states after an impact, with their derivatives."""
    rotation, rate = state
    require(rate * old.sign < 0, "an impact that hardly touches the ground")
    reach = 2 * magnitude(rotation) / ball(rate.abs_lower()) + ball(2) ** -400
    window = magnitude(reach) * WITHIN_ONE
    earlier, later = before.at(window), after.at(window)
    ground = earlier.union(later)
    before_impact = bound_motion(state, old, ground, window)
    at = -rotation / before_impact.rate
    require(
        before_impact.rate * old.sign < 0 and window.contains(at),
        "an impact whose instant is not enclosed",
    )
    arriving = rate + before_impact.acceleration * UNIT * at
    leaving = new.restitution * arriving
    after_impact = bound_motion([ZERO, leaving], new, ground, -UNIT * at)
    require(after_impact.rate * old.sign < 0, "a rebound without speed")
    end = [
        -leaving * at + after_impact.acceleration * at * at / 2,
        leaving - after_impact.acceleration * at,
    ]
    jump = (after_impact.acceleration - new.restitution * before_impact.acceleration) / arriving
    reset = [[new.restitution, ZERO], [jump, new.restitution]]
    flow_before = short_flow(before_impact, old, ground, at)
    flow_after = short_flow(after_impact, new, ground, at)
    after_reset = matrix_product(flow_after.matrix, reset)
    by_inputs = [
        list(
            Deviations.of(
                new.sign,
                restitution=back_row[1] * arriving,
                angle=flow_after.angle,
                other_angle=dot(row, [flow_before.angle] * 2),
                scale=dot(row, [flow_before.scale] * 2) + flow_after.scale,
            )
        )
        for back_row, row in zip(flow_after.matrix, after_reset, strict=True)
    ]
    return _Reset(
        end, matrix_product(after_reset, flow_before.matrix), by_inputs, at, before_impact.rate
    )
