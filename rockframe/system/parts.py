"""The parts of a scene by their slots, such as block, pads, soil and ground."""

import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
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
from rockframe.components.bases import Impact
from rockframe.components.block_numbers import BlockSI
from rockframe.components.parameters import Declared
from rockframe.errors import AssemblyError, LabelError, did_you_mean, short_repr
from rockframe.motion import GroundMotion
from rockframe.system.bodies import NO_SLIP, BaseFriction, BaseLoad, Cap, block_cap
from rockframe.system.options import Options, Sliding
from rockframe.system.own_base import OwnBase
from rockframe.system.support import RigidBase, Support, bed_under, pads_under


@dataclass(frozen=True)
class PartKind:
    """The slot of a class of parts and, if it is a base, its support."""

    slot: str  # slot that its parts fill
    # for a base, the function that gives its support from the part and the load on it
    support: Callable[[Any, BaseLoad], Support] | None = None


_KINDS: Final[dict[type, PartKind]] = {
    Block: PartKind("block"),
    FrameEquivalent: PartKind("block"),
    Stack: PartKind("stack"),
    RockingFrame: PartKind("frame"),
    TwoSpringSupport: PartKind("pads", pads_under),
    CushionCap: PartKind("cap"),
    WinklerSoil: PartKind("soil", bed_under),
    RigidGround: PartKind("ground", lambda _, load: RigidBase(load)),
    RearWall: PartKind("wall"),
    Restrainer: PartKind("restrainer"),
    Tendon: PartKind("restrainer"),
    Load: PartKind("restrainer"),
    GroundMotion: PartKind("motion"),
}

RESTRAINER: Final = "restrainer"
"""The slot of links other than walls."""
WALL: Final = "wall"
SLOTS_OF_SEVERAL: Final = (RESTRAINER, WALL)
"""Slots that several parts may fill; the slots of all but the first have a number."""
BUILTIN_SLOTS: Final = tuple(dict.fromkeys(kind.slot for kind in _KINDS.values()))
"""Slots of the package's own parts, in a fixed order; `motion` is the last."""
INFINITE_COEFFICIENT: Final = 1e8
"""Coefficient of friction that counts as infinite: a body would slip only under normal forces
below the rounding errors of weights."""


def slots() -> tuple[str, ...]:
    """Return all slots in a fixed order: slots of user-defined scenes come before `motion`."""
    own = sorted({kind.slot for kind in _KINDS.values()} - set(BUILTIN_SLOTS))
    return (*BUILTIN_SLOTS[:-1], *own, BUILTIN_SLOTS[-1])


def add_part_class(of: type, kind: PartKind) -> None:
    """Add a class of user-defined parts: a link, a base, or a part of a user-defined scene."""
    _KINDS[of] = kind


def unnumbered_slot(slot: str) -> str:
    """Return a slot without its number: `restrainer` for `restrainer_2`."""
    head, _, number = slot.rpartition("_")
    return head if head in SLOTS_OF_SEVERAL and number.isdigit() else slot


def registered_class(of: type) -> type | None:
    """Return the nearest class, among a class and its ancestors, that is registered for scenes."""
    return next((kind for kind in of.__mro__ if kind in _KINDS), None)


def slot_of_class(of: type) -> str | None:
    """Return the slot that parts of a class fill; None if they are not parts."""
    kind = registered_class(of)
    return None if kind is None else _KINDS[kind].slot


def default_class(slot: str) -> type:
    """Return the class of parts that fills a slot unless another is named."""
    return next(kind for kind, known in _KINDS.items() if known.slot == slot)


def support_of(part: Component, load: BaseLoad) -> Support:
    """Return the support that a base forms under a body."""
    kind = registered_class(type(part))
    make = None if kind is None else _KINDS[kind].support
    if make is None:  # only bases are in the slots of bases
        raise TypeError
    support: Any = make(part, load)
    if not isinstance(support, Support):
        msg = f"{type(part).__name__}.support must return a Support, got {short_repr(support)}"
        raise AssemblyError([msg])
    return support


