"""What the header of a text says of its time step and its peak, in whatever words."""

from __future__ import annotations

import math
import re
from typing import Final

from rockframe.records.numbers import NUMBER, with_e

TIME_UNITS: Final = {
    **dict.fromkeys(("s", "sec", "secs", "sec.", "second", "seconds"), 1.0),
    **dict.fromkeys(("ms", "msec", "millisecond", "milliseconds"), 1e-3),
}

_OTHER_TIME_UNITS: Final = ("us", "ns", "min", "minutes", "h", "hours", "hz")

_STEP: Final = re.compile(
    rf"(?:\bd_?t|\bdelta[ _]?t|\btime[ _-]?(?:step|increment|interval)|"
    rf"\bsampl(?:ing|e)[ _-]?(?:interval|period))\s*(?:[(\[]\s*([a-z]{{1,7}})\.?\s*[)\]])?"
    rf"\s*[:=]\s*({NUMBER})\s*([a-z]{{0,7}})",
    re.IGNORECASE | re.ASCII,
)
_RATE: Final = re.compile(
    rf"(?:\bsampl(?:ing|e)[ _-]?(?:rate|frequency))\s*(?:[(\[]\s*(?:hz|sps)\s*[)\]])?"
    rf"\s*[:=]\s*({NUMBER})",
    re.IGNORECASE | re.ASCII,
)
_PEAK: Final = re.compile(
    rf"\b(?:pga|peak(?: ground)? acceleration)\s*(?:[(\[]\s*([^()\[\]]{{1,12}})[)\]])?"
    rf"\s*[:=]\s*({NUMBER})\s*([a-z][a-z0-9/^*-]{{0,11}})?",
    re.IGNORECASE | re.ASCII,
)


def stated_step(header: list[tuple[int, str]]) -> tuple[float, int] | None:
    """Find a time step, or a sampling rate, that the header states, and its line."""
    for line, text in header:
        step, rate = _STEP.search(text), _RATE.search(text)
        if step is not None:
            before, printed, behind = step.groups()
            named = (before or behind or "s").casefold()
            if named in _OTHER_TIME_UNITS:
                continue
            scale = TIME_UNITS.get(named, 1.0)  # another word begins another statement
            value = float(with_e(printed))
            return float(f"{value * scale:.15g}"), line
        if rate is not None:
            value = float(with_e(rate.group(1)))
            if 0.0 < value < math.inf:
                return 1.0 / value, line
    return None


def stated_peak(header: list[tuple[int, str]]) -> tuple[str, str, int] | None:
    """Find a peak that the header states: the number as printed, its unit, its line."""
    for line, text in header:
        match = _PEAK.search(text)
        if match is not None:
            before, printed, behind = match.groups()
            unit = (before or behind or "").strip()
            if unit:
                return printed, unit, line
    return None
