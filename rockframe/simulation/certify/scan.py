"""Search for a change of the verdict along a change of one number, from small to large changes.

Between two runs with the same verdict there may be runs with the other one. The clearances of the
runs go to zero where the verdict changes: if they could reach zero inside an interval, at twice the
slopes found around it, the interval is halved.
"""

import math
from bisect import insort
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from typing import Final

from rockframe.simulation.certify.run_summary import RunSummary

SLOPE_FACTOR: Final = 2.0
"""Largest slope of a clearance assumed between two runs, over the slopes found around it."""
CURVATURE_FACTOR: Final = 2.0
"""Ratio of a clearance to its departure from a straight line below which an interval is halved."""
STRAIGHT_RATIO: Final = 2.0
"""Ratio of two slopes up to which they belong to a straight line."""
MIN_ROUGH_INTERVALS: Final = 2
"""Number of intervals between runs of different course that makes all around them doubtful."""
ROUGH_DISTANCE: Final = 8.0
"""Distance up to which it does, over the length of an interval."""
EQUAL_LENGTH_RATIO: Final = 1.4
"""Ratio of the lengths of two intervals up to which they count as equally long."""
EXTRAPOLATION: Final = 2.0
"""Distance, over the length of an interval, up to which its slope is used for the next one."""
MIN_LENGTH: Final = 1e-15
"""Length of an interval below which changes are rounding."""

RunAt = Callable[[float], RunSummary | None]
"""A function that makes the run with a change; None where that is not possible."""


@dataclass(frozen=True)
class Scan:
    """The result of a search."""

    # largest change, to both sides, up to which no other verdict was found and every interval was
    # followed closely enough to tell [1]
    margin: float
    flip: float | None  # change nearest to zero with another verdict [1]
    ended: RunSummary | None  # the run with that change
    # whether the margin ends at another verdict or at the reach, not since all runs were used
    followed: bool
    tried: dict[float, RunSummary]  # all runs by their changes, without the one at zero

    def within(self, reach: float) -> int:
        """Return the number of changes tried up to a reach."""
        return sum(abs(change) <= reach for change in self.tried)


NOT_TRIED: Final = Scan(math.nan, None, None, followed=False, tried={})
"""The result of a search without runs."""


@dataclass
class Side:
    """The runs with positive, or with negative, changes, by the size of their change."""

    sign: float  # of the changes
    shown: dict[float, RunSummary]  # the runs by the sizes of their changes; at first that at 0
    places: list[float] = field(default_factory=lambda: [0.0])  # sizes of the changes, ascending
    closed: bool = False  # whether no run is possible with a larger change
    # middles and lengths of intervals between runs of different course
    rough: list[tuple[float, float]] = field(default_factory=list)

    def add(self, place: float, summary: RunSummary) -> None:
        """Add a run by the size of its change."""
        self.shown[place] = summary  # first, so that an interrupt leaves no place without a run
        insort(self.places, place)
        number = self.places.index(place)
        for near, far in pairwise(self.places[number - 1 : number + 2]):
            if not self.shown[near].alike(self.shown[far]):
                self.rough.append((0.5 * (near + far), far - near))

    def is_rough(self, near: float, far: float) -> bool:
        """Whether several intervals of about this length nearby are between different courses."""
        length, middle = far - near, 0.5 * (near + far)
        count = 0
        for place, other in self.rough:
            as_long = length / EQUAL_LENGTH_RATIO < other < EQUAL_LENGTH_RATIO * length
            count += as_long and abs(place - middle) <= ROUGH_DISTANCE * length
        return count >= MIN_ROUGH_INTERVALS

    def intervals(self) -> Iterator[tuple[float, float]]:
        """Return the ends of all intervals, from near to far."""
        return pairwise(self.places)

    def flip(self) -> tuple[float, float] | None:
        """Return the first interval at whose far end the verdict differs from that at 0."""
        verdict = self.shown[0.0].overturned
        for near, far in self.intervals():
            if self.shown[far].overturned != verdict:
                return near, far
        return None


