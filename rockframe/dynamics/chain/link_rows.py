"""The links of bodies as numbers: a row for each, behind the rows of the bodies, and room.

One machine code serves all links of a law, whatever their number.
"""

import math
from typing import TYPE_CHECKING, Any, Final, NamedTuple

import numpy as np

from rockframe.compiled import Vector, inlined, kernel, numbers_in, part_of, stretch
from rockframe.dynamics.links import GUARDS, LinkNumbers
from rockframe.dynamics.pads import ROUNDING
from rockframe.dynamics.protocol import POWERS, Energies, Ground, Guards, Slope

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
LINK_MOMENT: Final = "link_moment"
"""The column behind them: the moment of all links on the first body, about its centre of mass."""


class ChainLink(NamedTuple):
    """A link of a chain; lengths in metres, bodies counted from 0 at the top."""

    on: int
    on_point: tuple[float, float]  # from the centre of mass of its body to the right and up
    to: int  # a body, or `GROUND`
    to_point: tuple[float, float]  # likewise; of no matter on the ground
    apart: tuple[float, float]  # from the second point to the first, as the link is given
    numbers: LinkNumbers
    along: tuple[float, float] = (0.0, 0.0)  # in which a load or a wall acts


class LinkedLists(NamedTuple):
    """The numbers of a chain with links."""

    body_count: int
    link_count: int
    law: Any  # of the class of all links; its numbers are those of one of them
    rows: Vector  # those of a chain; then of the links, and room to work in


class Linkable:
    """What bodies are to the links between them. A mixin of systems, which give all of it."""

    __slots__ = ()
    body_count: int
    rows: Vector

    if TYPE_CHECKING:

        def coordinates(self) -> int:
            """Give the number of coordinates."""
            raise NotImplementedError

        def moving_in(self, mode: int) -> int:
            """Give the number of coordinates that move in a mode."""
            raise NotImplementedError

        def places(self) -> Vector:
            """Give the room for places, speeds, loads and accelerations of all bodies."""
            raise NotImplementedError

        def behind_bodies(self) -> int:
            """Give the place behind all rows and rooms of the bodies."""
            raise NotImplementedError

        def own_guards(self) -> int:
            """Give the number of their guards."""
            raise NotImplementedError

        def own_columns(self) -> int:
            """Give the number of their columns."""
            raise NotImplementedError

        def lay(self, mode: int, state: Vector, room: Vector) -> None:
            """Write how bodies lie, after they are placed."""
            raise NotImplementedError

        def set_out(self, mode: int, state: Vector, room: Vector) -> None:
            """Write where all bodies are and how they move."""
            raise NotImplementedError

        def forces_from(self, mode: int, state: Vector, slope: Slope, ground: Ground) -> None:
            """Write the accelerations of all bodies, from a slope."""
            raise NotImplementedError

        def guards_of_bodies(
            self, mode: int, state: Vector, slope: Slope, ground: Ground
        ) -> Guards:
            """Write their guards, and the rates of these."""
            raise NotImplementedError

        def switch_body(
            self, mode: int, guard: int, state: Vector, ground: Ground, memory: Vector
        ) -> int:
            """Carry out the switch that a guard of theirs calls for; give the new mode."""
            raise NotImplementedError

        def begin_event(self, memory: Vector) -> None:
            """Forget what the last event left."""
            raise NotImplementedError

        def link_place(self) -> int:
            """Give the place of the last event's link in the memory."""
            raise NotImplementedError

        def energies_of_bodies(self, mode: int, state: Vector) -> Energies:
            """Give their energies, and leave where they are in the room."""
            raise NotImplementedError

        def observe_bodies(
            self, mode: int, state: Vector, slope: Slope, ground: Ground, memory: Vector
        ) -> Vector:
            """Write their columns, and leave where they are in the room."""
            raise NotImplementedError


class LinkRows(Linkable):
    """What stands in the rows of links. A mixin of systems."""

    __slots__ = ()
    link_count: int
    law: Any

    @inlined
    def link_width(self) -> int:
        """Give the length of the row of a link."""
        return NUMBERS + self.law.number_count()

    @inlined
    def behind_links(self) -> int:
        """Give the place behind the rows of links."""
        return self.behind_bodies() + self.link_count * self.link_width()

    @inlined
    def row_of_link(self, i: int) -> Vector:
        """Give the row of a link."""
        return stretch(self.rows, self.behind_bodies() + i * self.link_width(), self.link_width())

    @inlined
    def law_of(self, row: Vector) -> Any:
        """Give the law of a link, by its row."""
        return self.law.with_numbers(part_of(row, NUMBERS))

    @inlined
    def link_state(self, mode: int, row: Vector) -> int:
        """Give the state of a link, by its row."""
        return mode // int(row[PLACE_VALUE]) % int(row[STATES])

    @inlined
    def of_link(self, i: int, state: Vector) -> Vector:
        """Give the variables of a link."""
        each = self.law.variables()
        return stretch(state, 2 * self.coordinates() + i * each, each)

    @inlined
    def lies(self) -> Vector:
        """Give the room for how bodies lie, and what links load them by."""
        return stretch(self.rows, self.behind_links(), LIES * self.body_count)

    @inlined
    def slopes(self) -> Vector:
        """Give the room for accelerations, rates of the links' variables, and powers."""
        first = self.behind_links() + LIES * self.body_count
        return stretch(self.rows, first, self.coordinates() + self.variables() + POWERS)

    @inlined
    def behind_slopes(self) -> int:
        """Give the place behind them."""
        lies = LIES * self.body_count + self.coordinates()
        return self.behind_links() + lies + self.variables() + POWERS

    @inlined
    def guard_room(self, which: int) -> Vector:
        """Give the room for guards (0) or their rates (1)."""
        return stretch(self.rows, self.behind_slopes() + which * self.guards(), self.guards())

    @inlined
    def columns(self) -> int:
        """Give the number of columns."""
        return self.own_columns() + LINK_COLUMNS * self.link_count + 1

    @inlined
    def column_room(self) -> Vector:
        """Give the room for columns."""
        return stretch(self.rows, self.behind_slopes() + 2 * self.guards(), self.columns())

    def behind_room(self) -> int:
        """Give the place behind all."""
        return self.behind_slopes() + 2 * self.guards() + self.columns()

    @kernel
    def variables(self) -> int:
        """Give the number of variables of all links."""
        return self.link_count * self.law.variables()

    @kernel
    def guards(self) -> int:
        """Give the number of guards, of each body and then of each link in turn."""
        return self.own_guards() + GUARDS * self.link_count

    @kernel
    def modes(self) -> int:
        """Give the number of modes, of which some have no meaning."""
        last = self.row_of_link(self.link_count - 1)
        return int(last[PLACE_VALUE] * last[STATES])


def numbers_of_link(link: ChainLink, law: Any, value: int) -> Vector:
    """Give the row of a link, its state worth `value` in the mode of the system.

    `law` is that of all links, with the numbers of this one's own.
    """
    apart, reach = math.hypot(*link.apart), math.hypot(*link.on_point) + math.hypot(*link.to_point)
    geometry = (
        link.on, *link.on_point, link.to, *link.to_point, *link.apart, apart,
        ROUNDING * (apart + reach), 0.0, value, room_of_states(link.numbers.law.states()),
        *link.along,
    )  # fmt: skip
    return np.array([*geometry, *numbers_in(law)], dtype=np.float64)


def room_of_states(states: int) -> int:
    """Give the least power of two that counts all states."""
    return 1 << max(states - 1, 0).bit_length()
