"""Machine code on disk: shared with other processes, and compiled again if a source changes."""

import importlib
import os
import re
import subprocess
import sys
import time
import zipfile
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from rockframe.compiled import (
    COMPILED,
    Vector,
    compiled_within,
    compiling_for,
    entry,
    store,
)

pytestmark = [
    pytest.mark.unit,
    pytest.mark.skipif(not COMPILED, reason="compilation is off in this run"),
]

HELP = """
from rockframe.compiled import kernel

@kernel
def twice(x: float) -> float:
    return 2.0 * x
"""
OWN = """
from typing import NamedTuple
from own_help import twice
from rockframe.compiled import Vector, entry, kernel

class Law(NamedTuple):
    slope: float

    @kernel
    def doubled_at(self, x: float) -> float:
        return twice(self.slope * x)

@entry
def apply_law(law: Law, values: Vector) -> None:
    for i in range(len(values)):
        values[i] = law.doubled_at(values[i])

@entry
def add_one(values: Vector) -> None:
    values[0] += 1.0
"""
RUN = """
import logging, sys
logging.basicConfig(stream=sys.stdout, format="%(message)s")
import numpy as np
import own
if "reuse" in sys.argv:
    from numba.core import compiler
    compiler.compile_extra = None
values = np.array([1.0, -3.0])
own.apply_law(own.Law(1.5), values)
own.add_one(values)
print(values.tolist())
"""
ANNOUNCEMENT = "rockframe compiles what this needs for this machine"


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch):
    monkeypatch.setenv("ROCKFRAME_CACHE_DIR", str(tmp_path / "code"))
    return tmp_path / "code"


@pytest.fixture
def own(tmp_path, monkeypatch):
    """Return a folder with two user modules."""
    (tmp_path / "own.py").write_text(OWN)
    (tmp_path / "own_help.py").write_text(HELP)
    path = os.pathsep.join([str(tmp_path), *filter(None, [os.environ.get("PYTHONPATH")])])
    monkeypatch.setenv("PYTHONPATH", path)
    monkeypatch.setenv("PYTHONDONTWRITEBYTECODE", "1")  # a source may change within one second
    return tmp_path


def edit(file, old, new):
    text = file.read_text()
    assert text.count(old) == 1
    file.write_text(text.replace(old, new))


def start(*arguments):
    return subprocess.Popen(
        [sys.executable, "-c", RUN, *arguments], text=True, stdout=subprocess.PIPE
    )


def lines_of(process):
    lines = process.communicate(timeout=120)[0].splitlines()
    assert process.returncode == 0
    return lines


def run(*arguments):
    return lines_of(start(*arguments))


def written(folder):
    return sorted(path for path in folder.rglob("*") if path.is_file())


def test_stored_code_is_reused_until_source_changes(own, folder):
    first = run()
    assert first[0].startswith(ANNOUNCEMENT)
    assert first[1:] == ["[4.0, -9.0]"]
    before = {path: path.stat().st_mtime_ns for path in written(folder)}
    assert run("reuse") == first[1:]
    assert {path: path.stat().st_mtime_ns for path in written(folder)} == before
    edit(own / "own_help.py", "2.0 * x", "20.0 * x")
    changed = run()
    assert changed[0].startswith(ANNOUNCEMENT)
    assert changed[1:] == ["[31.0, -90.0]"]
    assert before.keys() < set(written(folder))


@pytest.mark.long
def test_processes_that_start_at_once_do_not_harm_each_other(own, folder):
    for process in [start() for _ in range(2)]:
        assert lines_of(process)[-1] == "[4.0, -9.0]"
    assert run("reuse") == ["[4.0, -9.0]"]
    assert {path.suffix for path in written(folder)} == {".py", ".nbc", ".nbi", ".crc"}


@pytest.mark.parametrize("suffix", [".nbc", ".nbi", ".crc", ".py"])
def test_damaged_files_are_compiled_anew(own, folder, suffix):
    *_, result = run()
    files = [file for file in written(folder) if file.suffix == suffix]
    assert len(files) == 2
    for file in files:
        content = bytearray(file.read_bytes())
        instructions = max(content.find(b"\x7fELF"), 0) + 64  # where an object file has them
        content[instructions : instructions + 8] = bytes(8)
        file.write_bytes(content)
    *_, again = run()
    assert again == result
    assert run("reuse") == [result]


