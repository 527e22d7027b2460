"""The parts of a scene: which slot each fills, and what stands in which slot."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from inspect import getattr_static
from typing import Any, Final, cast

from rockframe.components import (
    Block,
    Component,
    CushionCap,
    FrameEquivalent,
    Link,
    Load,
    RearWall,
    Restrainer,
    RigidGround,
    RockingFrame,
    Stack,
    Tendon,
    TwoSpringSupport,
    WinklerSoil,
)
from rockframe.components.block_numbers import BlockSI
from rockframe.components.parameters import Declared
from rockframe.errors import LabelError, nearest, shown
from rockframe.motion import GroundMotion
from rockframe.system.bodies import BaseLoad, Cap, cap_under
from rockframe.system.own_base import OwnBase
from rockframe.system.rigid_base import RigidBase
from rockframe.system.support import Support, bed_under, pads_under


@dataclass(frozen=True)
class Kind:
    """What scenes know of a class of parts."""

    slot: str  # that it fills
    # from a part and its load to what it is under a body, where it is a base
    support: Callable[[Any, BaseLoad], Support] | None = None


_KINDS: Final[dict[type, Kind]] = {
    Block: Kind("block"),
    FrameEquivalent: Kind("block"),
    Stack: Kind("stack"),
    RockingFrame: Kind("frame"),
    TwoSpringSupport: Kind("pads", pads_under),
    CushionCap: Kind("cap"),
    WinklerSoil: Kind("soil", bed_under),
    RigidGround: Kind("ground", lambda _, load: RigidBase(load)),
    RearWall: Kind("wall"),
    Restrainer: Kind("restrainer"),
    Tendon: Kind("restrainer"),
    Load: Kind("restrainer"),
    GroundMotion: Kind("motion"),
}

RESTRAINER: Final = "restrainer"
"""The slot of links, of which a scene may have several."""
SHIPPED: Final = tuple(dict.fromkeys(kind.slot for kind in _KINDS.values()))
"""Slots of the package's own parts, in a fixed order; that of the motion is the last."""


def slots() -> tuple[str, ...]:
    """Give all slots, in a fixed order: those of scenes of users' own stand before the motion."""
    own = sorted({kind.slot for kind in _KINDS.values()} - set(SHIPPED))
    return (*SHIPPED[:-1], *own, SHIPPED[-1])


def add_kind(of: type, kind: Kind) -> None:
    """Make a part of a user's own known: a link, a base, or what a scene of its own is made of."""
    _KINDS[of] = kind


def numbered(slot: str, number: int) -> str:
    """Give the slot of one of several parts of a kind, counted from 1."""
    return slot if number == 1 else f"{slot}_{number}"


def kind_of_slot(slot: str) -> str:
    """Give the slot of a kind of which there may be several parts."""
    head, _, number = slot.rpartition("_")
    return head if head == RESTRAINER and number.isdigit() else slot


def known_kind(of: type) -> type | None:
    """Give the nearest class, among a class and its ancestors, that scenes know."""
    return next((kind for kind in of.__mro__ if kind in _KINDS), None)


def slot_of_kind(of: type) -> str | None:
    """Give the slot that parts of a class fill; None if they are no parts."""
    kind = known_kind(of)
    return None if kind is None else _KINDS[kind].slot


def usual_kind(slot: str) -> type:
    """Give the class of parts that fills a slot unless another is named."""
    return next(kind for kind, known in _KINDS.items() if known.slot == slot)


def support_of(part: Component, load: BaseLoad) -> Support:
    """Give a base as it is under a body."""
    kind = known_kind(type(part))
    make = None if kind is None else _KINDS[kind].support
    if make is None:  # only bases are in the slots of bases
        raise TypeError
    return make(part, load)


def _beyond_models(part: Component, known: type) -> list[str]:
    """Refuse a part that adds to a class which scenes know something that they do not."""
    own = type(part)
    # parameters; a property of the same name is none
    declared, expected = (
        {
            name
            for name in vars(part.given)
            if isinstance(getattr_static(kind, name, None), Declared)
        }
        for kind in (own, known)
    )
    added = sorted(declared - expected)
    if added:
        return [
            f"{own.__name__} adds {' and '.join(added)} to {known.__name__}, of which no model "
            f"knows; it would be simulated as a {known.__name__}"
        ]
    between = own.__mro__[: own.__mro__.index(known)]
    if any("support" in vars(kind) for kind in between):
        return [f"{own.__name__} carries a body in its own way, but {_to_register(own)}"]
    return []


def hint_for(part: object) -> str:
    """Say what something that is no part lacks to be one; nothing if that is not known."""
    if isinstance(part, type) and known_kind(part) is not None:
        return "; it is the class itself: call it with its values"
    if isinstance(part, OwnBase):
        return f"; it {_to_register(type(part))}"
    if isinstance(part, Component):
        return "; no scene that is registered is made of it"
    return ""


