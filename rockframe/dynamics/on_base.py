"""A body on its base: equation of motion, guards, and response to impulses.

One equation of motion, :eq:`eq-two-spring`, serves all contact states and all bases: the
paper's Eqs. (12), (15), (18) and (19), corrected, are its special cases. Events are
carried out in :mod:`rockframe.dynamics.switching`. All quantities per unit mass.

An end can land while the horizontal restraint that its contact causes would lift it off again.
Then neither contact nor flight is a solution: a held end lifts off, a free one lands again. The
restraint can act only while the end presses, so its impulse ends when the end's speed equals that
of the base beneath it, :eq:`eq-partial-hold`. With the rest of its slip the end *slides*: it
remains at its level with no reaction, and the held point slips against a force that is just large
enough to keep the end there, :eq:`eq-sliding-contact`.
"""

import math
import sys
from typing import Any, Final, NamedTuple

from rockframe.compiled import constant, inlined, kernel
from rockframe.dynamics.base import Guards
from rockframe.dynamics.body import (
    LEADING_CORNER,
    PIVOT_CENTRE,
    PIVOT_RIGHT,
    Attitude,
    BaseLine,
    Body,
    BodyState,
    pivot_of,
    with_accelerations,
)
from rockframe.dynamics.events import FLIGHT, FULL, LEFT, RIGHT
from rockframe.dynamics.protocol import Ground

# guards of a body, behind those of both ends of its base
HOLD: Final = 0  # of a sliding end: the force of the hold that keeps it at its level
SLIP: Final = 1  # of a sliding end: its slip
PIVOT: Final = 2  # of the rule of restraint: change of the held corner
BODY_GUARDS: Final = 3

# a mode as an integer: the pivot in its lowest bits, then whether an end slides, then the contact
PIVOT_MASK: Final = 3
SLIDING_BIT: Final = 4
CONTACT_SHIFT: Final = 3
MODES_PER_CONTACT: Final = 1 << CONTACT_SHIFT
"""Modes of each contact."""

SPEED_ROUNDING: Final = 16.0 * sys.float_info.epsilon
"""Rounding noise of an end's speed, over the sum of the sizes of its two parts [1]."""
NEGLIGIBLE_LIFT: Final = 1e-7
"""Speed at which a hold lifts an end, over that of the slip, that is negligible [1]."""
LIFT_OFF_NOISE: Final = 1e3
"""Excess speed of a sliding end over its rounding noise above which it lifts off [1]."""


class Mode(NamedTuple):
    """Mode of a body on its base."""

    contact: int  # number of the base's contact state
    pivot: int  # the held point, or the one that would be held without sliding or flight
    slides: bool  # whether the end in contact slides


class Rates(NamedTuple):
    """Accelerations of a body, rates of its base's own variables, and powers."""

    rotation: float
    vertical: float
    horizontal: float
    own_rates: tuple[float, ...]
    dissipated: float
    supplied: float  # by the ground


class VelocityChange(NamedTuple):
    """Changes of a body's velocities by impulses, and the horizontal impulse of its restraint."""

    rotation: float
    vertical: float
    restraint: float
    others: tuple[float, ...]  # changes of all velocities, where other bodies respond, too


class SlidingGuards(NamedTuple):
    """Guards of a sliding end: of its hold and of its slip, and the rate of the slip's guard."""

    hold: float
    slip: float
    slip_rate: float


IDLE_GUARDS: Final = SlidingGuards(1.0, 1.0, 0.0)
"""The guards where no end slides."""


