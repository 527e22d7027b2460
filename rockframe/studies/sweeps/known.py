"""Cases that other studies have run, by which a study is extended or several are combined."""

import json
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any, Final

import numpy as np

from rockframe.errors import StudyError
from rockframe.results.outcome import Generic
from rockframe.results.variables.studies import MOTION
from rockframe.studies.sweeps.axes import Chunk
from rockframe.studies.sweeps.chunk import CaseResults, CollectedResults
from rockframe.studies.sweeps.identity import difference
from rockframe.studies.sweeps.scenes import SystemScene
from rockframe.studies.sweeps.store import Store
from rockframe.studies.sweeps.study import Study

_OWN: Final = ("grid", "motions")
"""Fields in which studies may differ when one takes cases of the other."""
_NOBODY: Final = -1


class KnownCases:
    """The cases of a study that others have run; if several have a case, the first is used."""

    def __init__(self, study: Study, folders: Iterable[Path]) -> None:
        self._grid = study.grid
        self._sources = [_Source(study, folder) for folder in folders]

    def lacking(self, chunk: Chunk) -> Generic:
        """Return the numbers of the cases of a chunk that nobody has run."""
        if not self._sources:
            return np.asarray(chunk.cases)
        source, _ = self._found(chunk)
        return np.asarray(chunk.cases)[source == _NOBODY]

    def filled(self, chunk: Chunk, run: CaseResults | None) -> CaseResults:
        """Return the results of a chunk: those just run, and those known from others."""
        if run is not None and len(run.status) == len(chunk.cases):
            return run
        source, number = self._found(chunk)
        whole = CollectedResults(len(chunk.cases))
        if run is not None:
            whole.put_rows(source == _NOBODY, run)
        for k, one in enumerate(self._sources):
            of_chunk = number // one.kept.chunk
            for old in np.unique(of_chunk[source == k]).tolist():
                here = (source == k) & (of_chunk == old)
                rows = one.kept.get(one.kept.chunk_at(old))
                whole.put_rows(here, rows, number[here] - old * one.kept.chunk)
        return whole.rows()

    def _found(self, chunk: Chunk) -> tuple[Generic, Generic]:
        """Return who has each case of a chunk, and its number there."""
        places = self._grid.places(chunk.cases)
        source = np.full(len(chunk.cases), _NOBODY)
        number = np.zeros(len(chunk.cases), dtype=np.int64)
        for k, one in reversed([*enumerate(self._sources)]):
            there = one.numbers(places)
            source[there != _NOBODY] = k
            number[there != _NOBODY] = there[there != _NOBODY]
        return source, number


class _Source:
    """A study that has cases, and where they are in it."""

    def __init__(self, study: Study, folder: Path) -> None:
        self.kept = Store.at(folder)
        description = self.kept.described()
        own = json.loads(json.dumps(study.to_dict()))
        differs = difference(
            *({k: v for k, v in d.items() if k not in _OWN} for d in (description, own))
        )
        if differs:
            msg = (
                f"known: {folder} holds a study that differs in {', '.join(differs)}; expected one "
                "that differs in motions and in values along its axes alone"
            )
            raise StudyError(msg)
        self._grid = self.kept.labels().grid
        grids = self._grid, study.grid
        tables = any(grid.columns or grid.motion_column is not None for grid in grids)
        if tables or not isinstance(study.scene, SystemScene):
            msg = (
                f"known: from {folder} cases can be taken where both studies are grids of one "
                "system: of a function or a table nothing tells which cases are the same"
            )
            raise StudyError(msg)
        kinds = [{axis.name: axis.to_dict() for axis in grid.axes} for grid in grids]
        if kinds[0] != kinds[1]:
            msg = (
                f"known: {folder} holds a study over {', '.join(kinds[0])}; expected the axes "
                f"{', '.join(kinds[1])}"
            )
            raise StudyError(msg)
        digests = [[digest for _, digest in each["motions"]] for each in (description, own)]
        self._places = {MOTION: _places(digests[1], digests[0])}
        there = {axis.name: axis.values.tolist() for axis in self._grid.axes}
        for axis in study.grid.axes:
            self._places[axis.name] = _places(axis.values.tolist(), there[axis.name])

    def numbers(self, places: Mapping[str, Generic]) -> Generic:
        """Return the numbers that cases have here, by their places in the other study."""
        each = [self._places[dim][places[dim]] for dim in self._grid.order]
        found = np.ravel_multi_index([np.maximum(one, 0) for one in each], self._grid.shape)
        found[np.any(np.array(each) == _NOBODY, axis=0)] = _NOBODY
        for old in np.unique(found[found != _NOBODY] // self.kept.chunk).tolist():
            if not self.kept.has(self.kept.chunk_at(old)):  # not yet run
                found[found // self.kept.chunk == old] = _NOBODY
        return found


def _places(wanted: list[Any], there: list[Any]) -> Generic:
    """Return the positions of values among others."""
    place = {one: k for k, one in enumerate(there)}
    return np.array([place.get(one, _NOBODY) for one in wanted])
