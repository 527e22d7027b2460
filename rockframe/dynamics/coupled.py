"""A block on two pads on a cap on a Winkler bed, section "Coupled" of the theory manual.

Equations :eq:`eq-coupled`; pads as in :mod:`rockframe.dynamics.pad`, soil as in
:mod:`rockframe.dynamics.bed`. These are the functions that the integrator calls between
events; what happens at events stands in :mod:`rockframe.dynamics.coupled_switches`.
"""

from typing import NamedTuple

from rockframe.compiled import Vector, callback, inlined
from rockframe.dynamics.bed import SLIP, bearing_part, bed_energy, bed_guards, bed_resultants
from rockframe.dynamics.coupled_gliding import glide, glide_guards
from rockframe.dynamics.coupled_layout import (
    ALONG,
    ANGLE,
    CAP_HALF_HEIGHT,
    CAP_HALF_WIDTH,
    CAP_HORIZONTAL,
    CAP_INERTIA,
    CAP_MASS,
    CAP_ROTATION,
    CAP_VERTICAL,
    COORDINATES,
    GRAVITY,
    GUARDS,
    HALF_HEIGHT,
    HALF_WIDTH,
    INERTIA,
    LEFT_GUARDS,
    LIMIT_GUARD,
    NORMAL,
    PAD_DAMPING,
    PAD_SETTLEMENT,
    PAD_STIFFNESS,
    PIVOT_GUARD,
    RESTRAINT,
    RIGHT_GUARDS,
    ROTATION,
    SMALL,
    SOIL_GUARDS,
    SOIL_PIVOT_GUARD,
    SOIL_SETTLEMENT,
    bed_contact,
    bed_of,
    block_glides,
    block_pivot,
    cap_ends,
    cap_glides,
    cap_pivot,
    held_block_pivot,
    held_cap_pivot,
)
from rockframe.dynamics.coupled_motion import (
    along_rate,
    block_height,
    block_velocity,
    cap_position,
    cap_sway,
    configuration,
    held_place,
    placed,
    solve_motion,
)
from rockframe.dynamics.kinematics import end_accelerations, pivot_guard, sine_cosine_rise
from rockframe.dynamics.pad import corner_guards, corners_in, pad_energy, pad_force_and_power
from rockframe.dynamics.protocol import ACCELERATE, ENERGY, GUARD, OBSERVE, ROTATION_LIMIT
from rockframe.dynamics.single_body import FREE
from rockframe.dynamics.two_spring import MODES as BLOCK_MODES
from rockframe.dynamics.two_spring import pressing


class Rates(NamedTuple):
    """Accelerations of all coordinates, and the powers dissipated and supplied."""

    cap_vertical: float
    cap_rotation: float
    normal: float
    rotation: float
    along: float
    cap_horizontal: float
    dissipated: float
    supplied: float


@inlined
def rates(mode: int, state: Vector, ground_x: float, ground_y: float, p: Vector) -> Rates:
    """Give the accelerations of :eq:`eq-coupled`, dashpot power and input power."""
    small = p[SMALL]
    # soil
    cap_sine, cap_cosine, cap_rise = sine_cosine_rise(
        p[CAP_HALF_HEIGHT], small, state[CAP_ROTATION]
    )
    ends = cap_ends(state, p, cap_sine, cap_cosine, cap_rise)
    left, right, gliding = bed_contact(mode)
    soil_force, soil_moment, burnt = bed_resultants(
        left,
        right,
        gliding,
        ends,
        bed_of(p),
        2.0 * p[CAP_HALF_WIDTH],
        p[CAP_HALF_HEIGHT] * cap_sine + p[CAP_HALF_WIDTH] * cap_cosine,
        p[CAP_HALF_HEIGHT] * cap_sine - p[CAP_HALF_WIDTH] * cap_cosine,
    )
    # pads
    spin = state[COORDINATES + ROTATION]
    lift = state[COORDINATES + NORMAL]
    sine, cosine, rise = sine_cosine_rise(p[HALF_HEIGHT], small, state[ROTATION])
    place = placed(mode, state, p, cap_sine, cap_cosine, sine, cosine)
    height = state[NORMAL] + rise
    half = p[HALF_WIDTH] * sine
    lever_left = p[HALF_HEIGHT] * sine + p[HALF_WIDTH] * cosine
    lever_right = p[HALF_HEIGHT] * sine - p[HALF_WIDTH] * cosine
    k, damping, delta = p[PAD_STIFFNESS], p[PAD_DAMPING], p[PAD_SETTLEMENT]
    on_left, on_right = corners_in(mode)
    block_mode = mode % BLOCK_MODES
    n_left, burnt_left = pad_force_and_power(
        pressing(block_mode, on_left), height + half, lift + lever_left * spin, k,
        damping, delta,
    )  # fmt: skip
    n_right, burnt_right = pad_force_and_power(
        pressing(block_mode, on_right), height - half, lift + lever_right * spin, k,
        damping, delta,
    )  # fmt: skip
    press = n_left + n_right
    # motion
    turn = state[COORDINATES + CAP_ROTATION]
    across = state[ALONG]
    s, c = place.sine, place.cosine
    slip = along_rate(place, state)
    load_y = p[GRAVITY] + ground_y
    load_along = ground_x * c - load_y * s
    load_normal = ground_x * s + load_y * c
    coriolis = 2.0 * lift * turn - across * turn * turn
    swing = place.bend * turn * turn
    drift = place.curve * spin * spin
    block_slips, cap_slips = block_glides(mode), cap_glides(mode)
    if block_slips or cap_slips:
        place = held_place(mode, place, state, p)
        swing, drift, hold_power = glide(
            mode, place, state, soil_force, soil_moment, coriolis + load_along, ground_x, load_y,
            (2.0 * slip + place.arm * turn) * turn - load_normal, press, p,
        )  # fmt: skip
        burnt -= hold_power
    motion = solve_motion(
        place,
        across,
        press,
        n_left * lever_left + n_right * lever_right,
        soil_force,
        soil_moment,
        swing,
        drift + coriolis + load_along,
        ground_x,
        load_y,
        p,
    )
    cap_along = c * motion.cap_horizontal - s * motion.cap_vertical
    cap_normal = s * motion.cap_horizontal + c * motion.cap_vertical
    normal = (
        press
        - load_normal
        - cap_normal
        + across * motion.cap_rotation
        + (2.0 * slip + place.arm * turn) * turn
    )
    along = place.slide * motion.rotation + drift
    if place.block_free:
        along = -load_along - cap_along - place.arm * motion.cap_rotation - coriolis
    cap_horizontal = motion.cap_horizontal if place.cap_free or cap_slips else 0.0
    if block_slips or cap_slips:
        place = placed(mode, state, p, cap_sine, cap_cosine, sine, cosine)
    sway = cap_sway(place, state)
    across_speed, up_speed = block_velocity(place, state)
    supplied = -ground_x * (across_speed + p[CAP_MASS] * sway) - ground_y * (
        up_speed + p[CAP_MASS] * state[COORDINATES + CAP_VERTICAL]
    )
    return Rates(
        motion.cap_vertical, motion.cap_rotation, normal, motion.rotation, along, cap_horizontal,
        burnt + burnt_left + burnt_right, supplied,
    )  # fmt: skip


