"""Where block and cap are, and how they accelerate under given forces.

Kinematics :eq:`eq-coupled-kinematics` and the solution of the equations of motion.
"""

import math
from typing import NamedTuple

from rockframe.compiled import Vector, inlined, kernel
from rockframe.dynamics.coupled_layout import (
    ALONG,
    CAP_HALF_HEIGHT,
    CAP_HALF_WIDTH,
    CAP_HORIZONTAL,
    CAP_INERTIA,
    CAP_MASS,
    CAP_ROTATION,
    CAP_VERTICAL,
    COORDINATES,
    HALF_HEIGHT,
    HALF_WIDTH,
    INERTIA,
    NORMAL,
    ROTATION,
    SMALL,
    block_glides,
    block_pivot,
    cap_glides,
    cap_pivot,
    held_block_pivot,
    held_cap_pivot,
)
from rockframe.dynamics.kinematics import about_pin, pinned_point, reach_and_bend, sine_cosine_rise
from rockframe.dynamics.protocol import HORIZONTAL_REFERENCE
from rockframe.dynamics.single_body import FREE


class Configuration(NamedTuple):
    """Where cap and block are, and how they can move.

    x_c' = reach, x_c'' = bend: the cap's centre about the point that the soil holds.
    xi' = slide, xi'' = curve: the block's centre along the cap about the point that
    the cap holds. arm = h_c + h + r, along the cap's normal.
    """

    sine: float
    cosine: float
    reach: float
    bend: float
    slide: float
    curve: float
    arm: float
    block_free: bool
    cap_free: bool


class Motion(NamedTuple):
    """Accelerations, or changes of velocities."""

    cap_horizontal: float
    cap_vertical: float
    cap_rotation: float
    rotation: float
    thrust: float  # force of the cap on the block along the cap, per unit mass


@inlined
def placed(
    mode: int,
    state: Vector,
    p: Vector,
    cap_sine: float,
    cap_cosine: float,
    block_sine: float,
    block_cosine: float,
) -> Configuration:
    """Give the geometry of a state from the sines and cosines of both bodies on their bases."""
    small = p[SMALL]
    cap = cap_pivot(mode)
    block = block_pivot(mode)
    pin = pinned_point(cap, p[CAP_HALF_WIDTH])
    reach, bend = reach_and_bend(p[CAP_HALF_HEIGHT], small, pin, cap_sine, cap_cosine)
    pin = pinned_point(block, p[HALF_WIDTH])
    slide, curve = reach_and_bend(p[HALF_HEIGHT], small, pin, block_sine, block_cosine)
    sine = cap_sine
    cosine = cap_cosine
    if small != 0.0:  # the frame of the cap turns exactly, whatever the kinematics on the bases
        sine = math.sin(state[CAP_ROTATION])
        cosine = math.cos(state[CAP_ROTATION])
    arm = p[CAP_HALF_HEIGHT] + p[HALF_HEIGHT] + state[NORMAL]
    return Configuration(sine, cosine, reach, bend, slide, curve, arm, block == FREE, cap == FREE)


@kernel
def configuration(mode: int, state: Vector, p: Vector) -> Configuration:
    """Give the geometry of a state, in the restraints of a mode."""
    cap_sine, cap_cosine, _ = sine_cosine_rise(p[CAP_HALF_HEIGHT], p[SMALL], state[CAP_ROTATION])
    sine, cosine, _ = sine_cosine_rise(p[HALF_HEIGHT], p[SMALL], state[ROTATION])
    return placed(mode, state, p, cap_sine, cap_cosine, sine, cosine)


@inlined
def along_rate(place: Configuration, state: Vector) -> float:
    """Give d xi/dt, the block's velocity along the cap."""
    if place.block_free:
        return state[COORDINATES + ALONG]
    return place.slide * state[COORDINATES + ROTATION]


@inlined
def cap_sway(place: Configuration, state: Vector) -> float:
    """Give the horizontal velocity of the cap's centre."""
    if place.cap_free:
        return state[COORDINATES + CAP_HORIZONTAL]
    return place.reach * state[COORDINATES + CAP_ROTATION]


