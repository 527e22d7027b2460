"""Several jobs on one study: each claims its chunks, and claims of ended jobs expire."""

import json
import os
import subprocess
import sys
import time
from collections import Counter
from concurrent.futures import ThreadPoolExecutor

import pytest
from stored_sweep import CASES, as_bytes, note_cases, run_sweep, start_sweep, stored_files

import rockframe as rf
from rockframe.errors import StudyError
from rockframe.studies.sweeps import claims as module
from rockframe.studies.sweeps.claims import Claims
from rockframe.studies.sweeps.execution import workers_of_executor
from rockframe.studies.sweeps.study import Study

pytestmark = pytest.mark.filterwarnings("ignore::rockframe.errors.SolverWarning")

KNOWS_PROCESSES = module._start_of_process(os.getpid()) is not None


@pytest.fixture(scope="module")
def complete(tmp_path_factory):
    folder = tmp_path_factory.mktemp("whole") / "study"
    return folder, run_sweep(folder)


@pytest.fixture
def start_other_job(tmp_path):
    """Start another job on the study, and wait until it has run some chunks."""
    log = tmp_path / "log 0"
    job = start_sweep(tmp_path / "study", f"note_cases({str(log)!r})")
    while job.poll() is None and not (log.exists() and len(log.read_text()) > 20):
        time.sleep(0.005)
    return job


@pytest.fixture
def run_here(tmp_path, monkeypatch):
    """Run the study in this process too, noting its chunks."""
    monkeypatch.setattr(Study, "job", Study.job)  # so that it is restored
    note_cases(tmp_path / "log 1")
    return lambda: run_sweep(tmp_path / "study")


def runs_per_chunk(tmp_path):
    """Return how often each chunk was run, by the number of its first case."""
    logs = [path.read_text().splitlines() for path in tmp_path.glob("log *")]
    return Counter(int(first) for each in logs for first in each)


def assert_complete(folder, complete, *, killed=False):
    assert stored_files(folder) == stored_files(complete[0])
    assert as_bytes(rf.open_study(folder)) == as_bytes(complete[1])
    # a job that is killed while it writes leaves a hidden partial file, which is never read
    left = {path.name for path in folder.iterdir() if not (killed and path.match(".*.part"))}
    assert left == {path.name for path in complete[0].iterdir()}


@pytest.mark.long
def test_two_jobs_run_each_case_once(complete, tmp_path, start_other_job, run_here):
    assert as_bytes(run_here()) == as_bytes(complete[1])  # each returns all cases
    out, err = start_other_job.communicate(timeout=300)
    assert out.strip() == "done", err
    assert_complete(tmp_path / "study", complete)
    assert runs_per_chunk(tmp_path) == Counter(range(0, CASES, 3))
    assert len([*tmp_path.glob("log *")]) == 2  # both have run some


@pytest.mark.skipif(not KNOWS_PROCESSES, reason="the system does not tell of processes")
def test_chunks_of_a_killed_job_are_taken_over(complete, tmp_path, start_other_job, run_here):
    with ThreadPoolExecutor(1) as pool:
        going_on = pool.submit(run_here)
        while not (going_on.done() or (tmp_path / "log 1").exists()):
            time.sleep(0.005)
        start_other_job.kill()
        start_other_job.communicate()
        begun = time.monotonic()
        going_on.result(timeout=300)
    assert time.monotonic() - begun < 0.5 * module._TIMEOUT  # it does not wait for the killed job
    assert_complete(tmp_path / "study", complete, killed=True)
    run = runs_per_chunk(tmp_path)
    assert set(run) == set(range(0, CASES, 3))
    in_flight = 2 * workers_of_executor(None)
    assert sum(run.values()) - len(run) <= in_flight
    assert max(run.values()) <= 2


def test_only_one_of_concurrent_jobs_claims_a_chunk(tmp_path):
    every = [Claims(tmp_path) for _ in range(8)]
    with ThreadPoolExecutor(8) as pool:
        for number in range(50):
            assert sum(pool.map(Claims.take, every, [number] * 8)) == 1
    assert len([*(tmp_path / "claims").iterdir()]) == 50
    every[0].clear()
    assert not [*tmp_path.iterdir()]


def test_released_claims_can_be_taken_again(tmp_path):
    one, other = Claims(tmp_path), Claims(tmp_path)
    assert one.take(3)
    assert not other.take(3)
    assert other.take(4)
    one.release_all()
    one.release(3)
    assert other.take(3)
    assert not one.take(4)


def test_job_killed_while_claiming_leaves_no_claim(tmp_path, monkeypatch):
    class Killed(BaseException):
        pass

    def killed(*_):
        raise Killed

    one, other = Claims(tmp_path), Claims(tmp_path)
    for place, name in ((module, "_this_job"), (module.Path, "hardlink_to")):
        with monkeypatch.context() as patch:
            patch.setattr(place, name, killed)
            with pytest.raises(Killed):
                one.take(5)
        assert not [*(tmp_path / "claims").glob("000005-*")]
    assert other.take(5)
    (claimed,) = (tmp_path / "claims").iterdir()
    assert json.loads(claimed.read_bytes()) == module._this_job()


def test_claims_work_without_hard_links(tmp_path, monkeypatch):
    def refused(*_):
        raise PermissionError(1, "Operation not permitted")

    monkeypatch.setattr(module.Path, "hardlink_to", refused)
    one, other = Claims(tmp_path), Claims(tmp_path)
    assert one.take(5)
    assert not other.take(5)
    (claimed,) = (tmp_path / "claims").iterdir()
    assert json.loads(claimed.read_bytes()) == module._this_job()


