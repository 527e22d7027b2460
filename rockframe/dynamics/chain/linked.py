"""A chain of bodies of which points are linked: to one another, or to the ground.

Links load the bodies, :eq:`eq-link-loads`; all else is that of a chain. One machine code serves
all links of a law, whatever their number. A chain without links knows nothing of them.
"""

import math
from collections.abc import Sequence
from typing import Any, Final, NamedTuple

import numpy as np

from rockframe.compiled import Vector, inlined, kernel, numbers_in, part_of, stretch
from rockframe.dynamics.bodies import DEGREES
from rockframe.dynamics.body import BodyState
from rockframe.dynamics.chain import rows as at
from rockframe.dynamics.chain.motion import place_bodies
from rockframe.dynamics.chain.rigid import RigidChain
from rockframe.dynamics.chain.rows import COLUMNS, CONSTRAINT, MODES, MOST_CONSTRAINTS, PLACES, ROW
from rockframe.dynamics.chain.rows import GUARDS as BODY_GUARDS
from rockframe.dynamics.chain.system import Chain
from rockframe.dynamics.links import GUARDS, LinkNumbers, Stretch, one_of
from rockframe.dynamics.pads import ROUNDING
from rockframe.dynamics.protocol import (
    HELD_PLACE,
    LAST_EVENT,
    LINK_LOSS,
    MOST_MODES,
    POWERS,
    Energies,
    Ground,
    Guards,
    Slope,
)
from rockframe.dynamics.trigonometry import sine_cosine
from rockframe.errors import AssemblyError

GROUND: Final = -1
"""In place of a body."""

# a row: the points, from the centres of mass of their bodies to the right and up
ON: Final = 0
ON_X: Final = 1
ON_Y: Final = 2
TO: Final = 3
TO_X: Final = 4
TO_Y: Final = 5
# how far they are apart as the link is given, from the latter to the former
APART_X: Final = 6
APART_Y: Final = 7
GIVEN: Final = 8  # the same, along the link
NOISE: Final = 9
STORED: Final = 10  # energy at rest
PLACE_VALUE: Final = 11  # of its state in the mode of the system
STATES: Final = 12  # a power of two, so that place values are exact
# direction in which it pulls whichever way its points go; zero for one that pulls along them
ALONG_X: Final = 13
ALONG_Y: Final = 14
NUMBERS: Final = 15  # of its law, from here on

# room to work in: for each body how it has moved from where it is given, and what links load it by
MOVED_X: Final = 0
MOVED_Y: Final = 1
OWN_SINE: Final = 2  # of its rotation
OWN_VERSINE: Final = 3
OWN_RATE: Final = 4
PULLED_X: Final = 5
PULLED_Y: Final = 6
LIES: Final = 7

LINK_COLUMNS: Final = 3
"""What users see of each link: force, elongation and state."""
MEET: Final = 1e3
"""Roundings of the elongation within which points of a link meet."""
TINY: Final = 1e-280
"""Square of a speed that is none."""


class Moved(NamedTuple):
    """Where a point of a body has come to from where it was given, and how it moves."""

    x: float
    y: float
    arm_x: float  # from the centre of mass of its body
    arm_y: float
    speed_x: float
    speed_y: float


class StretchedLink(NamedTuple):
    """A link that is stretched: how, and the direction from its second point to its first."""

    stretch: Stretch
    x: float
    y: float


class LinkedLists(NamedTuple):
    """The numbers of a chain with links."""

    body_count: int
    link_count: int
    law: Any  # of the class of all links; its numbers are those of one of them
    rows: Vector  # those of a chain; then of the links, and room to work in


