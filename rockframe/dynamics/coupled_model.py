"""Assembly of the model of a block on pads on a cap on soil."""

import math
from collections.abc import Callable

import numpy as np

from rockframe.compiled import Matrix, Vector, kernel
from rockframe.dynamics import bed, pad
from rockframe.dynamics import coupled as model
from rockframe.dynamics import coupled_layout as at
from rockframe.dynamics.coupled_corners import (
    corner_level,
    reaction,
)
from rockframe.dynamics.coupled_motion import configuration
from rockframe.dynamics.coupled_switches import switch
from rockframe.dynamics.kinematics import about_pin, pinned_point, sine_cosine_rise
from rockframe.dynamics.protocol import (
    HORIZONTAL_REFERENCE,
    ROTATION_LIMIT,
    ContactModel,
    ContactState,
)
from rockframe.dynamics.single_body import FREE, restraint_in_use, rounding_at
from rockframe.dynamics.starting import starting_by
from rockframe.dynamics.two_spring_model import (
    contact_of_corners,
    corner_tolerance,
    gliding_relaxation,
)
from rockframe.dynamics.two_spring_switches import mode_of as block_mode_of
from rockframe.dynamics.winkler import mode_of as bed_mode_of
from rockframe.dynamics.winkler_model import bed_tolerance, contact_of_bed, gliding_end


