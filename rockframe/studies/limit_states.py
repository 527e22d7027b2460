"""Limit states of a rocking body, and which runs exceed them."""

import json
import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any, Final, cast

import numpy as np
import xarray as xr

from rockframe.arguments import checked_dataset, checked_list, json_attribute
from rockframe.errors import ComponentError, SchemaError, did_you_mean, short_repr
from rockframe.results.joining import SWEEP_ATTRIBUTES
from rockframe.results.outcome import check_no_means, overturns
from rockframe.results.schema import SCHEMA, in_units_of_schema, labels_in_unit
from rockframe.results.variables.bodies import BODIES, RESTRAINERS
from rockframe.results.variables.requests import FORCE_SCALARS, POINT_PEAKS
from rockframe.results.variables.variable import TIME, unit_suffix_of
from rockframe.signals.arrays import AnyArray
from rockframe.studies.confidence import SHARE
from rockframe.studies.sweeps.motions import SCALE
from rockframe.units import NOT_NEGATIVE, Condition, Measure, Unit, to_ratio, to_si

UPLIFT: Final = "uplift"
OVERTURNING: Final = "overturning"
LIMITS_ATTRIBUTE: Final = "limits_json"
"""Attribute by which a dynamic analysis keeps its limit states."""
_SAMPLED_SCALARS: Final = {"residual_displacement", *(row.name for row in FORCE_SCALARS)} | {
    row.name for row in (*BODIES, *RESTRAINERS) if row.name.startswith("peak_")
}
"""Scalars of runs that were evaluated along their steps, as runs with histories are."""
_POINT_PEAKS: Final = {row.name for row in POINT_PEAKS}
_PEAKS_UP_TO_OVERTURNING: Final = {
    name for name in (*_SAMPLED_SCALARS, *_POINT_PEAKS) if name.startswith("peak_")
}
"""Scalars that describe a run only up to the overturning angle."""
_NEEDED_VARIABLES: Final = ("status", "peak_relative_rotation", "first_uplift_time", "overturned")
_ROUNDING: Final = 1e-12
"""Relative difference up to which two limits are one, given in different units."""


@dataclass(frozen=True)
class LimitState:
    """A limit state: a scalar of a run, and the value from which on it is exceeded."""

    # peak rotation over the overturning angle: 0 is uplift, 1 overturning; NaN of others [1]
    rotation: float
    variable: str = ""  # the scalar of a run, in limit states other than on the rotation
    # value from which on it exceeds, in its SI unit; NaN where any number exceeds
    value: float = math.nan
    label: str = ""  # point, body or restrainer of the scalar

    @property
    def name(self) -> str:
        """Its label in results."""
        if not self.variable:
            named = {0.0: UPLIFT, 1.0: OVERTURNING}
            return named.get(self.rotation, f"rotation {self.rotation:g}")
        words = [self.variable.replace("_", " "), self.label]
        if not math.isnan(self.value):
            unit = unit_suffix_of(SCHEMA[self.variable].attributes())
            words.append(f"{self.value:g}{unit}")
        return " ".join(filter(None, words))


def limit_states(
    items: Iterable[object], *, owner: str, name: str = "limits"
) -> tuple[LimitState, ...]:
    """Read limit states, each once, in the order in which they are given; overturning is last."""
    states: dict[str, LimitState] = {}
    for limit in listed_limits(items, owner=owner, name=name):
        if isinstance(limit, tuple):
            state = _variable_limit(cast("tuple[Any, ...]", limit), owner)
        elif isinstance(limit, str) and limit in (UPLIFT, OVERTURNING):
            state = LimitState(0.0 if limit == UPLIFT else 1.0)
        else:
            state = LimitState(_rotation_limit(limit, owner, name))
        known = states.setdefault(state.name, state)
        both = (known.rotation, known.value), (state.rotation, state.value)
        if not np.allclose(*both, rtol=_ROUNDING, atol=0.0, equal_nan=True):
            msg = (
                f"{owner}: two limit states are called {state.name!r}; expected values that differ "
                "in their first six digits"
            )
            raise ComponentError(msg)
    states.pop(OVERTURNING, None)
    return (*states.values(), LimitState(1.0))


