"""A numba that is damaged, turned off or set to another folder; code that can only be read."""

import errno
import os
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
import pytest

from rockframe.compiled import COMPILED, Vector, entry, store

pytestmark = [
    pytest.mark.unit,
    pytest.mark.skipif(not COMPILED, reason="compilation is off in this run"),
]


@entry
def add_one(values: Vector) -> None:
    values[0] += 1.0


@entry
def add_two(values: Vector) -> None:
    values[0] += 2.0


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch):
    from rockframe.compiled import jobs

    monkeypatch.setattr(jobs, "_warned", set())
    monkeypatch.setenv("ROCKFRAME_CACHE_DIR", str(tmp_path / "code"))
    return tmp_path / "code"


def job_of(function):
    from rockframe.compiled.jobs import Job

    return Job(function.source, (("float64", 1, True),), False)


def result_of(job):
    values = np.zeros(1)
    job.make()(values)
    return values[0]


def refuse(*arguments, **words):
    raise PermissionError(errno.EACCES, "Permission denied")


@pytest.fixture
def read_only(folder, monkeypatch):
    """Store the code of one function, and let nothing be written any more."""
    assert result_of(job_of(add_one)) == 1.0
    monkeypatch.setattr(store.os, "utime", refuse)
    monkeypatch.setattr(tempfile, "TemporaryFile", refuse)
    monkeypatch.setattr(Path, "unlink", refuse)
    monkeypatch.setattr(Path, "write_text", refuse)
    return folder


def test_code_that_can_only_be_read_is_used(read_only, monkeypatch):
    from numba.core import compiler

    job = job_of(add_one)
    assert job.is_stored
    assert job_of(add_two).file is None
    monkeypatch.setattr(compiler, "compile_extra", None)
    assert result_of(job) == 1.0


def test_damaged_code_that_can_only_be_read_is_replaced_in_memory(read_only, caplog):
    for file in read_only.rglob("*.nbc"):
        file.write_bytes(file.read_bytes()[:100])
    assert result_of(job_of(add_one)) == 1.0
    (message,) = caplog.messages
    assert "was damaged" in message


def test_full_disk_warns_once(monkeypatch, caplog):
    from numba.core.caching import IndexDataCacheFile

    def fill(self, name, data):
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC), name)

    monkeypatch.setattr(IndexDataCacheFile, "_save_data", fill)
    assert [result_of(job_of(function)) for function in (add_one, add_two)] == [1.0, 2.0]
    (message,) = caplog.messages
    assert os.strerror(errno.ENOSPC) in message


def test_code_is_kept_in_own_folder_whatever_the_folder_of_numba(monkeypatch, tmp_path):
    from numba import config

    monkeypatch.setattr(config, "CACHE_DIR", str(tmp_path / "numba"))
    job = job_of(add_one)
    assert result_of(job) == 1.0
    assert job.is_stored
    assert not (tmp_path / "numba").exists()


def test_code_of_other_compiler_or_processor_is_another_file(monkeypatch):
    from rockframe.compiled import jobs

    job = job_of(add_one)
    assert result_of(job) == 1.0
    monkeypatch.setattr(jobs, "_machine", lambda: "numba 1.0, cpython-399")
    assert job.is_stored
    assert not job_of(add_one).is_stored


@pytest.mark.parametrize(
    ("variables", "words"),
    [
        ({"PYTHONPATH": "broken"}, "numba cannot be imported, and rockframe runs as plain Python"),
        ({"NUMBA_DISABLE_JIT": "1"}, ""),
    ],
)
def test_without_usable_numba_entries_run_as_python(tmp_path, variables, words):
    program = """
import numpy as np
from rockframe.compiled import COMPILED, compiled_within, entry

@entry
def add(values) -> None:
    values[0] += 1.0

values = np.zeros(1)
assert COMPILED and not compiled_within(100.0, add, values)
for _ in range(2):
    add(values)
print(values)
"""
    (tmp_path / "broken" / "numba").mkdir(parents=True)
    (tmp_path / "broken" / "numba" / "__init__.py").write_text("raise ImportError('of another')")
    path = os.pathsep.join([str(tmp_path / variables.get("PYTHONPATH", "")), *sys.path])
    done = subprocess.run(
        [sys.executable, "-c", program], env=os.environ | variables | {"PYTHONPATH": path},
        capture_output=True, text=True, check=True,
    )  # fmt: skip
    assert done.stdout.strip() == "[2.]"
    assert done.stderr.count("plain Python") == bool(words)
    assert words in done.stderr
