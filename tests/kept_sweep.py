"""A sweep that is kept in a folder, and processes that run it; for what may go wrong with them."""

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
from kept_sweep import note_cases, the_sweep
{first}
the_sweep(sys.argv[1])
print("done")
"""
TESTS = str(Path(__file__).resolve().parent)


def the_sweep(store=None, **changes):
    """Run 120 cases, in 40 chunks; half of them cannot be assembled."""
    options = {"chunk": 3, "accuracy": "reference", "outputs": ["rotation"], **changes}
    return rf.sweep(
        SYSTEM, {"noise": RECORD, "pulse": PULSE}, scale=options.pop("scale", SCALES),
        height=["0.4 m", "3.6 m"], output_step="0.02 s", store=store, **options,
    )  # fmt: skip


def files(folder):
    """Return the bytes of all files but that with the date."""
    return {path.name: path.read_bytes() for path in folder.glob("*.arrays")}


def child(folder, first=""):
    """Start a process that runs the sweep, after some lines of its own."""
    return subprocess.Popen(
        [sys.executable, "-W", "ignore", "-c", CHILD.format(tests=TESTS, first=first), str(folder)],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )


def note_cases(log):
    """Have this process write down the first case of each chunk that it runs."""
    plain = Study.job

    def job(self, cases):
        with Path(log).open("a") as noted:
            noted.write(f"{cases[0]}\n")
        return plain(self, cases)

    Study.job = job


def as_bytes(dataset):
    """Return all numbers of a dataset, to be compared to the last bit."""
    return {name: one.values.tolist() if one.dtype.kind in "OU" else one.values.tobytes()
            for name, one in dataset.variables.items()}  # fmt: skip


def alike(one, other, *, apart=()):
    """Whether two datasets say the same, but for the time of day and some attributes."""
    assert list(one.dims) == list(other.dims)
    assert as_bytes(one) == as_bytes(other)
    apart = dict.fromkeys(("history", *apart), "")
    assert one.attrs | apart == other.attrs | apart
