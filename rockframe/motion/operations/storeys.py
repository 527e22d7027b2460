"""The motion of a floor of an elastic building on the ground."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import replace
from enum import StrEnum
from typing import Any, Final, TypeAlias

import numpy as np

from rockframe.arguments import checked_choice, checked_integer, is_iterable
from rockframe.errors import ComponentError, RecordWarning, short_repr, warn
from rockframe.motion.operations.derived import (
    cleared_vertical_metadata,
    derived_motion,
    dropped_pieces_note,
)
from rockframe.motion.processing.floors import (
    FloorModes,
    building_modes,
    decay_time,
    modal_acceleration,
    uniform_modes,
)
from rockframe.motion.processing.samples import divided_signal, padded
from rockframe.motion.quantities import ArrayLike
from rockframe.motion.value import MotionType
from rockframe.signals import Motion, Signal
from rockframe.signals.arrays import Array
from rockframe.signals.motion import MAXIMUM_SAMPLES
from rockframe.signals.spectra import DAMPING_RATIO, MAXIMUM_PARTS
from rockframe.suggestions import with_hints
from rockframe.units import (
    MASS,
    NOT_NEGATIVE,
    PERIOD,
    POSITIVE,
    STIFFNESS,
    TIME,
    TIME_STEP,
    Condition,
    Measure,
    QuantityLike,
    RatioLike,
    to_ratio,
    to_si,
    to_si_values,
)

_BuildingModes: TypeAlias = tuple[Array, Array, str, dict[str, Any]]
"""Periods and participations of the modes, a description of the building, its arguments."""

_MAX_STOREYS: Final = 1000


def _listed(names: tuple[str, ...]) -> str:
    *first, last = names
    return f"{', '.join(first)} and {last}" if first else last


def _read_modes(values: Mapping[str, Any], owner: str) -> _BuildingModes:
    periods = _values(values["periods"], PERIOD, owner, "periods", zero=True)
    value = values.get("floor_participations")
    if value is None and periods.size > 1:
        msg = (
            f"{owner}: {periods.size} periods need floor_participations, for each mode the "
            "participation factor times the displacement of the floor in the mode shape"
        )
        raise ComponentError(msg)
    factors = [1.0] if value is None else _ratios(value, owner, "floor_participations", "1.2")
    if len(factors) != periods.size:
        msg = (
            f"{owner}: floor_participations needs one value for each of the {periods.size} "
            f"periods, got {len(factors)}"
        )
        raise ComponentError(msg)
    arguments = {"periods": _quantity_texts(periods, PERIOD), "floor_participations": factors}
    return periods, np.array(factors), "given modes", arguments


def _read_uniform_building(values: Mapping[str, Any], owner: str) -> _BuildingModes:
    storeys = checked_integer(
        values["storeys"], owner=owner, name="storeys", lowest=1, highest=_MAX_STOREYS
    )
    floor = checked_integer(values["floor"], owner=owner, name="floor", lowest=1, highest=storeys)
    period = to_si(values["period"], PERIOD, owner=owner, name="period", condition=POSITIVE)
    words = f"floor {floor} of a shear building of equal storeys, {storeys} in number"
    arguments = {"storeys": storeys, "floor": floor, "period": f"{period!r} {PERIOD.unit}"}
    return *uniform_modes(storeys, floor, period), words, arguments


def _read_shear_building(values: Mapping[str, Any], owner: str) -> _BuildingModes:
    masses = _values(values["masses"], MASS, owner, "masses")
    stiffnesses = _values(values["stiffnesses"], STIFFNESS, owner, "stiffnesses")
    if masses.size != stiffnesses.size or masses.size > _MAX_STOREYS:
        msg = (
            f"{owner}: masses and stiffnesses need one value for each storey, from the lowest "
            f"up, at most {_MAX_STOREYS}; got {masses.size} and {stiffnesses.size}"
        )
        raise ComponentError(msg)
    floor = checked_integer(
        values["floor"], owner=owner, name="floor", lowest=1, highest=masses.size
    )
    with np.errstate(invalid="ignore", divide="ignore"):
        periods, participations = building_modes(masses, stiffnesses, floor)
    if not np.isfinite(periods).all():
        msg = f"{owner}: masses or stiffnesses are too far apart for their modes to be computed"
        raise ComponentError(msg)
    words = f"floor {floor} of a shear building of {masses.size} storeys"
    arguments = {
        "masses": _quantity_texts(masses, MASS),
        "stiffnesses": _quantity_texts(stiffnesses, STIFFNESS),
        "floor": floor,
    }
    return periods, participations, words, arguments


def _values(value: object, measure: Measure, owner: str, name: str, *, zero: bool = False) -> Array:
    values = np.array(to_si_values(value, measure, owner=owner, name=name))
    least = "zero or more" if zero else "greater than zero"
    if values.size == 0 or not ((values >= 0.0) if zero else (values > 0.0)).all():
        msg = f"{owner}: {name} must be one or more values, each {least}, got {short_repr(value)}"
        raise ComponentError(msg)
    return values


def _ratios(
    value: Any, owner: str, name: str, example: str, condition: Condition | None = None
) -> list[float]:
    if isinstance(value, str) or not is_iterable(value):
        return [to_ratio(value, owner=owner, name=name, condition=condition, example=example)]
    return [
        to_ratio(ratio, owner=owner, name=f"{name}[{k}]", condition=condition, example=example)
        for k, ratio in enumerate(value)
    ]


def _damping_ratios(value: object, modes: int, owner: str) -> list[float]:
    ratios = _ratios(value, owner, "damping_ratio", "0.05", DAMPING_RATIO)
    if len(ratios) not in (1, modes):
        msg = (
            f"{owner}: damping_ratio needs one value, or one for each of the {modes} modes, "
            f"got {len(ratios)}"
        )
        raise ComponentError(msg)
    return ratios * modes if len(ratios) == 1 else ratios


def _quantity_texts(values: Array, measure: Measure) -> list[str]:
    return [f"{value!r} {measure.unit}" for value in values.tolist()]


_BUILDINGS: Final = (
    # (required arguments, optional arguments, reader)
    (("periods",), ("floor_participations",), _read_modes),
    (("storeys", "period", "floor"), ("modes",), _read_uniform_building),
    (("masses", "stiffnesses", "floor"), ("modes",), _read_shear_building),
)


def _read_building(
    entries: Mapping[str, Any], damping_ratio: object, owner: str
) -> tuple[FloorModes, str, dict[str, Any]]:
    """Return the modes of a building, its description in words, and its arguments."""
    values = {name: value for name, value in entries.items() if value is not None}
    readers = [
        read for needed, more, read in _BUILDINGS
        if set(needed) <= set(values) <= {*needed, *more}
    ]  # fmt: skip
    if not readers:
        found = ", ".join(values) or "none of them"
        known = "; or ".join(_listed(needed) for needed, _, _ in _BUILDINGS)
        msg = f"{owner}: give {known}; got {found}; write for example periods=['0.5 s']"
        raise ComponentError(msg)
    periods, participations, words, arguments = readers[0](values, owner)
    if "modes" in values:
        highest = periods.size
        count = checked_integer(
            values["modes"], owner=owner, name="modes", lowest=1, highest=highest
        )
        periods, participations = periods[:count], participations[:count]
        words += f", of {highest} modes the first {count}"
        arguments["modes"] = count
    ratios = _damping_ratios(damping_ratio, periods.size, owner)
    arguments["damping_ratio"] = ratios if len(set(ratios)) > 1 else ratios[0]
    return FloorModes(periods, np.array(ratios), participations), words, arguments


_ROUNDING: Final = 1e-9
_MODES_LISTED: Final = 10
_MAX_DEVIATION: Final = 0.02
"""Interpolation error between samples, over the peak, that causes a warning [1]."""


class VerticalComponent(StrEnum):
    """Treatment of the vertical component."""

    UNCHANGED = "unchanged"
    OMITTED = "omitted"


@with_hints()
def through_storeys(
    motion: MotionType,
    periods: ArrayLike | Iterable[QuantityLike] | QuantityLike | None = None,
    damping_ratio: RatioLike | Iterable[RatioLike] = 0.05,
    *,
    floor_participations: RatioLike | Iterable[RatioLike] | None = None,
    storeys: int | None = None,
    period: QuantityLike | None = None,
    masses: ArrayLike | Iterable[QuantityLike] | None = None,
    stiffnesses: ArrayLike | Iterable[QuantityLike] | None = None,
    floor: int | None = None,
    modes: int | None = None,
    free_vibration: QuantityLike | None = None,
    time_step: QuantityLike | None = None,
    vertical: VerticalComponent | str = VerticalComponent.UNCHANGED,
) -> MotionType:
    """Compute the motion of a floor of an elastic building on the ground.

    Describe the building by `periods` (one for a single oscillator, several with
    `floor_participations`), by `storeys`, `period` and `floor` for equal storeys, or by
    `masses`, `stiffnesses` and `floor`.

    Parameters
    ----------
    periods : (sequence, unit), Quantity or sequence of str, optional
        Undamped periods of the modes; zero for a rigid mode [s].
    damping_ratio : float, or sequence of float, optional
        Damping ratio, from 0 to 1, of all modes or of each [1].
    floor_participations : sequence of float, optional
        Participation factor times the displacement of the floor in the mode shape, for each mode;
        by default 1 for a single period [1].
    storeys : int, optional
        Number of equal storeys.
    period : str or Quantity, optional
        First period of the building of equal storeys [s].
    masses : (sequence, unit), Quantity or sequence of str, shape (n,), optional
        Masses of the floors, from the lowest up [kg].
    stiffnesses : (sequence, unit), Quantity or sequence of str, shape (n,), optional
        Shear stiffnesses of the storeys below them [N m^-1].
    floor : int, optional
        Floor on which the object stands: 1 is on top of the lowest storey, the number of storeys
        is the roof.
    modes : int, optional
        Number of modes of the storeys to keep, those of the longest periods; by default all.
    free_vibration : str or Quantity, optional
        Duration of free vibration after the ground motion, to zero along a straight line from the
        last sample of a record; by default until every mode has decayed to a hundredth of its
        amplitude [s].
    time_step : str or Quantity, optional
        Greatest time step of the floor motion: that of the ground motion is divided into equal
        parts. The default is that of the ground motion [s].
    vertical : {"unchanged", "omitted"}, optional
        Treatment of the vertical component. Columns and walls are axially stiff, so the floor has
        that of the ground.

    Returns
    -------
    GroundMotion
        The absolute acceleration of the floor.

    Raises
    ------
    UnitsError
        A value without a unit, or of another kind.
    ComponentError
        No building or several are described; a value is out of range; the number of values differs
        from that of modes; no `free_vibration` for an undamped mode; periods too short or a motion
        too long to be sampled.

    Warns
    -----
    RecordWarning
        Between its samples the floor acceleration departs from straight lines by more than 2 %
        of its peak, so that a shorter `time_step` is needed.

    Notes
    -----
    The acceleration is the sum over the modes, :eq:`eq-floor-acceleration`, from rest. If the
    participations do not add up to 1, the rest moves with the ground; so do modes that are left
    out. At the samples the acceleration is exact, for ground motion that is linear or polynomial
    between its samples. Between the samples the floor acceleration is linear. The building does
    not interact with the object.

    Examples
    --------
    >>> import rockframe as rf
    >>> pulse = rf.GroundMotion.sine_pulse("1 m/s^2", "2 Hz")
    >>> roof = pulse.through_storeys(["0.5 s"], damping_ratio=0.05)
    >>> round(roof.peak_acceleration.m_as("m/s^2"), 3)
    2.712
    """
    owner, si = f"{type(motion).__name__}.through_storeys", motion.si
    building, what, arguments = _read_building(
        {
            "periods": periods,
            "floor_participations": floor_participations,
            "storeys": storeys,
            "period": period,
            "masses": masses,
            "stiffnesses": stiffnesses,
            "floor": floor,
            "modes": modes,
        },
        damping_ratio,
        owner,
    )
    vertical_treatment = checked_choice(VerticalComponent, vertical, owner=owner, name="vertical")
    duration = _free_vibration_time(free_vibration, building.participating, owner)
    parts = _step_divisions(time_step, si.time_step, owner)
    _check_size(si, building.participating, duration, parts, owner)
    zeros = math.ceil(duration / si.time_step * (1.0 - _ROUNDING))
    count = len(motion) + zeros
    horizontal, deviation = _floor_motion(padded(si.horizontal, count), building, parts)
    vertical_signal = None
    if si.vertical is not None and vertical_treatment is VerticalComponent.UNCHANGED:
        vertical_signal = divided_signal(padded(si.vertical, count), parts)
    result = Motion(horizontal, vertical_signal)
    if deviation > _MAX_DEVIATION:
        # the deviation falls with the square of the time step, :eq:`eq-floor-chords`
        finer = parts * math.ceil(math.sqrt(deviation / _MAX_DEVIATION))
        msg = (
            f"{owner}: between samples {result.time_step:.4g} s apart the floor's acceleration "
            f"departs from straight lines by up to {100.0 * deviation:.2g} % of its peak; "
            f"give a shorter time_step, for example time_step='{si.time_step / finer:.4g} s'"
        )
        warn(msg, RecordWarning)
    steps = [
        f"absolute acceleration of a floor, {what}: {_modes_words(building)}",
        f"with {zeros * si.time_step:.9g} s of free vibration after the ground motion",
    ]
    if parts > 1:
        steps.append(f"time step divided by {parts}, to {result.time_step!r} s")
    steps.append(
        "straight between samples, where the floor's acceleration departs from that by up to "
        f"{100.0 * deviation:.2g} % of its peak"
    )
    if si.vertical is not None:
        steps.append(f"vertical component {vertical_treatment}")
    operation = {
        "through_storeys": {
            **arguments,
            "free_vibration": f"{duration!r} {TIME.unit}",
            "time_step": f"{result.time_step!r} {TIME.unit}",
            "vertical": str(vertical_treatment),
        }
    }
    dropped = dropped_pieces_note(Motion(si.horizontal))
    lost = cleared_vertical_metadata(motion) if vertical_signal is None else None
    return derived_motion(motion, result, *steps, *dropped, operation=operation, metadata=lost)


def _floor_motion(ground: Signal, modes: FloorModes, parts: int) -> tuple[Signal, float]:
    """Return the floor acceleration, and its deviation from straight lines over its peak."""
    halves = divided_signal(ground, 2 * parts)
    rigid = modes.rigid_participation * divided_signal(ground, parts).samples
    modal = modal_acceleration(halves.pieces, halves.time_step, modes.participating)
    samples = rigid + modal[::2]
    peak = float(np.max(np.abs(samples)))
    midpoint_errors = np.abs(modal[1::2] - 0.5 * (modal[:-1:2] + modal[2::2]))
    deviation = float(np.max(midpoint_errors)) / peak if peak > 0.0 else 0.0
    step = ground.time_step / parts
    return replace(ground, time_step=step, samples=samples, polynomials=None), deviation


def _free_vibration_time(value: QuantityLike | None, modes: FloorModes, owner: str) -> float:
    if value is not None:
        return to_si(value, TIME, owner=owner, name="free_vibration", condition=NOT_NEGATIVE)
    needed = decay_time(modes)
    if math.isfinite(needed):
        return needed
    msg = (
        f"{owner}: a mode without damping never comes to rest; give the duration of its free "
        "vibration, for example free_vibration='20 s'"
    )
    raise ComponentError(msg)


def _step_divisions(value: QuantityLike | None, current: float, owner: str) -> int:
    if value is None:
        return 1
    step = to_si(value, TIME_STEP, owner=owner, name="time_step", condition=POSITIVE)
    if step > current * (1.0 + _ROUNDING):
        msg = (
            f"{owner}: time_step = {step:.6g} s is longer than that of the motion, {current:.6g} "
            "s; leave it out, and use resampled afterwards"
        )
        raise ComponentError(msg)
    return math.ceil(min(current / step * (1.0 - _ROUNDING), float(MAXIMUM_SAMPLES)))


def _check_size(si: Motion, modes: FloorModes, duration: float, parts: int, owner: str) -> None:
    if (si.duration + duration) / si.time_step * parts > MAXIMUM_SAMPLES:
        msg = (
            f"{owner}: {si.duration + duration:.6g} s in steps of {si.time_step / parts:.6g} s "
            f"are more than {MAXIMUM_SAMPLES} samples; give a shorter free_vibration"
        )
        raise ComponentError(msg)
    shortest = si.time_step / MAXIMUM_PARTS
    if (modes.periods < shortest).any():
        msg = (
            f"{owner}: a period of {modes.periods.min():.6g} s is too short for the time "
            f"step, {si.time_step:.6g} s; a rigid mode has the period '0 s'"
        )
        raise ComponentError(msg)


def _modes_words(modes: FloorModes) -> str:
    rows = np.column_stack(modes).tolist()
    phrases = [
        f"period {period:.9g} s, damping ratio {damping:.9g}, participation {participation:.9g}"
        for period, damping, participation in rows[:_MODES_LISTED]
    ]
    if len(rows) > _MODES_LISTED:
        phrases.append(f"{len(rows) - _MODES_LISTED} further modes")
    rigid = modes.rigid_participation
    if abs(rigid) > _ROUNDING:
        phrases.append(f"participation {rigid:.9g} with the ground")
    return "; ".join(phrases)
