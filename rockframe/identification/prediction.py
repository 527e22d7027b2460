"""Rotation of a test as predicted from the unknowns, and start values of the search."""

import math
from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from rockframe.dynamics.protocol import Start
from rockframe.identification.measured import History, MeasuredPeaks, Swings, restitution_of
from rockframe.identification.unknowns import Circumstance, TrialSystems, Unknown
from rockframe.signals.arrays import Array
from rockframe.simulation.system import System
from rockframe.solve.accuracy import Accuracy
from rockframe.solve.integrate import integrate
from rockframe.system.assembly import Assembly
from rockframe.system.options import Rotation

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
        start, slope, square, cube = (
            float(coefficient[0]) for coefficient in self._cubics(np.array([first]))
        )
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