def test_code_of_a_process_killed_before_its_checksum_was_written_is_not_loaded(own, folder):
    *_, result = run()
    for file in written(folder):
        if file.suffix == ".crc":
            file.unlink()
        elif file.suffix == ".nbc":
            os.truncate(file, 1000)
    first, *_, again = run()
    assert first.startswith(ANNOUNCEMENT)
    assert again == result
    assert run("reuse") == [result]


def test_helper_compiles_importable_functions(own, folder, monkeypatch):
    from rockframe.compiled import parallel
    from rockframe.compiled.jobs import Job

    monkeypatch.setattr(parallel, "processors", lambda: 2)
    job = Job(load(own, monkeypatch).add_one.source, (("float64", 1, True),), False)
    with parallel._start_helper([job, job]) as helper:  # it would not start for one job
        assert helper.wait(timeout=120) == 0
    assert job.is_stored
    values = np.array([1.0])
    job.make()(values)
    assert values.tolist() == [2.0]


def test_functions_helper_cannot_import_are_still_compiled(monkeypatch):
    from rockframe.compiled import parallel
    from rockframe.compiled.jobs import Job

    monkeypatch.setattr(parallel, "processors", lambda: 2)
    structure = (("float64", 1, True),)
    jobs = [Job(function.source, structure, False) for function in (add_two, add_three)]
    monkeypatch.delitem(sys.modules, __name__, raising=False)
    values = np.zeros(1)
    for routine in parallel.compile_all(jobs):
        routine(values)
    assert values.tolist() == [5.0]


def test_estimated_wall_time_counts_shared_functions_per_job(monkeypatch):
    from rockframe.compiled import parallel

    monkeypatch.setattr(parallel, "estimate_seconds", lambda jobs: 4.0)  # the jobs share 1 s
    jobs = [SimpleNamespace(is_stored=False, seconds=seconds) for seconds in (2.0, 3.0)]
    monkeypatch.setattr(parallel, "processors", lambda: 1)
    assert parallel.estimate_wall_time(jobs) == pytest.approx(4.0 + parallel.REPEAT_RATIO)
    monkeypatch.setattr(parallel, "processors", lambda: 8)
    assert parallel.estimate_wall_time(jobs) == 3.0  # the longest


def test_jobs_compiled_elsewhere_are_done_last(monkeypatch):
    from rockframe.compiled import parallel

    order = []

    def job(name):
        return SimpleNamespace(
            file=name, is_stored=False, seconds=0.1, make=lambda _: order.append(name) or name
        )

    monkeypatch.setattr(parallel, "_start_helper", lambda jobs: None)
    monkeypatch.setattr(store, "is_compiled_elsewhere", lambda file: file == "first")
    assert parallel.compile_all([job("first"), job("second")]) == ["first", "second"]
    assert order == ["second", "first"]


@pytest.mark.parametrize(("ends", "waits"), [("0", True), ("1", False)])
def test_dead_helper_ends_waiting(monkeypatch, ends, waits):
    from rockframe.compiled import parallel

    helper = subprocess.Popen([sys.executable, "-c", f"raise SystemExit({ends})"])
    monkeypatch.setattr(parallel, "_start_helper", lambda jobs: helper)
    with parallel._with_helper([]) as waiting:
        helper.wait(timeout=120)
        assert waiting() is waits


def load(own, monkeypatch):
    """Import the user module."""
    for name in ("own", "own_help"):
        monkeypatch.delitem(sys.modules, name, raising=False)
    monkeypatch.syspath_prepend(own)
    return importlib.import_module("own")


def some_function():
    """Represent a compiled function."""


