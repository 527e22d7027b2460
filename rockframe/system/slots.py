"""Which component fills which slot of a scene, and what it is under a body."""

from collections.abc import Callable
from dataclasses import dataclass
from inspect import getattr_static
from typing import Any, Final

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
from rockframe.components.parameters import Declared
from rockframe.motion import GroundMotion
from rockframe.system.load import BaseLoad
from rockframe.system.own_base import OwnBase
from rockframe.system.pads import pads_under
from rockframe.system.rigid_base import rigid_under
from rockframe.system.soil import bed_under
from rockframe.system.support import Support


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
    RigidGround: Kind("ground", rigid_under),
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


def add_base(kind: type[OwnBase]) -> None:
    """Make a user's own base known."""
    _KINDS[kind] = Kind(kind.slot, kind.support)


def add_link(kind: type[Link]) -> None:
    """Make a user's own link known."""
    _KINDS[kind] = Kind(RESTRAINER)


def numbered(slot: str, number: int) -> str:
    """Give the slot of one of several parts of a kind, counted from 1."""
    return slot if number == 1 else f"{slot}_{number}"


def kind_of_slot(slot: str) -> str:
    """Give the slot of a kind of which there may be several parts."""
    head, _, number = slot.rpartition("_")
    return head if head == RESTRAINER and number.isdigit() else slot


def add_part(kind: type[Component], slot: str) -> None:
    """Make a part of a user's own scene known."""
    _KINDS[kind] = Kind(slot)


def known_kind(of: type) -> type | None:
    """Give the nearest class, among a class and its ancestors, that scenes know."""
    return next((kind for kind in of.__mro__ if kind in _KINDS), None)


def slot_of(part: object) -> str | None:
    """Give the slot that a part fills; None if it is no part."""
    return slot_of_kind(type(part))


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


def beyond_models(part: object) -> list[str]:
    """Refuse a part that adds to a class which scenes know something that they do not."""
    known = known_kind(type(part))
    if known is None or not isinstance(part, Component):
        return []
    own = type(part)
    added = sorted(
        name for name in vars(part.given) if _declares(own, name) and not _declares(known, name)
    )
    if added:
        return [
            f"{own.__name__} adds {' and '.join(added)} to {known.__name__}, of which no model "
            f"knows; it would be simulated as a {known.__name__}"
        ]
    between = own.__mro__[: own.__mro__.index(known)]
    if any("support" in vars(kind) for kind in between):
        return [f"{own.__name__} carries a body in its own way, but {_to_register(own)}"]
    return []


def _declares(kind: type, name: str) -> bool:
    """Whether a class has a parameter of a name; a property of that name is none."""
    return isinstance(getattr_static(kind, name, None), Declared)


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
