"""Contacts of corners with their pads, switched by hand: what one corner does to the other."""

import numpy as np
import pytest

from rockframe.dynamics import pad
from rockframe.dynamics.kinematics import PIVOT_RIGHT
from rockframe.dynamics.two_spring import (
    DAMPING,
    LEFT_GUARDS,
    RIGHT_GUARDS,
    SETTLEMENT,
    STIFFNESS,
    in_flight,
)
from rockframe.dynamics.two_spring_model import two_spring
from rockframe.dynamics.two_spring_switches import corner_level, judged_anew_in, switch

G = 9.81
MODEL = two_spring(
    half_width=0.5, half_height=2.0, shape_factor=3.0, mass=1.0, stiffness=4e3, damping=60.0,
    restitution=0.9, restraint=0, small_rotation=False, gravity=G,
)  # fmt: skip
P = MODEL.parameters


def state_with(*, right_force):
    """Give a state with the left corner up, and the right one at a force of its pad's law."""
    state = np.zeros(6)
    state[0] = 0.001
    state[1] = 0.5 * P[SETTLEMENT] - corner_level(RIGHT_GUARDS, state, P)
    # the force by the speed alone, without rotation
    state[4] = (P[STIFFNESS] * 0.5 * P[SETTLEMENT] - right_force) / P[DAMPING]
    return state


def switched(left, right, guard, state):
    memory = np.zeros(5)
    mode = pad.both_corners(left, right) + pad.CONTACTS * PIVOT_RIGHT
    new = switch(mode, guard, state, 0.0, 0.0, P, memory)
    return new, *pad.corners_in(new)


@pytest.mark.parametrize("contact", [pad.LEAVING, pad.ENGAGING])
def test_what_waits_beside_a_corner_that_leaves_is_judged_by_its_force(contact):
    """The block flies: nothing is held, and nothing of its own re-pinning is left to wait for."""
    new, left, _ = switched(
        contact, pad.TOUCHING, RIGHT_GUARDS + pad.LEAVE, state_with(right_force=0.0)
    )
    assert left == pad.RELAXING
    assert in_flight(new) or pad.corners_in(new)[1] == pad.TOUCHING


def test_a_silent_event_of_one_corner_leaves_the_other_as_it_is():
    state = state_with(right_force=G)
    new, left, right = switched(pad.LEAVING, pad.ENGAGING, RIGHT_GUARDS + pad.TURN, state)
    assert (left, right) == (pad.LEAVING, pad.TOUCHING)
    assert new // pad.CONTACTS == PIVOT_RIGHT


def test_a_leaving_corner_that_its_pad_lets_go_is_relaxing():
    _, left, right = switched(
        pad.LEAVING, pad.TOUCHING, LEFT_GUARDS + pad.REENGAGE, state_with(right_force=G)
    )
    assert (left, right) == (pad.RELAXING, pad.TOUCHING)


def test_a_jolt_of_the_ground_makes_a_leaving_corner_relax():
    mode = pad.both_corners(pad.LEAVING, pad.TOUCHING) + pad.CONTACTS * PIVOT_RIGHT
    new = judged_anew_in(mode, state_with(right_force=G), P)
    assert pad.corners_in(new) == (pad.RELAXING, pad.TOUCHING)
    assert new // pad.CONTACTS == PIVOT_RIGHT
