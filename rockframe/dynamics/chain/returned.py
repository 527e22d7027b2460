"""Workspace at the end of a system's array, in which its equations return their values.

First slopes, then guards and their rates, then columns.
"""

from collections.abc import Callable
from typing import Any

import numpy as np

from rockframe.compiled import Vector, inlined, view_of
from rockframe.dynamics.protocol import POWERS


class ReturnedArrays:
    """Access to this workspace. A mixin of systems with an array."""

    __slots__ = ()
    rows: Vector
    # methods of the system
    coordinates: Callable[[], int]
    variables: Callable[[], int]
    guards: Callable[[], int]
    columns: Callable[[], int]
    returned_start: Callable[[], int]  # index at which this workspace begins

    @inlined
    def slopes(self) -> Vector:
        """Return the workspace for accelerations, rates of variables, and powers."""
        count = self.coordinates() + self.variables() + POWERS
        return view_of(self.rows, self.returned_start(), count)

    @inlined
    def slopes_end(self) -> int:
        """Return the index behind the workspace for slopes."""
        return self.returned_start() + self.coordinates() + self.variables() + POWERS

    @inlined
    def guard_workspace(self, which: int) -> Vector:
        """Return the workspace for guards (0) or their rates (1)."""
        return view_of(self.rows, self.slopes_end() + which * self.guards(), self.guards())

    @inlined
    def column_workspace(self) -> Vector:
        """Return the workspace for columns."""
        return view_of(self.rows, self.slopes_end() + 2 * self.guards(), self.columns())


def with_workspace(system: Any) -> Any:
    """Return a system with its workspace, added as zeros to what its array holds so far."""
    length = system.slopes_end() + 2 * system.guards() + system.columns()
    missing = np.zeros(length - len(system.rows))
    return system._replace(rows=np.concatenate([system.rows, missing]))
