"""Machine code on disk: what is written is read, what is damaged or out of date is not."""

import os
import stat
import sys

import pytest

from rockframe.compiled import store

NAME, MAKER = "rockframe.some.function", "a compiler for a processor"
CODE = bytes(range(256)) * 7


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch):
    monkeypatch.setenv("ROCKFRAME_CACHE_DIR", str(tmp_path / "code"))
    return tmp_path / "code"


def written(folder):
    return sorted(path.name for path in folder.iterdir())


def test_what_is_written_is_read():
    assert store.read(NAME, MAKER) is None
    store.write(NAME, MAKER, CODE)
    assert store.read(NAME, MAKER) == CODE


def test_another_function_or_maker_has_its_own(folder):
    store.write(NAME, MAKER, CODE)
    assert store.read(f"{NAME}s", MAKER) is None
    assert store.read(NAME, f"{MAKER} of another sort") is None
    store.write(f"{NAME}s", MAKER, CODE[:10])
    assert store.read(NAME, MAKER) == CODE
    assert len(written(folder)) == 2


@pytest.mark.parametrize("damage", ["cut", "changed", "emptied"])
def test_damaged_code_is_not_used(folder, damage):
    store.write(NAME, MAKER, CODE)
    (file,) = folder.iterdir()
    content = bytearray(file.read_bytes())
    if damage == "cut":
        content = content[:-5]
    elif damage == "changed":
        content[100] ^= 1
    else:
        content.clear()
    file.write_bytes(content)
    assert store.read(NAME, MAKER) is None
    store.write(NAME, MAKER, CODE)
    assert store.read(NAME, MAKER) == CODE


def test_a_changed_source_makes_it_stale_and_replaces_it(folder, monkeypatch):
    store.write(NAME, MAKER, CODE)
    before = written(folder)
    monkeypatch.setattr(store, "_sources", lambda: "edited")
    assert store.read(NAME, MAKER) is None
    store.write(NAME, MAKER, CODE[::-1])
    assert store.read(NAME, MAKER) == CODE[::-1]
    assert len(written(folder)) == 1
    assert written(folder) != before


def test_the_text_of_a_source_counts(tmp_path, monkeypatch):
    monkeypatch.setattr(store, "_ROOT", tmp_path)
    monkeypatch.setattr(store, "_files", store._files.__wrapped__)
    source = tmp_path / "dynamics" / "some.py"
    source.parent.mkdir()
    digests = set()
    for text in ("a = 1", "a = 2"):
        source.write_text(text)
        digests.add(store._sources.__wrapped__())
    source.rename(source.with_name("other.py"))
    digests.add(store._sources.__wrapped__())
    assert len(digests) == 3


def test_another_numba_has_its_own(monkeypatch):
    numba = pytest.importorskip("numba")
    assert numba.__version__ in store._numba()
    store.write(NAME, MAKER, CODE)
    monkeypatch.setattr(store, "_numba", lambda: "a later one")
    assert store.read(NAME, MAKER) is None


def test_every_source_that_is_compiled_counts():
    from rockframe.compiled import registry
    from rockframe.dynamics import coupled, rigid_ground, two_spring, winkler
    from rockframe.signals import oscillator
    from rockframe.solve import driver

    for module in (coupled, rigid_ground, two_spring, winkler, oscillator, driver):
        assert store.knows(module.__file__)
    for function in (*registry.KERNELS, *registry.CALLBACKS):
        if function.__module__.startswith("rockframe."):
            assert store.knows(function.__code__.co_filename), function.__module__
    assert not store.knows(__file__)


@pytest.mark.skipif(sys.platform == "win32", reason="permissions of another kind")
def test_others_may_read_what_the_user_lets_them(folder):
    mask = os.umask(0o022)
    try:
        store.write(NAME, MAKER, CODE)
    finally:
        os.umask(mask)
    (file,) = folder.iterdir()
    assert stat.S_IMODE(file.stat().st_mode) == 0o644


def test_where_nothing_can_be_written_nothing_is(tmp_path, monkeypatch):
    blocked = tmp_path / "a file, no folder"
    blocked.write_text("")
    monkeypatch.setenv("ROCKFRAME_CACHE_DIR", str(blocked))
    store.write(NAME, MAKER, CODE)
    assert store.read(NAME, MAKER) is None


def test_one_folder_is_written_to(tmp_path, monkeypatch):
    folders = [tmp_path / "one", tmp_path / "other"]
    monkeypatch.setattr(store, "_folders", lambda: folders)
    store.write(NAME, MAKER, CODE)
    assert len(written(folders[0])) == 1
    assert not folders[1].exists()


def test_the_next_folder_serves_where_the_first_cannot(tmp_path, monkeypatch):
    monkeypatch.delenv("ROCKFRAME_CACHE_DIR")
    blocked = tmp_path / "a file, no folder"
    blocked.write_text("")
    monkeypatch.setattr(store, "_ROOT", blocked)
    for variable in ("XDG_CACHE_HOME", "LOCALAPPDATA", "HOME"):
        monkeypatch.setenv(variable, str(tmp_path / "own"))
    store.write(NAME, MAKER, CODE)
    assert store.read(NAME, MAKER) == CODE
