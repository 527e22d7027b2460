"""Sorting a system's parts, whatever their order."""

from collections.abc import Sequence
from dataclasses import dataclass

from rockframe.components import Block, Component, CushionCap, RigidGround, Stack
from rockframe.components.block_numbers import BlockSI
from rockframe.errors import shown
from rockframe.motion import GroundMotion
from rockframe.system.bodies import Cap, cap_under
from rockframe.system.slots import beyond_models, hint_for, slot_of


@dataclass(frozen=True)
class Parts:
    """The parts of a scene, by what they are; absent ones are None."""

    block: Block | None = None
    pads: Component | None = None
    cap: CushionCap | None = None
    soil: Component | None = None
    ground: RigidGround | None = None
    motion: GroundMotion | None = None
    stack: Stack | None = None

    def given(self) -> list[Component | GroundMotion]:
        """Give the parts that are there, in a fixed order."""
        order = [self.stack, self.block, self.pads, self.cap, self.soil, self.ground, self.motion]
        return [part for part in order if part is not None]

    def structural(self) -> list[Component]:
        """Give the parts that are no motion, in a fixed order."""
        return [part for part in self.given() if not isinstance(part, GroundMotion)]

    @property
    def the_block(self) -> BlockSI:
        """The numbers of the block, the highest one of a stack, which every scene has."""
        if self.stack is not None:
            return self.stack.si.bodies[0]
        if self.block is None:
            raise TypeError
        return self.block.si

    @property
    def the_cap(self) -> Cap:
        """The cap in the size it has under the block, in a scene that has one."""
        if self.cap is None:
            raise TypeError
        return cap_under(self.the_block, self.cap.si)

    def base(self, slot: str) -> Component:
        """Give the base in a slot, in a scene that has one."""
        part = self.pads if slot == "pads" else self.soil
        if part is None:
            raise TypeError
        return part

    @property
    def signature(self) -> frozenset[str]:
        """Names of the structural parts that are there; rigid ground goes without saying."""
        names = {name for name, part in vars(self).items() if part is not None}
        return frozenset(names - {"motion", "ground"})


def sort_parts(given: Sequence[object], faults: list[str]) -> Parts:
    """Put each part in its slot; note doubled parts and things that are no parts.

    Parameters
    ----------
    given : sequence
        Parts in any order.
    faults : list of str
        Appended to.

    Returns
    -------
    Parts
    """
    found: dict[str, object] = {}
    for part in given:
        slot = slot_of(part)
        if slot is None:
            faults.append(f"{shown(part)} is not a part of a system{hint_for(part)}")
        elif slot in found:
            name = type(part).__name__
            faults.append(f"{name} is given twice: {shown(found[slot])} and {shown(part)}")
        else:
            found[slot] = part
            faults += beyond_models(part)
    return Parts(**found)  # type: ignore[arg-type]
