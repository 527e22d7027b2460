"""Assembly of the model of a body on a Winkler bed: parameters, tables, initial state."""

import math

import numpy as np
from numpy.typing import NDArray

from rockframe.compiled import Integers, Vector, kernel
from rockframe.dynamics import bed
from rockframe.dynamics import single_body as body
from rockframe.dynamics import winkler as soil
from rockframe.dynamics.kinematics import about_pin, pinned_point, sine_cosine_rise
from rockframe.dynamics.protocol import (
    HORIZONTAL_REFERENCE,
    ROUNDING,
    ContactModel,
    ContactState,
)
from rockframe.dynamics.starting import starting_by


def winkler(
    *,
    half_width: float,
    centre_height: float,
    inertia: float,
    mass: float,
    stiffness: float,
    damping: float,
    by_pressure: bool,
    restraint: int,
    small_rotation: bool,
    gravity: float,
) -> ContactModel:
    """Assemble the model of a body on a Winkler bed.

    Parameters
    ----------
    half_width, centre_height : float
        b, and h of the centre of mass above the base [m].
    inertia : float
        I_O about the centre of mass [kg m^2].
    mass : float
        Mass of the body [kg].
    stiffness, damping : float
        k0 and c0 per unit length of base [N m^-2], [N s m^-2].
    by_pressure : bool
        Whether the bed lets go where its pressure would be negative, too.
    restraint : int
        A rule of :mod:`rockframe.dynamics.kinematics`.
    small_rotation : bool
        Whether the kinematics are expanded to second order.
    gravity : float
        Acceleration of gravity [m s^-2].

    Returns
    -------
    ContactModel
    """
    p = body.body_parameters(
        soil.PARAMETERS,
        half_width=half_width,
        half_height=centre_height,
        inertia=inertia / mass,
        restraint=restraint,
        small_rotation=small_rotation,
        gravity=gravity,
    )
    p[soil.STIFFNESS] = stiffness / mass
    p[soil.DAMPING] = damping / mass
    p[soil.SETTLEMENT] = settlement = 0.5 * mass * gravity / (half_width * stiffness)
    p[soil.BY_PRESSURE] = float(by_pressure)
    vertical_frequency = math.sqrt(2.0 * half_width * p[soil.STIFFNESS])
    base_inertia = p[body.INERTIA] + centre_height**2
    rotational_frequency = vertical_frequency * half_width / math.sqrt(3.0 * base_inertia)
    fastest = max(vertical_frequency, rotational_frequency)
    modes = np.arange(soil.MODES)
    contact = contact_of_bed(modes)

    return ContactModel(
        name="Winkler",
        accelerate=soil.accelerate,
        guard=soil.guard,
        switch=soil.switch,
        energy=soil.energy,
        observe=soil.observe,
        active=np.where((contact == ContactState.FLIGHT) | gliding_end(modes), 3, 2),
        contact=contact,
        parameters=p,
        scales=body.body_scales(p, settlement, vertical_frequency),
        rotation_weights=np.array([1.0, 0.0, 0.0]),
        guard_tolerance=bed_tolerance(
            soil.GUARDS, math.hypot(half_width, centre_height), settlement
        ),
        relaxation=np.zeros(soil.MODES),
        columns=soil.COLUMNS,
        fastest_frequency=fastest,
        damping_rate=damping / stiffness * fastest**2,
        rounding=body.body_rounding(p, settlement, fastest),
        energy_scale=body.energy_scale(p),
        mass=mass,
        initial=starting_by(start_mode, body.COORDINATES, p),
    )


def contact_of_bed(modes: Integers) -> Integers:
    """Give the contact state of each mode of a bed."""
    left, right = modes & 1 == bed.RAISED, modes >> 1 & 1 == bed.RAISED
    contact = np.full(len(modes), ContactState.FULL, dtype=np.int64)
    contact[left] = ContactState.RIGHT
    contact[right] = ContactState.LEFT
    contact[left & right] = ContactState.FLIGHT
    return contact


def gliding_end(modes: Integers) -> NDArray[np.bool_]:
    """Tell in which modes of a bed an end glides."""
    return modes >> 2 & 1 == bed.GLIDING


def bed_tolerance(guards: int, radius: float, settlement: float) -> Vector:
    """Estimate the rounding noise: heights are differences of terms as large as the body."""
    tolerance = np.full(guards, ROUNDING)
    tolerance[: bed.BED_GUARDS] = ROUNDING * (1.0 + radius / settlement)
    return tolerance


@kernel
def start_mode(
    rotation: float, spin: float, height: float, speed: float, state: Vector, memory: Vector,
    p: Vector,
) -> int:  # fmt: skip
    """Fill the state and the memory at the start of a run, and give its mode.

    A height of NaN asks for vertical equilibrium. The pinned point starts where
    it is when the body rests, so that x = 0 there.
    """
    sine, cosine, rise = sine_cosine_rise(p[body.HALF_HEIGHT], p[body.SMALL], rotation)
    state[body.ROTATION] = rotation
    state[body.VERTICAL] = height
    if math.isnan(height):
        middle = bed.equilibrium_middle(sine, p[body.HALF_WIDTH], p[soil.SETTLEMENT])
        state[body.VERTICAL] = middle - rise
    state[body.COORDINATES + body.ROTATION] = spin
    state[body.COORDINATES + body.VERTICAL] = speed
    ends = soil.ends_of(state, p, sine, cosine, rise)
    left, right = bed.end_state(ends.u_left), bed.end_state(ends.u_right)
    mode = soil.mode_of(left, right, rotation, spin, p[body.RESTRAINT])
    pivot = soil.pivot_in(mode)
    if pivot == body.FREE:
        state[body.HORIZONTAL] = about_pin(p[body.HALF_HEIGHT], p[body.SMALL], 0.0, rotation)
    else:
        memory[HORIZONTAL_REFERENCE] = pinned_point(pivot, p[body.HALF_WIDTH])
    return mode
