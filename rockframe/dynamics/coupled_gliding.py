"""Ends of block and cap that glide: held at their level, with no reaction, :eq:`eq-gliding`."""

import math

from rockframe.compiled import Vector, kernel
from rockframe.dynamics.bed import LEFT_END, RIGHT_END, SLIP
from rockframe.dynamics.coupled_layout import (
    ALONG,
    CAP_HALF_HEIGHT,
    CAP_HALF_WIDTH,
    CAP_HORIZONTAL,
    CAP_MASS,
    CAP_ROTATION,
    CAP_VERTICAL,
    COORDINATES,
    GRAVITY,
    GUARDS,
    HALF_HEIGHT,
    HALF_WIDTH,
    LEFT_GUARDS,
    NORMAL,
    PAD_DAMPING,
    PAD_SETTLEMENT,
    PAD_STIFFNESS,
    RIGHT_GUARDS,
    ROTATION,
    SMALL,
    SOIL_GUARDS,
    block_glides,
    cap_glides,
)
from rockframe.dynamics.coupled_motion import (
    Configuration,
    Motion,
    configuration,
    held_place,
    solve_motion,
)
from rockframe.dynamics.gliding import NO_LEVER
from rockframe.dynamics.kinematics import end_accelerations, sine_cosine_rise
from rockframe.dynamics.pad import (
    LEAVE,
    TURN,
    corners_in,
    pad_force_and_power,
    relaxation_rate,
)
from rockframe.dynamics.two_spring import MODES as BLOCK_MODES
from rockframe.dynamics.two_spring import gliding_side
from rockframe.dynamics.winkler import gliding_side as bed_gliding_side


