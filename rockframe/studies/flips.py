"""Changes of the verdict (flips) along the scale of a motion, and their description in words."""

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from itertools import pairwise
from typing import Final

import numpy as np

from rockframe.results.forces import share_words, slip_words
from rockframe.results.outcome import enumeration
from rockframe.simulation.certify.run_summary import RunSummary
from rockframe.simulation.certify.scan import Side, may_change_between

MIN_INTERVAL: Final = 0.002
"""Length of an interval of scales, over its far end, that is not halved to find hidden flips."""

SMALL_PEAK: Final = 0.1
"""Peaks of two runs over the overturning angle below which no flip is expected between them."""

RunAtScale = Callable[[float], RunSummary]
"""Function that makes the run at a scale."""


@dataclass(frozen=True)
class Flip:
    """Two scales of unlike verdicts, between which no run has a verdict."""

    below: float  # the scales [1]
    above: float
    overturns_above: bool  # verdict of the upper one; the lower one has the other


@dataclass(frozen=True)
class ScaleScan:
    """The runs along the scale, and the flips and gaps between them."""

    runs: dict[float, RunSummary]  # all runs by their scales, ascending
    # scale up to which no gap between runs with a verdict is wider than the resolution times its
    # upper end, wherever the base lifts [1]
    resolved_up_to: float
    completed: bool = True  # False after an interrupt (Ctrl-C)

    @property
    def decided(self) -> list[float]:
        """The scales with a verdict."""
        return [scale for scale, run in self.runs.items() if run.overturned is not None]

    @property
    def undecided(self) -> list[float]:
        """The scales without a verdict."""
        return [scale for scale, run in self.runs.items() if run.overturned is None]

    def flips(self) -> list[Flip]:
        """Return all changes of the verdict, from low to high."""
        return list(_flips(self.runs))

    @property
    def largest_gap(self) -> float:
        """The widest gap between neighbouring scales with a verdict; NaN if fewer than two [1]."""
        return max((far - near for near, far in pairwise(self.decided)), default=math.nan)


def scan_scales(
    run_at: RunAtScale,
    scales: Sequence[float],
    *,
    max_runs: int,
    width: float,
    resolution: float = 1.0,
    may_slide: bool = False,
) -> ScaleScan:
    """Scan scales, halve doubtful intervals, and narrow every change of the verdict."""
    # Between two runs of the same verdict an even number of flips may hide. Below the least scale
    # that overturns, every interval is halved down to the resolution, the widest first, except
    # where the base does not lift: it does not lift at lower scales either, unless it may slide.
    # Then the intervals in which flips are likely are halved, below that scale and above it.
    least, *larger = scales
    side = Side(1.0, {least: run_at(least)}, [least])
    completed = True
    wide_intervals = partial(_wide_intervals, side, resolution, may_slide=may_slide)
    try:
        for scale in larger:
            side.add(scale, run_at(scale))
        while (gaps := list(wide_intervals())) and len(side.places) < max_runs:
            near, far = max(gaps, key=lambda ends: (ends[1] - ends[0]) / ends[1])
            middle = 0.5 * (near + far)
            side.add(middle, run_at(middle))
        for up_to_first in (True, False):
            while _halve_suspects(side, run_at, max_runs, up_to_first=up_to_first):
                pass
        for flip in list(_flips(_sorted_runs(side))):
            _bisect(side, run_at, flip, width)
    except KeyboardInterrupt:
        completed = False
    ends = [near for near, _ in wide_intervals(above_first=True)]
    runs = _sorted_runs(side)
    ends += [near for near, far in side.intervals()
             if None in (runs[near].overturned, runs[far].overturned)]  # fmt: skip
    return ScaleScan(runs, min([*ends, side.places[-1]]), completed)


def _wide_intervals(
    side: Side, resolution: float, *, may_slide: bool, above_first: bool = False
) -> Iterator[tuple[float, float]]:
    """Return wide intervals where the base lifts: below the least scale that overturns, or all."""
    for near, far in side.intervals():
        verdicts = side.shown[near].overturned, side.shown[far].overturned
        if verdicts[0] and not above_first:
            return
        if near == 0.0 and far <= resolution * side.places[-1]:
            continue  # halving towards zero would not end
        is_wide = None not in verdicts and far - near > resolution * far
        if is_wide and (side.shown[far].lifted or may_slide):
            yield near, far


def _halve_suspects(side: Side, run_at: RunAtScale, max_runs: int, *, up_to_first: bool) -> bool:
    """Halve the suspect intervals; give whether there were some, and runs left for them."""
    suspects = list(_suspect_intervals(side, up_to_first=up_to_first))
    # runs may not suffice for all: those nearest to overturning come first
    for near, far in sorted(suspects, key=lambda ends: _clearance(side, *ends)):
        if len(side.places) >= max_runs:
            return False
        middle = 0.5 * (near + far)
        side.add(middle, run_at(middle))
        if up_to_first and side.shown[middle].overturned:
            break  # the others lie above the least scale that overturns
    return bool(suspects)


