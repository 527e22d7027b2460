"""Verdicts along the scale of the motion, found in rounds of runs under all motions together.

The scan comes first, all motions at given scales; then the middles of wide intervals below the
first exceedance of a limit state; then brackets of all changes of a verdict are halved. All these
sweeps share one progress bar, and each has a folder of its own.
"""

from collections.abc import Callable, Generator, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Final

import numpy as np
import xarray as xr

from rockframe.errors import (
    ComponentError,
    ModelWarning,
    SolverWarning,
    StudyError,
    collected_warnings,
    short_repr,
    warn,
)
from rockframe.motion import GroundMotion
from rockframe.results.outcome import PEAK_SLIPS, Generic
from rockframe.results.table import head
from rockframe.results.variables.studies import CASE, MOTION
from rockframe.signals.arrays import Array
from rockframe.simulation.system import System
from rockframe.studies.sweeps.arguments import ExecutionArguments, SweepArguments
from rockframe.studies.sweeps.axes import numbers_of
from rockframe.studies.sweeps.case import remember
from rockframe.studies.sweeps.execution import ProgressBar, bar_of
from rockframe.studies.sweeps.motions import TARGETS
from rockframe.studies.sweeps.planning import plan_study
from rockframe.studies.sweeps.sweep import folder_of, run_study
from rockframe.units import Condition, Measure, to_ratio
from rockframe.version import __version__

SCALE: Final = "scale"
VERDICT: Final = "number of the verdict"
"""Dimension of verdicts along lines; no axis can have such a name."""
CAPACITY: Final = "least scale found to exceed"
"""Definition of a capacity, for the attributes of datasets."""
SOURCE: Final = f"rockframe {__version__}, scan and bisection of event-driven runs"
"""Source of the numbers of such analyses, for the attributes of datasets."""
INTERRUPTED: Final = "; interrupted."
"""Ends the verdict of an analysis whose brackets are wider than asked."""
MOST_ROUNDS: Final = 60
"""Most rounds of halving, whatever the width: by then neighbouring floats are reached."""
_WIDTH: Final = Condition("from 1e-12 to 0.1", lambda value: 1e-12 <= value <= 0.1)
_RESOLUTION: Final = Condition("from 1e-4 to 1", lambda value: 1e-4 <= value <= 1.0)
_MOST_SCALES: Final = 100_000


@dataclass(frozen=True, eq=False)
class Rounds:
    """What all sweeps of an analysis, made one after the other, have in common."""

    scene: System | Callable[..., System]  # as for :func:`rockframe.sweep`
    motions: Mapping[str, GroundMotion] | None
    run: Mapping[str, Any]  # arguments of each sweep, and who makes the runs
    store: Path | None
    bar: ProgressBar

    def sweep(
        self,
        part: str,
        cases: Any,
        axes: Mapping[str, Any],
        *,
        further: bool = False,
        **more: Any,
    ) -> tuple[xr.Dataset, bool]:
        """Run the cases of a part, whose name is used for its folder and on the bar.

        Also return whether this was not interrupted. Parts after the first are not recorded for
        :func:`rockframe.case`, as no result has them.
        """
        arguments = {**self.run, **more}
        means: Any = {
            name: arguments.pop(name, None) for name in ExecutionArguments.__annotations__
        }
        del means["progress"]
        means["store"] = None if self.store is None else self.store / part
        study = plan_study(self.scene, self.motions, axes, cases, **arguments)
        if not further:
            remember(study)
        self.bar.name(part)
        return run_study(study, self.bar, **means)


@contextmanager
def rounds_of(
    scene: System | Callable[..., System],
    motions: Mapping[str, GroundMotion] | None,
    run: Mapping[str, Any],
    *,
    owner: str,
) -> Generator[Rounds]:
    """Make the folder of an analysis, if it has one, and its bar, which closes when it ends."""
    value = run.get("store")
    folder = None if value is None else folder_of(value, owner=owner)
    try:
        if folder is not None:
            folder.mkdir(parents=True, exist_ok=True)
    except OSError as problem:
        msg = f"{owner}: store {str(folder)!r} cannot be made: {problem}"
        raise StudyError(msg) from problem
    with bar_of(run.get("progress"), owner=owner) as bar:
        yield Rounds(scene, motions, run, folder, bar)


