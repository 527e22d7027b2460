"""A block on two viscoelastic pads, section "Two pads" of the theory manual.

One equation, :eq:`eq-two-spring`, serves the four contact states; the paper's
Eqs. (12) and (15), corrected, are its special cases. Kinematics
:eq:`eq-kinematics`, pad forces :eq:`eq-pad-force`, energies :eq:`eq-energy`.
Switches stand in :mod:`rockframe.dynamics.two_spring_switches`.
All quantities per unit mass of the block.
"""

from typing import Final

from rockframe.compiled import Vector, callback, inlined, kernel
from rockframe.dynamics import single_body as body
from rockframe.dynamics.kinematics import end_accelerations, pivot_guard, sine_cosine_rise
from rockframe.dynamics.pad import (
    CLEAR,
    CORNER_GUARDS,
    LEAVE,
    RELAXING,
    TOUCHING,
    TURN,
    corner_guards,
    pad_energy,
    pad_force_and_power,
)
from rockframe.dynamics.protocol import ACCELERATE, ENERGY, GUARD, OBSERVE
from rockframe.dynamics.single_body import (
    ANGLE,
    COORDINATES,
    FREE,
    GRAVITY,
    HALF_HEIGHT,
    HALF_WIDTH,
    LEFT_SIDE,
    RESTRAINT,
    RIGHT_SIDE,
    ROTATION,
    SMALL,
    VERTICAL,
    glide_body,
    glide_guards,
    kinetic_energy,
    limit_guard,
    move_body,
    observe_body,
)

# parameters, after those of the body
STIFFNESS: Final = body.BODY_PARAMETERS  # k/m
DAMPING: Final = STIFFNESS + 1  # c/m
SETTLEMENT: Final = STIFFNESS + 2  # delta
RESTITUTION: Final = STIFFNESS + 3  # eps
PARAMETERS: Final = STIFFNESS + 4

# A mode is left corner + 4 * right corner + 16 * pivot; corners as in
# :mod:`rockframe.dynamics.pad`, pivots as in :mod:`rockframe.dynamics.kinematics`,
# plus GLIDING where the corner that touches glides.
GLIDING: Final = 3
MODES: Final = 96

# guards: three of each corner, the pivot's, and the rotation's limit
LEFT_GUARDS: Final = LEAVE
RIGHT_GUARDS: Final = CORNER_GUARDS
PIVOT_GUARD: Final = 2 * CORNER_GUARDS
LIMIT_GUARD: Final = PIVOT_GUARD + 1
GUARDS: Final = LIMIT_GUARD + 1

COLUMNS: Final = (*body.COLUMNS, "left_reaction", "right_reaction")
REACTIONS: Final = len(body.COLUMNS)


@kernel
def in_flight(mode: int) -> bool:
    """Whether no corner touches."""
    return (mode & 3) >= RELAXING and ((mode >> 2) & 3) >= RELAXING


@kernel
def glides(mode: int) -> bool:
    """Whether the corner that touches glides."""
    return (mode >> 4) >= GLIDING


@kernel
def pivot_in(mode: int) -> int:
    """Give the pivot of a mode."""
    return FREE if in_flight(mode) or glides(mode) else mode >> 4


@kernel
def gliding_side(mode: int) -> float:
    """Give the side of the corner that glides."""
    return LEFT_SIDE if (mode & 3) == TOUCHING else RIGHT_SIDE


@inlined
def pressing(mode: int, contact: int) -> int:
    """Give a corner's contact as far as its pad's force goes: gliding, it has none."""
    return CLEAR if contact == TOUCHING and glides(mode) else contact