@callback(ACCELERATE)
def accelerate(
    mode: int, state: Vector, ground_x: float, ground_y: float, p: Vector, out: Vector
) -> None:
    """Accelerations of :eq:`eq-coupled`, dashpot power and input power."""
    found = rates(mode, state, ground_x, ground_y, p)
    out[CAP_VERTICAL] = found.cap_vertical
    out[CAP_ROTATION] = found.cap_rotation
    out[NORMAL] = found.normal
    out[ROTATION] = found.rotation
    out[ALONG] = found.along
    out[CAP_HORIZONTAL] = found.cap_horizontal
    out[COORDINATES] = found.dissipated
    out[COORDINATES + 1] = found.supplied


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
    """Guards of the pads, of the soil, of both pivots and of the total rotation."""
    small = p[SMALL]
    # block on pads
    h, b = p[HALF_HEIGHT], p[HALF_WIDTH]
    rotation, spin = state[ROTATION], state[COORDINATES + ROTATION]
    sine, cosine, rise = sine_cosine_rise(h, small, rotation)
    left, right = end_accelerations(
        h, b, small, sine, cosine, spin, accelerations[NORMAL], accelerations[ROTATION]
    )
    height = state[NORMAL] + rise
    speed = state[COORDINATES + NORMAL] + h * sine * spin
    tilt = b * cosine * spin
    k, c, delta, g = p[PAD_STIFFNESS], p[PAD_DAMPING], p[PAD_SETTLEMENT], p[GRAVITY]
    on_left, on_right = corners_in(mode)
    corner_guards(
        on_left, LEFT_GUARDS, GUARDS, height + b * sine, speed + tilt, left, k, c, delta, g, out
    )
    corner_guards(
        on_right, RIGHT_GUARDS, GUARDS, height - b * sine, speed - tilt, right, k, c, delta,
        g, out,
    )  # fmt: skip
    out[PIVOT_GUARD] = 1.0
    out[GUARDS + PIVOT_GUARD] = 0.0
    pivot = block_pivot(mode)
    block_slips, cap_slips = block_glides(mode), cap_glides(mode)
    if pivot != FREE or block_slips:
        out[PIVOT_GUARD], out[GUARDS + PIVOT_GUARD] = pivot_guard(
            p[RESTRAINT], held_block_pivot(mode), p[ANGLE], rotation, spin, accelerations[ROTATION]
        )
    # cap on soil
    h, b = p[CAP_HALF_HEIGHT], p[CAP_HALF_WIDTH]
    cap_rotation, turn = state[CAP_ROTATION], state[COORDINATES + CAP_ROTATION]
    sine, cosine, rise = sine_cosine_rise(h, small, cap_rotation)
    ends = cap_ends(state, p, sine, cosine, rise)
    left_end, right_end, _ = bed_contact(mode)
    values = bed_guards(left_end, right_end, ends, p[SOIL_SETTLEMENT])
    for i in range(2):
        out[SOIL_GUARDS + i] = values[i]
        out[GUARDS + SOIL_GUARDS + i] = values[2 + i]
    out[SOIL_GUARDS + SLIP] = 1.0
    out[GUARDS + SOIL_GUARDS + SLIP] = 0.0
    if block_slips or cap_slips:
        glide_guards(mode, state, accelerations, ground_x, ground_y, p, out)
    out[SOIL_PIVOT_GUARD] = 1.0
    out[GUARDS + SOIL_PIVOT_GUARD] = 0.0
    pivot = cap_pivot(mode)
    if pivot != FREE or cap_slips:
        out[SOIL_PIVOT_GUARD], out[GUARDS + SOIL_PIVOT_GUARD] = pivot_guard(
            p[RESTRAINT],
            held_cap_pivot(mode),
            p[ANGLE],
            cap_rotation,
            turn,
            accelerations[CAP_ROTATION],
        )
    total = rotation + cap_rotation
    out[LIMIT_GUARD] = p[ROTATION_LIMIT] - abs(total)
    out[GUARDS + LIMIT_GUARD] = -(spin + turn) if total > 0.0 else spin + turn