def test_every_state_of_the_sources_has_a_folder_of_its_own(own, tmp_path, monkeypatch):
    package = tmp_path / "package"
    for name in (
        "constants.py",
        "compiled/language.py",
        "dynamics/single_body.py",
        "dynamics/a/b.py",
    ):
        (package / name).parent.mkdir(parents=True, exist_ok=True)
        (package / name).write_text("A = 1\n")
    monkeypatch.setattr(store, "PACKAGE", package)
    monkeypatch.setattr(store, "_package_digest", store._package_digest.__wrapped__)
    module = load(own, monkeypatch)

    def file(text="pass", classes=(module.Law,)):
        return store.module_file(some_function, text, classes)

    first = file()
    assert first == file()
    assert first.read_text() == "pass"
    assert file("return").parent == first.parent
    assert file("return") != first
    folders = {first.parent, file(classes=()).parent}
    edited = [own / "own.py", own / "own_help.py", *package.rglob("*.py")]
    for source in edited:
        edit(source, source.read_text(), source.read_text() + "\n# edited")
        folders.add(file().parent)
    assert len(folders) == 2 + len(edited)
    # other files of the package are not compiled
    (package / "system").mkdir()
    (package / "system" / "scenes.py").write_text("A = 1\n")
    assert file().parent in folders
    # a notebook has no file that could be compared
    monkeypatch.delattr(module, "__file__")
    assert file() is None


def test_sources_in_archives_differ_and_without_sources_nothing_is_kept(tmp_path, monkeypatch):
    monkeypatch.setattr(store, "_package_digest", store._package_digest.__wrapped__)
    folders = set()
    for text in ("A = 1\n", "A = 2\n"):
        with zipfile.ZipFile(tmp_path / "package.zip", "w") as archive:
            archive.writestr("package/dynamics/a/b.py", text)
        with zipfile.ZipFile(tmp_path / "package.zip") as archive:
            monkeypatch.setattr(store, "PACKAGE", zipfile.Path(archive, "package/"))
            folders.add(store.module_file(some_function, "pass", ()).parent)
    assert len(folders) == 2
    monkeypatch.setattr(store, "PACKAGE", tmp_path / "frozen")
    assert store.module_file(some_function, "pass", ()) is None


def test_editing_entry_module_changes_folder(own, monkeypatch):
    module = load(own, monkeypatch)
    before = store.module_file(module.add_one.__wrapped__, "pass", ())
    edit(own / "own.py", "+= 1.0", "+= 5.0")
    assert store.module_file(module.add_one.__wrapped__, "pass", ()).parent != before.parent


def test_editing_module_used_as_attribute_changes_folder(own, monkeypatch):
    edit(own / "own.py", "from own_help import twice", "import own_help")
    edit(own / "own.py", "twice(", "own_help.twice(")
    module = load(own, monkeypatch)
    before = store.module_file(some_function, "pass", (module.Law,))
    edit(own / "own_help.py", "2.0 * x", "20.0 * x")
    assert store.module_file(some_function, "pass", (module.Law,)).parent != before.parent


def test_changed_bytes_of_imported_library_change_folder(own, monkeypatch):
    (own / "own_library.so").write_bytes(b"\x7fELF\0one")
    library = SimpleNamespace(__file__=str(own / "own_library.so"))
    monkeypatch.setitem(sys.modules, "own_library", library)
    edit(
        own / "own.py",
        "from own_help import twice",
        "import own_library\nfrom own_help import twice",
    )
    module = load(own, monkeypatch)
    before = store.module_file(some_function, "pass", (module.Law,))
    (own / "own_library.so").write_bytes(b"\x7fELF\0other")
    assert store.module_file(some_function, "pass", (module.Law,)).parent != before.parent


def test_digest_covers_all_compiled_package_sources():
    marks = re.compile(r"^\s*@(kernel|inlined|entry)\b", re.MULTILINE)
    included = {
        file for place in store._SOURCES for file in store._modules_in(store.PACKAGE / place)
    }
    marked = {path for path in store.PACKAGE.rglob("*.py") if marks.search(path.read_text())}
    assert len(marked) > 20
    assert marked <= included


def test_code_of_other_sources_is_removed_after_a_month(folder):
    times = {"code-old": time.time() - 40 * 24 * 3600.0, "code-young": time.time() - 3600.0}
    for name, moment in times.items():
        cache = folder / name / "__pycache__"
        cache.mkdir(parents=True)
        (cache / "some.nbc").write_bytes(b"code")
        os.utime(folder / name, (moment, moment))
    file = store.module_file(some_function, "pass", ())
    assert {path.name for path in folder.iterdir()} == {"code-young", file.parent.name}


