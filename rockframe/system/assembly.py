"""Assembly: parts and options checked together, and the table of scenes that they make."""

import json
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property, partial
from typing import Final

from rockframe.components import Component, RigidGround
from rockframe.dynamics.protocol import ContactModel
from rockframe.errors import AssemblyError
from rockframe.system.block_on_cap import (
    BlockOnCapSetting,
    CascadeSetting,
    CoupledSetting,
    SlidingCoupledSetting,
)
from rockframe.system.bodies import NO_SLIP, BaseLoad, block_with_cap, load_of
from rockframe.system.compatibility import (
    combination_faults,
    depth_cautions,
    outside_point_cautions,
    size_faults,
    unused_option_cautions,
)
from rockframe.system.options import (
    SLIDING_AT_SMALL_ROTATION,
    Coupling,
    Options,
    Restraint,
    Rotation,
    Sliding,
    read_option,
    read_option_number,
)
from rockframe.system.own_base import OwnBase
from rockframe.system.own_scene import OwnScene
from rockframe.system.parts import (
    RESTRAINER,
    Parts,
    base_friction,
    check_registered,
    sort_parts,
    support_of,
)
from rockframe.system.rear_wall import rear_wall_setting
from rockframe.system.rigid_ground import rigid_ground_setting
from rockframe.system.rocking_frame import rocking_frame_setting
from rockframe.system.setting import Setting, describe
from rockframe.system.single_body import SingleBodySetting, SlidingBodySetting
from rockframe.system.stack import StackSetting, refuse_options, stack_setting


@dataclass(frozen=True)
class Scene:
    """A combination of parts that has a model, a row of the table of scenes."""

    title: str  # the parts, as users write them
    signature: frozenset[str]  # slots of :class:`rockframe.system.parts.Parts` that must be filled
    # function that gives the scene's setting from parts and options
    make_setting: Callable[[Parts, Options], Setting]
    # value of the option that selects this scene among two of the same parts
    coupling: Coupling | None = None
    # slots and classes of the parts of a user's own scene
    made_of: Mapping[str, type[Component]] | None = None

    def fits(self, parts: Parts, coupling: Coupling) -> bool:
        """Whether the parts make this scene."""
        if self.made_of is None:
            return self.signature == parts.signature and self.coupling in (None, coupling)
        present, kinds = parts.components, self.made_of
        return present.keys() == kinds.keys() and all(
            isinstance(part, kinds[slot]) for slot, part in present.items()
        )


def _block_on_base(slot: str, parts: Parts, options: Options) -> SingleBodySetting:
    """Put a block on a base without slip; block and cap on soil are one body."""
    if slot != "soil" or parts.cap is None:
        load = load_of(parts.block_si, options)
        return SingleBodySetting(load, support_of(parts[slot], load))
    cap = parts.cap_si
    load = BaseLoad(block_with_cap(parts.block_si, cap), options)
    offset = cap.half_height - load.body.centre_height
    return SingleBodySetting(load, support_of(parts[slot], load), cap_offset=offset)


def _single_body(slot: str, parts: Parts, options: Options) -> SingleBodySetting:
    """Put a block on a base, on which it slips if that has friction."""
    held, friction = _block_on_base(slot, parts, options), base_friction(parts[slot], options)
    if friction is None:
        return held
    if options.small:
        raise AssemblyError([SLIDING_AT_SMALL_ROTATION])
    return SlidingBodySetting(held.load, held.support, friction, cap_offset=held.cap_offset)


def _block_on_cap(
    kind: type[BlockOnCapSetting], parts: Parts, options: Options
) -> BlockOnCapSetting:
    """Put a block on pads on a cap on soil; of two columns of the same name one would be lost."""
    upper, lower = (_block_on_base(slot, parts, options) for slot in ("pads", "soil"))
    pads, soil = (
        {column.name for column in body.support.base_numbers.columns} for body in (upper, lower)
    )
    if shared := sorted(pads & soil):
        both = " and ".join(type(parts[slot]).__name__ for slot in ("pads", "soil"))
        fault = f"{both} both show {' and '.join(shared)}; give those of one other names"
        raise AssemblyError([fault])
    return kind(upper.load, upper, lower, parts.cap_si)


