"""Assembly of the two-pad model: parameters, tables and initial state."""

import math

import numpy as np

from rockframe.compiled import Vector, kernel
from rockframe.dynamics import two_spring as two
from rockframe.dynamics.protocol import (
    HORIZONTAL_REFERENCE,
    MEMORY_SIZE,
    ROTATION_LIMIT,
    ContactModel,
    ContactState,
    Start,
)
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
        :mod:`rockframe.dynamics.two_spring`.
    small_rotation : bool
        Whether the kinematics are expanded to second order.
    gravity : float
        Acceleration of gravity [m s^-2].

    Returns
    -------
    ContactModel
    """
    angle = math.atan2(half_width, half_height)
    radius = math.hypot(half_width, half_height)
    p = np.zeros(two.PARAMETERS)
    p[ROTATION_LIMIT] = p[two.ANGLE] = angle
    p[two.GRAVITY] = gravity
    p[two.HALF_HEIGHT] = half_height
    p[two.HALF_WIDTH] = half_width
    p[two.INERTIA] = radius**2 / shape_factor
    p[two.STIFFNESS] = stiffness / mass
    p[two.DAMPING] = damping / mass
    p[two.SETTLEMENT] = settlement = 0.5 * gravity * mass / stiffness
    p[two.RESTITUTION] = restitution
    p[two.RESTRAINT] = two.CENTRE if small_rotation else restraint
    p[two.SMALL] = float(small_rotation)
    vertical_frequency = math.sqrt(2.0 * p[two.STIFFNESS])
    frequency = math.sqrt(gravity * radius / (radius**2 + p[two.INERTIA]))
    modes = np.arange(two.MODES)
    left_free = (modes & 3) >= two.RELAXING
    right_free = (modes >> 2 & 3) >= two.RELAXING
    contact = np.full(two.MODES, ContactState.FULL, dtype=np.int64)
    contact[left_free] = ContactState.RIGHT
    contact[right_free] = ContactState.LEFT
    contact[left_free & right_free] = ContactState.FLIGHT
    rotational = half_width * math.sqrt(2.0 * p[two.STIFFNESS] / (p[two.INERTIA] + half_height**2))

    def initial(start: Start) -> tuple[int, Vector, Vector]:
        state, memory = np.zeros(2 * two.COORDINATES), np.zeros(MEMORY_SIZE)
        height = start.vertical_displacement
        mode = start_mode(
            start.rotation,
            start.angular_velocity,
            math.nan if height is None else height,
            start.vertical_velocity,
            state,
            memory,
            p,
        )
        return mode, state, memory

    return ContactModel(
        name="two-spring",
        accelerate=two.accelerate,
        guard=two.guard,
        switch=switch,
        energy=two.energy,
        observe=two.observe,
        active=np.where(contact == ContactState.FLIGHT, 3, 2),
        contact=contact,
        parameters=p,
        scales=np.array(
            [
                angle,
                settlement,
                radius * angle,
                angle * frequency,
                settlement * vertical_frequency,
                radius * angle * frequency,
            ]
        ),
        rotation_weights=np.array([1.0, 0.0, 0.0]),
        guard_tolerance=_guard_tolerance(p, radius),
        lazy_guard=np.array([0, 1, 0, 0, 1, 0, 0, 0]),
        columns=two.COLUMNS,
        fastest_frequency=max(vertical_frequency, rotational),
        energy_scale=gravity * radius * angle,
        mass=mass,
        initial=initial,
    )


def _guard_tolerance(p: Vector, radius: float) -> Vector:
    """Estimate the rounding noise: heights are differences of terms as large as the block."""
    noise = 4.0 * np.finfo(float).eps
    gap = noise * (1.0 + radius / p[two.SETTLEMENT])
    tolerance = np.full(two.GUARDS, gap)
    tolerance[[two.TURN, two.RIGHT_GUARDS + two.TURN]] = noise
    tolerance[[two.PIVOT_GUARD, two.LIMIT_GUARD]] = noise
    return tolerance


@kernel
def equilibrium_height(rotation: float, p: Vector) -> float:
    """Give y of vertical equilibrium at a rotation, both pads bearing or only one [m]."""
    sine, _, rise = two.sine_cosine_rise(p, rotation)
    half = p[two.HALF_WIDTH] * abs(sine)
    if half <= p[two.SETTLEMENT]:
        return -rise
    return half - rise - p[two.SETTLEMENT]


@kernel
def start_contact(first: int, state: Vector, p: Vector) -> int:
    """Give a corner's contact at the start of a run."""
    if corner_level(first, state, p) >= p[two.SETTLEMENT]:
        return two.CLEAR
    return two.TOUCHING if reaction(first, state, p) > 0.0 else two.RELAXING


@kernel
def start_mode(
    rotation: float, spin: float, height: float, speed: float, state: Vector, memory: Vector,
    p: Vector,
) -> int:  # fmt: skip
    """Fill the state and the memory at the start of a run, and give its mode.

    A height of NaN asks for vertical equilibrium. The pinned point starts where
    it is when the block rests, so that x = 0 there.
    """
    state[two.ROTATION] = rotation
    state[two.VERTICAL] = equilibrium_height(rotation, p) if math.isnan(height) else height
    state[two.COORDINATES + two.ROTATION] = spin
    state[two.COORDINATES + two.VERTICAL] = speed
    left = start_contact(two.LEAVE, state, p)
    right = start_contact(two.RIGHT_GUARDS, state, p)
    mode = mode_of(left, right, rotation, spin, p)
    memory[HORIZONTAL_REFERENCE] = two.pinned_point(mode, p)
    if two.in_flight(mode):
        state[two.HORIZONTAL] = two.about_pin(0.0, rotation, p)
    return mode
