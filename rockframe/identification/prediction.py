"""Unknowns of a fit, the rotation that they predict, and start values of the search."""

import math
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from enum import StrEnum
from functools import lru_cache
from itertools import pairwise
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from rockframe.components import Component, Stack
from rockframe.components.parameters import Ratio
from rockframe.dynamics.protocol import Start
from rockframe.errors import ComponentError, did_you_mean, short_repr
from rockframe.identification.measured import OWNER, History, MeasuredPeaks, Swings, restitution_of
from rockframe.signals.arrays import Array
from rockframe.simulation.system import System
from rockframe.solve.accuracy import Accuracy
from rockframe.solve.integrate import integrate
from rockframe.system.assembly import Assembly, assemble
from rockframe.system.options import Rotation

_OPEN_BOUND_MARGIN: Final = 1e-6
"""Distance of the search from an open lower bound, as a share of an unknown's size."""
_MIN_SCALE: Final = 0.01
"""Size of a ratio whose start value is zero."""


class Circumstance(StrEnum):
    """Quantities of the test itself that may be unknown."""

    INITIAL_ROTATION = "initial_rotation"
    RELEASE_TIME = "release_time"
    GAUGE_OFFSET = "gauge_offset"


@dataclass(frozen=True)
class Unknown:
    """A parameter or circumstance that is to be found."""

    name: str
    start: float  # start value of the search
    scale: float  # typical size, the unit of its steps
    lower: float = -math.inf  # bounds
    upper: float = math.inf

    def with_start(self, value: float) -> "Unknown":
        """Return the unknown with another start value, within the bounds."""
        return replace(self, start=min(max(value, self.lower), self.upper))


def with_starts(unknowns: Sequence[Unknown], values: NDArray[np.float64]) -> list[Unknown]:
    """Return the unknowns with other start values, within their bounds."""
    return [
        unknown.with_start(float(value)) for unknown, value in zip(unknowns, values, strict=True)
    ]


@dataclass(frozen=True)
class PartParameter:
    """A parameter of a part."""

    part: int  # index of the part
    argument: str  # name of the part's argument
    start: float  # its value in the system that was tested
    bounds: tuple[float, float]  # bounds of the values that the part accepts

    def unknown(self, name: str) -> Unknown:
        """Return the parameter as an unknown of a fit."""
        scale = abs(self.start) or _MIN_SCALE
        lower, upper = self.bounds[0] + _OPEN_BOUND_MARGIN * scale, self.bounds[1]
        return Unknown(name, self.start, scale, lower, upper).with_start(self.start)


class TrialSystems:
    """Systems that differ from the tested one in the parameters that are to be found."""

    def __init__(self, system: System, names: Sequence[str]) -> None:
        self._parts = system.parts.with_ground().structural()
        self._options: dict[str, Any] = system.options.to_dict()
        self.radius = system.parts.block_si.radius
        self.gravity = system.options.gravity
        known = dict(self._ratios(system))
        inside = {
            f"{type(interface).__name__}.{name}"
            for part in self._parts
            if isinstance(part, Stack)
            for interface in part.interfaces
            for name, _ in _declared_ratios(interface)
        }
        self.parameters = {name: _find_parameter(name, known, inside) for name in names}

    def _ratios(self, system: System) -> Iterator[tuple[str, PartParameter | None]]:
        """Find the dimensionless parameters of all parts; None for one without a start value."""
        usual = {"restitution": system.parts.block_si.maximum_restitution}
        for index, part in enumerate(self._parts):
            for argument, declared in _declared_ratios(part):
                value = part.to_dict().get(argument, usual.get(argument))
                condition = declared.condition
                bounds = (-math.inf, math.inf) if condition is None else condition.bounds
                known = value is not None
                parameter = PartParameter(index, argument, float(value), bounds) if known else None
                yield f"{type(part).__name__}.{argument}", parameter

    def _parts_with(self, values: Mapping[str, float]) -> list[Component]:
        """Return the parts with these values of the parameters."""
        changes: dict[int, dict[str, float]] = {}
        for name, value in values.items():
            parameter = self.parameters[name]
            changes.setdefault(parameter.part, {})[parameter.argument] = value
        return [
            type(part).from_dict({**part.to_dict(), **changes[index]}) if index in changes else part
            for index, part in enumerate(self._parts)
        ]

    def assembly(self, values: Mapping[str, float]) -> Assembly:
        """Assemble a system for a run, without the warnings for users."""
        return assemble(self._parts_with(values), **self._options)

    def system(self, values: Mapping[str, float]) -> System:
        """Return the system with these values of the parameters."""
        return System(*self._parts_with(values), **self._options)


