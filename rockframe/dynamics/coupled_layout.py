"""Layout of the coupled model: parameters, state, modes, guards and columns by their places.

A block on two pads on a cap on a Winkler bed, :mod:`rockframe.dynamics.coupled`. All
quantities per unit mass of the block.
"""

from typing import Final

from rockframe.compiled import Vector, inlined, kernel
from rockframe.dynamics.bed import BED_GUARDS, BED_MODES, PIVOT_FACTOR, Bed, Ends, airborne
from rockframe.dynamics.bed import GLIDING as BED_GLIDING
from rockframe.dynamics.pad import CORNER_GUARDS, LEAVE
from rockframe.dynamics.single_body import FREE
from rockframe.dynamics.two_spring import MODES as BLOCK_MODES
from rockframe.dynamics.two_spring import glides, held_pivot, pivot_in

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
    return held_pivot(mode % BLOCK_MODES)


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
