"""What a file states of its peak, its length and its end, held against its data.

None of this decides how a file is read. What disagrees is warned about: the unit, the
time step or the samples may be another record's than the header's.
"""

from __future__ import annotations

import math
import re
from typing import TYPE_CHECKING, Final

import numpy as np

from rockframe.records.numbers import NUMBER
from rockframe.records.unit_names import acceleration_unit

if TYPE_CHECKING:
    from rockframe.records.source import Source
    from rockframe.records.unit_names import RecordUnit
    from rockframe.signals.arrays import Array

PEAK_SHARE: Final = 0.015
"""Stated peaks differ from the samples' by 1.1 % at most in 275 channels as published."""
LENGTH_SHARE: Final = 0.01
"""Stated lengths are those of the samples to this share, or to two time steps."""

_ONE_NUMBER: Final = re.compile(NUMBER, re.ASCII)
_NUMBERS_ONLY: Final = re.compile(r"[-+.\dEeDd\s]*\d[-+.\dEeDd\s]*", re.ASCII)
_LONGEST: Final = 30
_MOST_LINES: Final = 200


def compare_peak(
    source: Source,
    samples: Array,
    unit: RecordUnit,
    *,
    printed: str,
    printed_unit: str,
    line: int,
    share: float = PEAK_SHARE,
) -> list[str]:
    """Hold the peak that a header states against the samples."""
    said, digit = _printed(printed)
    stated_unit = acceleration_unit(printed_unit)
    if said is None or stated_unit is None or math.isclose(said, 0.0):
        return []
    with np.errstate(over="ignore"):
        peak = float(np.max(np.abs(samples))) * (unit.factor / stated_unit.factor)
    if abs(peak - abs(said)) <= share * abs(said) + digit:
        return []
    return [
        f"{source.path}, line {line}: the header states a peak of {abs(said):g} {printed_unit}, "
        f"but the samples have {peak:.6g} {printed_unit}"
    ]


def compare_length(
    source: Source, count: int, time_step: float, *, printed: str, line: int
) -> list[str]:
    """Hold the length that a header states against the number of samples and the time step.

    Some agencies state ``n dt``, others ``(n - 1) dt``.
    """
    said, digit = _printed(printed)
    if said is None or said <= 0.0:
        return []
    length = count * time_step
    if abs(length - said) <= max(2.0 * time_step, LENGTH_SHARE * said) + digit:
        return []
    return [
        f"{source.path}, line {line}: the header states a length of {said:g} s, but "
        f"{count} samples at {time_step:g} s last {length - time_step:.6g} s"
    ]


def surplus(source: Source, index: int, what: str) -> list[str]:
    """Look for rows of numbers behind the last sample that a header announces."""
    rows = 0
    for line in source.lines[index : index + _MOST_LINES]:
        if not line.strip():
            continue
        if _NUMBERS_ONLY.fullmatch(line[:_LONGEST]) is None:
            break
        rows += 1
    if not rows:
        return []
    many = f"{rows} or more rows" if rows >= _MOST_LINES - 1 else f"{rows} row{'s' * (rows > 1)}"
    return [
        f"{source.path}, line {index + 1}: {many} of numbers behind the last sample that is "
        f"announced in {what}; they are not read"
    ]


def _printed(text: str) -> tuple[float | None, float]:
    """Give a number and half of its last printed digit."""
    text = text.strip()
    if len(text) > _LONGEST or _ONE_NUMBER.fullmatch(text) is None:
        return None, 0.0
    mantissa, _, exponent = text.upper().replace("D", "E").partition("E")
    value = float(f"{mantissa}E{exponent or 0}")
    decimals = len(mantissa.partition(".")[2])
    digit = float(f"0.51E{int(exponent or 0) - decimals}")
    return (value if math.isfinite(value) else None), digit
