"""Peaks of what a model shows along the steps of a run, and how long it is above some level.

Forces jump at events and vary within steps, so that neither samples nor the ends of steps meet
their peaks. Both ends of every step tell in which few a peak may lie; these are looked into by
the dense solution.
"""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Final

import numpy as np

from rockframe.compiled import Integers, Matrix, Vector, entry_at_once, inlined
from rockframe.results.outcome import Generic
from rockframe.signals.arrays import Array
from rockframe.solve.trajectory import Steps

Values = Mapping[str, Generic]

PARTS: Final = 8
"""Parts of a step that is looked into. Steps resolve the fastest vibration, and a parabola through
neighbours of an eighth of them misses a peak by less than 1e-4."""
FRACTIONS: Final = np.arange(1, PARTS) / PARTS
LOOKED_INTO: Final = 32
"""Most steps that are looked into for each peak, of those whose ends and curvature promise more
than is known of any: those that promise the most."""
BULGE: Final = 0.25
"""Share of its second difference by which a function may rise above both ends of a step: twice
that of a parabola."""

KINK: Final = 2.0
"""How many times as large or small as that at a top second differences beside it may be."""


@dataclass(frozen=True)
class AlongSteps:
    """What a model shows at both ends of its steps."""

    steps: Steps  # up to overturning
    # by names in the schema, in the rows of the steps: the end of one, just before what happened
    # after it, and the start of the next that does not go on from there
    shown: Values
    # gives the same at `FRACTIONS` of some steps, one step after the other, by the rows of their
    # ends
    inside: Callable[[Integers], Values]

    def largest(self, quantity: Callable[[Values], Array]) -> tuple[Array, Array]:
        """Give peaks and their times."""
        return self.each_largest(quantity)[0]

    def each_largest(self, *quantities: Callable[[Values], Array]) -> list[tuple[Array, Array]]:
        """Give peaks and their times of several quantities, each in the steps that promise them."""
        shown = [quantity(self.shown) for quantity in quantities]
        if len(self.steps.time) < 2:  # no step was made
            return [(np.zeros(len(one)), np.full(len(one), np.nan)) for one in shown]
        steps = [self._promising(one) for one in shown]
        every = np.unique(np.concatenate(steps))
        inside = self.inside(every)
        return [
            self._peaks(one, which, quantity(inside), np.searchsorted(every, which))
            for quantity, one, which in zip(quantities, shown, steps, strict=True)
        ]

    def _peaks(
        self, shown: Array, which: Integers, inside: Array, place: Integers
    ) -> tuple[Array, Array]:
        """Give the peaks of rows in some steps, whose insides stand at some places."""
        inner = inside.reshape(len(shown), -1, len(FRACTIONS))[:, place]
        both_ends = shown[:, which - 1, None], shown[:, which, None]
        known = np.concatenate([both_ends[0], inner, both_ends[1]], axis=-1)
        peak, top = _tops(known)
        row, best = np.arange(len(shown)), np.argmax(peak, axis=1)
        length = self.steps.length[which]
        time = (self.steps.time[which] - length)[best] + length[best] * top[row, best] / PARTS
        return peak[row, best], time

    def above(self, quantity: Callable[[Values], Array], level: float) -> tuple[float, float]:
        """Give from when on and how long a quantity is above a level; NaN and 0 where never."""
        shown = quantity(self.shown)
        beyond = np.maximum(shown[:-1], shown[1:]) > level
        which = 1 + np.flatnonzero(beyond & (self.steps.length[1:] > 0.0))
        if not len(which):
            return math.nan, 0.0
        start, end, length = shown[which - 1], shown[which], self.steps.length[which]
        low, high = np.minimum(start, end), np.maximum(start, end)
        with np.errstate(divide="ignore", invalid="ignore"):
            share = (high - level) / (high - low)
        # from without bound: as fast as its reciprocal falls
        share = np.where(np.isinf(high), low / level, share)
        share = np.where(low > level, 1.0, share)
        waits = 0.0 if start[0] > level else (1.0 - share[0]) * length[0]
        begins = self.steps.time[which[0]] - length[0] + waits
        return float(begins), float(share @ length)

    def _promising(self, shown: Array) -> Integers:
        """Find the steps in which a peak of some row may lie, by the rows of their ends."""
        promise, length = np.empty_like(shown), np.ascontiguousarray(self.steps.length)
        per_length = np.divide(1.0, length, out=np.full(len(length), np.nan), where=length > 0.0)
        promise_of_steps(shown, length, per_length, promise)
        tops = np.fmax.reduce(shown, axis=1)
        rows = zip(promise[:, 1:], tops, strict=True)
        return np.unique(np.concatenate([1 + _largest(row, top) for row, top in rows]))


