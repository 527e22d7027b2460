"""Conversion of text to numbers, in free format or fixed width, and of times to one time step.

The conversion is fast; only if it fails, a slower one finds the line of the fault.
"""

import math
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime, timedelta
from typing import Final

import numpy as np

from rockframe.errors import RecordError
from rockframe.records.reader import MAXIMUM_SAMPLES, Source, quoted_first_line
from rockframe.signals.arrays import Array

# no digit can be matched in two ways, so that a failed match takes linear time
NUMBER: Final = r"[-+]?(?:\d+(?:\.\d*)?|\.\d+)(?:[EeDd][-+]?\d+)?"
ONE_NUMBER: Final = re.compile(NUMBER, re.ASCII)
WHOLE_NUMBER: Final = rf"({NUMBER})(?!\d|\.\d|[EeDd][-+]?\d)"
"""A number followed by more of a pattern; the lookahead excludes a part of a longer number."""
_SHAPE: Final = re.compile(r"[-+]?\d*(\.\d*)?(?:[EeDd][-+]?(\d+))?", re.ASCII)
_SHAPE_SAMPLE: Final = 20
_MIN_FIELDS: Final = 4
_CHUNK: Final = 2**20
_MAX_COUNT_LENGTH: Final = 12
_WHOLE: Final = re.compile(r"[-+]?\d+", re.ASCII)

_EPOCH: Final = datetime(1970, 1, 1, tzinfo=UTC)
_SAME: Final = 0.1 * (1.0 + 1e-6)
"""Difference of starts, in time steps, up to which they count as equal: clocks round to 0.1 ms."""
_LATER: Final = re.compile(r"(.*), (plus|less) (\d+(?:\.\d+)?) s", re.ASCII)
"""Start that is stated as seconds after or before a text."""

_JITTER: Final = 1e-6
_FLOAT_ULPS: Final = 8.0
_TIES: Final = 1.0 + 1e-6
_COARSEST_DIGIT: Final = 0.5
_ROUNDED_AT_ALL: Final = 0.05
_PLAIN_DIGITS: Final = 4
_SMALLEST: Final = 1e-9
_LARGEST: Final = 1e9
_MAX_EXPONENT_LENGTH: Final = 5


def free_format(source: Source, first: int, end: int | None = None) -> Array:
    """Read all numbers from a line to the end of the file, or to another line."""
    parts: list[Array] = []
    count = 0
    for start, stop in _chunks(source, first, len(source.lines) if end is None else end):
        part = _fields(source, start, stop)
        count += part.size
        if count > MAXIMUM_SAMPLES:
            raise too_many_samples_error(source, count, line=stop)
        parts.append(part)
    return np.concatenate(parts) if parts else np.empty(0)


def all_numbers(source: Source, first: int, end: int | None = None, *, of: object = None) -> Array:
    """Read all numbers from a line on, `of` if stated; refuse a file that is cut off inside one."""
    values = free_format(source, first, end)
    if end is None:
        announced = "" if of is None else f" of {of}"
        check_end(source, last_fields(source, first), f"{values.size}{announced} samples")
    return values


def check_end(source: Source, fields: Sequence[str], content: str, line: int | None = None) -> None:
    """Refuse a file that is cut off inside its last number."""
    last_line = source.lines[-1]
    if not last_line or last_line[-1].isspace():
        return
    if len(source.lines) > 1 and len(last_line) == len(source.lines[-2]) and " 0" in last_line[-2:]:
        return
    shapes = {digit_counts(field) for field in fields[-_SHAPE_SAMPLE - 1 : -1]}
    if len(shapes) != 1 or len(fields) < _MIN_FIELDS:
        return
    usual, last = shapes.pop(), digit_counts(fields[-1])
    if usual is not None and (last is None or last < usual):
        raise cut_off_error(source, content, line)


def cut_off_error(source: Source, content: str, line: int | None = None) -> RecordError:
    """Build the error for a file that is cut off inside a number."""
    found, line = f"the end of the file inside a number ({content})", line or source.last_line
    return source.refuse(found=found, expected="a complete file", line=line)


def too_many_samples_error(source: Source, count: int, line: int | None = None) -> RecordError:
    """Build the error for more samples than a record can have."""
    expected = f"at most {MAXIMUM_SAMPLES} samples"
    return source.refuse(found=f"{count} or more numbers", expected=expected, line=line)


