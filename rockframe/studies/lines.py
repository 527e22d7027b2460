"""Verdicts followed along the scale of the motion, in rounds of runs under all motions at once.

First all motions at the scales of a first row; then the middles of wide intervals below what first
exceeds a limit state; then brackets of all changes of a verdict, which are halved.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any, Final

import numpy as np
import xarray as xr

from rockframe.errors import (
    ComponentError,
    ModelWarning,
    SolverWarning,
    collected_warnings,
    shown,
    warn,
)
from rockframe.motion import GroundMotion
from rockframe.results.outcome import PEAK_SLIPS, Generic
from rockframe.results.table import head
from rockframe.results.variables.studies import CASE, MOTION
from rockframe.signals.arrays import Array
from rockframe.studies.limit_states import interrupted
from rockframe.studies.rounds import Rounds, rounds_of
from rockframe.studies.sweeps.arguments import SweepArguments
from rockframe.studies.sweeps.axes import numbers_of
from rockframe.studies.sweeps.motions import TARGETS
from rockframe.units import Condition, Measure, to_ratio

if TYPE_CHECKING:
    from rockframe.simulation.system import System


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


@dataclass(frozen=True, eq=False)
class Seen:
    """What is known of lines at scales."""

    scales: Array  # all that were run along some line
    verdicts: Array  # over verdicts, lines and scales; NaN where a line was not run, or told none
    moves: Generic  # over lines and scales: whether the base left the ground, or slid

    def joined(self, scales: Array, lines: Generic, verdicts: Array, moves: Generic) -> "Seen":
        """Add cases: their scales and lines, and what they showed."""
        every = np.union1d(self.scales, scales)
        known = np.full((*self.verdicts.shape[:2], len(every)), np.nan)
        moved = np.ones(known.shape[1:], dtype=bool)
        old, new = np.searchsorted(every, self.scales), np.searchsorted(every, scales)
        known[..., old], moved[:, old] = self.verdicts, self.moves
        known[:, lines, new], moved[lines, new] = verdicts, moves
        return Seen(every, known, moved)

    def gaps(self, verdict: int, line: int) -> tuple[Array, Array]:
        """Give the intervals between runs, up to the one that ends at the first exceedance.

        Without those at whose upper end nothing moves: a base that holds with elastic parts holds
        at any lesser scale too.
        """
        along = self.verdicts[verdict, line]
        (known,) = np.nonzero(~np.isnan(along))
        (over,) = np.nonzero(along[known] == 1.0)
        known = known[: over[0] + 1] if len(over) else known
        known, far = known[:-1], known[1:]
        there = self.moves[line, far]
        return self.scales[known[there]], self.scales[far[there]]

    def middles(self, resolution: float) -> list[tuple[int, float]]:
        """Give the lines, and the middles of their gaps, that are wider than the resolution."""
        found: set[tuple[int, float]] = set()
        for verdict, line in np.ndindex(self.verdicts.shape[:2]):
            near, far = self.gaps(verdict, line)
            middle = 0.5 * (near + far)
            found |= {(line, one) for one in middle[far - near > resolution * far].tolist()}
        return sorted(found)

    @property
    def resolution(self) -> Array:
        """The widest gap below each first exceedance, over its upper end; verdicts, lines [1].

        One where the least scale exceeds already: nothing parts it from zero.
        """
        found = np.zeros(self.verdicts.shape[:2])
        for place in np.ndindex(found.shape):
            near, far = self.gaps(*place)
            along = self.verdicts[place]
            along = along[~np.isnan(along)]
            at_once = not len(along) or along[0] == 1.0
            found[place] = 1.0 if at_once else np.max((far - near) / far, initial=0.0)
        return found

    @property
    def first(self) -> Array:
        """The least scale that exceeds; infinite where none does, NaN without any verdict."""
        least = np.where(self.verdicts == 1.0, self.scales, np.inf).min(axis=-1)
        return np.where(np.isnan(self.verdicts).all(axis=-1), np.nan, least)


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


def least_exceeding(seen: Array, above: Array, after: Array) -> Array:
    """Give the least scale that exceeds, seen or in a bracket; infinite where none was found to."""
    rising = np.where(after == 1.0, above, np.inf).min(axis=-1, initial=np.inf)
    return np.minimum(rising, seen)


SCALE: Final = "scale"
CAPACITY: Final = "least scale found to exceed"
"""What a capacity is, as datasets tell it."""
_SCAN: Final = "scan"
INTERRUPTED: Final = "; interrupted."
"""Ends the verdict of an analysis whose brackets are wider than asked."""
_WIDTH: Final = Condition("from 1e-12 to 0.1", lambda value: 1e-12 <= value <= 0.1)
_MOST_SCALES: Final = 100_000
_RESOLUTION: Final = Condition("from 1e-4 to 1", lambda value: 1e-4 <= value <= 1.0)

LabelledVerdicts = Callable[[xr.Dataset], xr.DataArray]
"""Gives the verdicts of a sweep over ``verdict`` and its dimensions."""
VERDICT: Final = "verdict"


@dataclass(frozen=True, eq=False)
class Lines:
    """What is the same along each line, and how it is run."""

    scene: "System | Callable[..., System]"  # as for :func:`rockframe.sweep`
    motions: Mapping[str, GroundMotion]  # all of them
    # further values, and their unit, for each row of a table; one row without values if there are
    # none
    columns: Mapping[str, tuple[Array, str]]
    # how all of it is run. The scan and each round have a folder of their own in its store
    run: SweepArguments
    owner: str  # function that asks for it
    # what only the scan keeps beside: histories, of which the rounds need none
    kept: Mapping[str, Any] = field(default_factory=dict[str, Any])

    def followed(
        self,
        scales: Array,
        verdicts: LabelledVerdicts,
        *,
        width: float,
        resolution: float | None = None,
    ) -> tuple[xr.Dataset, Seen, list[Bracket]]:
        """Run all rows and motions at all scales, and narrow every change of a verdict.

        With a resolution the intervals below what first exceeds are made narrower than that
        before. One bar counts the cases of the scan and of all rounds. After an interrupt (Ctrl-C)
        the verdict of the scan says so.
        """
        with rounds_of(self.scene, self.motions, self.run, owner=self.owner) as rounds:
            runner = _Runner(self, rounds)
            scan = runner.scan(scales)
            with collected_warnings() as said:
                seen, whole = runner.seen(scan, verdicts, resolution)
                found = brackets_of(seen.scales, seen.verdicts)
                if whole:
                    found, whole = runner.narrowed(found, verdicts, width)
        if said and whole:
            warn(f"{self.owner}: in further rounds: {said[0]}", ModelWarning)
        if not whole:
            scan.attrs["verdict"] = f"{str(scan.attrs['verdict']).removesuffix('.')}{INTERRUPTED}"
            kept = "; the same call goes on, as it has a store" if rounds.store is not None else ""
            warn(f"{self.owner}: interrupted; brackets are wider than asked{kept}", SolverWarning)
        return scan, seen, found


@dataclass(frozen=True, eq=False)
class _Runner:
    """Makes the sweeps of an analysis, one after the other."""

    lines: Lines
    rounds: Rounds

    def scan(self, scales: Array) -> xr.Dataset:
        """Run all rows and motions at all scales."""
        heads = self._heads(slice(None))
        return self.rounds.sweep(_SCAN, heads or None, {SCALE: scales}, **self.lines.kept)

    def seen(
        self, scan: xr.Dataset, verdicts: LabelledVerdicts, resolution: float | None
    ) -> tuple[Seen, bool]:
        """Give what the scan showed, and runs in its gaps; tell if all have been made."""
        order = ([CASE] if self.lines.columns else []) + [MOTION, SCALE]
        shown = verdicts(scan).transpose(VERDICT, *order).to_numpy()
        shown = shown.reshape(len(shown), -1, shown.shape[-1])
        moves = _moves(scan).transpose(*order).to_numpy().reshape(shown.shape[1:])
        seen = Seen(scan[SCALE].to_numpy(), shown, moves)
        tried: set[tuple[int, float]] = set()
        for number in range(1, MOST_ROUNDS + 1):
            if interrupted(scan):
                return seen, False
            # where a middle told no verdict the gap stays
            wanted = [] if resolution is None else sorted({*seen.middles(resolution)} - tried)
            if not wanted:
                break
            tried |= set(wanted)
            lines, middles = (np.array(each) for each in zip(*wanted, strict=True))
            try:
                scan = self._cases(f"finer {number:02d}", lines, middles)
            except KeyboardInterrupt:  # between the runs of two rounds
                return seen, False
            found = verdicts(scan).transpose(VERDICT, CASE).to_numpy()
            seen = seen.joined(middles, lines, found, _moves(scan).to_numpy())
        return seen, True

    def narrowed(
        self, brackets: Sequence[Bracket], verdicts: LabelledVerdicts, width: float
    ) -> tuple[list[Bracket], bool]:
        """Narrow every change of a verdict between two scales that were run; tell if all are."""

        def middles(number: int, lines: Generic, scales: Array) -> xr.Dataset:
            return self._cases(f"round {number:02d}", lines, scales)

        def seen(runs: xr.Dataset) -> Array:
            return verdicts(runs).transpose(VERDICT, CASE).to_numpy()

        return narrowed(brackets, middles, seen, width=width)

    def _cases(self, part: str, lines: Generic, scales: Array) -> xr.Dataset:
        """Run lines at scales of their own."""
        names = list(self.lines.motions)
        rows, motions = np.divmod(lines, len(names))
        cases = {**self._heads(rows), SCALE: scales, MOTION: [names[k] for k in motions]}
        return self.rounds.sweep(part, cases, {})

    def _heads(self, rows: Any) -> dict[str, Any]:
        columns = self.lines.columns.items()
        return {head(name, unit): values[rows] for name, (values, unit) in columns}


def _moves(runs: xr.Dataset) -> xr.DataArray:
    """Tell in which runs a base left the ground, or slid; that of a lower body too."""
    moves = runs["first_uplift_time"].notnull() | (runs["impact_count"] > 0)
    moves |= runs["overturned"] == 1
    for slip in (runs[name] for name in PEAK_SLIPS if name in runs):
        moves |= ~(slip.max([dim for dim in slip.dims if dim not in moves.dims]) == 0.0)
    return moves


def read_resolution(given: object, *, owner: str) -> float:
    """Read the relative width of gaps below a capacity."""
    return to_ratio(given, owner=owner, name="resolution", condition=_RESOLUTION, example="0.02")


def read_rising(given: object, measure: Measure, name: str, *, owner: str) -> Array:
    """Read values above zero; those that are alike are one."""
    values = np.unique(numbers_of(given, measure, name))
    if not len(values) or values[0] <= 0.0:
        msg = f"{owner}: {name} must be above zero, got {shown(given)}"
        raise ComponentError(msg)
    return values


def read_scales(given: object, *, owner: str) -> Array:
    """Read the scales of a scan."""
    values = np.unique(numbers_of(given, TARGETS[SCALE].measure, SCALE))
    if not 2 <= len(values) <= _MOST_SCALES or values[0] <= 0.0:
        wanted = f"2 to {_MOST_SCALES} different numbers above zero"
        msg = f"{owner}: scale needs {wanted}, got {shown(given)}"
        raise ComponentError(msg)
    return values


def read_width(given: object, *, owner: str) -> float:
    """Read the relative width of brackets."""
    return to_ratio(given, owner=owner, name="bracket_width", condition=_WIDTH, example="0.001")
