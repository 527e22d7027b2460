"""A body on a Winkler bed, section "Winkler bed" of the theory manual.

Equation :eq:`eq-winkler`; the paper's Eq. (18) is its small-rotation form in full
contact, Eq. (19), corrected, its first order with an end raised. Kinematics
:eq:`eq-kinematics`, bed :eq:`eq-bed`.
All quantities per unit mass of the body.
"""

from typing import Final

from rockframe.compiled import Vector, callback, inlined, kernel
from rockframe.dynamics import single_body as body
from rockframe.dynamics.bed import (
    BED_GUARDS,
    BED_MODES,
    LEFT_END,
    PIVOT_FACTOR,
    RAISED,
    RIGHT_END,
    Bed,
    Ends,
    bearing_part,
    bed_energy,
    bed_guards,
    bed_resultants,
    nothing_bears,
    switch_bed,
)
from rockframe.dynamics.kinematics import (
    PIVOT_CENTRE,
    end_accelerations,
    pivot_guard,
    pivot_of,
    sine_cosine_rise,
)
from rockframe.dynamics.protocol import (
    ACCELERATE,
    ENERGY,
    GUARD,
    LAST_EVENT,
    OBSERVE,
    SWITCH,
)
from rockframe.dynamics.single_body import (
    ANGLE,
    COORDINATES,
    FREE,
    GRAVITY,
    HALF_HEIGHT,
    HALF_WIDTH,
    RESTRAINT,
    ROTATION,
    SMALL,
    VERTICAL,
    kinetic_energy,
    limit_guard,
    move_body,
    observe_body,
    repin,
    turned_pivot,
)

# parameters, after those of the body
STIFFNESS: Final = body.BODY_PARAMETERS  # k0/m
DAMPING: Final = STIFFNESS + 1  # c0/m
SETTLEMENT: Final = STIFFNESS + 2  # delta
BY_PRESSURE: Final = STIFFNESS + 3  # 1 where tension is cut off as well
PARAMETERS: Final = STIFFNESS + 4

MODES: Final = BED_MODES

# guards: the bed's, the pivot's, and the rotation's limit
PIVOT_GUARD: Final = BED_GUARDS
LIMIT_GUARD: Final = PIVOT_GUARD + 1
GUARDS: Final = LIMIT_GUARD + 1

COLUMNS: Final = (*body.COLUMNS, "soil_reaction", "contact_length")
REACTION: Final = len(body.COLUMNS)


@inlined
def bed_of(p: Vector) -> Bed:
    """Give the properties of the bed."""
    return Bed(p[STIFFNESS], p[DAMPING], p[SETTLEMENT], p[BY_PRESSURE])


@inlined
def contact_in(mode: int) -> tuple[int, int, int]:
    """Give the states of a mode's ends, and whether the base is loose."""
    return mode & 1, (mode >> 1) & 1, (mode >> 2) & 1


@kernel
def pivot_in(mode: int) -> int:
    """Give the pivot of a mode."""
    left, right, loose = contact_in(mode)
    return FREE if nothing_bears(left, right, loose) else mode // PIVOT_FACTOR


@inlined
def ends_of(state: Vector, p: Vector, sine: float, cosine: float, rise: float) -> Ends:
    """Give the base's ends."""
    height = p[SETTLEMENT] - state[VERTICAL] - rise
    half = p[HALF_WIDTH] * sine
    spin = state[COORDINATES + ROTATION]
    speed = state[COORDINATES + VERTICAL] + p[HALF_HEIGHT] * sine * spin
    tilt = p[HALF_WIDTH] * cosine * spin
    return Ends(height - half, height + half, speed + tilt, speed - tilt)


