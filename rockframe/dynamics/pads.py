"""Two pads, one under each corner: reaction, guards, and the corners' contacts.

Pad forces :eq:`eq-pad-force`, guards :eq:`eq-guards`, energies :eq:`eq-energy`. A
:class:`rockframe.dynamics.base.Base`.
"""

import math
import sys
from typing import Final, NamedTuple

from rockframe.compiled import Vector, inlined, kernel
from rockframe.dynamics.base import BaseForce, EndEvent, Guards, Variables
from rockframe.dynamics.body import BaseLine
from rockframe.dynamics.events import IMPACT, REENGAGEMENT, SEPARATION, SILENT

# contact of a corner; it is held, and counts as bearing, below RELAXING
TOUCHING: Final = 0
ENGAGING: Final = 1  # held again, but the pad has not caught up with the corner
RELAXING: Final = 2  # free, but still below the pad's unloaded level
CLEAR: Final = 3  # free, above it
LEAVING: Final = 4  # free, though the re-pinning of its separation left it pressing

# two corners' contacts in one integer: that of the left one in its lowest bits
CORNER_BITS: Final = 7
RIGHT_BIT: Final = 3
CORNER: Final = 1 << RIGHT_BIT
CONTACTS: Final = CORNER * CORNER

# guards of a corner
LEAVE: Final = 0  # the reaction of a touching corner; the gap of a free one
REENGAGE: Final = 1  # a relaxing pad catches up with its corner; a leaving corner outruns its pad
REVERSE: Final = 2  # a leaving corner stops rising; an engaging one is pressed
CORNER_GUARDS: Final = 3

SIMULTANEOUS: Final = 1e-9
"""Share of the settlement within which both corners land together."""
LEVEL_ROUNDING: Final = 1e-12
"""Share of the settlement within which a corner is at the pad's unloaded level."""
ROUNDING: Final = 4.0 * sys.float_info.epsilon
"""Rounding noise of a guard that is no difference of large terms."""


@inlined
def corner_contact(contact: int, left: bool) -> int:
    """Give the contact of one corner."""
    return contact & CORNER_BITS if left else contact >> RIGHT_BIT


@inlined
def with_corner(contact: int, left: bool, corner: int) -> int:
    """Give both corners' contacts with another one of one corner."""
    if left:
        return corner + contact - (contact & CORNER_BITS)
    return (contact & CORNER_BITS) + (corner << RIGHT_BIT)


@inlined
def corner_level(line: BaseLine, left: bool) -> float:
    """Give the height of one corner above its place at rest."""
    return line.left if left else line.right


@inlined
def corner_speed(line: BaseLine, left: bool) -> float:
    """Give the speed of one corner upwards."""
    return line.left_speed if left else line.right_speed