class BodyOnBase(NamedTuple):
    """A body and the base that it stands on."""

    body: Body
    base: Any  # a rockframe.dynamics.base.Base

    @kernel
    def modes(self) -> int:
        """Return the number of modes; some of these numbers do not occur."""
        return MODES_PER_CONTACT * self.base.contacts()

    @kernel
    def guards(self) -> int:
        """Return the number of guards."""
        return 2 * self.base.end_guards() + BODY_GUARDS

    @inlined
    def mode_of(self, mode: int) -> Mode:
        """Read a mode from its number."""
        return Mode(mode >> CONTACT_SHIFT, mode & PIVOT_MASK, (mode & SLIDING_BIT) != 0)

    @kernel
    def number_of(self, mode: Mode) -> int:
        """Return the number of a mode."""
        return mode.pivot + (SLIDING_BIT if mode.slides else 0) + (mode.contact << CONTACT_SHIFT)

    @inlined
    def flies(self, contact: int) -> bool:
        """Whether no end is held."""
        return not (self.base.is_held(contact, True) or self.base.is_held(contact, False))

    @inlined
    def is_free(self, mode: Mode) -> bool:
        """Whether no point of the base is held horizontally."""
        return mode.slides or self.flies(mode.contact)

    @inlined
    def contact_state(self, mode: Mode) -> int:
        """Return the contact state that users see."""
        left, right = self.base.is_held(mode.contact, True), self.base.is_held(mode.contact, False)
        if left and right:
            return FULL
        if left:
            return LEFT
        return RIGHT if right else FLIGHT

    @inlined
    def relaxation_in(self, mode: Mode) -> float:
        """Return the rate at which a sliding end follows the base, 0 where none slides [s^-1]."""
        return self.base.following_rate() if mode.slides else 0.0

    @kernel
    def mode_for_contact(self, contact: int, state: BodyState) -> Mode:
        """Return the mode of a contact, with the pivot of the restraint rule."""
        if self.flies(contact):
            return Mode(contact, 0, False)
        pivot = pivot_of(
            self.body.restraint,
            self.base.is_held(contact, True),
            self.base.is_held(contact, False),
            state.rotation,
            state.angular_velocity,
        )
        return Mode(contact, pivot, False)

    def initial_pin(self, mode: Mode, state: BodyState) -> float:
        """Return the point of the base that starts at its position at rest, as `Body.pin` [m].

        It is the held point, or in flight the one that would be held with both ends in contact.
        """
        pivot = mode.pivot
        if self.flies(mode.contact):
            rule, rate = self.body.restraint, state.angular_velocity
            pivot = pivot_of(rule, True, True, state.rotation, rate)
        return self.body.pin(pivot)

    @inlined
    def contact_with_force(self, mode: Mode) -> int:
        """Return the contact by which the base's force is computed: none acts on a sliding end."""
        if mode.slides:
            return self.base.follows(mode.contact, self.base.is_held(mode.contact, True))
        return mode.contact

    @inlined
    def horizontal_velocity(self, mode: Mode, state: BodyState, attitude: Attitude) -> float:
        """Return the horizontal velocity of the centre of mass: about the held point, or free."""
        if self.is_free(mode):
            return state.horizontal_velocity
        reach = self.body.reach(self.body.pin(mode.pivot), attitude)
        return reach.derivative * state.angular_velocity

    @inlined
    def rates_in(self, mode: Mode, state: BodyState, own: Any, ground: Ground) -> Rates:
        """Return the accelerations of :eq:`eq-two-spring`, with the powers."""
        body, attitude = self.body, self.body.attitude(state.rotation)
        line = body.base_line(state, attitude)
        rate, speed = state.angular_velocity, state.vertical_velocity
        contact = self.contact_with_force(mode)
        base = self.base.force(contact, line, own)
        own_rates = self.base.flow(contact, line, own)
        vertical = base.upward - body.gravity - ground.y
        reach = body.reach(body.pin(mode.pivot), attitude)
        supplied = -ground.y * speed
        if not self.is_free(mode):
            push = reach.derivative * (ground.x + reach.second_derivative * rate * rate)
            angular = (base.moment - push) / (body.inertia + reach.derivative * reach.derivative)
            horizontal = reach.derivative * angular + reach.second_derivative * rate * rate
            supplied -= ground.x * reach.derivative * rate
            return Rates(angular, vertical, horizontal, own_rates, base.dissipated, supplied)
        supplied -= ground.x * state.horizontal_velocity
        if not mode.slides:
            return Rates(0.0, vertical, -ground.x, own_rates, base.dissipated, supplied)
        # the end follows the base, which moves without a force, eq-sliding-contact
        left = self.base.is_held(mode.contact, True)
        on_left, on_right = body.end_accelerations(attitude, rate, vertical, 0.0)
        lever = line.left_lever if left else line.right_lever
        end_speed = line.left_speed if left else line.right_speed
        free = (on_left if left else on_right) + self.base.following_rate() * end_speed
        angular = -free / lever
        hold = -body.inertia * angular / reach.derivative
        hold_power = hold * (state.horizontal_velocity - reach.derivative * rate)
        dissipated = base.dissipated - hold_power
        return Rates(angular, vertical, hold - ground.x, own_rates, dissipated, supplied)

    @inlined
    def end_guards_in(self, mode: Mode, left: bool, line: BaseLine, own: Any) -> Guards:
        """Return the guards of an end of the base; those of an end that slides are idle."""
        guards = self.base.guards_of(mode.contact, left, line, own)
        if mode.slides and self.base.is_held(mode.contact, left):
            return Guards(constant(1.0, guards.values), constant(0.0, guards.values))
        return guards

    @inlined
    def pivot_guard(self, mode: Mode, state: BodyState, angular: float) -> tuple[float, float]:
        """Return the guard of the rule that the leading corner is held, and its rate."""
        body, rate = self.body, state.angular_velocity
        if self.flies(mode.contact) or body.restraint != LEADING_CORNER:
            return 1.0, 0.0
        if mode.pivot == PIVOT_CENTRE:  # upright and at rest: any lean ends this mode
            departure = rate if rate != 0.0 else angular
            return -abs(state.rotation) / body.angle, -abs(departure) / body.angle
        side = (1.0 if mode.pivot == PIVOT_RIGHT else -1.0) / body.angle
        return side * state.rotation, side * rate

    @inlined
    def guards_with(
        self, mode: Mode, state: BodyState, own: Any, vertical: float, angular: float,
        sliding: SlidingGuards,
    ) -> Guards:  # fmt: skip
        """Return all guards of the body, :eq:`eq-guards`: of both ends, and its own.

        `vertical` and `angular` are the accelerations of vertical coordinate and rotation.
        """
        attitude = self.body.attitude(state.rotation)
        rises = self.body.end_accelerations(attitude, state.angular_velocity, vertical, angular)
        line = with_accelerations(self.body.base_line(state, attitude), rises[0], rises[1])
        left = self.end_guards_in(mode, True, line, own)
        right = self.end_guards_in(mode, False, line, own)
        pivot, pivot_rate = self.pivot_guard(mode, state, angular)
        return Guards(
            left.values + right.values + (sliding.hold, sliding.slip, pivot),
            left.changes + right.changes + (0.0, sliding.slip_rate, pivot_rate),
        )

    @kernel
    def sliding_guards(
        self, mode: Mode, state: BodyState, angular: float, horizontal: float, push: float,
        rise: float,
    ) -> SlidingGuards:  # fmt: skip
        """Return the guards of a sliding end: of the hold, which lifts it, and of the slip.

        `angular` and `horizontal` are the accelerations of rotation and horizontal coordinate,
        `push` is the force of the hold, `rise` the speed at which the end rises per unit of slip.
        """
        body, rate = self.body, state.angular_velocity
        reach = body.reach_about(mode.pivot, state.rotation)
        upwards = 1.0 if rise < 0.0 else -1.0
        hold = -upwards * push / body.gravity
        if abs(rise) < NEGLIGIBLE_LIFT:
            # held beneath the centre of mass the body is not lifted by the hold
            return SlidingGuards(hold, -1.0, 0.0)
        slip = state.horizontal_velocity - reach.derivative * rate
        change = horizontal - reach.derivative * angular - reach.second_derivative * rate * rate
        scale = upwards / math.sqrt(body.gravity * body.size())
        return SlidingGuards(hold, scale * slip, scale * change)

    @kernel
    def kinetic_energy(self, mode: Mode, state: BodyState) -> float:
        """Return the kinetic energy relative to the ground, :eq:`eq-energy`."""
        across = self.horizontal_velocity(mode, state, self.body.attitude(state.rotation))
        rate, speed = state.angular_velocity, state.vertical_velocity
        return 0.5 * (self.body.inertia * rate * rate + speed * speed + across * across)

    @kernel
    def horizontal_position(self, mode: Mode, state: BodyState, held_at: float) -> float:
        """Return x of the centre of mass: about the held point, or free [m]."""
        if self.is_free(mode):
            return state.horizontal
        return held_at + self.body.from_pivot(mode.pivot, state.rotation)

    @kernel
    def end_accelerations_at(
        self, state: BodyState, vertical: float, angular: float
    ) -> tuple[float, float]:
        """Return the upward accelerations of the base's ends, from those of the body."""
        attitude = self.body.attitude(state.rotation)
        return self.body.end_accelerations(attitude, state.angular_velocity, vertical, angular)

    @kernel
    def elastic_energy(self, state: BodyState, own: Any) -> tuple[float, float]:
        """Return the energy that the base stores, and the energy less that at rest."""
        return self.base.energy(self.body.base_line_at(state), own)

    @kernel
    def base_columns(self, mode: Mode, state: BodyState, own: Any) -> tuple[float, ...]:
        """Return the base's columns in the results."""
        return self.base.observed(self.contact_with_force(mode), self.body.base_line_at(state), own)

    @inlined
    def response_in(
        self, mode: Mode, attitude: Attitude, impulse: float, moment: float, slip: float
    ) -> VelocityChange:
        """Return velocity changes by an impulse of the base, or by a hold that stops a slip."""
        if self.is_free(mode):
            return VelocityChange(moment / self.body.inertia, impulse, 0.0, ())
        reach = self.body.reach(self.body.pin(mode.pivot), attitude).derivative
        angular = (moment + reach * slip) / (self.body.inertia + reach * reach)
        return VelocityChange(angular, impulse, reach * angular - slip, ())


@inlined
def speed_noise(speed: float, lever: float, angular_velocity: float) -> float:
    """Return the rounding noise of an end's speed, the sum of two velocities."""
    return SPEED_ROUNDING * (abs(speed) + abs(lever * angular_velocity))


@inlined
def is_lifted(before: float, after: float, noise: float) -> bool:
    """Whether a hold would stop or lift an end that comes down, by its speeds before and after.

    An end that rises, though by rounding below its level, is about to lift off anyway.
    """
    return before <= noise and after >= -noise


@inlined
def share_at_lift_off(before: float, after: float) -> float:
    """Return the share of the hold's impulse that stops a landing end, :eq:`eq-partial-hold`.

    `before` and `after` are the end's speeds without the impulse and with all of it.
    """
    if before >= 0.0:
        return 0.0
    return min(before / (before - after), 1.0) if before < after else 1.0


@inlined
def blend(before: float, after: float, share: float) -> float:
    """Return a rate after a share of an impulse, from the rates without and with all of it."""
    return before + share * (after - before)
