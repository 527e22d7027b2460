"""Chains of bodies with links between them or to the ground, for each kind of base.

The kinds are: deformable bases without slip, rigid ones among them, and either with friction.
"""

from collections.abc import Sequence
from typing import Any

import numpy as np

from rockframe.compiled import Vector, inlined, kernel
from rockframe.dynamics.bodies import BODY_DOF
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
    """Displacements of the bodies of a chain, as links need them. A mixin of systems.

    The horizontal coordinate of the lowest body is integrated even while the body is held, as
    those of all other bodies are, since the elongations of links depend on it.
    """

    __slots__ = ()

    @inlined
    def behind_bodies(self) -> int:
        """Return the index behind rows and workspace of the bodies."""
        return self.behind_chain()

    @inlined
    def own_guards(self) -> int:
        """Return the number of guards of all bodies."""
        return GUARDS * self.body_count

    @inlined
    def own_columns(self) -> int:
        """Return the number of columns of all bodies and their bases."""
        return COLUMNS * self.body_count

    @kernel
    def moving_in(self, mode: int) -> int:
        """Return the number of coordinates that move in a mode: all."""
        return BODY_DOF * self.body_count

    @inlined
    def lowest_place(self, mode: int, body: BodyState, state: Vector) -> float:
        """Return the horizontal place of the lowest body's centre of mass [m]."""
        return body.horizontal

    @kernel
    def lay(self, mode: int, state: Vector, room: Vector) -> None:
        """Write displacements and rotations of bodies; `place_bodies` must have run before."""
        lies, x, y, rate, angle = self.lies(), 0.0, 0.0, 0.0, 0.0
        for k in range(self.body_count - 1, -1, -1):
            i, j = k * PLACES, k * LIES
            body = self.standing_state(k, self.body_mode(mode, k), state)
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
            if k > 0:  # the frame of the body above, which rotates with this one
                sine, cosine = room[i - PLACES + at.SINE], room[i - PLACES + at.COSINE]
            else:
                sine, cosine = sine_cosine(angle)
            lies[j + MOVED_X], lies[j + MOVED_Y], lies[j + OWN_RATE] = x, y, rate
            lies[j + OWN_SINE], lies[j + OWN_VERSINE] = sine, versine(sine, cosine)

    @inlined
    def set_out(self, mode: int, state: Vector, room: Vector) -> None:
        """Write places, displacements and velocities of all bodies."""
        place_bodies(self, mode, state, room)
        self.lay(mode, state, room)


class LinkedChain(LinkedLists, ChainLinks):  # pyright: ignore[reportGeneralTypeIssues]
    """Stacked bodies with links: a system."""

    __slots__ = ()


class RestOnGround(ChainLinks):
    """Displacements of bodies of which the lowest may stand on rigid ground. A mixin of systems.

    Forces of links are finite, so that links take no part in impacts. While rigid ground holds the
    lowest body, its horizontal coordinate is the place of the held point, and does not change.
    """

    __slots__ = ()

    @inlined
    def rests_on_ground(self, mode: int) -> bool:
        """Whether rigid ground holds the lowest body."""
        k = self.body_count - 1
        return self.is_rigid(k) and not self.on_base(k).is_free(self.body_mode(mode, k))

    @kernel
    def moving_in(self, mode: int) -> int:
        """Return the number of coordinates that move: all but one of a lowest body that is held."""
        return BODY_DOF * self.body_count - (1 if self.rests_on_ground(mode) else 0)

    @inlined
    def lowest_place(self, mode: int, body: BodyState, state: Vector) -> float:
        """Return the horizontal place of the lowest body, if held from that of the held point."""
        if not self.rests_on_ground(mode):
            return body.horizontal
        k = self.body_count - 1
        part = self.on_base(k)
        pin = part.body.pin(self.body_mode(mode, k).pivot)
        attitude = part.body.attitude(body.rotation)
        return float(body.horizontal + part.body.about_pin(pin, attitude))

    @kernel
    def keep_hold(self, mode: int, state: Vector, memory: Vector) -> None:
        """Write the place of the lowest body's held point to the state, if the ground holds it."""
        if self.rests_on_ground(mode):
            k = self.body_count - 1
            self.set_horizontal(k, memory[HELD_PLACE + k], 0.0, state)

    @kernel
    def switch(self, mode: int, guard: int, state: Vector, ground: Ground, memory: Vector) -> int:
        """Carry out the switch that a guard calls for; return the new mode."""
        new = self.switch_one(mode, guard, state, ground, memory)
        if guard >= self.own_guards():
            new = self.hold_again(new, state, ground, memory)
        self.keep_hold(new, state, memory)
        return new

    @inlined
    def hold_again(self, mode: int, state: Vector, ground: Ground, memory: Vector) -> int:
        """Return the mode in which bodies slip that friction cannot hold: none slips here."""
        return mode


class LinkedRigidChain(LinkedLists, RestOnGround, RigidChain):  # pyright: ignore[reportGeneralTypeIssues]
    """Stacked bodies, some of them on rigid bases, with links: a system."""

    __slots__ = ()


class LinkedSlips(ChainLinks, SlippingBodies):
    """Layout of the array of bodies with friction and links. A mixin of systems."""

    __slots__ = ()

    @inlined
    def behind_bodies(self) -> int:
        """Return the index behind rows, workspace and friction of the bodies."""
        return self.behind_friction()

    @inlined
    def own_columns(self) -> int:
        """Return the number of columns of all bodies, their bases and slips."""
        return (COLUMNS + SLIP_COLUMNS) * self.body_count


class LinkedSlippingChain(LinkedLists, LinkedSlips, SlippingChain):  # pyright: ignore[reportGeneralTypeIssues]
    """Bodies that friction holds on deformable bases, with links: a system.

    The forces of links enter the force that friction must hold.
    """

    __slots__ = ()


class LinkedSlippingRigidChain(  # pyright: ignore[reportGeneralTypeIssues]
    LinkedLists, LinkedSlips, RestOnGround, SlippingRigidChain
):
    """Bodies that friction holds, some of them on rigid bases, with links: a system."""

    __slots__ = ()

    @inlined
    def hold_again(self, mode: int, state: Vector, ground: Ground, memory: Vector) -> int:
        """Return the mode in which bodies slip that friction cannot hold after a link's event."""
        self.begin_slips(mode, state, memory)
        new = self.hold_as_far(mode, state, ground, memory)
        self.end_slips(new, state, memory)
        return new


def linked(chain: Chain, links: Sequence[ChainLink]) -> ChainLinks:
    """Return the system of a chain with links."""
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
