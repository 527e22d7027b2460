"""Chains of bodies with links between them or to the ground, for each kind of base.

The kinds are: deformable bases without slip, rigid ones among them, and either with friction.
"""

from collections.abc import Sequence
from typing import Any, Final

import numpy as np

from rockframe.compiled import Vector, inlined, kernel
from rockframe.dynamics.bodies import BODY_DOF
from rockframe.dynamics.body import BodyState
from rockframe.dynamics.chain import rows as at
from rockframe.dynamics.chain.friction import SlippingChain
from rockframe.dynamics.chain.link_rows import (
    BODY_ROTATION_RATE,
    BODY_SINE,
    BODY_VERSINE,
    DISPLACEMENT_X,
    DISPLACEMENT_Y,
    POSE_STRIDE,
    ChainLink,
    LinkedChainNumbers,
)
from rockframe.dynamics.chain.linked import LinkMechanics, link_law_and_rows
from rockframe.dynamics.chain.motion import write_kinematics
from rockframe.dynamics.chain.returned import with_workspace
from rockframe.dynamics.chain.rigid import RigidChain
from rockframe.dynamics.chain.rigid_friction import SlippingRigidChain
from rockframe.dynamics.chain.rows import BODY_STRIDE
from rockframe.dynamics.chain.system import Chain
from rockframe.dynamics.protocol import HELD_PLACE, Ground
from rockframe.dynamics.trigonometry import sine_cosine, versine


class LinkedBodies(LinkMechanics, Chain):
    """Bodies of a chain with the displacements that links depend on. A mixin of systems.

    The horizontal coordinate of the lowest body is integrated even while the body is held, as
    those of all other bodies are, since the elongations of links depend on it.
    """

    __slots__ = ()

    @kernel
    def moving_in(self, mode: int) -> int:
        """Return the number of coordinates that move in a mode: all."""
        return BODY_DOF * self.body_count

    @inlined
    def lowest_position(self, mode: int, body: BodyState, state: Vector) -> float:
        """Return the horizontal place of the lowest body's centre of mass [m]."""
        return body.horizontal

    @kernel
    def write_poses(self, mode: int, state: Vector, work: Vector) -> None:
        """Write displacements and rotations of bodies, after `write_kinematics`."""
        poses, x, y, rate, angle = self.poses(), 0.0, 0.0, 0.0, 0.0
        for k in range(self.body_count - 1, -1, -1):
            i, j = k * BODY_STRIDE, k * POSE_STRIDE
            body = self.constrained_state(k, self.body_mode(mode, k), state)
            sine, cosine = work[i + at.SINE], work[i + at.COSINE]
            y = self.rise_of(k, y, body.vertical, work)
            if k + 1 < self.body_count:
                across = work[i + at.TANGENTIAL]
                x += work[i + at.NORMAL] * sine + across - self.row_value(k, at.UPRIGHT_OFFSET)
                x -= across * versine(sine, cosine)
            else:
                x = self.lowest_position(mode, body, state)
            rate += body.angular_velocity
            angle += body.rotation
            if k > 0:  # the frame of the body above, which rotates with this one
                sine, cosine = work[i - BODY_STRIDE + at.SINE], work[i - BODY_STRIDE + at.COSINE]
            else:
                sine, cosine = sine_cosine(angle)
            poses[j + DISPLACEMENT_X], poses[j + DISPLACEMENT_Y] = x, y
            poses[j + BODY_ROTATION_RATE] = rate
            poses[j + BODY_SINE], poses[j + BODY_VERSINE] = sine, versine(sine, cosine)

    @inlined
    def write_kinematics_and_poses(self, mode: int, state: Vector, work: Vector) -> None:
        """Write places, displacements and velocities of all bodies."""
        write_kinematics(self, mode, state, work)
        self.write_poses(mode, state, work)


class LinkedChain(LinkedChainNumbers, LinkedBodies):  # pyright: ignore[reportGeneralTypeIssues]
    """Stacked bodies with links: a system."""

    __slots__ = ()


