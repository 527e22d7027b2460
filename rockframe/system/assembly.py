"""Assembly: parts and options checked together, and the scene they make."""

import json
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING

from rockframe.errors import AssemblyError
from rockframe.system.fitting import contradictions, misfits, missizes, unused
from rockframe.system.options import (
    Coupling,
    Options,
    Restraint,
    Rotation,
    Sliding,
    read_measured,
    read_option,
)
from rockframe.system.own_base import OwnBase
from rockframe.system.parts import Parts, sort_parts
from rockframe.system.scenes import Scene, scenes
from rockframe.system.setting import Setting
from rockframe.system.words import describe

if TYPE_CHECKING:
    from rockframe.dynamics.protocol import ContactModel


@dataclass(frozen=True)
class Assembly:
    """Parts and options that have been checked and make a supported scene.

    Two are equal if they have equal parts, in whatever order, and equal options.
    """

    parts: Parts  # by what they are
    options: Options  # all options, and gravity
    scene: Scene = field(compare=False)  # the scene that they make

    @cached_property
    def setting(self) -> Setting:
        """The scene's numbers in SI units."""
        return self.scene.make_setting(self.parts, self.options)

    @cached_property
    def model(self) -> "ContactModel":
        """The scene's equations, ready for the integrator, which leaves them as they are."""
        return self.setting.compile()

    @cached_property
    def doubts(self) -> list[str]:
        """What is unusual about the scene."""
        return [
            *self.setting.cautions(),
            *contradictions(self.parts),
            *unused(self.parts, self.options),
        ]

    @cached_property
    def cautions(self) -> list[str]:
        """What is unusual about the scene and its parts, each once."""
        of_parts = [text for part in self.parts.structural() for text in part.cautions()]
        return list(dict.fromkeys([*of_parts, *self.doubts]))

    @cached_property
    def description(self) -> str:
        """Which model was picked, by which equations, and what it leaves out."""
        return describe(self.setting, self.parts)

    @cached_property
    def json(self) -> str:
        """Parts and options as JSON text; without the motion."""
        return json.dumps(self.to_dict())

    def __reduce__(self) -> tuple[object, ...]:
        # without what has been computed: equations hold functions that cannot be sent
        return (Assembly, (self.parts, self.options, self.scene))

    def to_dict(self) -> dict[str, object]:
        """Give parts and options as plain values, fit for JSON; without the motion."""
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
    given = sort_parts(parts, faults)
    options = Options(
        read_option(Restraint, restraint, "restraint", wrong := []),
        read_option(Rotation, rotation, "rotation", wrong),
        read_option(Coupling, coupling, "coupling", wrong),
        read_measured(gravity, "gravity", wrong),
        read_measured(inclination, "inclination", wrong),
        read_option(Sliding, sliding, "sliding", wrong),
    )
    return assembly_of(given, options, faults, wrong)


def assembly_of(
    given: Parts, options: Options, faults: Sequence[str] = (), wrong: Sequence[str] = ()
) -> Assembly:
    """Check sorted parts against one another, and find the scene they make."""
    faults = [*faults, *misfits(given)]
    scene = next((scene for scene in scenes() if scene.fits(given, options.coupling)), None)
    if scene is None and not faults:
        names = " and ".join(type(part).__name__ for part in given.structural())
        faults.append(f"no scene is made of {names} together")
    # the scenes are of use to one whose parts make none, not to one with a wrong option
    supported = [scene.title for scene in scenes()] if faults else []
    faults += [*missizes(given, options), *wrong]
    if faults or scene is None:
        raise AssemblyError(faults, supported)
    made = Assembly(given, options, scene)
    if given.own() or any(isinstance(part, OwnBase) for part in given.structural()):
        made.model  # noqa: B018 - refuses more contacts than can be numbered, and wrong sizes
    return made
