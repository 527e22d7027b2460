"""Changes of the verdict (flips) along the scale of a motion, and their description in words."""

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from itertools import pairwise
from typing import Final

import numpy as np

from rockframe.simulation.certify.run_summary import RunSummary
from rockframe.simulation.certify.scan import Side, may_change_between
from rockframe.simulation.soundness import share_words, slip_words

FINEST: Final = 0.002
"""Length of an interval of scales, over its far end, that is not halved to find hidden flips."""

CALM: Final = 0.1
"""Peaks of two runs over the overturning angle below which no flip is expected between them."""

Look = Callable[[float], RunSummary]
"""Function that makes the run at a scale."""


@dataclass(frozen=True)
class Flip:
    """Two scales of unlike verdicts, between which no run has a verdict."""

    below: float  # the scales [1]
    above: float
    overturns_above: bool  # verdict of the upper one; the lower one has the other


@dataclass(frozen=True)
class Followed:
    """The runs along the scale, and the flips and gaps between them."""

    shown: dict[float, RunSummary]  # all runs by their scales, ascending
    # scale up to which no gap between runs with a verdict is wider than the resolution times its
    # upper end, wherever the base lifts [1]
    up_to: float
    whole: bool = True  # False after an interrupt (Ctrl-C)

    def flips(self) -> list[Flip]:
        """Return all changes of the verdict, from low to high."""
        return list(_flips(self.shown))

    @property
    def largest_gap(self) -> float:
        """Largest distance between neighbouring scales with a verdict; NaN if fewer than two [1].

        Pairs of flips closer together than this gap may be missed.
        """
        decided = [scale for scale, run in self.shown.items() if run.overturned is not None]
        return max((far - near for near, far in pairwise(decided)), default=math.nan)


def follow(
    look: Look,
    row: Sequence[float],
    *,
    most: int,
    width: float,
    resolution: float = 1.0,
    may_slide: bool = False,
) -> Followed:
    """Scan scales, halve doubtful intervals, and narrow every change of the verdict.

    Between two runs of the same verdict an even number of flips may hide. Below the least scale
    that overturns, every interval is halved down to the resolution, the widest first, except where
    the base does not lift: it does not lift at lower scales either, unless it may slide. Then the
    intervals in which flips are likely are halved, below that scale and above it,
    :func:`rockframe.simulation.certify.scan.may_change_between`.
    """
    least, *others = row
    side = Side(1.0, {least: look(least)}, [least])
    whole = True
    wide = partial(_wide, side, resolution, may_slide=may_slide)
    try:
        for scale in others:
            side.add(scale, look(scale))
        while (gaps := list(wide())) and len(side.places) < most:
            near, far = max(gaps, key=lambda ends: (ends[1] - ends[0]) / ends[1])
            middle = 0.5 * (near + far)
            side.add(middle, look(middle))
        for up_to_first in (True, False):
            while _halve(side, look, most, up_to_first=up_to_first):
                pass
        for flip in list(_flips(_in_order(side))):
            _narrow(side, look, flip, width)
    except KeyboardInterrupt:
        whole = False
    ends = [near for near, _ in wide(beyond=True)]
    shown = _in_order(side)
    ends += [near for near, far in side.intervals()
             if None in (shown[near].overturned, shown[far].overturned)]  # fmt: skip
    return Followed(shown, min([*ends, side.places[-1]]), whole)


def _wide(
    side: Side, resolution: float, *, may_slide: bool, beyond: bool = False
) -> Iterator[tuple[float, float]]:
    """Return the intervals that are wider than the resolution, where the base lifts.

    Those below the least scale that overturns, or also those beyond it.
    """
    for near, far in side.intervals():
        if side.shown[near].overturned and not beyond:
            return
        have_verdicts = None not in (side.shown[near].overturned, side.shown[far].overturned)
        if near == 0.0 and far <= resolution * side.places[-1]:
            continue  # halving towards zero would not end
        if (
            have_verdicts
            and far - near > resolution * far
            and (side.shown[far].lifted or may_slide)
        ):
            yield near, far


def _halve(side: Side, look: Look, most: int, *, up_to_first: bool) -> bool:
    """Halve the suspect intervals; give whether there were some, and runs left for them."""
    suspects = list(_suspects(side, up_to_first=up_to_first))
    # runs may not suffice for all: those nearest to overturning come first
    for near, far in sorted(suspects, key=lambda ends: _clearance(side, *ends)):
        if len(side.places) >= most:
            return False
        middle = 0.5 * (near + far)
        shown = look(middle)
        side.add(middle, shown)
        if up_to_first and shown.overturned:
            break  # the others lie above the least scale that overturns
    return bool(suspects)


def _suspects(side: Side, *, up_to_first: bool) -> Iterator[tuple[float, float]]:
    """Return the intervals in which flips may hide, from low to high.

    With `up_to_first`, the interval before the first scale that overturns is included too: flips
    may hide on both sides of the known flip.
    """
    for number, (near, far) in enumerate(side.intervals()):
        before, after = side.shown[near].overturned, side.shown[far].overturned
        if up_to_first and before:
            return
        if far - near <= FINEST * far or before is None or after is None:
            continue
        if _clearance(side, near, far) > 1.0 - CALM:
            continue
        if before != after:
            if up_to_first:
                yield near, far
        elif may_change_between(side, number):
            yield near, far


