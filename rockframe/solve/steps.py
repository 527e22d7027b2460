"""The steps of a run as they were made, and the solution inside them."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Final, cast

import numpy as np

from rockframe.compiled import Integers, Matrix, Vector
from rockframe.dynamics.protocol import ContactModel
from rockframe.solve.hermite import cubic, quintic
from rockframe.solve.workspace import BESIDE, CODES, StepTable

_quintic: Final = cast("Callable[..., tuple[Matrix, ...]]", quintic)  # of arrays too
_cubic: Final = cast("Callable[..., tuple[Matrix, ...]]", cubic)


@dataclass(frozen=True)
class Steps:
    """Ends of steps, each the start of the next; and starts of those that begin anew."""

    # rows of :class:`rockframe.solve.workspace.StepTable`, without a start at their end
    values: Matrix
    codes: Integers  # the same
    width: int  # numbers in a state
    # whether slopes are those of the equations at the states; of fixed steps they are near
    exact: bool

    @property
    def time(self) -> Vector:
        """Time of each row [s]."""
        return self.values[:, 0]

    @property
    def length(self) -> Vector:
        """Length of the step that ends there; 0 in the row of a start [s]."""
        return self.values[:, 1]

    @property
    def mode(self) -> Integers:
        """Mode of the model."""
        return self.codes[:, 0]

    @property
    def memory_row(self) -> Integers:
        """Number of events before, by which the model's memory is found."""
        return self.codes[:, 1]

    @property
    def ground(self) -> Matrix:
        """Ground acceleration as the equations take it, shape (rows, 2) [m s^-2]."""
        return self.values[:, 2:BESIDE]

    @property
    def state(self) -> Matrix:
        """State, shape (rows, 2 n + variables)."""
        return self.values[:, BESIDE : BESIDE + self.width]

    @property
    def slope(self) -> Matrix:
        """Accelerations, and rates of variables of first order, shape (rows, n + variables)."""
        return self.values[:, BESIDE + self.width :]

    def until(self, time: float) -> "Steps":
        """Give the steps that end up to a time [s]."""
        count = int(np.searchsorted(self.time, time, side="right"))
        if count and self.length[count - 1] == 0.0:  # no step goes on from there
            count -= 1
        return replace(self, values=self.values[:count], codes=self.codes[:count])

    def inside(self, which: Integers, model: ContactModel, fraction: Vector) -> Matrix:
        """Give states inside steps by their dense solution, :eq:`eq-hermite`."""
        size, u = model.system.coordinates(), fraction[:, None]
        h = self.length[which, None, None]
        state, new, first, last = (
            each[row, None] for each in (self.state, self.slope) for row in (which - 1, which)
        )
        x, v, w = (slice(0, size), slice(size, 2 * size), slice(2 * size, None))
        rates = slice(size, None)
        c0, c1, c2, c3, c4, c5 = _quintic(
            state[..., x], h * state[..., v], h * h * first[..., x],
            new[..., x], h * new[..., v], h * h * last[..., x],
        )  # fmt: skip
        place = c0 + u * (c1 + u * (c2 + u * (c3 + u * (c4 + u * c5))))
        speed = (c1 + u * (2.0 * c2 + u * (3.0 * c3 + u * (4.0 * c4 + u * 5.0 * c5)))) / h
        value, _ = _cubic(
            state[..., w], h * first[..., rates], new[..., w], h * last[..., rates], u
        )
        moves = np.arange(size) < model.moving(self.mode[which])[:, None, None]
        place = np.where(moves, place, state[..., x])
        return np.concatenate([place, np.where(moves, speed, state[..., v]), value], axis=-1)


def steps_of(table: StepTable, count: int, width: int, *, exact: bool) -> Steps:
    """Give the kept steps, whose states have `width` numbers."""
    codes = table.codes.reshape(-1, CODES)
    values = table.values.reshape(len(codes), -1)
    return Steps(values[:count], codes[:count], width, exact).until(np.inf)
