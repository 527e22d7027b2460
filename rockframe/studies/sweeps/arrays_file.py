"""Files of arrays: written whole or not at all, and known to be what was written.

The first line has a name, the version of the format, and the sha256 of all that follows: a line of
JSON that describes the arrays, and their bytes, one after the other. The same contents in the
same order give the same bytes; mappings come back in the order in which they were given.
"""

import hashlib
import json
import os
from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path
from typing import Any, Final

import numpy as np

from rockframe.errors import StudyError
from rockframe.results.outcome import Generic

_HEAD: Final = b"rockframe arrays 1 "
_DIGEST: Final = 64
_BLOCK: Final = 4096
"""What file systems usually give out at once [bytes]."""


def write_arrays(path: Path, described: Mapping[str, Any], arrays: Mapping[str, Generic]) -> None:
    """Write a file."""
    plain = {name: _little(values) for name, values in arrays.items()}
    shapes = [[name, values.dtype.str, list(values.shape)] for name, values in plain.items()]
    line = json.dumps({"described": dict(described), "arrays": shapes})
    body = b"".join([line.encode(), b"\n", *(values.tobytes() for values in plain.values())])
    digest = hashlib.sha256(body).hexdigest().encode()
    write_whole(path, b"".join([_HEAD, digest, b"\n", body]))


def read_arrays(path: Path) -> tuple[dict[str, Any], dict[str, Generic]]:
    """Read a file."""
    content = path.read_bytes()
    start = len(_HEAD) + _DIGEST + 1
    if not content.startswith(_HEAD):
        msg = f"{path}: found no file of a study; expected one that begins with {_HEAD.decode()!r}"
        raise StudyError(msg)
    digest, body = content[len(_HEAD) : start - 1], memoryview(content)[start:]
    if hashlib.sha256(body).hexdigest().encode() != digest:
        msg = (
            f"{path}: damaged: its contents ({len(content)} bytes) are not those that were "
            "written; remove the file, and its cases are run again"
        )
        raise StudyError(msg)
    end = content.index(b"\n", start)
    head = json.loads(content[start:end])
    arrays: dict[str, Generic] = {}
    place = end + 1
    for name, kind, shape in head["arrays"]:
        dtype = np.dtype(kind)
        count = int(np.prod(shape, dtype=np.int64))
        arrays[name] = np.frombuffer(content, dtype, count, place).reshape(shape).copy()
        place += count * dtype.itemsize
    return head["described"], arrays


def write_whole(path: Path, content: bytes, *, replace: bool = True) -> bool:
    """Write a file so that others see all of it or nothing, even if this process is killed."""
    part = path.with_name(f".{path.name}.{os.getpid()}.{os.urandom(4).hex()}.part")
    try:
        with part.open("xb") as file:
            file.write(content)
            file.flush()
            os.fsync(file.fileno())
        if replace:
            part.replace(path)
            return True
        return _linked(part, path)
    finally:
        with suppress(OSError):
            part.unlink(missing_ok=True)


def try_to_write(folder: Path) -> None:
    """Write a block into a folder, and take it away again."""
    part = folder / f".{os.getpid()}.{os.urandom(4).hex()}.part"
    try:
        with part.open("xb") as file:
            file.write(bytes(_BLOCK))
    finally:
        with suppress(OSError):
            part.unlink(missing_ok=True)


def _linked(part: Path, path: Path) -> bool:
    """Give a file its name, unless another one has it."""
    try:
        path.hardlink_to(part)
    except FileExistsError:
        return False
    except (OSError, NotImplementedError):  # file systems without links
        if path.exists():
            return False
        part.replace(path)
    return True


def _little(values: Generic) -> Generic:
    return np.ascontiguousarray(values, dtype=values.dtype.newbyteorder("<"))
