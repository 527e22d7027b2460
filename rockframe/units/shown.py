"""Units in which people read numbers, in the place of SI units."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from difflib import get_close_matches
from typing import Any, Final, cast

import numpy as np
import numpy.typing as npt

from rockframe.errors import ComponentError, shown
from rockframe.units import kinds
from rockframe.units.kinds import Measure
from rockframe.units.reading import to_si

_WRITTEN: Final = {"g_0": "g", "deg": "°", "degree": "°", "degrees": "°"}
KINDS: Final[Mapping[str, Measure]] = {
    "length": kinds.LENGTH,
    "mass": kinds.MASS,
    "angle": kinds.ANGLE,
    "angular_velocity": kinds.ANGULAR_VELOCITY,
    "velocity": kinds.VELOCITY,
    "acceleration": kinds.ACCELERATION,
    "force": kinds.FORCE,
    "moment": kinds.MOMENT,
    "energy": kinds.ENERGY,
    "stiffness": kinds.STIFFNESS,
}
"""What readers choose units of."""


@dataclass(frozen=True)
class Shown:
    """A unit in which numbers are shown."""

    words: str  # as it is written behind them
    size: float  # in the SI unit

    def of(self, values: Any) -> npt.NDArray[np.float64]:
        """Give values, in SI units, in this one."""
        return np.asarray(values, np.float64) / self.size


def shown_unit(given: object, measure: Measure, *, owner: str, name: str) -> Shown:
    """Read the unit in which numbers of a kind are shown."""
    if not isinstance(given, str):
        msg = f"{owner}: {name} must be a unit, such as {str(measure.unit)!r}, got {shown(given)}"
        raise ComponentError(msg)
    size = to_si(f"1 {given}", measure, owner=owner, name=name)
    return Shown(_WRITTEN.get(given, given).replace("*", " "), size)


@dataclass(frozen=True)
class ReaderUnits:
    """The units of a reader's choice, and SI units where none was chosen."""

    chosen: Mapping[str, Shown] = field(default_factory=dict[str, Shown])  # by the SI unit
    words: Mapping[str, str] = field(default_factory=dict[str, str])  # as they were given

    def of(self, unit: str) -> Shown:
        """Give the unit in which values in an SI unit are shown."""
        return self.chosen.get(unit, Shown(unit, 1.0))


def reader_units(given: object, *, owner: str) -> ReaderUnits:
    """Read units by what they are of, such as ``{"force": "kN"}``."""
    if given is None:
        return ReaderUnits()
    example = "such as units={'force': 'kN', 'angle': 'deg'}"
    if not isinstance(given, Mapping):
        msg = f"{owner}: units must be a mapping, {example}, got {shown(given)}"
        raise ComponentError(msg)
    chosen = dict[str, Shown]()
    for name, unit in cast("Mapping[Any, Any]", given).items():
        if name not in KINDS:
            near = get_close_matches(str(name), KINDS, 1)
            meant = f"did you mean {near[0]!r}?" if near else f"known are {', '.join(KINDS)}"
            msg = f"{owner}: units are of kinds, {example}; found {shown(name)}: {meant}"
            raise ComponentError(msg)
        kind = KINDS[name]
        chosen[str(kind.unit)] = shown_unit(unit, kind, owner=owner, name=f"units[{name!r}]")
    return ReaderUnits(chosen, dict(cast("Mapping[str, str]", given)))
