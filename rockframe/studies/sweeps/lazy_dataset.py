"""A kept study as a dataset that reads from the chunks only the values that are used."""

from collections.abc import Mapping
from functools import lru_cache
from importlib.util import find_spec
from typing import Any, Final, TypeAlias

import numpy as np
import xarray as xr
from xarray.backends import BackendArray
from xarray.core import indexing

from rockframe.results.joining import CASE_COUNT
from rockframe.results.schema import SCHEMA
from rockframe.results.variables.runs import RunStatus
from rockframe.results.variables.studies import MESSAGE
from rockframe.signals.arrays import AnyArray
from rockframe.simulation.run import NONE
from rockframe.studies.sweeps.axes import Chunk, Grid
from rockframe.studies.sweeps.chunk import CaseResults
from rockframe.studies.sweeps.labelling import (
    dataset_without_results,
    scalar_names,
    with_coordinates,
)
from rockframe.studies.sweeps.store import Store

_STATUS: Final = "status"
_CACHED_CHUNKS: Final = 8
"""Chunks that stay in memory, as variables of the same cases are often used together."""
_BLOCK_SIZE: Final = 1_000_000
"""Numbers of a block of dask, or those of a chunk where these are more."""
_Key: TypeAlias = tuple[Any, ...]
"""For each dimension a whole number, a slice, or a sequence of whole numbers."""


def lazy_dataset(stored: Store) -> xr.Dataset:
    """Return the content of a folder as a dataset, of dask or not, that is read when it is used."""
    labels = stored.labels()
    grid, over = labels.grid, tuple(labels.grid.sizes)
    shapes, done = stored.contents()
    points = (len(labels.points),)
    extra_shapes = {name: points if SCHEMA[name].dims else () for name in scalar_names(labels)}
    extra_shapes |= {name: shape for name, shape in shapes.items() if name in SCHEMA}

    def variable(name: str, kind: str, shape: tuple[int, ...]) -> xr.Variable:
        row = SCHEMA[name]
        data = indexing.LazilyIndexedArray(_Column(stored, grid, name, kind, shape))
        # gaps are unknown until chunks are read: all variables but texts and status may have some
        attributes = row.attributes("float64" if kind == "f8" else None)
        return xr.Variable((*over, *row.dims), data, attributes)

    columns = {
        name: variable(name, "f8", extra_shapes[name]) for name in SCHEMA if name in extra_shapes
    }
    attributes = {CASE_COUNT: grid.count, **labels.attributes}
    dataset = dataset_without_results(labels, attributes).assign(columns)
    dataset = dataset.assign({_STATUS: variable(_STATUS, "i1", ())})
    dataset = with_coordinates(dataset, labels, variable(MESSAGE, "O", ()))
    lengths = block_lengths(grid, max(_BLOCK_SIZE, stored.chunk))
    if find_spec("dask") is not None:
        dataset = dataset.chunk(lengths, token=f"{stored.digest} {done}")
    dataset[_STATUS].encoding["preferred_chunks"] = lengths
    return dataset


def block_lengths(grid: Grid, most: int) -> dict[str, int]:
    """Return the lengths of blocks of cases that follow one another in the order of running."""
    lengths: dict[str, int] = {}
    for dim in reversed(grid.order):
        lengths[dim] = max(1, min(grid.sizes[dim], most))
        most = most // grid.sizes[dim]
    return lengths


class _Column(BackendArray):
    """A variable over the cases of a study."""

    def __init__(
        self, stored: Store, grid: Grid, name: str, kind: str, beside: tuple[int, ...]
    ) -> None:
        self._stored, self._grid, self._name, self._beside = stored, grid, name, beside
        self.shape = (*grid.sizes.values(), *beside)
        self.dtype = np.dtype(kind)

    def __getitem__(self, key: indexing.ExplicitIndexer) -> Any:
        """Read the requested values."""
        support = indexing.IndexingSupport.OUTER
        return indexing.explicit_indexing_adapter(key, self.shape, support, self._select)

    def _select(self, key: _Key) -> AnyArray:
        dims = len(self._grid.sizes)
        numbers = self._grid.case_numbers(key[:dims])
        values = self._read_cases(numbers.ravel()).reshape((*numbers.shape, *self._beside))
        for axis, index in reversed([*enumerate(key[dims:], start=numbers.ndim)]):
            values = values[(*[slice(None)] * axis, index)]
        return values

    def _read_cases(self, numbers: AnyArray) -> AnyArray:
        """Read cases by their numbers in the order of running."""
        fill = _FILL_VALUES.get(self._name, np.nan)
        column = np.full((len(numbers), *self._beside), fill, self.dtype)
        of_chunk = numbers // self._stored.chunk
        order = np.argsort(of_chunk, kind="stable")
        used, firsts = np.unique(of_chunk[order], return_index=True)
        if not all(self._stored.has(self._stored.chunk_at(number)) for number in used.tolist()):
            self._stored.check_folder()  # not yet run, unless the folder has been moved
        for number, places in zip(used.tolist(), np.split(order, firsts)[1:], strict=True):
            chunk = self._stored.chunk_at(number)
            if self._stored.has(chunk):
                values = _values(_rows(self._stored, chunk), self._name)
                if values is not None:
                    beside = map(slice, values.shape[1:])
                    column[(places, *beside)] = values[numbers[places] - chunk.cases.start]
        return column


_FILL_VALUES: Final[Mapping[str, Any]] = {_STATUS: RunStatus.NOT_RUN, MESSAGE: NONE}
"""Values of cases that have not been run; NaN for other variables."""


@lru_cache(maxsize=_CACHED_CHUNKS)
def _rows(stored: Store, chunk: Chunk) -> CaseResults:
    return stored.get(chunk)


def _values(rows: CaseResults, name: str) -> AnyArray | None:
    if name == _STATUS:
        return rows.status
    if name == MESSAGE:
        return np.array(rows.texts, dtype=object)[rows.message]
    return rows.scalars.get(name, rows.histories.get(name))