def scan(
    run_at: RunAt,
    base: RunSummary,
    first_changes: Sequence[float],
    *,
    most: int,
    resolution: float,
    refine_flip: bool = True,
) -> Scan:
    """Try changes of both signs, from small to large ones.

    `first_changes` are their first sizes, the last of which is the reach. Intervals are halved
    until their length is `resolution` times their far end; an interval in which the verdict changes
    is halved only if `refine_flip`.
    """
    sides = [Side(sign, {0.0: base}) for sign in (-1.0, 1.0)]
    tried: dict[float, RunSummary] = {}

    def try_at(side: Side, place: float) -> bool:
        summary = run_at(side.sign * place)
        if summary is None:
            side.closed = True
            return False
        tried[side.sign * place] = summary
        side.add(place, summary)
        return summary.overturned == base.overturned

    reached = 0.0
    for place in first_changes:
        if len(tried) + 1 >= most:
            break
        same = [try_at(side, place) or side.closed for side in sides if not side.closed]
        if not all(same):
            break
        reached = place

    while True:
        # the interval that may contain the nearest flip is the one that begins first
        nearest = min(_flips(sides), key=lambda change: change[1:], default=None)
        if nearest is not None and not refine_flip:
            doubtful, end = None, nearest[1]
            break
        end = reached if nearest is None else nearest[1]
        doubtful = _nearest_doubtful_interval(sides, end, resolution)
        task = doubtful
        if nearest is not None and _is_wide(*nearest[1:], resolution):
            task = nearest
        if task is None or len(tried) >= most:
            break
        side, near, far = task
        try_at(side, 0.5 * (near + far))

    flip = min((side.sign * far for side, _, far in _flips(sides)), key=abs, default=None)
    return Scan(
        margin=end if doubtful is None else doubtful[1],
        flip=flip,
        ended=None if flip is None else tried[flip],
        followed=doubtful is None and (nearest is not None or reached == first_changes[-1]),
        tried=tried,
    )


_Task = tuple[Side, float, float]


def _flips(sides: Sequence[Side]) -> list[_Task]:
    return [(side, *flip) for side in sides if (flip := side.flip()) is not None]


def _is_wide(near: float, far: float, resolution: float) -> bool:
    return far - near > max(resolution * far, MIN_LENGTH)


def _nearest_doubtful_interval(
    sides: Sequence[Side], end: float, resolution: float
) -> _Task | None:
    """Return the nearest interval, up to an end, in which the verdict might change to and fro."""
    intervals: list[_Task] = []
    for side, other in zip(sides, reversed(sides), strict=True):
        for number, (near, far) in enumerate(side.intervals()):
            if near >= end or side.shown[far].overturned != side.shown[0.0].overturned:
                break
            if _is_wide(near, far, resolution) and may_change_between(side, number, other):
                intervals.append((side, near, far))
                break
    return min(intervals, key=lambda interval: interval[1], default=None)


def may_change_between(side: Side, number: int, other: Side | None = None) -> bool:
    """Whether a clearance might go to zero between two runs of the same verdict."""
    near, far = side.places[number], side.places[number + 1]
    first, last = side.shown[near], side.shown[far]
    if not first.alike(last) or side.is_rough(near, far):
        return True
    length, here = far - near, _slopes(side, number)
    if number > 0:
        before = _slopes(side, number - 1)
    else:
        before = _NOT_ALIKE if other is None else _slopes(other, 0).reversed()
    after = _slopes(side, number + 1)
    beside = [run for run in (before, after) if run.of]
    for k, slope in enumerate(here.of):
        start, end = first.clearances[k], last.clearances[k]
        spans = [min(length, EXTRAPOLATION * run.length) for run in beside]
        steep = max(
            [abs(run.of[k]) * span for run, span in zip(beside, spans, strict=True)]
            + [abs(slope) * length]
        )
        bent = max(
            [abs(slope - run.of[k]) * span for run, span in zip(beside, spans, strict=True)] + [0.0]
        )
        if start + end > SLOPE_FACTOR * steep and min(start, end) > CURVATURE_FACTOR * bent:
            continue
        # before a change of the verdict a clearance goes to zero, linearly or like a square root
        even = (
            bool(before.of)
            and before.of[k] <= 0.0
            and STRAIGHT_RATIO * slope <= before.of[k] <= slope / STRAIGHT_RATIO
        )
        if not after.of and even:
            continue
        return True
    return False


@dataclass(frozen=True)
class _Slopes:
    """Slopes of the clearances over an interval; none where its ends take different courses."""

    length: float
    of: tuple[float, ...]

    def reversed(self) -> "_Slopes":
        return _Slopes(self.length, tuple(-slope for slope in self.of))


_NOT_ALIKE: Final = _Slopes(0.0, ())


def _slopes(side: Side, number: int) -> _Slopes:
    if number + 1 >= len(side.places):
        return _NOT_ALIKE
    near, far = side.places[number], side.places[number + 1]
    first, last = side.shown[near], side.shown[far]
    length = far - near
    if not first.alike(last):
        return _Slopes(length, ())
    pairs = zip(first.clearances, last.clearances, strict=True)
    return _Slopes(length, tuple((b - a) / length for a, b in pairs))
