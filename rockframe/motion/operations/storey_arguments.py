"""The building that stands between the ground and a floor, as users describe it."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any, Final, NamedTuple, TypeAlias

import numpy as np

from rockframe.arguments import whole_number
from rockframe.errors import ComponentError, shown
from rockframe.motion.processing.floors import FloorModes
from rockframe.motion.processing.shear_buildings import building_modes, uniform_modes
from rockframe.signals.spectra import DAMPING_RATIO
from rockframe.units import (
    MASS,
    PERIOD,
    POSITIVE,
    STIFFNESS,
    Condition,
    Measure,
    to_ratio,
    to_si,
    to_si_values,
)

if TYPE_CHECKING:
    from collections.abc import Mapping

    from rockframe.signals.arrays import Array

    _Read: TypeAlias = tuple[Array, Array, str, dict[str, Any]]
    """Periods and participations of the modes, the building in words, and its arguments."""

_MOST_STOREYS: Final = 1000
_WAYS: Final = (
    # (what has to be given, what may be given with it)
    (("periods",), ("floor_participations",)),
    (("storeys", "period", "floor"), ("modes",)),
    (("masses", "stiffnesses", "floor"), ("modes",)),
)


class BuildingModes(NamedTuple):
    """A building's modes, what it is in words, and the arguments that describe it."""

    modes: FloorModes
    words: str
    arguments: dict[str, Any]


def read_building(given: Mapping[str, Any], damping_ratio: object, *, owner: str) -> BuildingModes:
    """Read one of the three ways in which a building is described."""
    told = {name: value for name, value in given.items() if value is not None}
    ways = [set(needed) <= set(told) <= {*needed, *more} for needed, more in _WAYS]
    if True not in ways:
        found = ", ".join(told) or "none of them"
        known = "; or ".join(_listed(needed) for needed, _ in _WAYS)
        msg = f"{owner}: give {known}; got {found}; write for example periods=['0.5 s']"
        raise ComponentError(msg)
    periods, participations, words, arguments = (_of_modes, _uniform, _of_masses)[ways.index(True)](
        told, owner
    )
    if "modes" in told:
        highest = periods.size
        kept = whole_number(told["modes"], owner=owner, name="modes", lowest=1, highest=highest)
        periods, participations = periods[:kept], participations[:kept]
        words += f", of {highest} modes the first {kept}"
        arguments["modes"] = kept
    ratios = _damping_ratios(damping_ratio, periods.size, owner)
    arguments["damping_ratio"] = ratios if len(set(ratios)) > 1 else ratios[0]
    return BuildingModes(FloorModes(periods, np.array(ratios), participations), words, arguments)


def _listed(names: tuple[str, ...]) -> str:
    *first, last = names
    return f"{', '.join(first)} and {last}" if first else last


def _of_modes(told: Mapping[str, Any], owner: str) -> _Read:
    periods = _values(told["periods"], PERIOD, owner, "periods", zero=True)
    given = told.get("floor_participations")
    if given is None and periods.size > 1:
        msg = (
            f"{owner}: {periods.size} periods need floor_participations, of each mode its "
            "participation factor times the displacement of the floor in the mode shape"
        )
        raise ComponentError(msg)
    each = [1.0] if given is None else _ratios(given, owner, "floor_participations", "1.2")
    if len(each) != periods.size:
        msg = (
            f"{owner}: floor_participations needs one value for each of the {periods.size} "
            f"periods, got {len(each)}"
        )
        raise ComponentError(msg)
    arguments = {"periods": _written(periods, PERIOD), "floor_participations": each}
    return periods, np.array(each), "given modes", arguments


def _uniform(told: Mapping[str, Any], owner: str) -> _Read:
    storeys = whole_number(
        told["storeys"], owner=owner, name="storeys", lowest=1, highest=_MOST_STOREYS
    )
    floor = whole_number(told["floor"], owner=owner, name="floor", lowest=1, highest=storeys)
    period = to_si(told["period"], PERIOD, owner=owner, name="period", condition=POSITIVE)
    words = f"floor {floor} of a shear building of equal storeys, {storeys} in number"
    arguments = {"storeys": storeys, "floor": floor, "period": f"{period!r} {PERIOD.unit}"}
    return *uniform_modes(storeys, floor, period), words, arguments


def _of_masses(told: Mapping[str, Any], owner: str) -> _Read:
    masses = _values(told["masses"], MASS, owner, "masses")
    stiffnesses = _values(told["stiffnesses"], STIFFNESS, owner, "stiffnesses")
    if masses.size != stiffnesses.size or masses.size > _MOST_STOREYS:
        msg = (
            f"{owner}: masses and stiffnesses need one value for each storey, from the lowest "
            f"up, at most {_MOST_STOREYS}; got {masses.size} and {stiffnesses.size}"
        )
        raise ComponentError(msg)
    floor = whole_number(told["floor"], owner=owner, name="floor", lowest=1, highest=masses.size)
    with np.errstate(invalid="ignore", divide="ignore"):
        periods, participations = building_modes(masses, stiffnesses, floor)
    if not np.isfinite(periods).all():
        msg = f"{owner}: masses or stiffnesses are too far apart for their modes to be computed"
        raise ComponentError(msg)
    words = f"floor {floor} of a shear building of {masses.size} storeys"
    arguments = {
        "masses": _written(masses, MASS),
        "stiffnesses": _written(stiffnesses, STIFFNESS),
        "floor": floor,
    }
    return periods, participations, words, arguments


def _values(given: object, measure: Measure, owner: str, name: str, *, zero: bool = False) -> Array:
    values = np.array(to_si_values(given, measure, owner=owner, name=name))
    least = "zero or more" if zero else "greater than zero"
    if values.size == 0 or not ((values >= 0.0) if zero else (values > 0.0)).all():
        msg = f"{owner}: {name} must be one or more values, each {least}, got {shown(given)}"
        raise ComponentError(msg)
    return values


def _ratios(
    given: Any, owner: str, name: str, example: str, condition: Condition | None = None
) -> list[float]:
    several = isinstance(given, Iterable) and not isinstance(given, str)
    if not several or getattr(given, "ndim", 1) == 0:  # a scalar Quantity calls itself iterable
        return [to_ratio(given, owner=owner, name=name, condition=condition, example=example)]
    return [
        to_ratio(one, owner=owner, name=f"{name}[{k}]", condition=condition, example=example)
        for k, one in enumerate(given)
    ]


def _damping_ratios(given: object, modes: int, owner: str) -> list[float]:
    ratios = _ratios(given, owner, "damping_ratio", "0.05", DAMPING_RATIO)
    if len(ratios) not in (1, modes):
        msg = (
            f"{owner}: damping_ratio needs one value, or one for each of the {modes} modes, "
            f"got {len(ratios)}"
        )
        raise ComponentError(msg)
    return ratios * modes if len(ratios) == 1 else ratios


def _written(values: Array, measure: Measure) -> list[str]:
    return [f"{value!r} {measure.unit}" for value in values.tolist()]
