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
    PIVOT_FACTOR,
    Bed,
    Ends,
    bearing_part,
    bed_energy,
    bed_guards,
    bed_resultants,
    nothing_bears,
)
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
    RELAXING,
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

# A mode is block mode + 48 * bed mode; a block mode is left corner + 4 * right corner
# + 16 * pivot, as of two pads on the ground.
BLOCK_MODES: Final = 48
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
    left = mode & 3
    right = (mode >> 2) & 3
    if left >= RELAXING and right >= RELAXING:
        return FREE
    return (mode % BLOCK_MODES) >> 4


@inlined
def bed_contact(mode: int) -> tuple[int, int, int]:
    """Give the states of the cap's ends, and whether its base is loose."""
    bed_mode = mode // BLOCK_MODES
    return bed_mode & 1, (bed_mode >> 1) & 1, (bed_mode >> 2) & 1


@kernel
def cap_pivot(mode: int) -> int:
    """Give the cap's pivot on the soil in a mode."""
    left, right, loose = bed_contact(mode)
    if nothing_bears(left, right, loose):
        return FREE
    return mode // BLOCK_MODES // PIVOT_FACTOR


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
    left, right, loose = bed_contact(mode)
    soil_force, soil_moment, burnt = bed_resultants(
        left,
        right,
        loose,
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
        mode & 3, height + half, lift + lever_left * spin, k, damping, delta
    )
    n_right, burnt_right = pad_force_and_power(
        (mode >> 2) & 3, height - half, lift + lever_right * spin, k, damping, delta
    )
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
    motion = solve_motion(
        place,
        across,
        press,
        n_left * lever_left + n_right * lever_right,
        soil_force,
        soil_moment,
        place.bend * turn * turn,
        place.curve * spin * spin + coriolis + load_along,
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
        out[ALONG] = place.slide * motion.rotation + place.curve * spin * spin
    out[CAP_HORIZONTAL] = motion.cap_horizontal if place.cap_free else 0.0
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
    if pivot != FREE:
        out[PIVOT_GUARD], out[GUARDS + PIVOT_GUARD] = pivot_guard(
            p[RESTRAINT], pivot, p[ANGLE], rotation, spin, accelerations[ROTATION]
        )
    # cap on soil
    h, b = p[CAP_HALF_HEIGHT], p[CAP_HALF_WIDTH]
    cap_rotation, turn = state[CAP_ROTATION], state[COORDINATES + CAP_ROTATION]
    sine, cosine, rise = sine_cosine_rise(h, small, cap_rotation)
    left, right = end_accelerations(
        h, b, small, sine, cosine, turn, accelerations[CAP_VERTICAL], accelerations[CAP_ROTATION]
    )
    ends = cap_ends(state, p, sine, cosine, rise)
    left_end, right_end, loose = bed_contact(mode)
    values = bed_guards(left_end, right_end, loose, ends, left, right, bed_of(p))
    for i in range(BED_GUARDS):
        out[SOIL_GUARDS + i] = values[i]
        out[GUARDS + SOIL_GUARDS + i] = values[BED_GUARDS + i]
    out[SOIL_PIVOT_GUARD] = 1.0
    out[GUARDS + SOIL_PIVOT_GUARD] = 0.0
    pivot = cap_pivot(mode)
    if pivot != FREE:
        out[SOIL_PIVOT_GUARD], out[GUARDS + SOIL_PIVOT_GUARD] = pivot_guard(
            p[RESTRAINT], pivot, p[ANGLE], cap_rotation, turn, accelerations[CAP_ROTATION]
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
    out[5], _ = pad_force_and_power(mode & 3, height + half, lift + lever_left * spin, k, c, delta)
    out[6], _ = pad_force_and_power(
        (mode >> 2) & 3, height - half, lift + lever_right * spin, k, c, delta
    )
    sine, cosine, rise = sine_cosine_rise(p[CAP_HALF_HEIGHT], p[SMALL], state[CAP_ROTATION])
    ends = cap_ends(state, p, sine, cosine, rise)
    bed = bed_of(p)
    left, right, loose = bed_contact(mode)
    start, end = bearing_part(left, right, loose, ends, bed)
    width = 2.0 * p[CAP_HALF_WIDTH]
    out[7], _, _ = bed_resultants(left, right, loose, ends, bed, width, 0.0, 0.0)
    out[8] = width * (end - start)
    out[9] = state[CAP_ROTATION]
    out[10] = turn
    out[11] = state[CAP_VERTICAL]
    out[12] = state[COORDINATES + CAP_VERTICAL]
    out[13] = state[ROTATION]
    out[14] = state[NORMAL]
