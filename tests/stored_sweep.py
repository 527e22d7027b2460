"""A sweep stored in a folder, and processes that run it, for tests of interruptions and faults."""

import subprocess
import sys
from pathlib import Path

import numpy as np

import rockframe as rf
from rockframe.studies.sweeps.study import Study

BLOCK = rf.Block(width="0.8 m", height="3.6 m", mass="4 t")
SYSTEM = rf.System(BLOCK, rf.TwoSpringSupport(frequency_ratio=20, damping_ratio=0.1))
RECORD = rf.GroundMotion.from_arrays(
    (2.0 * np.random.default_rng(3).normal(size=400), "m/s^2"), "0.01 s", name="noise"
)
PULSE = rf.GroundMotion.sine_pulse("2 m/s^2", "1 Hz")
SCALES = np.linspace(0.1, 3.0, 30)
CASES = 120
CHILD = """
import sys
sys.path.insert(0, {tests!r})
from stored_sweep import note_cases, run_sweep
{first}
run_sweep(sys.argv[1])
print("done")
"""
TESTS = str(Path(__file__).resolve().parent)


def run_sweep(store=None, **changes):
    """Run 120 cases, in 40 chunks; half of them cannot be assembled."""
    options = {"chunk": 3, "accuracy": "reference", "outputs": ["rotation"], **changes}
    return rf.sweep(
        SYSTEM, {"noise": RECORD, "pulse": PULSE}, scale=options.pop("scale", SCALES),
        height=["1e200 m", "3.6 m"], output_step="0.02 s", store=store, **options,
    )  # fmt: skip


def stored_files(folder):
    """Return the bytes of all stored arrays by file name."""
    return {path.name: path.read_bytes() for path in folder.glob("*.arrays")}


def start_sweep(folder, first=""):
    """Start a process that runs the sweep after the lines `first`."""
    return subprocess.Popen(
        [sys.executable, "-W", "ignore", "-c", CHILD.format(tests=TESTS, first=first), str(folder)],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )


def note_cases(log):
    """Log the first case of each chunk that this process runs."""
    plain = Study.job

    def job(self, cases):
        with Path(log).open("a") as noted:
            noted.write(f"{cases[0]}\n")
        return plain(self, cases)

    Study.job = job


def as_bytes(dataset):
    """Return all values of a dataset, for comparison to the last bit."""
    return {name: one.values.tolist() if one.dtype.kind in "OU" else one.values.tobytes()
            for name, one in dataset.variables.items()}  # fmt: skip


def assert_identical(one, other, *, apart=()):
    """Assert that two datasets are identical except for `history` and the attributes `apart`."""
    assert list(one.dims) == list(other.dims)
    assert as_bytes(one) == as_bytes(other)
    apart = dict.fromkeys(("history", *apart), "")
    assert one.attrs | apart == other.attrs | apart
