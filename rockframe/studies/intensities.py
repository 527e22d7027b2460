"""Intensity measures of the motions of a sweep, and of a motion that is scaled."""

import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Final, TypeAlias

import numpy as np
import xarray as xr

from rockframe.arguments import checked_name, checked_text
from rockframe.errors import ComponentError, SchemaError, StudyError, did_you_mean, short_repr
from rockframe.measures import average_spectral_acceleration, intensity_measures, response_spectrum
from rockframe.measures.intensity import measure_of_ground
from rockframe.measures.response import checked_periods
from rockframe.motion import GroundMotion
from rockframe.results.joining import described_motions
from rockframe.results.schema import SCHEMA, labels_in_unit
from rockframe.results.variables.studies import MOTION
from rockframe.results.variables.variable import OSCILLATOR
from rockframe.simulation.system import System
from rockframe.studies.sweeps.axes import Changes, described_axes
from rockframe.studies.sweeps.case import known_motions
from rockframe.studies.sweeps.motions import (
    ABBREVIATIONS,
    SCALE,
    SPECTRAL_ACCELERATION,
    motion_of_case,
    named_motions,
)
from rockframe.units import (
    ACCELERATION,
    PERIOD,
    POSITIVE,
    QuantityLike,
    RatioLike,
    quantity,
    to_ratio,
    to_si,
)

PeriodLike: TypeAlias = QuantityLike | tuple[Any, str] | Sequence[QuantityLike]

VELOCITY_ACCELERATION_RATIO: Final = "velocity_to_acceleration_ratio"
AVERAGE: Final = "average_spectral_acceleration"
MEASURE_ABBREVIATIONS: Final = {
    **ABBREVIATIONS,
    "PGD": "peak_ground_displacement",
    "CAV": "cumulative_absolute_velocity",
    "PGV/PGA": VELOCITY_ACCELERATION_RATIO,
    "Sa_avg": AVERAGE,
}
"""Usual abbreviations of measures, and their names."""
SCALE_EXPONENTS: Final = {
    "peak_ground_acceleration": 1,
    "peak_ground_velocity": 1,
    "peak_ground_displacement": 1,
    "arias_intensity": 2,
    "cumulative_absolute_velocity": 1,
    "housner_spectrum_intensity": 1,
    "mean_period": 0,
    "predominant_velocity_period": 0,
    "significant_duration_5_75": 0,
    "significant_duration_5_95": 0,
    VELOCITY_ACCELERATION_RATIO: 0,
    "spectral_displacement": 1,
    "spectral_velocity": 1,
    "absolute_spectral_acceleration": 1,
    "pseudo_spectral_velocity": 1,
    SPECTRAL_ACCELERATION: 1,
    AVERAGE: 1,
}
"""Powers of the scale of the motion with which measures grow."""
_SPELLINGS: Final = {short.casefold(): name for short, name in MEASURE_ABBREVIATIONS.items()} | {
    name.replace("_", " "): name for name in SCALE_EXPONENTS
}
"""Names of measures by their accepted spellings, in small letters."""
PERIOD_ATTRIBUTE: Final = "intensity_period"
"""Attribute that keeps the period of a spectral intensity, or those of an average [s]."""
Periods: TypeAlias = float | tuple[float, ...] | None
"""Period of an oscillator, or periods over which spectral values are averaged [s]."""
OSCILLATORS: Final = tuple(name for name in SCALE_EXPONENTS if SCHEMA[name].dims == OSCILLATOR)
"""Measures that need the period of an oscillator."""
_PERIOD_DEPENDENT: Final = (*OSCILLATORS, AVERAGE)
"""Measures that depend on a period, or on several."""


def measure_name(value: object) -> object:
    """Return the name of a measure for an abbreviation, or another spelling."""
    written = " ".join(value.split()).casefold() if isinstance(value, str) else ""
    return _SPELLINGS.get(written, value)


def measure_words(name: str, period: Any) -> str:
    """Write the name of a measure in words, for a spectral value with its period or periods [s]."""
    words = name.replace("_", " ")
    if period is None or name not in _PERIOD_DEPENDENT:
        return words
    periods = np.atleast_1d(period)
    if name == AVERAGE:
        return f"{words}, {periods[0]:.4g} to {periods[-1]:.4g} s"
    return f"{words} at {periods[0]:.6g} s"


