"""A stored sweep: killed processes, and disks that are full or read-only."""

import ctypes
import os
import random
import signal
import time
from concurrent.futures import BrokenExecutor, Future, ProcessPoolExecutor, ThreadPoolExecutor
from multiprocessing import get_context, parent_process
from pathlib import Path

import numpy as np
import pytest
from stored_sweep import BLOCK, CASES, PULSE, SYSTEM, as_bytes, run_sweep, start_sweep, stored_files

import rockframe as rf
from rockframe.errors import StudyError
from rockframe.results.variables.runs import RunStatus
from rockframe.simulation import run
from rockframe.studies.sweeps import chunk as chunks

pytestmark = pytest.mark.filterwarnings("ignore::rockframe.errors.SolverWarning")

HEIGHTS = ([3.0 + 0.05 * k for k in range(12)], "m")
MARK = "ROCKFRAME_TEST_MARK"


@pytest.fixture(scope="module")
def complete(tmp_path_factory):
    folder = tmp_path_factory.mktemp("whole") / "study"
    return folder, run_sweep(folder)


def assert_part_of(part, complete):
    """Check that the cases of a part equal those of the complete sweep; return their number."""
    done = part.status != RunStatus.NOT_RUN
    assert part.status.size == CASES
    for name in ("peak_rotation", "rotation"):
        if name in part:
            np.testing.assert_array_equal(part[name].where(done), complete[name].where(done))
    return int(done.sum())


@pytest.mark.long
def test_killed_sweep_resumes_to_identical_results(complete, tmp_path):
    folder, lost = tmp_path / "study", 0
    rng = random.Random(5)
    for _ in range(2):
        running = start_sweep(folder)
        chunks = len(list(folder.glob("chunk-*")))
        while running.poll() is None and len(list(folder.glob("chunk-*"))) <= chunks:
            time.sleep(0.005)
        time.sleep(rng.uniform(0.0, 0.15))
        running.kill()
        running.communicate()
        lost += assert_part_of(rf.open_study(folder), complete[1]) < CASES
    assert lost > 0
    runs = run_sweep(folder)
    assert as_bytes(runs) == as_bytes(complete[1])
    assert stored_files(folder) == stored_files(complete[0])


def scene_killed_once(height):
    """Return a scene; the first process of a pool that reaches the eighth one is killed."""
    mark, worker = Path(os.environ[MARK]), parent_process() is not None
    if worker and height.m_as("m") > HEIGHTS[0][7] - 0.01 and not mark.exists():
        mark.touch()
        os.kill(os.getpid(), signal.SIGKILL)
    return rf.System(BLOCK.replace(height=height))


@pytest.mark.wide
@pytest.mark.skipif(not hasattr(signal, "SIGKILL"), reason="signals as of Unix")
def test_killed_worker_loses_only_chunks_in_flight(tmp_path, monkeypatch):
    monkeypatch.setenv(MARK, str(tmp_path / "mark"))
    folder = tmp_path / "study"
    arguments = {"height": HEIGHTS, "chunk": 1, "progress": False}
    with (
        ProcessPoolExecutor(1, mp_context=get_context("spawn")) as pool,
        pytest.raises(StudyError, match=r"could not run a chunk: BrokenProcessPool.*have died"),
    ):
        rf.sweep(scene_killed_once, PULSE, executor=pool, store=folder, **arguments)
    assert 0 < (rf.open_study(folder).status != RunStatus.NOT_RUN).sum() < 12
    found = rf.sweep(scene_killed_once, PULSE, store=folder, **arguments)
    assert as_bytes(found) == as_bytes(rf.sweep(scene_killed_once, PULSE, **arguments))


def run_short_of_memory(*_, **__):
    msg = "Unable to allocate 9 GiB"
    raise MemoryError(msg)


@pytest.mark.parametrize(
    ("where", "name"),
    [
        (chunks, "compute_response"),
        (chunks, "_cautions_and_scalars"),
        (run, "energy_caution"),
        (run, "compute_outputs"),
    ],
)
def test_too_little_memory_is_no_result_of_a_case(tmp_path, monkeypatch, where, name):
    folder = tmp_path / "study"
    arguments = {"height": HEIGHTS, "outputs": ["rotation"], "output_step": "0.1 s"}
    with monkeypatch.context() as patch:
        patch.setattr(where, name, run_short_of_memory)
        with pytest.raises(StudyError, match=r"too little memory.*Unable to allocate 9 GiB"):
            rf.sweep(SYSTEM, PULSE, store=folder, **arguments)
        assert (rf.open_study(folder).status == RunStatus.NOT_RUN).all()
    found = rf.sweep(SYSTEM, PULSE, store=folder, **arguments)
    assert (found.message == "none").all()
    assert (found.status == RunStatus.COMPLETED).all()


