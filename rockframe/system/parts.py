"""Sorting a system's parts, whatever their order."""

from collections.abc import Sequence
from dataclasses import dataclass
from inspect import getattr_static

from rockframe.components import (
    Block,
    Component,
    CushionCap,
    FrameEquivalent,
    RigidGround,
    TwoSpringSupport,
    WinklerSoil,
)
from rockframe.components.parameters import Declared
from rockframe.errors import shown
from rockframe.motion import GroundMotion


@dataclass(frozen=True)
class Parts:
    """The parts of a scene, by what they are; absent ones are None."""

    block: Block | None = None
    pads: TwoSpringSupport | None = None
    cap: CushionCap | None = None
    soil: WinklerSoil | None = None
    ground: RigidGround | None = None
    motion: GroundMotion | None = None

    def given(self) -> list[Component | GroundMotion]:
        """Give the parts that are there, in a fixed order."""
        return [part for part in vars(self).values() if part is not None]

    def structural(self) -> list[Component]:
        """Give the parts that are no motion, in a fixed order."""
        return [part for part in self.given() if not isinstance(part, GroundMotion)]

    @property
    def signature(self) -> frozenset[str]:
        """Names of the structural parts that are there; rigid ground goes without saying."""
        names = {name for name, part in vars(self).items() if part is not None}
        return frozenset(names - {"motion", "ground"})


_SLOTS: dict[type, str] = {
    Block: "block",
    TwoSpringSupport: "pads",
    CushionCap: "cap",
    WinklerSoil: "soil",
    RigidGround: "ground",
    GroundMotion: "motion",
}

_MODULES = {kind.__module__ for kind in (*_SLOTS, FrameEquivalent)}
"""Modules of the parts that the models are written for."""


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
        slot = next((slot for kind, slot in _SLOTS.items() if isinstance(part, kind)), None)
        if slot is None:
            is_class = isinstance(part, type) and issubclass(part, tuple(_SLOTS))
            hint = "; it is the class itself: call it with its values" if is_class else ""
            faults.append(f"{shown(part)} is not a part of a system{hint}")
        elif slot in found:
            name = type(part).__name__
            faults.append(f"{name} is given twice: {shown(found[slot])} and {shown(part)}")
        else:
            found[slot] = part
            faults += _beyond_models(part)
    return Parts(**found)  # type: ignore[arg-type]


def _beyond_models(part: object) -> list[str]:
    """Refuse a part with parameters that its class has added to one that the models know."""
    if not isinstance(part, Component):
        return []
    known = next(kind for kind in type(part).__mro__ if kind.__module__ in _MODULES)
    added = sorted(
        name
        for name in vars(part.given)
        if _declares(type(part), name) and not _declares(known, name)
    )
    if not added:
        return []
    return [
        f"{type(part).__name__} adds {' and '.join(added)} to {known.__name__}, of which no model "
        f"knows; it would be simulated as a {known.__name__}"
    ]


def _declares(kind: type, name: str) -> bool:
    """Whether a class has a parameter of a name; a property of that name is none."""
    return isinstance(getattr_static(kind, name, None), Declared)
