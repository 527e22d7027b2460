"""A block on two viscoelastic pads, section "Two pads" of the theory manual.

One equation, :eq:`eq-two-spring`, serves the four contact states; the paper's
Eqs. (12) and (15), corrected, are its special cases. Kinematics
:eq:`eq-kinematics`, pad forces :eq:`eq-pad-force`, energies :eq:`eq-energy`.
Switches stand in :mod:`rockframe.dynamics.two_spring_switches`.
All quantities per unit mass of the block.
"""

import math
from typing import Final

from rockframe.compiled import Vector, callback, inlined, kernel
from rockframe.dynamics.protocol import (
    ACCELERATE,
    ENERGY,
    GUARD,
    HORIZONTAL_REFERENCE,
    OBSERVE,
    ROTATION_LIMIT,
)

# parameters, after ROTATION_LIMIT
GRAVITY: Final = 1  # g
ANGLE: Final = 2  # theta
HALF_HEIGHT: Final = 3  # h
HALF_WIDTH: Final = 4  # b
INERTIA: Final = 5  # I_O/m
STIFFNESS: Final = 6  # k/m
DAMPING: Final = 7  # c/m
SETTLEMENT: Final = 8  # delta
RESTITUTION: Final = 9  # eps
RESTRAINT: Final = 10  # one of the three rules below
SMALL: Final = 11  # 1 for small rotation
PARAMETERS: Final = 12

# restraint rules
BY_CONTACT: Final = 0
LEADING_CORNER: Final = 1
CENTRE: Final = 2

# state
ROTATION: Final = 0
VERTICAL: Final = 1
HORIZONTAL: Final = 2  # a coordinate of its own in flight only
COORDINATES: Final = 3

# A mode is left corner + 4 * right corner + 16 * pivot.
TOUCHING: Final = 0
ENGAGING: Final = 1  # held again, but the pad has not caught up with the corner
RELAXING: Final = 2  # free, but still below the pad's unloaded level
CLEAR: Final = 3  # free, above it
PIVOT_CENTRE: Final = 0  # e = 0
PIVOT_RIGHT: Final = 1  # e = +b
PIVOT_LEFT: Final = 2  # e = -b
MODES: Final = 48

# A corner is held, and counts as bearing, if its contact is below RELAXING.

# guards: three of each corner, the pivot's, and the rotation's limit
LEAVE: Final = 0  # the reaction of a touching corner; the gap of a free one
REENGAGE: Final = 1  # a relaxing pad catches up with its corner
TURN: Final = 2  # a relaxing corner stops rising; an engaging one is pressed
RIGHT_GUARDS: Final = 3
PIVOT_GUARD: Final = 6
LIMIT_GUARD: Final = 7
GUARDS: Final = 8

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
def in_flight(mode: int) -> bool:
    """Whether no corner touches."""
    return (mode & 3) >= RELAXING and ((mode >> 2) & 3) >= RELAXING


@kernel
def pinned_point(mode: int, p: Vector) -> float:
    """Give e, the base coordinate of the horizontally restrained point."""
    pivot = mode >> 4
    if pivot == PIVOT_RIGHT:
        return p[HALF_WIDTH]
    if pivot == PIVOT_LEFT:
        return -p[HALF_WIDTH]
    return 0.0


@kernel
def sine_cosine_rise(p: Vector, rotation: float) -> tuple[float, float, float]:
    """Give sin a, cos a and h(1 - cos a), or their small-rotation forms."""
    if p[SMALL] != 0.0:
        return rotation, 1.0, 0.5 * p[HALF_HEIGHT] * rotation * rotation
    sine = math.sin(rotation)
    cosine = math.cos(rotation)
    # sin^2/(1 + cos) keeps its digits at small rotation; past a right angle 1 - cos does
    if cosine > 0.0:
        return sine, cosine, p[HALF_HEIGHT] * sine * sine / (1.0 + cosine)
    return sine, cosine, p[HALF_HEIGHT] * (1.0 - cosine)


@kernel
def reach_and_bend(p: Vector, pin: float, sine: float, cosine: float) -> tuple[float, float]:
    """Give dx/da and d2x/da2 of the centre of mass about the pinned point."""
    if p[SMALL] != 0.0:
        return p[HALF_HEIGHT], 0.0
    return (
        p[HALF_HEIGHT] * cosine + pin * sine,
        pin * cosine - p[HALF_HEIGHT] * sine,
    )


