"""A block on two pads on a cap on a Winkler bed, section "Coupled" of the theory manual.

Equations :eq:`eq-coupled`, in coordinates :eq:`eq-coupled-kinematics`; pads as in
:mod:`rockframe.dynamics.pad`, soil as in :mod:`rockframe.dynamics.bed`. Switches stand
in :mod:`rockframe.dynamics.coupled_switches`. All quantities per unit mass of the block.
"""

import math
from typing import Final, NamedTuple

from rockframe.compiled import Vector, callback, inlined, kernel
from rockframe.dynamics.bed import (
    BED_GUARDS,
    BED_MODES,
    LEFT_END,
    PIVOT_FACTOR,
    RIGHT_END,
    SLIP,
    Bed,
    Ends,
    airborne,
    bearing_part,
    bed_energy,
    bed_guards,
    bed_resultants,
)
from rockframe.dynamics.bed import GLIDING as BED_GLIDING
from rockframe.dynamics.gliding import NO_LEVER
from rockframe.dynamics.kinematics import (
    about_pin,
    end_accelerations,
    pinned_point,
    pivot_guard,
    reach_and_bend,
    sine_cosine_rise,
)
from rockframe.dynamics.pad import (
    CORNER_GUARDS,
    LEAVE,
    TURN,
    corner_guards,
    pad_energy,
    pad_force_and_power,
)
from rockframe.dynamics.protocol import (
    ACCELERATE,
    ENERGY,
    GUARD,
    HORIZONTAL_REFERENCE,
    OBSERVE,
    ROTATION_LIMIT,
)
from rockframe.dynamics.single_body import FREE
from rockframe.dynamics.two_spring import GLIDING, glides, gliding_side, pivot_in, pressing
from rockframe.dynamics.two_spring import MODES as BLOCK_MODES
from rockframe.dynamics.winkler import gliding_side as bed_gliding_side

# parameters, after ROTATION_LIMIT
GRAVITY: Final = 1  # g
RESTRAINT: Final = 2  # a restraint rule, of both bases
SMALL: Final = 3  # 1 for small rotation of both bodies on their bases
ANGLE: Final = 4  # theta
HALF_HEIGHT: Final = 5  # h
HALF_WIDTH: Final = 6  # b
INERTIA: Final = 7  # I_O/m
PAD_STIFFNESS: Final = 8  # k/m
PAD_DAMPING: Final = 9  # c/m
PAD_SETTLEMENT: Final = 10  # mg/2k
RESTITUTION: Final = 11  # eps
CAP_HALF_HEIGHT: Final = 12  # h_c
CAP_HALF_WIDTH: Final = 13  # b_c
CAP_MASS: Final = 14  # m_c/m
CAP_INERTIA: Final = 15  # I_c/m
SOIL_STIFFNESS: Final = 16  # k0/m
SOIL_DAMPING: Final = 17  # c0/m
SOIL_SETTLEMENT: Final = 18  # (m + m_c) g/(2 b_c k0)
BY_PRESSURE: Final = 19  # 1 where tension is cut off as well
PARAMETERS: Final = 20

# state: the cap's, then the block's in the frame of the cap
CAP_VERTICAL: Final = 0  # Y
CAP_ROTATION: Final = 1  # phi
NORMAL: Final = 2  # r
ROTATION: Final = 3  # psi
ALONG: Final = 4  # xi; follows from psi unless the block is in flight
CAP_HORIZONTAL: Final = 5  # X; a coordinate of its own while the cap is in flight
COORDINATES: Final = 6

# A mode is block mode + BLOCK_MODES * bed mode, as of two pads on the ground and of a bed.
MODES: Final = BLOCK_MODES * BED_MODES

# guards
LEFT_GUARDS: Final = LEAVE
RIGHT_GUARDS: Final = CORNER_GUARDS
PIVOT_GUARD: Final = 2 * CORNER_GUARDS
SOIL_GUARDS: Final = PIVOT_GUARD + 1
SOIL_PIVOT_GUARD: Final = SOIL_GUARDS + BED_GUARDS
LIMIT_GUARD: Final = SOIL_PIVOT_GUARD + 1
GUARDS: Final = LIMIT_GUARD + 1

COLUMNS: Final = (
    "rotation",
    "angular_velocity",
    "vertical_displacement",
    "vertical_velocity",
    "horizontal_displacement",
    "left_reaction",
    "right_reaction",
    "soil_reaction",
    "contact_length",
    "cap_rotation",
    "cap_angular_velocity",
    "cap_vertical_displacement",
    "cap_vertical_velocity",
    "rotation_on_cap",
    "vertical_displacement_on_cap",
)


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


@kernel
def block_pivot(mode: int) -> int:
    """Give the block's pivot on the cap in a mode."""
    return pivot_in(mode % BLOCK_MODES)


@inlined
def bed_contact(mode: int) -> tuple[int, int, int]:
    """Give the states of the cap's ends, and whether its base glides."""
    bed_mode = mode // BLOCK_MODES
    return bed_mode & 1, (bed_mode >> 1) & 1, (bed_mode >> 2) & 1


