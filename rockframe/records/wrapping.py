"""One record wrapped to several values a line, or several records in columns.

Both look alike where columns have no names. They differ in what follows a number: in a wrapped
record the number to its right, and behind the last of a line the first of the next, all in the
same way; in columns the number below.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Final, Literal

import numpy as np

if TYPE_CHECKING:
    from rockframe.signals.arrays import Array

BY_ROWS: Final = "row by row"
"""What the argument ``component`` takes for a record that is wrapped."""

ROWS: Final = "rows"
COLUMNS: Final = "columns"

_PIECES: Final = 32
_FEWEST_ROWS: Final = 64
"""Pieces of a table of which means are compared; rows below which nothing is said."""

# Of 112 recorded components, each wrapped into 2 to 12 columns, these bounds know 93 %, and take
# none for columns. Of 3170 tables of two to twelve components that were recorded together, some
# on floors of one building, with each sample or each second to twentieth, which is like noise, they
# take none for one record.
_SURE: Final = 5.0  # standard errors
_SMOOTHER: Final = 0.2
_ROUGHER: Final = 0.1
_ALIKE: Final = 0.4
_APART: Final = 0.3
_EQUAL: Final = (0.5, 1.5)


def reading_order(values: Array) -> Literal["rows", "columns"] | None:
    """Tell whether a table is one record, row by row, or one in each column."""
    rows, columns = values.shape
    if rows < _FEWEST_ROWS:
        return None
    flat = values.ravel() - values.mean()
    count = (rows - 1) * columns
    before, after, below = flat[:count], flat[1 : count + 1], flat[columns:]
    steps = ((after - before) ** 2).reshape(-1, columns)
    down = ((below - before) ** 2).reshape(-1, columns).sum(axis=1)
    along = steps.sum(axis=1)
    if not along.any():
        return None
    # each row counts as much as any other: the strong ones are few
    smoothness = _share(down - along, down + along)
    size = (before**2 + after**2).reshape(-1, columns)
    likeness = _share(2.0 * (before * after).reshape(-1, columns), size)
    shares = _share(steps, along[:, None])[along > 0.0].mean(axis=0) * columns
    smoother, sure = _mean(smoothness[:, None])
    alike, certain = _mean(likeness)
    surely = abs(float(sure[0])) > _SURE
    least, most = _EQUAL
    if surely and smoother[0] > _SMOOTHER and alike.min() > _ALIKE and certain.min() > _SURE:
        return ROWS if shares.min() > least and shares.max() < most else None
    if surely and smoother[0] < -_ROUGHER and np.abs(alike).min() < _APART:
        return COLUMNS
    return None


def _share(part: Array, whole: Array) -> Array:
    """Divide, with zero where nothing moves."""
    return np.divide(part, whole, out=np.zeros_like(part), where=whole > 0.0)


def _mean(values: Array) -> tuple[Array, Array]:
    """Give the means of columns, and how many of their standard errors they are from zero."""
    pieces = np.array([piece.mean(axis=0) for piece in np.array_split(values, _PIECES)])
    mean = pieces.mean(axis=0)
    error = pieces.std(axis=0, ddof=1) / np.sqrt(_PIECES)
    return mean, mean / np.maximum(error, np.finfo(np.float64).tiny)
