"""The table of scenes: which slots make which scene."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial
from typing import Final

from rockframe.components import Component, RigidGround
from rockframe.errors import AssemblyError
from rockframe.system.alone import AloneSetting
from rockframe.system.bodies import BaseLoad, load_of, one_body
from rockframe.system.options import Coupling, Options
from rockframe.system.own_scene import OwnScene
from rockframe.system.parts import RESTRAINER, Parts, support_of
from rockframe.system.rear_wall import rear_wall_setting
from rockframe.system.rocking_frame import rocking_frame_setting
from rockframe.system.setting import Setting
from rockframe.system.sliding_base import alone_on, stack_on
from rockframe.system.sliding_ground import rigid_ground_setting
from rockframe.system.stack import StackSetting, block_setting, stack_setting
from rockframe.system.stacked import CascadeSetting, CoupledSetting, StackedSetting
from rockframe.system.tied_sliding import tied_on_ground


@dataclass(frozen=True)
class Scene:
    """A combination of parts that has a model."""

    title: str  # the parts, as users write them
    signature: frozenset[str]  # slots of :class:`rockframe.system.parts.Parts` that must be filled
    # from parts and options to the scene's setting
    make_setting: Callable[[Parts, Options], Setting]
    # the option that picks this one of two models of the same parts
    coupling: Coupling | None = None
    # slots and classes of the parts of a user's own scene
    made_of: Mapping[str, type[Component]] | None = None

    def fits(self, parts: Parts, coupling: Coupling) -> bool:
        """Whether the scene is that of the parts."""
        if self.made_of is None:
            return self.signature == parts.signature and self.coupling in (None, coupling)
        given, kinds = parts.components, self.made_of
        return given.keys() == kinds.keys() and all(
            isinstance(part, kinds[slot]) for slot, part in given.items()
        )


def _held(slot: str, parts: Parts, options: Options) -> AloneSetting:
    """Put a block on the base in a slot, which holds it."""
    load = load_of(parts.the_block, options)
    return AloneSetting(load, support_of(parts[slot], load))


def _held_with_cap(parts: Parts, options: Options) -> AloneSetting:
    """Put block and cap as one body on the soil, which holds it."""
    cap = parts.the_cap
    load = BaseLoad(one_body(parts.the_block, cap), options)
    offset = cap.half_height - load.body.centre_height
    return AloneSetting(load, support_of(parts["soil"], load), cap_offset=offset)


def _alone(slot: str, parts: Parts, options: Options) -> AloneSetting:
    """Put a block on the base in a slot."""
    return alone_on(parts[slot], _held(slot, parts, options))


def _with_cap(parts: Parts, options: Options) -> AloneSetting:
    """Put block and cap as one body on the soil."""
    return alone_on(parts["soil"], _held_with_cap(parts, options))


def _refuse_twins(parts: Parts, upper: AloneSetting, lower: AloneSetting) -> None:
    """Refuse two bases that show the same column, which would hide one of them."""
    shown = [
        {column.name for column in each.support.base_numbers.columns} for each in (upper, lower)
    ]
    twins = sorted(shown[0] & shown[1])
    if twins:
        pads, soil = (type(parts[slot]).__name__ for slot in ("pads", "soil"))
        fault = f"{pads} and {soil} both show {' and '.join(twins)}; give those of one other names"
        raise AssemblyError([fault])


def _stacked(kind: type[StackedSetting], parts: Parts, options: Options) -> StackedSetting:
    """Put a block on pads on a cap on soil."""
    upper, lower = _held("pads", parts, options), _held_with_cap(parts, options)
    _refuse_twins(parts, upper, lower)
    cap = parts.the_cap
    return kind(upper.load, upper, lower, cap)


def _upon_one_another(slot: str, parts: Parts, options: Options) -> StackSetting:
    """Put a stack, or a block with restrainers, on the base in a slot."""
    base = parts.components.get(slot, RigidGround())
    if parts.stack is not None:
        held = stack_setting(parts.stack, base, options, parts.links)
        return stack_on((*parts.stack.interfaces, base), held)
    held = block_setting(parts.the_block, base, options, parts.links)
    if isinstance(base, RigidGround):
        return tied_on_ground(base, held)
    return stack_on((base,), held)


_STACK = frozenset({"block", "pads", "cap", "soil"})

_SHIPPED: Final = (
    Scene(
        "Block (on rigid ground; RigidGround(...) to choose its restitution, or friction)",
        frozenset({"block"}),
        rigid_ground_setting,
    ),
    Scene("Block + RearWall (on rigid ground)", frozenset({"block", "wall"}), rear_wall_setting),
    Scene("Block + TwoSpringSupport", frozenset({"block", "pads"}), partial(_alone, "pads")),
    Scene("Block + WinklerSoil", frozenset({"block", "soil"}), partial(_alone, "soil")),
    Scene(
        "Block + CushionCap + WinklerSoil (block and cap as one body)",
        frozenset({"block", "cap", "soil"}),
        _with_cap,
    ),
    Scene(
        "Block + TwoSpringSupport + CushionCap + WinklerSoil, coupling='coupled'",
        _STACK,
        partial(_stacked, CoupledSetting),
        Coupling.COUPLED,
    ),
    Scene(
        "Block + TwoSpringSupport + CushionCap + WinklerSoil, coupling='cascade'",
        _STACK,
        partial(_stacked, CascadeSetting),
        Coupling.CASCADE,
    ),
    Scene("RockingFrame (on rigid ground)", frozenset({"frame"}), rocking_frame_setting),
    Scene(
        "RockingFrame + Tendon (one or several)",
        frozenset({"frame", RESTRAINER}),
        rocking_frame_setting,
    ),
    Scene("Stack (on rigid ground)", frozenset({"stack"}), partial(_upon_one_another, "ground")),
    Scene(
        "Stack + TwoSpringSupport",
        frozenset({"stack", "pads"}),
        partial(_upon_one_another, "pads"),
    ),
    Scene("Stack + WinklerSoil", frozenset({"stack", "soil"}), partial(_upon_one_another, "soil")),
    *(
        Scene(
            f"{upper} + {lower}Restrainer (one or several)",
            frozenset({slot, under, RESTRAINER}) - {"ground"},
            partial(_upon_one_another, under),
        )
        for upper, slot in (("Block", "block"), ("Stack", "stack"))
        for lower, under in (
            ("", "ground"),
            ("TwoSpringSupport + ", "pads"),
            ("WinklerSoil + ", "soil"),
        )
    ),
)


_OWN: Final[dict[str, Scene]] = {}
"""Scenes of users' own, by the full names of their classes."""


def scenes() -> tuple[Scene, ...]:
    """Give all scenes, those of users' own last."""
    return (*_SHIPPED, *_OWN.values())


def add_scene(kind: type[OwnScene]) -> None:
    """Make a user's own scene known; it takes the place of one whose class had its full name."""
    title = " + ".join(part.__name__ for part in kind.made_of.values())
    name = f"{kind.__module__}.{kind.__qualname__}"
    _OWN[name] = Scene(
        f"{title} ({kind.__name__})",
        frozenset(kind.made_of),
        partial(_own, kind),
        made_of=kind.made_of,
    )


def twin_of(kind: type[OwnScene]) -> str | None:
    """Give the title of another scene that is made of the same parts, if there is one."""
    own = f"{kind.__module__}.{kind.__qualname__}"
    titles = (
        scene.title
        for name, scene in _OWN.items()
        if name != own and scene.made_of == dict(kind.made_of)
    )
    return next(titles, None)


def _own(kind: type[OwnScene], parts: Parts, options: Options) -> OwnScene:
    """Make the setting of a user's own scene."""
    found = kind(load_of(parts.the_block, options), parts)
    faults = found.misfits()
    if faults:
        raise AssemblyError(faults)
    return found
