"""Files that are invalid in any format, and the choice of format."""

import os
import sys
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from unit.motion.motion_files import at2, numbers

from rockframe.errors import RecordError, RecordWarning, UnitsError
from rockframe.motion import GroundMotion, formats

HTML = "<!DOCTYPE html>\n<html><head><title>404 Not Found</title></head></html>\n"
AT2 = at2("NPTS=  12, DT= .0050 SEC", numbers(12))
CSV = "time (s),acceleration (g)\n" + "".join(
    f"{k * 0.01:.2f},{v:.7f}\n" for k, v in enumerate(numbers(12))
)


@pytest.mark.parametrize("name", ["r.AT2", "r.csv", "r"])
@pytest.mark.parametrize(
    ("content", "words"),
    [
        (b"", "empty file"),
        (b"  \r\n \n", "empty file"),
        (b"\xef\xbb\xbf", "empty file"),
        (HTML.encode(), "web page"),
        (b"\xef\xbb\xbf\n" + HTML.lower().encode(), "web page"),
        (bytes(range(256)) * 8, "binary data"),
        (b"\x1f\x8b\x08" + bytes(range(128, 256)) * 8, "gzip file that cannot be unpacked"),
        (AT2.encode("utf-16"), "UTF-16"),
        (b"nothing but a few words\n", "'nothing but a few words'"),
    ],
)
def test_content_that_is_no_record(write, name, content, words):
    path = write(content, name)
    with pytest.raises(RecordError, match=words) as caught:
        GroundMotion.read(path)
    assert str(path) in str(caught.value)
    assert caught.value.path == str(path)


def test_missing_file(tmp_path):
    with pytest.raises(RecordError, match="no such file"):
        GroundMotion.read(tmp_path / "nowhere.AT2")


def test_directory(tmp_path):
    with pytest.raises(RecordError, match="a directory"):
        GroundMotion.read(tmp_path)


@pytest.mark.parametrize("path", ["bad\x00name", 3.5, None])
def test_invalid_path_is_refused(path):
    with pytest.raises(RecordError, match="names no file"):
        GroundMotion.read(path)


@pytest.mark.skipif(sys.platform == "win32", reason="needs a special file")
def test_file_that_cannot_be_read(tmp_path):
    path = tmp_path / "link.AT2"
    path.symlink_to(path)
    with pytest.raises(RecordError, match=r"cannot be read|no such file"):
        GroundMotion.read(path)


@pytest.mark.skipif(sys.platform == "win32", reason="needs a pipe")
def test_pipe_is_refused_without_waiting(tmp_path):
    path = tmp_path / "pipe.AT2"
    os.mkfifo(path)
    with pytest.raises(RecordError, match="no ordinary file"):
        GroundMotion.read(path)


def test_format_can_be_specified_by_name(write):
    assert {"peer-at2", "text"} <= {entry.name for entry in formats()}
    motion = GroundMotion.read(write(AT2, "record.unknown"), format="peer-at2")
    assert motion == GroundMotion.read(write(AT2, "record.unknown"))
    assert motion.metadata["format"] == "peer-at2"


def test_accented_header_in_latin_1(write):
    motion = GroundMotion.read(write(AT2.replace("Made Up", "Córdoba").encode("latin-1")))
    assert motion.metadata["event"] == "Córdoba"


def test_a_string_is_a_path_too(write):
    path = write(AT2)
    assert GroundMotion.read(str(path)) == GroundMotion.read(Path(path))


def test_source_is_recorded(write):
    import hashlib

    motion = GroundMotion.read(write(AT2, "some.AT2"))
    assert motion.name == "some"
    assert motion.metadata["source_file"] == "some.AT2"
    assert motion.metadata["source_sha256"] == hashlib.sha256(AT2.encode()).hexdigest()
    assert motion.metadata["unit_as_read"] == "G"
    assert motion.history == (
        "read some.AT2 (PEER acceleration file (AT2), unit G): 12 samples at 0.005 s",
    )


@st.composite
def damaged(draw):
    """A record with some bytes changed, deleted or inserted."""
    name, text = draw(st.sampled_from([("r.AT2", AT2), ("r.csv", CSV)]))
    data = bytearray(text.encode())
    for _ in range(draw(st.integers(1, 4))):
        place = draw(st.integers(0, len(data)))
        kind = draw(st.sampled_from(["change", "cut", "insert", "end"]))
        inserted = draw(
            st.binary(min_size=1, max_size=4)
            | st.sampled_from(
                [
                    b",",
                    b";",
                    b".",
                    b"-",
                    b"E",
                    b"\n",
                    b"\r",
                    b" ",
                    b"nan",
                    b"1e999",
                    b"#",
                    b"(",
                    b"\t",
                ]
            )
        )
        if kind == "change":
            data[place : place + len(inserted)] = inserted
        elif kind == "cut":
            del data[place : place + draw(st.integers(1, 40))]
        elif kind == "insert":
            data[place:place] = inserted
        elif kind == "end":
            del data[max(place, 1) :]
    return name, bytes(data)


@settings(
    max_examples=400, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture]
)
@given(
    file=damaged(),
    unit=st.sampled_from([None, "g"]),
    given_format=st.sampled_from([None, "text", "peer-at2"]),
)
@pytest.mark.filterwarnings("ignore::rockframe.errors.RecordWarning")
def test_damaged_files_end_in_a_motion_or_a_record_error(write, file, unit, given_format):
    name, data = file
    path = write(data, name)
    try:
        motion = GroundMotion.read(path, format=given_format, unit=unit)
    except RecordError as refusal:
        error = refusal
        motion = None
    if motion is None:
        assert str(path) in str(error)
        lines = data.count(b"\n") + data.count(b"\r") + 1
        assert error.line is None or 1 <= error.line <= lines
    else:
        assert len(motion) >= 2
        assert abs(motion.si.horizontal.samples).max() < float("inf")
        assert 1e-6 <= motion.si.time_step <= 10.0


def test_warnings_point_at_the_caller(write):
    path = write(AT2.replace("12,", "13,"))
    with pytest.warns(RecordWarning, match="declares 13") as caught:
        GroundMotion.read(path)
    assert caught[0].filename == __file__


def test_bare_time_step(write):
    with pytest.raises(UnitsError, match="time_step needs a time"):
        GroundMotion.read(write(CSV, "r.csv"), time_step=0.01)
