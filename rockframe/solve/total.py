"""What becomes of the sum of two rotations, from samples of both and their rates."""

import math
from typing import TYPE_CHECKING

import numpy as np

from rockframe.compiled import Vector
from rockframe.dynamics.protocol import IMPACT, ROTATION_LIMIT, ContactModel
from rockframe.solve.layout import Status
from rockframe.solve.trajectory import Summary, Trajectory

if TYPE_CHECKING:
    from rockframe.solve.cascade import Cascade


def rotation_of(model: ContactModel, run: Trajectory) -> tuple[Vector, Vector]:
    """Give a run's rotation and its rate at the output times."""
    size = len(model.rotation_weights)
    return run.state[:, :size] @ model.rotation_weights, run.state[:, size:] @ (
        model.rotation_weights
    )


def summarise(
    cascade: "Cascade", first: Trajectory, second: Trajectory, *, stop_at_overturning: bool
) -> tuple[Summary, float]:
    """Judge the total rotation of two stages with the same output times.

    Between the samples the rotation is the cubic through both values and rates.

    Returns
    -------
    summary : Summary
        Of the total.
    overturning_rate : float
        Rate of the total rotation at overturning, NaN if it does not overturn [rad s^-1].
    """
    count = min(len(first.time), len(second.time))
    time = second.time[:count]
    rotation, rate = (
        one[:count] + other[:count]
        for one, other in zip(
            rotation_of(cascade.first, first), rotation_of(cascade.second, second), strict=True
        )
    )
    limit = float(cascade.second.parameters[ROTATION_LIMIT])
    place, extreme = _extremes(time, rotation, rate)
    crossing, side, overturning_rate = _first_reach(time, rotation, rate, place, extreme, limit)
    status = max(first.status, second.status)
    end = float(time[-1])
    if not math.isnan(crossing) and stop_at_overturning:
        status, end = Status.OVERTURNED, crossing
    before = time <= end
    events = second.events
    peaks = [np.abs(rotation[before]).max(), *np.abs(extreme[place <= end])]
    if status is Status.OVERTURNED:
        peaks = [limit]
    summary = Summary(
        status=Status(status),
        end_time=end,
        peak_rotation=float(max(peaks)),
        overturning_time=crossing,
        overturning_direction=side,
        first_uplift_time=second.first_uplift_time if second.first_uplift_time <= end else math.nan,
        flight_time=second.flight_time,
        impact_count=int(np.sum((events.kind == IMPACT) & (events.time <= end))),
        flight_count=second.flight_count,
        step_count=first.step_count + second.step_count,
        rejected_count=first.rejected_count + second.rejected_count,
        energy_residual=max(first.energy_residual, second.energy_residual),
    )
    return summary, overturning_rate


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
    time: Vector, value: Vector, rate: Vector, place: Vector, extreme: Vector, limit: float
) -> tuple[float, int, float]:
    """Give when the value first reaches the limit, on which side, and its rate there."""
    from scipy.optimize import root_scalar

    over = np.flatnonzero(np.abs(value) >= limit)
    beyond = place[np.abs(extreme) >= limit]
    candidates = [float(time[over[0]])] if len(over) else []
    candidates += [float(beyond[0])] if len(beyond) else []
    if not candidates:
        return math.nan, 0, math.nan
    end = min(candidates)
    i = max(int(np.searchsorted(time, end, side="left")) - 1, 0)
    cubic = _cubic(time, value, rate, i)
    h = float(time[i + 1] - time[i])
    last = (end - float(time[i])) / h
    side = 1 if cubic(last) > 0.0 else -1
    u = last
    if side * cubic(0.0) < limit <= side * cubic(last):
        u = root_scalar(lambda u: side * cubic(u) - limit, bracket=(0.0, last), xtol=1e-14).root
    return float(time[i]) + u * h, side, float(cubic.deriv()(u)) / h
