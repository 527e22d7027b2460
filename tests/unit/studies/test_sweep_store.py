"""The folder of a stored sweep: contents, resumption, damage, and other studies."""

import os
import time

import numpy as np
import pytest
from stored_sweep import BLOCK, PULSE, RECORD, SCALES, as_bytes, run_sweep, stored_files

import rockframe as rf
from rockframe.errors import ModelWarning, SolverWarning, StudyError
from rockframe.results.variables.runs import RunStatus
from rockframe.studies.sweeps import store
from rockframe.studies.sweeps import study as studies_at_hand
from rockframe.studies.sweeps.store import read_arrays, write_arrays, write_atomically
from rockframe.version import __version__

pytestmark = pytest.mark.filterwarnings("ignore::rockframe.errors.SolverWarning")


@pytest.fixture(scope="module")
def complete(tmp_path_factory):
    folder = tmp_path_factory.mktemp("whole") / "study"
    return folder, run_sweep(folder)


def test_stored_sweep_equals_sweep_in_memory(complete):
    folder, runs = complete
    plain = run_sweep()
    assert as_bytes(runs) == as_bytes(plain)
    assert {**runs.attrs, "history": ""} == {**plain.attrs, "history": ""}
    assert rf.open_study(folder).identical(runs)
    before = stored_files(folder)
    begun = time.process_time()
    assert run_sweep(folder, chunk=1000).identical(runs)  # stored chunks keep their size
    assert time.process_time() - begun < 5.0
    assert stored_files(folder) == before
    assert not list(folder.glob(".*"))


@pytest.mark.wide
def test_many_chunks_stand_in_folders_of_their_own(tmp_path, monkeypatch):
    folder, plain = tmp_path / "study", run_sweep()
    monkeypatch.setattr(store, "MAX_FILES_PER_FOLDER", 4)
    assert as_bytes(run_sweep(folder)) == as_bytes(plain)
    assert not list(folder.glob("chunk-*"))
    folders = sorted(folder.glob("chunks-*"))
    counts = [len(list(one.iterdir())) for one in folders]
    assert set(counts[:-1]) == {4}
    assert 1 <= counts[-1] <= 4
    (folders[1] / "chunk-000005.arrays").unlink()
    left = folders[1] / ".chunk-000005.arrays.1.part"
    left.write_bytes(b"")
    os.utime(left, (0, 0))
    assert as_bytes(run_sweep(folder)) == as_bytes(plain)
    assert not left.exists()
    assert as_bytes(rf.open_study(folder)) == as_bytes(plain)


def test_it_can_be_read_while_it_runs(tmp_path):
    folder = tmp_path / "study"
    counts = []

    def scene(height):
        if (folder / "study.json").exists():
            counts.append(int((rf.open_study(folder).status != RunStatus.NOT_RUN).sum()))
        return rf.System(BLOCK.replace(height=height))

    rf.sweep(scene, PULSE, height=(np.linspace(3, 4, 12), "m"), chunk=1, store=folder)
    assert len(counts) == 12
    assert 0 < max(counts) < 12  # either of two threads may read first


def test_a_folder_that_is_renamed_while_it_runs_is_not_made_again(tmp_path):
    folder, moved = tmp_path / "study", tmp_path / "moved"

    def scene(height):
        if (folder / "chunk-000001.arrays").exists():
            folder.rename(moved)
        return rf.System(BLOCK.replace(height=height))

    with pytest.raises(StudyError, match="cannot be written"):
        rf.sweep(scene, PULSE, height=(np.linspace(3, 4, 12), "m"), chunk=1, store=folder)
    assert not folder.exists()
    assert (moved / "chunk-000001.arrays").exists()


def test_case_is_restored_from_the_folder_alone(complete, monkeypatch):
    folder, runs = complete
    monkeypatch.setattr(studies_at_hand, "_cache", type(studies_at_hand._cache)())
    for place in (folder, runs):  # a sweep knows its folder
        found = rf.case(place, scale=SCALES[17], height="3.6 m", motion="noise")
        assert found.motion.sha256 == RECORD.scaled(SCALES[17]).sha256
        assert found.simulate().peak_rotation.item() == runs.peak_rotation[17, 1, 0].item()