@inlined
def greater(a: float, b: float) -> float:
    """Give the greater of two numbers, of which NaN is none."""
    return a if a >= b or b != b else b


@inlined
def slope_in(shown: Matrix, row: int, i: int, per_length: Vector) -> float:
    """Give the mean slope of a row in the step that ends at `i`; NaN where steps begin anew."""
    if i == len(per_length):
        return math.nan
    return (shown[row, i] - shown[row, i - 1]) * per_length[i]


@entry_at_once
def promise_of_steps(shown: Matrix, length: Vector, per_length: Vector, out: Matrix) -> None:
    """Fill what rows may rise to in each step, by its ends and by how slopes differ there.

    Nothing where steps begin anew, and `per_length` is NaN: what a jump tells nothing of.
    """
    for row in range(shown.shape[0]):
        bend, slope = math.nan, slope_in(shown, row, 1, per_length)
        for i in range(1, len(length)):
            next_slope = slope_in(shown, row, i + 1, per_length)
            next_bend = abs(next_slope - slope)
            bulge = greater(bend, next_bend) * length[i]
            if not bulge < math.inf:
                bulge = 0.0
            top = greater(shown[row, i - 1], shown[row, i]) + BULGE * bulge
            out[row, i] = top if length[i] > 0.0 else -math.inf
            bend, slope = next_bend, next_slope


def _largest(promise: Array, top: float) -> Integers:
    """Find what promises no less than is known; of many the most, and of equals the first."""
    which = np.flatnonzero(~(promise < top))
    if len(which) > LOOKED_INTO:
        which = which[np.argsort(-promise[which], kind="stable")[:LOOKED_INTO]]
    return which


def _tops(known: Array) -> tuple[Array, Array]:
    """Give the top of each row of values, and its place: that of a parabola where there is one.

    Where second differences beside a top are not about its own there is a kink, such as that of
    a base that begins to press: no parabola goes through it.
    """
    shape, known = known.shape[:-1], known.reshape(-1, known.shape[-1])
    largest, row = np.argmax(known, axis=-1), np.arange(len(known))
    middle = np.minimum(np.maximum(largest, 1), known.shape[-1] - 2)
    with np.errstate(invalid="ignore"):
        bends = known[:, :-2] - 2.0 * known[:, 1:-1] + known[:, 2:]
    last = bends.shape[-1] - 1

    a, b, c = known[row, middle - 1], known[row, middle], known[row, middle + 1]
    before, bend, after = (
        bends[row, np.minimum(np.maximum(middle - k, 0), last)] for k in (2, 1, 0)
    )
    most = known[row, largest]
    with np.errstate(divide="ignore", invalid="ignore"):
        slope = 0.5 * (c - a)
        beside = -slope / bend
        top = b + 0.5 * slope * beside
        smooth = np.minimum(before, after) >= KINK * bend
        smooth &= np.maximum(before, after) <= bend / KINK
        better = (bend < 0.0) & smooth & (np.abs(beside) <= 1.0) & (top > most)
    tops, places = np.where(better, top, most), np.where(better, middle + beside, largest)
    return tops.reshape(shape), places.reshape(shape)
