"""Pads, one under each corner, with any force law: reactions, guards and contacts of corners.

Guards :eq:`eq-guards`, energies :eq:`eq-energy`. Elastic pads follow the
:class:`~rockframe.dynamics.point_law.Viscoelastic` law.
"""

import sys
from typing import Any, Final, NamedTuple

from rockframe.compiled import Vector, constant, inlined, kernel
from rockframe.dynamics.base import (
    SIMULTANEOUS,
    Base,
    BaseForce,
    EndEvent,
    Guards,
    Variables,
    equilibrium_height,
)
from rockframe.dynamics.body import BaseLine
from rockframe.dynamics.events import IMPACT, REENGAGEMENT, SEPARATION, SILENT
from rockframe.dynamics.point_law import FREE, Point

# contact of a corner; numbers below RELAXING are held, and count as bearing
TOUCHING: Final = 0
ENGAGING: Final = 1  # held again, but without force: it moves down faster than the unloaded pad
RELAXING: Final = 2  # lifted off without force, still below the pad's unloaded level
CLEAR: Final = 3  # lifted off, above that level
LEAVING: Final = 4  # lifted off by a change of the held point, while its pad still presses it

# two corners' contacts in one integer: that of the left one in its lowest bits; behind them the
# states of the laws of both, the left one first
CORNER_MASK: Final = 7  # mask of one corner
RIGHT_SHIFT: Final = 3  # shift to the right corner
CORNER: Final = 1 << RIGHT_SHIFT
CONTACTS: Final = CORNER * CORNER

# guards of a corner, before those of its law's state
LEAVE: Final = 0  # reaction of a touching corner; gap of one that has lifted off
# a relaxing pad reaches its corner, the pad of a leaving corner loses its force, or the pad of an
# engaging corner gets a force
REENGAGE: Final = 1
REVERSE: Final = 2  # a leaving corner stops rising
CORNER_GUARDS: Final = 3

LEVEL_ROUNDING: Final = 1e-12
"""Distance from the unloaded level, over the settlement, at which a corner is on it [1]."""
ROUNDING: Final = 4.0 * sys.float_info.epsilon
"""Rounding noise of a guard that is no difference of large terms [1]."""


@inlined
def corner_contact(contact: int, left: bool) -> int:
    """Return the contact of one corner."""
    return contact & CORNER_MASK if left else (contact >> RIGHT_SHIFT) & CORNER_MASK


class PadNumbers(NamedTuple):
    """Two pads, per unit mass of the body on them."""

    law: Any  # of each pad, a rockframe.dynamics.point_law.PointLaw
    # settlement of each under half the weight: height of its unloaded level above its corner's
    # place at rest [m]
    rest: float
    rest_energy: float  # of one pad under half the weight [m^2 s^-2]
    frequency: float  # angular frequency of vertical vibration [s^-1]
    least: float  # speed of a landing below which a dashpot's force is rounding noise [m s^-1]
    left_restitution: float  # eps, of an impact on the left pad
    right_restitution: float
    gravity: float  # g
    noise: float  # rounding noise of a reaction over the weight