class Pads(NamedTuple):
    """Two pads, per unit mass of the body on them."""

    stiffness: float  # k/m, of one pad
    damping: float  # c/m
    left_settlement: float  # of the unloaded level above the corner's place at rest
    right_settlement: float
    rest: float  # settlement under half the weight
    left_restitution: float  # eps, of an impact on the left pad
    right_restitution: float
    gravity: float  # g
    body_size: float  # of the body: heights are differences of terms as large

    @kernel
    def contacts(self) -> int:
        """Give the number of both corners' contacts."""
        return CONTACTS

    @kernel
    def end_guards(self) -> int:
        """Give the number of guards of a corner."""
        return CORNER_GUARDS

    @kernel
    def variables(self) -> int:
        """Give 0: elastic pads have no variables of their own."""
        return 0

    @kernel
    def read(self, state: Vector, first: int) -> Variables:
        """Give none."""
        return ()

    @kernel
    def flow(self, contact: int, line: BaseLine, own: Variables) -> Variables:
        """Give none."""
        return ()

    @inlined
    def is_held(self, contact: int, left: bool) -> bool:
        """Whether a corner is held by its pad."""
        return corner_contact(contact, left) < RELAXING

    @inlined
    def touches(self, contact: int, left: bool) -> bool:
        """Whether a corner touches its pad."""
        return corner_contact(contact, left) == TOUCHING

    @kernel
    def tilt(self, contact: int) -> float:
        """Give the side that the pad of the corner that touches raises."""
        return float(corner_contact(contact, False) - corner_contact(contact, True))

    @inlined
    def settlement_of(self, left: bool) -> float:
        """Give how far a pad's unloaded level stands above its corner's place at rest."""
        return self.left_settlement if left else self.right_settlement

    @inlined
    def reaction(self, left: bool, line: BaseLine) -> float:
        """Give the reaction of a pad that touches its corner, :eq:`eq-pad-force`."""
        pressed = self.settlement_of(left) - corner_level(line, left)
        return self.stiffness * pressed - self.damping * corner_speed(line, left)

    @inlined
    def reaction_and_power(self, contact: int, left: bool, line: BaseLine) -> tuple[float, float]:
        """Give a pad's reaction and what its dashpot dissipates, in its corner's contact."""
        corner, speed = corner_contact(contact, left), corner_speed(line, left)
        if corner == TOUCHING:
            return self.reaction(left, line), self.damping * speed * speed
        if corner != CLEAR:  # the pad follows its corner, and its spring feeds the dashpot
            pressed = self.settlement_of(left) - corner_level(line, left)
            return 0.0, self.stiffness * pressed * speed
        return 0.0, 0.0

    @inlined
    def force(self, contact: int, line: BaseLine, own: Variables) -> BaseForce:
        """Give the reactions of both pads together."""
        left, by_left = self.reaction_and_power(contact, True, line)
        right, by_right = self.reaction_and_power(contact, False, line)
        moment = left * line.left_lever + right * line.right_lever
        return BaseForce(left + right, moment, by_left + by_right)

    @kernel
    def pad_energy(self, left: bool, line: BaseLine) -> tuple[float, float]:
        """Give the energy of a pad's spring, and that less the energy at rest."""
        settlement, level = self.settlement_of(left), corner_level(line, left)
        if level >= settlement:
            return 0.0, -0.5 * self.stiffness * self.rest * self.rest
        pressed = settlement - level
        # as products, to all digits
        change = level * (0.5 * level - settlement)
        change += 0.5 * (settlement - self.rest) * (settlement + self.rest)
        return 0.5 * self.stiffness * pressed * pressed, self.stiffness * change

    @kernel
    def energy(self, line: BaseLine, own: Variables) -> tuple[float, float]:
        """Give the energy of both springs, and that less the energy at rest."""
        left, left_change = self.pad_energy(True, line)
        right, right_change = self.pad_energy(False, line)
        return left + right, left_change + right_change

    @inlined
    def guards_of(
        self, contact: int, left: bool, line: BaseLine, acceleration: float, own: Variables
    ) -> Guards:
        """Give the three guards of a corner and their rates; idle ones are 1."""
        corner, settlement = corner_contact(contact, left), self.settlement_of(left)
        level, speed = corner_level(line, left), corner_speed(line, left)
        per_rest, per_weight = 1.0 / self.rest, 1.0 / self.gravity
        gap, gap_rate = (level - settlement) * per_rest, speed * per_rest
        leave, leave_rate = -gap, -gap_rate
        again, again_rate, reverse, reverse_rate = 1.0, 0.0, 1.0, 0.0
        reaction = self.reaction(left, line) * per_weight
        change = -(self.stiffness * speed + self.damping * acceleration) * per_weight
        if corner == TOUCHING:
            leave, leave_rate = reaction, change
        elif corner == ENGAGING:  # until it is pressed, only its height can take it off again
            reverse, reverse_rate = -reaction, -change
        elif corner == CLEAR:
            leave, leave_rate = gap, gap_rate
        elif corner == RELAXING:  # the pad presses again at a positive force
            again, again_rate = -reaction, -change
        else:  # after its separation the pad must have let go before
            again, again_rate = reaction, change
            scale = 1.0 / (self.rest * math.sqrt(2.0 * self.stiffness))
            reverse, reverse_rate = scale * speed, scale * acceleration
        return Guards((leave, again, reverse), (leave_rate, again_rate, reverse_rate))

    @kernel
    def released_corner(self, left: bool, line: BaseLine) -> int:
        """Give the contact of a corner that has just left: relaxing, or clear at once."""
        pressed = self.settlement_of(left) - corner_level(line, left)
        if self.damping > 0.0 and pressed > LEVEL_ROUNDING * self.rest:
            return RELAXING
        return CLEAR

    @kernel
    def switch(
        self, contact: int, left: bool, which: int, line: BaseLine, own: Variables
    ) -> EndEvent:
        """Give the contacts and the event after a guard of a corner.

        A corner that lands together with the other one, or leaves together with it, takes it
        along.
        """
        corner, other = corner_contact(contact, left), corner_contact(contact, not left)
        if corner in (RELAXING, LEAVING) and which == LEAVE:
            return EndEvent(with_corner(contact, left, CLEAR), SILENT, True)
        if corner == LEAVING and which == REENGAGE:
            return EndEvent(with_corner(contact, left, RELAXING), SILENT, False)
        if corner == ENGAGING and which == REVERSE:
            return EndEvent(with_corner(contact, left, TOUCHING), SILENT, False)
        other_speed = corner_speed(line, not left)
        if corner < RELAXING:
            # in a motion that is symmetric both reactions are the same, on either side of zero;
            # a corner that has just come down with the first one is on its way into its pad
            reaction = self.reaction(not left, line)
            leaves = reaction <= 0.0 and other_speed >= 0.0
            if other == TOUCHING and (leaves or reaction == self.reaction(left, line)):
                other = self.released_corner(not left, line)
            elif other in (ENGAGING, LEAVING):
                other = RELAXING  # nothing is held any more; what waited is judged anew
            corner = self.released_corner(left, line)
            both = with_corner(with_corner(0, left, corner), not left, other)
            return EndEvent(both, SEPARATION, corner == CLEAR)
        event = REENGAGEMENT
        if corner == CLEAR:
            event = IMPACT
            level = abs(corner_level(line, not left) - self.settlement_of(not left))
            falls = other_speed < 0.0 or other_speed == corner_speed(line, left)
            if other == CLEAR and level <= SIMULTANEOUS * self.rest and falls:
                other = TOUCHING
        if other == LEAVING:
            other = RELAXING
        both = with_corner(with_corner(0, left, TOUCHING), not left, other)
        return EndEvent(both, event, event == IMPACT)

    @kernel
    def variables_after(self, was: int, contact: int, line: BaseLine, own: Variables) -> Variables:
        """Give none."""
        return ()

    @kernel
    def level(self, left: bool, line: BaseLine, own: Variables) -> float:
        """Give how much higher than its corner a pad's unloaded level is."""
        return self.settlement_of(left) - corner_level(line, left)

    @kernel
    def is_level(self, left: bool, line: BaseLine, own: Variables) -> bool:
        """Whether a corner that follows its pad has come to the unloaded level."""
        return self.level(left, line, own) < SIMULTANEOUS * self.rest

    @inlined
    def follows(self, contact: int, left: bool) -> int:
        """Give the contact with a corner that its pad follows."""
        return with_corner(contact, left, RELAXING)

    @inlined
    def following_rate(self) -> float:
        """Give k/c, the rate at which an unloaded pad returns; 0 without a dashpot."""
        return self.stiffness / self.damping if self.damping > 0.0 else 0.0

    @kernel
    def following_speed(self, left: bool, line: BaseLine, own: Variables) -> float:
        """Give the speed of a corner that follows its pad without a force, :eq:`eq-forceless`."""
        return self.following_rate() * (self.settlement_of(left) - corner_level(line, left))

    @kernel
    def noise(self) -> float:
        """Give the rounding noise of a reaction over the weight."""
        return ROUNDING * (1.0 + self.body_size / self.rest)

    @kernel
    def least_landing(self) -> float:
        """Give the speed of a landing below which a dashpot's answer is rounding noise."""
        if self.damping == 0.0:
            return 0.0
        return 2.0 * self.gravity * self.noise() / self.damping

    @kernel
    def released(self, contact: int, left: bool, line: BaseLine, own: Variables) -> int:
        """Give the contact after a corner that slid has left."""
        return with_corner(contact, left, self.released_corner(left, line))

    @kernel
    def presses(self, contact: int, left: bool, line: BaseLine, own: Variables) -> bool:
        """Whether the pad still presses a corner that has just left and follows it."""
        if corner_contact(contact, left) != RELAXING:
            return False
        return self.reaction(left, line) >= -self.noise() * self.gravity

    @kernel
    def will_press(self, left: bool, line: BaseLine, acceleration: float, own: Variables) -> bool:
        """Whether the pad force of :eq:`eq-pad-force` would rise."""
        return self.stiffness * corner_speed(line, left) + self.damping * acceleration < 0.0

    @kernel
    def held(self, contact: int, left: bool) -> int:
        """Give the contact with a corner that touches."""
        return with_corner(contact, left, TOUCHING)

    @kernel
    def waiting(self, contact: int, left: bool) -> int:
        """Give the contact of a corner that has left while its pad still presses it."""
        return with_corner(contact, left, LEAVING)

    @kernel
    def unpressed(self, contact: int, left: bool) -> int:
        """Give the contact of a corner that stays held though its pad has ceased to press it."""
        return with_corner(contact, left, ENGAGING)

    @kernel
    def engaged(self, contact: int, left: bool, line: BaseLine, own: Variables) -> int:
        """Give the contact after a corner has come back to its pad and been held."""
        if self.reaction(left, line) < 0.0:
            # re-pinning sped the corner up beyond its pad: let go, it would come back without end
            return with_corner(contact, left, ENGAGING)
        return contact

    @kernel
    def disturbed(self, contact: int) -> int:
        """Give the contact after something else changed the corners' speeds."""
        if corner_contact(contact, True) == LEAVING:
            contact = with_corner(contact, True, RELAXING)
        if corner_contact(contact, False) == LEAVING:
            contact = with_corner(contact, False, RELAXING)
        return contact

    @kernel
    def rebound(self, left: bool) -> float:
        """Give the restitution of a corner that lands."""
        return self.left_restitution if left else self.right_restitution

    @kernel
    def starting_corner(self, left: bool, line: BaseLine) -> int:
        """Give a corner's contact at the start of a run."""
        if corner_level(line, left) >= self.settlement_of(left):
            return CLEAR
        return TOUCHING if self.reaction(left, line) > 0.0 else RELAXING

    @kernel
    def starting(self, line: BaseLine, own: Variables) -> int:
        """Give the contact at the start of a run."""
        right = self.starting_corner(False, line)
        return self.starting_corner(True, line) + CORNER * right

    @kernel
    def resting_height(self, left: float, right: float, own: Variables) -> float:
        """Give the height at which both pads, or only the lower one, carry the weight."""
        sunk = (self.left_settlement - self.rest) + (self.right_settlement - self.rest)
        middle = 0.5 * (sunk - left - right)
        if middle + left > self.left_settlement:
            return self.right_settlement - right - 2.0 * self.rest
        if middle + right > self.right_settlement:
            return self.left_settlement - left - 2.0 * self.rest
        return middle

    @kernel
    def observed(self, contact: int, line: BaseLine, own: Variables) -> Variables:
        """Give the reactions of the left and of the right pad."""
        left, _ = self.reaction_and_power(contact, True, line)
        right, _ = self.reaction_and_power(contact, False, line)
        return left, right


@inlined
def sunk_pads(pads: Pads, left: float, right: float) -> Pads:
    """Give pads whose unloaded levels have sunk for good."""
    return Pads(
        pads.stiffness, pads.damping, pads.left_settlement - left, pads.right_settlement - right,
        pads.rest, pads.left_restitution, pads.right_restitution, pads.gravity, pads.body_size,
    )  # fmt: skip
