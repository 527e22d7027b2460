"""Peaks of quantities along the steps of a run, and the time that they are above some level.

Forces jump at events and vary within steps, so that their peaks lie neither at samples nor at the
ends of steps. From the values at the ends of all steps follows in which few steps a peak may lie;
in these the quantity is evaluated on the dense solution.
"""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Final

import numpy as np

from rockframe.compiled import Integers, Matrix, Vector, background_entry, inlined
from rockframe.signals.arrays import AnyArray, Array
from rockframe.solve.trajectory import Steps

Values = Mapping[str, AnyArray]

PARTS: Final = 8
"""Parts into which a step is divided for its peak. Steps resolve the fastest vibration, so that a
parabola through three points an eighth of a step apart misses a peak by less than 1e-4."""
FRACTIONS: Final = np.arange(1, PARTS) / PARTS
MAX_SEARCHED_STEPS: Final = 32
"""Most steps that are evaluated for each peak: of those in which, by values and curvature at their
ends, the quantity may exceed the largest value at all ends, the ones with the highest bounds."""
CURVATURE_SHARE: Final = 0.25
"""Share of its second difference by which a function may rise above both ends of a step: twice
the share of a parabola."""

MAX_CURVATURE_RATIO: Final = 2.0
"""Largest ratio of the second differences at and beside a maximum for which it is smooth."""


@dataclass(frozen=True)
class AlongSteps:
    """Quantities of a run at the ends and the new starts of its steps, and inside of them."""

    steps: Steps  # up to overturning
    # values by names in the schema, at the rows of the steps: at the end of each step, before any
    # event there, and at the start of a step that does not go on from the end of another
    shown: Values
    # function that gives these at `FRACTIONS` of the steps whose ends are at some rows, one step
    # after the other
    inside: Callable[[Integers], Values]

    def largest(self, quantity: Callable[[Values], Array]) -> tuple[Array, Array]:
        """Return the peaks of the rows of a quantity, and their times [s]."""
        return self.each_largest(quantity)[0]

    def each_largest(self, *quantities: Callable[[Values], Array]) -> list[tuple[Array, Array]]:
        """Return the peaks of the rows of each of several quantities, and their times [s]."""
        at_steps = [quantity(self.shown) for quantity in quantities]
        if len(self.steps.time) < 2:  # no step was made
            return [(np.zeros(len(rows)), np.full(len(rows), np.nan)) for rows in at_steps]
        steps = [self._candidate_steps(rows) for rows in at_steps]
        every = np.unique(np.concatenate(steps))
        inside = self.inside(every)
        return [
            self._peaks(rows, which, quantity(inside), np.searchsorted(every, which))
            for quantity, rows, which in zip(quantities, at_steps, steps, strict=True)
        ]

    def _peaks(
        self, at_ends: Array, which: Integers, inside: Array, place: Integers
    ) -> tuple[Array, Array]:
        """Return peaks of rows in the steps `which`, evaluated inside at `place` of `inside`."""
        inner = inside.reshape(len(at_ends), -1, len(FRACTIONS))[:, place]
        both_ends = at_ends[:, which - 1, None], at_ends[:, which, None]
        values = np.concatenate([both_ends[0], inner, both_ends[1]], axis=-1)
        peak, top = _interpolated_maxima(values)
        row, best = np.arange(len(at_ends)), np.argmax(peak, axis=1)
        length = self.steps.length[which]
        time = (self.steps.time[which] - length)[best] + length[best] * top[row, best] / PARTS
        return peak[row, best], time

    def above(self, quantity: Callable[[Values], Array], level: float) -> tuple[float, float]:
        """Return the time from which a quantity exceeds a level in magnitude, and how long it does.

        NaN and 0 if it never does. A magnitude that reaches zero in a step needs its sign.
        """
        values = quantity(self.shown)
        beyond = np.maximum(np.abs(values[:-1]), np.abs(values[1:])) > level
        which = 1 + np.flatnonzero(beyond & (self.steps.length[1:] > 0.0))
        if not len(which):
            return math.nan, 0.0
        start, end, length = values[which - 1], values[which], self.steps.length[which]
        # an infinite value is of the sign of the other end
        start = np.where(np.isinf(start), np.copysign(start, end), start)
        end = np.where(np.isinf(end), np.copysign(end, start), end)
        share = _share_above(start, end, level) + _share_above(-start, -end, level)
        waits = 0.0
        if abs(start[0]) <= level:  # then only one of both is above it in this step
            waits = (1.0 - share[0]) * length[0]
        begins = self.steps.time[which[0]] - length[0] + waits
        return float(begins), float(share @ length)

    def _candidate_steps(self, at_ends: Array) -> Integers:
        """Find the steps in which a peak of some row may lie, by the rows of their ends."""
        bounds, length = np.empty_like(at_ends), np.ascontiguousarray(self.steps.length)
        per_length = np.divide(1.0, length, out=np.full(len(length), np.nan), where=length > 0.0)
        step_bounds(at_ends, length, per_length, bounds)
        tops = np.fmax.reduce(at_ends, axis=1)
        # a step that has the largest value at one of its ends is never left out
        reached = np.fmax(at_ends[:, 1:], at_ends[:, :-1]) >= tops[:, None]
        bounds[:, 1:][reached & (length[1:] > 0.0)] = np.inf
        rows = zip(bounds[:, 1:], tops, strict=True)
        return np.unique(np.concatenate([1 + _highest_bounds(row, top) for row, top in rows]))


