"""From a printed column of times to one time step."""

from __future__ import annotations

from datetime import UTC, datetime
from typing import TYPE_CHECKING, Final

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from rockframe.signals.arrays import Array

_EPOCH: Final = datetime(1970, 1, 1, tzinfo=UTC)
_SAME: Final = 0.1 * (1.0 + 1e-6)
"""Time steps that samples of one time may be apart: clocks of digitisers round to 0.1 ms."""

_JITTER: Final = 1e-6
_FLOAT_ULPS: Final = 8.0
_TIES: Final = 1.0 + 1e-6
_COARSEST_DIGIT: Final = 0.5
_ROUNDED_AT_ALL: Final = 0.05
_PLAIN_DIGITS: Final = 4
_SMALLEST: Final = 1e-9
_LARGEST: Final = 1e9
_LONGEST_EXPONENT: Final = 5


def same_start(one: object, other: object, time_step: float) -> bool:
    """Tell whether two samples were taken at the same time."""
    if one is None or other is None or one == other:
        return True
    first, second = epoch_seconds(one), epoch_seconds(other)
    return first is not None and second is not None and abs(second - first) <= _SAME * time_step


def epoch_seconds(time: object) -> float | None:
    """Give the seconds from 1970 to a time in ISO 8601, or None for another one."""
    try:
        moment = datetime.fromisoformat(str(time).strip())
    except ValueError:
        return None
    zoned = moment if moment.tzinfo is not None else moment.replace(tzinfo=UTC)
    return (zoned - _EPOCH).total_seconds()


def uniform_step(times: Array, fields: Sequence[str]) -> tuple[float, int | None]:
    """Find the time step that a column of times was printed from.

    Times t_0 + k dt, each rounded to its last printed digit q, lie within q/2
    of a straight line through the first, or, if that one was rounded too,
    within q of one another. What rounding does not explain must stay below
    1e-6 dt. A missing sample or one wrong last digit is not taken for rounding:
    a last digit of more than dt/2 allows none.
    """
    with np.errstate(over="ignore"):
        rises = np.diff(times)
    beyond = np.flatnonzero(~np.isfinite(rises))
    if beyond.size:
        return float(rises[beyond[0]]), int(beyond[0]) + 1
    typical = float(np.median(rises))
    if typical <= 0.0 or np.any(rises <= 0.0):
        return typical, _first_misfit(rises, typical)
    if not _SMALLEST < typical < _LARGEST:
        return typical, None  # of no record, in whatever unit: the caller refuses it
    digit = _last_digits(times, fields)
    digit = np.where(digit > _COARSEST_DIGIT * typical, 0.0, digit)
    noise = _JITTER * typical + _FLOAT_ULPS * np.finfo(float).eps * float(np.max(np.abs(times)))
    count = np.arange(times.size)
    for within in (0.5 * _TIES * digit + noise, _TIES * digit + noise):
        lower = float(np.max((times[1:] - times[0] - within[1:]) / count[1:]))
        upper = float(np.min((times[1:] - times[0] + within[1:]) / count[1:]))
        for step in _plain_numbers(lower, upper):
            rest = times - times[0] - count * step
            first_exact = np.all(np.abs(rest) <= 0.5 * _TIES * digit + noise)
            if first_exact or _all_rounded(rest, float(np.max(digit))):
                return step, None
    return typical, _first_misfit(rises, typical)


def _all_rounded(rest: Array, digit: float) -> bool:
    spread = float(np.median(np.abs(rest - np.median(rest))))
    return float(np.ptp(rest)) <= _TIES * digit and spread >= _ROUNDED_AT_ALL * digit


def _first_misfit(rises: Array, typical: float) -> int:
    misfit = np.abs(rises - typical)
    beyond = np.flatnonzero((misfit > 0.5 * abs(typical)) | (rises <= 0.0))
    if not beyond.size:
        # one wrong time makes two wrong steps of almost the same size
        beyond = np.flatnonzero(misfit >= 0.99 * np.max(misfit))
    return int(beyond[0]) + 1


def _plain_numbers(lower: float, upper: float) -> Iterator[float]:
    # short decimals first, then a whole number of samples per second
    if not 0.0 < lower <= upper:
        return
    middle = 0.5 * (lower + upper)
    candidates = [float(f"{middle:.{digits}g}") for digits in range(1, 18)]
    rate = round(1.0 / middle)
    if rate > 0:
        candidates.insert(_PLAIN_DIGITS, 1.0 / rate)
    yield from (step for step in candidates if lower <= step <= upper)


def _last_digits(times: Array, fields: Sequence[str]) -> Array:
    # Printed with a fixed number of decimals, all times share the last digit;
    # printed with a fixed number of significant digits, it grows with the time.
    decimals, significant = -400, 1
    if any("e" in field or "E" in field or "d" in field or "D" in field for field in fields):
        for field in fields:
            mantissa, _, exponent = field.upper().replace("D", "E").partition("E")
            # a longer exponent is that of a zero, whose digits tell nothing
            power = int(exponent) if 0 < len(exponent) <= _LONGEST_EXPONENT else 0
            decimals = max(decimals, len(mantissa.partition(".")[2]) - power)
            significant = max(significant, len(mantissa.replace(".", "").lstrip("+-0")))
    else:
        decimals = max(len(field.partition(".")[2]) for field in fields)
        significant = max(1, *(len(field.replace(".", "").lstrip("+-0")) for field in fields))
    size = np.abs(times)
    leading = np.floor(np.log10(np.where(size > 0.0, size, 1.0))) + 1.0 - significant
    return 10.0 ** np.where(size > 0.0, np.maximum(-decimals, leading), -float(decimals))
