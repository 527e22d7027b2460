"""Checks of plausibility, and comparison of the statements of a header with the samples.

Peak, length and end in a header do not affect the reading of a file. A disagreement causes a
warning: unit, time step or samples may not belong to the header.
"""

import math
import re
from collections.abc import Iterable
from typing import Final, NamedTuple

import numpy as np

from rockframe.constants import STANDARD_GRAVITY
from rockframe.records.numbers import ONE_NUMBER
from rockframe.records.reader import Metadata, Record, Request, Source
from rockframe.records.unit_names import RecordUnit, acceleration_unit
from rockframe.signals.arrays import Array

TIME_STEP_LIMITS: Final = (1e-6, 10.0)
"""Range of time steps; others are refused [s]."""
USUAL_TIME_STEPS: Final = (1e-4, 0.1)
"""Usual range of time steps; others cause a warning [s]."""
USUAL_PEAKS: Final = (1e-4, 1.5)
"""Usual range of peaks; others cause a warning [g].

Few records exceed 1.5 g. A file in m/s^2 that is read in g exceeds it from 0.15 g on.
"""
MIN_OFFSET: Final = 1e-3
"""Offset up to which there is no warning [g]."""
OFFSET_FRACTION: Final = 0.15
"""Offset over the largest distance from it, up to which there is no warning [1]."""

MISSING_VALUES: Final = (
    *(999.0, 9999.0, 99999.0, 999999.0, 12345.0, 32768.0, 1.7e38),
    *(
        float(f"{nines}.{tail}")
        for nines in ("999", "9999", "99999")
        for tail in ("9", "99", "999")
    ),
)
"""Values, of either sign, by which agencies mark missing samples."""

PEAK_TOLERANCE: Final = 0.015
"""Tolerance of stated peaks [1]; in 275 published channels they differ by at most 1.1 %."""
LENGTH_TOLERANCE: Final = 0.01
"""Tolerance of stated lengths [1]; two time steps are admitted in any case."""

NUMBERS_ONLY: Final = re.compile(r"[-+.\dEeDd\s]*\d[-+.\dEeDd\s]*", re.ASCII)
_MAX_TEXT_LENGTH: Final = 30
_MAX_ROWS: Final = 200
_MIN_MATCHING_FRACTION: Final = 0.9
_MIN_MISSING: Final = 5
_ROUNDING: Final = 1e-6
_MIN_SAMPLES_FOR_OFFSET: Final = 50
_ENDS: Final = 10


def check_time_step(source: Source, time_step: float, line: int | None) -> None:
    """Refuse a time step that no record has."""
    low, high = TIME_STEP_LIMITS
    if not (math.isfinite(time_step) and low <= time_step <= high):
        expected = f"a time step between {low:g} s and {high:g} s"
        raise source.refuse(found=f"a time step of {time_step!r} s", expected=expected, line=line)


def check_requested_time_step(
    source: Source, request: Request, time_step: float, line: int | None
) -> None:
    """Refuse a ``time_step=`` argument that the file contradicts."""
    requested = request.time_step
    if requested is not None and not math.isclose(requested, time_step, rel_tol=_ROUNDING):
        raise source.refuse(
            found=f"a time step of {time_step!r} s",
            expected=f"the {requested!r} s given by the argument time_step",
            line=line,
        )


def checked_time_step(source: Source, request: Request, time_step: float, line: int | None) -> None:
    """Refuse a time step that no record has, or that contradicts the argument ``time_step``."""
    check_time_step(source, time_step, line)
    check_requested_time_step(source, request, time_step, line)


