"""Cases that other studies have run, by which a study is extended or several are combined."""

import json
from collections.abc import Iterable, Mapping
from functools import cache
from pathlib import Path
from typing import Any, Final

import numpy as np

from rockframe.errors import StudyError
from rockframe.results.variables.studies import MOTION
from rockframe.signals.arrays import AnyArray
from rockframe.studies.sweeps.axes import Chunk
from rockframe.studies.sweeps.chunk import CaseResults, CollectedResults
from rockframe.studies.sweeps.identity import difference
from rockframe.studies.sweeps.scenes import SystemScene
from rockframe.studies.sweeps.store import Store
from rockframe.studies.sweeps.study import Study

_MAY_DIFFER: Final = ("grid", "motions")
"""Fields in which studies may differ when one takes cases of the other."""
_NOT_RUN: Final = -1


class KnownCases:
    """The cases of a study that others have run; if several have a case, the first is used."""

    def __init__(self, study: Study, folders: Iterable[Path]) -> None:
        self._grid = study.grid
        self._sources = [_Source(study, folder) for folder in folders]

    def missing_cases(self, chunk: Chunk) -> AnyArray:
        """Return the numbers of the cases of a chunk that have not been run."""
        if not self._sources:
            return np.asarray(chunk.cases)
        source, _ = self._locate(chunk)
        return np.asarray(chunk.cases)[source == _NOT_RUN]

    def merge(self, chunk: Chunk, run: CaseResults | None) -> CaseResults:
        """Return the results of a chunk: those just run, and those known from others."""
        if run is not None and len(run.status) == len(chunk.cases):
            return run
        source, number = self._locate(chunk)
        merged = CollectedResults(len(chunk.cases))
        if run is not None:
            merged.put_rows(source == _NOT_RUN, run)
        for k, known in enumerate(self._sources):
            of_chunk = number // known.stored.chunk
            for old in np.unique(of_chunk[source == k]).tolist():
                here = (source == k) & (of_chunk == old)
                rows = known.stored.get(known.stored.chunk_at(old))
                merged.put_rows(here, rows, number[here] - old * known.stored.chunk)
        return merged.rows()

    def _locate(self, chunk: Chunk) -> tuple[AnyArray, AnyArray]:
        """Return which source has each case of a chunk, and the number of the case there."""
        places = self._grid.indices(chunk.cases)
        source = np.full(len(chunk.cases), _NOT_RUN)
        number = np.zeros(len(chunk.cases), dtype=np.int64)
        for k, known in reversed([*enumerate(self._sources)]):
            numbers = known.numbers(places)
            source[numbers != _NOT_RUN] = k
            number[numbers != _NOT_RUN] = numbers[numbers != _NOT_RUN]
        return source, number


class _Source:
    """A study that has cases, and where they are in it."""

    def __init__(self, study: Study, folder: Path) -> None:
        self.stored = Store.open(folder)
        # as it was when first asked, though another job may go on with the study: cases are chosen
        # and merged alike
        self._has = cache(self.stored.has)
        description = self.stored.description()
        requested = json.loads(json.dumps(study.to_dict()))
        names = difference(description, requested)
        differs = [name for name in names if name.partition(" ")[0] not in _MAY_DIFFER]
        if differs:
            msg = (
                f"known: {folder} holds a study that differs in {', '.join(differs)}; expected one "
                "that differs in motions and in values along its axes alone"
            )
            raise StudyError(msg)
        self._grid = self.stored.labels().grid
        grids = self._grid, study.grid
        tables = any(grid.columns or grid.motion_column is not None for grid in grids)
        if tables or not isinstance(study.scene, SystemScene):
            msg = (
                f"known: from {folder} cases can be taken where both studies are grids of one "
                "system; cases of a function or a table cannot be recognised"
            )
            raise StudyError(msg)
        kinds = [{axis.name: axis.to_dict() for axis in grid.axes} for grid in grids]
        if kinds[0] != kinds[1]:
            msg = (
                f"known: {folder} holds a study over {', '.join(kinds[0])}; expected the axes "
                f"{', '.join(kinds[1])}"
            )
            raise StudyError(msg)
        values, stored = (  # of the axes, and digests of the motions
            {MOTION: [digest for _, digest in described["motions"]],
             **{axis.name: axis.values.tolist() for axis in grid.axes}}
            for described, grid in ((requested, study.grid), (description, self._grid))
        )  # fmt: skip
        self._positions = {dim: _positions(values[dim], stored[dim]) for dim in values}

    def numbers(self, places: Mapping[str, AnyArray]) -> AnyArray:
        """Return the numbers that cases have here, by their places in the other study."""
        positions = [self._positions[dim][places[dim]] for dim in self._grid.order]
        numbers = np.ravel_multi_index(
            [np.maximum(position, 0) for position in positions], self._grid.shape
        )
        numbers[np.any(np.array(positions) == _NOT_RUN, axis=0)] = _NOT_RUN
        for old in np.unique(numbers[numbers != _NOT_RUN] // self.stored.chunk).tolist():
            if not self._has(self.stored.chunk_at(old)):  # not yet run
                numbers[numbers // self.stored.chunk == old] = _NOT_RUN
        return numbers


def _positions(values: list[Any], stored: list[Any]) -> AnyArray:
    """Return the positions of values among others."""
    place = {value: k for k, value in enumerate(stored)}
    return np.array([place.get(value, _NOT_RUN) for value in values])