def _clearance(side: Side, near: float, far: float) -> float:
    """Return the smaller clearance of both runs to the overturning angle; 0 if it was passed."""
    ends = side.shown[near], side.shown[far]
    return min(one.clearances[0] if one.within_the_angle else 0.0 for one in ends)


def _narrow(side: Side, look: Look, flip: Flip, width: float) -> None:
    """Bisect a bracket, until it is narrow or a run in its middle has no verdict."""
    below, above = flip.below, flip.above
    while above - below > width * above:
        middle = 0.5 * (below + above)
        if middle in side.shown or not below < middle < above:
            return
        shown = look(middle)
        side.add(middle, shown)
        if shown.overturned is None:
            return
        if shown.overturned == flip.overturns_above:
            above = middle
        else:
            below = middle


def _flips(shown: Mapping[float, RunSummary]) -> Iterator[Flip]:
    decided = [(at, run.overturned) for at, run in shown.items() if run.overturned is not None]
    for (below, before), (above, after) in pairwise(decided):
        if before != after:
            yield Flip(below, above, after)


def _in_order(side: Side) -> dict[float, RunSummary]:
    return {scale: side.shown[scale] for scale in side.places}


_FEWEST_DIGITS: Final = 4
_ROUNDING: Final = 1e-9
"""Excess over a digit, in units of it, that is not rounded up [1]."""
_MOST_GAPS: Final = 3
"""Most ranges of scales without overturning that are named one by one."""


def flips_sentence(found: Followed, *, width: float, resolution: float = 1.0) -> str:
    """Return in words from which scale the block overturns, where it stands again, and the gaps."""
    digits = max(_FEWEST_DIGITS, 1 + math.ceil(-math.log10(width)))

    def number(scale: float) -> str:
        return f"{scale:.{digits}g}"

    scales = list(found.shown)
    largest, flips = scales[-1], found.flips()
    critical = least_overturning(found.shown)
    decided = [scale for scale, run in found.shown.items() if run.overturned is not None]
    if not decided:
        text = "No run could be finished"
    elif math.isnan(critical):
        text = f"Did not overturn up to {number(decided[-1])} times the motion"
    elif critical == 0.0:
        text = "Overturns without the motion"
    else:
        text = f"Overturns from {number(critical)} times the motion on"
    ends = [(number(start), number(end)) for start, end in _gaps(flips, largest)]
    gaps = [f"at {start}" if start == end else f"from {start} to {end}" for start, end in ends]
    if gaps:
        text += f", stands again {_listed(gaps)}"
    plural = "" if len(scales) == 1 else "s"
    text += f"; {len(scales)} scale{plural} tried up to {number(largest)}"
    if not math.isnan(gap := found.largest_gap):  # to two digits, rounded up
        size = 10.0 ** (math.floor(math.log10(gap)) - 1)
        text += f", at most {math.ceil(gap / size - _ROUNDING) * size:.2g} apart"
    slides = share_words(np.array([run.slides for run in found.shown.values()]))
    text += f"; {slides}" if slides else ""
    slid = slip_words(np.array([run.slip for run in found.shown.values()]))
    text += f"; {slid}" if slid else ""
    text += "." if found.whole else ", then interrupted."
    first = next((one for one in flips if one.overturns_above), None)
    end = largest
    if first is not None:  # runs without a verdict may leave its bracket wide
        wide = first.above - first.below > resolution * first.above
        end = first.above if wide else first.below
    if found.up_to < end and critical != scales[0]:  # there is none below the least
        text += (
            f" Beyond {number(found.up_to)} some are more than {100.0 * resolution:g} % apart, "
            "and a lesser scale between them may overturn."
        )
    undecided = [scale for scale, run in found.shown.items() if run.overturned is None]
    if undecided:
        text += f" {unfinished(undecided)}, the first at {number(undecided[0])}."
    return text


def unfinished(undecided: Sequence[float]) -> str:
    """Return in words how many runs have no verdict."""
    if len(undecided) == 1:
        return "1 run could not be finished and has no verdict"
    return f"{len(undecided)} runs could not be finished and have no verdict"


def least_overturning(shown: dict[float, RunSummary]) -> float:
    """Return the least scale that overturned; NaN if none did."""
    return next((scale for scale, run in shown.items() if run.overturned), math.nan)


def _gaps(flips: Sequence[Flip], largest: float) -> list[tuple[float, float]]:
    """Return the ranges where the block stands again: their least and greatest scale of a run."""
    starts = [flip.above for flip in flips if not flip.overturns_above]
    ends = [flip.below for flip in flips if flip.overturns_above]
    if flips and flips[0].overturns_above:
        ends = ends[1:]
    ends += [largest] * (len(starts) - len(ends))
    return list(zip(starts, ends, strict=True))


def _listed(gaps: list[str]) -> str:
    named, more = gaps[:_MOST_GAPS], len(gaps) - _MOST_GAPS
    if more > 0:
        further = "range" if more == 1 else "ranges"
        return f"{', '.join(named)} and in {more} further {further}"
    return " and ".join([", ".join(named[:-1]), named[-1]] if named[:-1] else named)