def _coupled_block_on_cap(parts: Parts, options: Options) -> BlockOnCapSetting:
    """Put a block on pads on a cap on soil; block and cap slip where their bases have friction."""
    held, bases = _block_on_cap(CoupledSetting, parts, options), (parts["pads"], parts["soil"])
    pads, soil = (base_friction(base, options) for base in bases)
    own = any(isinstance(base, OwnBase) for base in bases)  # these do not slip
    if own or (pads is None and soil is None):
        return held
    if options.small:
        raise AssemblyError([SLIDING_AT_SMALL_ROTATION])
    return SlidingCoupledSetting(
        held.load, held.upper, held.lower, held.cap, frictions=(pads or NO_SLIP, soil or NO_SLIP)
    )


def _stack(slot: str, parts: Parts, options: Options) -> StackSetting:
    """Put a stack, or a block with restrainers, on the base in a slot."""
    base, stack = parts.components.get(slot, RigidGround()), parts.stack
    if stack is None:
        refuse_options("a block with restrainers", options, small=False)
        blocks, offsets, bases = (parts.block_si,), (0.0,), (base,)
    else:
        refuse_options("a Stack", options, small=not parts.links)
        blocks, offsets, bases = stack.si.bodies, stack.si.offsets, (*stack.interfaces, base)
    return stack_setting(blocks, offsets, bases, options, parts.links)


_BLOCK_ON_CAP = frozenset({"block", "pads", "cap", "soil"})

_BUILTIN_SCENES: Final = (
    Scene(
        "Block (on rigid ground; RigidGround(...) to choose its restitution, or friction)",
        frozenset({"block"}),
        rigid_ground_setting,
    ),
    Scene("Block + RearWall (on rigid ground)", frozenset({"block", "wall"}), rear_wall_setting),
    Scene("Block + TwoSpringSupport", frozenset({"block", "pads"}), partial(_single_body, "pads")),
    Scene("Block + WinklerSoil", frozenset({"block", "soil"}), partial(_single_body, "soil")),
    Scene(
        "Block + CushionCap + WinklerSoil (block and cap as one body)",
        frozenset({"block", "cap", "soil"}),
        partial(_single_body, "soil"),
    ),
    Scene(
        "Block + TwoSpringSupport + CushionCap + WinklerSoil, coupling='coupled'",
        _BLOCK_ON_CAP,
        _coupled_block_on_cap,
        Coupling.COUPLED,
    ),
    Scene(
        "Block + TwoSpringSupport + CushionCap + WinklerSoil, coupling='cascade'",
        _BLOCK_ON_CAP,
        partial(_block_on_cap, CascadeSetting),
        Coupling.CASCADE,
    ),
    Scene("RockingFrame (on rigid ground)", frozenset({"frame"}), rocking_frame_setting),
    Scene(
        "RockingFrame + Tendon (one or several)",
        frozenset({"frame", RESTRAINER}),
        rocking_frame_setting,
    ),
    Scene("Stack (on rigid ground)", frozenset({"stack"}), partial(_stack, "ground")),
    Scene("Stack + TwoSpringSupport", frozenset({"stack", "pads"}), partial(_stack, "pads")),
    Scene("Stack + WinklerSoil", frozenset({"stack", "soil"}), partial(_stack, "soil")),
    *(
        Scene(
            "Block or Stack (on rigid ground, TwoSpringSupport or WinklerSoil) + Restrainer, "
            "Tendon, Load, elastic RearWall (one or several)",
            frozenset({slot, under, RESTRAINER}) - {"ground"},
            partial(_stack, under),
        )
        for slot in ("block", "stack")
        for under in ("ground", "pads", "soil")
    ),
)


_USER_SCENES: Final[dict[str, Scene]] = {}
"""Scenes that users have registered, by the full names of their classes."""


def scenes() -> tuple[Scene, ...]:
    """Return all scenes, user-defined scenes last."""
    return (*_BUILTIN_SCENES, *_USER_SCENES.values())


def add_scene(kind: type[OwnScene]) -> None:
    """Add a user-defined scene to the table; it replaces one whose class has the same full name."""
    title = " + ".join(part.__name__ for part in kind.made_of.values())
    name = f"{kind.__module__}.{kind.__qualname__}"
    _USER_SCENES[name] = Scene(
        f"{title} ({kind.__name__})",
        frozenset(kind.made_of),
        partial(_user_scene, kind),
        made_of=kind.made_of,
    )


