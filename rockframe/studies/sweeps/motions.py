"""The ground motions of a sweep: their names, and how axes change them."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Final, TypeAlias, cast

import numpy as np

from rockframe.arguments import is_iterable, with_string_keys
from rockframe.errors import ComponentError, StudyError, short_repr
from rockframe.motion import GroundMotion, HorizontalPair
from rockframe.motion.display import display_name
from rockframe.studies.sweeps.axes import OWNER
from rockframe.units import ACCELERATION, TIME, VELOCITY, Measure, Unit

NO_MOTION: Final = "none"
"""Name of a motion of zero, as in the attributes of a run."""
MOTION_OF_SCENE: Final = "of the scene"
"""Name of motions that a function puts into its systems."""
_MAX_LISTED: Final = 6
"""Names that a message lists."""


Motions: TypeAlias = GroundMotion | HorizontalPair
MotionsLike: TypeAlias = Motions | Mapping[str, Motions] | Sequence[Motions]
"""Motions of a study; a pair of components is two motions."""


@dataclass(frozen=True)
class MotionAxis:
    """An axis that scales the motion."""

    argument: str  # of :meth:`rockframe.GroundMotion.scaled`
    measure: Measure  # kind of quantity


SPECTRAL_ACCELERATION: Final = "pseudo_spectral_acceleration"
SCALE: Final = "scale"
MOTION_AXES: Final = {
    SCALE: MotionAxis("factor", Measure("a pure ratio", Unit.ONE, "2")),
    "peak_ground_acceleration": MotionAxis("peak", ACCELERATION),
    "peak_ground_velocity": MotionAxis("peak_velocity", VELOCITY),
    SPECTRAL_ACCELERATION: MotionAxis("spectral_acceleration", ACCELERATION),
}
"""Axes that change the motion, by their names."""
ABBREVIATIONS: Final = {
    "PGA": "peak_ground_acceleration",
    "PGV": "peak_ground_velocity",
    "SA": SPECTRAL_ACCELERATION,
}
"""Of these axes."""


def full_name(name: str) -> str:
    """Return the name of an axis that an abbreviation stands for."""
    return ABBREVIATIONS.get(name, name)


def motion_of_case(
    motion: GroundMotion, name: str, value: float, period: float | None
) -> GroundMotion:
    """Return the motion of a case."""
    target = MOTION_AXES[name]
    if target.measure.unit == Unit.ONE:
        return motion.scaled(value)
    arguments: dict[str, Any] = {target.argument: f"{value!r} {target.measure.unit}"}
    if name == SPECTRAL_ACCELERATION:
        arguments["period"] = f"{period!r} {TIME.unit}"
    return motion.scaled(**arguments)


def named_motions(value: object) -> dict[str, GroundMotion]:
    """Read the motions of a sweep."""
    named: dict[str, Any]
    if isinstance(value, GroundMotion):
        return {value.name: value}
    if isinstance(value, HorizontalPair):
        value = [value]
    if isinstance(value, Mapping):
        named = _split_pairs(cast("Mapping[Any, Any]", value))
    elif is_iterable(value) and not isinstance(value, str):
        several = list(value)
        pairs = (
            item.components if isinstance(item, HorizontalPair) else (item,) for item in several
        )
        named = _distinct_names([motion for pair in pairs for motion in pair])
    else:
        named = {"": value}
    wrong = [motion for motion in named.values() if not isinstance(motion, GroundMotion)]
    if wrong or not named:
        given = short_repr(wrong[0]) if wrong else "none"
        msg = f"{OWNER}: motions must be a GroundMotion, or several, got {given}"
        raise ComponentError(msg)
    return named


def _split_pairs(named: Mapping[Any, Any]) -> dict[str, Any]:
    """Return motions by name; the name of a component follows that of its pair."""
    motions: list[tuple[Any, Any]] = []
    for name, item in named.items():
        if not isinstance(item, HorizontalPair):
            motions.append((name, item))
            continue
        directions = [str(motion.metadata.get("component", "")) for motion in item.components]
        words = (
            directions
            if all(directions) and len(set(directions)) == len(directions)
            else ["first", "second"]
        )
        motions += [
            (f"{name} {word}", component)
            for word, component in zip(words, item.components, strict=True)
        ]
    return with_string_keys(motions, owner=OWNER)


def motion_number(requested: object, names: Sequence[str], *, owner: str) -> int:
    """Return the number of the motion for a name or a number, also one given as text."""
    if isinstance(requested, str) and requested in names:
        return names.index(requested)
    typed = isinstance(requested, str) and requested in {str(place) for place in range(len(names))}
    if typed or (isinstance(requested, int | np.integer) and not isinstance(requested, bool)):
        number = int(cast("int | str", requested))
        alike = [name for name in names if name.isdecimal() and int(name) == number]
        if alike and names.index(alike[0]) != number:
            msg = (
                f"{owner}: {number} is the name of one motion, and the place of another; give the "
                f"name, {alike[0]!r}"
            )
            raise StudyError(msg)
        if 0 <= number < len(names):
            return number
    few = ", ".join(map(repr, names[:_MAX_LISTED])) + ", ..." * (len(names) > _MAX_LISTED)
    msg = (
        f"{owner}: there is no motion {short_repr(requested)}; expected a name, or a number from 0 "
        f"to {len(names) - 1}; there are {few}"
    )
    raise StudyError(msg)


def _distinct_names(motions: list[Any]) -> dict[str, Any]:
    """Name motions: by their scales those of one name, with a number those that remain alike."""
    names = [str(getattr(motion, "name", place)) for place, motion in enumerate(motions)]
    named: dict[str, Any] = {}
    for original, motion in zip(names, motions, strict=True):
        alone = names.count(original) == 1
        plain = name = original if alone else display_name(original, getattr(motion, "history", ()))
        count = 1
        while name in named:
            count += 1
            name = f"{plain} ({count})"
        named[name] = motion
    return named
