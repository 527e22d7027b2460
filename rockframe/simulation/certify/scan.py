"""Where, along a change of one number, a verdict turns round: tried from near to far.

Between two runs of the same verdict there may be others. Whether to look is told by the
clearances of the runs, which go to zero where the verdict changes: if they could, at twice
the slopes seen hereabouts, the interval is halved.
"""

import math
from bisect import insort
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from typing import Final

from rockframe.simulation.certify.run_summary import RunSummary

STEEPER: Final = 2.0
"""Slope that a clearance is allowed between two runs, over those seen hereabouts."""
BENT: Final = 2.0
"""Clearance that is looked into, over its departure from a straight line hereabouts."""
EVEN: Final = 2.0
"""Ratio up to which two slopes are those of a straight line."""
CROWD: Final = 2
"""Intervals with unlike ends that make all those around them suspect."""
AROUND: Final = 8.0
"""Distance up to which they do, over the length of an interval."""
AS_LONG: Final = 1.4
"""Ratio up to which two intervals are of about the same length."""
AHEAD: Final = 2.0
"""Share of its own length up to which the slope of an interval tells of the next one."""
LEAST: Final = 1e-15
"""Change below which nothing can be told from rounding."""

Look = Callable[[float], RunSummary | None]
"""Makes the run with a change; None where that cannot be."""


@dataclass(frozen=True)
class Scan:
    """What was found along a path."""

    # largest change, to both sides, up to which no other verdict was found and every interval was
    # followed closely enough to tell [1]
    margin: float
    flip: float | None  # change nearest to zero with another verdict [1]
    ended: RunSummary | None  # what that run showed
    # whether the margin ends at another verdict or at the reach, not for want of runs
    followed: bool
    tried: dict[float, RunSummary]  # all runs, without the one at zero

    def within(self, reach: float) -> int:
        """Give the number of changes tried up to a reach."""
        return sum(abs(change) <= reach for change in self.tried)


NOT_TRIED: Final = Scan(math.nan, None, None, followed=False, tried={})
"""What is found without a run."""


@dataclass
class Side:
    """The runs to one side, by the size of their change."""

    sign: float  # of the changes
    shown: dict[float, RunSummary]  # the runs by their places, at first the nearest one only
    places: list[float] = field(default_factory=lambda: [0.0])  # sizes of the changes, rising
    closed: bool = False
    rough: list[tuple[float, float]] = field(default_factory=list)

    def add(self, place: float, shown: RunSummary) -> None:
        """Put a run in its place."""
        self.shown[place] = shown  # first, so that an interrupt leaves no place without a run
        insort(self.places, place)
        # intervals whose ends took other courses are remembered, with their lengths
        number = self.places.index(place)
        for near, far in pairwise(self.places[number - 1 : number + 2]):
            if not self.shown[near].alike(self.shown[far]):
                self.rough.append((0.5 * (near + far), far - near))

    def crowded(self, near: float, far: float) -> bool:
        """Whether several intervals of about this length hereabouts have unlike ends."""
        length, middle = far - near, 0.5 * (near + far)
        count = 0
        for place, other in self.rough:
            as_long = length / AS_LONG < other < AS_LONG * length
            count += as_long and abs(place - middle) <= AROUND * length
        return count >= CROWD

    def intervals(self) -> Iterator[tuple[float, float]]:
        """Give the ends of all intervals, from near to far."""
        yield from pairwise(self.places)

    def flip(self) -> tuple[float, float] | None:
        """Give the first interval at whose end the verdict is another one."""
        verdict = self.shown[0.0].overturned
        for near, far in self.intervals():
            if self.shown[far].overturned != verdict:
                return near, far
        return None


def scan(
    look: Look,
    base: RunSummary,
    row: Sequence[float],
    *,
    most: int,
    resolution: float,
    close_in: bool = True,
) -> Scan:
    """Try changes to both sides, from near to far.

    `row` are the sizes of the first changes, the last of which is the reach. Intervals are halved
    down to `resolution` over their far ends; where the verdict changes only if `close_in`.
    """
    sides = [Side(sign, {0.0: base}) for sign in (-1.0, 1.0)]
    tried: dict[float, RunSummary] = {}

    def try_at(side: Side, place: float) -> bool:
        shown = look(side.sign * place)
        if shown is None:
            side.closed = True
            return False
        tried[side.sign * place] = shown
        side.add(place, shown)
        return shown.overturned == base.overturned

    reached = 0.0
    for place in row:
        if len(tried) + 1 >= most:
            break
        same = [try_at(side, place) or side.closed for side in sides if not side.closed]
        if not all(same):
            break
        reached = place

    while True:
        nearest = _nearest_flip(sides)
        if nearest is not None and not close_in:
            doubtful, end = None, nearest[1]
            break
        end = reached if nearest is None else nearest[1]
        doubtful = _first_doubt(sides, end, resolution)
        task = doubtful
        if nearest is not None and _wide(*nearest[1:], resolution):
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
        followed=doubtful is None and (nearest is not None or reached == row[-1]),
        tried=tried,
    )


_Task = tuple[Side, float, float]


def _flips(sides: Sequence[Side]) -> list[_Task]:
    return [(side, *flip) for side in sides if (flip := side.flip()) is not None]


def _nearest_flip(sides: Sequence[Side]) -> _Task | None:
    """Give the interval that may hold the nearest flip: the one that begins first."""
    return min(_flips(sides), key=lambda one: one[1:], default=None)


def _wide(near: float, far: float, resolution: float) -> bool:
    return far - near > max(resolution * far, LEAST)


def _first_doubt(sides: Sequence[Side], end: float, resolution: float) -> _Task | None:
    """Give the nearest interval, up to an end, in which the verdict might change and back."""
    found: list[_Task] = []
    for side, other in zip(sides, reversed(sides), strict=True):
        for number, (near, far) in enumerate(side.intervals()):
            if near >= end or side.shown[far].overturned != side.shown[0.0].overturned:
                break
            if _wide(near, far, resolution) and may_change_between(side, number, other):
                found.append((side, near, far))
                break
    return min(found, key=lambda one: one[1], default=None)


def may_change_between(side: Side, number: int, other: Side | None = None) -> bool:
    """Tell whether a clearance might go to zero between two runs of the same verdict."""
    near, far = side.places[number], side.places[number + 1]
    first, last = side.shown[near], side.shown[far]
    if not first.alike(last) or side.crowded(near, far):
        return True
    length, here = far - near, _slopes(side, number)
    if number > 0:
        before = _slopes(side, number - 1)
    else:
        before = _NOT_ALIKE if other is None else _slopes(other, 0).reversed()
    after = _slopes(side, number + 1)
    beside = [one for one in (before, after) if one.of]
    for k, slope in enumerate(here.of):
        start, end = first.clearances[k], last.clearances[k]
        spans = [min(length, AHEAD * one.length) for one in beside]
        steep = max(
            [abs(one.of[k]) * span for one, span in zip(beside, spans, strict=True)]
            + [abs(slope) * length]
        )
        bent = max(
            [abs(slope - one.of[k]) * span for one, span in zip(beside, spans, strict=True)] + [0.0]
        )
        if start + end > STEEPER * steep and min(start, end) > BENT * bent:
            continue
        # before a change of the verdict a clearance goes to zero, as a line does or a root
        even = (
            bool(before.of) and before.of[k] <= 0.0 and EVEN * slope <= before.of[k] <= slope / EVEN
        )
        if not after.of and even:
            continue
        return True
    return False


@dataclass(frozen=True)
class _Slopes:
    """Slopes of the clearances over an interval; none where its ends are not alike."""

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