class Disk:
    """A file system in memory with a given size."""

    READ_ONLY, REMOUNT, DETACH = 1, 32, 2  # <sys/mount.h>

    def __init__(self, place):
        self.place = place
        self.libc = ctypes.CDLL(None, use_errno=True)

    def mount(self, size, flags=0):
        if not hasattr(self.libc, "mount"):
            return False
        place, words = bytes(self.place), f"size={size}".encode()
        return self.libc.mount(b"none", place, b"tmpfs", flags, words) == 0

    def leave(self):
        self.libc.umount2(bytes(self.place), self.DETACH)


@pytest.fixture
def disk(tmp_path):
    """Mount a disk of 64 kB, if permitted."""
    place = tmp_path / "disk"
    place.mkdir()
    found = Disk(place)
    if not found.mount("64k"):
        pytest.skip("no file system can be mounted here")
    yield found
    found.leave()


def test_full_disk_preserves_written_chunks(disk, complete):
    folder = disk.place / "study"
    with pytest.raises(StudyError, match=r"cannot be written.*No space left"):
        run_sweep(folder)
    assert 0 < assert_part_of(rf.open_study(folder), complete[1]) < CASES
    assert not list(folder.glob(".*"))
    assert disk.mount("10m", Disk.REMOUNT)  # with more room, the same call continues
    assert as_bytes(run_sweep(folder)) == as_bytes(complete[1])
    assert stored_files(folder) == stored_files(complete[0])


def test_file_size_limit_raises_like_a_full_disk(complete, tmp_path):
    resource = pytest.importorskip("resource", reason="limits as of Unix")
    folder = tmp_path / "study"
    run_sweep(folder)
    for chunk in folder.glob("chunk-00001*"):
        chunk.unlink()
    finished = assert_part_of(rf.open_study(folder), complete[1])
    assert finished == CASES - 30
    limits = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (200, limits[1]))
    try:
        with pytest.raises(StudyError, match=r"(?s)cannot be kept in.*File too large"):
            run_sweep(folder)
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, limits)
    assert assert_part_of(rf.open_study(folder), complete[1]) == finished
    assert as_bytes(run_sweep(folder)) == as_bytes(complete[1])


def test_a_folder_that_has_become_read_only_can_be_read(disk, complete):
    folder = disk.place / "study"
    assert disk.mount("10m", Disk.REMOUNT)
    run_sweep(folder)
    flags = Disk.REMOUNT | Disk.READ_ONLY
    assert disk.mount("10m", flags)
    assert rf.open_study(folder).identical(run_sweep(folder))  # nothing to run, nothing to write
    assert disk.mount("10m", Disk.REMOUNT)
    (folder / "chunk-000007.arrays").unlink()
    assert disk.mount("10m", flags)
    executor = []
    with pytest.raises(StudyError, match=r"cannot be kept in .*Read-only file system"):
        run_sweep(folder, executor=executor)  # before anything runs
    with pytest.raises(StudyError, match=r"cannot be kept in .*Read-only file system"):
        rf.sweep(SYSTEM, PULSE, scale=[1.0], store=disk.place / "another")
    assert assert_part_of(rf.open_study(folder), complete[1]) == CASES - 3


def test_pool_broken_on_submit_raises():
    class Broken(ThreadPoolExecutor):
        def submit(self, *_: object, **__: object) -> Future[object]:
            msg = "a child process terminated abruptly"
            raise BrokenExecutor(msg)

    with Broken(1) as pool, pytest.raises(StudyError, match=r"BrokenExecutor: a child.*have died"):
        rf.sweep(scene_killed_once, PULSE, height=HEIGHTS, executor=pool)


def test_executor_that_has_been_shut_down_is_refused():
    with ThreadPoolExecutor(1) as pool:
        pass
    with pytest.raises(StudyError, match=r"takes no work: .* after shutdown; call sweep inside"):
        rf.sweep(SYSTEM, PULSE, scale=[1.0], executor=pool)
