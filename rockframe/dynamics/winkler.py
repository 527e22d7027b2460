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
    DOWN,
    GLIDING,
    LEFT_END,
    PIVOT_FACTOR,
    RAISED,
    RIGHT_END,
    SLIP,
    Bed,
    Ends,
    airborne,
    bearing_part,
    bed_energy,
    bed_guards,
    bed_resultants,
    switch_bed,
)
from rockframe.dynamics.kinematics import (
    PIVOT_CENTRE,
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
    PIVOT_CHANGE,
    SEPARATION,
    SWITCH,
)
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
    repin,
    repin_landing,
    set_end_rate,
    turned_pivot,
    write_rates,
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
BODY_GUARDS: Final = PIVOT_GUARD + 1
LIMIT_GUARD: Final = BODY_GUARDS
GUARDS: Final = LIMIT_GUARD + 1

COLUMNS: Final = (*body.COLUMNS, "soil_reaction", "contact_length")
REACTION: Final = len(body.COLUMNS)


@inlined
def bed_of(p: Vector) -> Bed:
    """Give the properties of the bed."""
    return Bed(p[STIFFNESS], p[DAMPING], p[SETTLEMENT], p[BY_PRESSURE])


@inlined
def contact_in(mode: int) -> tuple[int, int, int]:
    """Give the states of a mode's ends, and whether the base glides."""
    return mode & 1, (mode >> 1) & 1, (mode >> 2) & 1


@kernel
def pivot_in(mode: int) -> int:
    """Give the pivot of a mode."""
    left, right, gliding = contact_in(mode)
    if gliding == GLIDING or airborne(left, right):
        return FREE
    return mode // PIVOT_FACTOR


@kernel
def gliding_side(mode: int) -> float:
    """Give the side of the end that glides."""
    return LEFT_SIDE if (mode & 1) == DOWN else RIGHT_SIDE


@inlined
def ends_of(state: Vector, p: Vector, sine: float, cosine: float, rise: float) -> Ends:
    """Give the base's ends."""
    height = p[SETTLEMENT] - state[VERTICAL] - rise
    half = p[HALF_WIDTH] * sine
    spin = state[COORDINATES + ROTATION]
    speed = state[COORDINATES + VERTICAL] + p[HALF_HEIGHT] * sine * spin
    tilt = p[HALF_WIDTH] * cosine * spin
    return Ends(height - half, height + half, speed + tilt, speed - tilt)


@inlined
def body_rates(mode: int, state: Vector, ground_x: float, ground_y: float, p: Vector) -> Rates:
    """Give the accelerations of :eq:`eq-winkler`, dashpot power and input power."""
    sine, cosine, rise = sine_cosine_rise(p[HALF_HEIGHT], p[SMALL], state[ROTATION])
    ends = ends_of(state, p, sine, cosine, rise)
    bed = bed_of(p)
    left, right, gliding = contact_in(mode)
    force, moment, burnt = bed_resultants(
        left,
        right,
        gliding,
        ends,
        bed,
        2.0 * p[HALF_WIDTH],
        p[HALF_HEIGHT] * sine + p[HALF_WIDTH] * cosine,
        p[HALF_HEIGHT] * sine - p[HALF_WIDTH] * cosine,
    )
    if gliding == GLIDING:
        return glide_body(
            mode // PIVOT_FACTOR, gliding_side(mode), 0.0, burnt, state, sine, cosine, ground_x,
            ground_y, p,
        )  # fmt: skip
    return move_body(
        pivot_in(mode), state, sine, cosine, force, moment, burnt, ground_x, ground_y, p
    )


@callback(ACCELERATE)
def accelerate(
    mode: int, state: Vector, ground_x: float, ground_y: float, p: Vector, out: Vector
) -> None:
    """Accelerations of :eq:`eq-winkler`, dashpot power and input power."""
    write_rates(body_rates(mode, state, ground_x, ground_y, p), out)


