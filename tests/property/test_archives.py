"""Malicious archives are refused quickly, with little memory, and nothing is written."""

import gzip
import io
import os
import tarfile
import tracemalloc
import zipfile
import zlib
from contextlib import suppress

import pytest
from hypothesis import HealthCheck, event, given, settings
from hypothesis import strategies as st
from processor_time import processor_time
from property.damaged_files import DAMAGE, damaged
from property.test_reading import check
from unit.motion.format_samples import SAMPLES
from unit.motion.test_record_sources import AT2, tarred, zipped

import rockframe as rf
from rockframe.errors import RecordError

pytestmark = [
    pytest.mark.wide,
    pytest.mark.filterwarnings("ignore::rockframe.errors.RecordWarning"),
]

TIMES = float(os.environ.get("ROCKFRAME_FUZZ", "1"))
LONGEST = 1.0  # s of processor time
MOST_MEMORY = 200e6  # byte
MANY = tuple((f"{k}.AT2", AT2) for k in range(3))
WHOLE = {
    "one.zip": zipped(("a.AT2", AT2)),
    "many.zip": zipped(*MANY),
    "one.tar": tarred(("a.AT2", AT2)),
    "many.tar": tarred(*MANY),
    "one.tar.gz": tarred(("a.AT2", AT2), mode="w:gz"),
    "one.AT2.gz": gzip.compress(AT2),
}


def examples(count: int) -> settings:
    return settings(
        max_examples=int(count * TIMES), deadline=None, suppress_health_check=list(HealthCheck)
    )


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    path = tmp_path_factory.mktemp("archives")
    for name, data in WHOLE.items():  # loads the libraries
        (path / name).write_bytes(data)
        rf.read_suite(path / name)
    return path


def read_all(data: bytes) -> str:
    """Read a file as a suite, or get a RecordError, quickly and with little memory."""
    suite = error = None
    peak = 0

    def read():
        nonlocal suite, error, peak
        tracemalloc.start()
        try:
            suite = rf.read_suite(data)
        except RecordError as refusal:
            error = refusal
        finally:
            peak = tracemalloc.get_traced_memory()[1]
            tracemalloc.stop()

    longest = 2.0 * LONGEST  # tracing doubles the time
    assert processor_time(read, longest) < longest
    assert peak < MOST_MEMORY
    assert error is None or len(str(error)) < 2_500
    assert suite is None or all(suite.unread.values())
    return "refused" if suite is None else "read"


@pytest.mark.parametrize("name", WHOLE)
@examples(60)
@given(damage=DAMAGE)
def test_damaged_archives(folder, name, damage):
    data = damaged(WHOLE[name], damage)
    event(check(folder / name, data, packed=True))
    event(read_all(data))


@examples(80)
@given(
    names=st.lists(
        st.sampled_from(["a.AT2", "../a", "/a", "a/../../b", "C:\\a", "a\\..\\..\\b", ".", ".."])
        | st.text(min_size=1, max_size=20).filter(lambda name: name.encode("utf-8", "ignore")),
        min_size=1,
        max_size=4,
    ),
    sample=st.sampled_from(sorted(SAMPLES)),
)
def test_member_names_cannot_escape_archive(tmp_path_factory, names, sample):
    place = tmp_path_factory.mktemp("names") / "below"
    place.mkdir()
    data = SAMPLES[sample].data
    held = io.BytesIO()
    with zipfile.ZipFile(held, "w") as archive:
        for name in dict.fromkeys(names):
            archive.writestr(zipfile.ZipInfo(name.encode("utf-8", "ignore").decode()), data)
    (place / "given.zip").write_bytes(held.getvalue())
    with suppress(RecordError):
        rf.read_suite(place / "given.zip")
    assert [path.name for path in place.parent.rglob("*")] == ["below", "given.zip"]


def zip_bomb(count: int, size: int) -> bytes:
    held = io.BytesIO()
    with zipfile.ZipFile(held, "w", zipfile.ZIP_DEFLATED, compresslevel=6) as archive:
        for k in range(count):
            archive.writestr(f"{k}.AT2", bytes(size))
    return held.getvalue()


