"""Verdicts followed along the scale of the motion: brackets of their changes, halved in rounds."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import numpy as np
import xarray as xr

from rockframe.errors import (
    ComponentError,
    ModelWarning,
    SolverWarning,
    StudyError,
    heard,
    shown,
    warn,
)
from rockframe.motion import GroundMotion
from rockframe.results.outcome import Generic
from rockframe.results.variables.studies import CASE, MOTION
from rockframe.signals.arrays import Array
from rockframe.studies.limit_states import interrupted
from rockframe.studies.sweeps.arguments import ExecutionArguments, SweepArguments
from rockframe.studies.sweeps.axes import numbers_of
from rockframe.studies.sweeps.execution import ProgressBar, bar_of
from rockframe.studies.sweeps.motions import TARGETS
from rockframe.studies.sweeps.planning import plan_study
from rockframe.studies.sweeps.running import run_study
from rockframe.units import Condition, Unit, to_ratio

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


SCALE: Final = "scale"
_SCAN: Final = "scan"
INTERRUPTED: Final = "; interrupted."
"""Ends the verdict of an analysis whose brackets are wider than asked."""
_WIDTH: Final = Condition("from 1e-12 to 0.1", lambda value: 1e-12 <= value <= 0.1)

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

    def followed(
        self, scales: Array, verdicts: LabelledVerdicts, *, width: float
    ) -> tuple[xr.Dataset, list[Bracket]]:
        """Run all rows and motions at all scales, and narrow every change of a verdict.

        One bar counts the cases of the scan and of all rounds. After an interrupt (Ctrl-C) the
        verdict of the scan says so.
        """
        store = read_store(self.run.get("store"), owner=self.owner)
        with bar_of(self.run.get("progress"), owner=self.owner) as bar:
            runner = _Runner(self, store, bar)
            scan = runner.scan(scales)
            found, whole = runner.narrowed(scan, verdicts, width)
        if not whole:
            scan.attrs["verdict"] = f"{str(scan.attrs['verdict']).removesuffix('.')}{INTERRUPTED}"
            kept = "; the same call goes on, as it has a store" if store is not None else ""
            warn(f"{self.owner}: interrupted; brackets are wider than asked{kept}", SolverWarning)
        return scan, found


@dataclass(frozen=True, eq=False)
class _Runner:
    """Makes the sweeps of an analysis, one after the other."""

    lines: Lines
    store: Path | None
    bar: ProgressBar

    def scan(self, scales: Array) -> xr.Dataset:
        """Run all rows and motions at all scales."""
        heads = self._heads(slice(None))
        return self._sweep(_SCAN, heads or None, {SCALE: scales})

    def narrowed(
        self, scan: xr.Dataset, verdicts: LabelledVerdicts, width: float
    ) -> tuple[list[Bracket], bool]:
        """Narrow every change of a verdict between two scales of the scan; tell if all are."""
        names = list(self.lines.motions)
        order = (VERDICT, *([CASE] if self.lines.columns else []), MOTION, SCALE)
        shown = verdicts(scan).transpose(*order).to_numpy()
        shown = shown.reshape(len(shown), -1, shown.shape[-1])
        found = brackets_of(scan[SCALE].to_numpy(), shown)
        if interrupted(scan):
            return found, False

        def middles(number: int, lines: Generic, scales: Array) -> xr.Dataset:
            rows, motions = np.divmod(lines, len(names))
            cases = {**self._heads(rows), SCALE: scales, MOTION: [names[k] for k in motions]}
            return self._sweep(f"round {number:02d}", cases, {})

        def seen(runs: xr.Dataset) -> Array:
            return verdicts(runs).transpose(VERDICT, CASE).to_numpy()

        with heard() as said:
            narrow, whole = narrowed(found, middles, seen, width=width)
        if said and whole:
            warn(f"while brackets were narrowed: {said[0]}", ModelWarning)
        return narrow, whole

    def _heads(self, rows: Any) -> dict[str, Any]:
        columns = self.lines.columns.items()
        return {head(name, unit): values[rows] for name, (values, unit) in columns}

    def _sweep(self, part: str, cases: Any, axes: Mapping[str, Any]) -> xr.Dataset:
        asked: dict[str, Any] = {**self.lines.run}
        means: Any = {name: asked.pop(name, None) for name in ExecutionArguments.__annotations__}
        del means["progress"]
        means["store"] = None if self.store is None else self.store / part
        study = plan_study(self.lines.scene, self.lines.motions, axes, cases, **asked)
        self.bar.name(part)
        return run_study(study, self.bar, **means)


def read_scales(given: object, *, owner: str, most: int) -> Array:
    """Read the scales of a scan."""
    values = np.unique(numbers_of(given, TARGETS[SCALE].measure, SCALE))
    if not 2 <= len(values) <= most or values[0] <= 0.0:
        msg = f"{owner}: scale needs 2 to {most} different numbers above zero, got {shown(given)}"
        raise ComponentError(msg)
    return values


def read_width(given: object, *, owner: str) -> float:
    """Read the relative width of brackets."""
    return to_ratio(given, owner=owner, name="width", condition=_WIDTH, example="0.001")


def read_store(given: object, *, owner: str) -> Path | None:
    """Read the folder of an analysis, and make it."""
    if given is None:
        return None
    if not isinstance(given, str | PathLike):
        msg = f"{owner}: store must be the path of a folder, got {shown(given)}"
        raise StudyError(msg)
    folder = Path(given)  # pyright: ignore[reportUnknownArgumentType]
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as problem:
        msg = f"{owner}: store {str(folder)!r} cannot be made: {problem}"
        raise StudyError(msg) from problem
    return folder


def head(name: str, unit: str) -> str:
    """Give the head of a column in a table of cases."""
    return name if unit == Unit.ONE else f"{name} [{unit}]"
