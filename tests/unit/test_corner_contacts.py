"""Contacts of corners with their pads: effects of switching one corner on the other."""

import numpy as np
import pytest

from rockframe.dynamics.base_numbers import pads_numbers
from rockframe.dynamics.bodies import BODY_DOF, ROTATION, VERTICAL
from rockframe.dynamics.body import BY_CONTACT, PIVOT_RIGHT
from rockframe.dynamics.on_base import Mode
from rockframe.dynamics.pads import (
    CORNER,
    CORNER_GUARDS,
    ENGAGING,
    LEAVE,
    LEAVING,
    REENGAGE,
    RELAXING,
    TOUCHING,
    corner_contact,
)
from rockframe.dynamics.protocol import MEMORY, Ground
from rockframe.dynamics.single_body import rigid_body, single_body
from rockframe.dynamics.switching import mode_after_disturbance

G = 9.81
BODY = rigid_body(
    left=0.5, right=0.5, height=2.0, inertia=4.25 / 3.0, restraint=BY_CONTACT, small_rotation=False,
    gravity=G,
)  # fmt: skip
SYSTEM = single_body(
    "two-spring",
    BODY,
    pads_numbers(BODY, stiffness=4e3, damping=60.0, restitution=(0.9, 0.9)),
    mass=1.0,
).system
PADS = SYSTEM.part.base
LEFT_GUARDS, RIGHT_GUARDS = 0, CORNER_GUARDS


def state_with(*, right_force):
    """Return a state with the left corner lifted and a given force on the right pad."""
    state = np.zeros(2 * BODY_DOF)
    state[ROTATION] = 0.001
    level = BODY.base_line_at(SYSTEM.state_of(0, state)).right
    state[VERTICAL] = 0.5 * PADS.rest - level
    # the force results from the velocity alone, without rotation
    speed = (PADS.law.stiffness * 0.5 * PADS.rest - right_force) / PADS.law.damping
    state[BODY_DOF + VERTICAL] = speed
    return state


def mode_of(left, right):
    return SYSTEM.part.number_of(Mode(left + CORNER * right, PIVOT_RIGHT, False))


def corners_in(mode):
    contact = SYSTEM.part.mode_of(mode).contact
    return corner_contact(contact, True), corner_contact(contact, False)


def pivot_in(mode):
    return SYSTEM.part.mode_of(mode).pivot


def switched(left, right, guard, state):
    memory = np.zeros(len(MEMORY))
    return SYSTEM.switch(mode_of(left, right), guard, state, Ground(0.0, 0.0), memory)


@pytest.mark.parametrize("contact", [LEAVING, ENGAGING])
def test_leaving_corner_reclassifies_the_waiting_corner_by_force(contact):
    """In flight no corner is held, and no re-pinning is pending."""
    new = switched(contact, TOUCHING, RIGHT_GUARDS + LEAVE, state_with(right_force=0.0))
    assert corners_in(new) == (RELAXING, TOUCHING)
    assert SYSTEM.part.is_free(SYSTEM.part.mode_of(new))


def test_event_at_one_corner_does_not_change_the_other():
    new = switched(LEAVING, ENGAGING, RIGHT_GUARDS + REENGAGE, state_with(right_force=G))
    assert corners_in(new) == (LEAVING, TOUCHING)
    assert pivot_in(new) == PIVOT_RIGHT


def test_leaving_corner_released_by_its_pad_is_relaxing():
    new = switched(LEAVING, TOUCHING, LEFT_GUARDS + REENGAGE, state_with(right_force=G))
    assert corners_in(new) == (RELAXING, TOUCHING)


def test_ground_disturbance_relaxes_a_leaving_corner():
    state = state_with(right_force=G)
    new = mode_after_disturbance(SYSTEM, SYSTEM.part, 0, mode_of(LEAVING, TOUCHING), state)
    assert corners_in(new) == (RELAXING, TOUCHING)
    assert pivot_in(new) == PIVOT_RIGHT
