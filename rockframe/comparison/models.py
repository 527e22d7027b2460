"""Models to compare: the scene, and simpler ones without some of its parts and effects."""

import warnings
from collections.abc import Iterator, Mapping
from typing import Any, Final

from rockframe.components import (
    Component,
    Load,
    RearWall,
    Restrainer,
    RigidGround,
    Stack,
    Tendon,
    TwoSpringSupport,
    WinklerSoil,
)
from rockframe.components.block_numbers import squat_body_warnings
from rockframe.errors import ModelWarning
from rockframe.simulation.system import System, check_system
from rockframe.suggestions import with_hints
from rockframe.system.options import Coupling, Rotation, Sliding
from rockframe.system.own_base import OwnBase

_MODELS: Final = (
    ("rigid ground", ("block",), Coupling.COUPLED),
    ("rigid ground", ("frame",), Coupling.COUPLED),
    ("rigid ground and wall", ("block", "wall"), Coupling.COUPLED),
    ("{two pads}", ("block", "pads"), Coupling.COUPLED),
    ("{soil}", ("block", "soil"), Coupling.COUPLED),
    ("cap and {soil}", ("block", "cap", "soil"), Coupling.COUPLED),
    ("{pads}, cap and {soil} by cascade", ("block", "pads", "cap", "soil"), Coupling.CASCADE),
    ("{pads}, cap and {soil} coupled", ("block", "pads", "cap", "soil"), Coupling.COUPLED),
    ("stack on rigid ground", ("stack",), Coupling.COUPLED),
    ("stack on {two pads}", ("stack", "pads"), Coupling.COUPLED),
    ("stack on {soil}", ("stack", "soil"), Coupling.COUPLED),
)
"""Models of all scenes: their names, the slots of their parts, and how these are joined."""
_BASE_WORDS: Final = {"two pads": "pads", "pads": "pads", "soil": "soil"}
"""Words in the names of models, and the slots of the bases that they name."""


_LINK_WORDS: Final[dict[type, str]] = {
    Restrainer: "restrainers",
    Tendon: "tendons",
    Load: "loads",
}
"""Words for links but walls; links of a user's own are named by their classes."""


