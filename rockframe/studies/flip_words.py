"""What a scan of scales found, in words."""

import math
from collections.abc import Sequence
from typing import Final

import numpy as np

from rockframe.simulation.friction import share_words
from rockframe.simulation.run_summary import RunSummary
from rockframe.studies.flips import Flip, Followed

_FEWEST_DIGITS: Final = 4
_ROUNDING: Final = 1e-9
"""Of a distance over its last digit, not to be rounded up [1]."""
_MOST_GAPS: Final = 3
"""Ranges that stand again which are named one by one."""


def sentence(found: Followed, *, width: float) -> str:
    """Tell from which scale on the block overturns, where it stands again, and what was tried.

    Parameters
    ----------
    found : Followed
        The runs.
    width : float
        Relative width of the brackets, which rules the digits [1].

    Returns
    -------
    str
    """
    digits = max(_FEWEST_DIGITS, 1 + math.ceil(-math.log10(width)))

    def number(scale: float) -> str:
        return f"{scale:.{digits}g}"

    scales = list(found.shown)
    largest, flips = scales[-1], found.flips()
    critical = least_overturning(found.shown)
    if math.isnan(critical):
        text = f"Did not overturn up to {number(largest)} times the motion"
    elif critical == 0.0:
        text = "Overturns without the motion"
    else:
        text = f"Overturns from {number(critical)} times the motion on"
    ends = [(number(start), number(end)) for start, end in _gaps(flips, largest)]
    gaps = [f"at {start}" if start == end else f"from {start} to {end}" for start, end in ends]
    if gaps:
        text += f", stands again {_listed(gaps)}"
    text += f"; looked at {len(scales)} scales up to {number(largest)}"
    if not math.isnan(found.largest_gap):
        text += f", at most {_at_most(found.largest_gap)} apart"
    slides = share_words(np.array([run.slides for run in found.shown.values()]))
    text += f"; {slides}" if slides else ""
    text += "." if found.whole else ", then interrupted."
    if found.up_to < largest:
        lesser = " and a lesser scale" if not found.up_to >= critical else ""
        text += (
            f" Beyond {number(found.up_to)} there are signs of further flips{lesser} between them: "
            "they are not close enough together to tell."
        )
    undecided = [scale for scale, run in found.shown.items() if run.overturned is None]
    if undecided:
        text += f" {unfinished(undecided)}, the first at {number(undecided[0])}."
    return text


def _at_most(gap: float) -> str:
    """Give a distance to two digits, rounded up."""
    size = 10.0 ** (math.floor(math.log10(gap)) - 1)
    return f"{math.ceil(gap / size - _ROUNDING) * size:.2g}"


def unfinished(undecided: Sequence[float]) -> str:
    """Tell how many runs have no verdict."""
    if len(undecided) == 1:
        return "1 run could not be finished and has no verdict"
    return f"{len(undecided)} runs could not be finished and have no verdict"


def least_overturning(shown: dict[float, RunSummary]) -> float:
    """Give the least scale that overturned; NaN if none did."""
    return next((scale for scale, run in shown.items() if run.overturned), math.nan)


def _gaps(flips: Sequence[Flip], largest: float) -> list[tuple[float, float]]:
    """Give where the block stands again: the least and greatest scale that it was seen to."""
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
