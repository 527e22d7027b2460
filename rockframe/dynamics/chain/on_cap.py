"""A block on pads on a cap on soil, with slip on either: a chain of two, named as a cap scene."""

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Final, cast

from rockframe.compiled import Vector, kernel
from rockframe.dynamics.chain.friction import SlippingChain
from rockframe.dynamics.chain.model import chain_model
from rockframe.dynamics.chain.rigid_friction import SlippingRigidChain
from rockframe.dynamics.chain.rows import BASE_COLUMNS
from rockframe.dynamics.chain.system import Chain
from rockframe.dynamics.events import REVERSAL, SLIP, STICK
from rockframe.dynamics.protocol import (
    BODY_COLUMNS,
    HELD_PLACE,
    LAST_EVENT,
    Column,
    ContactModel,
    Ground,
)
from rockframe.dynamics.stacked import COLUMNS, CONTACTS, LOWER, name_soil_event
from rockframe.dynamics.starting import AtRest
from rockframe.dynamics.vibrations import ChainBody

CAP_COLUMNS: Final = 4
"""Columns of the cap's motion: its forces are in the columns of block and soil."""


class OnCap(Chain):
    """A block on a cap, whose events of the soil have names of their own. A mixin of systems."""

    __slots__ = ()

    @kernel
    def switch(self, mode: int, guard: int, state: Vector, ground: Ground, memory: Vector) -> int:
        """Carry out the switch that a guard calls for, and name it; return the new mode."""
        new, of_soil = self.switch_body(mode, guard, state, ground, memory), LOWER + 1.0
        names_itself = int(memory[LAST_EVENT]) in (SLIP, STICK, REVERSAL)
        if memory[HELD_PLACE + self.body_count] == of_soil and not names_itself:
            name_soil_event(memory)
        return new


class BothSlip(OnCap, SlippingChain):
    """A block on a cap, both of which may slip: a system."""

    __slots__ = ()


class OneSlips(OnCap, SlippingRigidChain):
    """A block on a cap, one of which cannot slip: a system."""

    __slots__ = ()


def block_on_cap(
    block: ChainBody, cap: ChainBody, mass: float, rest: Sequence[AtRest],
    frictions: Sequence[tuple[float, float, float]],
) -> ContactModel:  # fmt: skip
    """Assemble the model of a block on a cap, arguments as of :func:`chain`."""
    model = chain_model((block, cap), mass, rest, frictions=frictions)
    kind = BothSlip if isinstance(model.system, SlippingChain) else OneSlips
    slips = Column("cap_slip" if math.isfinite(frictions[LOWER][0]) else "unused_slip")
    own, of_cap = COLUMNS[len(BODY_COLUMNS) :], len(BODY_COLUMNS) + len(COLUMNS[-2:])
    return replace(
        model,
        name="coupled",
        system=kind(*cast("Chain", model.system)),
        columns=(
            *BODY_COLUMNS, *own[CAP_COLUMNS:], *_padded(block.base.columns, BASE_COLUMNS, "block"),
            *_padded(own[:CAP_COLUMNS], of_cap, "cap"),
            *_padded(cap.base.columns, BASE_COLUMNS, "soil"),
            Column("slip"), Column("slip_velocity"), slips, Column("unused_rate"),
        ),
        contacts=CONTACTS,
        shows_bodies=False,
    )  # fmt: skip


def _padded(columns: Sequence[Column], count: int, whose: str) -> tuple[Column, ...]:
    """Return columns, filled up to a number by columns that users do not see."""
    unseen = (Column(f"unused_{i}_of_{whose}") for i in range(count - len(columns)))
    return (*columns, *unseen)