class Linked(Chain):
    """What bodies upon one another have of what links them. A mixin of systems.

    The horizontal coordinate of the lowest body moves wherever that is held, as those of all
    others do, for links ask where it is.
    """

    __slots__ = ()
    link_count: int
    law: Any

    @inlined
    def first_link(self) -> int:
        """Give the place of the rows of links, behind those of the chain and its room."""
        room = PLACES + MOST_CONSTRAINTS * CONSTRAINT + 2 * DEGREES + 2 * BODY_GUARDS + COLUMNS
        count = self.body_count
        return count * (ROW + room) + POWERS + (MOST_CONSTRAINTS * count) ** 2

    @inlined
    def link_width(self) -> int:
        """Give the length of the row of a link."""
        return NUMBERS + self.law.number_count()

    @inlined
    def behind_links(self) -> int:
        """Give the place behind the rows of links."""
        return self.first_link() + self.link_count * self.link_width()

    @inlined
    def row_of_link(self, i: int) -> Vector:
        """Give the row of a link."""
        return stretch(self.rows, self.first_link() + i * self.link_width(), self.link_width())

    @inlined
    def lies(self) -> Vector:
        """Give the room for how bodies lie, and what links load them by."""
        return stretch(self.rows, self.behind_links(), LIES * self.body_count)

    @inlined
    def slopes(self) -> Vector:
        """Give the room for accelerations, rates of the links' variables, and powers."""
        first = self.behind_links() + LIES * self.body_count
        return stretch(self.rows, first, DEGREES * self.body_count + self.variables() + POWERS)

    @inlined
    def behind_slopes(self) -> int:
        """Give the place behind them."""
        lies = (LIES + DEGREES) * self.body_count
        return self.behind_links() + lies + self.variables() + POWERS

    @inlined
    def guard_room(self, which: int) -> Vector:
        """Give the room for guards (0) or their rates (1)."""
        return stretch(self.rows, self.behind_slopes() + which * self.guards(), self.guards())

    @inlined
    def column_room(self) -> Vector:
        """Give the room for columns."""
        count = COLUMNS * self.body_count + LINK_COLUMNS * self.link_count
        return stretch(self.rows, self.behind_slopes() + 2 * self.guards(), count)

    @kernel
    def variables(self) -> int:
        """Give the number of variables of all links."""
        return self.link_count * self.law.variables()

    @kernel
    def guards(self) -> int:
        """Give the number of guards, of each body and then of each link in turn."""
        return BODY_GUARDS * self.body_count + GUARDS * self.link_count

    @kernel
    def modes(self) -> int:
        """Give the number of modes, of which some have no meaning."""
        last = self.row_of_link(self.link_count - 1)
        return int(last[PLACE_VALUE] * last[STATES])

    @kernel
    def moving_in(self, mode: int) -> int:
        """Give the number of coordinates that move: all."""
        return DEGREES * self.body_count

    @inlined
    def link_state(self, mode: int, row: Vector) -> int:
        """Give the state of a link, by its row."""
        return mode // int(row[PLACE_VALUE]) % int(row[STATES])

    @inlined
    def of_link(self, i: int, state: Vector) -> Vector:
        """Give the variables of a link."""
        each = self.law.variables()
        return stretch(state, 2 * DEGREES * self.body_count + i * each, each)

    @inlined
    def lowest_place(self, mode: int, body: BodyState, state: Vector) -> float:
        """Give the horizontal place of the lowest body."""
        return body.horizontal

    @kernel
    def lay(self, mode: int, state: Vector, room: Vector) -> None:
        """Write how all bodies lie, from where they are given, after they are placed."""
        lies, x, y, rate, angle = self.lies(), 0.0, 0.0, 0.0, 0.0
        for k in range(self.body_count - 1, -1, -1):
            i, j = k * PLACES, k * LIES
            body = self.standing_state(k, self.part_mode(mode, k), state)
            sine, cosine = room[i + at.SINE], room[i + at.COSINE]
            y = self.rise_of(k, y, body.vertical, room)
            if k + 1 < self.body_count:
                across = room[i + at.ACROSS]
                x += room[i + at.ARM] * sine + across - self.number(k, at.BESIDE)
                x -= across * versine(sine, cosine)
            else:
                x = self.lowest_place(mode, body, state)
            rate += body.angular_velocity
            angle += body.rotation
            if k > 0:  # what the next body stands on
                sine, cosine = room[i - PLACES + at.SINE], room[i - PLACES + at.COSINE]
            else:
                sine, cosine = sine_cosine(angle)
            lies[j + MOVED_X], lies[j + MOVED_Y], lies[j + OWN_RATE] = x, y, rate
            lies[j + OWN_SINE], lies[j + OWN_VERSINE] = sine, versine(sine, cosine)

    @inlined
    def moved(self, k: int, x: float, y: float, room: Vector) -> Moved:
        """Give where a point of a body, or of the ground, has come to."""
        if k == GROUND:
            return Moved(0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
        lies, i, j = self.lies(), k * PLACES, k * LIES
        sine, lacks, rate = lies[j + OWN_SINE], lies[j + OWN_VERSINE], lies[j + OWN_RATE]
        turned_x, turned_y = y * sine - x * lacks, -x * sine - y * lacks
        arm_x, arm_y = x + turned_x, y + turned_y
        return Moved(
            lies[j + MOVED_X] + turned_x, lies[j + MOVED_Y] + turned_y, arm_x, arm_y,
            room[i + at.SPEED_X] + rate * arm_y, room[i + at.SPEED_Y] - rate * arm_x,
        )  # fmt: skip

    @inlined
    def upward(self, k: int) -> tuple[float, float]:
        """Give the direction that points up on a body, or on the ground."""
        if k == GROUND:
            return 0.0, 1.0
        lies = self.lies()
        return lies[k * LIES + OWN_SINE], 1.0 - lies[k * LIES + OWN_VERSINE]

    @inlined
    def drawn(self, row: Vector, on: Moved, to: Moved) -> StretchedLink:
        """Give how a link is stretched, :eq:`eq-link`.

        Where its points meet it acts along the way that they go apart, or come together, upwards.
        """
        apart_x, apart_y, given = row[APART_X], row[APART_Y], row[GIVEN]
        moved_x, moved_y = on.x - to.x, on.y - to.y
        x, y = apart_x + moved_x, apart_y + moved_y
        speed_x, speed_y = on.speed_x - to.speed_x, on.speed_y - to.speed_y
        along_x, along_y = row[ALONG_X], row[ALONG_Y]
        if along_x != 0.0 or along_y != 0.0:
            elongation = along_x * moved_x + along_y * moved_y
            rate = along_x * speed_x + along_y * speed_y
            return StretchedLink(
                Stretch(elongation, rate, 0.0, given, row[NOISE]), along_x, along_y
            )
        square = x * x + y * y
        length, elongation = math.sqrt(square), 0.0
        if length + given > 0.0:
            elongation = (2.0 * apart_x * moved_x + moved_x * moved_x) / (length + given)
            elongation += (2.0 * apart_y * moved_y + moved_y * moved_y) / (length + given)
        if length <= MEET * row[NOISE]:
            up_x, up_y = self.upward(int(row[TO]))
            away = 1.0 if speed_x * up_x + speed_y * up_y >= 0.0 else -1.0
            x, y = away * speed_x, away * speed_y
            square = x * x + y * y
            length = math.sqrt(square)
            if square < TINY:
                still = Stretch(elongation, 0.0, 0.0, given, row[NOISE])
                return StretchedLink(still, up_x, up_y)
        x, y = x / length, y / length
        rate = x * speed_x + y * speed_y
        return StretchedLink(Stretch(elongation, rate, 0.0, given, row[NOISE]), x, y)

    @inlined
    def points_of(self, row: Vector, room: Vector) -> tuple[Moved, Moved]:
        """Give both points of a link."""
        on = self.moved(int(row[ON]), row[ON_X], row[ON_Y], room)
        return on, self.moved(int(row[TO]), row[TO_X], row[TO_Y], room)

    @kernel
    def pull(self, mode: int, state: Vector, room: Vector) -> float:
        """Load all bodies by their links, :eq:`eq-link-loads`; give what these dissipate."""
        lies, out, lost = self.lies(), self.slopes(), 0.0
        self.lay(mode, state, room)
        for k in range(self.body_count):
            lies[k * LIES + PULLED_X] = lies[k * LIES + PULLED_Y] = 0.0
        for i in range(self.link_count):
            row, own = self.row_of_link(i), self.of_link(i, state)
            law, standing = self.law.with_numbers(part_of(row, NUMBERS)), self.link_state(mode, row)
            on, to = self.points_of(row, room)
            link = self.drawn(row, on, to)
            force = law.force(standing, link.stretch, own)
            lost += law.power(standing, link.stretch, own)
            self.load_point(int(row[ON]), on, -force * link.x, -force * link.y, room, lies)
            self.load_point(int(row[TO]), to, force * link.x, force * link.y, room, lies)
            each = law.variables()
            law.rates(
                standing, link.stretch, own,
                stretch(out, DEGREES * self.body_count + i * each, each),
            )  # fmt: skip
        return lost

    @inlined
    def load_point(
        self, k: int, point: Moved, x: float, y: float, room: Vector, lies: Vector
    ) -> None:
        """Add a force on a point of a body, or of the ground."""
        if k != GROUND:
            i, j = k * PLACES, k * LIES
            room[i + at.LOAD_X] += x
            room[i + at.LOAD_Y] += y
            room[i + at.LOAD_MOMENT] += x * point.arm_y - y * point.arm_x
            lies[j + PULLED_X] += x
            lies[j + PULLED_Y] += y

    @inlined
    def pulled_x(self, k: int) -> float:
        """Give the last force of links on a body, to the right."""
        return float(self.lies()[k * LIES + PULLED_X])

    @inlined
    def pulled_y(self, k: int) -> float:
        """Give the same upwards."""
        return float(self.lies()[k * LIES + PULLED_Y])

    @inlined
    def accelerated_point(self, k: int, point: Moved, room: Vector) -> tuple[float, float]:
        """Give the acceleration of a point of a body, or of the ground."""
        if k == GROUND:
            return 0.0, 0.0
        i, rate = k * PLACES, self.lies()[k * LIES + OWN_RATE]
        turning, square = room[i + at.ROTATION], rate * rate
        return (
            room[i + at.X] + turning * point.arm_y - square * point.arm_x,
            room[i + at.Y] - turning * point.arm_x - square * point.arm_y,
        )

    @inlined
    def watched(self, row: Vector, room: Vector) -> Stretch:
        """Give how a link is stretched, with its acceleration, as forces are known."""
        on, to = self.points_of(row, room)
        found, x, y = self.drawn(row, on, to)
        on_x, on_y = self.accelerated_point(int(row[ON]), on, room)
        to_x, to_y = self.accelerated_point(int(row[TO]), to, room)
        speed_x, speed_y = on.speed_x - to.speed_x, on.speed_y - to.speed_y
        across = speed_x * y - speed_y * x
        length = found.given + found.elongation
        bend = across * across / length if length > 0.0 else 0.0
        acceleration = x * (on_x - to_x) + y * (on_y - to_y) + bend
        return Stretch(found.elongation, found.rate, acceleration, found.given, found.noise)

    @kernel
    def guards_in(self, mode: int, state: Vector, slope: Slope, ground: Ground) -> Guards:
        """Give the guards of each body in turn, then of each link, and their rates."""
        found = self.guards_of_bodies(mode, state, slope, ground)
        self.forces_from(mode, state, slope, ground)
        room, values, changes = self.places(), self.guard_room(0), self.guard_room(1)
        for i in range(self.link_count):
            row, own = self.row_of_link(i), self.of_link(i, state)
            law, standing = self.law.with_numbers(part_of(row, NUMBERS)), self.link_state(mode, row)
            link, first = self.watched(row, room), BODY_GUARDS * self.body_count + GUARDS * i
            for which in range(GUARDS):
                value, change = law.guard(which, standing, link, own)
                values[first + which], changes[first + which] = value, change
        return found

    @kernel
    def switch(self, mode: int, guard: int, state: Vector, ground: Ground, memory: Vector) -> int:
        """Carry out the switch that a guard calls for; give the new mode."""
        return self.switch_one(mode, guard, state, ground, memory)

    @kernel
    def switch_one(
        self, mode: int, guard: int, state: Vector, ground: Ground, memory: Vector
    ) -> int:
        """Carry out the switch of a body or of a link; give the new mode."""
        shown, place = HELD_PLACE + self.body_count, self.link_place()
        first = BODY_GUARDS * self.body_count
        if guard < first:
            memory[place] = 0.0
            return self.switch_body(mode, guard, state, ground, memory)
        self.begin_event(memory)
        i = (guard - first) // GUARDS
        row, own, room = self.row_of_link(i), self.of_link(i, state), self.places()
        place_bodies(self, mode, state, room)
        self.lay(mode, state, room)
        on, to = self.points_of(row, room)
        standing, value = self.link_state(mode, row), int(row[PLACE_VALUE])
        found = self.law.with_numbers(part_of(row, NUMBERS)).switch(
            guard - first - GUARDS * i, standing, self.drawn(row, on, to).stretch, own
        )
        memory[LAST_EVENT] = found.event
        memory[LINK_LOSS] += found.lost
        memory[shown], memory[place] = 0.0, i + 1.0
        return mode + value * (found.state - standing)

    @kernel
    def energies(self, mode: int, state: Vector) -> Energies:
        """Give the energies of all bodies, bases and links."""
        found, room = self.energies_of_bodies(mode, state), self.places()
        self.lay(mode, state, room)
        gravity, elastic, change = found.gravity, found.elastic, found.from_rest
        for i in range(self.link_count):
            row, own = self.row_of_link(i), self.of_link(i, state)
            on, to = self.points_of(row, room)
            stored = self.law.with_numbers(part_of(row, NUMBERS)).energy(
                self.link_state(mode, row), self.drawn(row, on, to).stretch, own
            )
            # of what acts along a direction a load has but one state, a wall two
            if (row[ALONG_X] != 0.0 or row[ALONG_Y] != 0.0) and row[STATES] <= 1.0:
                gravity += stored
            else:
                elastic += stored
                change += stored - row[STORED]
        return Energies(found.kinetic, gravity, elastic, change)

    @kernel
    def observe(
        self, mode: int, state: Vector, slope: Slope, ground: Ground, memory: Vector
    ) -> Vector:
        """Give motion and forces of each body and base, then force and elongation of each link."""
        out, room = self.observe_bodies(mode, state, slope, ground, memory), self.places()
        for i in range(self.link_count):
            row, own = self.row_of_link(i), self.of_link(i, state)
            law, standing = self.law.with_numbers(part_of(row, NUMBERS)), self.link_state(mode, row)
            on, to = self.points_of(row, room)
            link = self.drawn(row, on, to).stretch
            j = COLUMNS * self.body_count + LINK_COLUMNS * i
            out[j], out[j + 1] = law.force(standing, link, own), link.elongation
            out[j + 2] = law.shown(standing)
        return out

    def keep_energies(self, mode: int, state: Vector) -> None:
        """Keep what links store at rest, from which energies are told."""
        room = self.places()
        place_bodies(self, mode, state, room)
        self.lay(mode, state, room)
        for i in range(self.link_count):
            row, own = self.row_of_link(i), self.of_link(i, state)
            stretched = self.drawn(row, *self.points_of(row, room)).stretch
            law = self.law.with_numbers(part_of(row, NUMBERS))
            row[STORED] = law.energy(self.link_state(mode, row), stretched, own)

    @kernel
    def start_links(self, mode: int, state: Vector) -> int:
        """Give the mode with the states in which links start; sets their variables."""
        room = self.places()
        place_bodies(self, mode, state, room)
        self.lay(mode, state, room)
        for i in range(self.link_count):
            row, own = self.row_of_link(i), self.of_link(i, state)
            on, to = self.points_of(row, room)
            found = self.law.with_numbers(part_of(row, NUMBERS)).starting(
                self.drawn(row, on, to).stretch, own
            )
            mode += int(row[PLACE_VALUE]) * (found - self.link_state(mode, row))
        return mode


class LinkedChain(LinkedLists, Linked):  # pyright: ignore[reportGeneralTypeIssues]
    """Bodies upon one another, and what links them: a system."""

    __slots__ = ()


class LinkedRigidChain(LinkedLists, Linked, RigidChain):  # pyright: ignore[reportGeneralTypeIssues]
    """The same where some bodies stand on rigid bases.

    Forces of links are finite: impacts are those without them. While the lowest body is held on
    rigid ground, its horizontal coordinate is the place of what holds it, and does not move.
    """

    __slots__ = ()

    @inlined
    def rests_on_ground(self, mode: int) -> bool:
        """Whether rigid ground holds the lowest body."""
        k = self.body_count - 1
        return self.is_rigid(k) and not self.on_base(k).is_free(self.part_mode(mode, k))

    @kernel
    def moving_in(self, mode: int) -> int:
        """Give the number of coordinates that move."""
        return DEGREES * self.body_count - (1 if self.rests_on_ground(mode) else 0)

    @inlined
    def lowest_place(self, mode: int, body: BodyState, state: Vector) -> float:
        """Give the horizontal place of the lowest body: that follows from what holds it."""
        if not self.rests_on_ground(mode):
            return body.horizontal
        k = self.body_count - 1
        part = self.on_base(k)
        pin = part.body.pin(self.part_mode(mode, k).pivot)
        return float(body.horizontal + part.body.about_pin(pin, body.rotation))

    @kernel
    def keep_hold(self, mode: int, state: Vector, memory: Vector) -> None:
        """Write to the state where the lowest body is held, if rigid ground does."""
        if self.rests_on_ground(mode):
            k = self.body_count - 1
            self.set_sway(k, memory[HELD_PLACE + k], 0.0, state)

    @kernel
    def switch(self, mode: int, guard: int, state: Vector, ground: Ground, memory: Vector) -> int:
        """Carry out the switch that a guard calls for; give the new mode."""
        new = self.switch_one(mode, guard, state, ground, memory)
        self.keep_hold(new, state, memory)
        return new


@inlined
def versine(sine: float, cosine: float) -> float:
    """Give 1 - cos to all digits."""
    return sine * sine / (1.0 + cosine) if cosine > 0.0 else 1.0 - cosine


class ChainLink(NamedTuple):
    """A link of a chain; lengths in metres, bodies counted from 0 at the top."""

    on: int
    on_point: tuple[float, float]  # from the centre of mass of its body to the right and up
    to: int  # a body, or `GROUND`
    to_point: tuple[float, float]  # likewise; of no matter on the ground
    apart: tuple[float, float]  # from the second point to the first, as the link is given
    numbers: LinkNumbers
    along: tuple[float, float] = (
        0.0,
        0.0,
    )  # in which a load or a wall acts


def linked(chain: Chain, links: Sequence[ChainLink]) -> LinkedChain | LinkedRigidChain:
    """Give a chain with links."""
    laws = [one.numbers.law for one in links]
    kinds = list({type(law): law for law in laws}.values())
    own = [one_of(kinds, law) for law in laws]
    law = own[0].with_numbers(numbers_in(own[0]).tolist())
    rows, value = list[Vector](), MODES**chain.body_count
    for one, each in zip(links, own, strict=True):
        rows.append(_row_of(one, each, value))
        value *= room_of_states(each.states())
    if value > MOST_MODES:
        msg = f"{len(links)} links are more than {chain.body_count} bodies can have"
        raise AssemblyError([msg])
    count, variables = len(links), len(links) * law.variables()
    room = (LIES + DEGREES + 2 * BODY_GUARDS + COLUMNS) * chain.body_count
    room += variables + POWERS + (2 * GUARDS + LINK_COLUMNS) * count
    numbers = np.concatenate([chain.rows, *rows, np.zeros(room)])
    kind = LinkedRigidChain if isinstance(chain, RigidChain) else LinkedChain
    return kind(chain.body_count, count, law, numbers)


def _row_of(link: ChainLink, law: Any, value: int) -> Vector:
    apart, reach = math.hypot(*link.apart), math.hypot(*link.on_point) + math.hypot(*link.to_point)
    geometry = (
        link.on, *link.on_point, link.to, *link.to_point, *link.apart, apart,
        ROUNDING * (apart + reach), 0.0, value, room_of_states(law.states()), *link.along,
    )  # fmt: skip
    return np.array([*geometry, *numbers_in(law)], dtype=np.float64)


def room_of_states(states: int) -> int:
    """Give the least power of two that counts all states."""
    return 1 << max(states - 1, 0).bit_length()