def test_motions_with_a_vertical_component_are_kept_however_they_were_made(tmp_path, monkeypatch):
    def make(seed):
        return rf.GroundMotion.stochastic(6.6, "5 km", seed=seed, vertical=0.6)

    shaking = make(1)
    stored = tmp_path / "shaking.nc"
    shaking.to_dataset().to_netcdf(stored)
    motions = {
        "of arguments": shaking,
        "of samples": rf.GroundMotion.read(stored),
        "of two": make(2).with_vertical(make(3)),
        "record": RECORD,
        "record with a vertical": RECORD.with_vertical(RECORD.scaled(0.4)),
    }
    system = rf.System(BLOCK, rf.TwoSpringSupport(frequency_ratio=20, damping_ratio=0.1))
    folder = tmp_path / "study"

    def run(**changes):
        return rf.sweep(system, motions, scale=[1, 2], chunk=4, **changes)

    plain, resumable = run(), run(store=folder)
    assert as_bytes(resumable) == as_bytes(plain)
    (folder / "chunk-000001.arrays").unlink()
    assert as_bytes(run(store=folder)) == as_bytes(plain)
    assert as_bytes(rf.open_study(folder)) == as_bytes(plain)
    monkeypatch.setattr(studies_at_hand, "_cache", type(studies_at_hand._cache)())
    for name, motion in motions.items():
        found = rf.case(folder, scale=2.0, motion=name)
        assert found.motion.sha256 == motion.scaled(2.0).sha256
        again = found.simulate(outputs=None).peak_rotation.item()
        assert again == plain.peak_rotation.sel(scale=2.0, motion=name).item()


@pytest.fixture
def copied(complete, tmp_path):
    folder = tmp_path / "study"
    folder.mkdir()
    for path in complete[0].iterdir():
        (folder / path.name).write_bytes(path.read_bytes())
    return folder


def test_another_study_is_refused_with_the_difference(copied):
    for changes, words in (
        ({"scale": SCALES[:-1]}, r"differs in grid \(axes \(scale \(values\)\)\)"),
        ({"accuracy": "fast"}, r"arguments \(accuracy \(.*\), accuracy_name\)"),
        ({"outputs": ["rotation", "base_shear"]}, r"differs in histories \(names\)"),
    ):
        with pytest.raises(StudyError, match=f"another study.*{words}.*another folder"):
            run_sweep(copied, **changes)


def test_another_function_is_another_study(tmp_path):
    scenes = [lambda height: rf.System(BLOCK.replace(height=height))]
    scenes.append(lambda height: rf.System(BLOCK.replace(height=height), gravity="9 m/s^2"))
    arguments = {"height": ["3 m"], "store": tmp_path / "study"}
    rf.sweep(scenes[0], PULSE, **arguments)
    with pytest.raises(StudyError, match=r"differs in scene \(function \(source\)\), scenes"):
        rf.sweep(scenes[1], PULSE, **arguments)