def _declared_ratios(part: Component) -> list[tuple[str, Ratio[Any]]]:
    declared = sorted(part.declared().items())
    return [(name, parameter) for name, parameter in declared if isinstance(parameter, Ratio)]


def _find_parameter(
    name: object, known: Mapping[str, PartParameter | None], inside: Collection[str]
) -> PartParameter:
    matches = [full for full in known if name in (full, full.partition(".")[2])]
    if len(matches) == 1:
        parameter = known[matches[0]]
        if parameter is not None:
            return parameter
        msg = (
            f"{OWNER}: {short_repr(name)} cannot be fitted, since the part was given without it; "
            f"give {matches[0]} as a start value, instead of what stands for it"
        )
        raise ComponentError(msg)
    choice = ", ".join(repr(full) for full in (matches or known))
    if not matches and any(name in (full, full.partition(".")[2]) for full in inside):
        fitted = f"of the parts of the system, which are {choice}" if known else "of other parts"
        msg = (
            f"{OWNER}: {short_repr(name)} is a parameter of an interface of the Stack; fitted are "
            f"those {fitted}. To find that of an interface, compare the measured rotation with "
            "runs of a sweep over a function that returns the system"
        )
        raise ComponentError(msg)
    fault = "several parts have" if matches else "no part of the system has, as a pure ratio,"
    near = "" if matches else did_you_mean(name, {full.rpartition(".")[2] for full in known})
    msg = f"{OWNER}: {fault} the parameter {short_repr(name)}; expected one of {choice}{near}"
    raise ComponentError(msg)


SAMPLES_PER_PERIOD: Final = 100
"""Samples in the shortest period of the model. Between two samples a cubic interpolates; its error
is (2 pi / 100)^4 / 384, or 4e-8, of a vibration's amplitude."""
_DOUBLINGS: Final = 6
"""Number of times that the duration of a run with too few peaks is doubled."""


@dataclass(frozen=True)
class FreeMotion:
    """History of the rotation after a release, at samples and twice at each event."""

    time: Array  # since the release [s]
    rotation: Array  # [rad]
    rate: Array  # angular velocity, which jumps between both samples of an event [rad s^-1]

    def at(self, time: Array) -> Array:
        """Return the rotation, constant before the release and after the end of the run [rad]."""
        inside = np.clip(time, self.time[0], self.time[-1])
        first = np.searchsorted(self.time, inside, side="right") - 1
        first = np.clip(first, 0, self.time.size - 2)
        length = self.time[first + 1] - self.time[first]
        share = (inside - self.time[first]) / np.where(length > 0.0, length, 1.0)
        start, slope, square, cube = self._cubics(first)
        return start + share * (slope + share * (square + share * cube))

    def first_crossing(self) -> float:
        """Return the time of the first passage through zero, or of the end without one [s]."""
        beyond = np.flatnonzero(self.rotation * self.rotation[0] <= 0.0)
        return float(self.time[beyond[0] if beyond.size else -1])

    def peaks(self) -> tuple[Array, Array]:
        """Return times [s] and magnitudes [rad] of the peaks between passages through zero."""
        side = np.sign(self.rotation)
        nonzero = np.flatnonzero(side)
        side_changes = nonzero[1:][side[nonzero[1:]] != side[nonzero[:-1]]]
        edges = np.concatenate([nonzero[:1], side_changes])
        peaks = [
            self._peak(first + int(np.argmax(np.abs(self.rotation[first:end]))))
            for first, end in pairwise(edges.tolist())
        ]
        times, sizes = zip(*peaks, strict=True) if peaks else ((), ())
        return np.array(times), np.array(sizes)

    def _peak(self, node: int) -> tuple[float, float]:
        """Find time and magnitude of the peak beside the sample of largest rotation."""
        rises = self.rate[node] * self.rotation[node] > 0.0
        first = node if rises else node - 1
        if first < 0 or self.time[first + 1] <= self.time[first]:
            return float(self.time[node]), float(abs(self.rotation[node]))
        start, slope, square, cube = (float(of[0]) for of in self._cubics(np.array([first])))
        # root of slope + 2 square s + 3 cube s^2, in a form that is accurate for a small cube too
        discriminant = max(0.0, square * square - 3.0 * cube * slope)
        divisor = -square - math.copysign(math.sqrt(discriminant), square)
        share = min(max(slope / divisor, 0.0), 1.0) if divisor != 0.0 else 0.0
        size = abs(start + share * (slope + share * (square + share * cube)))
        length = float(self.time[first + 1] - self.time[first])
        return float(self.time[first]) + share * length, size

    def _cubics(self, first: NDArray[np.intp]) -> tuple[Array, Array, Array, Array]:
        """Return the coefficients of the cubic through rotations and rates of two samples [rad]."""
        length = self.time[first + 1] - self.time[first]
        start, step = self.rotation[first], self.rotation[first + 1] - self.rotation[first]
        start_slope, end_slope = self.rate[first] * length, self.rate[first + 1] * length
        square = 3.0 * step - 2.0 * start_slope - end_slope
        return start, start_slope, square, start_slope + end_slope - 2.0 * step