def measure_attributes(measure: "Intensity | ScaledIntensity") -> dict[str, Any]:
    """Return the attributes in which a dataset records its measure, and period or periods of it."""
    period = np.array(measure.period) if isinstance(measure.period, tuple) else measure.period
    recorded = {"intensity": measure.name, PERIOD_ATTRIBUTE: period}
    return {name: value for name, value in recorded.items() if value is not None}


_SPECTRAL_AT_PERIOD: Final = re.compile(r"(?i)sa *[(\[] *([\d.]*).*[)\]]")
"""A spectral acceleration as other programs write it: ``Sa(1.0)``, ``SA[T1]``."""


def _check_no_period(name: object, owner: str) -> None:
    """Refuse the name of a measure that contains its period."""
    found = _SPECTRAL_AT_PERIOD.fullmatch(name) if isinstance(name, str) else None
    if found is not None:
        msg = (
            f"{owner}: intensity {name!r} contains a period; write intensity='SA', "
            f"period='{found[1] or '0.5'} s'"
        )
        raise ComponentError(msg)


@dataclass(frozen=True)
class Intensity:
    """An intensity measure."""

    name: str  # in the schema
    period: Periods  # of a spectral value

    @classmethod
    def read(cls, value: object, period: PeriodLike | None, *, owner: str) -> "Intensity":
        """Read the arguments ``intensity`` and ``period``."""
        value = measure_name(value)
        _check_no_period(value, owner)
        name = checked_name(
            value, [*SCALE_EXPONENTS, *MEASURE_ABBREVIATIONS], owner=owner, name="intensity"
        )
        if name not in _PERIOD_DEPENDENT:
            return cls(name, None)
        several = name == AVERAGE
        if period is None:
            needed = "the periods over which it is averaged" if several else "a period"
            example = "(numpy.linspace(0.2, 3, 57), 's')" if several else "'0.5 s'"
            msg = f"{owner}: intensity {name!r} needs {needed}, for example period={example}"
            raise ComponentError(msg)
        if not several:
            single: Any = period
            return cls(name, to_si(single, PERIOD, owner=owner, name="period", condition=POSITIVE))
        periods = tuple(checked_periods(period, owner=owner).tolist())
        if periods[0] <= 0.0:
            msg = f"{owner}: periods must be above zero, whose logarithm is averaged"
            raise ComponentError(msg)
        return cls(name, periods)

    def compute(self, motion: GroundMotion) -> float:
        """Return the measure of a motion, in SI units."""
        if isinstance(self.period, tuple):
            return float(average_spectral_acceleration(motion, (self.period, "s"))[self.name])
        if self.period is not None:
            spectrum = response_spectrum(motion, [quantity(self.period, PERIOD)])[self.name]
            return float(spectrum.squeeze())
        if self.name == VELOCITY_ACCELERATION_RATIO:
            names = "peak_ground_velocity", "peak_ground_acceleration"
            velocity, acceleration = (measure_of_ground(motion, name) for name in names)
            return velocity / acceleration
        return measure_of_ground(motion, self.name)

    def attributes(self) -> dict[str, Any]:
        """Return the CF attributes of its values."""
        return SCHEMA[self.name].attributes()


def measure_of_runs(
    runs: xr.Dataset, value: object, period: PeriodLike | None, motions: object, *, owner: str
) -> xr.DataArray:
    """Return a measure of the motion of each case: a known one, a column by name, or numbers."""
    if motions is not None:
        named_motions(motions)  # also where they are not needed
    value = column_of_runs(runs, value)
    named = str(measure_name(value))
    known = isinstance(value, str) and named in runs.variables
    if known and (named not in _PERIOD_DEPENDENT or _has_period(runs, named, period, owner)):
        return runs[named]
    if isinstance(value, xr.DataArray) and value.dtype.kind not in "biuf":
        msg = f"{owner}: {value.name!r} has no numbers, but words or objects; it is no intensity"
        raise ComponentError(msg)
    if not isinstance(value, xr.DataArray):
        which = Intensity.read(value, period, owner=owner)
        return intensity_of_runs(runs, which, motions, owner=owner)
    return aligned_with_runs(runs, value, "intensity", owner=owner)


