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
from rockframe.results.outcome import PEAK_SLIPS
from rockframe.results.table import head
from rockframe.results.variables.studies import CASE, MOTION
from rockframe.signals.arrays import AnyArray, Array
from rockframe.simulation.system import System
from rockframe.studies.sweeps.arguments import ExecutionArguments, SweepArguments
from rockframe.studies.sweeps.axes import read_numbers
from rockframe.studies.sweeps.execution import ProgressBar, progress_bar
from rockframe.studies.sweeps.motions import MOTION_AXES, SCALE
from rockframe.studies.sweeps.planning import plan_study
from rockframe.studies.sweeps.study import cache_study
from rockframe.studies.sweeps.sweep import read_folder, run_study
from rockframe.units import Condition, Measure, to_ratio
from rockframe.version import __version__

VERDICT_DIM: Final = "number of the verdict"
"""Dimension of verdicts along lines; no axis can have such a name."""
CAPACITY_DEFINITION: Final = "least scale found to exceed"
"""Definition of a capacity, for the attributes of datasets."""
SCAN_SOURCE: Final = f"rockframe {__version__}, scan and bisection of event-driven runs"
"""Source of the numbers of such analyses, for the attributes of datasets."""
INTERRUPTED_ENDING: Final = "; interrupted."
"""Ends the verdict of an analysis whose brackets are wider than requested."""
MAX_ROUNDS: Final = 60
"""Most rounds of halving, whatever the width: by then neighbouring floats are reached."""
_WIDTH: Final = Condition("from 1e-12 to 0.1", lambda value: 1e-12 <= value <= 0.1)
_RESOLUTION: Final = Condition("from 1e-4 to 1", lambda value: 1e-4 <= value <= 1.0)
_MAX_SCALES: Final = 100_000


@dataclass(frozen=True, eq=False)
class SweepRounds:
    """What all sweeps of an analysis, made one after the other, have in common."""

    scene: System | Callable[..., System]  # as for :func:`rockframe.sweep`
    motions: Mapping[str, GroundMotion] | None
    options: Mapping[str, Any]  # arguments of each sweep, and who makes the runs
    store: Path | None
    bar: ProgressBar

    @property
    def advice(self) -> str:
        """What the message about an interrupt says of the store, if there is one."""
        return "; the same call continues, as it has a store" if self.store else ""

    def sweep(
        self,
        part: str,
        cases: Any,
        axes: Mapping[str, Any],
        *,
        follow_up: bool = False,
        **options: Any,
    ) -> tuple[xr.Dataset, bool]:
        """Run the cases of a part, whose name is used for its folder and on the bar.

        Also return whether this was completed. Parts after the first are not recorded for
        :func:`rockframe.case`, as no result has them.
        """
        arguments = {**self.options, **options}
        execution: Any = {
            name: arguments.pop(name, None) for name in ExecutionArguments.__annotations__
        }
        del execution["progress"]
        execution["store"] = None if self.store is None else self.store / part
        study = plan_study(self.scene, self.motions, axes, cases, **arguments)
        if not follow_up:
            cache_study(study)
        self.bar.name(part)
        return run_study(study, self.bar, **execution)


@contextmanager
def sweep_rounds(
    scene: System | Callable[..., System],
    motions: Mapping[str, GroundMotion] | None,
    options: Mapping[str, Any],
    *,
    owner: str,
) -> Generator[SweepRounds]:
    """Make the folder of an analysis, if it has one, and its bar, which closes when it ends."""
    value = options.get("store")
    folder = None if value is None else read_folder(value, owner=owner)
    try:
        if folder is not None:
            folder.mkdir(parents=True, exist_ok=True)
    except OSError as problem:
        msg = f"{owner}: store {str(folder)!r} cannot be made: {problem}"
        raise StudyError(msg) from problem
    with progress_bar(options.get("progress"), owner=owner) as bar:
        yield SweepRounds(scene, motions, options, folder, bar)


LineScales = list[tuple[int, float]]
"""Numbers of lines, each with a scale at which it is to be run."""


@dataclass(frozen=True, order=True)
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

    def is_wide(self, width: float) -> bool:
        """Whether it is wider than a share of its upper scale."""
        return self.above - self.below > width * self.above

    def halves(self, verdict: float) -> Iterator["Bracket"]:
        """Return the part that remains by the verdict of its middle; both parts by a third one."""
        if verdict != self.before:
            yield replace(self, above=self.middle, after=verdict)
        if verdict != self.after:
            yield replace(self, below=self.middle, before=verdict)


