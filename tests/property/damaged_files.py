"""Ways to damage a record file, as strategies: bytes, lines, numbers, parts of other files."""

import re

from hypothesis import strategies as st
from unit.motion.format_samples import SAMPLES

HEADER = 6_000  # byte: numbers are replaced in the headers

FRAGMENTS = [
    *(b"", b" ", b"\n", b"\r", b"\t", b",", b";", b".", b"-", b"+", b"E", b"D", b"#", b"|"),
    *(b"(", b":", b"nan", b"inf", b"1e999", b"1e-999999", b"0", b"-1", b"1.7E38", b"-999"),
    *(b"9" * 20, b"9" * 5000, b" " * 3000, b"(" * 3000, b"1 " * 3000),
    *(b"*****", b"1_0", b"\xd9\xa3", b"\x00", b"\xff\xfe", b"\x1a", b"/&"),
    *(b"NPTS= 5, DT= .01", b"End-of-data", b"accelerogram GNS Science\n"),
]
NUMBERS = [b"0", b"1", b"2", b"7", b"-5", b"62", b"360", b"1e9", b"999999999", b"99999999999999"]
TEXTS = [sample.data for sample in SAMPLES.values()]


def _overwrite(data: bytes, here: float, there: float, piece: bytes) -> bytes:
    at = int(here * len(data))
    return data[:at] + piece + data[at + len(piece) :]


def _insert(data: bytes, here: float, there: float, piece: bytes) -> bytes:
    at = int(here * len(data))
    return data[:at] + piece + data[at:]


def _remove(data: bytes, here: float, there: float, piece: bytes) -> bytes:
    at = int(here * len(data))
    return data[:at] + data[at + 1 + int(60 * there) :]


def _cut(data: bytes, here: float, there: float, piece: bytes) -> bytes:
    return data[: int(here * len(data))]


def _swap(data: bytes, here: float, there: float, piece: bytes) -> bytes:
    lines = data.split(b"\n")
    a, b = (int(place * (len(lines) - 1)) for place in (here, there))
    lines[a], lines[b] = lines[b], lines[a]
    return b"\n".join(lines)


def _repeat(data: bytes, here: float, there: float, piece: bytes) -> bytes:
    lines = data.split(b"\n")
    at = int(here * (len(lines) - 1))
    lines[at : at + 1] = [lines[at]] * int(4 * there)
    return b"\n".join(lines)


def _renumber(data: bytes, here: float, there: float, piece: bytes) -> bytes:
    numbers_found = list(re.finditer(rb"\d+", data[:HEADER]))
    if not numbers_found:
        return data
    match = numbers_found[int(here * (len(numbers_found) - 1))]
    number = NUMBERS[int(there * (len(NUMBERS) - 1))]
    return data[: match.start()] + number + data[match.end() :]


def _splice(data: bytes, here: float, there: float, piece: bytes) -> bytes:
    other = TEXTS[int(there * (len(TEXTS) - 1))]
    return data[: int(here * len(data))] + other[int(there * len(other)) :]


def _exchange_headers(data: bytes, here: float, there: float, piece: bytes) -> bytes:
    other = TEXTS[int(there * (len(TEXTS) - 1))].split(b"\n")
    lines = data.split(b"\n")
    count = int(60 * here)
    return b"\n".join(other[:count] + lines[count:])


KINDS = [
    *(_overwrite, _insert, _remove, _cut, _swap, _repeat, _renumber, _renumber, _splice),
    _exchange_headers,
]

# half of the positions near the top, in the headers
PLACES = st.one_of(st.floats(0.0, 0.1), st.floats(0.0, 1.0))
PIECES = st.one_of(st.sampled_from(FRAGMENTS), st.binary(min_size=1, max_size=12))
DAMAGE = st.lists(st.tuples(st.sampled_from(KINDS), PLACES, PLACES, PIECES), min_size=1, max_size=4)


def damaged(data: bytes, damage) -> bytes:
    """Apply a draw of DAMAGE to a file."""
    for step, here, there, piece in damage:
        data = step(data, here, there, piece)
    return data