@entry
def add_two(values: Vector) -> None:
    values[0] += 2.0


@entry
def add_three(values: Vector) -> None:
    values[0] += 3.0


@entry
def add_four(values: Vector) -> None:
    values[0] += 4.0


@entry
def add_five(values: Vector) -> None:
    values[0] += 5.0


@entry
def add_six(values: Vector) -> None:
    values[0] += 6.0


@entry
def add_seven(values: Vector) -> None:
    values[0] += 7.0


def test_unwritable_cache_only_warns(tmp_path, monkeypatch, caplog):
    from rockframe.compiled import parallel

    monkeypatch.setattr(parallel, "_announced", set())
    blocked = tmp_path / "a file, no folder"
    blocked.write_text("")
    monkeypatch.setenv("ROCKFRAME_CACHE_DIR", str(blocked))
    values = np.zeros(1)
    add_two(values)
    add_three(values)
    assert values.tolist() == [5.0]
    assert len(caplog.messages) == 1
    assert all(routine.code for add in (add_two, add_three) for routine in add._routines.values())


def test_long_compilation_is_announced_with_purpose(monkeypatch, caplog):
    from rockframe.compiled import parallel
    from rockframe.compiled.jobs import Job

    def announcements(words, called, seconds):
        monkeypatch.setattr(Job, "seconds", seconds)
        with compiling_for(words):
            called(np.zeros(1))
        messages = [text for text in caplog.messages if "compiles what" in text]
        caplog.clear()
        return messages

    monkeypatch.setattr(parallel, "_announced", set())
    text = "rockframe compiles what a run (pads) needs for this machine: about 1 s where nothing"
    assert announcements("a run (pads)", add_four, 0.1)[0].startswith(text)
    assert announcements("a run (pads)", add_four, 30.0) == []
    assert announcements("a run (pads)", add_five, 0.1) == []  # too short to notice
    [text] = announcements("lanes (soil)", add_six, 30.0)
    assert text.startswith(
        "rockframe compiles what lanes (soil) needs for this machine: about 30 s"
    )


def test_compilation_beyond_time_budget_is_skipped(folder, monkeypatch):
    from rockframe.compiled.jobs import Job

    monkeypatch.setattr(Job, "seconds", 10.0)
    values = np.zeros(1)
    assert not compiled_within(9.0, add_seven, values)
    assert not any(routine.code for routine in add_seven._routines.values())
    assert not list(folder.rglob("*.nbc"))
    assert compiled_within(11.0, add_seven, values)
    assert list(folder.rglob("*.nbc"))
    assert compiled_within(0.0, add_seven, values)  # already compiled
    add_seven._routines.clear()
    assert compiled_within(0.0, add_seven, values)  # and stored for other processes
    add_seven(values)
    assert values.tolist() == [7.0]


def test_next_cache_folder_replaces_unusable_first(tmp_path, monkeypatch):
    monkeypatch.delenv("ROCKFRAME_CACHE_DIR")
    for variable in ("XDG_CACHE_HOME", "LOCALAPPDATA", "HOME"):
        monkeypatch.setenv(variable, str(tmp_path / "own"))
    monkeypatch.setattr(store, "PACKAGE", tmp_path / "package")
    monkeypatch.setattr(store, "_package_digest", lambda: b"some sources")
    first = store.module_file(some_function, "pass", ())
    assert first.is_relative_to(tmp_path / "own")
    assert not (tmp_path / "package").exists()
    (tmp_path / "own").rename(tmp_path / "away")
    Path(tmp_path / "own").write_text("")
    second = store.module_file(some_function, "pass", ())
    assert second.is_relative_to(tmp_path / "package" / "__pycache__")
    assert second.read_text() == "pass"


def test_missing_home_folder_is_skipped_for_cache(monkeypatch):
    def homeless(path):
        msg = "Could not determine home directory."
        raise RuntimeError(msg)

    monkeypatch.delenv("ROCKFRAME_CACHE_DIR", raising=False)
    usual = store.cache_folders()
    monkeypatch.setattr(Path, "expanduser", homeless)
    assert store.cache_folders() == usual[1:]
