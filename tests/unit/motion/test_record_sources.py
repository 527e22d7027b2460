"""Sources of records: paths, gzip, archives, bytes, open files."""

import bz2
import gzip
import io
import lzma
import tarfile
import zipfile

import pytest
from unit.motion.motion_files import at2, numbers

from rockframe.errors import RecordError
from rockframe.motion import GroundMotion

AT2 = at2("NPTS=  12, DT= .0050 SEC", numbers(12)).encode()
CSV = b"time (s),acceleration (g)\n0.00,0.0\n0.01,0.1\n0.02,-0.1\n"


def zipped(*files: tuple[str, bytes], method: int = zipfile.ZIP_DEFLATED) -> bytes:
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", method) as archive:
        for name, data in files:
            archive.writestr(name, data)
    return buffer.getvalue()


def tarred(*files: tuple[str, bytes], mode: str = "w") -> bytes:
    buffer = io.BytesIO()
    with tarfile.open(fileobj=buffer, mode=mode) as archive:
        for name, data in files:
            info = tarfile.TarInfo(name)
            info.size = len(data)
            archive.addfile(info, io.BytesIO(data))
    return buffer.getvalue()


def test_paths_archives_bytes_and_open_files_give_same_record(tmp_path, monkeypatch):
    monkeypatch.setenv("HOME", str(tmp_path))
    monkeypatch.setenv("USERPROFILE", str(tmp_path))
    path = tmp_path / "some.AT2"
    path.write_bytes(AT2)
    plain = GroundMotion.read(path)
    assert plain.name == "some"
    packed = {
        "some.AT2.gz": gzip.compress(AT2),
        "one.zip": zipped(("folder/some.AT2", AT2), ("__MACOSX/folder/._some.AT2", b"\x00")),
        "stored.zip": zipped(("some.AT2", AT2), method=zipfile.ZIP_STORED),
        "one.tar": tarred(("some.AT2", AT2)),
        "one.tar.gz": tarred(("some.AT2", AT2), mode="w:gz"),
    }
    for name, data in packed.items():
        file = tmp_path / name
        file.write_bytes(data)
        assert GroundMotion.read(file) == plain, name
    assert GroundMotion.read("~/some.AT2") == plain
    assert GroundMotion.read("~/one.zip") == plain
    with path.open("rb") as file:
        assert GroundMotion.read(file).sha256 == plain.sha256
    with path.open(encoding="ascii") as file:
        assert GroundMotion.read(file).sha256 == plain.sha256
    for source in (AT2, bytearray(AT2), memoryview(AT2), io.BytesIO(AT2), packed["one.zip"]):
        assert GroundMotion.read(source).sha256 == plain.sha256
    assert GroundMotion.read(io.BytesIO(packed["one.tar.gz"])) == plain
    assert GroundMotion.read(zipped(("in.zip", packed["one.zip"]))).sha256 == plain.sha256
    assert GroundMotion.read(AT2).metadata["source_file"] == "bytes"


def test_arguments_go_with_bytes_too():
    motion = GroundMotion.read(b"0.0\n0.1\n-0.1\n", unit="g", time_step="0.01 s")
    assert len(motion) == 3
    with pytest.raises(RecordError, match=r"bytes: found no unit"):
        GroundMotion.read(b"0.0\n0.1\n-0.1\n", time_step="0.01 s")


def test_stored_motion_is_read_from_bytes(tmp_path):
    pulse = GroundMotion.sine_pulse("1 m/s^2", "1 Hz")
    path = tmp_path / "pulse.nc"
    pulse.to_dataset().to_netcdf(path)
    assert GroundMotion.read(path.read_bytes()) == pulse
    assert GroundMotion.read(gzip.compress(path.read_bytes())) == pulse


def linked(kind: bytes) -> bytes:
    buffer = io.BytesIO()
    with tarfile.open(fileobj=buffer, mode="w") as archive:
        info = tarfile.TarInfo("link.AT2")
        info.type, info.linkname = kind, "/etc/passwd"
        archive.addfile(info)
    return buffer.getvalue()


def encrypted() -> bytes:
    data = bytearray(zipped(("some.AT2", AT2)))
    central = data.rindex(b"PK\x01\x02")
    data[central + 8] |= 1
    return bytes(data)


REFUSED = {
    "two files": (zipped(("a.AT2", AT2), ("b.AT2", AT2)), "an archive of several files, a.AT2, b"),
    "nothing": (zipped(), "an archive without files"),
    "folder": (tarred(mode="w"), "an archive without files|cannot be unpacked|binary data"),
    "absolute": (zipped(("/etc/a.AT2", AT2)), "a name that leads out of the archive"),
    "upwards": (zipped(("x/../../a.AT2", AT2)), "a name that leads out of the archive"),
    "backwards": (zipped(("..\\a.AT2", AT2)), "a name that leads out of the archive"),
    "drive": (tarred(("C:/a.AT2", AT2)), "a name that leads out of the archive"),
    "symbolic link": (linked(tarfile.SYMTYPE), "a link"),
    "hard link": (linked(tarfile.LNKTYPE), "a link"),
    "device": (linked(tarfile.CHRTYPE), "no ordinary file"),
    "nested twice": (
        zipped(("b.zip", zipped(("c.zip", zipped(("a.AT2", AT2)))))),
        "packed inside an archive; unpack that one first",
    ),
    "packed in tar": (tarred(("a.gz", gzip.compress(AT2))), "packed inside an archive"),
    "damaged inside": (zipped(("b.zip", zipped(("a.AT2", AT2))[:-30])), "cannot be unpacked"),
    "packed twice": (gzip.compress(gzip.compress(AT2)), "packed twice"),
    "encrypted": (encrypted(), "an encrypted file"),
    "method": (
        zipped(("a.AT2", AT2), method=zipfile.ZIP_LZMA),
        r"a method that is not read \(number 14\)",
    ),
    "xz": (lzma.compress(AT2), "packed by xz"),
    "bzip2": (bz2.compress(AT2), "packed by bzip2"),
    "7z": (b"7z\xbc\xaf\x27\x1c" + bytes(30), "a 7z archive"),
    "cut gzip": (gzip.compress(AT2)[:-20], "gzip file that cannot be unpacked"),
    "cut zip": (zipped(("a.AT2", AT2))[:-30], "archive that cannot be unpacked"),
    "web page": (gzip.compress(b"<!doctype html><html></html>"), "web page"),
}


@pytest.mark.parametrize("name", REFUSED)
def test_invalid_archives_are_refused(name, tmp_path):
    data, words = REFUSED[name]
    path = tmp_path / "given"
    path.write_bytes(data)
    for source in (path, data, io.BytesIO(data)):
        with pytest.raises(RecordError, match=words):
            GroundMotion.read(source)
    assert not list(tmp_path.glob("*.AT2"))


def test_open_files_that_cannot_be_read(tmp_path):
    closed = io.BytesIO(AT2)
    closed.close()
    with pytest.raises(RecordError, match="an open file that cannot be read"):
        GroundMotion.read(closed)
    with (tmp_path / "w").open("wb") as file, pytest.raises(RecordError, match="cannot be read"):
        GroundMotion.read(file)

    class InvalidFile:
        def read(self, count):
            return 3.0

    with pytest.raises(RecordError, match="gives float"):
        GroundMotion.read(InvalidFile())