def find_brackets(scales: Array, verdicts: Array) -> list[Bracket]:
    """Find all changes among verdicts."""
    brackets: list[Bracket] = []
    for verdict, line in np.ndindex(verdicts.shape[:2]):
        along = verdicts[verdict, line]
        (known,) = np.nonzero(~np.isnan(along))
        for k in np.flatnonzero(np.diff(along[known]) != 0.0):
            ends = known[k : k + 2]
            brackets.append(Bracket(verdict, line, *scales[ends].tolist(), *along[ends].tolist()))
    return brackets


def bisect_brackets(
    brackets: Sequence[Bracket],
    run_at: Callable[[str, LineScales], tuple[Array, bool]],
    *,
    width: float,
) -> tuple[list[Bracket], bool]:
    """Halve brackets in named rounds until they are narrow; also return whether all were made."""
    done: list[Bracket] = []
    remaining = list(brackets)
    completed = True
    for number in range(1, MAX_ROUNDS + 1):
        wide = [bracket for bracket in remaining if bracket.is_wide(width)]
        done += [bracket for bracket in remaining if not bracket.is_wide(width)]
        remaining = []
        if not wide:
            break
        # brackets of several verdicts may have the same middle
        requested = sorted({(bracket.line, bracket.middle) for bracket in wide})
        try:
            verdicts, completed = run_at(f"round {number:02d}", requested)
        except KeyboardInterrupt:  # between the runs of two rounds
            done, completed = [*done, *wide], False
            break
        position = {case: k for k, case in enumerate(requested)}
        for bracket in wide:
            verdict = float(verdicts[bracket.verdict, position[bracket.line, bracket.middle]])
            if np.isnan(verdict):
                done.append(bracket)
            else:
                remaining += bracket.halves(verdict)
        if not completed:
            break
    return sorted([*done, *remaining]), completed


def bracket_arrays(
    brackets: Sequence[Bracket], shape: tuple[int, int]
) -> tuple[Array, Array, Array, Array]:
    """Arrange brackets in arrays: lower and upper scales, and the verdicts there."""
    rows: dict[tuple[int, int], list[Bracket]] = {}
    for bracket in brackets:
        rows.setdefault((bracket.verdict, bracket.line), []).append(bracket)
    values = np.full((4, *shape, max(map(len, rows.values()), default=0)), np.nan)
    for place, several in rows.items():
        numbers = [(one.below, one.above, one.before, one.after) for one in several]
        values[(slice(None), *place, slice(len(several)))] = np.transpose(numbers)
    below, above, before, after = values
    return below, above, before, after


@dataclass(frozen=True, eq=False)
class LineVerdicts:
    """Verdicts of all lines at the scales that were run."""

    scales: Array  # all scales that were run along some line
    verdicts: Array  # over verdicts, lines and scales; NaN where a line was not run, or has none
    moved: AnyArray  # over lines and scales: whether the base left the ground, or slid

    def with_runs(self, cases: LineScales, verdicts: Array, moved: AnyArray) -> "LineVerdicts":
        """Add cases, and what they showed."""
        lines, scales = (np.array(values) for values in zip(*cases, strict=True))
        all_scales = np.union1d(self.scales, scales)
        all_verdicts = np.full((*self.verdicts.shape[:2], len(all_scales)), np.nan)
        all_moved = np.ones(all_verdicts.shape[1:], dtype=bool)
        old, new = np.searchsorted(all_scales, self.scales), np.searchsorted(all_scales, scales)
        all_verdicts[..., old], all_moved[:, old] = self.verdicts, self.moved
        all_verdicts[:, lines, new], all_moved[lines, new] = verdicts, moved
        return LineVerdicts(all_scales, all_verdicts, all_moved)

    def gaps(self, verdict: int, line: int) -> tuple[Array, Array]:
        """Return the intervals between runs, up to the one that ends at the first exceedance."""
        along = self.verdicts[verdict, line]
        (known,) = np.nonzero(~np.isnan(along))
        (exceeding,) = np.nonzero(along[known] == 1.0)
        known = known[: exceeding[0] + 1] if len(exceeding) else known
        near, far = known[:-1], known[1:]
        counted = self.moved[line, far]  # where nothing moves, nothing moves at lesser scales
        return self.scales[near[counted]], self.scales[far[counted]]

    def gap_midpoints(self, resolution: float) -> LineScales:
        """Return lines and the middles of their gaps that are wider than the resolution."""
        midpoints = set[tuple[int, float]]()
        for verdict, line in np.ndindex(self.verdicts.shape[:2]):
            near, far = self.gaps(verdict, line)
            middle = 0.5 * (near + far)
            midpoints |= {(line, scale) for scale in middle[far - near > resolution * far].tolist()}
        return sorted(midpoints)

    @property
    def resolution(self) -> Array:
        """The widest gap below each first exceedance, over its upper end; verdicts, lines [1]."""
        widest = np.zeros(self.verdicts.shape[:2])
        for place in np.ndindex(widest.shape):
            near, far = self.gaps(*place)
            along = self.verdicts[place]
            along = along[~np.isnan(along)]
            to_zero = not len(along) or along[0] == 1.0  # the least scale exceeds already
            widest[place] = 1.0 if to_zero else np.max((far - near) / far, initial=0.0)
        return widest

    @property
    def first_exceedance(self) -> Array:
        """The least scale that exceeds; infinite if none does, NaN without any verdict."""
        least = np.where(self.verdicts == 1.0, self.scales, np.inf).min(axis=-1)
        return np.where(np.isnan(self.verdicts).all(axis=-1), np.nan, least)


