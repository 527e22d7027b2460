"""Brackets about every change of a verdict along the scale of motions, narrowed in rounds.

All brackets of all lines are halved at once, in one sweep a round.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Final

import numpy as np
import xarray as xr

from rockframe.results.outcome import Generic
from rockframe.signals.arrays import Array
from rockframe.studies.limit_states import interrupted

MOST_ROUNDS: Final = 60
"""More are not needed, whatever the width: then neighbouring floats have been reached."""

Sweep = Callable[[int, Generic, Array], xr.Dataset]
"""Runs cases: the number of the round, the line of each case, and its scale."""
Verdicts = Callable[[xr.Dataset], Array]
"""Gives the verdicts of cases, whole numbers as floats, NaN where there is none; over verdicts,
then cases."""


@dataclass(frozen=True)
class Bracket:
    """Two scales of unlike verdicts, between which no run has a verdict."""

    verdict: int  # which verdict along which line
    line: int
    below: float  # the scales
    above: float
    before: float  # the verdicts there
    after: float


def brackets_of(scales: Array, verdicts: Array) -> list[Bracket]:
    """Find all changes among verdicts."""
    found: list[Bracket] = []
    for verdict, line in np.ndindex(verdicts.shape[:2]):
        along = verdicts[verdict, line]
        (known,) = np.nonzero(~np.isnan(along))
        for k in np.flatnonzero(np.diff(along[known]) != 0.0):
            low, high = known[k], known[k + 1]
            below, above = float(scales[low]), float(scales[high])
            before, after = float(along[low]), float(along[high])
            found.append(Bracket(verdict, line, below, above, before, after))
    return found


def narrowed(
    brackets: Sequence[Bracket], sweep: Sweep, verdicts: Verdicts, *, width: float
) -> tuple[list[Bracket], bool]:
    """Halve brackets in rounds until they are narrow.

    Where the middle has a third verdict a bracket becomes two.
    """
    done: list[Bracket] = []
    waiting = list(brackets)
    whole = True
    for number in range(1, MOST_ROUNDS + 1):
        wide = [one for one in waiting if one.above - one.below > width * one.above]
        done += [one for one in waiting if one.above - one.below <= width * one.above]
        waiting = []
        if not wide:
            break
        # brackets of several verdicts may have the same middle
        wanted = sorted({(one.line, 0.5 * (one.below + one.above)) for one in wide})
        lines, middles = (np.array(each) for each in zip(*wanted, strict=True))
        try:
            runs = sweep(number, lines, middles)
            found, whole = verdicts(runs), not interrupted(runs)
        except KeyboardInterrupt:  # between the runs of two rounds
            done, whole = [*done, *wide], False
            break
        place = {case: k for k, case in enumerate(wanted)}
        for one in wide:
            middle = 0.5 * (one.below + one.above)
            shown = float(found[one.verdict, place[one.line, middle]])
            if np.isnan(shown):
                done.append(one)
            else:
                waiting += _halved(one, middle, shown)
        if not whole:
            break
    rising = sorted([*done, *waiting], key=lambda one: (one.verdict, one.line, one.below))
    return rising, whole


def _halved(one: Bracket, middle: float, shown: float) -> Iterator[Bracket]:
    if shown != one.before:
        yield replace(one, above=middle, after=shown)
    if shown != one.after:
        yield replace(one, below=middle, before=shown)


def bracket_arrays(
    brackets: Sequence[Bracket], shape: tuple[int, int]
) -> tuple[Array, Array, Array, Array]:
    """Arrange brackets in arrays."""
    count = np.zeros(shape, dtype=np.intp)
    for one in brackets:
        count[one.verdict, one.line] += 1
    values = np.full((4, *shape, int(count.max(initial=0))), np.nan)
    count[:] = 0
    for one in brackets:
        place = one.verdict, one.line
        values[(slice(None), *place, count[place])] = one.below, one.above, one.before, one.after
        count[place] += 1
    below, above, before, after = values
    return below, above, before, after


def least_exceeding(scales: Array, shown: Array, above: Array, after: Array) -> Array:
    """Give the least scale that exceeds a limit state."""
    rising = np.where(after == 1.0, above, np.inf).min(axis=-1, initial=np.inf)
    at = np.where(shown == 1.0, scales, np.inf).min(axis=-1)
    least = np.minimum(rising, at)
    return np.where(np.isfinite(least), least, np.nan)
