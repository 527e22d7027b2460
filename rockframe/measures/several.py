"""One motion or several: what is looked at, and labels for the answers."""

from collections.abc import Callable, Iterable, Mapping
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from os import cpu_count
from typing import Any, Final, Generic, TypeVar, cast

import numpy as np
import xarray as xr

from rockframe.compiled import COMPILED
from rockframe.errors import ComponentError
from rockframe.measures.about import REFERENCES, about
from rockframe.measures.component import component_of, signal_of
from rockframe.motion import GroundMotion
from rockframe.results.joining import MOTION
from rockframe.signals import Signal

Thing = TypeVar("Thing")
Answer = TypeVar("Answer")

_LABEL: Final = {"long_name": "ground motion"}


@dataclass(frozen=True)
class Looked(Generic[Thing]):
    """What is looked at: one thing, or several with their labels.

    Parameters
    ----------
    things : list
        Signals, or pairs of motions.
    labels : list of str or None
        Of several; None where it is one.
    attributes : dict
        What the answer says of them.
    """

    things: list[Thing]
    labels: list[str] | None
    attributes: dict[str, str | float | int]

    @property
    def over(self) -> tuple[str, ...]:
        """The dimension of several."""
        return () if self.labels is None else (MOTION,)

    def each(self, function: Callable[[Thing], Answer]) -> list[Answer]:
        """Ask for the answer of each, in threads where compiled code lets them run together."""
        workers = min(cpu_count() or 1, len(self.things))
        if not COMPILED or workers < 2:
            return [function(thing) for thing in self.things]
        first = function(self.things[0])  # compiles, the first time
        with ThreadPoolExecutor(workers) as pool:
            return [first, *pool.map(function, self.things[1:])]

    def together(self, answers: Iterable[Mapping[str, Any]]) -> dict[str, Any]:
        """Put the values of all answers into arrays, or give those of the one."""
        rows = list(answers)
        if self.labels is None:
            return dict(rows[0])
        return {name: np.array([row[name] for row in rows]) for name in rows[0]}

    def labelled(self, dataset: xr.Dataset) -> xr.Dataset:
        """Name several along their dimension."""
        if self.labels is None:
            return dataset
        dataset = dataset.assign_coords({MOTION: (MOTION, self.labels, _LABEL)})
        # a coordinate has no missing values, so it needs no fill value (CF 2.5.1)
        dataset[MOTION].encoding["_FillValue"] = None
        return dataset


def looked_at(given: object, component: object, *, owner: str) -> Looked[Signal]:
    """Take one component of a motion, or of each of several.

    Parameters
    ----------
    given : GroundMotion, or mapping of str to GroundMotion
        The motion, or a suite.
    component : {"horizontal", "vertical"}
        Which acceleration.
    owner : str
        Function, for the message.

    Returns
    -------
    Looked

    Raises
    ------
    ComponentError
        Neither, none at all, not a component, or a motion lacks it.
    """
    if not isinstance(given, Mapping):
        signal = signal_of(given, component, owner=owner)
        which = component_of(component, owner=owner)
        return Looked([signal], None, about(cast("GroundMotion", given), which))
    motions = cast("Mapping[Any, Any]", given)
    check_some(motions, owner=owner)
    signals = [signal_of(motion, component, owner=owner) for motion in motions.values()]
    which = str(component_of(component, owner=owner))
    attributes: dict[str, Any] = {"component": which, "references": REFERENCES}
    return Looked(signals, [str(label) for label in motions], attributes)


def check_some(motions: Mapping[Any, Any], *, owner: str) -> None:
    """Refuse a mapping that is empty."""
    if not motions:
        msg = f"{owner}: found no motions; expected one at least"
        raise ComponentError(msg)
