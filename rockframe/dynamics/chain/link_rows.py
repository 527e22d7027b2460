"""Links in the array of a chain, behind the bodies: a row of data for each, and a workspace.

One machine code serves all links of a law, whatever their number.
"""

import math
from collections.abc import Callable, Iterator
from typing import Any, Final, NamedTuple

import numpy as np

from rockframe.compiled import Vector, inlined, kernel, numbers_in, view_from, view_of
from rockframe.dynamics.chain.returned import ReturnedArrays
from rockframe.dynamics.links import GUARDS, LinkNumbers
from rockframe.dynamics.pads import ROUNDING
from rockframe.dynamics.protocol import Column, column_of

GROUND: Final = -1
"""In place of the number of a body."""

# columns of a row; points are to the right and up from the centre of mass of their body [m]
FIRST_BODY: Final = 0  # number of the body of the first point, or GROUND
FIRST_X: Final = 1
FIRST_Y: Final = 2
SECOND_BODY: Final = 3  # and of the second
SECOND_X: Final = 4
SECOND_Y: Final = 5
# first point from the second one, as the link is given [m]
SEPARATION_X: Final = 6
SEPARATION_Y: Final = 7
INITIAL_LENGTH: Final = 8  # distance between them then [m]
NOISE: Final = 9  # rounding noise of the elongation [m]
REST_ENERGY: Final = 10  # elastic energy at rest, per reference mass [m^2 s^-2]
PLACE_VALUE: Final = 11  # factor of its state in the number of the system's mode
STATE_COUNT: Final = 12  # number of states, rounded up to a power of two: place values are exact
# unit vector of a force of fixed direction; zero for a link that acts along its points
DIRECTION_X: Final = 13
DIRECTION_Y: Final = 14
LAW_NUMBERS: Final = 15  # first of the numbers of its law

# workspace, for each body: its displacement from where it is given, and the loads of its links
DISPLACEMENT_X: Final = 0  # displacement of its centre of mass [m]
DISPLACEMENT_Y: Final = 1
BODY_SINE: Final = 2  # of its rotation
BODY_VERSINE: Final = 3  # 1 - cos of it
BODY_ROTATION_RATE: Final = 4  # angular velocity [s^-1]
LINK_FORCE_X: Final = 5  # resultant force of its links over the reference mass [m s^-2]
LINK_FORCE_Y: Final = 6
POSE_STRIDE: Final = 7  # numbers of each body

LINK_COLUMNS: Final = 3
"""Columns of each link in the results: force, elongation and state."""
LINK_MOMENT: Final = "link_moment"
"""The column behind those: moment of all links on body 0, about its centre of mass."""


class ChainLink(NamedTuple):
    """A link of a chain; lengths in metres, bodies counted from 0 at the top."""

    on: int
    on_point: tuple[float, float]  # from the centre of mass of its body to the right and up
    to: int  # a body, or `GROUND`
    to_point: tuple[float, float]  # likewise; not used on the ground
    separation: tuple[float, float]  # from the second point to the first, as the link is given
    numbers: LinkNumbers
    along: tuple[float, float] = (0.0, 0.0)  # unit vector along which a load or a wall acts

    @property
    def length_scale(self) -> float:
        """Length that the rounding noise of the elongation is proportional to [m]."""
        length = math.hypot(*self.separation)
        return length + math.hypot(*self.on_point) + math.hypot(*self.to_point)


class LinkInMode(NamedTuple):
    """A link in a mode and state of the system."""

    row: Vector
    law: Any
    state: int  # of its law
    own: Vector  # its variables


class LinkedChainNumbers(NamedTuple):
    """The numbers of a chain with links."""

    body_count: int
    link_count: int
    law: Any  # of the class of all links; its numbers are replaced by those of each link's row
    rows: Vector  # the array of the chain, then the rows of the links and their workspace


