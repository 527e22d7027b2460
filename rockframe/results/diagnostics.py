"""Diagnostics: functions of the state that users register as further outputs of runs."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, Final

import numpy as np

from rockframe.errors import SchemaError
from rockframe.results.schema import SCHEMA
from rockframe.results.variables.variable import TIME, Variable
from rockframe.signals.arrays import AnyArray, Array
from rockframe.suggestions import suggests_names
from rockframe.units import Unit

State = Mapping[str, AnyArray]
"""Arrays over instants, by their names in the schema, in SI units."""


@suggests_names
@dataclass(frozen=True)
class Diagnostic:
    """A function of the state, which any scene can give as an output, by its name.

    Parameters
    ----------
    function : callable
        Takes a mapping of arrays by their names in results, in SI units, and returns an array
        of as many numbers. The mapping has ``time``, the response (``rotation``,
        ``angular_velocity``, ``horizontal_displacement``, ...), accelerations, reactions,
        ``friction_demand``, ``ground_acceleration`` and ``vertical_ground_acceleration``, and
        all further columns of the scene for the block, the highest body of a stack. Each number
        returned must depend only on the numbers at its own instant: instants are those of the
        histories, or others at which the peak is sought.
    name : str
        Its name among the outputs and in results.
    unit : str
        Unit of the numbers returned; ``"1"`` for a ratio.
    long_name : str
        Its meaning, in words.

    Examples
    --------
    >>> import numpy as np
    >>> import rockframe as rf
    >>> roof = rf.extension.Diagnostic(
    ...     lambda state: state["horizontal_displacement"] + 2.0 * np.sin(state["rotation"]),
    ...     "lean_of_roof",
    ...     "m",
    ...     "how far the middle of the roof moves to the right",
    ... )
    >>> state = {
    ...     "time": np.zeros(1),
    ...     "rotation": np.zeros(1),
    ...     "horizontal_displacement": np.ones(1),
    ... }
    >>> roof.of(state)
    array([1.])
    """

    function: Callable[[State], Any]
    name: str
    unit: Unit | str
    long_name: str

    @property
    def rows(self) -> tuple[Variable, Variable]:
        """Its history and its peak, as rows of the schema."""
        return (
            Variable(self.name, TIME, self.unit, self.long_name),
            Variable(
                f"peak_{self.name}",
                (),
                self.unit,
                f"largest absolute value up to overturning: {self.long_name}",
            ),
        )

    def of(self, state: State) -> Array:
        """Return its values at some instants.

        Parameters
        ----------
        state : mapping of str to ndarray, shape (instants,)
            Arrays by their names in results, in SI units.

        Returns
        -------
        ndarray, shape (instants,)

        Raises
        ------
        SchemaError
            The function does not return one number for each instant.
        """
        values = np.array(self.function(read_only(state)), dtype=np.float64)
        if values.shape != state["time"].shape:
            msg = (
                f"the diagnostic {self.name!r} gave an array of shape {values.shape}, for "
                f"{len(state['time'])} instants"
            )
            raise SchemaError(msg)
        return values


def read_only(values: Mapping[str, Any]) -> dict[str, Any]:
    """Return arrays as the functions of users see them, who cannot change those of the run."""
    views = {name: np.asarray(value).view() for name, value in values.items()}
    for view in views.values():
        view.flags.writeable = False
    return views


DIAGNOSTICS: Final[dict[str, Diagnostic]] = {}
"""Diagnostics that users have registered, by their names."""


def add_diagnostic(diagnostic: Diagnostic) -> None:
    """Add a diagnostic to the schema; it replaces another one of its name."""
    DIAGNOSTICS[diagnostic.name] = diagnostic
    SCHEMA.update({row.name: row for row in diagnostic.rows})