def listed_limits(value: object, *, owner: str, name: str = "limits") -> list[Any]:
    """Return the given limit states as a list, also a single one."""
    if isinstance(value, str | int | float):
        return [value]
    return checked_list(value, owner=owner, name=name, of="limit states")


def _rotation_limit(value: Any, owner: str, name: str) -> float:
    """Read a rotation over the overturning angle."""
    if isinstance(value, str) and not any(letter.isdigit() for letter in value):
        words = (
            f"{owner}: {name} must be {UPLIFT!r}, {OVERTURNING!r}, a rotation over the overturning "
            "angle such as 0.5, or a variable of runs and a value such as ('peak_slip', '5 cm')"
        )
        msg = f"{words}, got {short_repr(value)}{did_you_mean(value, (UPLIFT, OVERTURNING))}"
        raise ComponentError(msg)
    return to_ratio(value, owner=owner, name=name, condition=SHARE, example="0.5")


def _variable_limit(items: tuple[Any, ...], owner: str) -> LimitState:
    """Read a limit state on a scalar of runs: its name, its limit, and the point or body."""
    name, value, label = (*items, None)[:3] if len(items) in (2, 3) else ("", None, None)
    if isinstance(name, str) and name and name not in SCHEMA:
        scalars = [row.name for row in SCHEMA.values() if TIME[0] not in row.dims]
        near = did_you_mean(name, scalars)
        msg = (
            f"{owner}: limits: no variable of runs is called {name!r}; a limit state is for "
            f"example ('peak_slip', '5 cm'){near}"
        )
        raise ComponentError(msg)
    if not isinstance(name, str) or not name:
        msg = (
            f"{owner}: a limit state on a variable of runs is its name, a value with a unit or "
            "None, and of several points, bodies or restrainers which one, for example "
            f"('peak_slip', '5 cm'); got {short_repr(items)}"
        )
        raise ComponentError(msg)
    row, least = SCHEMA[name], math.nan
    if value is not None:
        unit = str(row.unit or Unit.ONE)
        least = read_in_unit(value, unit, "a limit", owner=owner, name=name, condition=NOT_NEGATIVE)
    return LimitState(math.nan, name, least, "" if label is None else str(label))


def read_in_unit(
    value: Any, unit: str, words: str, *, owner: str, name: str, condition: Condition | None = None
) -> float:
    """Read a number in the unit of a variable; a ratio where this unit is 1."""
    if unit == Unit.ONE:
        return to_ratio(value, owner=owner, name=name, condition=condition, example="0.5")
    measure = Measure(words, Unit(unit), f"1 {unit}")
    return to_si(value, measure, owner=owner, name=name, condition=condition)


def labels_of_states(states: Sequence[LimitState]) -> dict[str, AnyArray]:
    """Return the labels along limit states."""
    return {
        "limit_state": np.array([state.name for state in states], dtype=object),
        "rotation_limit": np.array([state.rotation for state in states]),
    }


def states_json(states: Sequence[LimitState]) -> str:
    """Write limit states as JSON."""
    return json.dumps([list(vars(state).values()) for state in states])


def states_of(analysis: xr.Dataset) -> tuple[LimitState, ...]:
    """Return the limit states that a dynamic analysis, or a part of it, still has."""
    names = np.atleast_1d(analysis["limit_state"].to_numpy()).tolist()

    def read(rows: Iterable[Any]) -> tuple[LimitState, ...]:
        every = {(state := LimitState(*row)).name: state for row in rows}
        return tuple(every[name] for name in every | dict.fromkeys(names) if name in names)

    return json_attribute(analysis, LIMITS_ATTRIBUTE, read, owner="fragility")