def coupled(
    *,
    half_width: float,
    half_height: float,
    inertia: float,
    mass: float,
    pad_stiffness: float,
    pad_damping: float,
    restitution: float,
    cap_half_width: float,
    cap_half_height: float,
    cap_mass: float,
    cap_inertia: float,
    soil_stiffness: float,
    soil_damping: float,
    by_pressure: bool,
    restraint: int,
    small_rotation: bool,
    gravity: float,
) -> ContactModel:
    """Assemble the model of a block on two pads on a cap on a Winkler bed.

    Parameters
    ----------
    half_width, half_height : float
        b and h of the block [m].
    inertia, mass : float
        I_O and m of the block [kg m^2], [kg].
    pad_stiffness, pad_damping : float
        k and c of one pad [N m^-1], [N s m^-1].
    restitution : float
        eps of a landing corner [1].
    cap_half_width, cap_half_height : float
        b_c and h_c [m].
    cap_mass, cap_inertia : float
        m_c and I_c about the cap's centre [kg], [kg m^2].
    soil_stiffness, soil_damping : float
        k0 and c0 per unit length of base [N m^-2], [N s m^-2].
    by_pressure : bool
        Whether the soil lets go where its pressure would be negative, too.
    restraint : int
        A rule of :mod:`rockframe.dynamics.kinematics`, for block and cap alike.
    small_rotation : bool
        Whether the kinematics of each body on its base are expanded to second order.
    gravity : float
        Acceleration of gravity [m s^-2].

    Returns
    -------
    ContactModel
    """
    radius = math.hypot(half_width, half_height)
    p = np.zeros(at.PARAMETERS)
    p[ROTATION_LIMIT] = p[at.ANGLE] = theta = math.atan2(half_width, half_height)
    p[at.GRAVITY] = gravity
    p[at.RESTRAINT] = restraint_in_use(restraint, small_rotation)
    p[at.SMALL] = float(small_rotation)
    p[at.HALF_HEIGHT] = half_height
    p[at.HALF_WIDTH] = half_width
    p[at.INERTIA] = inertia / mass
    p[at.PAD_STIFFNESS] = pad_stiffness / mass
    p[at.PAD_DAMPING] = pad_damping / mass
    p[at.PAD_SETTLEMENT] = settlement = 0.5 * gravity * mass / pad_stiffness
    p[at.RESTITUTION] = restitution
    p[at.CAP_HALF_HEIGHT] = cap_half_height
    p[at.CAP_HALF_WIDTH] = cap_half_width
    p[at.CAP_MASS] = cap_mass / mass
    p[at.CAP_INERTIA] = cap_inertia / mass
    p[at.SOIL_STIFFNESS] = soil_stiffness / mass
    p[at.SOIL_DAMPING] = soil_damping / mass
    soil_settlement = 0.5 * (mass + cap_mass) * gravity / (cap_half_width * soil_stiffness)
    p[at.SOIL_SETTLEMENT] = soil_settlement
    p[at.BY_PRESSURE] = float(by_pressure)
    modes = np.arange(at.MODES)
    contact = contact_of_corners(modes % at.BLOCK_MODES)
    soil_contact = contact_of_bed(modes // at.BLOCK_MODES)
    fastest, damping_rate = fastest_vibration(p)
    rocking = math.sqrt(gravity * radius / (radius**2 + p[at.INERTIA]))
    pads = math.sqrt(2.0 * p[at.PAD_STIFFNESS])
    soil = math.sqrt(2.0 * cap_half_width * p[at.SOIL_STIFFNESS] / (1.0 + p[at.CAP_MASS]))
    sizes = np.array([soil_settlement, theta, settlement, theta, radius * theta, radius * theta])
    rates = np.array([soil, rocking, pads, rocking, rocking, rocking])
    tolerance = corner_tolerance(at.GUARDS, radius, settlement)
    cap_radius = math.hypot(cap_half_width, cap_half_height)
    tolerance[at.SOIL_GUARDS : at.SOIL_PIVOT_GUARD] = bed_tolerance(
        bed.BED_GUARDS, cap_radius, soil_settlement
    )

    return ContactModel(
        name="coupled",
        accelerate=model.accelerate,
        guard=model.guard,
        switch=switch,
        energy=model.energy,
        observe=model.observe,
        active=np.where(
            (soil_contact == ContactState.FLIGHT) | gliding_end(modes // at.BLOCK_MODES), 6, 5
        ),
        contact=contact,
        parameters=p,
        scales=np.concatenate([sizes, sizes * rates]),
        rotation_weights=np.array([0.0, 1.0, 0.0, 1.0, 0.0, 0.0]),
        guard_tolerance=tolerance,
        relaxation=gliding_relaxation(
            modes % at.BLOCK_MODES, p[at.PAD_STIFFNESS], p[at.PAD_DAMPING]
        ),
        columns=at.COLUMNS,
        fastest_frequency=fastest,
        damping_rate=damping_rate,
        rounding=rounding(p, fastest),
        energy_scale=gravity * radius * theta,
        mass=mass,
        initial=starting_by(start_mode, at.COORDINATES, p),
        soil_contact=soil_contact,
    )


def rounding(p: Vector, fastest: float) -> Callable[[float], Vector]:
    """Estimate the rounding noise of coordinates and rates, as of a body on its base."""
    block = math.hypot(p[at.HALF_WIDTH], p[at.HALF_HEIGHT])
    cap = math.hypot(p[at.CAP_HALF_WIDTH], p[at.CAP_HALF_HEIGHT])
    turning = p[at.HALF_WIDTH] / (p[at.INERTIA] + p[at.HALF_HEIGHT] ** 2)
    settlement = p[at.PAD_SETTLEMENT] + p[at.SOIL_SETTLEMENT]
    answers = np.array([1.0, 1.0 / cap, 1.0, turning, 1.0, 1.0])
    return rounding_at(block + cap, settlement, answers, fastest)


def small_motion_matrices(p: Vector) -> tuple[Matrix, Matrix, Matrix]:
    """Give mass, damping and stiffness of small motion about rest, in full contact.

    In the order Y, phi, r, psi, per unit mass of the block, :eq:`eq-coupled-small`.
    """
    h, h_c, g = p[at.HALF_HEIGHT], p[at.CAP_HALF_HEIGHT], p[at.GRAVITY]
    b, b_c, m_c = p[at.HALF_WIDTH], p[at.CAP_HALF_WIDTH], p[at.CAP_MASS]
    high = h + 2.0 * h_c
    mass = np.array(
        [
            [1.0 + m_c, 0.0, 1.0, 0.0],
            [
                0.0,
                p[at.CAP_INERTIA] + m_c * h_c**2 + p[at.INERTIA] + high**2,
                0.0,
                p[at.INERTIA] + h * high,
            ],
            [1.0, 0.0, 1.0, 0.0],
            [0.0, p[at.INERTIA] + h * high, 0.0, p[at.INERTIA] + h**2],
        ]
    )

    def springs(soil: float, pads: float) -> Matrix:
        return np.diag([2.0 * b_c * soil, soil * b_c**3 / 1.5, 2.0 * pads, 2.0 * pads * b**2])

    stiffness = springs(p[at.SOIL_STIFFNESS], p[at.PAD_STIFFNESS])
    stiffness[1, 1] -= g * (m_c * h_c + high)
    stiffness[3, 3] -= g * h
    stiffness[1, 3] = stiffness[3, 1] = -g * h
    return mass, springs(p[at.SOIL_DAMPING], p[at.PAD_DAMPING]), stiffness


def fastest_vibration(p: Vector) -> tuple[float, float]:
    """Give bounds of angular frequency and damping rate, of both together or the cap alone."""
    mass, damping, stiffness = small_motion_matrices(p)
    cap_mass = p[at.CAP_MASS]
    turning = p[at.CAP_INERTIA] + cap_mass * p[at.CAP_HALF_HEIGHT] ** 2

    def largest(matrix: Matrix, soil: float) -> float:
        together = float(np.linalg.eigvals(np.linalg.solve(mass, matrix)).real.max())
        b_c = p[at.CAP_HALF_WIDTH]
        return max(together, 2.0 * b_c * soil / cap_mass, soil * b_c**3 / 1.5 / turning)

    return (
        math.sqrt(largest(stiffness, p[at.SOIL_STIFFNESS])),
        largest(damping, p[at.SOIL_DAMPING]),
    )


@kernel
def start_mode(
    rotation: float, spin: float, height: float, speed: float, state: Vector, memory: Vector,
    p: Vector,
) -> int:  # fmt: skip
    """Fill the state and the memory at the start of a run, and give its mode.

    The cap starts upright and at rest; rotation and height are those of the block on
    it, and NaN for a height asks for equilibrium on the pads.
    """
    delta = p[at.PAD_SETTLEMENT]
    sine, _, rise = sine_cosine_rise(p[at.HALF_HEIGHT], p[at.SMALL], rotation)
    state[at.ROTATION] = rotation
    state[at.NORMAL] = height
    if math.isnan(height):
        tilt = p[at.HALF_WIDTH] * abs(sine)
        state[at.NORMAL] = max(tilt - delta, 0.0) - rise
    state[at.COORDINATES + at.ROTATION] = spin
    state[at.COORDINATES + at.NORMAL] = speed
    left = pad.start_contact(
        corner_level(at.LEFT_GUARDS, state, p), reaction(at.LEFT_GUARDS, state, p), delta
    )
    right = pad.start_contact(
        corner_level(at.RIGHT_GUARDS, state, p), reaction(at.RIGHT_GUARDS, state, p), delta
    )
    rule = p[at.RESTRAINT]
    # upright and at rest the cap leans nowhere yet; it follows the block
    bed_mode = bed_mode_of(bed.DOWN, bed.DOWN, rotation, spin, rule)
    mode = block_mode_of(left, right, rotation, spin, rule) + at.BLOCK_MODES * bed_mode
    pivot = at.block_pivot(mode)
    pin = 0.0 if pivot == FREE else pinned_point(pivot, p[at.HALF_WIDTH])
    state[at.ALONG] = pin + about_pin(p[at.HALF_HEIGHT], p[at.SMALL], pin, rotation)
    place = configuration(mode, state, p)
    state[at.COORDINATES + at.ALONG] = 0.0 if pivot == FREE else place.slide * spin
    memory[HORIZONTAL_REFERENCE] = pinned_point(at.cap_pivot(mode), p[at.CAP_HALF_WIDTH])
    return mode
