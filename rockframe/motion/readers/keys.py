"""Headers made of keys and values, one per line."""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeAlias

from rockframe.motion.readers.numbers import number

if TYPE_CHECKING:
    from collections.abc import Mapping

    from rockframe.motion.readers.source import Metadata, Source

Keys: TypeAlias = "dict[str, tuple[str, int]]"
"""Value and line, from 1, of each key."""


def needed(source: Source, keys: Keys, key: str) -> tuple[str, int]:
    """Give the value of a key that must be there.

    Parameters
    ----------
    source : Source
        File.
    keys : dict
        Header.
    key : str
        Which.

    Returns
    -------
    tuple of str and int
        Value and line, from 1.

    Raises
    ------
    RecordError
        No such key, or no value.
    """
    value, line = keys.get(key, ("", 1))
    if not value:
        expected = f"a header line {key!r} with a value"
        raise source.refuse(found=f"no value of {key!r}", expected=expected, line=line)
    return value, line


def needed_rate(source: Source, keys: Keys, key: str) -> tuple[float, int]:
    """Give a sampling rate that must be there and above zero, and its line [Hz]."""
    text, line = needed(source, keys, key)
    rate = number(text.casefold().removesuffix("hz").strip(), source, line)
    if not rate > 0.0:
        found = f"a sampling rate of {rate!r} Hz"
        raise source.refuse(found=found, expected="one above zero", line=line)
    return rate, line


def kept(keys: Keys, names: Mapping[str, str]) -> Metadata:
    """Give those values that go into the metadata, under their new names."""
    return {name: keys[key][0] for key, name in names.items() if keys.get(key, ("", 0))[0]}