def claim(folder, content, number=7):
    (folder / "claims").mkdir(exist_ok=True)
    path = folder / "claims" / f"{number:06d}-000"
    path.write_bytes(content if isinstance(content, bytes) else json.dumps(content).encode())
    return path


ELSEWHERE = module._this_job() | {"machine": ["another"]}
SILENT = {
    "of another machine": ELSEWHERE,
    "empty": b"",
    "half written": json.dumps(ELSEWHERE).encode()[:20],
    "no text": bytes(range(256)),
    "other words": b"[1, 2]",
    "other entries": {"machine": module._machine(), "process": "x", "begun": 1},
    "infinite": {"machine": module._machine(), "process": float("inf"), "begun": 1},
}


@pytest.mark.parametrize("content", [pytest.param(one, id=name) for name, one in SILENT.items()])
def test_claims_expire_after_the_timeout(tmp_path, monkeypatch, content):
    path, one = claim(tmp_path, content), Claims(tmp_path)
    now = [1000.0]
    monkeypatch.setattr(module.time, "monotonic", lambda: now[0])
    os.utime(path, (0, 0))  # clocks of other machines may differ
    assert not one.take(7)
    now[0] += 0.9 * module._TIMEOUT
    assert not one.take(7)
    os.utime(path)  # the claim has been renewed
    now[0] += 0.9 * module._TIMEOUT
    assert not one.take(7)
    now[0] += 1.1 * module._TIMEOUT
    other = Claims(tmp_path)
    assert not other.take(7)  # the other job has not been watching for so long
    assert one.take(7)
    assert not other.take(7)


def test_a_claim_that_cannot_be_read_expires(tmp_path, monkeypatch):
    (tmp_path / "claims" / "000007-000").mkdir(parents=True)  # like a file of another user
    one, now = Claims(tmp_path), [1000.0]
    monkeypatch.setattr(module.time, "monotonic", lambda: now[0])
    assert not one.take(7)
    now[0] += 1.1 * module._TIMEOUT
    assert one.take(7)


def test_living_job_renews_its_claims(tmp_path, monkeypatch):
    now = [1000.0]
    monkeypatch.setattr(module.time, "monotonic", lambda: now[0])
    one = Claims(tmp_path)
    assert one.take(1)
    (path,) = (tmp_path / "claims").iterdir()
    os.utime(path, (0, 0))
    one.renew()
    assert path.stat().st_mtime == 0
    now[0] += 1.1 * module._RENEWAL_INTERVAL
    one.renew()
    assert time.time() - path.stat().st_mtime < 60.0
    assert 5.0 * module._RENEWAL_INTERVAL < module._TIMEOUT


@pytest.mark.skipif(not KNOWS_PROCESSES, reason="the system does not tell of processes")
def test_claims_of_ended_processes_expire_immediately(tmp_path):
    running = subprocess.Popen([sys.executable, "-c", "input()"], stdin=subprocess.PIPE)
    its = {"process": running.pid, "begun": module._start_of_process(running.pid)}
    claim(tmp_path, module._this_job() | its)
    one, other = Claims(tmp_path), Claims(tmp_path)
    assert not one.take(7)
    running.communicate(b"\n")
    assert one.take(7)
    assert not other.take(7)
    # a later process with the same number is a different one
    claim(tmp_path, module._this_job() | {"begun": "1"}, 8)
    assert one.take(8)
    claim(tmp_path, module._this_job(), 9)
    assert not one.take(9)


@pytest.mark.wide
def test_damaged_claims_do_not_change_results(complete, tmp_path, monkeypatch):
    folder = tmp_path / "study"
    folder.mkdir()
    for number, content in enumerate(SILENT.values()):
        claim(folder, content, 10 + number)
    (folder / "claims" / "what is this").write_text("")
    (folder / "claims" / "000011-more").write_text("")
    monkeypatch.setattr(module, "_TIMEOUT", 0.5)
    run_sweep(folder)
    assert_complete(folder, complete)


def test_failing_job_releases_its_chunks(tmp_path):
    class Broken(ThreadPoolExecutor):
        def submit(self, *_, **__):
            msg = "no more"
            raise RuntimeError(msg)

    with Broken(2) as pool, pytest.raises(rf.errors.StudyError, match="no more"):
        run_sweep(tmp_path / "study", executor=pool)
    assert not [*(tmp_path / "study" / "claims").iterdir()]
    begun = time.monotonic()
    run_sweep(tmp_path / "study")
    assert time.monotonic() - begun < module._TIMEOUT


def test_unwritable_claims_folder_raises(tmp_path):
    (tmp_path / "claims").write_text("a file")
    with pytest.raises(StudyError, match=r"claims.* cannot be written"):
        Claims(tmp_path).take(1)


def test_worker_count_is_read_from_the_executor():
    class Dask:
        class _client:  # noqa: N801
            @staticmethod
            def nthreads():
                return {"tcp://a": 4, "tcp://b": 8}

    class Unknown:
        pass

    with ThreadPoolExecutor(5) as pool:
        assert workers_of_executor(pool) == 5
    assert workers_of_executor(Dask()) == 12
    assert workers_of_executor(None) >= 1
    assert workers_of_executor(Unknown()) > 50


@pytest.mark.parametrize("workers", [pytest.param(1, marks=pytest.mark.long), 3])
def test_submitted_chunks_are_limited_to_twice_the_workers(workers):
    going = []

    class Counted(ThreadPoolExecutor):
        def submit(self, *given, **named):
            one = super().submit(*given, **named)
            going.append(one)
            most.append(sum(not each.done() for each in going))
            return one

    most = []
    with Counted(workers) as pool:
        run_sweep(executor=pool)
    assert len(going) == CASES / 3
    assert max(most) <= 2 * workers