def release_response(
    system: Assembly, rotation: float, duration: float, accuracy: Accuracy
) -> FreeMotion:
    """Compute the motion of a system that is released from rest at a rotation, on still ground."""
    model = system.setting.compile()
    step = 2.0 * math.pi / model.fastest_frequency / SAMPLES_PER_PERIOD
    # the last sample may be up to one step before the end
    run = integrate(
        model, Start(rotation), None, accuracy, duration=duration + step, output_step=step
    )
    weights, count = model.rotation_weights, len(model.rotation_weights)
    rates = slice(count, 2 * count)
    events = run.events
    time = np.concatenate([np.repeat(events.time, 2), run.time])
    event_states = np.stack([events.state_before, events.state_after], axis=1)
    state = np.concatenate([event_states.reshape(-1, run.state.shape[1]), run.state])
    # a sample at the instant of an event has the rate of one side of its jump only
    is_valid = np.ones(time.size, dtype=bool)
    is_valid[2 * events.time.size :] = ~np.isin(run.time, events.time[events.time > 0.0])
    order = np.argsort(time[is_valid], kind="stable")
    state = state[is_valid][order]
    return FreeMotion(time[is_valid][order], state[:, :count] @ weights, state[:, rates] @ weights)


def first_peaks(
    system: Assembly, rotation: float, count: int, duration: float, accuracy: Accuracy
) -> tuple[Array, Array]:
    """Return times and magnitudes of the first peaks after a release, zero for missing ones."""
    motion = release_response(system, rotation, duration, accuracy)
    times, sizes = motion.peaks()
    for _ in range(_DOUBLINGS):
        if times.size >= count:
            break
        duration *= 2.0
        motion = release_response(system, rotation, duration, accuracy)
        times, sizes = motion.peaks()
    missing = (0, max(0, count - times.size))
    times = np.pad(times, missing, constant_values=motion.time[-1])
    return times[:count], np.pad(sizes, missing)[:count]


RELEASE_MARGIN: Final = 0.25
"""Share of a history's duration by which the release may precede its first sample."""
_CACHE_SIZE: Final = 4
"""Number of runs that are kept, since other values of offset and release time need no new run."""