def base_friction(part: Component, options: Options) -> BaseFriction | None:
    """Return the friction of a base; None if nothing slips on it."""
    static = getattr(part.si, "friction", None)
    if static is None or options.sliding is Sliding.CHECKED or isinstance(part, OwnBase):
        return None
    kinetic = static if part.si.kinetic_friction is None else part.si.kinetic_friction
    rigid = isinstance(part, RigidGround)
    if kinetic >= INFINITE_COEFFICIENT and not rigid:
        return NO_SLIP
    sticks = rigid and part.si.impact is Impact.STICK
    return BaseFriction(static, kinetic, math.inf if sticks else kinetic)


def _subclass_faults(part: Component, known: type) -> list[str]:
    """Return the faults of a part of a derived class whose additions no scene would use."""
    own = type(part)
    # declared parameters only: a property of the same name is none
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
        return [f"{own.__name__} carries a body in its own way, but {_registration_hint(own)}"]
    return []


def unknown_part_fault(part: object) -> str:
    """Say that something is not a part, and how to make one of it if that is known."""
    hint = ""
    if isinstance(part, type) and registered_class(part) is not None:
        hint = "; it is the class itself: call it with its values"
    elif isinstance(part, OwnBase | Link):
        hint = f"; it {_registration_hint(type(part))}"
    elif isinstance(part, Component):
        hint = "; no scene that is registered is made of it"
    return f"{short_repr(part)} is not a part of a system{hint}"


def check_registered(parts: Iterable[Component | GroundMotion | None]) -> None:
    """Refuse parts of classes that another process has registered, and this one has not."""
    strangers = [
        part for part in parts if part is not None and registered_class(type(part)) is None
    ]
    if strangers:
        raise AssemblyError([unknown_part_fault(part) for part in strangers])


def _registration_hint(kind: type) -> str:
    if issubclass(kind, OwnBase | Link):
        call = f"call rockframe.register({kind.__name__})"
        return f"is not registered in this process; {call} beside the class"
    return "is no OwnBase; derive it from rockframe.extension.OwnBase, and register it"


def link_labels(parts: Sequence[Link]) -> list[str]:
    """Return the names of links in results: their own, or a number; a wall may be the only one."""
    walls = [part for part in parts if isinstance(part, RearWall) and not part.si.name]
    labels = list[str]()
    for i, part in enumerate(parts, 1):
        label = f"{'load' if isinstance(part, Load) else 'restrainer'} {i}"
        if isinstance(part, RearWall):
            before = sum(isinstance(other, RearWall) and not other.si.name for other in parts[:i])
            label = WALL if len(walls) == 1 else f"{WALL} {before}"
        labels.append(part.si.name or label)
    return labels


