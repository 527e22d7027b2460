"""One process compiles a module at a time, and none waits for a killed process."""

import errno
import os
import subprocess
import sys
import time

import pytest

from rockframe.compiled import store

pytestmark = pytest.mark.unit

AT_ONCE = 5.0
"""Less than a process waits for another that does not end, on a slow machine too [s]."""

KEEP = """
import sys, time
from pathlib import Path
from rockframe.compiled.store import lock_while_compiling

module = Path(sys.argv[1])
with lock_while_compiling(module, lambda: True):
    print("begun", flush=True)
    time.sleep(float(sys.argv[2]))
    module.with_suffix(".nbc").touch()
"""


@pytest.fixture
def module(tmp_path):
    file = tmp_path / "run.py"
    file.write_text("pass")
    return file


@pytest.fixture
def no_locks(monkeypatch):
    """Replace a network folder without locks."""

    def refuse(number):
        raise OSError(errno.ENOLCK, "No locks available")

    monkeypatch.setattr(store, "_lock", refuse)


def keep(module, seconds):
    """Start another process that compiles for `seconds`, and wait until it has begun."""
    process = subprocess.Popen(
        [sys.executable, "-c", KEEP, str(module), str(seconds)], text=True, stdout=subprocess.PIPE
    )
    assert process.stdout.readline() == "begun\n"
    return process


def seconds_until_compiled(module):
    start = time.monotonic()
    with store.lock_while_compiling(module, lambda: True):
        return time.monotonic() - start


def test_lock_of_killed_process_does_not_delay(module):
    with keep(module, 600) as process:
        assert store.is_compiled_elsewhere(module)
        process.kill()
    assert not store.is_compiled_elsewhere(module)
    assert seconds_until_compiled(module) < AT_ONCE


def test_lock_file_is_ignored_where_locks_exist(module):
    module.with_suffix(".lock").touch()
    assert not store.is_compiled_elsewhere(module)
    assert seconds_until_compiled(module) < AT_ONCE


@pytest.mark.wide
def test_two_processes_do_not_compile_at_once(module):
    with keep(module, 1.0), store.lock_while_compiling(module, lambda: True):
        assert module.with_suffix(".nbc").exists()
    assert {path.suffix for path in module.parent.iterdir()} == {".py", ".nbc"}
    assert module.read_text() == "pass"


def test_waiting_for_lock_ends_when_no_longer_worthwhile(module):
    answers = iter([True, True, False])
    with keep(module, 600) as process:
        with store.lock_while_compiling(module, lambda: next(answers)):
            assert store.is_compiled_elsewhere(module)
        assert store.is_compiled_elsewhere(module)
        process.kill()


def test_unwritable_folder_does_not_delay(tmp_path):
    missing = tmp_path / "nowhere" / "run.py"
    assert not store.is_compiled_elsewhere(missing)
    assert seconds_until_compiled(missing) < AT_ONCE


@pytest.mark.usefixtures("no_locks")
def test_lock_file_replaces_missing_locks(module):
    assert not store.is_compiled_elsewhere(module)
    with store.lock_while_compiling(module, lambda: True):
        assert store.is_compiled_elsewhere(module)
        assert store.lock(module) is None
    assert not store.is_compiled_elsewhere(module)
    assert list(module.parent.iterdir()) == [module]


@pytest.mark.usefixtures("no_locks")
def test_old_lock_file_expires(module):
    mark = module.with_suffix(".lock")
    mark.touch()
    assert store.is_compiled_elsewhere(module)
    old = time.time() - 2.0 * store.LOCK_TIMEOUT
    os.utime(mark, (old, old))
    assert seconds_until_compiled(module) < AT_ONCE
    assert not mark.exists()
