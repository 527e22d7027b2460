"""Sweeps that follow one another in one analysis: a bar over all of them, a folder for each."""

from collections.abc import Callable, Generator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import xarray as xr

from rockframe.errors import StudyError
from rockframe.motion import GroundMotion
from rockframe.studies.sweeps.arguments import ExecutionArguments
from rockframe.studies.sweeps.execution import ProgressBar, bar_of
from rockframe.studies.sweeps.planning import plan_study
from rockframe.studies.sweeps.running import folder_of, run_study

if TYPE_CHECKING:
    from rockframe.simulation.system import System


@dataclass(frozen=True, eq=False)
class Rounds:
    """What is the same in all sweeps of an analysis."""

    scene: "System | Callable[..., System]"  # as for :func:`rockframe.sweep`
    motions: Mapping[str, GroundMotion] | None
    run: Mapping[str, Any]  # arguments of each sweep, and who makes the runs
    store: Path | None
    bar: ProgressBar

    def sweep(self, part: str, cases: Any, axes: Mapping[str, Any], **more: Any) -> xr.Dataset:
        """Run the cases of a part, which names a folder and stands on the bar."""
        asked = {**self.run, **more}
        means: Any = {name: asked.pop(name, None) for name in ExecutionArguments.__annotations__}
        del means["progress"]
        means["store"] = None if self.store is None else self.store / part
        study = plan_study(self.scene, self.motions, axes, cases, **asked)
        self.bar.name(part)
        return run_study(study, self.bar, **means)


@contextmanager
def rounds_of(
    scene: "System | Callable[..., System]",
    motions: Mapping[str, GroundMotion] | None,
    run: Mapping[str, Any],
    *,
    owner: str,
) -> Generator[Rounds]:
    """Read the store and the bar of an analysis, which closes when it ends."""
    store = _store(run.get("store"), owner)
    with bar_of(run.get("progress"), owner=owner) as bar:
        yield Rounds(scene, motions, run, store, bar)


def _store(given: object, owner: str) -> Path | None:
    """Read the folder of an analysis, and make it."""
    if given is None:
        return None
    folder = folder_of(given, owner=owner)
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as problem:
        msg = f"{owner}: store {str(folder)!r} cannot be made: {problem}"
        raise StudyError(msg) from problem
    return folder