@dataclass(frozen=True)
class Parts:
    """The parts of a scene by their slots; a shipped slot that is empty is None."""

    # slots and the parts that fill them, in the order of all slots
    filled: tuple[tuple[str, Component | GroundMotion], ...] = ()
    # all parts but the motion, by their slots
    components: dict[str, Component] = field(init=False, repr=False, compare=False)
    # own: parts in slots of users' own scenes, by slots; walls: all walls, rigid_wall: the first of
    # them that is not elastic; links: all links, elastic walls among them, loads last; signature:
    # names of the filled slots without numbers, motion and ground, elastic walls counting as
    # restrainers; then the parts in the shipped slots
    own: dict[str, Component] = field(init=False, repr=False, compare=False)
    walls: tuple[RearWall, ...] = field(init=False, repr=False, compare=False)
    rigid_wall: RearWall | None = field(init=False, repr=False, compare=False)
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
        slots = dict(self.filled)
        vars(self).update({slot: slots.get(slot) for slot in BUILTIN_SLOTS if slot != RESTRAINER})
        components = {slot: part for slot, part in slots.items() if slot != "motion"}
        kinds = {slot: unnumbered_slot(slot) for slot in components}
        walls = tuple(part for part in components.values() if isinstance(part, RearWall))
        rigid = [wall for wall in walls if not wall.elastic]
        links = [
            component
            for component in components.values()
            if isinstance(component, Link) and component not in rigid
        ]
        signature = frozenset(kinds.values()) - {"ground"}
        if walls and not rigid:
            signature = signature - {WALL} | {RESTRAINER}
        vars(self).update(
            components=components,
            own={
                slot: components[slot] for slot, kind in kinds.items() if kind not in BUILTIN_SLOTS
            },
            walls=walls,
            rigid_wall=rigid[0] if rigid else None,
            links=tuple(sorted(links, key=lambda part: isinstance(part, Load))),
            signature=signature,
        )

    @classmethod
    def of(cls, by_slot: Mapping[str, Component | GroundMotion | None]) -> "Parts":
        """Make parts from a mapping by slots, in any order; None leaves a slot empty."""
        check_registered(by_slot.values())
        order = {slot: i for i, slot in enumerate(slots())}
        values = [slot for slot, part in by_slot.items() if part is not None]
        # several parts of one slot keep their order
        values.sort(key=lambda slot: order[unnumbered_slot(slot)])
        return cls(tuple((slot, by_slot[slot]) for slot in values))  # type: ignore[misc]

    def __getitem__(self, slot: str) -> Component:
        """Return the part in a slot; LabelError if it is empty."""
        slots = dict(self.filled)
        if slot not in slots:
            known = ", ".join(map(repr, slots))
            near = did_you_mean(slot, slots) or "."
            msg = f"the scene has no part {short_repr(slot)}{near} It has {known}"
            raise LabelError(msg)
        return cast("Component", slots[slot])

    def __iter__(self) -> Iterator[Component | GroundMotion]:
        """Return the parts, in a fixed order."""
        return (part for _, part in self.filled)

    def __len__(self) -> int:
        return len(self.filled)

    def replace(self, **by_slot: Component | GroundMotion | None) -> "Parts":
        """Return the parts with others in the given slots; None empties a slot."""
        return Parts.of({**dict(self.filled), **by_slot})

    def structural(self) -> list[Component]:
        """Return the parts other than motions, in a fixed order."""
        return list(self.components.values())

    def with_ground(self) -> "Parts":
        """Return the parts, with rigid ground if no base is given."""
        bases = {"pads", "soil", "ground"}.intersection(self.components)
        return self if bases or self.own else self.replace(ground=RigidGround())

    @property
    def named_links(self) -> list[tuple[str, Link]]:
        """All links with their names in results."""
        return list(zip(link_labels(self.links), self.links, strict=True))

    @property
    def block_si(self) -> BlockSI:
        """The numbers of the block; of the highest block of a stack, or of a column of a frame."""
        if self.stack is not None:
            return self.stack.si.bodies[0]
        if self.frame is not None:
            return self.frame.si.column
        if self.block is None:
            raise TypeError
        return self.block.si

    @property
    def cap_si(self) -> Cap:
        """The cap in SI units, in a scene that has one."""
        if self.cap is None:
            raise TypeError
        return block_cap(self.block_si, self.cap.si)


def sort_parts(values: Sequence[object], faults: list[str]) -> Parts:
    """Put each part in its slot; duplicates, and objects that are not parts, become faults."""
    slots: dict[str, Any] = {}
    for part in values:
        kind = registered_class(type(part))
        if kind is None:
            faults.append(unknown_part_fault(part))
            continue
        slot = _KINDS[kind].slot
        if slot in SLOTS_OF_SEVERAL:
            count = sum(unnumbered_slot(filled) == slot for filled in slots)
            slot = f"{slot}_{count + 1}" if count else slot
        elif slot in slots:
            name = type(part).__name__
            faults.append(
                f"{name} is given twice: {short_repr(slots[slot])} and {short_repr(part)}"
            )
            continue
        slots[slot] = part
        if kind is not type(part) and isinstance(part, Component):
            faults += _subclass_faults(part, kind)
    return Parts.of(slots)
