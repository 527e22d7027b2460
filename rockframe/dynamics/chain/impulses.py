"""Impulses in an event: of rigid bases, and of a deformable base on which an end lands (its blow).

First the corners that bear on rigid bases react to the impulse of the landing as constraints. If
this takes tension or more than friction, all impulses of the event are undone and found again, the
rigid bases in compression only, the impulse of the landing scaled so that its end gets the speed
that restitution leaves it.
"""

import math
from typing import Final, NamedTuple

from rockframe.compiled import Vector, inlined, kernel
from rockframe.dynamics.chain import rows as at
from rockframe.dynamics.chain.corner_guards import CornerGuards
from rockframe.dynamics.chain.impact import (
    BOTH,
    LEFT_ONLY,
    NOISE,
    RIGHT_ONLY,
    attempt,
    bearing_corners,
)
from rockframe.dynamics.chain.motion import (
    load_along,
    load_bodies,
    place_bodies,
    press_at,
    write_relative,
)
from rockframe.dynamics.chain.rows import CONSTRAINT, PLACES
from rockframe.dynamics.switching import end_speed

MOST_SHARES: Final = 60
"""Most steps of a bisection for the share of a blow: the bits of a float, and some."""
MOST_BLOWS: Final = 1e3
"""Largest share of a blow; if more is needed the blow stays as it was found first."""


SLIGHT: Final = 1e-9
"""Velocity of slip, over the velocities along the base, that counts as none [1]."""


class Shares(NamedTuple):
    """Factors of a blow: `press` of the whole impulse, `along` of its friction beside that [1]."""

    press: float
    along: float


class Met(NamedTuple):
    """Velocities as impulses are found again: rise of an end beyond the old one, and slip."""

    rises: float
    driven: float  # velocity of slip, positive in the sense of the friction


