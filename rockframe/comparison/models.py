"""Models to compare: what a scene becomes when parts and effects are left out."""

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
from rockframe.components.block_numbers import squat
from rockframe.errors import ComponentError, ModelWarning
from rockframe.proposals import hinted
from rockframe.simulation.system import System
from rockframe.system.options import Coupling, Rotation, Sliding
from rockframe.system.own_base import OwnBase

_STACK = (
    ("rigid ground", ("block",), Coupling.COUPLED),
    ("{two pads}", ("block", "pads"), Coupling.COUPLED),
    ("{pads}, cap and {soil} by cascade", ("block", "pads", "cap", "soil"), Coupling.CASCADE),
    ("{pads}, cap and {soil} coupled", ("block", "pads", "cap", "soil"), Coupling.COUPLED),
)
_BED = (
    ("rigid ground", ("block",), Coupling.COUPLED),
    ("{soil}", ("block", "soil"), Coupling.COUPLED),
    ("cap and {soil}", ("block", "cap", "soil"), Coupling.COUPLED),
)
_UPON: Final = (
    ("stack on {two pads}", ("stack", "pads"), Coupling.COUPLED),
    ("stack on {soil}", ("stack", "soil"), Coupling.COUPLED),
)
_ON_RIGID: Final = (("stack on rigid ground", ("stack",), Coupling.COUPLED),)
_FRAME: Final = (("rigid ground", ("frame",), Coupling.COUPLED),)
_WALL: Final = (
    *_STACK[:1],
    ("rigid ground and wall", ("block", "wall"), Coupling.COUPLED),
)
_WORDS: Final = {"two pads": "pads", "pads": "pads", "soil": "soil"}
"""Words of rungs, and the slots of the bases that they name."""


_LINKS: Final[dict[type, str]] = {
    Restrainer: "restrainers",
    Tendon: "tendons",
    Load: "loads",
    RearWall: "wall",
}
"""Words for links; those of users' own are called by their classes."""


def check_system(given: object, owner: str) -> None:
    """Refuse what is no System."""
    if not isinstance(given, System):
        msg = f"{owner}: system needs a System, got {type(given).__name__}"
        raise ComponentError(msg)


@hinted()
def model_ladder(system: System) -> dict[str, System]:
    """Give the models of a scene, from the simplest to the scene itself.

    From rigid ground over pads to pads, cap and soil, first by cascade, then coupled; or
    from rigid ground to soil, without the cap and with it. A base of a user's own comes after
    those that it calls simpler. Each with small rotations first, then with finite ones, and then
    with the restrainers, tendons, loads and elastic walls of the scene; a block that slides first
    held, then sliding.

    Parameters
    ----------
    system : System
        The scene; nothing that it lacks is added.

    Returns
    -------
    dict of str to System
        By a name in words, the scene itself last.

    Raises
    ------
    ComponentError
        Not a System.

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
    given = system.parts.components
    present = system.parts.signature
    rows = _STACK if {"pads", "cap"} <= present or "soil" not in present else _BED
    if "stack" in present:
        rows = _UPON if present & {"pads", "soil"} else _ON_RIGID
    rows = _FRAME if "frame" in present else rows
    rows = _WALL if "wall" in present else rows
    if system.parts.own:
        rows = _STACK[:1]
    slides = system.setting.slides and not system.parts.own
    if slides and "stack" not in present and squat(system.parts.the_block, ""):
        rows = ()  # held it would not rock
    # a wall holds a block that slides without it
    holds = slides or "wall" in present
    whole, held = given, Sliding.CHECKED if holds else system.sliding
    if slides and "stack" in present:  # whose bases hold where they have no friction
        given, held = {slot: _holding(part) for slot, part in given.items()}, system.sliding
    options: dict[str, Any] = {
        "restraint": system.restraint, "gravity": system.gravity,
        "inclination": system.inclination,
        "sliding": held,
    }  # fmt: skip
    models: dict[str, System] = {}
    links = () if system.parts.own else system.parts.links
    acts = " and ".join(dict.fromkeys(_LINKS.get(type(one), type(one).__name__) for one in links))
    with warnings.catch_warnings():
        # what is left out may be said of a rung, but the scene itself has said its own
        warnings.simplefilter("ignore", ModelWarning)
        for name, slots, coupling in rows:
            if not set(slots) <= present or not _reached(slots, coupling, system):
                continue
            for bases in _bases(given, slots):
                parts = {**{slot: given[slot] for slot in slots}, **bases}
                if "ground" in given:
                    parts["ground"] = given["ground"]
                words = name.format(**_named(bases))
                for rotation in Rotation.SMALL, Rotation.FINITE:
                    if rotation is Rotation.FINITE and system.rotation is Rotation.SMALL:
                        continue
                    rung = f"{words}, small rotations" if rotation is Rotation.SMALL else words
                    models[rung] = System(
                        *parts.values(), rotation=rotation, coupling=coupling, **options
                    )
                if links:
                    models[f"{words} with {acts}"] = System(*parts.values(), *links, **options)
    if slides:
        computed: dict[str, Any] = {**options, "sliding": Sliding.COMPUTED}
        last = list(models)[-1] if models else "rigid ground"
        models[f"{last}, sliding"] = System(*whole.values(), **computed)
    if system.parts.own:
        models[system.setting.model] = System(*given.values(), rotation=system.rotation, **options)
    return models


def _holding(part: Component) -> Component:
    """Give a part whose base, or those between bodies, hold what stands on them."""
    if isinstance(part, Stack):
        return part.replace(interfaces=[_holding(one) for one in part.interfaces])
    if isinstance(part, RigidGround):
        return RigidGround(restitution=part.si.restitution)
    if isinstance(part, TwoSpringSupport | WinklerSoil):
        return part.replace(friction=None, kinetic_friction=None)
    return part


def _bases(given: Mapping[str, Any], slots: tuple[str, ...]) -> Iterator[dict[str, Component]]:
    """Give the bases of a rung: all simpler ones of users' own bases first, then themselves."""
    bases = {slot: given[slot] for slot in ("pads", "soil") if slot in slots}
    simpler = {
        slot: part.simpler() if isinstance(part, OwnBase) else () for slot, part in bases.items()
    }
    for step in range(max((len(parts) for parts in simpler.values()), default=0)):
        yield {
            slot: (*simpler[slot], part)[min(step, len(simpler[slot]))]
            for slot, part in bases.items()
        }
    yield bases


def _named(bases: Mapping[str, Component]) -> dict[str, str]:
    """Give the words of a rung: users' own bases are called by their classes."""
    own = {slot: type(part).__name__ for slot, part in bases.items() if isinstance(part, OwnBase)}
    return {words: own.get(slot, words) for words, slot in _WORDS.items()}


def _reached(slots: tuple[str, ...], coupling: Coupling, system: System) -> bool:
    """Whether a rung is not above the scene: a cascade has no coupled rung."""
    if "cap" not in slots or "pads" not in slots:
        return True
    return system.coupling is Coupling.COUPLED or coupling is Coupling.CASCADE
