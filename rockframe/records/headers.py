"""Text headers: lines that match a pattern, and keys with values, one per line."""

import re
from collections.abc import Iterable, Mapping
from typing import Final, TypeAlias

from rockframe.records.checks import checked_time_step
from rockframe.records.numbers import integer_or_none, required_number
from rockframe.records.reader import Metadata, Request, Source, quoted_first_line

Keys: TypeAlias = dict[str, tuple[str, int]]
"""Value and line number, from 1, of each key."""

MISSING_KEY: Final = ("", 0)
"""Value and line of a missing key."""


def first_match(
    pattern: re.Pattern[str], lines: Iterable[str], first: int = 1
) -> tuple[re.Match[str], int] | None:
    """Find the first line that contains a pattern, and its number, counted from `first`."""
    matches = ((pattern.search(text), line) for line, text in enumerate(lines, start=first))
    return next(((match, line) for match, line in matches if match is not None), None)


def read_keys(lines: Iterable[str]) -> Keys:
    """Read lines ``KEY   : value``; the first one counts if a key is repeated."""
    keys: Keys = {}
    for line, text in enumerate(lines, start=1):
        key, colon, value = text.partition(":")
        if colon and key.strip():
            keys.setdefault(key.strip(), (value.strip(), line))
    return keys


def required_count(source: Source, keys: Keys, key: str) -> tuple[int, str, int]:
    """Return a required number of samples, above zero, with its key and line."""
    text, line = required_value(source, keys, key)
    return whole_number(source, text, f"{key} {quoted_first_line(text)}", line), key, line


def whole_number(source: Source, text: str, found: str, line: int) -> int:
    """Read a whole number above zero; `found` are the words of the error."""
    count = integer_or_none(text)
    if count is None or count < 1:
        raise source.refuse(found=found, expected="a whole number above zero", line=line)
    return count


def required_value(source: Source, keys: Keys, key: str) -> tuple[str, int]:
    """Return the value of a required key, and its line."""
    value, line = keys.get(key, ("", 1))
    if not value:
        expected = f"a header line {key!r} with a value"
        raise source.refuse(found=f"no value of {key!r}", expected=expected, line=line)
    return value, line


def required_rate(source: Source, request: Request, keys: Keys, key: str) -> float:
    """Return a required sampling rate, above zero and consistent with the request [Hz]."""
    text, line = required_value(source, keys, key)
    rate = required_number(text.casefold().removesuffix("hz").strip(), source, line)
    if not rate > 0.0:
        found = f"a sampling rate of {rate!r} Hz"
        raise source.refuse(found=found, expected="one above zero", line=line)
    checked_time_step(source, request, 1.0 / rate, line)
    return rate


def required_step(source: Source, request: Request, keys: Keys, key: str) -> float:
    """Return a required time step, consistent with the request [s]."""
    text, line = required_value(source, keys, key)
    time_step = required_number(text, source, line)
    checked_time_step(source, request, time_step, line)
    return time_step


def value_or_empty(keys: Keys, key: str) -> str:
    """Return the value of a key, empty if it is not there."""
    return keys.get(key, MISSING_KEY)[0]


def without_empty_values(described: Mapping[str, str]) -> Metadata:
    """Leave out empty texts."""
    return {name: text for name, text in described.items() if text}


def required_match(
    source: Source, pattern: re.Pattern[str], lines: list[str], such_as: str, first: int = 1
) -> tuple[re.Match[str], int]:
    """Find the first line that contains a required pattern, and its number."""
    match_and_line = first_match(pattern, lines, first)
    if match_and_line is None:
        words = f"no such line below {quoted_first_line(chr(10).join(lines))}"
        raise source.refuse(found=words, expected=f"a line such as {such_as!r}", line=first)
    return match_and_line


def renamed_keys(keys: Keys, names: Mapping[str, str]) -> Metadata:
    """Return values of a header for the metadata, under their new names."""
    return without_empty_values({name: value_or_empty(keys, key) for key, name in names.items()})