def test_other_versions_and_damaged_files_are_refused_with_a_reason(copied):
    head, chunk = copied / "study.json", copied / "chunk-000004.arrays"
    keep, plain = head.read_text(), chunk.read_bytes()
    for content, words in (
        (
            keep.replace('"format": 3', '"format": 5'),
            r"\(format 5\), which this version cannot read",
        ),
        (keep[:300], "study.json: damaged"),
        (keep.replace('"cases":', '"kases":'), "entries are missing"),
        ("", "study.json: damaged"),
    ):
        head.write_text(content)
        for read in (rf.open_study, run_sweep):
            with pytest.raises(StudyError, match=words):
                read(copied)
    head.write_text(keep)
    flipped = bytearray(plain)
    flipped[len(plain) // 2] ^= 1
    other = (copied / "chunk-000005.arrays").read_bytes()
    for content, words in (
        (plain[: len(plain) // 2], r"chunk-000004.arrays: damaged.*remove the file"),
        (plain[:-1], "damaged"),
        (plain + b"\0", "damaged"),
        (bytes(flipped), "damaged"),
        (b"", "found no file of a study.*remove the file"),
        (other, "found a chunk of another study; expected.*cases 12 to 14"),
    ):
        chunk.write_bytes(content)
        for read in (rf.open_study, run_sweep):
            with pytest.raises(StudyError, match=words):
                read(copied)
    chunk.unlink()
    assert (rf.open_study(copied).status == RunStatus.NOT_RUN).sum() == 3
    run_sweep(copied)
    assert chunk.read_bytes() == plain
    (copied / "labels.arrays").unlink()
    with pytest.raises(StudyError, match=r"labels.arrays cannot be read"):
        rf.open_study(copied)


def test_damaged_labels_raise_and_are_rebuilt(copied, complete):
    labels = copied / "labels.arrays"
    plain = labels.read_bytes()
    labels.write_bytes(plain[:-1])
    with pytest.raises(StudyError, match=r"labels.arrays: damaged.*remove the file, and the same"):
        run_sweep(copied)
    labels.unlink()
    with pytest.raises(StudyError, match="another study"):
        run_sweep(copied, accuracy="fast")
    assert not labels.exists()
    assert as_bytes(run_sweep(copied)) == as_bytes(complete[1])
    assert labels.read_bytes() == plain


def test_labels_of_another_study_are_refused(copied, tmp_path):
    other, labels = tmp_path / "other", copied / "labels.arrays"
    run_sweep(other, scale=SCALES + 1.0)
    labels.write_bytes((other / "labels.arrays").read_bytes())
    for read in (rf.open_study, run_sweep):
        with pytest.raises(StudyError, match=r"labels of another study.*remove the file"):
            read(copied)
    labels.unlink()
    assert run_sweep(copied).scale.values.tolist() == SCALES.tolist()


@pytest.mark.parametrize("lazy", [False, True])
def test_a_file_of_a_study_in_the_place_of_another_is_refused(copied, complete, lazy):
    labels, chunk = copied / "labels.arrays", copied / "chunk-000004.arrays"
    kept = {file: file.read_bytes() for file in (labels, chunk)}
    for file, other, words in (
        (labels, chunk, "labels of another study"),
        (chunk, labels, "a chunk of another study"),
    ):
        file.write_bytes(kept[other])
        with pytest.raises(StudyError, match=words):
            rf.open_study(copied, lazy=lazy).load()
        file.write_bytes(kept[file])
    chunk.with_name("chunk-000099.arrays").write_bytes(kept[labels])  # none of its own
    found = rf.open_study(copied, lazy=lazy).peak_rotation
    np.testing.assert_array_equal(found, complete[1].peak_rotation)


def test_of_two_studies_begun_at_once_in_a_folder_the_first_keeps_its_labels(tmp_path, monkeypatch):
    folder, plain, first = tmp_path / "study", write_atomically, []

    def write(path, *arguments, **options):
        if not first:
            first.append(path)
            run_sweep(folder, scale=SCALES[:3])
        plain(path, *arguments, **options)

    monkeypatch.setattr(store, "write_atomically", write)
    with pytest.raises(StudyError, match="another study"):
        run_sweep(folder, scale=SCALES[3:6])
    assert rf.open_study(folder).scale.values.tolist() == SCALES[:3].tolist()


def test_study_of_another_version_can_be_read_but_not_resumed(copied, complete):
    head, last = copied / "study.json", copied / "chunk-000039.arrays"
    head.write_text(
        head.read_text().replace(
            f'"rockframe_version": "{__version__}', '"rockframe_version": "0.0.9'
        )
    )
    last.unlink()
    with pytest.raises(StudyError, match=r"of rockframe 0.0.9, whose .* may be others .* not gone"):
        run_sweep(copied)
    assert not last.exists()
    for lazy in (False, True):
        with pytest.warns(ModelWarning, match=r"was run by rockframe 0\.0\.9"):
            found = rf.open_study(copied, lazy=lazy)
        assert found.attrs["rockframe_version"] == "0.0.9"
        assert found.attrs["source"].startswith("rockframe 0.0.9, ")
        finished = found.status != RunStatus.NOT_RUN
        assert int((~finished).sum()) == 3
        expected = complete[1].peak_rotation.where(finished)
        np.testing.assert_array_equal(found.peak_rotation, expected)


def test_a_folder_without_a_study_is_refused(tmp_path):
    with pytest.raises(StudyError, match=r"found no study; expected a folder with study.json"):
        rf.open_study(tmp_path)
    with pytest.raises(StudyError, match="store must be the path of a folder"):
        run_sweep(store=3)
    (tmp_path / "file").write_text("")
    with pytest.raises(StudyError, match="cannot be kept in"):
        run_sweep(tmp_path / "file")


def test_a_folder_may_be_in_that_of_the_user(copied, monkeypatch):
    for variable in ("HOME", "USERPROFILE"):
        monkeypatch.setenv(variable, str(copied.parent))
    assert rf.open_study(f"~/{copied.name}").sizes["scale"] == len(SCALES)
    with pytest.raises(StudyError, match="store must be the path of a folder, got '~no user/a'"):
        rf.open_study("~no user/a")


@pytest.mark.skipif(not hasattr(os, "geteuid"), reason="permissions as of Unix")
def test_where_nothing_can_be_written_it_says_so_at_once(tmp_path):
    folder = tmp_path / "closed"
    folder.mkdir()
    folder.chmod(0o555)
    for above in (folder, *folder.parents[:3]):
        if above != folder and str(above) != "/":
            above.chmod(above.stat().st_mode | 0o055)
    user = os.geteuid()
    try:
        if user == 0:
            os.seteuid(65534)  # root may write anywhere
        with pytest.raises(StudyError, match=r"cannot be kept in .*Permission denied"):
            run_sweep(folder / "study")
    finally:
        if user == 0:
            os.seteuid(user)


def test_a_write_that_fails_halfway_leaves_nothing(tmp_path, monkeypatch):
    path = tmp_path / "one.arrays"
    write_arrays(path, {"name": "old"}, {"a": np.arange(3.0)})
    before = path.read_bytes()

    def fails(descriptor):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(os, "fsync", fails)
    with pytest.raises(OSError, match="No space left"):
        write_arrays(path, {"name": "new"}, {"a": np.arange(9.0)})
    assert path.read_bytes() == before
    assert list(tmp_path.iterdir()) == [path]


@pytest.mark.parametrize("links", [True, False])
def test_a_file_that_is_there_is_kept(tmp_path, monkeypatch, links):
    """Of several jobs that make a study at once the first is taken, also without hard links."""

    def refused(*_):
        raise PermissionError

    if not links:
        monkeypatch.setattr(store.Path, "hardlink_to", refused)
    file = tmp_path / "study.json"
    for content, replace, expected in (
        (b"1", False, b"1"),
        (b"2", False, b"1"),
        (b"3", True, b"3"),
    ):
        write_atomically(file, content, replace=replace)
        assert file.read_bytes() == expected
        assert [*tmp_path.iterdir()] == [file]


def test_arrays_come_back_as_they_were(tmp_path):
    path = tmp_path / "one.arrays"
    arrays = {
        "a": np.array([[1.0, np.nan], [-0.0, np.inf]]), "none": np.zeros((0, 3)),
        "b": np.array([1, -2], dtype=np.int8), "c": np.array([True, False]),
    }  # fmt: skip
    write_arrays(path, {"text": "\u03b1\n", "n": None}, arrays)
    described, again = read_arrays(path)
    assert described == {"text": "\u03b1\n", "n": None}
    for name, values in arrays.items():
        assert again[name].dtype == values.dtype
        assert again[name].shape == values.shape
        assert again[name].tobytes() == values.tobytes()
    write_atomically(path, b"x", replace=False)
    assert read_arrays(path)[0] == described


def test_half_written_files_of_the_dead_are_swept_away(copied):
    dead, alive = copied / ".chunk-1.9.aa.part", copied / ".chunk-2.9.bb.part"
    dead.write_text("x")
    alive.write_text("x")
    os.utime(dead, (0, 0))
    run_sweep(copied)
    assert not dead.exists()
    assert alive.exists()


def test_the_warning_is_repeated_when_it_is_resumed(copied):
    with pytest.warns(SolverWarning, match="60 of 120 cases have no result"):
        run_sweep(copied)