def _suspect_intervals(side: Side, *, up_to_first: bool) -> Iterator[tuple[float, float]]:
    """Return the intervals in which flips may hide, from low to high."""
    for number, (near, far) in enumerate(side.intervals()):
        before, after = side.shown[near].overturned, side.shown[far].overturned
        if up_to_first and before:
            return
        if far - near <= MIN_INTERVAL * far or before is None or after is None:
            continue
        if _clearance(side, near, far) > 1.0 - SMALL_PEAK:
            continue
        # flips may hide on both sides of the first one
        if up_to_first if before != after else may_change_between(side, number):
            yield near, far


def _clearance(side: Side, near: float, far: float) -> float:
    """Return the smaller clearance of both runs to the overturning angle; 0 if it was passed."""
    ends = side.shown[near], side.shown[far]
    return min(run.clearances[0] if run.within_the_angle else 0.0 for run in ends)


def _bisect(side: Side, run_at: RunAtScale, flip: Flip, width: float) -> None:
    """Bisect a bracket, until it is narrow or a run in its middle has no verdict."""
    below, above = flip.below, flip.above
    while above - below > width * above:
        middle = 0.5 * (below + above)
        if middle in side.shown or not below < middle < above:
            return
        side.add(middle, run_at(middle))
        verdict = side.shown[middle].overturned
        if verdict is None:
            return
        below, above = (below, middle) if verdict == flip.overturns_above else (middle, above)


def _flips(runs: Mapping[float, RunSummary]) -> Iterator[Flip]:
    decided = [(at, run.overturned) for at, run in runs.items() if run.overturned is not None]
    for (below, before), (above, after) in pairwise(decided):
        if before != after:
            yield Flip(below, above, after)


def _sorted_runs(side: Side) -> dict[float, RunSummary]:
    return {scale: side.shown[scale] for scale in side.places}


_MIN_DIGITS: Final = 4
_ROUNDING_TOLERANCE: Final = 1e-9
"""Excess over a digit, in units of it, that is not rounded up [1]."""
_MAX_LISTED_RANGES: Final = 3
"""Most ranges of scales without overturning that are named one by one."""


def flips_sentence(scan: ScaleScan, *, width: float, resolution: float = 1.0) -> str:
    """Return in words from which scale the block overturns, where it stands again, and the gaps."""
    digits = max(_MIN_DIGITS, 1 + math.ceil(-math.log10(width)))

    def number(scale: float) -> str:
        return f"{scale:.{digits}g}"

    scales = list(scan.runs)
    largest, flips = scales[-1], scan.flips()
    critical = least_overturning_scale(scan.runs)
    if not scan.decided:
        text = "No run could be finished"
    elif math.isnan(critical):
        text = f"Did not overturn up to {number(scan.decided[-1])} times the motion"
    elif critical == 0.0:
        text = "Overturns without the motion"
    else:
        text = f"Overturns from {number(critical)} times the motion on"
    ends = [(number(start), number(end)) for start, end in _standing_ranges(flips, largest)]
    gaps = [f"at {start}" if start == end else f"from {start} to {end}" for start, end in ends]
    if gaps:
        text += f", stands again {_range_words(gaps)}"
    plural = "" if len(scales) == 1 else "s"
    text += f"; {len(scales)} scale{plural} tried up to {number(largest)}"
    if not math.isnan(gap := scan.largest_gap):  # to two digits, rounded up
        size = 10.0 ** (math.floor(math.log10(gap)) - 1)
        text += f", at most {math.ceil(gap / size - _ROUNDING_TOLERANCE) * size:.2g} apart"
    runs = scan.runs.values()
    slides, slips = np.array([run.slides for run in runs]), np.array([run.slip for run in runs])
    text += "".join(f"; {words}" for words in (share_words(slides), slip_words(slips)) if words)
    text += "." if scan.completed else ", then interrupted."
    first = next((flip for flip in flips if flip.overturns_above), None)
    end = largest
    if first is not None:  # runs without a verdict may leave its bracket wide
        wide = first.above - first.below > resolution * first.above
        end = first.above if wide else first.below
    if scan.resolved_up_to < end and critical != scales[0]:  # there is none below the least
        text += (
            f" Beyond {number(scan.resolved_up_to)} some are more than {100.0 * resolution:g} % "
            "apart, and a lesser scale between them may overturn."
        )
    if undecided := scan.undecided:
        text += f" {unfinished_words(undecided)}, the first at {number(undecided[0])}."
    return text


def unfinished_words(undecided: Sequence[float]) -> str:
    """Return in words how many runs have no verdict."""
    if len(undecided) == 1:
        return "1 run could not be finished and has no verdict"
    return f"{len(undecided)} runs could not be finished and have no verdict"


def least_overturning_scale(runs: dict[float, RunSummary]) -> float:
    """Return the least scale that overturned; NaN if none did."""
    return next((scale for scale, run in runs.items() if run.overturned), math.nan)


def _standing_ranges(flips: Sequence[Flip], largest: float) -> list[tuple[float, float]]:
    """Return the ranges where the block stands again: their least and greatest scale of a run."""
    starts = [flip.above for flip in flips if not flip.overturns_above]
    ends = [*(flip.below for flip in flips[1:] if flip.overturns_above), largest]
    return list(zip(starts, ends, strict=False))


def _range_words(gaps: list[str]) -> str:
    named, more = gaps[:_MAX_LISTED_RANGES], len(gaps) - _MAX_LISTED_RANGES
    if more > 0:
        further = "range" if more == 1 else "ranges"
        return f"{', '.join(named)} and in {more} further {further}"
    return enumeration(named)
