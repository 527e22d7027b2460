"""A block on rigid ground (Housner), section "Rigid ground" of the theory manual.

Equation of motion :eq:`eq-rigid-rocking`, impact :eq:`eq-rigid-impact`, energies
:eq:`eq-rigid-energy`. All quantities per unit mass.
"""

import math
from typing import Final

import numpy as np

from rockframe.compiled import Vector, callback, kernel
from rockframe.dynamics.protocol import (
    ACCELERATE,
    ENERGY,
    GUARD,
    IMPACT,
    IMPACT_LOSS,
    LAST_EVENT,
    MEMORY_SIZE,
    OBSERVE,
    REST,
    ROTATION_LIMIT,
    SWITCH,
    UPLIFT,
    ContactModel,
    ContactState,
    Start,
)

# parameters, after ROTATION_LIMIT
GRAVITY: Final = 1  # g
ANGLE: Final = 2  # theta
RADIUS: Final = 3  # R0
CORNER_INERTIA: Final = 4  # I_O/m + R0^2
RESTITUTION: Final = 5  # eps
SMALL: Final = 6  # 1 for small rotation
TANGENT: Final = 7  # tan theta; theta for small rotation
PARAMETERS: Final = 8

# modes; rocking on the right corner has alpha > 0
RESTING: Final = 0
ON_RIGHT: Final = 1
ON_LEFT: Final = 2

# guards
IMPACT_GUARD: Final = 0
UPLIFT_ON_RIGHT: Final = 1
UPLIFT_ON_LEFT: Final = 2
LIMIT_GUARD: Final = 3
GUARDS: Final = 4

REST_AMPLITUDE: Final = 1e-10
"""Share of theta below which a rebound is taken for rest. It is far below what any
accuracy setting resolves, and ends the endless series of ever smaller impacts."""

COLUMNS: Final = (
    "rotation",
    "angular_velocity",
    "vertical_displacement",
    "vertical_velocity",
    "horizontal_displacement",
    "left_reaction",
    "right_reaction",
)


@kernel
def side_of(mode: int) -> float:
    """Give s = sgn(alpha) of a rocking mode, 0 at rest."""
    if mode == ON_RIGHT:
        return 1.0
    if mode == ON_LEFT:
        return -1.0
    return 0.0


@kernel
def rise_and_reach(p: Vector, side: float, rotation: float) -> tuple[float, float]:
    """Give the sine and cosine of theta s - alpha, or their small-rotation forms."""
    lean = p[ANGLE] * side - rotation
    if p[SMALL] != 0.0:
        return lean, 1.0
    return math.sin(lean), math.cos(lean)


@kernel
def turning_acceleration(
    p: Vector, sine: float, cosine: float, ground_x: float, ground_y: float
) -> float:
    """Give the angular acceleration of Housner's block, :eq:`eq-rigid-rocking`."""
    moment = (p[GRAVITY] + ground_y) * sine + ground_x * cosine
    return -p[RADIUS] * moment / p[CORNER_INERTIA]


@kernel
def rocking_acceleration(
    p: Vector, side: float, rotation: float, ground_x: float, ground_y: float
) -> float:
    """Give the angular acceleration at a rotation on one side."""
    sine, cosine = rise_and_reach(p, side, rotation)
    return turning_acceleration(p, sine, cosine, ground_x, ground_y)


@callback(ACCELERATE)
def accelerate(
    mode: int, state: Vector, ground_x: float, ground_y: float, p: Vector, out: Vector
) -> None:
    """Acceleration, dashpot power (none) and input power."""
    out[0] = 0.0
    out[1] = 0.0
    out[2] = 0.0
    if mode == RESTING:
        return
    sine, cosine = rise_and_reach(p, side_of(mode), state[0])
    out[0] = turning_acceleration(p, sine, cosine, ground_x, ground_y)
    out[2] = -p[RADIUS] * (ground_x * cosine + ground_y * sine) * state[1]


@callback(GUARD)
def guard(
    mode: int,
    state: Vector,
    accelerations: Vector,
    ground_x: float,
    ground_y: float,
    p: Vector,
    out: Vector,
) -> None:
    """Impact while rocking, uplift while at rest, and the rotation's limit."""
    for i in range(2 * GUARDS):
        out[i] = 1.0 if i < GUARDS else 0.0
    rotation = state[0]
    if mode == RESTING:
        threshold = (p[GRAVITY] + ground_y) * p[TANGENT]
        out[UPLIFT_ON_RIGHT] = (threshold + ground_x) / p[GRAVITY]
        out[UPLIFT_ON_LEFT] = (threshold - ground_x) / p[GRAVITY]
        return
    side = side_of(mode)
    out[IMPACT_GUARD] = side * rotation / p[ANGLE]
    out[GUARDS + IMPACT_GUARD] = side * state[1] / p[ANGLE]
    out[LIMIT_GUARD] = p[ROTATION_LIMIT] - abs(rotation)
    out[GUARDS + LIMIT_GUARD] = -side * state[1]