@inlined
def solve_motion(
    place: Configuration,
    across: float,
    press: float,
    moment: float,
    soil_force: float,
    soil_moment: float,
    swing: float,
    drift: float,
    load_x: float,
    load_y: float,
    p: Vector,
) -> Motion:
    """Solve the equations of motion, or of impulsive motion, for cap and block.

    Equation :eq:`eq-coupled-solution`. `across` is xi, `press` and `moment` are the
    pads' force and generalised force on psi; `swing` and `drift` are the parts of the
    cap's horizontal acceleration and of the block's along the cap that do not depend
    on the unknowns; the loads are those on the cap per unit of its mass.
    """
    s, c = place.sine, place.cosine
    i, i_c, mass = p[INERTIA], p[CAP_INERTIA], p[CAP_MASS]
    tied = i + place.slide * place.slide
    share = 0.0 if place.block_free else i / tied
    lever = 0.0 if place.block_free else place.slide / tied
    arm = place.arm - place.slide
    if place.cap_free:
        turn = (across * press - moment) / i_c
        drive = share * (s * load_y - c * load_x + arm * turn + drift) + lever * moment
        thrust = drive / (1.0 + share / mass + share * arm * arm / i_c)
        x = -load_x - (c * thrust + s * press) / mass
        y = -load_y - (c * press - s * thrust) / mass
        turn -= arm * thrust / i_c
    else:
        reach = place.reach
        reaching = c * reach + arm
        given = share * (c * swing + drift) + lever * moment
        a11 = share * reaching * reaching + mass * reach * reach + i_c
        a12 = -share * reaching * s
        a22 = share * s * s + mass
        b1 = (
            soil_moment
            - moment
            + (across - reach * s) * press
            - reach * mass * (swing + load_x)
            - reaching * given
        )
        b2 = soil_force - mass * load_y - c * press + s * given
        determinant = a11 * a22 - a12 * a12
        turn = (a22 * b1 - a12 * b2) / determinant
        y = (a11 * b2 - a12 * b1) / determinant
        x = reach * turn + swing
        thrust = share * (reaching * turn - s * y) + given
    return Motion(x, y, turn, (moment - place.slide * thrust) / i - turn, thrust)


@kernel
def held_place(mode: int, place: Configuration, state: Vector, p: Vector) -> Configuration:
    """Give a configuration in which what glides is held, as far as its levers go."""
    reach, bend, slide, curve = place.reach, place.bend, place.slide, place.curve
    cap_free, block_free = place.cap_free, place.block_free
    if cap_glides(mode):
        sine, cosine, _ = sine_cosine_rise(p[CAP_HALF_HEIGHT], p[SMALL], state[CAP_ROTATION])
        pin = pinned_point(held_cap_pivot(mode), p[CAP_HALF_WIDTH])
        reach, bend = reach_and_bend(p[CAP_HALF_HEIGHT], p[SMALL], pin, sine, cosine)
        cap_free = False
    if block_glides(mode):
        sine, cosine, _ = sine_cosine_rise(p[HALF_HEIGHT], p[SMALL], state[ROTATION])
        pin = pinned_point(held_block_pivot(mode), p[HALF_WIDTH])
        slide, curve = reach_and_bend(p[HALF_HEIGHT], p[SMALL], pin, sine, cosine)
        block_free = False
    return Configuration(
        place.sine, place.cosine, reach, bend, slide, curve, place.arm, block_free, cap_free
    )


@inlined
def block_velocity(place: Configuration, state: Vector) -> tuple[float, float]:
    """Give the horizontal and vertical velocity of the block's centre of mass."""
    turn = state[COORDINATES + CAP_ROTATION]
    s, c = place.sine, place.cosine
    along = along_rate(place, state) + place.arm * turn
    normal = state[COORDINATES + NORMAL] - state[ALONG] * turn
    return (
        cap_sway(place, state) + along * c + normal * s,
        state[COORDINATES + CAP_VERTICAL] - along * s + normal * c,
    )


@kernel
def block_height(place: Configuration, state: Vector) -> float:
    """Give the rise of the block's centre of mass from rest, to all digits."""
    s, c = place.sine, place.cosine
    versine = s * s / (1.0 + c) if c > 0.0 else 1.0 - c
    reach = place.arm - state[NORMAL]
    return state[CAP_VERTICAL] + state[NORMAL] * c - state[ALONG] * s - reach * versine


@kernel
def cap_position(mode: int, state: Vector, p: Vector, memory: Vector) -> float:
    """Give x of the cap's centre: about the pinned point, or free in flight."""
    pivot = cap_pivot(mode)
    if pivot == FREE:
        return state[CAP_HORIZONTAL]
    pin = pinned_point(pivot, p[CAP_HALF_WIDTH])
    return memory[HORIZONTAL_REFERENCE] + about_pin(
        p[CAP_HALF_HEIGHT], p[SMALL], pin, state[CAP_ROTATION]
    )
