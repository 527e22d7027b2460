"""A block on pads on a cap on soil by two stages, Eq. (20), page "Cap and soil" of the manual.

The first body, block and cap as one on a bed (:mod:`rockframe.dynamics.winkler`), is shaken
by the ground. The middle of its top shakes the second, the block on its pads
(:mod:`rockframe.dynamics.two_spring`), which does not act back. Both are integrated together,
so that one control rules the errors of both. Energies are per unit mass of the block.

State: the coordinates of both bodies in turn, so that even places hold those of the first
body and odd places those of the second. What happens at events stands in
:mod:`rockframe.dynamics.cascade_switches`.
"""

from typing import Final

from rockframe.compiled import Vector, callback, inlined, kernel
from rockframe.dynamics import single_body as body
from rockframe.dynamics import two_spring as pads
from rockframe.dynamics import winkler as soil
from rockframe.dynamics.kinematics import sine_cosine_rise
from rockframe.dynamics.protocol import (
    ACCELERATE,
    ENERGY,
    GUARD,
    MEMORY_SIZE,
    OBSERVE,
    ROTATION_LIMIT,
)
from rockframe.dynamics.single_body import (
    HORIZONTAL,
    ROTATION,
    SMALL,
    VERTICAL,
)
from rockframe.dynamics.winkler_carried import PointMotion, carried_point

# parameters: those of the first body, with the limit of the total rotation; of the second; and
FIRST_PARAMETERS: Final = soil.PARAMETERS
MASS_RATIO: Final = FIRST_PARAMETERS + pads.PARAMETERS  # mass of the first body over the block's
TOP: Final = MASS_RATIO + 1  # height of the cap's top above the first centre of mass
CAP_CENTRE: Final = TOP + 1  # the same of the cap's centre
PARAMETERS: Final = CAP_CENTRE + 1

COORDINATES: Final = 2 * body.COORDINATES

# A mode is the block's on its pads + BLOCK_MODES * that of the first body on the bed.
BLOCK_MODES: Final = pads.MODES
MODES: Final = BLOCK_MODES * soil.MODES

# guards: of the block, of the first body, and the limit of the total rotation
SOIL_GUARDS: Final = pads.PADS_GUARDS
LIMIT_GUARD: Final = SOIL_GUARDS + soil.BODY_GUARDS
GUARDS: Final = LIMIT_GUARD + 1

# memory: the block's, with the sums of both; then the first body's own
FIRST_MEMORY: Final = MEMORY_SIZE

COLUMNS: Final = (
    *pads.COLUMNS,
    "soil_reaction",
    "contact_length",
    "cap_rotation",
    "cap_angular_velocity",
    "cap_vertical_displacement",
    "cap_vertical_velocity",
    "rotation_on_cap",
    "vertical_displacement_on_cap",
    "cap_acceleration",
    "cap_vertical_acceleration",
)