def floats_or_none(fields: Sequence[str]) -> Array | None:
    """Convert all fields together; None if one of them is not a finite number."""
    for attempt in (fields, map(with_exponent_e, fields)):
        try:
            values = np.fromiter(map(float, attempt), dtype=np.float64, count=len(fields))
        except ValueError:
            continue
        return values if np.isfinite(values).all() else None
    return None


def number_or_none(text: str) -> float | None:
    """Read a number; None for other text."""
    return None if ONE_NUMBER.fullmatch(text) is None else float(with_exponent_e(text))


def is_plain_number_text(text: str) -> bool:
    """Tell whether text has no characters that only Python accepts in numbers."""
    return text.isascii() and "_" not in text


def required_number(text: str, source: Source, line: int) -> float:
    """Read a field that must be a finite number."""
    if ONE_NUMBER.fullmatch(text) is None:
        raise source.refuse(found=quoted_first_line(text), expected="a number", line=line)
    value = float(with_exponent_e(text))
    if not math.isfinite(value):
        raise source.refuse(
            found=f"{quoted_first_line(text)}, which overflows",
            expected="a finite number",
            line=line,
        )
    return value


def last_fields(source: Source, first: int) -> list[str]:
    """Return the last fields of a file, as printed."""
    count = _SHAPE_SAMPLE + 1
    fields: list[str] = []
    for line in reversed(source.lines[first:]):
        fields = line.split()[-count:] + fields
        if len(fields) >= count:
            break
    return fields[-count:]


def _chunks(source: Source, first: int, last: int) -> Iterator[tuple[int, int]]:
    # in pieces, so that not all fields of a long file are in memory at once
    start, size = first, 0
    for index in range(first, last):
        size += len(source.lines[index]) + 1
        if size >= _CHUNK:
            yield start, index + 1
            start, size = index + 1, 0
    if start < last:
        yield start, last


def _fields(source: Source, first: int, end: int) -> Array:
    body = " ".join(source.lines[first:end])
    fields = body.split()
    if len(fields) > MAXIMUM_SAMPLES:
        raise too_many_samples_error(source, len(fields), line=end)
    values = floats_or_none(fields) if is_plain_number_text(body) else None
    if values is not None:
        return values
    collected: list[Array] = []
    for index in range(first, end):
        fields = source.lines[index].split()
        values = floats_or_none(fields) if is_plain_number_text(source.lines[index]) else None
        if values is None:
            pieces = [
                piece for field in fields for piece in _checked_float(field, source, index + 1)
            ]
            values = np.array(pieces, dtype=np.float64)
        collected.append(values)
    return np.concatenate(collected)


def with_exponent_e(field: str) -> str:
    """Replace the exponent letter D, of Fortran's double precision, by E."""
    return field.replace("D", "E").replace("d", "e")


def digit_counts(field: str) -> tuple[int, int] | None:
    """Count the digits of the exponent and after the point; None if it is not a number."""
    match = _SHAPE.fullmatch(field)
    if match is None:
        return None
    decimals, exponent = match.groups()
    return len(exponent or ""), len(decimals or "")


def _checked_float(field: str, source: Source, line: int) -> list[float]:
    # Fortran writes fixed-width numbers without a blank between them if they fill their width.
    # A sign then marks the start of the next one; without a sign or a decimal point the start
    # is ambiguous.
    pieces: list[str] = []
    position = 0
    for match in ONE_NUMBER.finditer(field):
        if match.start() != position:
            break
        pieces.append(match.group())
        position = match.end()
    if position != len(field) or not pieces:
        raise source.refuse(found=quoted_first_line(field), expected="a finite number", line=line)
    together = len(pieces) > 1
    if together and not all(piece[0] in "+-" and "." in piece for piece in pieces[1:]):
        found = f"{quoted_first_line(field)}, numbers run together"
        raise source.refuse(
            found=found, expected="blanks, or signs, between the numbers", line=line
        )
    if together and "." not in pieces[0]:
        raise source.refuse(found=quoted_first_line(field), expected="a finite number", line=line)
    return [required_number(piece, source, line) for piece in pieces]