@kernel
def cap_pivot(mode: int) -> int:
    """Give the cap's pivot on the soil in a mode."""
    left, right, gliding = bed_contact(mode)
    if gliding == BED_GLIDING or airborne(left, right):
        return FREE
    return held_cap_pivot(mode)


@inlined
def held_block_pivot(mode: int) -> int:
    """Give the block's pivot as if it did not glide."""
    return ((mode % BLOCK_MODES) >> 4) % GLIDING


@inlined
def held_cap_pivot(mode: int) -> int:
    """Give the cap's pivot as if it did not glide."""
    return mode // BLOCK_MODES // PIVOT_FACTOR


@inlined
def block_glides(mode: int) -> bool:
    """Whether a corner of the block glides on the cap."""
    return glides(mode % BLOCK_MODES)


@inlined
def cap_glides(mode: int) -> bool:
    """Whether an end of the cap glides on the soil."""
    return (mode // BLOCK_MODES >> 2) & 1 == BED_GLIDING


@inlined
def bed_of(p: Vector) -> Bed:
    """Give the properties of the bed."""
    return Bed(p[SOIL_STIFFNESS], p[SOIL_DAMPING], p[SOIL_SETTLEMENT], p[BY_PRESSURE])


@inlined
def cap_ends(state: Vector, p: Vector, sine: float, cosine: float, rise: float) -> Ends:
    """Give the ends of the cap's base."""
    height = p[SOIL_SETTLEMENT] - state[CAP_VERTICAL] - rise
    half = p[CAP_HALF_WIDTH] * sine
    spin = state[COORDINATES + CAP_ROTATION]
    speed = state[COORDINATES + CAP_VERTICAL] + p[CAP_HALF_HEIGHT] * sine * spin
    tilt = p[CAP_HALF_WIDTH] * cosine * spin
    return Ends(height - half, height + half, speed + tilt, speed - tilt)


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
    n_left, _ = pad_force_and_power(mode & 3, height + half, lift + left * spin, k, damping, delta)
    n_right, _ = pad_force_and_power(
        (mode >> 2) & 3, height - half, lift + right * spin, k, damping, delta
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


@callback(ACCELERATE)
def accelerate(
    mode: int, state: Vector, ground_x: float, ground_y: float, p: Vector, out: Vector
) -> None:
    """Accelerations of :eq:`eq-coupled`, dashpot power and input power."""
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
    n_left, burnt_left = pad_force_and_power(
        pressing(mode % BLOCK_MODES, mode & 3), height + half, lift + lever_left * spin, k,
        damping, delta,
    )  # fmt: skip
    n_right, burnt_right = pad_force_and_power(
        pressing(mode % BLOCK_MODES, (mode >> 2) & 3), height - half, lift + lever_right * spin, k,
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
    out[CAP_VERTICAL] = motion.cap_vertical
    out[CAP_ROTATION] = motion.cap_rotation
    out[NORMAL] = (
        press
        - load_normal
        - cap_normal
        + across * motion.cap_rotation
        + (2.0 * slip + place.arm * turn) * turn
    )
    out[ROTATION] = motion.rotation
    if place.block_free:
        out[ALONG] = -load_along - cap_along - place.arm * motion.cap_rotation - coriolis
    else:
        out[ALONG] = place.slide * motion.rotation + drift
    out[CAP_HORIZONTAL] = motion.cap_horizontal if place.cap_free or cap_slips else 0.0
    if block_slips or cap_slips:
        place = placed(mode, state, p, cap_sine, cap_cosine, sine, cosine)
    sway = cap_sway(place, state)
    across_speed, up_speed = block_velocity(place, state)
    out[COORDINATES] = burnt + burnt_left + burnt_right
    out[COORDINATES + 1] = -ground_x * (across_speed + p[CAP_MASS] * sway) - ground_y * (
        up_speed + p[CAP_MASS] * state[COORDINATES + CAP_VERTICAL]
    )


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
    corner_guards(
        mode & 3, LEFT_GUARDS, GUARDS, height + b * sine, speed + tilt, left, k, c, delta, g, out
    )
    corner_guards(
        (mode >> 2) & 3, RIGHT_GUARDS, GUARDS, height - b * sine, speed - tilt, right, k, c, delta,
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


@kernel
def block_height(place: Configuration, state: Vector) -> float:
    """Give the rise of the block's centre of mass from rest, to all digits."""
    s, c = place.sine, place.cosine
    versine = s * s / (1.0 + c) if c > 0.0 else 1.0 - c
    reach = place.arm - state[NORMAL]
    return state[CAP_VERTICAL] + state[NORMAL] * c - state[ALONG] * s - reach * versine


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
    out[5], _ = pad_force_and_power(
        pressing(block_mode, mode & 3), height + half, lift + lever_left * spin, k, c, delta
    )
    out[6], _ = pad_force_and_power(
        pressing(block_mode, (mode >> 2) & 3), height - half, lift + lever_right * spin, k, c, delta
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
