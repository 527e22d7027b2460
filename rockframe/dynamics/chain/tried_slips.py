"""Which corners on rigid bases bear and which bodies slip, found together.

The row of a body says whether its base is rigid or deformable, and has friction. On a rigid base
friction holds the body up to its bound, :eq:`eq-stack-friction`; beyond, the force at each corner
that bears includes kinetic friction, :eq:`eq-stack-slip`. On a deformable base the normal force is
known, :eq:`eq-mixed-slips`. Conditions are :eq:`eq-mixed-conditions` under new forces,
:eq:`eq-stack-impact` after an impact.
"""

import math
from typing import Final

from rockframe.compiled import Vector, inlined, kernel
from rockframe.dynamics.bodies import BEFORE_HORIZONTAL, ROTATION, VERTICAL
from rockframe.dynamics.body import PIVOT_LEFT, PIVOT_RIGHT
from rockframe.dynamics.chain import rows as at
from rockframe.dynamics.chain.corners import NONE
from rockframe.dynamics.chain.impact import (
    BOTH,
    LEFT_ONLY,
    NOISE,
    Attempt,
    attempt,
    size_of,
)
from rockframe.dynamics.chain.motion import (
    FREE,
    add_constraint,
    coriolis_along,
    of_both,
    write_direction,
)
from rockframe.dynamics.chain.rigid import RigidChain
from rockframe.dynamics.chain.rows import CONSTRAINT, MOST_CONSTRAINTS, PLACES
from rockframe.dynamics.chain.slippery import SlipperyBases
from rockframe.dynamics.chain.slips import IMPULSIVE, KINETIC, ROUNDING, STATIC, TRIES
from rockframe.dynamics.on_base import Mode
from rockframe.dynamics.sliding import SPEED_ROUNDING

NOWHERE: Final = -1
"""In place of a pivot, where a body neither slips nor is held by friction."""
SLICK: Final = 0.5
"""In place of a sense of 1, of a slip on which friction does not act."""
MOST_WAYS: Final = 81
"""Most combinations of slips tried for a set of corners; each base is held or slips to a side."""