@callback(ENERGY)
def energy(mode: int, state: Vector, p: Vector, out: Vector) -> None:
    """Kinetic, gravity and elastic energy, :eq:`eq-coupled-energy`."""
    place = configuration(mode, state, p)
    across, up = block_velocity(place, state)
    sway = cap_sway(place, state)
    turn = state[COORDINATES + CAP_ROTATION]
    spin = turn + state[COORDINATES + ROTATION]
    lift = state[COORDINATES + CAP_VERTICAL]
    out[0] = 0.5 * (
        across * across
        + up * up
        + p[INERTIA] * spin * spin
        + p[CAP_MASS] * (sway * sway + lift * lift)
        + p[CAP_INERTIA] * turn * turn
    )
    out[1] = p[GRAVITY] * (block_height(place, state) + p[CAP_MASS] * state[CAP_VERTICAL])
    sine, _, rise = sine_cosine_rise(p[HALF_HEIGHT], p[SMALL], state[ROTATION])
    height = state[NORMAL] + rise
    half = p[HALF_WIDTH] * sine
    left, left_change = pad_energy(height + half, p[PAD_STIFFNESS], p[PAD_SETTLEMENT])
    right, right_change = pad_energy(height - half, p[PAD_STIFFNESS], p[PAD_SETTLEMENT])
    sine, cosine, rise = sine_cosine_rise(p[CAP_HALF_HEIGHT], p[SMALL], state[CAP_ROTATION])
    soil, soil_change = bed_energy(
        cap_ends(state, p, sine, cosine, rise), bed_of(p), 2.0 * p[CAP_HALF_WIDTH]
    )
    out[2] = left + right + soil
    out[3] = left_change + right_change + soil_change


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
    """Motion of block and cap, reactions of pads and soil."""
    place = configuration(mode, state, p)
    spin = state[COORDINATES + ROTATION]
    turn = state[COORDINATES + CAP_ROTATION]
    out[0] = state[ROTATION] + state[CAP_ROTATION]
    out[1] = spin + turn
    out[2] = block_height(place, state)
    _, out[3] = block_velocity(place, state)
    out[4] = (
        cap_position(mode, state, p, memory) + place.arm * place.sine + state[ALONG] * place.cosine
    )
    sine, cosine, rise = sine_cosine_rise(p[HALF_HEIGHT], p[SMALL], state[ROTATION])
    height = state[NORMAL] + rise
    half = p[HALF_WIDTH] * sine
    lift = state[COORDINATES + NORMAL]
    lever_left = p[HALF_HEIGHT] * sine + p[HALF_WIDTH] * cosine
    lever_right = p[HALF_HEIGHT] * sine - p[HALF_WIDTH] * cosine
    k, c, delta = p[PAD_STIFFNESS], p[PAD_DAMPING], p[PAD_SETTLEMENT]
    block_mode = mode % BLOCK_MODES
    on_left, on_right = corners_in(mode)
    out[5], _ = pad_force_and_power(
        pressing(block_mode, on_left), height + half, lift + lever_left * spin, k, c, delta
    )
    out[6], _ = pad_force_and_power(
        pressing(block_mode, on_right), height - half, lift + lever_right * spin, k, c, delta
    )
    sine, cosine, rise = sine_cosine_rise(p[CAP_HALF_HEIGHT], p[SMALL], state[CAP_ROTATION])
    ends = cap_ends(state, p, sine, cosine, rise)
    bed = bed_of(p)
    left, right, gliding = bed_contact(mode)
    start, end = bearing_part(left, right, gliding, ends, bed)
    width = 2.0 * p[CAP_HALF_WIDTH]
    out[7], _, _ = bed_resultants(left, right, gliding, ends, bed, width, 0.0, 0.0)
    out[8] = width * (end - start)
    out[9] = state[CAP_ROTATION]
    out[10] = turn
    out[11] = state[CAP_VERTICAL]
    out[12] = state[COORDINATES + CAP_VERTICAL]
    out[13] = state[ROTATION]
    out[14] = state[NORMAL]
