"""The table of a suite: metadata of each motion, and selection by them."""

import math
from collections.abc import Callable, Collection, Mapping
from typing import Any, Final, cast

import numpy as np

from rockframe.arguments import checked_function
from rockframe.errors import ComponentError, did_you_mean, short_repr
from rockframe.motion import GroundMotion
from rockframe.results.schema import SCHEMA
from rockframe.results.variables.motions import RECORDS
from rockframe.units import Measure, Unit, to_ratio, to_si

_COMPUTED: Final = ("time_step", "duration", "sample_count", "peak_ground_acceleration")
COLUMNS: Final = (*(row.name for row in RECORDS), "peak_ground_acceleration")
"""Columns that have a row in the schema, in order."""


def column_value(name: str, motion: GroundMotion) -> Any:
    """Return the metadata of a motion."""
    if name in _COMPUTED:
        return _computed(name, motion)
    value = motion.metadata.get(name)
    if name == "azimuth" and isinstance(value, int | float):
        return math.radians(value)
    row = SCHEMA.get(name) if name in COLUMNS else None
    if row is not None and value is not None:
        return str(value) if row.dtype == "str" else _as_number(value)
    return value


def known_columns(motions: Mapping[str, GroundMotion]) -> dict[str, np.ndarray]:
    """Return the columns of the schema for which some motion has a value."""
    columns: dict[str, np.ndarray] = {}
    for name in COLUMNS:
        values = [column_value(name, motion) for motion in motions.values()]
        if all(value is None for value in values):
            continue
        kind = SCHEMA[name].dtype
        missing: Any = "" if kind == "str" else math.nan
        columns[name] = np.array([missing if value is None else value for value in values])
    return columns


def other_columns(motions: Mapping[str, GroundMotion]) -> dict[str, list[Any]]:
    """Return other metadata of the files, by their keys, None where a motion has none."""
    keys = dict.fromkeys(key for motion in motions.values() for key in motion.metadata)
    return {
        key: [motion.metadata.get(key) for motion in motions.values()]
        for key in keys
        if key not in COLUMNS
    }


def _computed(name: str, motion: GroundMotion) -> float | int:
    si = motion.si
    if name == "sample_count":
        return len(motion)
    return {"time_step": si.time_step, "duration": si.duration}.get(name, si.peak)


def _as_number(value: object) -> float | None:
    try:
        return float(str(value))
    except ValueError:
        return None


_OWNER: Final = "MotionSuite.select"
_EXAMPLES: Final = {
    Unit.METRE: ("a length", "20 km"),
    Unit.SECOND: ("a time", "0.01 s"),
    Unit.HERTZ: ("a cyclic frequency", "0.1 Hz"),
    Unit.RADIAN: ("an angle", "90 deg"),
    Unit.METRE_PER_SECOND: ("a velocity", "760 m/s"),
    Unit.METRE_PER_SECOND_SQUARED: ("an acceleration", "0.1 g_0"),
}

Test = Callable[[Any], bool]


def matching_labels(
    motions: Mapping[str, GroundMotion], criteria: Mapping[str, object]
) -> list[str]:
    """Return the labels of the motions that meet all criteria."""
    for name in criteria:
        check_column(motions, name, owner=_OWNER)
    tests = {name: _criterion(name, criterion) for name, criterion in criteria.items()}
    return [
        label
        for label, motion in motions.items()
        if all(_passes(test, column_value(name, motion)) for name, test in tests.items())
    ]


def check_column(motions: Mapping[str, GroundMotion], name: object, *, owner: str) -> None:
    """Refuse a column for which no motion has a value."""
    known = dict.fromkeys(
        [*COLUMNS, *(key for motion in motions.values() for key in motion.metadata)]
    )
    if not isinstance(name, str) or name not in known:
        requested = f"{short_repr(name)}{did_you_mean(name, known)}"
        msg = f"{owner}: there is no column {requested}; known are {', '.join(known)}"
        raise ComponentError(msg)


def sorted_labels(motions: Mapping[str, GroundMotion], name: str, *, descending: bool) -> list[str]:
    """Return the labels in the order of a column; motions without a value come last."""
    values = {label: column_value(name, motion) for label, motion in motions.items()}
    with_value = [label for label, value in values.items() if not is_missing(value)]
    as_text = any(isinstance(values[label], str) for label in with_value)
    with_value.sort(
        key=lambda label: str(values[label]) if as_text else values[label], reverse=descending
    )
    return [*with_value, *(label for label in values if label not in set(with_value))]


def _passes(test: Test, value: Any) -> bool:
    return not is_missing(value) and bool(test(value))


def is_missing(value: Any) -> bool:
    """Whether a column has no value for a motion."""
    return value is None or value == "" or (isinstance(value, float) and math.isnan(value))


def _criterion(name: str, argument: Any) -> Test:
    if callable(argument):
        return checked_function(argument, "value", owner=_OWNER, name=name)
    if isinstance(argument, tuple):
        bounds = cast("tuple[Any, ...]", argument)
        if len(bounds) != 2:
            msg = f"{_OWNER}: {name} needs a range of two values, got {short_repr(argument)}"
            raise ComponentError(msg)
        low, high = (None if bound is None else _read_value(name, bound) for bound in bounds)

        def is_within(value: Any) -> bool:
            try:
                return (low is None or low <= value) and (high is None or value <= high)
            except TypeError as problem:
                kind = "words" if isinstance(value, str) else "numbers"
                msg = (
                    f"{_OWNER}: {name} needs a range of {kind}, as of {short_repr(value)}, got "
                    f"{short_repr(argument)}"
                )
                raise ComponentError(msg) from problem

        return is_within
    if isinstance(argument, Collection) and not isinstance(argument, str):
        accepted = [_read_value(name, value) for value in cast("Collection[Any]", argument)]
        return lambda value: _comparison_key(value) in map(_comparison_key, accepted)
    wanted = _read_value(name, argument)
    return lambda value: _comparison_key(value) == _comparison_key(wanted)


def _read_value(name: str, value: Any) -> Any:
    row = SCHEMA.get(name) if name in COLUMNS else None
    if row is None or row.dtype == "str":
        return value
    if row.unit in _EXAMPLES:
        words, example = _EXAMPLES[Unit(str(row.unit))]
        return to_si(value, Measure(words, Unit(str(row.unit)), example), owner=_OWNER, name=name)
    return to_ratio(value, owner=_OWNER, name=name, example="6")


def _comparison_key(value: Any) -> Any:
    if isinstance(value, str):
        return value.strip().casefold()
    if isinstance(value, int | float):
        return float(f"{float(value):.12g}")  # without the rounding of a change of unit
    return value
