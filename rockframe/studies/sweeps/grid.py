"""The cases of a sweep: how many there are, in which order they run, and where each one stands."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Final

import numpy as np
from numpy.typing import NDArray

from rockframe.results.outcome import Generic
from rockframe.results.variables.studies import CASE, MOTION
from rockframe.studies.sweeps.axes import Axis, Changes

Places: Final = NDArray[np.intp]
MOST_CASES: Final = 1_000_000_000


@dataclass(frozen=True, eq=False)
class Grid:
    """All combinations of values, or of the rows of a table and further values."""

    axes: tuple[Axis, ...]  # with a dimension each
    columns: tuple[Axis, ...]  # of the table, all of one length
    motions: int  # number of motions
    # number of the motion of each row of the table; else the motions have a dimension
    motion_column: Generic | None = None

    @cached_property
    def sizes(self) -> dict[str, int]:
        """Dimensions of the result, in their order, and their lengths."""
        rows = len(self.columns[0].values) if self.columns else None
        if self.motion_column is not None:
            rows = len(self.motion_column)
        table = {} if rows is None else {CASE: rows}
        own = {axis.name: len(axis.values) for axis in self.axes}
        motions = {MOTION: self.motions} if self.motion_column is None else {}
        return {**table, **own, **motions}

    @property
    def count(self) -> int:
        """Number of cases."""
        return math.prod(self.sizes.values())

    @cached_property
    def order(self) -> tuple[str, ...]:
        """Dimensions in the order in which cases run, the last one varying fastest.

        Neighbours share their motion, and its scale, as long as may be: each is then prepared
        once.
        """
        scales = [axis.name for axis in self.axes if axis.changes is Changes.MOTION]
        others = [axis.name for axis in self.axes if axis.changes is not Changes.MOTION]
        last = [*([CASE] if CASE in self.sizes else []), *others]
        first = [MOTION] if MOTION in self.sizes else []
        return (*first, *scales, *last)

    def places(self, first: int, last: int) -> dict[str, Generic]:
        """Give the places along all dimensions of the cases from `first` to before `last`."""
        shape = [self.sizes[name] for name in self.order]
        found = np.unravel_index(np.arange(first, last), shape)
        return dict(zip(self.order, found, strict=True))

    def number_of(self, place: Mapping[str, int]) -> int:
        """Give the number, in the order of running, of the case at a place."""
        shape = [self.sizes[name] for name in self.order]
        return int(np.ravel_multi_index([place[name] for name in self.order], shape))

    def arranged(self, values: Generic) -> Generic:
        """Bring values from the order of running into that of the dimensions."""
        shape = [self.sizes[name] for name in self.order]
        apart = values.reshape([*shape, *values.shape[1:]])
        moved = [self.order.index(name) for name in self.sizes]
        rest = range(len(shape), apart.ndim)
        return np.ascontiguousarray(apart.transpose([*moved, *rest]))

    def of_cases(self, first: int, last: int) -> tuple[tuple[Axis, Generic], ...]:
        """Give for each axis its values in the cases from `first` to before `last`."""
        places = self.places(first, last)
        own = [(axis, axis.values[places[axis.name]]) for axis in self.axes]
        rows = [(axis, axis.values[places[CASE]]) for axis in self.columns]
        return (*own, *rows)

    def motions_of(self, first: int, last: int) -> Generic:
        """Give the numbers of the motions of the cases from `first` to before `last`."""
        places = self.places(first, last)
        if self.motion_column is not None:
            return self.motion_column[places[CASE]]
        return places[MOTION]


def chunks_of(count: int, size: int) -> Sequence[range]:
    """Cut the cases into chunks of a size; the last may be shorter."""
    return [range(first, min(first + size, count)) for first in range(0, count, size)]