class Prediction:
    """Prediction of the measured data from values of the unknowns."""

    def __init__(
        self,
        trials: TrialSystems,
        names: Sequence[str],
        known: Mapping[str, float],
        accuracy: Accuracy,
    ) -> None:
        self.trials = trials
        self.names = names
        self._known = known
        self._accuracy = accuracy
        self._found: Any = lru_cache(maxsize=_CACHE_SIZE)(self._run)

    def values(self, estimates: Array) -> dict[str, float]:
        """Return the values of all parameters and circumstances by name, including known ones."""
        return {**self._known, **dict(zip(self.names, estimates.tolist(), strict=True))}

    def history(self, estimates: Array, measured: History) -> Array:
        """Return the rotation that the gauge would show at the times of a history [rad]."""
        values = self.values(estimates)
        duration = (1.0 + RELEASE_MARGIN) * measured.span
        motion = self._found(release_response, *self._key(values), duration)
        since = measured.time - values[Circumstance.RELEASE_TIME]
        return values[Circumstance.GAUGE_OFFSET] + motion.at(since)

    def peaks(self, estimates: Array, measured: MeasuredPeaks) -> tuple[Array, Array]:
        """Return times [s] and rotations [rad] of the peaks that the gauge would show."""
        values = self.values(estimates)
        extent = measured.rotation.size, self._run_duration(measured)
        times, sizes = self._found(first_peaks, *self._key(values), *extent)
        rotation = values[Circumstance.GAUGE_OFFSET] + measured.sides * sizes
        return values[Circumstance.RELEASE_TIME] + times, rotation

    def _key(self, values: Mapping[str, float]) -> tuple[tuple[float, ...], float]:
        parameters = tuple(values[name] for name in self.trials.parameters)
        return parameters, values[Circumstance.INITIAL_ROTATION]

    def _run(
        self, compute: Callable[..., Any], parameters: tuple[float, ...], *extent: float
    ) -> Any:
        """Compute a motion or its peaks from the parameters, initial rotation and so on."""
        values = dict(zip(self.trials.parameters, parameters, strict=True))
        return compute(self.trials.assembly(values), *extent, self._accuracy)

    def _run_duration(self, measured: MeasuredPeaks) -> float:
        """Return the duration of a run that is likely to contain all peaks [s]."""
        if measured.time is not None:
            return 1.5 * float(measured.time[-1] - np.nanmin(measured.time))
        radius, gravity = self.trials.radius, self.trials.gravity
        return 2.0 * measured.rotation.size * math.sqrt(radius / gravity)


_MAX_INITIAL_RATIO: Final = 1.0 - 1e-6
"""Largest initial rotation, as a share of the overturning angle."""


def start_values(
    system: System,
    trials: TrialSystems,
    measured: History | MeasuredPeaks,
    swings: Swings,
    fitted: Collection[Circumstance],
    accuracy: Accuracy,
) -> dict[str, Unknown]:
    """Return start values and bounds of all parameters and circumstances."""
    offset = swings.offset if Circumstance.GAUGE_OFFSET in fitted else 0.0
    about_offset = swings.peaks.rotation - offset
    first = float(about_offset[0])
    starts = {name: place.unknown(name) for name, place in trials.parameters.items()}
    angles, body = system.setting.overturning_angles, system.setting.body
    if system.setting.settlement is None and about_offset.size > 1:
        left, right = (
            math.hypot(arm, body.centre_height) / body.gyration_square_about(arm)
            for arm in (body.left, body.right)
        )
        restitution = restitution_of(
            about_offset,
            np.where(about_offset < 0.0, angles.left, angles.right),
            np.where(about_offset < 0.0, left / right, 1.0),
            small_rotation=system.rotation is Rotation.SMALL,
        )
        for name, place in trials.parameters.items():
            if place.argument == "restitution":
                starts[name] = place.unknown(name).with_start(restitution)
    limit = math.copysign(_MAX_INITIAL_RATIO * angles.on_side_of(first), first)
    rotation = Unknown(
        Circumstance.INITIAL_ROTATION, first, abs(first), min(limit, 0.0), max(limit, 0.0)
    ).with_start(first)
    period = math.sqrt(trials.radius / trials.gravity)
    release = Unknown(Circumstance.RELEASE_TIME, 0.0, period)
    if isinstance(measured, History):
        begin, end, span = float(measured.time[0]), float(measured.time[-1]), measured.span
        release = Unknown(
            Circumstance.RELEASE_TIME, begin, period, begin - RELEASE_MARGIN * span, end
        )
        if Circumstance.RELEASE_TIME in fitted:
            system_at_start = trials.assembly({name: at.start for name, at in starts.items()})
            motion = release_response(system_at_start, rotation.start, span, accuracy)
            release = release.with_start(swings.crossing - motion.first_crossing())
    elif measured.time is not None:
        release = release.with_start(float(measured.time[0]))
    gauge = Unknown(Circumstance.GAUGE_OFFSET, offset, abs(first))
    return {**starts, **{unknown.name: unknown for unknown in (rotation, release, gauge)}}