def aligned_with_runs(
    runs: xr.Dataset, array: xr.DataArray, what: str, *, owner: str
) -> xr.DataArray:
    """Return the user's numbers in the order of the runs' labels; NaN where one is missing."""
    dims = runs["status"].dims
    if array.name is None or not set(array.dims) <= set(dims):
        article = "an" if what == "intensity" else "a"
        msg = (
            f"{owner}: {article} {what} of one's own needs a name and dimensions among "
            f"{', '.join(map(str, dims))}, got {array.name!r} over {array.dims}"
        )
        raise ComponentError(msg)
    for dim in array.dims:
        twice = dim in array.indexes and not array.indexes[dim].is_unique
        if twice and dim in runs.indexes and array.indexes[dim].equals(runs.indexes[dim]):
            continue
        if dim in array.indexes and dim in runs.indexes and not twice:
            array = array.reindex({dim: runs.indexes[dim]})
        elif twice or array.sizes[dim] != runs.sizes[dim]:
            words = "labels that stand twice" if twice else f"{array.sizes[dim]} values"
            msg = (
                f"{owner}: the {what} {array.name!r} has {words} along {str(dim)!r}, of which "
                f"the runs have {runs.sizes[dim]}"
            )
            raise ComponentError(msg)
    return array


def column_of_runs(runs: xr.Dataset, value: object) -> object:
    """Return a column of the runs by its name, unless a known measure has this name."""
    known = measure_name(value)
    if isinstance(known, str) and known not in SCALE_EXPONENTS and known in runs.variables:
        return runs[known]
    return value


def _has_period(runs: xr.Dataset, name: str, period: PeriodLike | None, owner: str) -> bool:
    """Return whether the runs have a spectral measure of the requested period."""
    known = runs.attrs.get(PERIOD_ATTRIBUTE, runs.attrs.get("spectral_period"))
    if period is None:
        return True
    requested: Any = Intensity.read(name, period, owner=owner).period
    return known is not None and np.array_equal(np.atleast_1d(known), np.atleast_1d(requested))


def period_attribute(
    runs: xr.Dataset | None, measures: Iterable[object], period: PeriodLike | None, *, owner: str
) -> dict[str, Any]:
    """Return the period of a spectral measure, or those of an average, as an attribute."""
    named = [measure_name(measure) for measure in measures if not isinstance(measure, xr.DataArray)]
    known: Any = {} if runs is None else runs.attrs
    if period is not None:
        several = AVERAGE if AVERAGE in named else SPECTRAL_ACCELERATION
        known = measure_attributes(Intensity.read(several, period, owner=owner))
    elif not any(name in _PERIOD_DEPENDENT for name in named):
        return {}
    return {name: known[name] for name in (PERIOD_ATTRIBUTE,) if name in known}


def intensity_of_runs(
    runs: xr.Dataset, intensity: Intensity, motions: object, *, owner: str
) -> xr.DataArray:
    """Return an intensity measure of the motion of each case of a sweep."""
    if intensity.name in runs.coords and intensity.period is None:
        return runs[intensity.name]
    before = _motions_of_runs(runs, motions, owner)
    factor = _scale_factors(runs, before, owner)
    measured = map_motions(runs, before, intensity.compute)
    values = measured * np.abs(factor) ** SCALE_EXPONENTS[intensity.name]
    return values.assign_attrs(intensity.attributes()).rename(intensity.name)


def _motions_of_runs(runs: xr.Dataset, value: object, owner: str) -> dict[str, GroundMotion]:
    """Return the motions of a sweep by their names, as they were before they were scaled."""
    if MOTION not in runs.coords:
        msg = f"{owner}: found runs without the coordinate {MOTION!r}; expected it, as sweeps have"
        raise SchemaError(msg)
    used = set(runs[MOTION].to_numpy().astype(str).ravel().tolist())
    unknown = sorted(used - set(described_motions(runs, owner=owner)))
    if unknown:
        msg = (
            f"{owner}: the sweep had no motion {unknown[0]!r}; datasets that were put together "
            "tell the motions of the first alone: run all motions in one sweep, or give the "
            "intensity as a DataArray"
        )
        raise StudyError(msg)
    motions = known_motions(runs, value, needed=True, owner=owner)
    if len(motions) < len(used):
        msg = f"{owner}: the sweep has no motions of its own, of which there is an intensity"
        raise StudyError(msg)
    return motions