def check_runs(value: object, *, owner: str) -> xr.Dataset:
    """Refuse anything but the result of a sweep; give its variables in the units of the schema."""
    runs = checked_dataset(value, owner=owner)
    missing = [name for name in _NEEDED_VARIABLES if name not in runs]
    if missing or not set(SWEEP_ATTRIBUTES) <= set(runs.attrs):
        what = f"a dataset without {', '.join(missing)}" if missing else "joined runs"
        what = what if missing or "end_state" not in runs.attrs else "a single run"
        msg = (
            f"{owner}: found {what}, which is no sweep; expected the result of rf.sweep, with its "
            "attributes"
        )
        raise SchemaError(msg)
    check_no_means(runs, owner=owner)
    if SCALE in runs.coords and "capacity_scale" in runs:  # which is in multiples of the motion
        scales = labels_in_unit(runs[SCALE], Unit.ONE, owner=owner)
        runs = runs.assign_coords(scale=scales.variable)
    return in_units_of_schema(runs, owner=owner)


def exceeds(runs: xr.Dataset, state: LimitState) -> xr.DataArray:
    """Return which runs exceed a limit state."""
    overturned = overturns(runs)
    if state.rotation == 1.0:
        return overturned
    known, certain = runs["peak_relative_rotation"].notnull(), _exceeds_any_value(runs, state)
    if state.variable:
        values = scalar_of(runs, state.variable, state.label, owner="limits")
        beyond = values.notnull()
        if not math.isnan(state.value):
            beyond, known = abs(values) >= state.value, known & beyond
        known = known | certain
    elif state.rotation == 0.0:
        beyond = runs["first_uplift_time"].notnull()
    else:
        beyond = runs["peak_relative_rotation"] >= state.rotation
    return (beyond | certain).astype(float).where(known)


def _exceeds_any_value(runs: xr.Dataset, state: LimitState) -> xr.DataArray:
    """Return which runs exceed a limit state for any value of its variable."""
    # a block that passed the overturning angle and stands in the end has not overturned; but
    # scalars up to the overturning angle say nothing about later motion
    followed = state.variable and state.variable not in _PEAKS_UP_TO_OVERTURNING
    return (overturns(runs) if followed else runs["overturned"]) == 1


def demands(runs: xr.Dataset, state: LimitState) -> xr.DataArray:
    """Return the response over its limit, infinite where the block overturned."""
    exceeded = exceeds(runs, state)
    certain = exceeded if state.rotation == 1.0 else _exceeds_any_value(runs, state)
    if state.variable:
        ratio = abs(scalar_of(runs, state.variable, state.label, owner="limits")) / state.value
    else:
        ratio = runs["peak_relative_rotation"] / state.rotation
    return ratio.where(certain != 1, np.inf).where(exceeded.notnull())


def scalar_of(runs: xr.Dataset, name: str, label: object = None, *, owner: str) -> xr.DataArray:
    """Return a scalar of runs, for one point, body or restrainer if it has several."""
    known = isinstance(cast("Any", name), str)
    if not known or name not in runs or runs[name].dtype.kind not in "biuf":
        hint = _scalar_hint(runs, name) if known else ""
        msg = f"{owner}: the runs have no {short_repr(name)}{hint}"
        raise SchemaError(msg)
    values = runs[name]
    extra_dims = [dim for dim in values.dims if dim not in runs["status"].dims]
    labels = values[extra_dims[0]].to_numpy().astype(str).tolist() if extra_dims else [""]
    requested = "" if label is None else str(label)
    requested = labels[0] if not requested and len(labels) == 1 else requested
    if len(extra_dims) > 1 or requested not in labels:
        msg = (
            f"{owner}: {name} is of {' and '.join(map(str, extra_dims)) or 'the whole'}; "
            f"give one of {', '.join(map(repr, labels))}, got {requested!r}"
        )
        raise ComponentError(msg)
    return values.isel({dim: labels.index(requested) for dim in extra_dims}, drop=True)


def _scalar_hint(runs: xr.Dataset, name: str) -> str:
    """Say which sweep has a scalar; or list the scalars."""
    if name in _POINT_PEAKS:
        return "; a sweep has it with points={...}"
    if name in _SAMPLED_SCALARS:
        return (
            "; a sweep has it with points={...}, which names points of the body, or with "
            "outputs=[], and then the histories of all cases, too"
        )
    numbers = [str(variable) for variable, values in runs.items() if values.dtype.kind in "fiu"]
    near = did_you_mean(name, numbers)
    return f"; they have {', '.join(numbers)}{near}"