def _share_above(start: Array, end: Array, level: float) -> Array:
    """Return the shares of steps in which a quantity, linear in each, is above a level > 0."""
    low, high = np.minimum(start, end), np.maximum(start, end)
    with np.errstate(divide="ignore", invalid="ignore"):
        share = (high - level) / (high - low)
    # to an infinite value: as if the reciprocal were linear
    share = np.where(np.isinf(high), low / level, share)
    share = np.where(low > level, 1.0, share)
    return np.where(high > level, share, 0.0)


@inlined
def greater(a: float, b: float) -> float:
    """Return the greater of two numbers, ignoring NaN."""
    return a if a >= b or b != b else b


@inlined
def slope_in(rows: Matrix, row: int, i: int, per_length: Vector) -> float:
    """Return the mean slope of a row in the step that ends at `i`; NaN where steps begin anew."""
    if i == len(per_length):
        return math.nan
    return (rows[row, i] - rows[row, i - 1]) * per_length[i]


@background_entry
def step_bounds(rows: Matrix, length: Vector, per_length: Vector, out: Matrix) -> None:
    """Fill a bound of each row in each step, from values at its ends and changes of slope there.

    Slopes across a jump, where steps begin anew and `per_length` is NaN, are left out.
    """
    for row in range(rows.shape[0]):
        curvature, slope = math.nan, slope_in(rows, row, 1, per_length)
        for i in range(1, len(length)):
            next_slope = slope_in(rows, row, i + 1, per_length)
            next_change = abs(next_slope - slope)
            bulge = greater(curvature, next_change) * length[i]
            if not bulge < math.inf:
                bulge = 0.0
            top = greater(rows[row, i - 1], rows[row, i]) + CURVATURE_SHARE * bulge
            out[row, i] = top if length[i] > 0.0 else -math.inf
            curvature, slope = next_change, next_slope


def _highest_bounds(bounds: Array, top: float) -> Integers:
    """Find the steps whose bounds reach the known peak `top`; of many those of highest bound."""
    which = np.flatnonzero(~(bounds < top))
    if len(which) > MAX_SEARCHED_STEPS:
        which = which[np.argsort(-bounds[which], kind="stable")[:MAX_SEARCHED_STEPS]]
    return which


def _interpolated_maxima(values: Array) -> tuple[Array, Array]:
    """Return the maximum of each row of values, and its place: by a parabola where that fits.

    It does not where the second differences beside a maximum differ much from the one at it: there
    is a kink, as where a base begins to press.
    """
    shape, values = values.shape[:-1], values.reshape(-1, values.shape[-1])
    largest, row = np.argmax(values, axis=-1), np.arange(len(values))
    middle = np.minimum(np.maximum(largest, 1), values.shape[-1] - 2)
    with np.errstate(invalid="ignore"):
        second_differences = values[:, :-2] - 2.0 * values[:, 1:-1] + values[:, 2:]
    last = second_differences.shape[-1] - 1

    a, b, c = values[row, middle - 1], values[row, middle], values[row, middle + 1]
    before, curvature, after = (
        second_differences[row, np.minimum(np.maximum(middle - k, 0), last)] for k in (2, 1, 0)
    )
    most = values[row, largest]
    with np.errstate(divide="ignore", invalid="ignore"):
        slope = 0.5 * (c - a)
        beside = -slope / curvature
        top = b + 0.5 * slope * beside
        smooth = np.minimum(before, after) >= MAX_CURVATURE_RATIO * curvature
        smooth &= np.maximum(before, after) <= curvature / MAX_CURVATURE_RATIO
        better = (curvature < 0.0) & smooth & (np.abs(beside) <= 1.0) & (top > most)
    tops, places = np.where(better, top, most), np.where(better, middle + beside, largest)
    return tops.reshape(shape), places.reshape(shape)
