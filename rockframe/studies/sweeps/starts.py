"""Axes that change where the runs start."""

from collections.abc import Mapping
from typing import Final

from rockframe.components import InitialState
from rockframe.studies.sweeps.axes import Axis, Changes, numbers_of

STARTS: Final = {
    f"initial_{name}": (name, one.measure)
    for name, one in InitialState.declared().items()
    if one.measure is not None
}
"""Axes by their names: which parameter of an initial state each changes, and its kind."""


def of_start(name: str, given: object) -> Axis:
    """Read an axis that changes the initial state."""
    parameter, measure = STARTS[name]
    values = numbers_of(given, measure, name)
    words = name.replace("_", " ")
    return Axis(name, values, str(measure.unit), words, Changes.START, parameter)


def started(initial: InitialState, values: Mapping[str, float]) -> InitialState:
    """Give an initial state with the values of a case in the place of its own."""
    return initial.with_si(values) if values else initial