def map_motions(
    runs: xr.Dataset, motions: Mapping[str, GroundMotion], value: Callable[[GroundMotion], float]
) -> xr.DataArray:
    """Return a number of each case by a function of its motion."""
    numbers = {name: value(motion) for name, motion in motions.items()}
    names = runs[MOTION]
    values = np.array([numbers[str(name)] for name in names.to_numpy().ravel()])
    return xr.DataArray(values.reshape(names.shape), dims=names.dims, coords=names.coords)


def _scale_factors(
    runs: xr.Dataset, motions: Mapping[str, GroundMotion], owner: str
) -> xr.DataArray:
    """Return the factor by which the motion of each case was multiplied."""
    axes = [axis for axis in described_axes(runs, owner=owner) if axis.changes is Changes.MOTION]
    if not axes:
        return xr.DataArray(1.0)
    name = axes[0].name
    labels = labels_in_unit(runs[name], axes[0].unit, owner=owner)
    if name == SCALE:
        return labels

    def unit_factor(motion: GroundMotion) -> float:
        """Return the factor that reaches the unit of the target."""
        scaled = motion_of_case(motion, name, 1.0, runs.attrs.get("spectral_period"))
        at = int(np.argmax(np.abs(motion.si.horizontal.samples)))
        return abs(float(scaled.si.horizontal.samples[at] / motion.si.horizontal.samples[at]))

    return labels * map_motions(runs, motions, unit_factor)


_BLOCK_VARIABLES: Final = ("overturning_angle", "uplift_acceleration")
"""Variables among the measures that depend on the block alone."""


class ScaledIntensity:
    """An intensity measure of a motion at any scale."""

    def __init__(
        self,
        system: System,
        motion: GroundMotion,
        name: object,
        *,
        period: QuantityLike | None,
        damping_ratio: RatioLike,
        owner: str,
    ) -> None:
        self._motion, self._system = motion, system
        name = measure_name(checked_text(name, owner=owner, name="intensity"))
        _check_no_period(name, owner)
        self._damping = to_ratio(damping_ratio, owner=owner, name="damping_ratio")
        spectral = name in OSCILLATORS
        if spectral != (period is not None):
            needed = "needs a period, for example period='0.5 s'" if spectral else "has no period"
            msg = f"{owner}: intensity {short_repr(name)} {needed}"
            raise ComponentError(msg)
        self.period = None if period is None else to_si(period, PERIOD, owner=owner, name="period")
        known = sorted({*map(str, self._measures(motion)), *OSCILLATORS} - {*_BLOCK_VARIABLES})
        if name not in known:
            near = did_you_mean(name, [*MEASURE_ABBREVIATIONS, *known])
            msg = (
                f"{owner}: intensity must be one of {', '.join(known)}, got "
                f"{short_repr(name)}{near}"
            )
            raise ComponentError(msg)
        self.name = str(name)

    def at_scale(self, scale: float) -> xr.DataArray:
        """Return the measure of the scaled motion; NaN unless the scale is above zero."""
        motion = self._motion.scaled(scale) if scale > 0.0 else self._motion
        intensity = self._measures(motion)[self.name].isel(dict.fromkeys(SCHEMA[self.name].dims, 0))
        return intensity if scale > 0.0 else xr.full_like(intensity, np.nan)

    def _measures(self, motion: GroundMotion) -> xr.Dataset:
        if self.period is not None:
            return response_spectrum(motion, [quantity(self.period, PERIOD)], self._damping)
        gravity = quantity(self._system.options.gravity, ACCELERATION)
        return intensity_measures(
            motion, block=self._system.parts.block, damping_ratio=self._damping, gravity=gravity
        )