@callback(ACCELERATE)
def accelerate(
    mode: int, state: Vector, ground_x: float, ground_y: float, p: Vector, out: Vector
) -> None:
    """Accelerations of :eq:`eq-winkler`, dashpot power and input power."""
    sine, cosine, rise = sine_cosine_rise(p[HALF_HEIGHT], p[SMALL], state[ROTATION])
    ends = ends_of(state, p, sine, cosine, rise)
    bed = bed_of(p)
    left, right, loose = contact_in(mode)
    force, moment, burnt = bed_resultants(
        left,
        right,
        loose,
        ends,
        bed,
        2.0 * p[HALF_WIDTH],
        p[HALF_HEIGHT] * sine + p[HALF_WIDTH] * cosine,
        p[HALF_HEIGHT] * sine - p[HALF_WIDTH] * cosine,
    )
    out[COORDINATES] = burnt
    move_body(pivot_in(mode), state, sine, cosine, force, moment, ground_x, ground_y, p, out)


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
    """Guards of the ends, of the pressure, of the pivot and of the rotation."""
    rotation = state[ROTATION]
    spin = state[COORDINATES + ROTATION]
    turn = accelerations[ROTATION]
    h = p[HALF_HEIGHT]
    sine, cosine, rise = sine_cosine_rise(h, p[SMALL], rotation)
    a_left, a_right = end_accelerations(
        h, p[HALF_WIDTH], p[SMALL], sine, cosine, spin, accelerations[VERTICAL], turn
    )
    left, right, loose = contact_in(mode)
    ends = ends_of(state, p, sine, cosine, rise)
    values = bed_guards(left, right, loose, ends, a_left, a_right, bed_of(p))
    for i in range(BED_GUARDS):
        out[i] = values[i]
        out[GUARDS + i] = values[BED_GUARDS + i]
    out[PIVOT_GUARD] = 1.0
    out[GUARDS + PIVOT_GUARD] = 0.0
    pivot = pivot_in(mode)
    if pivot != FREE:
        out[PIVOT_GUARD], out[GUARDS + PIVOT_GUARD] = pivot_guard(
            p[RESTRAINT], pivot, p[ANGLE], rotation, spin, turn
        )
    out[LIMIT_GUARD], out[GUARDS + LIMIT_GUARD] = limit_guard(state, p)


@kernel
def mode_of(left: int, right: int, loose: int, rotation: float, spin: float, p: Vector) -> int:
    """Give the mode of a bed's contact, with the pivot of the restraint rule."""
    pivot = PIVOT_CENTRE
    if not nothing_bears(left, right, loose):
        pivot = pivot_of(p[RESTRAINT], left == RAISED, right == RAISED, rotation, spin)
    return left + 2 * right + 4 * loose + PIVOT_FACTOR * pivot


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
    """Carry out the switch that a guard calls for; give the new mode."""
    old = pivot_in(mode)
    if guard_index == PIVOT_GUARD:
        pivot = turned_pivot(old, state, ground_x, memory)
        repin(old, pivot, state, p, memory)
        return mode + PIVOT_FACTOR * (pivot - old)
    left, right, loose = contact_in(mode)
    sine, cosine, rise = sine_cosine_rise(p[HALF_HEIGHT], p[SMALL], state[ROTATION])
    ends = ends_of(state, p, sine, cosine, rise)
    left, right, loose, event = switch_bed(guard_index, left, right, loose, ends, bed_of(p))
    # the crossed level is set exactly, so that rounding cannot undo the switch
    if guard_index == LEFT_END:
        state[VERTICAL] += ends.u_left
    elif guard_index == RIGHT_END:
        state[VERTICAL] += ends.u_right
    new = mode_of(left, right, loose, state[ROTATION], state[COORDINATES + ROTATION], p)
    if pivot_in(new) != old:
        repin(old, pivot_in(new), state, p, memory)
    memory[LAST_EVENT] = event
    return new


@callback(ENERGY)
def energy(mode: int, state: Vector, p: Vector, out: Vector) -> None:
    """Kinetic, gravity and elastic energy, :eq:`eq-energy`."""
    sine, cosine, rise = sine_cosine_rise(p[HALF_HEIGHT], p[SMALL], state[ROTATION])
    ends = ends_of(state, p, sine, cosine, rise)
    out[0] = kinetic_energy(pivot_in(mode), state, p)
    out[1] = p[GRAVITY] * state[VERTICAL]
    out[2], out[3] = bed_energy(ends, bed_of(p), 2.0 * p[HALF_WIDTH])


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
    """Displacements of the centre of mass, the bed's reaction and the contact length."""
    sine, cosine, rise = sine_cosine_rise(p[HALF_HEIGHT], p[SMALL], state[ROTATION])
    ends = ends_of(state, p, sine, cosine, rise)
    bed = bed_of(p)
    left, right, loose = contact_in(mode)
    start, end = bearing_part(left, right, loose, ends, bed)
    width = 2.0 * p[HALF_WIDTH]
    force, _, _ = bed_resultants(left, right, loose, ends, bed, width, 0.0, 0.0)
    observe_body(pivot_in(mode), state, memory, p, out)
    out[REACTION] = force
    out[REACTION + 1] = width * (end - start)
