"""Sorting a system's parts, whatever their order."""

from collections.abc import Sequence
from dataclasses import dataclass

from rockframe.components import (
    Block,
    Component,
    CushionCap,
    RigidGround,
    TwoSpringSupport,
    WinklerSoil,
)
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
    return Parts(**found)  # type: ignore[arg-type]
