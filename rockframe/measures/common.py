"""Inputs and outputs of measures: motions and their components, and labels of the results."""

from collections.abc import Callable, Iterable, Mapping
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from os import cpu_count
from typing import Any, Final, Generic, TypeVar, cast

import numpy as np
import xarray as xr

from rockframe.arguments import checked_choice, with_string_keys
from rockframe.compiled import COMPILED
from rockframe.errors import ComponentError, short_repr
from rockframe.motion import GroundMotion
from rockframe.motion.pair import motion_hint
from rockframe.motion.value import GroundComponent
from rockframe.results.joining import MOTION
from rockframe.results.schema import SCHEMA, build_dataset, without_fill_values
from rockframe.signals import Signal
from rockframe.signals.arrays import Array


def signal_of(motion: object, component: object, *, owner: str) -> Signal:
    """Take one component of a motion."""
    if not isinstance(motion, GroundMotion):
        msg = f"{owner}: motion needs a GroundMotion, got {short_repr(motion)}{motion_hint(motion)}"
        raise ComponentError(msg)
    which = checked_choice(GroundComponent, component, owner=owner, name="component")
    if which is GroundComponent.HORIZONTAL:
        return motion.si.horizontal
    if motion.si.vertical is None:
        msg = f"{owner}: component='vertical', but {motion.name!r} has no vertical acceleration"
        raise ComponentError(msg)
    return motion.si.vertical


Input = TypeVar("Input")
Result = TypeVar("Result")

_LABEL: Final = {"long_name": "ground motion"}


@dataclass(frozen=True)
class Inputs(Generic[Input]):
    """Inputs of a measure: one signal or pair, or several with their labels."""

    items: list[Input]  # signals, or pairs of motions
    labels: list[str] | None  # of several; None for a single one
    attributes: dict[str, str | float | int]  # attributes of the result on them

    @property
    def over(self) -> tuple[str, ...]:
        """The dimension of several inputs; none for a single one."""
        return () if self.labels is None else (MOTION,)

    def each(self, function: Callable[[Input], Result]) -> list[Result]:
        """Return the function of each input, computed in threads where compiled code permits."""
        workers = min(cpu_count() or 1, len(self.items))
        if not COMPILED or workers < 2:
            return [function(item) for item in self.items]
        first = function(self.items[0])  # compiles, the first time
        with ThreadPoolExecutor(workers) as pool:
            return [first, *pool.map(function, self.items[1:])]

    def joined(self, results: Iterable[Mapping[str, Any]]) -> dict[str, Any]:
        """Return the values of all results as arrays, or those of the single one."""
        rows = list(results)
        if self.labels is None:
            return dict(rows[0])
        return {name: np.array([row[name] for row in rows]) for name in rows[0]}

    def labelled(self, dataset: xr.Dataset) -> xr.Dataset:
        """Label several inputs along their dimension."""
        if self.labels is None:
            return dataset
        return without_fill_values(dataset.assign_coords({MOTION: (MOTION, self.labels, _LABEL)}))


def read_inputs(value: object, component: object, *, owner: str) -> Inputs[Signal]:
    """Take one component of a motion, or of each of several."""
    if not isinstance(value, Mapping):
        signal = signal_of(value, component, owner=owner)
        return Inputs([signal], None, component_attributes(cast("GroundMotion", value), component))
    motions = by_label(cast("Mapping[Any, Any]", value), owner=owner)
    signals = [signal_of(motion, component, owner=owner) for motion in motions.values()]
    attributes: dict[str, Any] = {"component": str(component), "references": REFERENCES}
    return Inputs(signals, list(motions), attributes)


def by_label(motions: Mapping[Any, Any], *, owner: str) -> dict[str, Any]:
    """Return several motions by their labels as texts, which differ."""
    if not motions:
        msg = f"{owner}: found no motions; expected one at least"
        raise ComponentError(msg)
    return with_string_keys(motions, owner=owner)


OSCILLATOR_REFERENCE: Final = "Nigam and Jennings (1969), Bull. Seism. Soc. Am. 59, 909-922"
"""Reference of spectra."""

REFERENCES: Final = (
    f"{OSCILLATOR_REFERENCE}; Arias (1970), in Seismic Design for Nuclear Power Plants; Rathje et "
    "al. (2004), Earthquake Spectra 20, 119-144"
)
"""References of spectra and intensity measures; all are on the page "Response spectra"."""


def component_attributes(motion: GroundMotion, component: object) -> dict[str, str | float | int]:
    """Describe a motion so that it can be recognised."""
    return {
        "motion": motion.name,
        "motion_sha256": motion.sha256,
        "motion_time_step": motion.si.time_step,
        "motion_samples": len(motion),
        "motion_history": "; ".join(motion.history),
        "component": str(component),
        "references": REFERENCES,
    }


def build_over(
    axes: Mapping[str, tuple[Array, str]],
    values: Mapping[str, Array],
    attributes: Mapping[str, str | float | int],
    *,
    over: tuple[str, ...] = (),
    title: str,
    source: str,
) -> xr.Dataset:
    """Return a labelled dataset of values, with coordinates of their dimensions.

    The axes have the names and units of the schema's rows for a system's modes, where
    these are variables over ``mode``.
    """
    dataset = build_dataset(values, attributes, over=over, title=title, source=source)
    for name, (axis, meaning) in axes.items():
        labels = {**SCHEMA[name].attributes(), "long_name": meaning}
        dataset = dataset.assign_coords({name: (name, axis.copy(), labels)})
    return without_fill_values(dataset)