def _to_register(kind: type) -> str:
    if issubclass(kind, OwnBase):
        return f"is not registered; call rockframe.register({kind.__name__}) first"
    return "is no OwnBase; derive it from rockframe.extension.OwnBase, and register it"


@dataclass(frozen=True)
class Parts:
    """The parts of a scene, by what they are; None where there is none of a kind."""

    # slots and what fills them, in the order of all slots
    filled: tuple[tuple[str, Component | GroundMotion], ...] = ()
    # the same apart: parts that are no motion by their slots, and those of the package's own kinds
    components: dict[str, Component] = field(init=False, repr=False, compare=False)
    # those in slots that scenes of users' own have, by these; links between points of bodies,
    # ground and walls, loads behind the others; and names of the parts that are no motion: rigid
    # ground goes without saying, and an elastic wall is a link
    own: dict[str, Component] = field(init=False, repr=False, compare=False)
    links: tuple[Link, ...] = field(init=False, repr=False, compare=False)
    signature: frozenset[str] = field(init=False, repr=False, compare=False)
    block: Block | None = field(init=False, repr=False, compare=False)
    stack: Stack | None = field(init=False, repr=False, compare=False)
    frame: RockingFrame | None = field(init=False, repr=False, compare=False)
    pads: Component | None = field(init=False, repr=False, compare=False)
    cap: CushionCap | None = field(init=False, repr=False, compare=False)
    soil: Component | None = field(init=False, repr=False, compare=False)
    ground: RigidGround | None = field(init=False, repr=False, compare=False)
    wall: RearWall | None = field(init=False, repr=False, compare=False)
    motion: GroundMotion | None = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        found = dict(self.filled)
        vars(self).update({slot: found.get(slot) for slot in SHIPPED if slot != RESTRAINER})
        components = {slot: part for slot, part in found.items() if slot != "motion"}
        kinds = {slot: kind_of_slot(slot) for slot in components}
        stiff = self.wall if self.wall is not None and not self.wall.elastic else None
        links = [one for one in components.values() if isinstance(one, Link) and one is not stiff]
        signature = frozenset(kinds.values()) - {"ground"}
        if self.wall is not stiff:
            signature = signature - {"wall"} | {RESTRAINER}
        vars(self).update(
            components=components,
            own={slot: components[slot] for slot, kind in kinds.items() if kind not in SHIPPED},
            links=tuple(sorted(links, key=lambda part: isinstance(part, Load))),
            signature=signature,
        )

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
        found = dict(self.filled)
        if slot not in found:
            known = ", ".join(map(repr, found))
            near = nearest(slot, found) or ";"
            msg = f"the scene has no part {shown(slot)}{near} It has {known}"
            raise LabelError(msg)
        return cast("Component", found[slot])

    def __iter__(self) -> Iterator[Component | GroundMotion]:
        """Give the parts, in a fixed order."""
        return (part for _, part in self.filled)

    def __len__(self) -> int:
        return len(self.filled)

    def changed(self, **by_slot: Component | GroundMotion | None) -> "Parts":
        """Give the parts with others in some slots."""
        return Parts.of({**dict(self.filled), **by_slot})

    def structural(self) -> list[Component]:
        """Give the parts that are no motion, in a fixed order."""
        return list(self.components.values())

    def standing(self) -> "Parts":
        """Give the parts with the rigid ground on which bodies stand when no base is given."""
        bases = {"pads", "soil", "ground"}.intersection(self.components)
        return self if bases or self.own else self.changed(ground=RigidGround())

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
    def the_cap(self) -> Cap:
        """The cap in the size it has under the block, in a scene that has one."""
        if self.cap is None:
            raise TypeError
        return cap_under(self.the_block, self.cap.si)


def sort_parts(given: Sequence[object], faults: list[str]) -> Parts:
    """Put each part in its slot; note doubled parts and things that are no parts."""
    found: dict[str, Any] = {}
    for part in given:
        kind = known_kind(type(part))
        if kind is None:
            faults.append(f"{shown(part)} is not a part of a system{hint_for(part)}")
            continue
        slot = _KINDS[kind].slot
        if slot == RESTRAINER:
            count = sum(kind_of_slot(one) == RESTRAINER for one in found)
            slot = numbered(slot, count + 1)
        elif slot in found:
            name = type(part).__name__
            faults.append(f"{name} is given twice: {shown(found[slot])} and {shown(part)}")
            continue
        found[slot] = part
        if kind is not type(part) and isinstance(part, Component):
            faults += _beyond_models(part, kind)
    return Parts.of(found)
