"""Options of systems and runs: their values, how they are read, and their words."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import StrEnum
from typing import Final, Literal, TypeAlias, TypeVar

from rockframe.constants import STANDARD_GRAVITY
from rockframe.dynamics.body import BY_CONTACT, CENTRE, LEADING_CORNER
from rockframe.errors import RockframeError, did_you_mean, short_repr
from rockframe.signals.motion import Incline
from rockframe.solve.accuracy import Accuracy, AccuracyLevel
from rockframe.units import (
    ACCELERATION,
    ANGLE,
    POSITIVE,
    Condition,
    Measure,
    QuantityLike,
    quantity_text,
    to_si,
)


class Restraint(StrEnum):
    """Which point of the base the ground holds horizontally."""

    CONTACT_STATE = "contact-state"
    LEADING_CORNER = "leading-corner"
    CENTRE = "centre"


class Rotation(StrEnum):
    """Kinematics: exact, or expanded to second order in the rotation."""

    FINITE = "finite"
    SMALL = "small"


class Coupling(StrEnum):
    """How a block on pads, cap and soil is joined."""

    COUPLED = "coupled"
    CASCADE = "cascade"


class Sliding(StrEnum):
    """What friction does: its forces are computed, or the base is held and the friction checked."""

    COMPUTED = "computed"
    CHECKED = "checked"


class Overturning(StrEnum):
    """What a run does when the rotation reaches the overturning angle."""

    STOP = "stop"
    CONTINUE = "continue"


RestraintLike: TypeAlias = Restraint | Literal["contact-state", "leading-corner", "centre"]
RotationLike: TypeAlias = Rotation | Literal["finite", "small"]
CouplingLike: TypeAlias = Coupling | Literal["coupled", "cascade"]
SlidingLike: TypeAlias = Sliding | Literal["computed", "checked"]
OverturningLike: TypeAlias = Overturning | Literal["stop", "continue"]
AccuracyLike: TypeAlias = (
    Accuracy | AccuracyLevel | Literal["fast", "standard", "reference"] | float
)
SweepAccuracyLike: TypeAlias = AccuracyLike | Literal["screen"]
PointsLike: TypeAlias = Mapping[str, tuple[QuantityLike, QuantityLike]]
"""Points of the body by names: how far to the right of the middle of its base, how far above."""


@dataclass(frozen=True)
class NumericOption:
    """An option that is a number."""

    measure: Measure  # kind of quantity
    condition: Condition  # range
    description: str  # meaning
    default: float  # default, in SI units


NUMERIC_OPTIONS: Final = {
    "gravity": NumericOption(ACCELERATION, POSITIVE, "acceleration of gravity", STANDARD_GRAVITY),
    "inclination": NumericOption(
        ANGLE,
        Condition("between -90° and 90°", lambda angle: abs(angle) < 0.5 * math.pi),
        "angle by which the base rises to the right",
        0.0,
    ),
}
"""The options that are numbers, by their names."""


@dataclass(frozen=True)
class Options:
    """Options of a system, the gravity it stands in [m s^-2], and how its base rises [rad]."""

    restraint: Restraint
    rotation: Rotation
    coupling: Coupling
    gravity: float
    inclination: float = 0.0
    sliding: Sliding = Sliding.COMPUTED
    # inclination of the base and gravity; whether the kinematics are expanded to second order
    slope: Incline = field(init=False, repr=False, compare=False)
    small: bool = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        slope = Incline(self.inclination, self.gravity)
        vars(self).update(slope=slope, small=self.rotation is Rotation.SMALL)

    def to_dict(self) -> dict[str, str]:
        """Return the options as texts that a system reads back exactly.

        A level base and computed sliding, the defaults, are left out.
        """
        inclined = {"inclination": quantity_text(self.inclination, ANGLE)}
        checked = {"sliding": str(self.sliding)}
        return {
            "restraint": str(self.restraint),
            "rotation": str(self.rotation),
            "coupling": str(self.coupling),
            "gravity": quantity_text(self.gravity, ACCELERATION),
            **(inclined if self.inclination != 0.0 else {}),
            **(checked if self.sliding is Sliding.CHECKED else {}),
        }


Option = TypeVar("Option", bound=StrEnum)


def read_option(kind: type[Option], value: object, name: str, faults: list[str]) -> Option:
    """Return the option that a string names; if it names none, add to faults and give the first."""
    try:
        return kind(value)  # type: ignore[arg-type]
    except ValueError:
        known = ", ".join(repr(str(option)) for option in kind)
        near = did_you_mean(value, map(str, kind))
        faults.append(f"{name} must be one of {known}, got {short_repr(value)}{near}")
        return next(iter(kind))


def read_option_number(argument: object, name: str, faults: list[str]) -> float:
    """Return an option that is a number; if it is wrong, add to faults and give the default."""
    option = NUMERIC_OPTIONS[name]
    if argument is None:
        return option.default
    try:
        value = to_si(
            argument, option.measure, owner="System", name=name, condition=option.condition
        )
    except RockframeError as problem:
        faults.append(str(problem))
        return option.default
    return value + 0.0  # no negative zero


_WORDS = {
    Restraint.CONTACT_STATE: (
        "contact-state: the middle of the base while both {ends} bear, else the bearing "
        "{end}; at each change the momentum is projected on the new restraint"
    ),
    Restraint.LEADING_CORNER: (
        "leading-corner: the corner towards which the block leans, in every contact state"
    ),
    Restraint.CENTRE: "centre: the middle of the base, in every contact state",
}


def restraint_words(options: Options, end: str = "corner") -> str:
    """Say which point of the base is held horizontally."""
    if options.small:
        return "the middle of the base (at small rotation the rules coincide)"
    return _WORDS[options.restraint].format(end=end, ends=f"{end}s")


RESTRAINT_CODES: Final = {
    Restraint.CONTACT_STATE: BY_CONTACT,
    Restraint.LEADING_CORNER: LEADING_CORNER,
    Restraint.CENTRE: CENTRE,
}
"""Codes of the restraint rules in the equations."""
SLIDING_AT_SMALL_ROTATION: Final = (
    "a block slides with rotation='finite' only; give sliding='checked' to hold it and compare its "
    "friction"
)