@inlined
def pad_force(level: float, rate: float, p: Vector) -> float:
    """Give the reaction of a pad under a corner at a height, :eq:`eq-pad-force`."""
    return p[STIFFNESS] * (p[SETTLEMENT] - level) - p[DAMPING] * rate


@inlined
def pad_force_and_power(contact: int, level: float, rate: float, p: Vector) -> tuple[float, float]:
    """Give a pad's reaction and what its dashpot burns, in the corner's contact."""
    if contact == TOUCHING:
        return pad_force(level, rate, p), p[DAMPING] * rate * rate
    if contact != CLEAR:  # the pad follows its corner, and its spring feeds the dashpot
        return 0.0, p[STIFFNESS] * (p[SETTLEMENT] - level) * rate
    return 0.0, 0.0


@callback(ACCELERATE)
def accelerate(
    mode: int, state: Vector, ground_x: float, ground_y: float, p: Vector, out: Vector
) -> None:
    """Accelerations of :eq:`eq-two-spring`, dashpot power and input power."""
    spin = state[COORDINATES + ROTATION]
    speed = state[COORDINATES + VERTICAL]
    sine, cosine, rise = sine_cosine_rise(p, state[ROTATION])
    height = state[VERTICAL] + rise
    half = p[HALF_WIDTH] * sine
    lever_left = p[HALF_HEIGHT] * sine + p[HALF_WIDTH] * cosine
    lever_right = p[HALF_HEIGHT] * sine - p[HALF_WIDTH] * cosine
    left, burnt_left = pad_force_and_power(mode & 3, height + half, speed + lever_left * spin, p)
    right, burnt_right = pad_force_and_power(
        (mode >> 2) & 3, height - half, speed + lever_right * spin, p
    )
    out[VERTICAL] = left + right - p[GRAVITY] - ground_y
    out[COORDINATES] = burnt_left + burnt_right
    if in_flight(mode):
        out[ROTATION] = 0.0
        out[HORIZONTAL] = -ground_x
        out[COORDINATES + 1] = -ground_x * state[COORDINATES + HORIZONTAL] - ground_y * speed
        return
    reach, bend = reach_and_bend(p, pinned_point(mode, p), sine, cosine)
    moment = left * lever_left + right * lever_right - reach * (ground_x + bend * spin * spin)
    out[ROTATION] = moment / (p[INERTIA] + reach * reach)
    out[HORIZONTAL] = 0.0
    out[COORDINATES + 1] = -ground_x * reach * spin - ground_y * speed


@kernel
def corner_guards(
    contact: int,
    first: int,
    level: float,
    rate: float,
    acceleration: float,
    p: Vector,
    out: Vector,
) -> None:
    """Write the three guards of a corner and their rates; idle ones stay at 1."""
    k = p[STIFFNESS]
    c = p[DAMPING]
    g = p[GRAVITY]
    out[first + REENGAGE] = 1.0
    out[first + TURN] = 1.0
    out[GUARDS + first + REENGAGE] = 0.0
    out[GUARDS + first + TURN] = 0.0
    if contact < RELAXING:
        reaction = pad_force(level, rate, p) / g
        change = -(k * rate + c * acceleration) / g
        if contact == TOUCHING:
            out[first + LEAVE] = reaction
            out[GUARDS + first + LEAVE] = change
        else:  # until it is pressed, only its height can take it off again
            out[first + LEAVE] = 1.0 - level / p[SETTLEMENT]
            out[GUARDS + first + LEAVE] = -rate / p[SETTLEMENT]
            out[first + TURN] = -reaction
            out[GUARDS + first + TURN] = -change
    elif contact == CLEAR:
        out[first + LEAVE] = level / p[SETTLEMENT] - 1.0
        out[GUARDS + first + LEAVE] = rate / p[SETTLEMENT]
    else:
        out[first + LEAVE] = 1.0 - level / p[SETTLEMENT]
        out[GUARDS + first + LEAVE] = -rate / p[SETTLEMENT]
        out[first + REENGAGE] = -pad_force(level, rate, p) / g
        out[GUARDS + first + REENGAGE] = (c * acceleration + k * rate) / g
        scale = p[SETTLEMENT] * math.sqrt(2.0 * k)
        out[first + TURN] = rate / scale
        out[GUARDS + first + TURN] = acceleration / scale


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
    sine, cosine, rise = sine_cosine_rise(p, rotation)
    b = p[HALF_WIDTH]
    h = p[HALF_HEIGHT]
    height = state[VERTICAL] + rise
    speed = state[COORDINATES + VERTICAL]
    rolled = h * sine
    # second derivatives of the corners' heights: l' = h cos a -/+ b sin a
    arch = h if p[SMALL] != 0.0 else h * cosine
    twist = 0.0 if p[SMALL] != 0.0 else b * sine
    lift = accelerations[VERTICAL] + rolled * accelerations[ROTATION] + arch * spin * spin
    tilt = b * cosine * accelerations[ROTATION] - twist * spin * spin
    speed += rolled * spin
    turn = b * cosine * spin
    corner_guards(mode & 3, 0, height + b * sine, speed + turn, lift + tilt, p, out)
    corner_guards(
        (mode >> 2) & 3, RIGHT_GUARDS, height - b * sine, speed - turn, lift - tilt, p, out
    )
    out[PIVOT_GUARD] = 1.0
    out[GUARDS + PIVOT_GUARD] = 0.0
    if p[RESTRAINT] == LEADING_CORNER and not in_flight(mode):
        pivot = mode >> 4
        if pivot == PIVOT_CENTRE:  # upright and at rest: whichever corner it leans to
            departure = spin if spin != 0.0 else accelerations[ROTATION]
            out[PIVOT_GUARD] = -abs(rotation) / p[ANGLE]
            out[GUARDS + PIVOT_GUARD] = -abs(departure) / p[ANGLE]
        else:
            side = 1.0 if pivot == PIVOT_RIGHT else -1.0
            out[PIVOT_GUARD] = side * rotation / p[ANGLE]
            out[GUARDS + PIVOT_GUARD] = side * spin / p[ANGLE]
    out[LIMIT_GUARD] = p[ROTATION_LIMIT] - abs(rotation)
    out[GUARDS + LIMIT_GUARD] = -spin if rotation > 0.0 else spin