def check_missing_values(source: Source, samples: Array) -> None:
    """Refuse samples with marks of missing ones among them."""
    size = np.abs(samples)
    marked = np.isin(size, MISSING_VALUES)
    if not marked.any():
        return
    places = np.flatnonzero(marked)
    unmarked = np.flatnonzero(~marked)
    if unmarked.size:
        after = np.searchsorted(unmarked, places)
        beside = np.maximum(
            size[unmarked[np.maximum(after - 1, 0)]],
            size[unmarked[np.minimum(after, unmarked.size - 1)]],
        )
        places = places[beside < 0.5 * size[places]]
    if places.size:
        first = int(places[0])
        found = (
            f"{samples[first]:.9g} as sample {first + 1}, alone among much smaller ones, "
            f"{places.size} times such a value"
        )
        expected = "samples without marks of missing ones; fill them first, see from_times"
        raise source.refuse(found=found, expected=expected)


def plausibility_warnings(
    source: Source, time_step: float, samples: Array, unit: RecordUnit
) -> list[str]:
    """Return warnings of a peak, an offset or a time step that is not plausible."""
    warnings: list[str] = []
    low, high = USUAL_PEAKS
    with np.errstate(over="ignore"):
        peak = float(np.max(np.abs(samples))) * unit.factor / STANDARD_GRAVITY
    if not low <= peak <= high:
        warnings.append(
            f"{source.path}: the peak acceleration is {peak:.4g} g (usual: {low:g} g to "
            f"{high:g} g); is the unit {unit.spelling} right?"
        )
    offset = _offset(samples)
    with np.errstate(over="ignore"):
        in_g = offset * unit.factor / STANDARD_GRAVITY
    if abs(in_g) > MIN_OFFSET:
        warnings.append(
            f"{source.path}: the samples lie around an offset of {in_g:.4g} g, from the first to "
            "the last; baseline_corrected(order=0) subtracts their mean"
        )
    short, long = USUAL_TIME_STEPS
    if not short <= time_step <= long:
        warnings.append(
            f"{source.path}: the time step is {time_step:.4g} s (usual: {short:g} s to {long:g} s)"
        )
    return warnings