@dataclass(frozen=True, eq=False)
class LineResults:
    """Result of an analysis along lines."""

    scan: xr.Dataset  # the runs at the scales of the first row
    verdicts: LineVerdicts  # verdicts of these runs and of those in their gaps
    brackets: list[Bracket]

    def capacities(self, shape: tuple[int, ...]) -> dict[str, Array]:
        """Return variables of capacities in a dataset, over verdicts and lines in some shape."""
        _, above, _, after = self.arrays(shape)
        rising = np.where(after == 1.0, above, np.inf).min(axis=-1, initial=np.inf)
        return {
            "capacity_scale": np.minimum(rising, self.verdicts.first_exceedance.reshape(shape)),
            "capacity_resolution": self.verdicts.resolution.reshape(shape),
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
        every = bracket_arrays(self.brackets, self.verdicts.verdicts.shape[:2])
        return (array.reshape((*shape, -1)) for array in every)


@dataclass(frozen=True, eq=False)
class LineScan:
    """Scene, motions and rows of the lines, and how their runs are made."""

    scene: System | Callable[..., System]  # as for :func:`rockframe.sweep`
    motions: Mapping[str, GroundMotion]  # all of them
    # further values, and their unit, for each row of a table; if there are none, there is one row
    columns: Mapping[str, tuple[Array, str]]
    # how all of it is run. The scan and each round have a folder of their own in its store
    options: SweepArguments
    owner: str  # the calling public function, for messages
    # gives the verdicts of runs over ``verdict`` and their dimensions: whole numbers as floats, NaN
    # where there is none
    verdicts: Callable[[xr.Dataset], xr.DataArray]

    def run_scan(
        self, scales: Array, *, width: float, resolution: float | None = None, **histories: Any
    ) -> LineResults:
        """Run all rows and motions at all scales, and narrow every change of a verdict.

        With a resolution the intervals below the first exceedance are made narrower than that
        before. Only the runs of the scan have `histories`.
        """
        with sweep_rounds(self.scene, self.motions, self.options, owner=self.owner) as rounds:
            columns = table_of(self.columns)
            scan, completed = rounds.sweep("scan", columns or None, {SCALE: scales}, **histories)

            def run_at(part: str, requested: LineScales) -> tuple[Array, bool]:
                return self._run_at(rounds, part, requested)[1:]

            with collected_warnings() as messages:
                verdicts = self._scan_verdicts(scan)
                if completed and resolution is not None:
                    verdicts, completed = self._refine_gaps(rounds, verdicts, resolution)
                brackets = find_brackets(verdicts.scales, verdicts.verdicts)
                if completed:
                    brackets, completed = bisect_brackets(brackets, run_at, width=width)
        if messages and completed:
            warn(f"{self.owner}: in further rounds: {messages[0]}", ModelWarning)
        if not completed:
            text = str(scan.attrs["verdict"]).removesuffix(".")
            scan.attrs["verdict"] = f"{text}{INTERRUPTED_ENDING}"
            msg = f"{self.owner}: interrupted; brackets are wider than requested{rounds.advice}"
            warn(msg, SolverWarning)
        return LineResults(scan, verdicts, brackets)

    def _scan_verdicts(self, runs: xr.Dataset) -> LineVerdicts:
        """Return the verdicts of the scan."""
        order = ([CASE] if self.columns else []) + [MOTION, SCALE]
        verdicts = self.verdicts(runs).transpose(VERDICT_DIM, *order).to_numpy()
        verdicts = verdicts.reshape(len(verdicts), -1, verdicts.shape[-1])
        moved = _has_moved(runs).transpose(*order).to_numpy().reshape(verdicts.shape[1:])
        return LineVerdicts(runs[SCALE].to_numpy(), verdicts, moved)

    def _refine_gaps(
        self, rounds: SweepRounds, verdicts: LineVerdicts, resolution: float
    ) -> tuple[LineVerdicts, bool]:
        """Run the gaps below the first exceedance; also return whether this was completed."""
        tried = set[tuple[int, float]]()
        for number in range(1, MAX_ROUNDS + 1):
            # where a middle has no verdict the gap stays
            requested = sorted({*verdicts.gap_midpoints(resolution)} - tried)
            if not requested:
                break
            tried |= set(requested)
            try:
                runs, shown, completed = self._run_at(rounds, f"finer {number:02d}", requested)
            except KeyboardInterrupt:  # between the runs of two rounds
                return verdicts, False
            verdicts = verdicts.with_runs(requested, shown, _has_moved(runs).to_numpy())
            if not completed:
                return verdicts, False
        return verdicts, True

    def _run_at(
        self, rounds: SweepRounds, part: str, requested: LineScales
    ) -> tuple[xr.Dataset, Array, bool]:
        """Run lines at their own scales; give runs, verdicts, and whether this was completed."""
        lines, scales = (np.array(values) for values in zip(*requested, strict=True))
        names = list(self.motions)
        rows, motions = np.divmod(lines, len(names))
        columns = table_of(self.columns, rows)
        cases = {**columns, SCALE: scales, MOTION: [names[k] for k in motions]}
        runs, completed = rounds.sweep(part, cases, {}, follow_up=True)
        return runs, self.verdicts(runs).transpose(VERDICT_DIM, CASE).to_numpy(), completed


def table_of(
    columns: Mapping[str, tuple[Array, str]], rows: AnyArray | slice = slice(None)
) -> dict[str, Any]:
    """Return a table of cases, or some of its rows, from columns and their units."""
    return {head(name, unit): values[rows] for name, (values, unit) in columns.items()}


def _has_moved(runs: xr.Dataset) -> xr.DataArray:
    """Return in which runs a base lifted or slid, also one of a lower body."""
    moved = runs["first_uplift_time"].notnull() | (runs["impact_count"] > 0)
    moved |= runs["overturned"] == 1
    for slip in (runs[name] for name in PEAK_SLIPS if name in runs):
        moved |= ~(slip.max([dim for dim in slip.dims if dim not in moved.dims]) == 0.0)
    return moved


def read_resolution(value: object, *, owner: str) -> float:
    """Read the relative width of gaps below a capacity."""
    return to_ratio(value, owner=owner, name="resolution", condition=_RESOLUTION, example="0.02")


def read_sorted(value: object, measure: Measure, name: str, *, owner: str) -> Array:
    """Read values above zero, sorted, equal ones once."""
    values = np.unique(read_numbers(value, measure, name, owner=owner))
    if not len(values) or values[0] <= 0.0:
        msg = f"{owner}: {name} must be above zero, got {short_repr(value)}"
        raise ComponentError(msg)
    return values


def read_scales(value: object, *, owner: str) -> Array:
    """Read the scales of a scan."""
    values = np.unique(read_numbers(value, MOTION_AXES[SCALE].measure, SCALE, owner=owner))
    if not 2 <= len(values) <= _MAX_SCALES or values[0] <= 0.0:
        expected = f"2 to {_MAX_SCALES} different numbers above zero"
        msg = f"{owner}: scale needs {expected}, got {short_repr(value)}"
        raise ComponentError(msg)
    return values


def read_width(value: object, *, owner: str) -> float:
    """Read the relative width of brackets."""
    return to_ratio(value, owner=owner, name="bracket_width", condition=_WIDTH, example="0.001")