@kernel
def gliding_levers(mode: int, state: Vector, p: Vector) -> tuple[float, float, float, float]:
    """Give lever and its derivative of the end that glides: the block's, then the cap's."""
    small = p[SMALL]
    sine, cosine, _ = sine_cosine_rise(p[HALF_HEIGHT], small, state[ROTATION])
    side = gliding_side(mode % BLOCK_MODES)
    lever = p[HALF_HEIGHT] * sine + side * p[HALF_WIDTH] * cosine
    left, right = end_accelerations(
        p[HALF_HEIGHT], p[HALF_WIDTH], small, sine, cosine, 1.0, 0.0, 0.0
    )
    bend = left if side > 0.0 else right
    sine, cosine, _ = sine_cosine_rise(p[CAP_HALF_HEIGHT], small, state[CAP_ROTATION])
    cap_side = bed_gliding_side(mode // BLOCK_MODES)
    cap_lever = p[CAP_HALF_HEIGHT] * sine + cap_side * p[CAP_HALF_WIDTH] * cosine
    left, right = end_accelerations(
        p[CAP_HALF_HEIGHT], p[CAP_HALF_WIDTH], small, sine, cosine, 1.0, 0.0, 0.0
    )
    return lever, bend, cap_lever, left if cap_side > 0.0 else right


@kernel
def rises(
    place: Configuration, motion: Motion, across: float, press: float, lever: float,
    cap_lever: float,
) -> tuple[float, float]:  # fmt: skip
    """Give what a motion adds to the acceleration of the block's corner and the cap's end."""
    s, c = place.sine, place.cosine
    normal = s * motion.cap_horizontal + c * motion.cap_vertical
    corner = press - normal + across * motion.cap_rotation + lever * motion.rotation
    return corner, motion.cap_vertical + cap_lever * motion.cap_rotation


@kernel
def responses(
    mode: int, place: Configuration, state: Vector, p: Vector
) -> tuple[float, float, float, float]:
    """Give the rises of corner and end per unit of slip of the block, then of the cap."""
    lever, _, cap_lever, _ = gliding_levers(mode, state, p)
    across = state[ALONG]
    motion = solve_motion(place, across, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, p)
    corner, end = rises(place, motion, across, 0.0, lever, cap_lever)
    motion = solve_motion(place, across, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, p)
    cap_corner, cap_end = rises(place, motion, across, 0.0, lever, cap_lever)
    return corner, end, cap_corner, cap_end


@kernel
def slips(place: Configuration, state: Vector) -> tuple[float, float]:
    """Give the slip of the block on the cap and of the cap on the soil where they glide."""
    block = state[COORDINATES + ALONG] - place.slide * state[COORDINATES + ROTATION]
    sway = state[COORDINATES + CAP_HORIZONTAL]
    return block, sway - place.reach * state[COORDINATES + CAP_ROTATION]


@kernel
def glide(
    mode: int,
    place: Configuration,
    state: Vector,
    soil_force: float,
    soil_moment: float,
    load_along: float,
    load_x: float,
    load_y: float,
    given_normal: float,
    press: float,
    p: Vector,
) -> tuple[float, float, float]:
    """Give the accelerations of slip that keep what glides at its level, :eq:`eq-gliding`.

    They come as the parts of `swing` and `drift` that belong to them, with the power
    that the holds take from the slips (negative). A gliding corner bears alone, so that
    the pads of a gliding block do not press.
    """
    lever, bend, cap_lever, cap_bend = gliding_levers(mode, state, p)
    turn, spin = state[COORDINATES + CAP_ROTATION], state[COORDINATES + ROTATION]
    across = state[ALONG]
    moment = 0.0
    if not block_glides(mode):  # the block's own contact goes on
        moment = pads_moment(mode, state, p)
    swing = place.bend * turn * turn
    drift = place.curve * spin * spin
    motion = solve_motion(
        place, across, press, moment, soil_force, soil_moment, swing, drift + load_along, load_x,
        load_y, p,
    )  # fmt: skip
    corner, end = rises(place, motion, across, press, lever, cap_lever)
    corner += given_normal + bend * spin * spin
    # a corner below its pad's level rises with the pad, which relaxes without pressing
    rate = state[COORDINATES + NORMAL] + lever * spin
    corner += relaxation_rate(p[PAD_STIFFNESS], p[PAD_DAMPING]) * rate
    end += cap_bend * turn * turn
    a11, a21, a12, a22 = responses(mode, place, state, p)
    if not block_glides(mode):
        drift_slip, swing_slip = 0.0, -end / a22
    elif not cap_glides(mode):
        drift_slip, swing_slip = -corner / a11, 0.0
    else:
        determinant = a11 * a22 - a12 * a21
        drift_slip = (a12 * end - a22 * corner) / determinant
        swing_slip = (a21 * corner - a11 * end) / determinant
    swing += swing_slip
    drift += drift_slip
    motion = solve_motion(
        place, across, press, moment, soil_force, soil_moment, swing, drift + load_along, load_x,
        load_y, p,
    )  # fmt: skip
    block_slip, cap_slip = slips(place, state)
    power = 0.0
    if block_glides(mode):
        power += motion.thrust * block_slip
    if cap_glides(mode):
        hold = place.cosine * motion.thrust + place.sine * press
        power += (p[CAP_MASS] * (motion.cap_horizontal + load_x) + hold) * cap_slip
    return swing, drift, power


@kernel
def pads_moment(mode: int, state: Vector, p: Vector) -> float:
    """Give the pads' generalised force on psi."""
    sine, cosine, rise = sine_cosine_rise(p[HALF_HEIGHT], p[SMALL], state[ROTATION])
    spin, lift = state[COORDINATES + ROTATION], state[COORDINATES + NORMAL]
    height, half = state[NORMAL] + rise, p[HALF_WIDTH] * sine
    k, damping, delta = p[PAD_STIFFNESS], p[PAD_DAMPING], p[PAD_SETTLEMENT]
    left = p[HALF_HEIGHT] * sine + p[HALF_WIDTH] * cosine
    right = p[HALF_HEIGHT] * sine - p[HALF_WIDTH] * cosine
    on_left, on_right = corners_in(mode)
    n_left, _ = pad_force_and_power(on_left, height + half, lift + left * spin, k, damping, delta)
    n_right, _ = pad_force_and_power(
        on_right, height - half, lift + right * spin, k, damping, delta
    )
    return n_left * left + n_right * right


@kernel
def glide_guards(
    mode: int,
    state: Vector,
    accelerations: Vector,
    ground_x: float,
    ground_y: float,
    p: Vector,
    out: Vector,
) -> None:
    """Write the guards of what glides: of the hold that lifts, and of the slip."""
    place = held_place(mode, configuration(mode, state, p), state, p)
    s, c = place.sine, place.cosine
    turn, spin = state[COORDINATES + CAP_ROTATION], state[COORDINATES + ROTATION]
    block_slip, cap_slip = slips(place, state)
    corner, _, _, end = responses(mode, place, state, p)
    # forces of the cap on the block, from its acceleration, eq-coupled
    x = accelerations[CAP_HORIZONTAL]
    if not cap_glides(mode) and not place.cap_free:
        x = place.reach * accelerations[CAP_ROTATION] + place.bend * turn * turn
    x += ground_x
    y = accelerations[CAP_VERTICAL] + p[GRAVITY] + ground_y
    across = state[ALONG]
    along_speed = state[COORDINATES + ALONG]
    if not block_glides(mode) and not place.block_free:
        along_speed = place.slide * spin
    thrust = (
        c * x - s * y + accelerations[ALONG] + place.arm * accelerations[CAP_ROTATION]
        + 2.0 * state[COORDINATES + NORMAL] * turn - across * turn * turn
    )  # fmt: skip
    press = (
        s * x + c * y + accelerations[NORMAL] - across * accelerations[CAP_ROTATION]
        - 2.0 * along_speed * turn - place.arm * turn * turn
    )  # fmt: skip
    scale = math.sqrt(p[GRAVITY] * (p[HALF_WIDTH] + p[HALF_HEIGHT]))
    if block_glides(mode):
        first = LEFT_GUARDS if gliding_side(mode % BLOCK_MODES) > 0.0 else RIGHT_GUARDS
        sign = 1.0 if corner < 0.0 else -1.0
        out[first + LEAVE] = -sign * thrust / p[GRAVITY]
        out[GUARDS + first + LEAVE] = 0.0
        change = (
            accelerations[ALONG] - place.slide * accelerations[ROTATION]
            - place.curve * spin * spin
        )  # fmt: skip
        out[first + TURN] = sign * block_slip / scale if abs(corner) > NO_LEVER else -1.0
        out[GUARDS + first + TURN] = sign * change / scale
    if cap_glides(mode):
        left = bed_gliding_side(mode // BLOCK_MODES) > 0.0
        first = SOIL_GUARDS + (LEFT_END if left else RIGHT_END)
        sign = 1.0 if end < 0.0 else -1.0
        hold = p[CAP_MASS] * x + c * thrust + s * press
        out[first] = -sign * hold / p[GRAVITY]
        out[GUARDS + first] = 0.0
        change = (
            accelerations[CAP_HORIZONTAL] - place.reach * accelerations[CAP_ROTATION]
            - place.bend * turn * turn
        )  # fmt: skip
        out[SOIL_GUARDS + SLIP] = sign * cap_slip / scale if abs(end) > NO_LEVER else -1.0
        out[GUARDS + SOIL_GUARDS + SLIP] = sign * change / scale