@inlined
def write_guards(
    mode: int,
    state: Vector,
    accelerations: Vector,
    ground_x: float,
    p: Vector,
    first: int,
    guards: int,
    out: Vector,
) -> None:
    """Write the guards of ends, slip and pivot, from `first` on of a model's `guards`."""
    rotation = state[ROTATION]
    spin = state[COORDINATES + ROTATION]
    turn = accelerations[ROTATION]
    sine, cosine, rise = sine_cosine_rise(p[HALF_HEIGHT], p[SMALL], rotation)
    left, right, gliding = contact_in(mode)
    ends = ends_of(state, p, sine, cosine, rise)
    values = bed_guards(left, right, ends, p[SETTLEMENT])
    rates = guards + first
    out[first + LEFT_END], out[first + RIGHT_END], out[first + SLIP] = values[0], values[1], 1.0
    out[rates + LEFT_END], out[rates + RIGHT_END], out[rates + SLIP] = values[2], values[3], 0.0
    if gliding == GLIDING:
        side = gliding_side(mode)
        end = LEFT_END if side > 0.0 else RIGHT_END
        out[first + end], out[first + SLIP], out[rates + SLIP] = glide_guards(
            mode // PIVOT_FACTOR, side, state, accelerations, ground_x, p
        )
        out[rates + end] = 0.0
    out[first + PIVOT_GUARD] = 1.0
    out[rates + PIVOT_GUARD] = 0.0
    if not airborne(left, right):
        out[first + PIVOT_GUARD], out[rates + PIVOT_GUARD] = pivot_guard(
            p[RESTRAINT], mode // PIVOT_FACTOR, p[ANGLE], rotation, spin, turn
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
    """Guards of the ends, of the slip, of the pivot and of the rotation."""
    write_guards(mode, state, accelerations, ground_x, p, 0, GUARDS, out)
    out[LIMIT_GUARD], out[GUARDS + LIMIT_GUARD] = limit_guard(state, p)


@kernel
def mode_of(left: int, right: int, rotation: float, spin: float, rule: float) -> int:
    """Give the mode of a bed's contact, with the pivot of the restraint rule."""
    pivot = PIVOT_CENTRE
    if not airborne(left, right):
        pivot = pivot_of(rule, left == RAISED, right == RAISED, rotation, spin)
    return left + 2 * right + PIVOT_FACTOR * pivot


@kernel
def end_gliding(which: int, mode: int, state: Vector, p: Vector, memory: Vector) -> int:
    """Let a gliding end fly, or hold it as its slip has come to nought."""
    side = gliding_side(mode)
    sine, cosine, rise = sine_cosine_rise(p[HALF_HEIGHT], p[SMALL], state[ROTATION])
    ends = ends_of(state, p, sine, cosine, rise)
    state[VERTICAL] += ends.u_left if side > 0.0 else ends.u_right
    if which != SLIP:
        set_end_rate(side, 0.0, 1.0, 0.0, state, p)
        memory[LAST_EVENT] = SEPARATION
        return RAISED + 2 * RAISED
    repin(FREE, mode // PIVOT_FACTOR, state, p, memory)
    set_end_rate(side, 0.0, -1.0, 0.0, state, p)
    memory[LAST_EVENT] = PIVOT_CHANGE
    return mode - 4 * GLIDING


@callback(SWITCH)
@kernel
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
    left, right, gliding = contact_in(mode)
    if guard_index == PIVOT_GUARD:
        held = mode // PIVOT_FACTOR
        pivot = turned_pivot(held, float(right - left), state, ground_x, memory)
        if gliding != GLIDING:
            repin(old, pivot, state, p, memory)
        return mode + PIVOT_FACTOR * (pivot - held)
    if gliding == GLIDING and (guard_index == SLIP or (mode >> guard_index) & 1 == DOWN):
        return end_gliding(guard_index, mode, state, p, memory)
    sine, cosine, rise = sine_cosine_rise(p[HALF_HEIGHT], p[SMALL], state[ROTATION])
    ends = ends_of(state, p, sine, cosine, rise)
    lands = gliding != GLIDING and airborne(left, right)
    left, right, event = switch_bed(guard_index, left, right, ends, bed_of(p))
    memory[LAST_EVENT] = event
    # the crossed level is set exactly, so that rounding cannot undo the switch
    if guard_index == LEFT_END:
        state[VERTICAL] += ends.u_left
    else:
        state[VERTICAL] += ends.u_right
    new = mode_of(left, right, state[ROTATION], state[COORDINATES + ROTATION], p[RESTRAINT])
    if lands and left != right:
        side = LEFT_SIDE if guard_index == LEFT_END else RIGHT_SIDE
        if repin_landing(pivot_in(new), side, 0.0, 0.0, state, p, memory):
            return new + 4 * GLIDING
    elif pivot_in(new) != old:
        repin(old, pivot_in(new), state, p, memory)
    return new


@callback(ENERGY)
@kernel
def energy(mode: int, state: Vector, p: Vector, out: Vector) -> None:
    """Kinetic, gravity and elastic energy, :eq:`eq-energy`."""
    sine, cosine, rise = sine_cosine_rise(p[HALF_HEIGHT], p[SMALL], state[ROTATION])
    ends = ends_of(state, p, sine, cosine, rise)
    out[0] = kinetic_energy(pivot_in(mode), state, p)
    out[1] = p[GRAVITY] * state[VERTICAL]
    out[2], out[3] = bed_energy(ends, bed_of(p), 2.0 * p[HALF_WIDTH])


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
    """Displacements of the centre of mass, the bed's reaction and the contact length."""
    sine, cosine, rise = sine_cosine_rise(p[HALF_HEIGHT], p[SMALL], state[ROTATION])
    ends = ends_of(state, p, sine, cosine, rise)
    bed = bed_of(p)
    left, right, gliding = contact_in(mode)
    start, end = bearing_part(left, right, gliding, ends, bed)
    width = 2.0 * p[HALF_WIDTH]
    force, _, _ = bed_resultants(left, right, gliding, ends, bed, width, 0.0, 0.0)
    observe_body(pivot_in(mode), state, memory, p, out)
    out[REACTION] = force
    out[REACTION + 1] = width * (end - start)
