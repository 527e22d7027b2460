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
    CONTACT_BITS,
    CONTACTS,
    CORNER_GUARDS,
    LEAVE,
    RELAXING,
    TOUCHING,
    TURN,
    corner_guards,
    corners_in,
    pad_energy,
    pad_force_and_power,
    relaxation_rate,
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
    Rates,
    glide_body,
    glide_guards,
    kinetic_energy,
    limit_guard,
    move_body,
    observe_body,
    write_rates,
)

# parameters, after those of the body
STIFFNESS: Final = body.BODY_PARAMETERS  # k/m
DAMPING: Final = STIFFNESS + 1  # c/m
SETTLEMENT: Final = STIFFNESS + 2  # delta
RESTITUTION: Final = STIFFNESS + 3  # eps
PARAMETERS: Final = STIFFNESS + 4

# A mode is the corners' contacts, :func:`rockframe.dynamics.pad.both_corners`, + CONTACTS *
# pivot; pivots as in :mod:`rockframe.dynamics.kinematics`, plus GLIDING where the corner that
# touches glides.
GLIDING: Final = 3
MODES: Final = 6 * CONTACTS

# guards: three of each corner, the pivot's, and the rotation's limit
LEFT_GUARDS: Final = LEAVE
RIGHT_GUARDS: Final = CORNER_GUARDS
PIVOT_GUARD: Final = 2 * CORNER_GUARDS
PADS_GUARDS: Final = PIVOT_GUARD + 1
LIMIT_GUARD: Final = PADS_GUARDS
GUARDS: Final = LIMIT_GUARD + 1

COLUMNS: Final = (*body.COLUMNS, "left_reaction", "right_reaction")
REACTIONS: Final = len(body.COLUMNS)


@kernel
def in_flight(mode: int) -> bool:
    """Whether no corner touches."""
    left, right = corners_in(mode)
    return airborne_corners(left, right)


@inlined
def airborne_corners(left: int, right: int) -> bool:
    """Whether two corners' contacts are those of a flight."""
    return left >= RELAXING and right >= RELAXING


@kernel
def glides(mode: int) -> bool:
    """Whether the corner that touches glides."""
    return mode >> CONTACT_BITS >= GLIDING


@inlined
def held_pivot(mode: int) -> int:
    """Give the pivot of a mode as if nothing glided or flew."""
    pivot = mode >> CONTACT_BITS
    return pivot - GLIDING if pivot >= GLIDING else pivot


@kernel
def pivot_in(mode: int) -> int:
    """Give the pivot of a mode."""
    return FREE if in_flight(mode) or glides(mode) else mode >> CONTACT_BITS


@kernel
def gliding_side(mode: int) -> float:
    """Give the side of the corner that glides."""
    left, _ = corners_in(mode)
    return LEFT_SIDE if left == TOUCHING else RIGHT_SIDE


@inlined
def pressing(mode: int, contact: int) -> int:
    """Give a corner's contact as far as its pad's force goes: gliding, it has none."""
    return RELAXING if contact == TOUCHING and glides(mode) else contact


@inlined
def body_rates(mode: int, state: Vector, ground_x: float, ground_y: float, p: Vector) -> Rates:
    """Give the accelerations of :eq:`eq-two-spring`, dashpot power and input power."""
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
    on_left, on_right = corners_in(mode)
    left, burnt_left = pad_force_and_power(
        pressing(mode, on_left), height + half, speed + lever_left * spin, k, c, delta
    )
    right, burnt_right = pad_force_and_power(
        pressing(mode, on_right), height - half, speed + lever_right * spin, k, c, delta
    )
    burnt = burnt_left + burnt_right
    if glides(mode):
        return glide_body(
            held_pivot(mode), gliding_side(mode), relaxation_rate(k, c), burnt, state, sine, cosine,
            ground_x, ground_y, p,
        )  # fmt: skip
    moment = left * lever_left + right * lever_right
    return move_body(
        pivot_in(mode), state, sine, cosine, left + right, moment, burnt, ground_x, ground_y, p
    )


@callback(ACCELERATE)
def accelerate(
    mode: int, state: Vector, ground_x: float, ground_y: float, p: Vector, out: Vector
) -> None:
    """Accelerations of :eq:`eq-two-spring`, dashpot power and input power."""
    write_rates(body_rates(mode, state, ground_x, ground_y, p), out)


@inlined
def write_guards(
    mode: int,
    state: Vector,
    accelerations: Vector,
    ground_x: float,
    p: Vector,
    guards: int,
    out: Vector,
) -> None:
    """Write the guards of corners and pivot, the first of a model that has `guards` of them."""
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
    on_left, on_right = corners_in(mode)
    corner_guards(
        on_left, LEFT_GUARDS, guards, height + b * sine, speed + tilt, left, k, c, delta, g, out
    )
    corner_guards(
        on_right, RIGHT_GUARDS, guards, height - b * sine, speed - tilt, right, k, c, delta, g, out
    )
    out[PIVOT_GUARD] = 1.0
    out[guards + PIVOT_GUARD] = 0.0
    if not in_flight(mode):
        out[PIVOT_GUARD], out[guards + PIVOT_GUARD] = pivot_guard(
            p[RESTRAINT], held_pivot(mode), p[ANGLE], rotation, spin, turn
        )
    if glides(mode):
        side = gliding_side(mode)
        first = LEFT_GUARDS if side > 0.0 else RIGHT_GUARDS
        hold, slip, change = glide_guards(held_pivot(mode), side, state, accelerations, ground_x, p)
        out[first + LEAVE] = hold
        out[guards + first + LEAVE] = 0.0
        out[first + TURN] = slip
        out[guards + first + TURN] = change


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
    write_guards(mode, state, accelerations, ground_x, p, GUARDS, out)
    out[LIMIT_GUARD], out[GUARDS + LIMIT_GUARD] = limit_guard(state, p)


@callback(ENERGY)
@kernel
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
@kernel
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
    on_left, on_right = corners_in(mode)
    out[REACTIONS], _ = pad_force_and_power(
        pressing(mode, on_left), height + half, speed + lever_left * spin, k, c, delta
    )
    out[REACTIONS + 1], _ = pad_force_and_power(
        pressing(mode, on_right), height - half, speed + lever_right * spin, k, c, delta
    )