class LinkRows(ReturnedArrays):
    """Access to the rows and the workspace of links. A mixin of systems."""

    __slots__ = ()
    body_count: int
    link_count: int
    law: Any
    # methods of the system of the bodies
    bodies_end: Callable[[], int]  # index behind rows and workspace of the bodies
    body_guard_count: Callable[[], int]
    body_column_count: Callable[[], int]  # of all bodies and their bases

    @inlined
    def link_row_length(self) -> int:
        """Return the length of the row of a link."""
        return LAW_NUMBERS + self.law.number_count()

    @inlined
    def links_end(self) -> int:
        """Return the index behind the rows of links."""
        return self.bodies_end() + self.link_count * self.link_row_length()

    @inlined
    def row_of_link(self, i: int) -> Vector:
        """Return the row of a link."""
        return view_of(
            self.rows, self.bodies_end() + i * self.link_row_length(), self.link_row_length()
        )

    @inlined
    def law_of(self, row: Vector) -> Any:
        """Return the law of a link, by its row."""
        return self.law.with_numbers(view_from(row, LAW_NUMBERS))

    @inlined
    def link_state(self, mode: int, row: Vector) -> int:
        """Return the state of a link, by its row."""
        return mode // int(row[PLACE_VALUE]) % int(row[STATE_COUNT])

    @inlined
    def link_variables(self, i: int, state: Vector) -> Vector:
        """Return the variables of a link in a state."""
        count = self.law.variables()
        return view_of(state, 2 * self.coordinates() + i * count, count)

    @inlined
    def link(self, i: int, mode: int, state: Vector) -> LinkInMode:
        """Return a link as it is in a mode and state."""
        row = self.row_of_link(i)
        return LinkInMode(
            row, self.law_of(row), self.link_state(mode, row), self.link_variables(i, state)
        )

    @inlined
    def poses(self) -> Vector:
        """Return displacements and rotations of bodies, and the forces of links on them."""
        return view_of(self.rows, self.links_end(), POSE_STRIDE * self.body_count)

    @inlined
    def returned_start(self) -> int:
        """Return the index of the workspace for what the equations return."""
        return self.links_end() + POSE_STRIDE * self.body_count

    @inlined
    def columns(self) -> int:
        """Return the number of columns."""
        return self.body_column_count() + LINK_COLUMNS * self.link_count + 1

    @kernel
    def variables(self) -> int:
        """Return the number of variables of all links."""
        return self.link_count * self.law.variables()

    @kernel
    def guards(self) -> int:
        """Return the number of guards, of each body and then of each link in turn."""
        return self.body_guard_count() + GUARDS * self.link_count

    @kernel
    def modes(self) -> int:
        """Return the number of modes; some of these numbers do not occur."""
        last = self.row_of_link(self.link_count - 1)
        return int(last[PLACE_VALUE] * last[STATE_COUNT])


def link_row(link: ChainLink, law: Any, value: int) -> Vector:
    """Return the row of a link; `value` is the place value of its state in the system's mode.

    `law` is the law of the class of all links, with the numbers of this link.
    """
    length = math.hypot(*link.separation)
    arms = math.hypot(*link.on_point) + math.hypot(*link.to_point)
    geometry = (
        link.on, *link.on_point, link.to, *link.to_point, *link.separation, length,
        ROUNDING * (length + arms), 0.0, value, padded_state_count(link.numbers.law.states()),
        *link.along,
    )  # fmt: skip
    return np.array([*geometry, *numbers_in(law)], dtype=np.float64)


def link_columns(links: int, shown: int) -> Iterator[Column]:
    """Return the columns of links; users do not see those of loads, which come last."""
    for i in range(links):
        kind = "restrainer" if i < shown else "unused_load"
        yield Column(column_of(f"{kind}_force", i), per_mass=True)
        yield Column(column_of(f"{kind}_elongation", i))
        yield Column(column_of(f"{kind}_state", i))


MOMENT_OF_LINKS: Final = Column(LINK_MOMENT, per_mass=True)
"""The column behind those of the links of bodies."""


def padded_state_count(states: int) -> int:
    """Return the least power of two that counts all states."""
    return 1 << max(states - 1, 0).bit_length()
