"""A pad and the corner it carries: reaction, guards, and the corner's contact.

Functions of plain numbers, for a block on the ground as for one on a cap. Pad
forces :eq:`eq-pad-force`, guards :eq:`eq-guards`. Per unit mass of the block.
"""

import math
from typing import Final

from rockframe.compiled import Vector, inlined, kernel
from rockframe.dynamics.protocol import IMPACT, REENGAGEMENT, ROUNDING, SEPARATION, SILENT

# contact of a corner; it is held, and counts as bearing, below RELAXING
TOUCHING: Final = 0
ENGAGING: Final = 1  # held again, but the pad has not caught up with the corner
RELAXING: Final = 2  # free, but still below the pad's unloaded level
CLEAR: Final = 3  # free, above it
LEAVING: Final = 4  # free, though the re-pinning of its separation left it pressing

# Two corners' contacts in one integer: left corner + 8 * right corner.
CORNER_BITS: Final = 3
CORNER_MASK: Final = 7
CONTACT_BITS: Final = 6
CONTACTS: Final = 1 << CONTACT_BITS

# guards of a corner
LEAVE: Final = 0  # the reaction of a touching corner; the gap of a free one
REENGAGE: Final = 1  # a relaxing pad catches up with its corner; a leaving corner outruns its pad
TURN: Final = 2  # a leaving corner stops rising; an engaging one is pressed
CORNER_GUARDS: Final = 3

SIMULTANEOUS: Final = 1e-9
"""Share of the settlement within which both corners land together."""
DISTURBED: Final = 1e3
"""Speed of a gliding end beside its own, over its rounding noise, from which on it flies."""
LEVEL_ROUNDING: Final = 1e-12
"""Share of the settlement within which a corner is at the pad's unloaded level."""


@inlined
def corners_in(contacts: int) -> tuple[int, int]:
    """Give the contacts of the left and of the right corner."""
    return contacts & CORNER_MASK, (contacts >> CORNER_BITS) & CORNER_MASK


@inlined
def both_corners(left: int, right: int) -> int:
    """Give the integer that holds both corners' contacts."""
    return left + (right << CORNER_BITS)


@inlined
def pad_force(
    level: float, rate: float, stiffness: float, damping: float, settlement: float
) -> float:
    """Give the reaction of a pad under a corner at a height, :eq:`eq-pad-force`."""
    return stiffness * (settlement - level) - damping * rate


@inlined
def pad_force_and_power(
    contact: int, level: float, rate: float, stiffness: float, damping: float, settlement: float
) -> tuple[float, float]:
    """Give a pad's reaction and what its dashpot burns, in the corner's contact."""
    if contact == TOUCHING:
        return pad_force(level, rate, stiffness, damping, settlement), damping * rate * rate
    if contact != CLEAR:  # the pad follows its corner, and its spring feeds the dashpot
        return 0.0, stiffness * (settlement - level) * rate
    return 0.0, 0.0


@kernel
def pad_energy(level: float, stiffness: float, settlement: float) -> tuple[float, float]:
    """Give the energy of a pad's spring, and that less the energy at rest."""
    if level < settlement:
        pressed = settlement - level
        return 0.5 * stiffness * pressed * pressed, stiffness * level * (0.5 * level - settlement)
    return 0.0, -0.5 * stiffness * settlement * settlement


@kernel
def corner_guards(
    contact: int,
    first: int,
    guards: int,
    level: float,
    rate: float,
    acceleration: float,
    stiffness: float,
    damping: float,
    settlement: float,
    gravity: float,
    out: Vector,
) -> None:
    """Write the three guards of a corner and their rates; idle ones stay at 1.

    They start at index `first` of the model's `guards`.
    """
    out[first + REENGAGE] = 1.0
    out[first + TURN] = 1.0
    out[guards + first + REENGAGE] = 0.0
    out[guards + first + TURN] = 0.0
    if contact < RELAXING:
        reaction = pad_force(level, rate, stiffness, damping, settlement) / gravity
        change = -(stiffness * rate + damping * acceleration) / gravity
        if contact == TOUCHING:
            out[first + LEAVE] = reaction
            out[guards + first + LEAVE] = change
        else:  # until it is pressed, only its height can take it off again
            out[first + LEAVE] = 1.0 - level / settlement
            out[guards + first + LEAVE] = -rate / settlement
            out[first + TURN] = -reaction
            out[guards + first + TURN] = -change
    elif contact == CLEAR:
        out[first + LEAVE] = level / settlement - 1.0
        out[guards + first + LEAVE] = rate / settlement
    else:
        out[first + LEAVE] = 1.0 - level / settlement
        out[guards + first + LEAVE] = -rate / settlement
        # a pad presses again at a positive force; after a separation it must have let go before
        sign = 1.0 if contact == LEAVING else -1.0
        force = pad_force(level, rate, stiffness, damping, settlement)
        out[first + REENGAGE] = sign * force / gravity
        out[guards + first + REENGAGE] = (
            -sign * (damping * acceleration + stiffness * rate) / gravity
        )
        if contact == LEAVING:
            scale = settlement * math.sqrt(2.0 * stiffness)
            out[first + TURN] = rate / scale
            out[guards + first + TURN] = acceleration / scale


