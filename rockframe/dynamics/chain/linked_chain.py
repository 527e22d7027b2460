"""A chain of bodies of which points are linked: to one another, or to the ground.

All else is that of a chain, on bases that hold, on rigid ones, or on those with friction.
"""

from collections.abc import Sequence
from typing import Any

import numpy as np

from rockframe.compiled import Vector, inlined, kernel
from rockframe.dynamics.bodies import DEGREES
from rockframe.dynamics.body import BodyState
from rockframe.dynamics.chain import rows as at
from rockframe.dynamics.chain.friction import SlippingChain
from rockframe.dynamics.chain.link_rows import (
    LIES,
    MOVED_X,
    MOVED_Y,
    OWN_RATE,
    OWN_SINE,
    OWN_VERSINE,
    ChainLink,
    LinkedLists,
)
from rockframe.dynamics.chain.linked import Linked, rows_of_links, with_room
from rockframe.dynamics.chain.motion import place_bodies
from rockframe.dynamics.chain.rigid import RigidChain
from rockframe.dynamics.chain.rigid_friction import SlippingRigidChain
from rockframe.dynamics.chain.rows import COLUMNS, GUARDS, PLACES
from rockframe.dynamics.chain.slips import SLIP_COLUMNS, SlippingBodies
from rockframe.dynamics.chain.system import Chain
from rockframe.dynamics.protocol import HELD_PLACE, Ground
from rockframe.dynamics.trigonometry import sine_cosine, versine


class ChainLinks(Linked, Chain):
    """How the bodies of a chain lie, for what links them. A mixin of systems.

    The horizontal coordinate of the lowest body moves wherever that is held, as those of all
    others do, for links ask where it is.
    """

    __slots__ = ()

    @inlined
    def behind_bodies(self) -> int:
        """Give the place behind all rows and rooms of the bodies."""
        return self.behind_chain()

    @inlined
    def own_guards(self) -> int:
        """Give the number of guards of all bodies."""
        return GUARDS * self.body_count

    @inlined
    def own_columns(self) -> int:
        """Give the number of columns of all bodies and their bases."""
        return COLUMNS * self.body_count

    @kernel
    def moving_in(self, mode: int) -> int:
        """Give the number of coordinates that move: all."""
        return DEGREES * self.body_count

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
    def set_out(self, mode: int, state: Vector, room: Vector) -> None:
        """Write where all bodies are and how they move."""
        place_bodies(self, mode, state, room)
        self.lay(mode, state, room)


class LinkedChain(LinkedLists, ChainLinks):  # pyright: ignore[reportGeneralTypeIssues]
    """Bodies upon one another, and what links them: a system."""

    __slots__ = ()


class RestOnGround(ChainLinks):
    """How bodies lie of which the lowest may stand on rigid ground. A mixin of systems.

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
        attitude = part.body.attitude(body.rotation)
        return float(body.horizontal + part.body.about_pin(pin, attitude))

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
        if guard >= self.own_guards():
            new = self.hold_again(new, state, ground, memory)
        self.keep_hold(new, state, memory)
        return new

    @inlined
    def hold_again(self, mode: int, state: Vector, ground: Ground, memory: Vector) -> int:
        """Let what friction no longer holds slip: none slips here."""
        return mode


class LinkedRigidChain(LinkedLists, RestOnGround, RigidChain):  # pyright: ignore[reportGeneralTypeIssues]
    """Bodies upon one another of which some stand on rigid bases, and what links them."""

    __slots__ = ()


class LinkedSlips(ChainLinks, SlippingBodies):
    """Where the numbers are of bodies that friction holds, and of what links them. A mixin."""

    __slots__ = ()

    @inlined
    def behind_bodies(self) -> int:
        """Give the place behind all rows and rooms of the bodies, and their friction."""
        return self.behind_friction()

    @inlined
    def own_columns(self) -> int:
        """Give the number of columns of all bodies, their bases and slips."""
        return (COLUMNS + SLIP_COLUMNS) * self.body_count


class LinkedSlippingChain(LinkedLists, LinkedSlips, SlippingChain):  # pyright: ignore[reportGeneralTypeIssues]
    """The same where friction holds the bodies on their bases.

    What friction must hold follows from the forces of the links too.
    """

    __slots__ = ()


class LinkedSlippingRigidChain(  # pyright: ignore[reportGeneralTypeIssues]
    LinkedLists, LinkedSlips, RestOnGround, SlippingRigidChain
):
    """The same where friction holds the bodies on their rigid bases."""

    __slots__ = ()

    @inlined
    def hold_again(self, mode: int, state: Vector, ground: Ground, memory: Vector) -> int:
        """Let what friction no longer holds slip: a link has broken, or a wall is touched."""
        self.begin_slips(mode, state, memory)
        new = self.hold_as_far(mode, state, ground, memory)
        self.end_slips(new, state, memory)
        return new


def linked(chain: Chain, links: Sequence[ChainLink]) -> ChainLinks:
    """Give a chain with links."""
    law, rows = rows_of_links(links, chain.modes(), chain.body_count)
    if isinstance(chain, SlippingRigidChain):
        kind: Any = LinkedSlippingRigidChain
    elif isinstance(chain, RigidChain):
        kind = LinkedRigidChain
    elif isinstance(chain, SlippingChain):
        kind = LinkedSlippingChain
    else:
        kind = LinkedChain
    filled = np.concatenate([chain.rows, *rows])
    return with_room(kind(chain.body_count, len(links), law, filled), filled)
