"""Unknowns of a fit: parameters of the system's parts, and circumstances of the test."""

import math
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from enum import StrEnum
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from rockframe.components import Component, Stack
from rockframe.components.parameters import Ratio
from rockframe.errors import ComponentError, did_you_mean, short_repr
from rockframe.identification.measured import OWNER
from rockframe.simulation.system import System
from rockframe.system.assembly import Assembly, assemble

_OPEN_BOUND_MARGIN: Final = 1e-6
"""Distance of the search from an open lower bound, as a share of an unknown's size."""
_MIN_SCALE: Final = 0.01
"""Size of a ratio whose start value is zero."""


class Circumstance(StrEnum):
    """Quantities of the test itself that may be unknown."""

    INITIAL_ROTATION = "initial_rotation"
    RELEASE_TIME = "release_time"
    GAUGE_OFFSET = "gauge_offset"


@dataclass(frozen=True)
class Unknown:
    """A parameter or circumstance that is to be found."""

    name: str
    start: float  # start value of the search
    scale: float  # typical size, the unit of its steps
    lower: float = -math.inf  # bounds
    upper: float = math.inf

    def with_start(self, value: float) -> "Unknown":
        """Return the unknown with another start value, within the bounds."""
        return replace(self, start=min(max(value, self.lower), self.upper))


def with_starts(unknowns: Sequence[Unknown], values: NDArray[np.float64]) -> list[Unknown]:
    """Return the unknowns with other start values, within their bounds."""
    return [
        unknown.with_start(float(value)) for unknown, value in zip(unknowns, values, strict=True)
    ]


@dataclass(frozen=True)
class PartParameter:
    """A parameter of a part."""

    part: int  # index of the part
    argument: str  # name of the part's argument
    start: float  # its value in the system that was tested
    bounds: tuple[float, float]  # bounds of the values that the part accepts

    def unknown(self, name: str) -> Unknown:
        """Return the parameter as an unknown of a fit."""
        scale = abs(self.start) or _MIN_SCALE
        lower, upper = self.bounds[0] + _OPEN_BOUND_MARGIN * scale, self.bounds[1]
        return Unknown(name, self.start, scale, lower, upper).with_start(self.start)


class TrialSystems:
    """Systems that differ from the tested one in the parameters that are to be found."""

    def __init__(self, system: System, names: Sequence[str]) -> None:
        alone = system.parts.signature == frozenset({"block"})
        self._parts = (system.parts.with_ground() if alone else system.parts).structural()
        self._options: dict[str, Any] = system.options.to_dict()
        self.radius = system.parts.block_si.radius
        self.gravity = system.options.gravity
        known = dict(self._ratios(system))
        inside = {
            f"{type(interface).__name__}.{name}"
            for part in self._parts
            if isinstance(part, Stack)
            for interface in part.interfaces
            for name, _ in _declared_ratios(interface)
        }
        self.parameters = {name: _find_parameter(name, known, inside) for name in names}

    def _ratios(self, system: System) -> Iterator[tuple[str, PartParameter | None]]:
        """Find the dimensionless parameters of all parts; None for one without a start value."""
        usual = {"restitution": system.parts.block_si.maximum_restitution}
        for index, part in enumerate(self._parts):
            for argument, declared in _declared_ratios(part):
                value = part.to_dict().get(argument, usual.get(argument))
                condition = declared.condition
                bounds = (-math.inf, math.inf) if condition is None else condition.bounds
                known = value is not None
                parameter = PartParameter(index, argument, float(value), bounds) if known else None
                yield f"{type(part).__name__}.{argument}", parameter

    def _parts_with(self, values: Mapping[str, float]) -> list[Component]:
        """Return the parts with these values of the parameters."""
        changes: dict[int, dict[str, float]] = {}
        for name, value in values.items():
            parameter = self.parameters[name]
            changes.setdefault(parameter.part, {})[parameter.argument] = value
        return [
            type(part).from_dict({**part.to_dict(), **changes[index]}) if index in changes else part
            for index, part in enumerate(self._parts)
        ]

    def assembly(self, values: Mapping[str, float]) -> Assembly:
        """Assemble a system for a run, without the warnings for users."""
        return assemble(self._parts_with(values), **self._options)

    def system(self, values: Mapping[str, float]) -> System:
        """Return the system with these values of the parameters."""
        return System(*self._parts_with(values), **self._options)


def _declared_ratios(part: Component) -> list[tuple[str, Ratio[Any]]]:
    declared = sorted(part.declared().items())
    return [(name, parameter) for name, parameter in declared if isinstance(parameter, Ratio)]


def _find_parameter(
    name: object, known: Mapping[str, PartParameter | None], inside: Collection[str]
) -> PartParameter:
    matches = [full for full in known if name in (full, full.partition(".")[2])]
    if len(matches) == 1:
        parameter = known[matches[0]]
        if parameter is not None:
            return parameter
        msg = (
            f"{OWNER}: {short_repr(name)} cannot be fitted, since the part was given without it; "
            f"give {matches[0]} as a start value, instead of what stands for it"
        )
        raise ComponentError(msg)
    choice = ", ".join(repr(full) for full in (matches or known))
    if not matches and any(name in (full, full.partition(".")[2]) for full in inside):
        fitted = f"of the parts of the system, which are {choice}" if known else "of other parts"
        msg = (
            f"{OWNER}: {short_repr(name)} is a parameter of an interface of the Stack; fitted are "
            f"those {fitted}. To find that of an interface, compare the measured rotation with "
            "runs of a sweep over a function that returns the system"
        )
        raise ComponentError(msg)
    fault = "several parts have" if matches else "no part of the system has, as a pure ratio,"
    near = "" if matches else did_you_mean(name, {full.rpartition(".")[2] for full in known})
    msg = f"{OWNER}: {fault} the parameter {short_repr(name)}{near}; expected one of {choice}"
    raise ComponentError(msg)
