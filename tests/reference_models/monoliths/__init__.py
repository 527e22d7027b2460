"""Hand-written integrations of the rocking equations, independent of the package.

Nothing here imports the package. The modules state the mechanics independently, integrate by
SciPy's DOP853 at tight tolerance, or by another of its methods, and find every contact change on
the dense output. They share the ground motion, cut into smooth pieces, and the search for
crossings.
"""

from __future__ import annotations

import bisect
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.integrate import DOP853, LSODA, RK45, OdeSolver, Radau
from scipy.optimize import brentq

EPS = float(np.finfo(float).eps)
METHODS = {"DOP853": DOP853, "RK45": RK45, "LSODA": LSODA, "Radau": Radau}
SIMULTANEOUS = 1e-9
"""Crossings closer than this [s] are simultaneous."""


class _Samples:
    """Samples at k * step, linear in between, zero after the last one."""

    def __init__(self, values: Sequence[float], step: float) -> None:
        self.values = np.asarray(values, dtype=float)
        if self.values.ndim != 1 or self.values.size < 2:
            msg = "a sampled acceleration needs at least two samples in one row"
            raise ValueError(msg)
        self.step = float(step)
        self.end = (self.values.size - 1) * self.step

    def knots(self, every: bool) -> list[float]:
        return [k * self.step for k in range(self.values.size)] if every else [self.end]

    def piece(self, start: float, stop: float) -> Callable:
        middle = 0.5 * (start + stop)
        if middle > self.end:
            return lambda t: 0.0 * t
        first = int(start / self.step + 1e-6)
        last = int(np.ceil(stop / self.step - 1e-6))
        if last - first <= 1:
            at, slope = first * self.step, self.values[first + 1] - self.values[first]
            base, slope = float(self.values[first]), float(slope) / self.step
            return lambda t: base + slope * (t - at)
        times = np.arange(self.values.size) * self.step
        return lambda t: np.interp(t, times, self.values)


class _Function:
    """A function of time, smooth between its breakpoints."""

    def __init__(self, function: Callable[[float], float]) -> None:
        self.function = function

    def knots(self, every: bool) -> list[float]:
        return []

    def piece(self, start: float, stop: float) -> Callable:
        low, high = np.nextafter(start, np.inf), np.nextafter(stop, -np.inf)

        def value(t):
            if isinstance(t, np.ndarray):
                return np.array([value(float(one)) for one in t])
            return float(self.function(min(max(t, low), high)))

        return value


class Pieces:
    """A sequence of polynomials of fourth degree, appended in order of time."""

    NODES = np.linspace(0.0, 1.0, 5)
    INVERSE = np.linalg.inv(np.vander(NODES))

    def __init__(self) -> None:
        self.edges: list[float] = []
        self.polynomials: list[tuple[float, ...]] = []

    def add(self, start: float, stop: float, values: np.ndarray) -> None:
        """Append the polynomial through values at five equally spaced times."""
        if not self.edges:
            self.edges.append(float(start))
        if stop > self.edges[-1]:
            self.edges.append(float(stop))
            self.polynomials.append(tuple((self.INVERSE @ values).tolist()))

    def knots(self, every: bool) -> list[float]:
        return self.edges if every else []

    def _value(self, i: int, t):
        u = (t - self.edges[i]) / (self.edges[i + 1] - self.edges[i])
        a, b, c, d, e = self.polynomials[i]
        return (((a * u + b) * u + c) * u + d) * u + e

    def piece(self, start: float, stop: float) -> Callable:
        last = len(self.polynomials) - 1

        def place(t):
            return min(max(bisect.bisect_right(self.edges, t) - 1, 0), last)

        first = place(0.5 * (start + stop))
        if self.edges[first] <= start and stop <= self.edges[first + 1]:
            return lambda t: self._value(first, t)

        def value(t):
            if isinstance(t, np.ndarray):
                return np.array([self._value(place(one), one) for one in t.tolist()])
            return self._value(place(t), t)

        return value


class _None:
    def knots(self, every: bool) -> list[float]:
        return []

    def piece(self, start: float, stop: float) -> Callable:
        return lambda t: 0.0 * t