def _offset(samples: Array) -> float:
    # the ground comes to rest, so the mean acceleration is nearly zero, and so are the means
    # before and after the strong motion
    if samples.size < _MIN_SAMPLES_FOR_OFFSET:
        return 0.0
    part = max(samples.size // _ENDS, _MIN_SAMPLES_FOR_OFFSET)
    with np.errstate(over="ignore", invalid="ignore"):
        means = [float(np.mean(piece)) for piece in (samples, samples[:part], samples[-part:])]
        swing = float(np.max(np.abs(samples - means[0])))
    one_sided = min(means) > 0.0 or max(means) < 0.0
    return means[0] if one_sided and min(map(abs, means)) > OFFSET_FRACTION * swing else 0.0


LENGTH: Final = "a length [s]"


class StatedValue(NamedTuple):
    """Peak or length of the samples that a header states."""

    text: str  # the number as printed
    unit: str  # unit of a peak as record files spell it, or `LENGTH`
    line: int  # line number from 1


def _compare_peak(
    source: Source, samples: Array, unit: RecordUnit, stated: StatedValue
) -> list[str]:
    printed, digit = _number_and_rounding(stated.text)
    stated_unit = acceleration_unit(stated.unit)
    if printed is None or stated_unit is None or math.isclose(printed, 0.0):
        return []
    with np.errstate(over="ignore"):
        peak = float(np.max(np.abs(samples))) * (unit.factor / stated_unit.factor)
    if abs(peak - abs(printed)) <= PEAK_TOLERANCE * abs(printed) + digit:
        return []
    return [
        f"{source.path}, line {stated.line}: the header states a peak of {abs(printed):g} "
        f"{stated.unit}, but the samples have {peak:.6g} {stated.unit}"
    ]


def _compare_length(source: Source, count: int, time_step: float, stated: StatedValue) -> list[str]:
    # some agencies state n dt, others (n - 1) dt
    printed, digit = _number_and_rounding(stated.text)
    if printed is None or printed <= 0.0:
        return []
    length = count * time_step
    if abs(length - printed) <= max(2.0 * time_step, LENGTH_TOLERANCE * printed) + digit:
        return []
    return [
        f"{source.path}, line {stated.line}: the header states a length of {printed:g} s, but "
        f"{count} samples at {time_step:g} s last {length - time_step:.6g} s"
    ]


def surplus_rows_warning(
    source: Source, index: int, what: str, end: int | None = None
) -> list[str]:
    """Warn of rows of numbers after the last sample that a header announces.

    The search ends at the first text, or at the line `end`, if nothing else is read before it.
    """
    rows, first = 0, index
    for place, line in enumerate(source.lines[index:end], start=index):
        if rows == _MAX_ROWS:
            break
        if not line.strip():
            continue
        if NUMBERS_ONLY.fullmatch(line[:_MAX_TEXT_LENGTH]) is not None:
            first = place if rows == 0 else first
            rows += 1
        elif end is None:
            break
    if not rows:
        return []
    many = f"{rows} or more rows" if rows == _MAX_ROWS else f"{rows} row{'s' * (rows > 1)}"
    return [
        f"{source.path}, line {first + 1}: {many} of numbers after the last sample that "
        f"{what} announces; they are not read"
    ]


def truncation_warning(source: Source, line: int, rows: int) -> list[str]:
    """Say of a file that it ends among the rows below a line, so that others may be missing."""
    if line + rows <= source.last_line:
        return []
    return [
        f"{source.path}, line {source.last_line}: the file ends inside what line {line} announces; "
        "components may be missing"
    ]


def _number_and_rounding(text: str) -> tuple[float | None, float]:
    """Return a number and half of its last printed digit."""
    text = text.strip()
    if len(text) > _MAX_TEXT_LENGTH or ONE_NUMBER.fullmatch(text) is None:
        return None, 0.0
    mantissa, _, exponent = text.upper().replace("D", "E").partition("E")
    value = float(f"{mantissa}E{exponent or 0}")
    decimals = len(mantissa.partition(".")[2])
    digit = float(f"0.51E{int(exponent or 0) - decimals}")
    return (value if math.isfinite(value) else None), digit


def checked_count(
    source: Source, *, declared: int, counted: int, what: str, line: int
) -> tuple[Metadata, list[str]]:
    """Compare the announced number of samples with the data, which take precedence."""
    missing = declared - counted
    if counted < 2 or missing > max(_MIN_MISSING, (1.0 - _MIN_MATCHING_FRACTION) * declared):
        raise source.refuse(
            found=f"the end of the file after {counted} samples",
            expected=f"{declared} samples ({what} in line {line})",
            line=source.last_line,
        )
    if not missing:
        return {}, []
    words = (
        f"{source.path}, line {line}: {what} declares {declared} samples, but the file "
        f"holds {counted}; the {counted} are used"
    )
    return {"declared_samples": declared, "counted_samples": counted}, [words]


def make_record(
    source: Source,
    values: Array,
    time_step: float,
    chosen: tuple[RecordUnit, str, list[str]],
    metadata: Metadata,
    *,
    count: tuple[int, str, int] | None = None,
    warnings_before: Iterable[str] = (),
    stated: Iterable[StatedValue] = (),
    warnings_after: Iterable[str] = (),
) -> Record:
    """Make a record, after a comparison of the statements of its header with its samples.

    `chosen` is the result of :func:`choose_unit`; `count` is the announced number of samples, the
    name of the field that announces it, and its line; `warnings_before` and `warnings_after` go
    before and after those of `stated` peaks and lengths.
    """
    unit, as_read, warnings = chosen
    counts: Metadata = {}
    if count is not None:
        declared, what, line = count
        counts, differing = checked_count(
            source, declared=declared, counted=values.size, what=what, line=line
        )
        warnings = [*warnings, *differing]
    mismatches: list[str] = []
    for value in stated:
        if value.unit == LENGTH:
            mismatches += _compare_length(source, values.size, time_step, value)
        else:
            mismatches += _compare_peak(source, values, unit, value)
    described: Metadata = {**metadata, "unit_as_read": as_read, **counts}
    return Record(
        time_step,
        values,
        unit,
        described,
        warnings=(*warnings, *warnings_before, *mismatches, *warnings_after),
    )