class RigidImpulses(CornerGuards):
    """Stacked bodies that get impulses from rigid bases in an event. A mixin of systems."""

    __slots__ = ()

    @kernel
    def take_answer(self, state: Vector) -> None:
        """Change the velocities by the last response, and add up the impulses of rigid bases."""
        self.add_slopes(state)
        room, rows = self.places(), self.constraints()
        for j in range(self.body_count):
            i, last = j * PLACES, -1
            for side in range(2):
                which = int(room[i + at.LEFT_CORNER + side])
                if which >= 0:
                    room[i + at.LEFT_IMPULSE + side] += rows[which * CONSTRAINT + at.FORCE]
                    self.keep_impulse(j, which, room, rows)
                    last = which
            # the constraint along the base comes behind those of the corners
            if last >= 0 and self.slip_sense(j) == 0.0:
                self.keep_impulse(j, last + 1, room, rows)

    @kernel
    def keep_impulse(self, k: int, which: int, room: Vector, rows: Vector) -> None:
        """Add the impulse of a rigid base's constraint to the sums of the bodies it acts on."""
        first = which * CONSTRAINT
        force, holds = rows[first + at.FORCE], first + at.HOLDS
        for body in range(k, min(k + 2, self.body_count)):
            i = body * PLACES + at.IMPULSE_X
            for j in range(3):
                room[i + j] += force * rows[holds + j]
            holds += 3

    @kernel
    def scale_impulses(self, share: float) -> None:
        """Multiply the impulses of all bases in this event by a factor."""
        room = self.places()
        for k in range(self.body_count):
            for j in range(at.IMPULSES):
                room[k * PLACES + at.LEFT_IMPULSE + j] *= share

    @inlined
    def must_meet_anew(self, closed: int, mode: int) -> bool:
        """Whether impulses must be found again: a corner pulled, or a closed one did not act."""
        return self.some_pull() or closed != self.bearing(mode)

    @kernel
    def some_pull(self) -> bool:
        """Whether the impulse of a corner on a rigid base in this event is one of tension."""
        room, least, all_of_them = self.places(), 0.0, 0.0
        for k in range(self.body_count):
            for side in range(2):
                impulse = room[k * PLACES + at.LEFT_IMPULSE + side]
                least, all_of_them = min(least, impulse), all_of_them + abs(impulse)
        return least < -NOISE * all_of_them

    @kernel
    def change_velocities(self, state: Vector) -> None:
        """Change the velocities by the last solution for impulses, which is in the workspace."""
        room = self.places()
        for k in range(self.body_count):
            i = k * PLACES
            room[i + at.RISE] = room[i + at.SWAY] = room[i + at.FRAME_RATE] = 0.0
        write_relative(self, room, self.slopes())
        self.add_slopes(state)

    @inlined
    def record_impulse(self, k: int, normal: float, moment: float, along: float) -> None:
        """Add to the impulses of a deformable base on its body as an end lands."""
        room, i = self.places(), k * PLACES
        room[i + at.BLOW] += normal
        room[i + at.BLOW_MOMENT] += moment
        room[i + at.BLOW_ALONG] += along

    @inlined
    def landed(self, k: int, left: bool, mode: int, new: int) -> int:
        """Return the set of ends that have landed on a deformable base in an event.

        Both ends of a body that flew may have landed together.
        """
        part = self.on_base(k)
        both = part.flies(self.body_mode(mode, k).contact)
        both &= part.base.is_held(self.body_mode(new, k).contact, not left)
        return BOTH if both else LEFT_ONLY if left else RIGHT_ONLY

    @kernel
    def take_back(self, k: int, blow: Shares, mode: int, state: Vector) -> None:
        """Undo the impulses of rigid bases, and scale the blow on a body to its shares."""
        room = self.places()
        place_bodies(self, mode, state, room)
        for j in range(self.body_count):
            i = j * PLACES
            room[i + at.LOAD_X] = -room[i + at.IMPULSE_X]
            room[i + at.LOAD_Y] = -room[i + at.IMPULSE_Y]
            room[i + at.LOAD_MOMENT] = -room[i + at.IMPULSE_MOMENT]
        i, off = k * PLACES, blow.press - 1.0
        press_at(self, k, off * room[i + at.BLOW], off * room[i + at.BLOW_MOMENT], room)
        load_along(self, k, (blow.press * blow.along - 1.0) * room[i + at.BLOW_ALONG], room)
        attempt(self, mode, 0, 0, False, True, 0.0, state)
        self.change_velocities(state)

    @kernel
    def shares_of_blow(self, k: int, ends: int, mode: int, closed: int, state: Vector) -> Shares:
        """Return the shares of a blow, and of its friction, as the impulses are found again.

        The blow is such that one end has the speed that restitution leaves it, and none a higher
        one; its friction does not reverse the slip.
        """
        room, i = self.places(), k * PLACES
        if room[i + at.BLOW] <= 0.0 and room[i + at.BLOW_ALONG] == 0.0:
            return Shares(1.0, 1.0)
        rubs = self.driven_slip(k, mode, state) <= 0.0
        low, high, share = 0.0, math.inf, 1.0
        for _ in range(MOST_SHARES):
            blow = Shares(share, self.share_along(k, rubs, share, mode, closed, state))
            rises = self.try_blow(k, ends, blow, mode, closed, state).rises
            if rises > 0.0:
                high = share
            else:
                low = share
            if rises == 0.0:
                break
            share = 0.5 * (low + high) if high < math.inf else 2.0 * share
            if share > MOST_BLOWS:
                low = 1.0
                break
        return Shares(low, self.share_along(k, rubs, low, mode, closed, state))

    @kernel
    def share_along(
        self, k: int, rubs: bool, press: float, mode: int, closed: int, state: Vector
    ) -> float:
        """Return the share of friction beside a share `press` of the blow: it must oppose the slip.

        It is 1 if friction did not oppose the slip in the first solution (`rubs` is false). The
        slip is linear in the share as long as the same corners bear.
        """
        if not rubs or self.places()[k * PLACES + at.BLOW_ALONG] == 0.0:
            return 1.0
        low, high = 0.0, 1.0
        at_high = self.try_blow(k, 0, Shares(press, high), mode, closed, state).driven
        if at_high <= 0.0:
            return high
        at_low = self.try_blow(k, 0, Shares(press, low), mode, closed, state).driven
        for _ in range(MOST_SHARES):
            if at_low >= 0.0:
                break
            share = low - (high - low) * at_low / (at_high - at_low)
            found = self.try_blow(k, 0, Shares(press, share), mode, closed, state).driven
            if found > 0.0:
                high, at_high, at_low = share, found, 0.5 * at_low
            else:
                low, at_low, at_high = share, found, 0.5 * at_high
        return low

    @kernel
    def try_blow(
        self, k: int, ends: int, blow: Shares, mode: int, closed: int, state: Vector
    ) -> Met:
        """Return velocities, with impulses found again for shares of a blow; restores the state."""
        part, n, before = self.on_base(k), self.coordinates(), self.velocities(state)
        left, noise_left = end_speed(part, True, self.state_of(k, state))
        right, noise_right = end_speed(part, False, self.state_of(k, state))
        self.take_back(k, blow, mode, state)
        place_bodies(self, mode, state, self.places())
        load_bodies(self, 0.0, 0.0, self.places())
        bearing_corners(self, mode, closed, 0, closed, 0, state)
        self.change_velocities(state)
        left_after, more_left = end_speed(part, True, self.state_of(k, state))
        right_after, more_right = end_speed(part, False, self.state_of(k, state))
        rises, least = -math.inf, 0.0
        if ends & LEFT_ONLY != 0:
            rises, least = left_after - left, noise_left + more_left
        if ends & RIGHT_ONLY != 0 and right_after - right > rises:
            rises, least = right_after - right, noise_right + more_right
        if abs(rises) <= least:
            rises = 0.0
        found = Met(rises, self.driven_slip(k, mode, state))
        for i in range(n):
            state[n + i] = before[i]
        return found

    @kernel
    def driven_slip(self, k: int, mode: int, state: Vector) -> float:
        """Return the velocity of slip of a body, positive in the sense of its blow's friction."""
        part, body = self.on_base(k), self.state_of(k, state)
        pin = part.body.pin(self.body_mode(mode, k).pivot)
        reach = part.body.reach(pin, part.body.attitude(body.rotation))
        about, sway = reach.derivative * body.angular_velocity, body.horizontal_velocity
        slip, along = sway - about, self.places()[k * PLACES + at.BLOW_ALONG]
        if along == 0.0 or abs(slip) <= SLIGHT * (abs(sway) + abs(about)):
            return 0.0
        return math.copysign(slip, along * slip)