@callback(ACCELERATE)
def accelerate(
    mode: int, state: Vector, ground_x: float, ground_y: float, p: Vector, out: Vector
) -> None:
    """Accelerations of :eq:`eq-two-spring`, dashpot power and input power."""
    spin = state[COORDINATES + ROTATION]
    speed = state[COORDINATES + VERTICAL]
    sine, cosine, rise = sine_cosine_rise(p[HALF_HEIGHT], p[SMALL], state[ROTATION])
    height = state[VERTICAL] + rise
    half = p[HALF_WIDTH] * sine
    lever_left = p[HALF_HEIGHT] * sine + p[HALF_WIDTH] * cosine
    lever_right = p[HALF_HEIGHT] * sine - p[HALF_WIDTH] * cosine
    k = p[STIFFNESS]
    c = p[DAMPING]
    delta = p[SETTLEMENT]
    left, burnt_left = pad_force_and_power(
        pressing(mode, mode & 3), height + half, speed + lever_left * spin, k, c, delta
    )
    right, burnt_right = pad_force_and_power(
        pressing(mode, (mode >> 2) & 3), height - half, speed + lever_right * spin, k, c, delta
    )
    moment = left * lever_left + right * lever_right
    out[COORDINATES] = burnt_left + burnt_right
    if glides(mode):
        glide_body(
            (mode >> 4) - GLIDING, gliding_side(mode), state, sine, cosine, ground_x, ground_y, p,
            out,
        )  # fmt: skip
        return
    move_body(pivot_in(mode), state, sine, cosine, left + right, moment, ground_x, ground_y, p, out)


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
    """Guards of the corners, of the pivot and of the rotation, :eq:`eq-guards`."""
    rotation = state[ROTATION]
    spin = state[COORDINATES + ROTATION]
    b = p[HALF_WIDTH]
    h = p[HALF_HEIGHT]
    sine, cosine, rise = sine_cosine_rise(h, p[SMALL], rotation)
    turn = accelerations[ROTATION]
    left, right = end_accelerations(
        h, b, p[SMALL], sine, cosine, spin, accelerations[VERTICAL], turn
    )
    height = state[VERTICAL] + rise
    speed = state[COORDINATES + VERTICAL] + h * sine * spin
    tilt = b * cosine * spin
    k = p[STIFFNESS]
    c = p[DAMPING]
    delta = p[SETTLEMENT]
    g = p[GRAVITY]
    corner_guards(
        mode & 3, LEFT_GUARDS, GUARDS, height + b * sine, speed + tilt, left, k, c, delta, g, out
    )
    corner_guards(
        (mode >> 2) & 3, RIGHT_GUARDS, GUARDS, height - b * sine, speed - tilt, right, k, c, delta,
        g, out,
    )  # fmt: skip
    out[PIVOT_GUARD] = 1.0
    out[GUARDS + PIVOT_GUARD] = 0.0
    if not in_flight(mode):
        out[PIVOT_GUARD], out[GUARDS + PIVOT_GUARD] = pivot_guard(
            p[RESTRAINT], (mode >> 4) % GLIDING, p[ANGLE], rotation, spin, turn
        )
    if glides(mode):
        side = gliding_side(mode)
        first = LEFT_GUARDS if side > 0.0 else RIGHT_GUARDS
        hold, slip, change = glide_guards(
            (mode >> 4) - GLIDING, side, state, accelerations, ground_x, p
        )
        out[first + LEAVE] = hold
        out[GUARDS + first + LEAVE] = 0.0
        out[first + TURN] = slip
        out[GUARDS + first + TURN] = change
    out[LIMIT_GUARD], out[GUARDS + LIMIT_GUARD] = limit_guard(state, p)


@callback(ENERGY)
def energy(mode: int, state: Vector, p: Vector, out: Vector) -> None:
    """Kinetic, gravity and elastic energy, :eq:`eq-energy`."""
    sine, _, rise = sine_cosine_rise(p[HALF_HEIGHT], p[SMALL], state[ROTATION])
    out[0] = kinetic_energy(pivot_in(mode), state, p)
    out[1] = p[GRAVITY] * state[VERTICAL]
    height = state[VERTICAL] + rise
    half = p[HALF_WIDTH] * sine
    left, left_change = pad_energy(height + half, p[STIFFNESS], p[SETTLEMENT])
    right, right_change = pad_energy(height - half, p[STIFFNESS], p[SETTLEMENT])
    out[2] = left + right
    out[3] = left_change + right_change


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
    spin = state[COORDINATES + ROTATION]
    speed = state[COORDINATES + VERTICAL]
    sine, cosine, rise = sine_cosine_rise(p[HALF_HEIGHT], p[SMALL], state[ROTATION])
    height = state[VERTICAL] + rise
    half = p[HALF_WIDTH] * sine
    lever_left = p[HALF_HEIGHT] * sine + p[HALF_WIDTH] * cosine
    lever_right = p[HALF_HEIGHT] * sine - p[HALF_WIDTH] * cosine
    k = p[STIFFNESS]
    c = p[DAMPING]
    delta = p[SETTLEMENT]
    observe_body(pivot_in(mode), state, memory, p, out)
    out[REACTIONS], _ = pad_force_and_power(
        pressing(mode, mode & 3), height + half, speed + lever_left * spin, k, c, delta
    )
    out[REACTIONS + 1], _ = pad_force_and_power(
        pressing(mode, (mode >> 2) & 3), height - half, speed + lever_right * spin, k, c, delta
    )