class TriedSlips(SlipperyBases, RigidChain):
    """Trials of corners on rigid bases with bodies that may slip. A mixin of systems."""

    __slots__ = ()

    @inlined
    def slip_sense(self, k: int) -> float:
        """Return the sense of slip of a body on its base in the present trial: 0, held."""
        return float(self.places()[k * PLACES + at.SLIPS])

    @inlined
    def sense_in(self, mode: int, k: int) -> float:
        """Return the sense of slip of a body on its base in a mode; 0 if it does not slip."""
        if (self.is_rigid(k) or self.is_slippery(k)) and self.body_mode(mode, k).slides:
            return self.sense(mode, k)
        return 0.0

    @kernel
    def note_slips(self, mode: int) -> None:
        """Write the senses of slips of a mode as those of the present trial."""
        room = self.places()
        for k in range(self.body_count):
            room[k * PLACES + at.SLIPS] = self.sense_in(mode, k)

    @inlined
    def forget_slips(self, mode: int, impulsive: bool) -> None:
        """Restore the slips of a mode for the next trial; none in an impact, where all are held."""
        self.note_slips(mode)
        if impulsive:
            for k in range(self.body_count):
                self.places()[k * PLACES + at.SLIPS] = 0.0

    @kernel
    def standing_on(self, k: int, bears: int, mode: int) -> int:
        """Return the mode with the slip, on a rigid base, that the last trial gave a body."""
        sense = self.slip_sense(k)
        if bears != 0 and sense != 0.0:
            return self.slipping(mode, k, sense)
        value = self.modes_of_bodies() * 2**k
        return mode - mode // value % 2 * value

    @kernel
    def as_tried(self, mode: int, state: Vector, memory: Vector) -> int:
        """Return the mode with the slips on deformable bases of the last trial."""
        for k in range(self.body_count):
            if self.is_slippery(k) and not self.on_base(k).flies(self.body_mode(mode, k).contact):
                mode = self.with_slip(k, self.slip_sense(k), mode, state, memory)
        return mode

    @kernel
    def hold_as_tried(
        self, k: int, count: int, standing: Mode, state: Vector, room: Vector, rows: Vector
    ) -> int:
        """Hold a body on a deformable base, or load it by friction, in the present trial."""
        if not self.is_slippery(k) or self.on_base(k).flies(standing.contact):
            return self.hold_or_slide(k, count, standing, state, room, rows)
        i, sense = k * PLACES, self.slip_sense(k)
        self.drag(k, sense, room)
        if sense == 0.0:
            wanted = coriolis_along(i, room) + room[i + at.DRIFT]
            add_constraint(self, count, k, 1.0, 0.0, -room[i + at.REACH], wanted, room, rows)
            room[i + at.HOLDS_ALONG] = count
            count += 1
        return count

    @inlined
    def pin_on(self, bears: int) -> int:
        """Return the pivot at corners that bear; where both do they have one velocity."""
        return PIVOT_LEFT if bears == LEFT_ONLY else PIVOT_RIGHT

    @inlined
    def pressed(self, k: int) -> float:
        """Return the normal force of a body's base on it, or its impulse."""
        if self.is_rigid(k):
            return self.corner_force(k, True) + self.corner_force(k, False)
        return float(self.places()[k * PLACES + at.PRESS])

    @kernel
    def note_free_slips(self, mode: int, state: Vector) -> None:
        """Write the senses in which bodies in flight over rigid bases would slip on landing."""
        bearing, room = self.bearing(mode), self.places()
        for k in range(self.body_count):
            if self.is_rigid(k) and bearing >> 2 * k & BOTH == 0:
                rate, noise = self.slip_on(k, self.pin_on(BOTH), state)
                slips = abs(rate) > noise and self.friction_of(k, IMPULSIVE) < math.inf
                room[k * PLACES + at.SLIPS] = math.copysign(1.0, rate) if slips else 0.0

    @kernel
    def rub(
        self, k: int, which: int, sense: float, reach: float, impulsive: bool, room: Vector,
        rows: Vector,
    ) -> None:  # fmt: skip
        """Add friction to the force of a corner that slips, :eq:`eq-stack-slip`."""
        holds, i, ratio = which * CONSTRAINT + at.HOLDS, k * PLACES, 0.0
        if abs(sense) == 1.0:
            ratio = -sense * self.friction_of(k, IMPULSIVE if impulsive else KINETIC)
            x, y = ratio * room[i + at.COSINE], -ratio * room[i + at.SINE]
            rows[holds] += x
            rows[holds + 1] += y
            rows[holds + 2] -= ratio * reach
            rows[which * CONSTRAINT + at.UNSYMMETRIC] = 1.0
            if k + 1 < self.body_count:
                rows[holds + 3] -= x
                rows[holds + 4] -= y
                rows[holds + 5] += ratio * (reach - room[i + at.ARM])
        room[i + at.RUBS] = ratio

    @kernel
    def stand_still(self, room: Vector, out: Vector) -> None:
        """Write the friction of slipping bodies; set accelerations to zero in full contact."""
        for k in range(self.body_count):
            i = k * PLACES
            left, right = room[i + at.LEFT_CORNER], room[i + at.RIGHT_CORNER]
            if not self.is_rigid(k) or (left == NONE and right == NONE):
                continue
            if room[i + at.HELD] == FREE:
                press = self.corner_force(k, True) + self.corner_force(k, False)
                room[i + at.THRUST] = room[i + at.RUBS] * press
            if left != NONE and right != NONE:
                first = BEFORE_HORIZONTAL * k
                out[first + ROTATION] = out[first + VERTICAL] = 0.0
                if room[i + at.HELD] != FREE:
                    out[self.horizontal_of(k)] = 0.0

    @kernel
    def lost_by_friction(
        self, k: int, which: int, state: Vector, room: Vector, rows: Vector
    ) -> float:
        """Return the energy that friction takes in an impact at a corner that slips."""
        first, ratio = which * CONSTRAINT, room[k * PLACES + at.RUBS]
        if ratio == 0.0:
            return 0.0
        # both corners have the same slip where both bear
        left = room[k * PLACES + at.LEFT_CORNER] != NONE
        slip, _ = self.slip_on(k, PIVOT_LEFT if left else PIVOT_RIGHT, state)
        leaned = of_both(self.body_count, k, first + at.HOLDS, room, rows) - rows[first + at.VALUE]
        return float(-rows[first + at.FORCE] * (ratio * slip + 0.5 * leaned))

    @kernel
    def must_meet_anew(self, closed: int, mode: int) -> bool:
        """Whether impulses must be found again: a base with friction acted, or a corner pulled.

        Or a closed corner did not act, as it did not bear before.
        """
        room = self.places()
        for k in range(self.body_count):
            i = k * PLACES
            acts = room[i + at.LEFT_IMPULSE] != 0.0 or room[i + at.RIGHT_IMPULSE] != 0.0
            if acts and self.friction_of(k, IMPULSIVE) < math.inf:
                return True
        return self.some_pull() or closed != self.bearing(mode)

    @kernel
    def try_corners(
        self, mode: int, some: int, closed: int, impulsive: bool, noise: float, state: Vector
    ) -> Attempt:
        """Let a set of the closed corners bear, and find which of their bodies slip, base by base.

        In an impact the velocities after it decide. Under new forces, slipping bodies continue to
        slip, and held ones start to slip if friction cannot hold them.
        """
        self.note_first_slips(mode, some, impulsive, state)
        found = Attempt(0, math.inf)
        most = TRIES * self.body_count
        # where static friction leads to no solution, kinetic friction decides what is held
        for tries in range(2 * most):
            holding = IMPULSIVE if impulsive else STATIC if tries < most else KINETIC
            found = attempt(self, mode, some, closed, False, impulsive, noise, state)
            k = self.otherwise(mode, some, closed, impulsive, holding, noise, state)
            if k < 0:
                return found
        return Attempt(max(found.fault, 0), math.inf)

    @kernel
    def note_first_slips(self, mode: int, some: int, impulsive: bool, state: Vector) -> int:
        """Write the first slips of a trial; return the set of bodies whose slip is open."""
        room, loose = self.places(), 0
        for k in range(self.body_count):
            i, pivot = k * PLACES, self.tried_at(k, mode, some, impulsive)
            room[i + at.SLIPS] = 0.0
            slips = pivot != NOWHERE and self.friction_of(k, STATIC) < math.inf
            if slips and not impulsive:
                room[i + at.SLIPS] = room[i + at.STARTS]
                rate, least = self.slip_before(k, pivot, mode, state)
                if abs(rate) > least:
                    room[i + at.SLIPS] = math.copysign(1.0, rate)
                else:
                    loose |= 1 << k
        return loose

    @kernel
    def try_all_slips(
        self, mode: int, some: int, closed: int, noise: float, state: Vector
    ) -> Attempt:
        """Let a set of the closed corners bear with the first consistent combination of slips.

        The search base by base may fail where the slip of one body, say of an end on pads, makes
        another base push harder the more it is held back.
        """
        loose = self.note_first_slips(mode, some, False, state)
        for way in range(min(3 ** size_of(loose), MOST_WAYS)):
            self.note_way(way, loose)
            found = attempt(self, mode, some, closed, False, False, noise, state)
            k = self.otherwise(mode, some, closed, False, STATIC, noise, state)
            if found.fault < 0 and k < 0:
                return found
        return Attempt(0, math.inf)

    @inlined
    def note_way(self, way: int, bodies: int) -> None:
        """Write the slips of a set of bodies: digits, in base 3, of the number `way`."""
        for k in range(self.body_count):
            if bodies >> k & 1 != 0:
                self.places()[k * PLACES + at.SLIPS] = float((way + 1) % 3 - 1)
                way //= 3

    @kernel
    def noted_way(self) -> int:
        """Return the number, in base 3, of the slips of all bodies in the present trial."""
        way = 0
        for k in range(self.body_count - 1, -1, -1):
            way = 3 * way + int(self.places()[k * PLACES + at.SLIPS]) % 3
        return way

    @kernel
    def other_ways(self, mode: int, some: int, closed: int, noise: float, state: Vector) -> int:
        """Count the consistent combinations of slips on a set of corners other than the last one.

        A body that friction can hold, with the slips of the others unchanged, does not count as
        slipping: where only one body may slip there is one combination.
        """
        room, found, taken = self.places(), 0, self.noted_way()
        loose = self.note_first_slips(mode, some, False, state)
        for way in range(min(3 ** size_of(loose), MOST_WAYS) if size_of(loose) > 1 else 0):
            self.note_way(way, loose)
            counts = self.noted_way() != taken and self.is_motion(mode, some, closed, noise, state)
            for k in range(self.body_count):
                slips = room[k * PLACES + at.SLIPS]
                if counts and loose >> k & 1 != 0 and slips != 0.0:
                    room[k * PLACES + at.SLIPS] = 0.0
                    held = attempt(self, mode, some, closed, False, False, noise, state)
                    friction = self.friction_of(k, STATIC)
                    counts = held.fault >= 0 or self.cannot_hold(k, friction, False)
                    room[k * PLACES + at.SLIPS] = slips
            found += 1 if counts else 0
        self.note_way(taken, 2**self.body_count - 1)
        attempt(self, mode, some, closed, False, False, noise, state)
        return found

    @kernel
    def is_motion(self, mode: int, some: int, closed: int, noise: float, state: Vector) -> bool:
        """Whether a set of corners that bear, with the slips as written, is admissible."""
        way = self.noted_way()
        found = attempt(self, mode, some, closed, False, False, noise, state)
        k = self.otherwise(mode, some, closed, False, STATIC, noise, state)
        self.note_way(way, 2**self.body_count - 1)
        return found.fault < 0 and k < 0

    @kernel
    def try_standing(self, mode: int, corners: int, state: Vector) -> None:
        """Find the impulses by which bodies stand on corners: slipping ones slip, others are held.

        A body whose slip would be reversed, as no friction can do, is held, too. Friction does not
        act at a base in tension, where it would drive the slip.
        """
        room, turned = self.places(), True
        self.note_slips_before(mode, corners, state)
        while turned:
            turned = False
            attempt(self, mode, corners, corners, False, True, 0.0, state)
            for k in range(self.body_count):
                sense = room[k * PLACES + at.SLIPS]
                if sense != 0.0:
                    pivot = self.tried_at(k, mode, corners, True)
                    rate, least = self.slip_on(k, pivot, state)
                    after = self.slips_on(k, pivot, True, state) + rate
                    if sense * after < -abs(sense) * (least + SPEED_ROUNDING * abs(after)):
                        room[k * PLACES + at.SLIPS] = 0.0
                        turned = True
                    elif abs(sense) == 1.0 and self.pressed(k) < 0.0:
                        room[k * PLACES + at.SLIPS] = SLICK * sense
                        turned = True

    @kernel
    def try_stops(self, mode: int, some: int, closed: int, noise: float, state: Vector) -> Attempt:
        """Let a set of closed corners bear by impulses that stop a slip, each slip in turn."""
        room = self.places()
        for stopped in range(self.body_count):
            self.note_slips_before(mode, some, state)
            if room[stopped * PLACES + at.SLIPS] == 0.0:
                continue
            room[stopped * PLACES + at.SLIPS] = 0.0
            for _ in range(TRIES * self.body_count):
                found = attempt(self, mode, some, closed, False, True, noise, state)
                k = self.otherwise(mode, some, closed, True, IMPULSIVE, noise, state)
                if k < 0:
                    if found.fault < 0 and room[stopped * PLACES + at.SLIPS] == 0.0:
                        return found
                    break
        return Attempt(0, math.inf)

    @kernel
    def note_slips_before(self, mode: int, some: int, state: Vector) -> None:
        """Write the senses of the slips before an impact, of bodies that may slip in it."""
        for k in range(self.body_count):
            pivot, i = self.tried_at(k, mode, some, True), k * PLACES
            self.places()[i + at.SLIPS] = 0.0
            if pivot != NOWHERE and self.friction_of(k, IMPULSIVE) < math.inf:
                rate, least = self.slip_on(k, pivot, state)
                if abs(rate) > least:
                    self.places()[i + at.SLIPS] = math.copysign(1.0, rate)

    @inlined
    def tried_at(self, k: int, mode: int, some: int, impulsive: bool) -> int:
        """Return the pivot at which a body is held or slips in a trial of corners, or `NOWHERE`.

        On a deformable base friction has no part in impacts.
        """
        bears, standing = some >> 2 * k & BOTH, self.body_mode(mode, k)
        if self.is_rigid(k):
            return NOWHERE if bears == 0 else self.pin_on(bears)
        idle = impulsive or self.on_base(k).flies(standing.contact)
        return NOWHERE if idle or not self.is_slippery(k) else standing.pivot

    @inlined
    def slip_before(self, k: int, pivot: int, mode: int, state: Vector) -> tuple[float, float]:
        """Return the velocity of slip before a trial of corners, and its rounding noise."""
        if not self.is_rigid(k) and not self.body_mode(mode, k).slides:
            return 0.0, 0.0  # held: the state need not have its velocity
        return self.slip_on(k, pivot, state)

    @kernel
    def otherwise(
        self, mode: int, some: int, closed: int, impulsive: bool, holding: int, noise: float,
        state: Vector,
    ) -> int:  # fmt: skip
        """Correct the slip of one body in the present trial, and give its number; else -1.

        A held body slips if friction, of the coefficient `holding`, cannot hold it; a slipping one
        is held if it does not slip. Accelerations up to `noise` count as zero.
        """
        room = self.places()
        for k in range(self.body_count):
            i, pivot = k * PLACES, self.tried_at(k, mode, some, impulsive)
            friction = self.friction_of(k, holding)
            pulled = self.is_rigid(k) and some & closed & BOTH << 2 * k == 0
            if pivot == NOWHERE or friction == math.inf or pulled:
                continue
            sense = room[i + at.SLIPS]
            if sense == 0.0:
                if self.cannot_hold(k, friction, impulsive):
                    room[i + at.SLIPS] = -math.copysign(1.0, self.thrust_of(k))
                    return k
            else:
                rate, least = self.slip_before(k, pivot, mode, state)
                if impulsive or abs(rate) <= least:
                    after = self.slips_on(k, pivot, impulsive, state)
                    if impulsive:
                        after, least = after + rate, least + SPEED_ROUNDING * abs(after)
                    else:  # as it starts to slip, friction is what holds it
                        least = noise
                    if sense * after < -least:
                        room[i + at.SLIPS] = 0.0
                        return k
        return -1

    @inlined
    def thrust_of(self, k: int) -> float:
        """Return the force along its base that holds a body in the present trial."""
        which = int(self.places()[k * PLACES + at.HOLDS_ALONG])
        return float(self.constraints()[which * CONSTRAINT + at.FORCE])

    @kernel
    def cannot_hold(self, k: int, friction: float, impulsive: bool) -> bool:
        """Whether the force that holds a body in the present trial exceeds its friction."""
        press = self.pressed(k)
        least = NOISE * abs(press)
        if not impulsive:  # a body that has just started to slip is not held at the bound
            least = ROUNDING * self.number(k, at.FORCE_SIZE)
            least = least if self.places()[k * PLACES + at.STARTS] == 0.0 else -least
        return abs(self.thrust_of(k)) > friction * max(press, 0.0) + least

    @kernel
    def slips_on(self, k: int, pivot: int, impulsive: bool, state: Vector) -> float:
        """Return the acceleration of the slip of a point, or its change in an impact."""
        i, part, body = k * PLACES, self.on_base(k), self.state_of(k, state)
        room, rows, rate = self.places(), self.constraints(), body.angular_velocity
        reach = part.body.reach(part.body.pin(pivot), part.body.attitude(body.rotation))
        spare = MOST_CONSTRAINTS * self.body_count - 1  # a slipping body has no hold: free
        keeps = spare * CONSTRAINT + at.KEEPS
        write_direction(self, k, 1.0, 0.0, -reach.derivative, keeps, room, rows)
        found = of_both(self.body_count, k, keeps, room, rows)
        if impulsive:
            return found
        return found - coriolis_along(i, room) - reach.second_derivative * rate * rate
