"""What becomes of the sum of two rotations, from samples of both and their rates."""

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from rockframe.compiled import Vector
from rockframe.dynamics.protocol import IMPACT, ROTATION_LIMIT, ContactModel, EventKind
from rockframe.solve.books import FLIGHT, ON_SAMPLE, RIGHT_ANGLE
from rockframe.solve.layout import Status
from rockframe.solve.trajectory import Summary, Trajectory

if TYPE_CHECKING:
    from rockframe.solve.cascade import Cascade


@dataclass(frozen=True)
class Reach:
    """When a rotation first reaches a limit, on which side, and its rate there."""

    kind: EventKind
    time: float
    side: int
    rotation: float
    rate: float


def rotation_of(model: ContactModel, run: Trajectory) -> tuple[Vector, Vector]:
    """Give a run's rotation and its rate at the output times."""
    size = len(model.rotation_weights)
    return run.state[:, :size] @ model.rotation_weights, run.state[:, size:] @ (
        model.rotation_weights
    )


def summarise(
    cascade: "Cascade",
    first: Trajectory,
    second: Trajectory,
    *,
    duration: float,
    stop_at_overturning: bool,
) -> tuple[Summary, list[Reach]]:
    """Judge the total rotation of two stages with the same output times.

    Between the samples the rotation is the cubic through both values and rates.
    Samples may go on beyond the duration; what happens there does not count.

    Returns
    -------
    summary : Summary
        Of the total.
    reaches : list of Reach
        Overturning and the fall that ends a run, as far as they happen.
    """
    finished = max(first.status, second.status) is Status.COMPLETED
    count = min(_on_grid(first), _on_grid(second))
    time = second.time[:count]
    rotation, rate = (
        one[:count] + other[:count]
        for one, other in zip(
            rotation_of(cascade.first, first), rotation_of(cascade.second, second), strict=True
        )
    )
    limit = float(cascade.second.parameters[ROTATION_LIMIT])
    history = (time, rotation, rate, *_extremes(time, rotation, rate))
    status = Status.COMPLETED if finished else Status(max(first.status, second.status))
    end = min(duration, float(time[-1]))
    reaches: list[Reach] = []
    overturned = _first_reach(*history, limit, EventKind.OVERTURNING)
    if overturned is not None and overturned.time <= end:
        reaches.append(overturned)
        fallen = _first_reach(*history, RIGHT_ANGLE, EventKind.TOPPLED)
        if stop_at_overturning:
            status, end = Status.OVERTURNED, overturned.time
        elif fallen is not None and fallen.time <= end:
            reaches.append(fallen)
            status, end = Status.TOPPLED, fallen.time
    events = second.events
    flight_time, flight_count = _flights(cascade.second, second, end)
    summary = Summary(
        status=status,
        end_time=end,
        peak_rotation=_peak(history, end),
        overturning_time=reaches[0].time if reaches else math.nan,
        overturning_direction=reaches[0].side if reaches else 0,
        first_uplift_time=second.first_uplift_time if second.first_uplift_time <= end else math.nan,
        flight_time=flight_time,
        impact_count=int(np.sum((events.kind == IMPACT) & (events.time <= end))),
        flight_count=flight_count,
        step_count=first.step_count + second.step_count,
        rejected_count=first.rejected_count + second.rejected_count,
        substeps=max(first.substeps, second.substeps),
        energy_residual=max(first.energy_residual, second.energy_residual),
    )
    return summary, reaches


def _on_grid(run: Trajectory) -> int:
    """Give the number of evenly spaced samples: the end of a run may stand after them."""
    if len(run.time) < 3:
        return len(run.time)
    step = run.time[1]
    uneven = abs(run.time[-1] - (len(run.time) - 1) * step) > 0.5 * ON_SAMPLE * step * len(run.time)
    return len(run.time) - int(uneven)


def _flights(model: ContactModel, run: Trajectory, end: float) -> tuple[float, int]:
    """Give time and number of a run's flights up to an end."""
    before = run.events.time <= end
    modes = np.concatenate([[run.start_mode], run.events.mode_after[before]])
    flying = model.contact[modes] == FLIGHT
    spans = np.diff(np.concatenate([[0.0], run.events.time[before], [end]]))
    entries = flying & ~np.concatenate([[False], flying[:-1]])
    return float(spans[flying].sum()), int(entries.sum())


def _peak(history: tuple[Vector, Vector, Vector, Vector, Vector], end: float) -> float:
    """Give the largest absolute rotation up to an end, which may lie between samples."""
    time, value, rate, place, extreme = history
    largest = [np.abs(value[time <= end]).max(), *np.abs(extreme[place <= end])]
    i = int(np.searchsorted(time, end, side="right")) - 1
    if i + 1 < len(time):
        part = (end - time[i]) / (time[i + 1] - time[i])
        largest.append(abs(_cubic(time, value, rate, i)(part)))
    return float(max(largest))


def _cubic(time: Vector, value: Vector, rate: Vector, i: int) -> np.polynomial.Polynomial:
    h = time[i + 1] - time[i]
    rise, v0, v1 = value[i + 1] - value[i], h * rate[i], h * rate[i + 1]
    return np.polynomial.Polynomial(
        [value[i], v0, 3.0 * rise - 2.0 * v0 - v1, v0 + v1 - 2.0 * rise]
    )


def _extremes(time: Vector, value: Vector, rate: Vector) -> tuple[Vector, Vector]:
    """Give the times and the values of the extremes between samples."""
    h = np.diff(time)
    v0, v1, rise = h * rate[:-1], h * rate[1:], np.diff(value)
    turns = np.flatnonzero(v0 * v1 < 0.0)
    h, v0, v1, rise = h[turns], v0[turns], v1[turns], rise[turns]
    c2, c3 = 3.0 * rise - 2.0 * v0 - v1, v0 + v1 - 2.0 * rise
    # the root of v0 + 2 c2 u + 3 c3 u^2 in (0, 1), in the form that does not cancel
    root = np.sqrt(np.maximum(c2 * c2 - 3.0 * c3 * v0, 0.0))
    with np.errstate(divide="ignore", invalid="ignore"):
        u = np.where(v0 > 0.0, v0 / (root - c2), -v0 / (root + c2))
    u = np.clip(np.nan_to_num(u, nan=0.5), 0.0, 1.0)
    extreme = value[turns] + u * (v0 + u * (c2 + u * c3))
    return time[turns] + u * h, extreme


def _first_reach(
    time: Vector,
    value: Vector,
    rate: Vector,
    place: Vector,
    extreme: Vector,
    limit: float,
    kind: EventKind,
) -> Reach | None:
    """Give when, on which side and how fast the value first reaches a limit."""
    from scipy.optimize import root_scalar

    over = np.flatnonzero(np.abs(value) >= limit)
    beyond = place[np.abs(extreme) >= limit]
    candidates = [float(time[over[0]])] if len(over) else []
    candidates += [float(beyond[0])] if len(beyond) else []
    if not candidates:
        return None
    end = min(candidates)
    i = max(int(np.searchsorted(time, end, side="left")) - 1, 0)
    cubic = _cubic(time, value, rate, i)
    h = float(time[i + 1] - time[i])
    last = (end - float(time[i])) / h
    side = 1 if cubic(last) > 0.0 else -1
    u = last
    if side * cubic(0.0) < limit <= side * cubic(last):
        u = root_scalar(lambda u: side * cubic(u) - limit, bracket=(0.0, last), xtol=1e-14).root
    return Reach(kind, float(time[i]) + u * h, side, side * limit, float(cubic.deriv()(u)) / h)
