"""A stored sweep killed at random moments, and the result after it is resumed.

Usage: python tests/benchmarks/interrupted_sweeps.py [kills] [seed]

Each time a process that runs a sweep of 240 cases into a new folder is killed (SIGKILL) shortly
after it has written a random number of files, or at a random time after its start; then the same
sweep is run there again. Every third time a second process works on the same folder, is not killed,
and must finish the whole sweep. Prints for each kill its time, the stored cases, and whether all
files and the dataset equal those of an uninterrupted sweep to the last byte. Exits with 1 if not.
"""

import random
import sys
import tempfile
import time
import warnings
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from stored_sweep import CASES, as_bytes, run_sweep, start_sweep, stored_files

import rockframe as rf
from rockframe.errors import StudyError
from rockframe.results.variables.runs import RunStatus


def main() -> int:
    """Kill, resume and compare."""
    kills = int(sys.argv[1]) if len(sys.argv) > 1 else 20
    rng = random.Random(int(sys.argv[2]) if len(sys.argv) > 2 else 1)
    warnings.simplefilter("ignore")
    same = 0
    with tempfile.TemporaryDirectory() as place:
        first = Path(place) / "whole"
        start = time.perf_counter()
        start_sweep(first).communicate()
        duration = time.perf_counter() - start
        expected_files, expected_dataset = stored_files(first), as_bytes(rf.open_study(first))
        print(f"uninterrupted: {duration:.1f} s")
        for number in range(1, kills + 1):
            folder = Path(place) / f"study {number}"
            # every fifth kill at a random time after the start, the others while the process writes
            after = rng.randrange(len(expected_files)) if number % 5 else -1
            delay = rng.uniform(0.0, 0.1 if number % 5 else 0.8 * duration)
            running = start_sweep(folder)
            second_process = None if number % 3 else start_sweep(folder)
            while running.poll() is None and len(list(folder.glob("*.arrays"))) <= after:
                time.sleep(0.002)
            time.sleep(delay)
            running.kill()
            running.communicate()
            state, parts = left_behind(folder)
            if second_process is not None and second_process.communicate()[0].strip() != "done":
                state += ", the second process failed"
            dataset = as_bytes(run_sweep(folder))
            good = (
                stored_files(folder) == expected_files
                and dataset == expected_dataset
                and "failed" not in state
            )
            same += good
            print(
                f"{number:3d}: killed {delay:.3f} s after {after + 1} files; {state}, "
                f"{parts} half-written files; "
                f"resumed: {'identical' if good else 'ANOTHER'}",
                flush=True,
            )
    print(f"{same} of {kills} identical to the uninterrupted sweep")
    return int(same < kills)


def left_behind(folder) -> tuple[str, int]:
    """Return what a killed sweep has stored, and its number of half-written files."""
    try:
        done = int((rf.open_study(folder).status != RunStatus.NOT_RUN).sum())
    except StudyError:
        return "no study yet", len(list(folder.glob(".*")))
    return f"{done} of {CASES} cases kept", len(list(folder.glob(".*")))


if __name__ == "__main__":
    sys.exit(main())