@inlined
def reaction_noise(size: float, settlement: float) -> float:
    """Give the rounding noise of a reaction over the weight: heights are of the body's size."""
    return ROUNDING * (1.0 + size / settlement)


@inlined
def least_speed(size: float, gravity: float, damping: float, settlement: float) -> float:
    """Give the speed of a landing below which a dashpot's answer is rounding noise."""
    if damping == 0.0:
        return 0.0
    return 2.0 * gravity * reaction_noise(size, settlement) / damping


@kernel
def start_contact(level: float, reaction: float, settlement: float) -> int:
    """Give a corner's contact at the start of a run."""
    if level >= settlement:
        return CLEAR
    return TOUCHING if reaction > 0.0 else RELAXING


@kernel
def released(level: float, damping: float, settlement: float) -> int:
    """Give the contact of a corner that has just left: relaxing, or clear at once."""
    if damping > 0.0 and settlement - level > LEVEL_ROUNDING * settlement:
        return RELAXING
    return CLEAR


@inlined
def relaxation_rate(stiffness: float, damping: float) -> float:
    """Give the rate at which an unloaded pad returns to its level, 0 without a dashpot."""
    return stiffness / damping if damping > 0.0 else 0.0


@kernel
def forceless_rate(level: float, stiffness: float, damping: float, settlement: float) -> float:
    """Give the speed of a corner that follows its pad without a force, :eq:`eq-forceless`."""
    return relaxation_rate(stiffness, damping) * (settlement - level)


@inlined
def force_rises(rate: float, acceleration: float, stiffness: float, damping: float) -> bool:
    """Whether the pad force of :eq:`eq-pad-force` rises."""
    return stiffness * rate + damping * acceleration < 0.0


@inlined
def judged_anew(contact: int) -> int:
    """Give a corner's contact after something else than its own separation changed its speed."""
    return RELAXING if contact == LEAVING else contact


@kernel
def switch_corner(
    which: int,
    contact: int,
    other: int,
    level: float,
    other_level: float,
    rate: float,
    other_rate: float,
    reaction: float,
    other_reaction: float,
    damping: float,
    settlement: float,
) -> tuple[int, int, int]:
    """Give the contacts of a corner and of the other one, and the event, after a guard.

    `which` is the guard of the corner that fell. A corner that lands together with
    the other one, or leaves together with it, takes it along.
    """
    if contact in (RELAXING, LEAVING) and which == LEAVE:
        return CLEAR, other, SILENT
    if contact == LEAVING and which == REENGAGE:
        return RELAXING, other, SILENT
    if contact == ENGAGING and which == TURN:
        return TOUCHING, other, SILENT
    if contact < RELAXING:
        # in a motion that is symmetric both reactions are the same, on either side of zero;
        # a corner that has just come down with the first one is on its way into its pad
        leaves = other_reaction <= 0.0 and other_rate >= 0.0
        if other == TOUCHING and (leaves or other_reaction == reaction):
            other = released(other_level, damping, settlement)
        elif other == ENGAGING:  # nothing presses any more, so that nothing is held
            other = RELAXING
        return released(level, damping, settlement), other, SEPARATION
    if contact == CLEAR:
        level = abs(other_level - settlement)
        falls = other_rate < 0.0 or other_rate == rate
        if other == CLEAR and level <= SIMULTANEOUS * settlement and falls:
            other = TOUCHING
        return TOUCHING, other, IMPACT
    return TOUCHING, other, REENGAGEMENT