@dataclass(frozen=True)
class FixedWidth:
    """Layout of numbers in columns of fixed width, as Fortran writes them, also without blanks."""

    width: int
    per_line: int
    indent: int = 0

    def rows(self, count: int) -> int:
        """Return the number of lines for some numbers."""
        return -(-count // self.per_line)

    def read(self, source: Source, first: int, count: int) -> Array:
        """Read numbers from a line on."""
        width, per_line = self.width, self.per_line
        if width < 1 or per_line < 1:
            found = f"a layout of {per_line} numbers of {width} characters in a line"
            raise source.refuse(found=found, expected="one or more of each", line=first)
        if count < 2:
            found = f"{count} samples announced"
            raise source.refuse(found=found, expected="two or more", line=first)
        if count > MAXIMUM_SAMPLES:
            raise too_many_samples_error(source, count, line=first)
        needed = self.rows(count)
        lines = [line.rstrip()[self.indent :] for line in source.lines[first : first + needed]]
        if len(lines) < needed or not lines[-1]:
            available = min(sum(len(line) // width for line in lines), count - 1)
            found = f"the end of the file after {available} samples"
            raise source.refuse(found=found, expected=f"{count} samples", line=source.last_line)
        last = count - per_line * (needed - 1)
        for index, line in enumerate(lines):
            fields = per_line if index < needed - 1 else last
            if len(line) != width * fields:
                raise source.refuse(
                    found=f"{len(line)} characters ({quoted_first_line(line)})",
                    expected=f"{width * fields}: {fields} numbers of {width} characters",
                    line=first + index + 1,
                )
        body = "".join(lines)
        printed = [body[place : place + width] for place in range(0, len(body), width)]
        values = floats_or_none(printed) if is_plain_number_text(body) else None
        if values is not None:
            return values
        checked = [
            required_number(field.strip(), source, first + index // per_line + 1)
            for index, field in enumerate(printed)
        ]
        return np.array(checked, dtype=np.float64)


@dataclass(frozen=True)
class Fields:
    """Numbers of a header, by their place from 1."""

    source: Source
    layout: FixedWidth
    first: int  # index of their first line, from 0

    def line(self, place: int) -> int:
        """Return the line of a field, from 1."""
        return self.first + (place - 1) // self.layout.per_line + 1

    def cell(self, place: int) -> str:
        """Return a field without surrounding blanks; empty if the file ends before it."""
        row, column = divmod(place - 1, self.layout.per_line)
        if self.first + row >= len(self.source.lines):
            return ""
        width, text = self.layout.width, self.source.lines[self.first + row]
        return text[column * width : (column + 1) * width].strip()

    def number(self, place: int, what: str) -> float:
        """Read one number."""
        text, line = self.cell(place), self.line(place)
        if not text:
            raise self.source.refuse(found=f"no {what}", expected=f"a number ({what})", line=line)
        return required_number(text, self.source, line)

    def count(self, place: int, what: str) -> int:
        """Read one whole number."""
        text = self.cell(place)
        value = integer_or_none(text)
        if value is None:
            found = f"{quoted_first_line(text)} for the {what}"
            raise self.source.refuse(found=found, expected="a whole number", line=self.line(place))
        return value


def rows_below(source: Source, first: int) -> int:
    """Count the rows from a line to the end of the file; there must be at least two."""
    rows = source.last_line - first
    if rows < 2:
        found = f"{max(rows, 0)} rows of numbers"
        raise source.refuse(found=found, expected="two or more", line=source.last_line)
    return rows


def integer_or_none(text: str) -> int | None:
    """Read a whole number; None for other text, or too many digits."""
    text = text.strip()
    if len(text) > _MAX_COUNT_LENGTH or _WHOLE.fullmatch(text) is None:
        return None
    return int(text)


def same_start(start: object, other_start: object, time_step: float) -> bool:
    """Tell whether two starts agree to a tenth of a time step, or one of them is unknown."""
    if start is None or other_start is None or start == other_start:
        return True
    first, second = epoch_seconds(start), epoch_seconds(other_start)
    if first is None or second is None:
        (text, first), (other_text, second) = (
            _text_and_seconds(start),
            _text_and_seconds(other_start),
        )
        if text != other_text:
            return False
    return abs(second - first) <= _SAME * time_step


def epoch_seconds(time: object) -> float | None:
    """Return the seconds from 1970 to a time in ISO 8601; None for other text."""
    try:
        moment = datetime.fromisoformat(str(time).strip())
    except ValueError:
        return None
    zoned = moment if moment.tzinfo is not None else moment.replace(tzinfo=UTC)
    return (zoned - _EPOCH).total_seconds()


def time_after(time: object, seconds: float) -> str:
    """Return the time some seconds after a time in ISO 8601, or after any text."""
    text = str(time).strip()
    try:
        moved = datetime.fromisoformat(text) + timedelta(seconds=seconds)
    except (ValueError, OverflowError):
        start, before = _text_and_seconds(text)
        later = before + seconds
        amount = f"{abs(later):.6f}".rstrip("0").rstrip(".")
        word = "plus" if later > 0.0 else "less"
        return start if amount == "0" else f"{start}, {word} {amount} s"
    return moved.isoformat().replace("+00:00", "Z" if text.endswith("Z") else "+00:00")


def _text_and_seconds(time: object) -> tuple[str, float]:
    """Divide the text of a start into that of the file and the seconds after it."""
    match = _LATER.fullmatch(str(time).strip())
    if match is None:
        return str(time).strip(), 0.0
    return match[1], float(match[3]) * (1.0 if match[2] == "plus" else -1.0)


def uniform_step(
    times: Array, fields: Sequence[str], precision: type[np.float32 | np.float64] = np.float64
) -> tuple[float, int | None]:
    """Find the time step from which a column of times was printed.

    Times t_0 + k dt, each rounded to its last printed digit q, lie within q/2 of a straight line
    through the first, or, if the first was rounded, too, within q of one another. Further
    deviations must be below 1e-6 dt and a few roundings of `precision`. If q exceeds dt/2, no
    rounding is admitted, so that a missing sample or a wrong last digit is found.
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
        return typical, None  # the step of no record in any unit; the caller refuses it
    digit = _last_digits(times, fields)
    digit = np.where(digit > _COARSEST_DIGIT * typical, 0.0, digit)
    rounding = float(np.finfo(precision).eps) * float(np.max(np.abs(times)))
    noise = _JITTER * typical + _FLOAT_ULPS * rounding
    count = np.arange(times.size)
    for within in (0.5 * _TIES * digit + noise, _TIES * digit + noise):
        lower = float(np.max((times[1:] - times[0] - within[1:]) / count[1:]))
        upper = float(np.min((times[1:] - times[0] + within[1:]) / count[1:]))
        for step in _plain_numbers(lower, upper):
            deviation = times - times[0] - count * step
            first_exact = np.all(np.abs(deviation) <= 0.5 * _TIES * digit + noise)
            if first_exact or _all_rounded(deviation, float(np.max(digit))):
                return step, None
    return typical, _first_misfit(rises, typical)


def _all_rounded(deviation: Array, digit: float) -> bool:
    spread = float(np.median(np.abs(deviation - np.median(deviation))))
    return float(np.ptp(deviation)) <= _TIES * digit and spread >= _ROUNDED_AT_ALL * digit


def _first_misfit(rises: Array, typical: float) -> int:
    misfit = np.abs(rises - typical)
    beyond = np.flatnonzero((misfit > 0.5 * abs(typical)) | (rises <= 0.0))
    if not beyond.size:
        # one wrong time causes two wrong steps of almost the same size
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
    # With a fixed number of decimals all times have the same last digit; with a fixed number of
    # significant digits it grows with the time.
    decimals, significant = -400, 1
    for field in fields:
        mantissa, _, exponent = field.upper().replace("D", "E").partition("E")
        # a longer exponent is that of a zero, whose digits have no meaning
        power = int(exponent) if 0 < len(exponent) <= _MAX_EXPONENT_LENGTH else 0
        decimals = max(decimals, len(mantissa.partition(".")[2]) - power)
        significant = max(significant, len(mantissa.replace(".", "").lstrip("+-0")))
    size = np.abs(times)
    leading = np.floor(np.log10(np.where(size > 0.0, size, 1.0))) + 1.0 - significant
    return 10.0 ** np.where(size > 0.0, np.maximum(-decimals, leading), -float(decimals))