def overlapping() -> bytes:
    """An archive with many directory entries for the same compressed file."""
    data = zip_bomb(1, 8 * 2**20)
    end = data.rindex(b"PK\x05\x06")
    start = int.from_bytes(data[end + 16 : end + 20], "little")
    entry, count = data[start:end], 400
    tail = bytearray(data[end:])
    tail[8:10] = tail[10:12] = count.to_bytes(2, "little")
    tail[12:16] = (count * len(entry)).to_bytes(4, "little")
    return data[:start] + entry * count + bytes(tail)


def many_entries() -> bytes:
    """An archive with the longest possible directory."""
    data = zipped(("a", b""))
    end = data.rindex(b"PK\x05\x06")
    start = int.from_bytes(data[end + 16 : end + 20], "little")
    entry, count = data[start:end], 500_000
    tail = bytearray(data[end:])
    tail[8:10] = tail[10:12] = b"\xff\xff"
    tail[12:16] = (count * len(entry)).to_bytes(4, "little")
    return data[:start] + entry * count + bytes(tail)


def lying_size() -> bytes:
    """A compressed file that states too small a size."""
    data = bytearray(zip_bomb(1, 64 * 2**20))
    for mark, offset in ((b"PK\x03\x04", 22), (b"PK\x01\x02", 24)):
        place = data.rindex(mark) + offset
        data[place : place + 4] = (1000).to_bytes(4, "little")
    return bytes(data)


def long_tar_name() -> bytes:
    """A tar header that announces a name of gigabytes, followed by gzipped zeros."""
    info = tarfile.TarInfo("x")
    info.type, info.size = tarfile.GNUTYPE_LONGNAME, 2**31
    packer = zlib.compressobj(9, wbits=31)
    parts = [packer.compress(info.tobuf(tarfile.GNU_FORMAT))]
    parts += [packer.compress(bytes(2**20)) for _ in range(64)]
    return b"".join([*parts, packer.flush()])


def sparse_tar() -> bytes:
    """A sparse file of large size without content."""
    info = tarfile.TarInfo("a.AT2")
    info.type, info.size = tarfile.GNUTYPE_SPARSE, 0
    head = bytearray(info.tobuf(tarfile.GNU_FORMAT))
    head[483:495] = b"77777777777\x00"
    head[148:156] = b" " * 8
    head[148:156] = b"%06o\x00 " % sum(head)
    return bytes(head) + bytes(1024)


def many_members() -> bytes:
    head = tarfile.TarInfo("a.AT2").tobuf()
    return head * 75_000 + bytes(1024)


BOMBS = {
    "gzip": lambda: gzip.compress(bytes(100 * 2**20), 6),
    "zip of one": lambda: zip_bomb(1, 100 * 2**20),
    "zip of many": lambda: zip_bomb(12, 39 * 2**20),
    "overlapping files": overlapping,
    "many entries": many_entries,
    "a size that lies": lying_size,
    "tar of zeros": lambda: gzip.compress(tarred(("a.AT2", bytes(100 * 2**20))), 6),
    "a long name": long_tar_name,
    "sparse": sparse_tar,
    "many members": many_members,
    "nested": lambda: zipped(("b.zip", zip_bomb(1, 100 * 2**20))),
    "many nested": lambda: zipped(*((f"{k}.zip", zip_bomb(1, 39 * 2**20)) for k in range(12))),
    "overlapping and nested": lambda: zipped(("b.zip", overlapping()), ("c.zip", overlapping())),
    "many entries nested": lambda: zipped(("b.zip", many_entries())),
    "nested in gzip": lambda: gzip.compress(zip_bomb(1, 100 * 2**20)),
}


@pytest.mark.parametrize(
    "name",
    [
        pytest.param(name, marks=[pytest.mark.long] * ("nested" in name or "many" in name))
        for name in BOMBS
    ],
)
def test_decompression_bombs_are_refused(folder, name, tmp_path):
    data = BOMBS[name]()
    path = tmp_path / "bomb"
    path.write_bytes(data)
    for read in (rf.GroundMotion.read, rf.read_suite):
        # thousands of files take long even when empty
        longest = 5.0 * LONGEST if (name, read) == ("many members", rf.read_suite) else LONGEST

        def refused(read=read):
            with pytest.raises(RecordError):
                read(path)

        assert processor_time(refused, longest) < longest
        tracemalloc.start()
        try:
            refused()
            assert tracemalloc.get_traced_memory()[1] < MOST_MEMORY
        finally:
            tracemalloc.stop()
    assert [one.name for one in tmp_path.iterdir()] == ["bomb"]