class Pads(Base, PadNumbers):
    """Two pads under the corners: a :class:`rockframe.dynamics.base.Base`."""

    __slots__ = ()

    @kernel
    def contacts(self) -> int:
        """Return the number of contacts of both corners, with the states of their laws."""
        return CONTACTS * self.law.states() * self.law.states()

    @kernel
    def end_guards(self) -> int:
        """Return the number of guards of a corner."""
        return CORNER_GUARDS + (1 if self.law.states() > 1 else 0)

    @inlined
    def variables(self) -> int:
        """Return the number of variables of both laws."""
        return 2 * self.law.variables()

    @inlined
    def read(self, state: Vector, first: int) -> Any:
        """Read the variables of the left law and of the right one."""
        return self.law.read(state, first, 2)

    @inlined
    def of_corner(self, own: Any, left: bool) -> Any:
        """Return the variables of one corner's law."""
        return self.law.of_point(own, 0 if left else 1)

    @inlined
    def law_state(self, contact: int, left: bool) -> int:
        """Return the state of a corner's law."""
        both = contact // CONTACTS
        return (both if left else both // self.law.states()) % self.law.states()

    @kernel
    def with_state(self, contact: int, left: bool, state: int) -> int:
        """Return the contacts with another state of a corner's law."""
        step = CONTACTS if left else CONTACTS * self.law.states()
        return contact + step * (state - self.law_state(contact, left))

    @kernel
    def with_end(self, contact: int, left: bool, end: int) -> int:
        """Return both corners' contacts with a new one of one corner, its law in state 0."""
        step = 1 if left else CORNER
        new = contact + step * (end - corner_contact(contact, left))
        return self.with_state(new, left, 0)

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
        """Return the sign of the rotation that begins if one corner alone touches, or 0."""
        return float(corner_contact(contact, False) - corner_contact(contact, True))

    @inlined
    def level(self, left: bool, line: BaseLine, own: Any) -> float:
        """Return how far below the unloaded level of its pad a corner is [m]."""
        point = self.corner(left, line)
        return point.settlement - self.law.sunk(self.of_corner(own, left)) - point.rise

    @inlined
    def corner(self, left: bool, line: BaseLine) -> Point:
        """Return the compression and motion of one corner, for its law."""
        rise = line.left if left else line.right
        speed = line.left_speed if left else line.right_speed
        change = line.left_acceleration if left else line.right_acceleration
        return Point(self.rest - rise, -speed, -change, rise, self.rest, 0.0 if left else 1.0, line)

    @inlined
    def reaction(self, contact: int, left: bool, line: BaseLine, own: Any) -> float:
        """Return the reaction of a pad that touches its corner."""
        state, point = self.law_state(contact, left), self.corner(left, line)
        return self.law.force(state, point, self.of_corner(own, left))

    @inlined
    def reaction_and_power(
        self, contact: int, left: bool, line: BaseLine, own: Any
    ) -> tuple[float, float]:
        """Return a pad's reaction and dissipated power in its corner's contact."""
        corner, point = corner_contact(contact, left), self.corner(left, line)
        mine = self.of_corner(own, left)
        if corner == TOUCHING:
            state = self.law_state(contact, left)
            return self.law.force(state, point, mine), self.law.power(state, point, mine)
        if corner != CLEAR:  # the pad follows its corner: its spring relaxes against the dashpot
            return 0.0, -self.law.spring(point, mine) * point.speed
        return 0.0, 0.0

    @inlined
    def force(self, contact: int, line: BaseLine, own: Any) -> BaseForce:
        """Return force, moment and dissipated power of both pads together."""
        left, by_left = self.reaction_and_power(contact, True, line, own)
        right, by_right = self.reaction_and_power(contact, False, line, own)
        moment = left * line.left_lever + right * line.right_lever
        return BaseForce(left + right, moment, by_left + by_right)

    @inlined
    def state_if_touching(self, contact: int, left: bool) -> int:
        """Return the state of a corner's law; FREE if the corner does not touch."""
        touches = corner_contact(contact, left) == TOUCHING
        return self.law_state(contact, left) if touches else FREE

    @inlined
    def flow(self, contact: int, line: BaseLine, own: Any) -> Variables:
        """Return the rates of both laws' variables."""
        on_left = self.state_if_touching(contact, True)
        on_right = self.state_if_touching(contact, False)
        left = self.law.rates(on_left, self.corner(True, line), self.of_corner(own, True))
        right = self.law.rates(on_right, self.corner(False, line), self.of_corner(own, False))
        return left + right

    @kernel
    def pad_energy(self, left: bool, line: BaseLine, own: Any) -> tuple[float, float]:
        """Return the energy of a pad, and the energy less that at rest."""
        if self.level(left, line, own) <= 0.0:
            return 0.0, -self.rest_energy
        point, mine = self.corner(left, line), self.of_corner(own, left)
        return self.law.energies(point, self.rest_energy, mine)

    @kernel
    def energy(self, line: BaseLine, own: Any) -> tuple[float, float]:
        """Return the energy of both pads, and the energy less that at rest."""
        left, left_change = self.pad_energy(True, line, own)
        right, right_change = self.pad_energy(False, line, own)
        return left + right, left_change + right_change

    @inlined
    def guards_of(self, contact: int, left: bool, line: BaseLine, own: Any) -> Guards:
        """Return the guards of a corner and their rates; idle ones are 1."""
        corner, point = corner_contact(contact, left), self.corner(left, line)
        state, mine = self.law_state(contact, left), self.of_corner(own, left)
        per_rest, per_weight = 1.0 / self.rest, 1.0 / self.gravity
        leave, leave_rate = self.level(left, line, own) * per_rest, point.speed * per_rest
        again, again_rate, reverse, reverse_rate = 1.0, 0.0, 1.0, 0.0
        reaction = self.law.force(state, point, mine) * per_weight
        change = self.law.force_rate(state, point, mine) * per_weight
        if corner == TOUCHING:
            leave, leave_rate = reaction, change
        elif corner == ENGAGING:  # until pressed, only its height ends its contact
            again, again_rate = -reaction, -change
        elif corner == CLEAR:
            leave, leave_rate = -leave, -leave_rate
            if leave_rate < 0.0 and point.speed <= self.least and point.acceleration < 0.0:
                leave_rate = 0.0  # its downward speed is rounding
        elif corner == RELAXING:  # the pad presses again at a positive force
            again, again_rate = -reaction, -change
        else:  # LEAVING: it becomes relaxing once the pad has lost its force
            again, again_rate = reaction, change
            scale = 1.0 / (self.rest * self.frequency)
            reverse, reverse_rate = -scale * point.speed, -scale * point.acceleration
        of_law = self.law.guards(state, point, mine)
        if corner != TOUCHING:
            of_law = Guards(constant(1.0, of_law.values), constant(0.0, of_law.changes))
        return Guards(
            (leave, again, reverse) + of_law.values,
            (leave_rate, again_rate, reverse_rate) + of_law.changes,
        )

    @kernel
    def released_corner(self, left: bool, line: BaseLine, own: Any) -> int:
        """Return the contact of a corner that has just lifted off: RELAXING, or CLEAR."""
        pressed = self.level(left, line, own)
        if self.law.return_rate() > 0.0 and pressed > LEVEL_ROUNDING * self.rest:
            return RELAXING
        return CLEAR

    @kernel
    def switch(self, contact: int, left: bool, which: int, line: BaseLine, own: Any) -> EndEvent:
        """Return contacts and event after a guard of a corner; correct the laws' variables."""
        if which == CORNER_GUARDS:
            state = (self.law_state(contact, left) + 1) % self.law.states()
            event = EndEvent(self.with_state(contact, left, state), SILENT, False)
        else:
            event = self.switch_corner(contact, left, which, line, own)
        self.settle(event.contact, line, own)
        return event

    @kernel
    def settle(self, contact: int, line: BaseLine, own: Any) -> None:
        """Correct variables of both laws that are out of range."""
        left, right = self.law_state(contact, True), self.law_state(contact, False)
        self.law.settle(left, self.corner(True, line), self.of_corner(own, True))
        self.law.settle(right, self.corner(False, line), self.of_corner(own, False))

    @kernel
    def switch_corner(
        self, contact: int, left: bool, which: int, line: BaseLine, own: Any
    ) -> EndEvent:
        """Return the contacts and the event after a guard of a corner's contact.

        Where both corners land, or leave, at the same instant one event switches both.
        """
        corner, other = corner_contact(contact, left), corner_contact(contact, not left)
        if corner in (RELAXING, LEAVING) and which == LEAVE:
            return EndEvent(self.with_end(contact, left, CLEAR), SILENT, True)
        if corner == LEAVING and which == REENGAGE:
            return EndEvent(self.with_end(contact, left, RELAXING), SILENT, False)
        if corner == ENGAGING and which == REENGAGE:
            return EndEvent(self.with_end(contact, left, TOUCHING), SILENT, False)
        was, other_speed = other, -self.corner(not left, line).speed
        event, crossed = REENGAGEMENT, False
        if corner < RELAXING:
            # in a motion that is symmetric both reactions are the same, on either side of zero;
            # a corner that has just landed with the first one moves into its pad
            reaction = self.reaction(contact, not left, line, own)
            leaves = reaction <= 0.0 and other_speed >= 0.0
            if other == TOUCHING and (
                leaves or reaction == self.reaction(contact, left, line, own)
            ):
                other = self.released_corner(not left, line, own)
            elif other in (ENGAGING, LEAVING):
                other = RELAXING  # no corner holds the body any more
            corner = self.released_corner(left, line, own)
            event, crossed = SEPARATION, corner == CLEAR
        else:
            if corner == CLEAR:
                event, crossed = IMPACT, True
                level = abs(self.level(not left, line, own))
                falls = other_speed < 0.0 or other_speed == -self.corner(left, line).speed
                if other == CLEAR and level <= SIMULTANEOUS * self.rest and falls:
                    other = TOUCHING
            if other == LEAVING:
                other = RELAXING
            corner = TOUCHING
        both = self.with_end(contact, left, corner)
        if other != was:
            both = self.with_end(both, not left, other)
        return EndEvent(both, event, crossed)

    @kernel
    def is_level(self, left: bool, line: BaseLine, own: Any) -> bool:
        """Whether a relaxing or sliding corner is at the unloaded level, but for rounding."""
        return self.level(left, line, own) < SIMULTANEOUS * self.rest

    @inlined
    def follows(self, contact: int, left: bool) -> int:
        """Return the contact with a corner that its pad follows without a force."""
        return self.with_end(contact, left, RELAXING)

    @inlined
    def following_rate(self) -> float:
        """Return the rate at which an unloaded pad returns [s^-1]; 0 without a dashpot."""
        return self.law.return_rate()

    @inlined
    def least_landing(self) -> float:
        """Return the speed of a landing below which a dashpot's force is rounding noise."""
        return self.least

    @kernel
    def released(self, contact: int, left: bool, line: BaseLine, own: Any) -> int:
        """Return the contact after a sliding corner has lifted off."""
        return self.with_end(contact, left, self.released_corner(left, line, own))

    @kernel
    def presses(self, contact: int, left: bool, line: BaseLine, own: Any) -> bool:
        """Whether the pad still presses a corner that has just lifted off."""
        if corner_contact(contact, left) != RELAXING:
            return False
        return self.reaction(contact, left, line, own) >= -self.noise * self.gravity

    @kernel
    def will_press(self, left: bool, line: BaseLine, own: Any) -> bool:
        """Whether the force of the pad would rise with the line's accelerations."""
        return self.law.force_rate(0, self.corner(left, line), self.of_corner(own, left)) > 0.0

    @kernel
    def engaged(self, contact: int, left: bool, line: BaseLine, own: Any) -> int:
        """Return the contact after a corner has landed on its pad and its body is held."""
        if self.reaction(contact, left, line, own) < 0.0:
            # the hold made the corner faster than its pad; released, it would land again endlessly
            return self.with_end(contact, left, ENGAGING)
        return contact

    @kernel
    def disturbed(self, contact: int) -> int:
        """Return the contact after an event elsewhere has changed the corners' speeds."""
        if corner_contact(contact, True) == LEAVING:
            contact = self.with_end(contact, True, RELAXING)
        if corner_contact(contact, False) == LEAVING:
            contact = self.with_end(contact, False, RELAXING)
        return contact

    @kernel
    def rebound(self, left: bool) -> float:
        """Return the coefficient of restitution of a corner that lands [1]."""
        return self.left_restitution if left else self.right_restitution

    @kernel
    def starting_corner(self, left: bool, line: BaseLine, own: Any) -> int:
        """Return a corner's contact at the start of a run."""
        if self.level(left, line, own) <= 0.0:
            return CLEAR
        return TOUCHING if self.reaction(TOUCHING, left, line, own) > 0.0 else RELAXING

    @kernel
    def starting(self, line: BaseLine, own: Any) -> int:
        """Return the contact at the start of a run."""
        self.law.reset(own)
        self.settle(TOUCHING, line, own)
        right = self.starting_corner(False, line, own)
        return self.starting_corner(True, line, own) + CORNER * right

    def resting_height(self, left: float, right: float, own: Any) -> float:
        """Return the height at which the pads carry the weight [m], found numerically."""
        return equilibrium_height(self, self.gravity, 2.0 * self.rest, (left, right), own)

    @kernel
    def observed(self, contact: int, line: BaseLine, own: Any) -> Variables:
        """Return the reactions of the left and right pad, and the columns of their laws."""
        left, _ = self.reaction_and_power(contact, True, line, own)
        right, _ = self.reaction_and_power(contact, False, line, own)
        on_left = self.state_if_touching(contact, True)
        on_right = self.state_if_touching(contact, False)
        of_left = self.law.seen(on_left, self.corner(True, line), self.of_corner(own, True))
        of_right = self.law.seen(on_right, self.corner(False, line), self.of_corner(own, False))
        return (left, right) + of_left + of_right


class ElasticPads(Pads):
    """Two pads of linear springs and dashpots, whose equilibrium is known in closed form."""

    __slots__ = ()

    @kernel
    def resting_height(self, left: float, right: float, own: Any) -> float:
        """Return the height at which both pads, or only the lower one, carry the weight [m]."""
        middle = 0.0 - 0.5 * (left + right)
        if middle + left > self.rest:
            return self.rest - right - 2.0 * self.rest
        if middle + right > self.rest:
            return self.rest - left - 2.0 * self.rest
        return middle
