"""Sorting a system's parts, whatever their order."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, cast

from rockframe.components import (
    Block,
    Component,
    CushionCap,
    Link,
    Load,
    RearWall,
    RigidGround,
    RockingFrame,
    Stack,
)
from rockframe.components.block_numbers import BlockSI
from rockframe.errors import shown
from rockframe.motion import GroundMotion
from rockframe.system.bodies import Cap, cap_under
from rockframe.system.slots import (
    RESTRAINER,
    SHIPPED,
    beyond_models,
    hint_for,
    kind_of_slot,
    numbered,
    slot_of,
    slots,
)


@dataclass(frozen=True)
class Parts:
    """The parts of a scene, by what they are."""

    # slots and what fills them, in the order of all slots
    filled: tuple[tuple[str, Component | GroundMotion], ...] = ()

    @classmethod
    def of(cls, by_slot: Mapping[str, Component | GroundMotion | None]) -> "Parts":
        """Give parts by their slots, in whatever order; None fills none."""
        order = {slot: i for i, slot in enumerate(slots())}
        given = [slot for slot, part in by_slot.items() if part is not None]
        # several of a kind keep their order
        given.sort(key=lambda slot: order[kind_of_slot(slot)])
        return cls(tuple((slot, by_slot[slot]) for slot in given))  # type: ignore[misc]

    def __getitem__(self, slot: str) -> Component:
        """Give the part in a slot, in a scene that has it."""
        return cast("Component", dict(self.filled)[slot])

    def changed(self, **by_slot: Component | GroundMotion | None) -> "Parts":
        """Give the parts with others in some slots."""
        return Parts.of({**dict(self.filled), **by_slot})

    def _in(self, slot: str) -> Any:
        return dict(self.filled).get(slot)

    @property
    def block(self) -> Block | None:
        """The block."""
        return self._in("block")

    @property
    def stack(self) -> Stack | None:
        """Blocks upon one another."""
        return self._in("stack")

    @property
    def frame(self) -> RockingFrame | None:
        """Columns under a beam."""
        return self._in("frame")

    @property
    def pads(self) -> Component | None:
        """The pads under it."""
        return self._in("pads")

    @property
    def cap(self) -> CushionCap | None:
        """The cap under block or pads."""
        return self._in("cap")

    @property
    def soil(self) -> Component | None:
        """The soil under block or cap."""
        return self._in("soil")

    @property
    def ground(self) -> RigidGround | None:
        """The rigid ground under a block."""
        return self._in("ground")

    @property
    def wall(self) -> RearWall | None:
        """The wall behind a block."""
        return self._in("wall")

    @property
    def motion(self) -> GroundMotion | None:
        """The motion of the ground."""
        return self._in("motion")

    def given(self) -> list[Component | GroundMotion]:
        """Give the parts that are there, in a fixed order."""
        return [part for _, part in self.filled]

    def structural(self) -> list[Component]:
        """Give the parts that are no motion, in a fixed order."""
        return list(self.components().values())

    def components(self) -> dict[str, Component]:
        """Give the same by their slots."""
        return {slot: part for slot, part in self.filled if isinstance(part, Component)}

    def own(self) -> dict[str, Component]:
        """Give the parts in slots that scenes of users' own have, by these."""
        return {
            slot: part
            for slot, part in self.components().items()
            if kind_of_slot(slot) not in SHIPPED
        }

    @property
    def links(self) -> tuple[Link, ...]:
        """The links between points of bodies, ground and walls; loads stand behind the others."""
        found = [
            part
            for part in self.structural()
            if isinstance(part, Link) and (not isinstance(part, RearWall) or part.elastic)
        ]
        return tuple(sorted(found, key=lambda part: isinstance(part, Load)))

    @property
    def the_block(self) -> BlockSI:
        """The numbers of the block: the highest one of a stack, a column of a frame."""
        if self.stack is not None:
            return self.stack.si.bodies[0]
        if self.frame is not None:
            return self.frame.si.column
        if self.block is None:
            raise TypeError
        return self.block.si

    @property
    def the_frame(self) -> RockingFrame:
        """Columns under a beam, in a scene that has them."""
        if self.frame is None:
            raise TypeError
        return self.frame

    @property
    def the_wall(self) -> RearWall:
        """The wall behind the block, in a scene that has one."""
        if self.wall is None:
            raise TypeError
        return self.wall

    @property
    def the_cap(self) -> Cap:
        """The cap in the size it has under the block, in a scene that has one."""
        if self.cap is None:
            raise TypeError
        return cap_under(self.the_block, self.cap.si)

    @property
    def signature(self) -> frozenset[str]:
        """Names of the structural parts that are there; rigid ground goes without saying.

        An elastic wall is a link.
        """
        found = frozenset(kind_of_slot(slot) for slot in self.components()) - {"ground"}
        if self.wall is not None and self.wall.elastic:
            found = found - {"wall"} | {RESTRAINER}
        return found


def sort_parts(given: Sequence[object], faults: list[str]) -> Parts:
    """Put each part in its slot; note doubled parts and things that are no parts."""
    found: dict[str, Any] = {}
    for part in given:
        slot = slot_of(part)
        if slot is None:
            faults.append(f"{shown(part)} is not a part of a system{hint_for(part)}")
        elif slot == RESTRAINER:
            count = sum(kind_of_slot(one) == RESTRAINER for one in found)
            found[numbered(slot, count + 1)] = part
            faults += beyond_models(part)
        elif slot in found:
            name = type(part).__name__
            faults.append(f"{name} is given twice: {shown(found[slot])} and {shown(part)}")
        else:
            found[slot] = part
            faults += beyond_models(part)
    return Parts.of(found)