@callback(ENERGY)
def energy(mode: int, state: Vector, p: Vector, out: Vector) -> None:
    """Kinetic, gravity and elastic energy, :eq:`eq-energy`."""
    sine, cosine, rise = sine_cosine_rise(p, state[ROTATION])
    spin = state[COORDINATES + ROTATION]
    speed = state[COORDINATES + VERTICAL]
    if in_flight(mode):
        sway = state[COORDINATES + HORIZONTAL]
    else:
        reach, _ = reach_and_bend(p, pinned_point(mode, p), sine, cosine)
        sway = reach * spin
    out[0] = 0.5 * (p[INERTIA] * spin * spin + speed * speed + sway * sway)
    out[1] = p[GRAVITY] * state[VERTICAL]
    half = p[HALF_WIDTH] * sine
    out[2] = 0.0
    out[3] = 0.0
    for side in (1.0, -1.0):
        level = state[VERTICAL] + rise + side * half
        if level < p[SETTLEMENT]:
            out[2] += 0.5 * p[STIFFNESS] * (p[SETTLEMENT] - level) ** 2
            out[3] += p[STIFFNESS] * level * (0.5 * level - p[SETTLEMENT])
        else:
            out[3] -= 0.5 * p[STIFFNESS] * p[SETTLEMENT] * p[SETTLEMENT]


@kernel
def horizontal_position(mode: int, state: Vector, p: Vector, memory: Vector) -> float:
    """Give x of the centre of mass: about the pinned point, or free in flight."""
    if in_flight(mode):
        return state[HORIZONTAL]
    return memory[HORIZONTAL_REFERENCE] + about_pin(pinned_point(mode, p), state[ROTATION], p)


@kernel
def about_pin(pin: float, rotation: float, p: Vector) -> float:
    """Give h sin a - e cos a, the centre of mass seen from the pinned point."""
    if p[SMALL] != 0.0:
        return p[HALF_HEIGHT] * rotation
    return p[HALF_HEIGHT] * math.sin(rotation) - pin * math.cos(rotation)


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
    sine, cosine, rise = sine_cosine_rise(p, state[ROTATION])
    height = state[VERTICAL] + rise
    half = p[HALF_WIDTH] * sine
    lever_left = p[HALF_HEIGHT] * sine + p[HALF_WIDTH] * cosine
    lever_right = p[HALF_HEIGHT] * sine - p[HALF_WIDTH] * cosine
    out[0] = state[ROTATION]
    out[1] = spin
    out[2] = state[VERTICAL]
    out[3] = speed
    out[4] = horizontal_position(mode, state, p, memory)
    out[5], _ = pad_force_and_power(mode & 3, height + half, speed + lever_left * spin, p)
    out[6], _ = pad_force_and_power((mode >> 2) & 3, height - half, speed + lever_right * spin, p)