@inlined
def top_motion(
    mode: int, state: Vector, turn: float, lift: float, sideways: float, p: Vector
) -> PointMotion:
    """Give the motion of the cap's top from the accelerations of the first body."""
    own = p[:FIRST_PARAMETERS]
    return carried_point(mode // BLOCK_MODES, state[::2], turn, lift, sideways, own, p[TOP])


@callback(ACCELERATE)
def accelerate(
    mode: int, state: Vector, ground_x: float, ground_y: float, p: Vector, out: Vector
) -> None:
    """Accelerations of both bodies, :eq:`eq-winkler` and :eq:`eq-two-spring`, and powers."""
    first = soil.body_rates(
        mode // BLOCK_MODES, state[::2], ground_x, ground_y, p[:FIRST_PARAMETERS]
    )
    top = top_motion(mode, state, first.rotation, first.vertical, first.horizontal, p)
    second = pads.body_rates(
        mode % BLOCK_MODES,
        state[1::2],
        ground_x + top.acceleration_x,
        ground_y + top.acceleration_y,
        p[FIRST_PARAMETERS:],
    )
    out[2 * ROTATION] = first.rotation
    out[2 * VERTICAL] = first.vertical
    out[2 * HORIZONTAL] = first.horizontal
    out[2 * ROTATION + 1] = second.rotation
    out[2 * VERTICAL + 1] = second.vertical
    out[2 * HORIZONTAL + 1] = second.horizontal
    ratio = p[MASS_RATIO]
    out[COORDINATES] = ratio * first.dissipated + second.dissipated
    out[COORDINATES + 1] = ratio * first.supplied + second.supplied


@kernel
def shaking(
    mode: int, state: Vector, ground_x: float, ground_y: float, p: Vector
) -> tuple[float, float]:
    """Give the absolute acceleration of the cap's top, the ground of the second body."""
    first = soil.body_rates(
        mode // BLOCK_MODES, state[::2], ground_x, ground_y, p[:FIRST_PARAMETERS]
    )
    top = top_motion(mode, state, first.rotation, first.vertical, first.horizontal, p)
    return ground_x + top.acceleration_x, ground_y + top.acceleration_y


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
    """Guards of the block on its pads, of the first body on the bed, and of the total rotation."""
    top = top_motion(
        mode,
        state,
        accelerations[2 * ROTATION],
        accelerations[2 * VERTICAL],
        accelerations[2 * HORIZONTAL],
        p,
    )
    pads.write_guards(
        mode % BLOCK_MODES,
        state[1::2],
        accelerations[1::2],
        ground_x + top.acceleration_x,
        p[FIRST_PARAMETERS:],
        GUARDS,
        out,
    )
    soil.write_guards(
        mode // BLOCK_MODES,
        state[::2],
        accelerations[::2],
        ground_x,
        p[:FIRST_PARAMETERS],
        SOIL_GUARDS,
        GUARDS,
        out,
    )
    rotation, spin = total_rotation(state)
    out[LIMIT_GUARD] = p[ROTATION_LIMIT] - abs(rotation)
    out[GUARDS + LIMIT_GUARD] = -spin if rotation > 0.0 else spin


@inlined
def total_rotation(state: Vector) -> tuple[float, float]:
    """Give the rotation of the block, Eq. (20), and its rate."""
    first, second = 2 * ROTATION, 2 * ROTATION + 1
    rate = COORDINATES
    return state[first] + state[second], state[rate + first] + state[rate + second]


@callback(ENERGY)
def energy(mode: int, state: Vector, p: Vector, out: Vector) -> None:
    """Add up the energies of both bodies, each relative to its own ground."""
    soil.energy(mode // BLOCK_MODES, state[::2], p[:FIRST_PARAMETERS], out)
    kinetic, gravity, elastic, change = out[0], out[1], out[2], out[3]
    pads.energy(mode % BLOCK_MODES, state[1::2], p[FIRST_PARAMETERS:], out)
    ratio = p[MASS_RATIO]
    out[0] += ratio * kinetic
    out[1] += ratio * gravity
    out[2] += ratio * elastic
    out[3] += ratio * change


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
    """Motion of the block and of the cap, reactions of pads and soil, and what shakes the block."""
    first, second = state[::2], state[1::2]
    own = p[:FIRST_PARAMETERS]
    soil.observe(mode // BLOCK_MODES, first, memory[FIRST_MEMORY:], ground_x, ground_y, own, out)
    rotation, spin, lift, speed, sway = out[0], out[1], out[2], out[3], out[4]
    press, length = out[soil.REACTION], out[soil.REACTION + 1]
    x, y = shaking(mode, state, ground_x, ground_y, p)
    pads.observe(mode % BLOCK_MODES, second, memory, x, y, p[FIRST_PARAMETERS:], out)
    at = len(pads.COLUMNS)
    out[at] = p[MASS_RATIO] * press
    out[at + 1] = length
    out[at + 2] = rotation
    out[at + 3] = spin
    # a point above the centre of mass sinks by what the centre would rise over it
    sine, _, versine = sine_cosine_rise(1.0, p[SMALL], rotation)
    out[at + 4] = lift - p[CAP_CENTRE] * versine
    out[at + 5] = speed - p[CAP_CENTRE] * sine * spin
    out[at + 6] = out[0]
    out[at + 7] = out[2]
    out[at + 8] = x
    out[at + 9] = y
    out[0] += rotation
    out[1] += spin
    out[2] += lift
    out[3] += speed
    out[4] += sway