class LinkedRigidChain(LinkedChainNumbers, LinkedBodies, RigidChain):  # pyright: ignore[reportGeneralTypeIssues]
    """Stacked bodies, some of them on rigid bases, with links: a system.

    Forces of links are finite, so that links take no part in impacts. While rigid ground holds the
    lowest body, its horizontal coordinate is the place of the held point, and does not change.
    """

    __slots__ = ()

    @inlined
    def lowest_is_held(self, mode: int) -> bool:
        """Whether rigid ground holds the lowest body."""
        k = self.body_count - 1
        return self.is_rigid(k) and not self.on_base(k).is_free(self.body_mode(mode, k))

    @kernel
    def moving_in(self, mode: int) -> int:
        """Return the number of coordinates that move: all but one of a lowest body that is held."""
        return BODY_DOF * self.body_count - (1 if self.lowest_is_held(mode) else 0)

    @inlined
    def lowest_position(self, mode: int, body: BodyState, state: Vector) -> float:
        """Return the horizontal place of the lowest body, if held from that of the held point."""
        if not self.lowest_is_held(mode):
            return body.horizontal
        k = self.body_count - 1
        return self.position_from_pin(k, self.body_mode(mode, k), body.horizontal, state)[0]

    @kernel
    def store_held_place(self, mode: int, state: Vector, memory: Vector) -> None:
        """Write the place of the lowest body's held point to the state, if the ground holds it."""
        if self.lowest_is_held(mode):
            k = self.body_count - 1
            self.set_horizontal(k, memory[HELD_PLACE + k], 0.0, state)

    @kernel
    def switch(self, mode: int, guard: int, state: Vector, ground: Ground, memory: Vector) -> int:
        """Carry out the switch that a guard calls for; return the new mode."""
        new = self.switch_body_or_link(mode, guard, state, ground, memory)
        if guard >= self.body_guard_count():
            new = self.with_slips_after_event(new, state, ground, memory)
        self.store_held_place(new, state, memory)
        return new

    @inlined
    def with_slips_after_event(
        self, mode: int, state: Vector, ground: Ground, memory: Vector
    ) -> int:
        """Return the mode in which bodies slip that friction cannot hold: none slips here."""
        return mode


class LinkedSlippingChain(LinkedChainNumbers, LinkedBodies, SlippingChain):  # pyright: ignore[reportGeneralTypeIssues]
    """Bodies that friction holds on deformable bases, with links: a system.

    The forces of links enter the force that friction must hold.
    """

    __slots__ = ()


class LinkedSlippingRigidChain(LinkedRigidChain, SlippingRigidChain):  # pyright: ignore[reportGeneralTypeIssues]
    """Bodies that friction holds, some of them on rigid bases, with links: a system."""

    __slots__ = ()

    @inlined
    def with_slips_after_event(
        self, mode: int, state: Vector, ground: Ground, memory: Vector
    ) -> int:
        """Return the mode in which bodies slip that friction cannot hold after a link's event."""
        self.store_slips(mode, state, memory)
        new = self.with_consistent_slips(mode, state, ground, memory)
        self.restore_slips(new, state, memory)
        return new


_LINKED: Final[dict[type[Chain], Any]] = {
    Chain: LinkedChain,
    RigidChain: LinkedRigidChain,
    SlippingChain: LinkedSlippingChain,
    SlippingRigidChain: LinkedSlippingRigidChain,
}
"""The system of each kind of chain with links."""


def with_links(chain: Chain, links: Sequence[ChainLink]) -> LinkedBodies:
    """Return the system of a chain with links."""
    law, rows = link_law_and_rows(links, chain.modes(), chain.body_count)
    bodies = chain.rows[: chain.bodies_end()]
    kind = _LINKED[type(chain)]
    return with_workspace(kind(chain.body_count, len(links), law, np.concatenate([bodies, *rows])))