class Drive:
    """Ground acceleration in two directions, cut where it is not smooth."""

    def __init__(
        self,
        *,
        acceleration,
        vertical,
        time_step: float | None,
        breakpoints: Sequence[float],
        duration: float,
        restart_every_knot: bool,
    ) -> None:
        def source(component):
            if component is None:
                return _None()
            if isinstance(component, Pieces):
                return component
            if callable(component):
                return _Function(component)
            if time_step is None:
                msg = "a sampled acceleration needs its time_step"
                raise ValueError(msg)
            return _Samples(component, time_step)

        self.sources = (source(acceleration), source(vertical))
        edges = {0.0, float(duration), *map(float, breakpoints)}
        for one in self.sources:
            edges.update(one.knots(restart_every_knot))
        inside = sorted(edge for edge in edges if 0.0 <= edge <= duration)
        kept = [0.0]
        for edge in inside[1:]:
            if edge - kept[-1] > 1e-12 * max(1.0, edge):
                kept.append(edge)
        kept[-1] = float(duration)
        self.edges = kept

    def pieces(self):
        """Yield (start, stop, horizontal, vertical) of each smooth piece."""
        for start, stop in zip(self.edges[:-1], self.edges[1:], strict=True):
            yield start, stop, *(source.piece(start, stop) for source in self.sources)


@dataclass
class Guard:
    """A quantity that is positive until its event.

    ``strict``: if it starts a piece negative, the event is due at once.
    """

    kind: str
    where: str
    strict: bool = True
    armed: bool = False


def stepper(rhs, start, state, stop, *, max_step, rtol, atol, method="DOP853") -> OdeSolver:
    """Set up a solver, usually without trial steps for the first step, which is bounded anyway.

    LSODA starts at first order and chooses its own first step.
    """
    first_step = None if method == "LSODA" else min(max_step, stop - start)
    return METHODS[method](
        rhs,
        start,
        state,
        stop,
        max_step=max_step,
        first_step=first_step,
        rtol=rtol,
        atol=atol,
    )


def polish(function: Callable[[float], float], left: float, right: float) -> float:
    """Find the root between two points at which the function differs in sign."""
    at_left, at_right = function(left), function(right)
    if at_left * at_right >= 0.0:
        return float(left if abs(at_left) <= abs(at_right) else right)
    return float(brentq(function, left, right, xtol=1e-15, rtol=4.0 * EPS))


def crossings(guards, values, rates, times, dense_values) -> list[float | None]:
    """Return for each guard the time at which it first falls through zero in this step.

    Each guard's turning points are added to the sub-points, so that a dip between two of them is
    seen too. ``dense_values(i, t)`` gives guard i and its rate at one time.
    A guard counts once it has been positive, as the flags ``armed`` record.
    """
    times_found: list[float | None] = []
    for i, guard in enumerate(guards):
        value, rate = values[i], rates[i]
        turning = np.nonzero(rate[:-1] * rate[1:] < 0.0)[0]
        if guard.armed and turning.size == 0 and value.min() > 0.0:
            times_found.append(None)
            continue
        points = list(zip(times, value, strict=True))
        for j in turning:
            at = polish(lambda t, i=i: dense_values(i, t)[1], times[j], times[j + 1])
            points.append((at, dense_values(i, at)[0]))
        points.sort(key=lambda point: point[0])
        hit = None
        armed = guard.armed or points[0][1] > 0.0
        before = points[0]
        for number, point in enumerate(points[1:], start=1):
            if armed and point[1] <= 0.0:
                if point[1] == 0.0 or before[1] <= 0.0:
                    hit = point[0] if before[1] > 0.0 else before[0]
                else:
                    hit = polish(lambda t, i=i: dense_values(i, t)[0], before[0], point[0])
                break
            if not armed and point[1] < 0.0 and number == 1 and guard.strict:
                hit = points[0][0]
                break
            armed = armed or point[1] > 0.0
            before = point
        guard.armed = armed
        times_found.append(hit)
    return times_found