@callback(SWITCH)
def switch(
    mode: int,
    guard_index: int,
    state: Vector,
    ground_x: float,
    ground_y: float,
    p: Vector,
    memory: Vector,
) -> int:
    """Uplift from rest, or an impact that ends in rocking on the other corner or in rest."""
    if mode == RESTING:
        memory[LAST_EVENT] = UPLIFT
        if p[GRAVITY] + ground_y <= 0.0:  # no weight left: the ground decides the side
            return ON_LEFT if ground_x > 0.0 else ON_RIGHT
        return ON_RIGHT if guard_index == UPLIFT_ON_RIGHT else ON_LEFT
    before = state[1]
    after = p[RESTITUTION] * before
    side = -side_of(mode)
    state[0] = 0.0
    restoring = -side * rocking_acceleration(p, side, 0.0, ground_x, ground_y)
    rebound = after * after / (2.0 * restoring) if restoring > 0.0 else math.inf
    memory[LAST_EVENT] = IMPACT
    mode = ON_RIGHT if side > 0.0 else ON_LEFT
    if rebound < REST_AMPLITUDE * p[ANGLE]:
        memory[LAST_EVENT] = REST
        after = 0.0
        mode = RESTING
    memory[IMPACT_LOSS] += 0.5 * p[CORNER_INERTIA] * (before * before - after * after)
    state[1] = after
    return mode


@kernel
def centre_rise(p: Vector, angle: float) -> float:
    """Give the rise of the centre of mass, R0 [cos(theta - a) - cos theta], to all digits."""
    if p[SMALL] != 0.0:
        return p[RADIUS] * angle * (p[ANGLE] - 0.5 * angle)
    return 2.0 * p[RADIUS] * math.sin(p[ANGLE] - 0.5 * angle) * math.sin(0.5 * angle)


@callback(ENERGY)
def energy(mode: int, state: Vector, p: Vector, out: Vector) -> None:
    """Kinetic and gravity energy, :eq:`eq-rigid-energy`; nothing is elastic."""
    angle = abs(state[0])
    out[0] = 0.5 * p[CORNER_INERTIA] * state[1] * state[1]
    out[1] = p[GRAVITY] * centre_rise(p, angle)
    out[2] = 0.0
    out[3] = 0.0


@callback(OBSERVE)
def observe(
    mode: int,
    state: Vector,
    memory: Vector,
    ground_x: float,
    ground_y: float,
    p: Vector,
    out: Vector,
) -> None:
    """Displacements of the centre of mass and the corners' reactions."""
    rotation, rate = state[0], state[1]
    side = side_of(mode)
    sine, cosine = rise_and_reach(p, side, rotation)
    radius = p[RADIUS]
    weight = p[GRAVITY] + ground_y
    out[0] = rotation
    out[1] = rate
    out[2] = centre_rise(p, abs(rotation))
    if mode == RESTING:
        out[3] = 0.0
        out[4] = 0.0
        # moments about the middle of the base: (N_R - N_L) b = -m h x_g''
        tilt = ground_x / p[TANGENT]
        out[5] = 0.5 * (weight + tilt)
        out[6] = 0.5 * (weight - tilt)
        return
    out[3] = radius * sine * rate
    if p[SMALL] != 0.0:
        out[4] = radius * rotation
    else:
        out[4] = radius * (side * math.sin(p[ANGLE]) - sine)
    acceleration = rocking_acceleration(p, side, rotation, ground_x, ground_y)
    bearing = weight + radius * (sine * acceleration - cosine * rate * rate)
    out[5] = bearing if mode == ON_LEFT else 0.0
    out[6] = bearing if mode == ON_RIGHT else 0.0


def rigid_ground(
    *,
    overturning_angle: float,
    radius: float,
    shape_factor: float,
    mass: float,
    restitution: float,
    small_rotation: bool,
    gravity: float,
) -> ContactModel:
    """Assemble the model of a block on rigid ground.

    Parameters
    ----------
    overturning_angle : float
        theta [rad].
    radius : float
        R0 [m].
    shape_factor : float
        mu [1].
    mass : float
        Mass of the block [kg].
    restitution : float
        Ratio of the angular velocities after and before an impact [1].
    small_rotation : bool
        Whether sines and cosines are expanded.
    gravity : float
        Acceleration of gravity [m s^-2].

    Returns
    -------
    ContactModel
    """
    p = np.zeros(PARAMETERS)
    p[ROTATION_LIMIT] = p[ANGLE] = overturning_angle
    p[GRAVITY] = gravity
    p[RADIUS] = radius
    p[CORNER_INERTIA] = radius**2 * (1.0 + 1.0 / shape_factor)
    p[RESTITUTION] = restitution
    p[SMALL] = float(small_rotation)
    p[TANGENT] = overturning_angle if small_rotation else math.tan(overturning_angle)
    frequency = math.sqrt(gravity * radius / p[CORNER_INERTIA])

    def initial(start: Start) -> tuple[int, Vector, Vector]:
        rotation, rate = start.rotation, start.angular_velocity
        direction = rotation or rate
        mode = RESTING if direction == 0.0 else (ON_RIGHT if direction > 0.0 else ON_LEFT)
        return mode, np.array([rotation, rate]), np.zeros(MEMORY_SIZE)

    return ContactModel(
        name="rigid ground",
        accelerate=accelerate,
        guard=guard,
        switch=switch,
        energy=energy,
        observe=observe,
        active=np.array([0, 1, 1]),
        contact=np.array([ContactState.FULL, ContactState.RIGHT, ContactState.LEFT]),
        parameters=p,
        scales=overturning_angle * np.array([1.0, frequency]),
        rotation_weights=np.ones(1),
        guard_tolerance=np.array([1e-15, 1e-14, 1e-14, 1e-15]),
        relaxation=np.zeros(3),
        columns=COLUMNS,
        fastest_frequency=frequency,
        damping_rate=0.0,
        energy_scale=gravity * radius * overturning_angle,
        mass=mass,
        initial=initial,
    )