def scene_of_same_parts(kind: type[OwnScene]) -> str | None:
    """Return the title of another scene that is made of the same parts, if there is one."""
    own = f"{kind.__module__}.{kind.__qualname__}"
    titles = (
        scene.title
        for name, scene in _USER_SCENES.items()
        if name != own and scene.made_of == dict(kind.made_of)
    )
    return next(titles, None)


def _user_scene(kind: type[OwnScene], parts: Parts, options: Options) -> OwnScene:
    """Make the setting of a user-defined scene."""
    setting = kind(load_of(parts.block_si, options), parts)
    if faults := setting.misfits():
        raise AssemblyError(faults)
    return setting


@dataclass(frozen=True)
class Assembly:
    """Parts and options that have been checked together, and the scene that they make."""

    parts: Parts  # the parts by their slots
    options: Options  # all options, and gravity
    scene: Scene = field(compare=False)

    @cached_property
    def setting(self) -> Setting:
        """The scene's numbers in SI units."""
        check_registered(self.parts.structural())
        return self.scene.make_setting(self.parts, self.options)

    @property
    def model(self) -> ContactModel:
        """The scene's equations, ready for the integrator; each thread has its own."""
        return self.setting.compile()

    @cached_property
    def setting_cautions(self) -> list[str]:
        """Warnings about the scene."""
        return [
            *self.setting.cautions(),
            *outside_point_cautions(self.parts),
            *depth_cautions(self.parts),
            *unused_option_cautions(self.parts, self.options),
        ]

    @cached_property
    def cautions(self) -> list[str]:
        """Warnings about the scene and its parts, each once."""
        of_parts = [text for part in self.parts.structural() for text in part.cautions()]
        return list(dict.fromkeys([*of_parts, *self.setting_cautions]))

    @cached_property
    def description(self) -> str:
        """The model in words: its equations, its numbers, and what it leaves out."""
        return describe(self.setting, self.parts)

    @cached_property
    def json(self) -> str:
        """Parts and options as JSON text; without the motion."""
        return json.dumps(self.to_dict())

    def __reduce__(self) -> tuple[object, ...]:
        # without cached values: equations contain functions that cannot be pickled
        return (Assembly, (self.parts, self.options, self.scene))

    def to_dict(self) -> dict[str, object]:
        """Return parts and options as plain values, fit for JSON; without the motion."""
        parts = [part.to_dict() for part in self.parts.structural()]
        return {"parts": parts, **self.options.to_dict()}


def assemble(
    parts: Sequence[object],
    *,
    restraint: object = Restraint.CONTACT_STATE,
    rotation: object = Rotation.FINITE,
    coupling: object = Coupling.COUPLED,
    gravity: object = None,
    inclination: object = None,
    sliding: object = Sliding.COMPUTED,
) -> Assembly:
    """Check parts and options together, and find the scene they make."""
    faults: list[str] = []
    sorted_parts = sort_parts(parts, faults)
    options = Options(
        read_option(Restraint, restraint, "restraint", option_faults := []),
        read_option(Rotation, rotation, "rotation", option_faults),
        read_option(Coupling, coupling, "coupling", option_faults),
        read_option_number(gravity, "gravity", option_faults),
        read_option_number(inclination, "inclination", option_faults),
        read_option(Sliding, sliding, "sliding", option_faults),
    )
    return assemble_parts(sorted_parts, options, faults, option_faults)


def assemble_parts(
    parts: Parts, options: Options, faults: Sequence[str] = (), option_faults: Sequence[str] = ()
) -> Assembly:
    """Check sorted parts against one another, and find the scene they make."""
    faults = [*faults, *combination_faults(parts)]
    scene = next((scene for scene in scenes() if scene.fits(parts, options.coupling)), None)
    if scene is None and not faults:
        names = " and ".join(type(part).__name__ for part in parts.structural())
        faults.append(f"no scene is made of {names} together")
    # the list of scenes helps where the parts make none, not where an option is wrong
    supported = list(dict.fromkeys(scene.title for scene in scenes())) if faults else []
    faults += [*size_faults(parts, options), *option_faults]
    if faults or scene is None:
        raise AssemblyError(faults, supported)
    made = Assembly(parts, options, scene)
    if parts.own or any(isinstance(part, OwnBase) for part in parts.structural()):
        made.model  # noqa: B018 - refuses more contacts than can be numbered, and wrong sizes
    return made