Wanted = list[tuple[int, float]]
"""Numbers of lines, each with a scale at which it is to be run."""


@dataclass(frozen=True)
class Bracket:
    """Two scales of unlike verdicts, between which no run has a verdict."""

    verdict: int  # which verdict along which line
    line: int
    below: float  # the scales
    above: float
    before: float  # the verdicts there
    after: float

    @property
    def middle(self) -> float:
        """The scale in its middle."""
        return 0.5 * (self.below + self.above)

    def halved(self, shown: float) -> Iterator["Bracket"]:
        """Return the part that remains by the verdict of its middle; both parts by a third one."""
        if shown != self.before:
            yield replace(self, above=self.middle, after=shown)
        if shown != self.after:
            yield replace(self, below=self.middle, before=shown)


def brackets_of(scales: Array, verdicts: Array) -> list[Bracket]:
    """Find all changes among verdicts."""
    found: list[Bracket] = []
    for verdict, line in np.ndindex(verdicts.shape[:2]):
        along = verdicts[verdict, line]
        (known,) = np.nonzero(~np.isnan(along))
        for k in np.flatnonzero(np.diff(along[known]) != 0.0):
            ends = known[k : k + 2]
            found.append(Bracket(verdict, line, *scales[ends].tolist(), *along[ends].tolist()))
    return found