@with_hints()
def model_ladder(system: System) -> dict[str, System]:
    """Return the models of a scene, from the simplest to the scene itself.

    The bases lead from rigid ground to pads, and to pads, cap and soil, first by cascade, then
    coupled. In a scene without pads they lead from rigid ground to soil, first without the cap,
    then with it. A user-defined base comes after the bases that its method ``simpler`` returns. On
    each base small rotations come first, then finite ones, then the model with the restrainers,
    tendons, loads and elastic walls of the scene. A block that slides is first held against
    sliding; the model that slides comes last.

    Parameters
    ----------
    system : System
        The scene. Models contain no part that it lacks.

    Returns
    -------
    dict of str to System
        The models by their names in words, with the scene itself last.

    Raises
    ------
    ComponentError
        If `system` is not a System.

    Examples
    --------
    >>> import rockframe as rf
    >>> block = rf.Block(width="1 m", height="4 m", mass="10 t")
    >>> pads = rf.TwoSpringSupport(frequency_ratio=20, damping_ratio=0.1)
    >>> for name in model_ladder(rf.System(block, pads)):
    ...     print(name)
    rigid ground, small rotations
    rigid ground
    two pads, small rotations
    two pads
    """
    check_system(system, "model_ladder")
    components = system.parts.components
    present = system.parts.signature
    rows = _MODELS[:1] if system.parts.own else _MODELS
    slides = system.setting.slides and not system.parts.own
    block = system.parts.block
    squat = block is not None and bool(squat_body_warnings(block.si, ""))
    # a wall prevents the sliding of the model without it
    prevents_sliding = slides or "wall" in present
    all_parts, sliding = components, Sliding.CHECKED if prevents_sliding else system.sliding
    if slides and "stack" in present:  # the bases of a stack do not slide without a friction
        components = {slot: _without_sliding(part) for slot, part in components.items()}
        sliding = system.sliding
    options: dict[str, Any] = {
        "restraint": system.restraint, "gravity": system.gravity,
        "inclination": system.inclination,
        "sliding": sliding,
    }  # fmt: skip
    models: dict[str, System] = {}
    last = ""
    links = () if system.parts.own else system.parts.links
    words_of = {**_LINK_WORDS, RearWall: "wall" if len(system.parts.walls) == 1 else "walls"}
    link_words = " and ".join(
        dict.fromkeys(words_of.get(type(link), type(link).__name__) for link in links)
    )
    with warnings.catch_warnings():
        # a simpler model may warn of effects that it leaves out; the scene has warned before
        warnings.simplefilter("ignore", ModelWarning)
        for name, slots, coupling in rows:
            if not _is_simpler(slots, coupling, system):
                continue
            for bases in _bases(components, slots):
                parts = {**{slot: components[slot] for slot in slots}, **bases}
                if "ground" in components:
                    parts["ground"] = components["ground"]
                # where it is held and strikes its base, a squat body would not rock
                rocks = not squat or ("soil" in parts and "pads" not in parts and not slides)
                words = name.format(**_base_names(bases))
                for rotation in dict.fromkeys((Rotation.SMALL, system.rotation)):
                    last = f"{words}, small rotations" if rotation is Rotation.SMALL else words
                    if rocks:
                        models[last] = System(
                            *parts.values(), rotation=rotation, coupling=coupling, **options
                        )
                if links:
                    last = f"{words} with {link_words}"
                    if rocks:
                        models[last] = System(*parts.values(), *links, **options)
    if slides:
        sliding_options: dict[str, Any] = {**options, "sliding": Sliding.COMPUTED}
        models[f"{last}, sliding"] = System(*all_parts.values(), **sliding_options)
    if system.parts.own:
        models[system.setting.model] = System(
            *components.values(), rotation=system.rotation, **options
        )
    return models


def _without_sliding(part: Component) -> Component:
    """Return a base, or a stack with all its interfaces, without sliding."""
    if isinstance(part, Stack):
        return part.replace(interfaces=[*map(_without_sliding, part.interfaces)])
    if isinstance(part, RigidGround):
        return RigidGround(restitution=part.si.restitution)
    if isinstance(part, TwoSpringSupport | WinklerSoil):
        return part.replace(friction=None, kinetic_friction=None)
    return part


def _bases(arguments: Mapping[str, Any], slots: tuple[str, ...]) -> Iterator[dict[str, Component]]:
    """Return the bases of a model: for users' own bases the simpler ones, then the own ones."""
    bases = {slot: arguments[slot] for slot in ("pads", "soil") if slot in slots}
    simpler = {
        slot: part.simpler() if isinstance(part, OwnBase) else () for slot, part in bases.items()
    }
    for step in range(max(map(len, simpler.values()), default=0)):
        rungs = {slot: (*simpler[slot], part) for slot, part in bases.items()}
        yield {slot: rung[min(step, len(rung) - 1)] for slot, rung in rungs.items()}
    yield bases


def _base_names(bases: Mapping[str, Component]) -> dict[str, str]:
    """Return the words for the bases of a model; users' own bases are named by their classes."""
    own = {slot: type(part).__name__ for slot, part in bases.items() if isinstance(part, OwnBase)}
    return {words: own.get(slot, words) for words, slot in _BASE_WORDS.items()}


def _is_simpler(slots: tuple[str, ...], coupling: Coupling, system: System) -> bool:
    """Whether a model is no finer than the scene: a cascade has no coupled model."""
    present = system.parts.signature
    below = present & {"pads", "soil"} - set(slots)
    # pads stay as long as the soil under them, and a stack stays on one of its bases
    if not set(slots) <= present or (below and slots == ("stack",)):
        return False
    if "pads" in below and "soil" in slots:
        return False
    if "cap" not in slots or "pads" not in slots:
        return True
    return system.coupling is Coupling.COUPLED or coupling is Coupling.CASCADE
