"""Assembly of the two-pad model: parameters, tables and initial state."""

import math

import numpy as np
from numpy.typing import NDArray

from rockframe.compiled import Integers, Vector, kernel
from rockframe.dynamics import pad
from rockframe.dynamics import single_body as body
from rockframe.dynamics import two_spring as two
from rockframe.dynamics.kinematics import about_pin, pinned_point, sine_cosine_rise
from rockframe.dynamics.protocol import (
    HORIZONTAL_REFERENCE,
    ROUNDING,
    ContactModel,
    ContactState,
)
from rockframe.dynamics.starting import starting_by
from rockframe.dynamics.two_spring_switches import corner_level, mode_of, reaction, switch


def two_spring(
    *,
    half_width: float,
    half_height: float,
    shape_factor: float,
    mass: float,
    stiffness: float,
    damping: float,
    restitution: float,
    restraint: int,
    small_rotation: bool,
    gravity: float,
) -> ContactModel:
    """Assemble the model of a block on two pads.

    Parameters
    ----------
    half_width, half_height : float
        b and h [m].
    shape_factor : float
        mu [1].
    mass : float
        Mass of the block [kg].
    stiffness, damping : float
        k and c of one pad [N m^-1], [N s m^-1].
    restitution : float
        eps of a landing corner [1].
    restraint : int
        ``BY_CONTACT``, ``LEADING_CORNER`` or ``CENTRE`` of
        :mod:`rockframe.dynamics.kinematics`.
    small_rotation : bool
        Whether the kinematics are expanded to second order.
    gravity : float
        Acceleration of gravity [m s^-2].

    Returns
    -------
    ContactModel
    """
    radius = math.hypot(half_width, half_height)
    p = body.body_parameters(
        two.PARAMETERS,
        half_width=half_width,
        half_height=half_height,
        inertia=radius**2 / shape_factor,
        restraint=restraint,
        small_rotation=small_rotation,
        gravity=gravity,
    )
    p[two.STIFFNESS] = stiffness / mass
    p[two.DAMPING] = damping / mass
    p[two.SETTLEMENT] = settlement = 0.5 * gravity * mass / stiffness
    p[two.RESTITUTION] = restitution
    vertical_frequency = math.sqrt(2.0 * p[two.STIFFNESS])
    base_inertia = p[body.INERTIA] + half_height**2
    rotational_frequency = half_width * math.sqrt(2.0 * p[two.STIFFNESS] / base_inertia)
    fastest = max(vertical_frequency, rotational_frequency)
    modes = np.arange(two.MODES)
    contact = contact_of_corners(modes)

    return ContactModel(
        name="two-spring",
        accelerate=two.accelerate,
        guard=two.guard,
        switch=switch,
        energy=two.energy,
        observe=two.observe,
        active=np.where((contact == ContactState.FLIGHT) | gliding_corner(modes), 3, 2),
        contact=contact,
        parameters=p,
        scales=body.body_scales(p, settlement, vertical_frequency),
        rotation_weights=np.array([1.0, 0.0, 0.0]),
        guard_tolerance=corner_tolerance(two.GUARDS, radius, settlement),
        relaxation=gliding_relaxation(modes, p[two.STIFFNESS], p[two.DAMPING]),
        columns=two.COLUMNS,
        fastest_frequency=fastest,
        damping_rate=damping / stiffness * fastest**2,
        rounding=body.body_rounding(p, settlement, fastest),
        energy_scale=body.energy_scale(p),
        mass=mass,
        initial=starting_by(start_mode, body.COORDINATES, p),
    )


def contact_of_corners(modes: Integers) -> Integers:
    """Give the contact state of modes that hold two corners' contacts in their low bits."""
    left_free = modes & pad.CORNER_MASK >= pad.RELAXING
    right_free = modes >> pad.CORNER_BITS & pad.CORNER_MASK >= pad.RELAXING
    contact = np.full(len(modes), ContactState.FULL, dtype=np.int64)
    contact[left_free] = ContactState.RIGHT
    contact[right_free] = ContactState.LEFT
    contact[left_free & right_free] = ContactState.FLIGHT
    return contact


def gliding_corner(modes: Integers) -> NDArray[np.bool_]:
    """Tell in which of such modes a corner glides."""
    return modes >= two.GLIDING * pad.CONTACTS


def corner_tolerance(guards: int, radius: float, settlement: float) -> Vector:
    """Estimate the rounding noise: heights are differences of terms as large as the block."""
    tolerance = np.full(guards, ROUNDING)
    for first in (two.LEFT_GUARDS, two.RIGHT_GUARDS):
        for guard in (pad.LEAVE, pad.REENGAGE):
            tolerance[first + guard] = pad.reaction_noise(radius, settlement)
    return tolerance


def gliding_relaxation(modes: Integers, stiffness: float, damping: float) -> Vector:
    """Give the rate at which a gliding corner follows its pad in each of such modes [s^-1]."""
    return np.where(gliding_corner(modes), pad.relaxation_rate(stiffness, damping), 0.0)


@kernel
def equilibrium_height(rotation: float, p: Vector) -> float:
    """Give y of vertical equilibrium at a rotation, both pads bearing or only one [m]."""
    sine, _, rise = sine_cosine_rise(p[body.HALF_HEIGHT], p[body.SMALL], rotation)
    half = p[body.HALF_WIDTH] * abs(sine)
    if half <= p[two.SETTLEMENT]:
        return -rise
    return half - rise - p[two.SETTLEMENT]


@kernel
def start_mode(
    rotation: float, spin: float, height: float, speed: float, state: Vector, memory: Vector,
    p: Vector,
) -> int:  # fmt: skip
    """Fill the state and the memory at the start of a run, and give its mode.

    A height of NaN asks for vertical equilibrium. The pinned point starts where
    it is when the block rests, so that x = 0 there.
    """
    state[body.ROTATION] = rotation
    state[body.VERTICAL] = equilibrium_height(rotation, p) if math.isnan(height) else height
    state[body.COORDINATES + body.ROTATION] = spin
    state[body.COORDINATES + body.VERTICAL] = speed
    left = pad.start_contact(
        corner_level(two.LEFT_GUARDS, state, p),
        reaction(two.LEFT_GUARDS, state, p),
        p[two.SETTLEMENT],
    )
    right = pad.start_contact(
        corner_level(two.RIGHT_GUARDS, state, p),
        reaction(two.RIGHT_GUARDS, state, p),
        p[two.SETTLEMENT],
    )
    mode = mode_of(left, right, rotation, spin, p[body.RESTRAINT])
    memory[HORIZONTAL_REFERENCE] = pinned_point(two.held_pivot(mode), p[body.HALF_WIDTH])
    if two.in_flight(mode):
        state[body.HORIZONTAL] = about_pin(p[body.HALF_HEIGHT], p[body.SMALL], 0.0, rotation)
    return mode