def narrowed(
    brackets: Sequence[Bracket], look: Callable[[str, Wanted], tuple[Array, bool]], *, width: float
) -> tuple[list[Bracket], bool]:
    """Halve brackets in rounds until they are narrow; return whether all of them are.

    This uses the verdicts of the runs of a named part, and whether all were made.
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
        wanted = sorted({(one.line, one.middle) for one in wide})
        try:
            found, whole = look(f"round {number:02d}", wanted)
        except KeyboardInterrupt:  # between the runs of two rounds
            done, whole = [*done, *wide], False
            break
        place = {case: k for k, case in enumerate(wanted)}
        for one in wide:
            shown = float(found[one.verdict, place[one.line, one.middle]])
            if np.isnan(shown):
                done.append(one)
            else:
                waiting += one.halved(shown)
        if not whole:
            break
    rising = sorted([*done, *waiting], key=lambda one: (one.verdict, one.line, one.below))
    return rising, whole


def bracket_arrays(
    brackets: Sequence[Bracket], shape: tuple[int, int]
) -> tuple[Array, Array, Array, Array]:
    """Arrange brackets in arrays: lower and upper scales, and the verdicts there."""
    rows: dict[tuple[int, int], list[Bracket]] = {}
    for one in brackets:
        rows.setdefault((one.verdict, one.line), []).append(one)
    values = np.full((4, *shape, max(map(len, rows.values()), default=0)), np.nan)
    for place, several in rows.items():
        numbers = [(one.below, one.above, one.before, one.after) for one in several]
        values[(slice(None), *place, slice(len(several)))] = np.transpose(numbers)
    below, above, before, after = values
    return below, above, before, after


@dataclass(frozen=True, eq=False)
class Seen:
    """Verdicts of all lines at the scales that were run."""

    scales: Array  # all scales that were run along some line
    verdicts: Array  # over verdicts, lines and scales; NaN where a line was not run, or has none
    moves: Generic  # over lines and scales: whether the base left the ground, or slid

    def joined(self, cases: Wanted, verdicts: Array, moves: Generic) -> "Seen":
        """Add cases, and what they showed."""
        lines, scales = (np.array(each) for each in zip(*cases, strict=True))
        every = np.union1d(self.scales, scales)
        known = np.full((*self.verdicts.shape[:2], len(every)), np.nan)
        moved = np.ones(known.shape[1:], dtype=bool)
        old, new = np.searchsorted(every, self.scales), np.searchsorted(every, scales)
        known[..., old], moved[:, old] = self.verdicts, self.moves
        known[:, lines, new], moved[lines, new] = verdicts, moves
        return Seen(every, known, moved)

    def gaps(self, verdict: int, line: int) -> tuple[Array, Array]:
        """Return the intervals between runs, up to the one that ends at the first exceedance.

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

    def middles(self, resolution: float) -> Wanted:
        """Return lines and the middles of their gaps that are wider than the resolution."""
        found = set[tuple[int, float]]()
        for verdict, line in np.ndindex(self.verdicts.shape[:2]):
            near, far = self.gaps(verdict, line)
            middle = 0.5 * (near + far)
            found |= {(line, one) for one in middle[far - near > resolution * far].tolist()}
        return sorted(found)

    @property
    def resolution(self) -> Array:
        """The widest gap below each first exceedance, over its upper end; verdicts, lines [1].

        It is 1 where the least scale exceeds already: the gap extends to zero.
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
        """The least scale that exceeds; infinite if none does, NaN without any verdict."""
        least = np.where(self.verdicts == 1.0, self.scales, np.inf).min(axis=-1)
        return np.where(np.isnan(self.verdicts).all(axis=-1), np.nan, least)


@dataclass(frozen=True, eq=False)
class FollowedLines:
    """Result of an analysis along lines."""

    scan: xr.Dataset  # the runs at the scales of the first row
    seen: Seen  # verdicts of these runs and of those in their gaps
    brackets: list[Bracket]

    def capacities(self, shape: tuple[int, ...]) -> dict[str, Array]:
        """Return variables of capacities in a dataset, over verdicts and lines in some shape."""
        _, above, _, after = self.arrays(shape)
        rising = np.where(after == 1.0, above, np.inf).min(axis=-1, initial=np.inf)
        return {
            "capacity_scale": np.minimum(rising, self.seen.first.reshape(shape)),
            "capacity_resolution": self.seen.resolution.reshape(shape),
        }

    def flips(self, shape: tuple[int, ...]) -> dict[str, Array]:
        """Return the variables of changes of verdicts in a dataset."""
        below, above, _, after = self.arrays(shape)
        count = np.isfinite(below).sum(axis=-1)
        return {
            "flip_count": count, "scale_below": below, "scale_above": above, "exceeds_above": after
        }  # fmt: skip

    def arrays(self, shape: tuple[int, ...]) -> Iterator[Array]:
        """Return lower and upper scales of brackets, and the verdicts there."""
        every = bracket_arrays(self.brackets, self.seen.verdicts.shape[:2])
        return (one.reshape((*shape, -1)) for one in every)


@dataclass(frozen=True, eq=False)
class Lines:
    """Scene, motions and rows of the lines, and how their runs are made."""

    scene: System | Callable[..., System]  # as for :func:`rockframe.sweep`
    motions: Mapping[str, GroundMotion]  # all of them
    # further values, and their unit, for each row of a table; one row without values if there are
    # none
    columns: Mapping[str, tuple[Array, str]]
    # how all of it is run. The scan and each round have a folder of their own in its store
    run: SweepArguments
    owner: str  # the calling public function, for messages
    # gives the verdicts of runs over ``verdict`` and their dimensions: whole numbers as floats, NaN
    # where there is none
    verdicts: Callable[[xr.Dataset], xr.DataArray]

    def followed(
        self, scales: Array, *, width: float, resolution: float | None = None, **kept: Any
    ) -> FollowedLines:
        """Run all rows and motions at all scales, and narrow every change of a verdict.

        With a resolution the intervals below the first exceedance are made narrower than that
        before. Only the runs of the scan have the histories `kept`. After an interrupt (Ctrl-C) the
        verdict of the scan says so.
        """
        with rounds_of(self.scene, self.motions, self.run, owner=self.owner) as rounds:
            heads = self._heads(slice(None))
            scan, whole = rounds.sweep("scan", heads or None, {SCALE: scales}, **kept)

            def look(part: str, wanted: Wanted) -> tuple[Array, bool]:
                return self._at(rounds, part, wanted)[1:]

            with collected_warnings() as warned:
                seen = self._seen(scan)
                if whole and resolution is not None:
                    seen, whole = self._finer(rounds, seen, resolution)
                found = brackets_of(seen.scales, seen.verdicts)
                if whole:
                    found, whole = narrowed(found, look, width=width)
        if warned and whole:
            warn(f"{self.owner}: in further rounds: {warned[0]}", ModelWarning)
        if not whole:
            scan.attrs["verdict"] = f"{str(scan.attrs['verdict']).removesuffix('.')}{INTERRUPTED}"
            goes_on = "; the same call goes on, as it has a store" if rounds.store else ""
            msg = f"{self.owner}: interrupted; brackets are wider than asked{goes_on}"
            warn(msg, SolverWarning)
        return FollowedLines(scan, seen, found)

    def _seen(self, runs: xr.Dataset) -> Seen:
        """Return the verdicts of the scan."""
        order = ([CASE] if self.columns else []) + [MOTION, SCALE]
        shown = self.verdicts(runs).transpose(VERDICT, *order).to_numpy()
        shown = shown.reshape(len(shown), -1, shown.shape[-1])
        moves = _moves(runs).transpose(*order).to_numpy().reshape(shown.shape[1:])
        return Seen(runs[SCALE].to_numpy(), shown, moves)

    def _finer(self, rounds: Rounds, seen: Seen, resolution: float) -> tuple[Seen, bool]:
        """Run the gaps below the first exceedance; also return whether this was not interrupted."""
        tried = set[tuple[int, float]]()
        for number in range(1, MOST_ROUNDS + 1):
            # where a middle has no verdict the gap stays
            wanted = sorted({*seen.middles(resolution)} - tried)
            if not wanted:
                break
            tried |= set(wanted)
            try:
                runs, shown, whole = self._at(rounds, f"finer {number:02d}", wanted)
            except KeyboardInterrupt:  # between the runs of two rounds
                return seen, False
            seen = seen.joined(wanted, shown, _moves(runs).to_numpy())
            if not whole:
                return seen, False
        return seen, True

    def _at(self, rounds: Rounds, part: str, wanted: Wanted) -> tuple[xr.Dataset, Array, bool]:
        """Run each line at its own scale.

        Give runs, verdicts over verdicts and cases, and whether this was not interrupted.
        """
        lines, scales = (np.array(each) for each in zip(*wanted, strict=True))
        names = list(self.motions)
        rows, motions = np.divmod(lines, len(names))
        cases = {**self._heads(rows), SCALE: scales, MOTION: [names[k] for k in motions]}
        runs, whole = rounds.sweep(part, cases, {}, further=True)
        return runs, self.verdicts(runs).transpose(VERDICT, CASE).to_numpy(), whole

    def _heads(self, rows: Any) -> dict[str, Any]:
        columns = self.columns.items()
        return {head(name, unit): values[rows] for name, (values, unit) in columns}


def _moves(runs: xr.Dataset) -> xr.DataArray:
    """Return in which runs a base lifted or slid, also one of a lower body."""
    moves = runs["first_uplift_time"].notnull() | (runs["impact_count"] > 0)
    moves |= runs["overturned"] == 1
    for slip in (runs[name] for name in PEAK_SLIPS if name in runs):
        moves |= ~(slip.max([dim for dim in slip.dims if dim not in moves.dims]) == 0.0)
    return moves


def read_resolution(value: object, *, owner: str) -> float:
    """Read the relative width of gaps below a capacity."""
    return to_ratio(value, owner=owner, name="resolution", condition=_RESOLUTION, example="0.02")


def read_rising(value: object, measure: Measure, name: str, *, owner: str) -> Array:
    """Read values above zero, sorted, equal ones once."""
    values = np.unique(numbers_of(value, measure, name))
    if not len(values) or values[0] <= 0.0:
        msg = f"{owner}: {name} must be above zero, got {short_repr(value)}"
        raise ComponentError(msg)
    return values


def read_scales(value: object, *, owner: str) -> Array:
    """Read the scales of a scan."""
    values = np.unique(numbers_of(value, TARGETS[SCALE].measure, SCALE))
    if not 2 <= len(values) <= _MOST_SCALES or values[0] <= 0.0:
        wanted = f"2 to {_MOST_SCALES} different numbers above zero"
        msg = f"{owner}: scale needs {wanted}, got {short_repr(value)}"
        raise ComponentError(msg)
    return values


def read_width(value: object, *, owner: str) -> float:
    """Read the relative width of brackets."""
    return to_ratio(value, owner=owner, name="bracket_width", condition=_WIDTH, example="0.001")
