"""Speed of spectra and intensity measures, compared with an independent library.

Run with ``python -m pytest tests/benchmarks -m benchmarks -s``.
"""

import os
import subprocess
import sys
import time

import numpy as np
import pytest
from records import record_path

import rockframe as rf
from rockframe.measures import intensity_measures, response_spectrum

PERIODS = np.geomspace(0.05, 10.0, 500)  # not shorter than the samples resolve
REPEATS = 9


def best(function, repeats: int = REPEATS) -> float:
    times = []
    for _ in range(repeats):
        start = time.perf_counter()
        function()
        times.append(time.perf_counter() - start)
    return min(times)


def say(text: str) -> None:
    print(f"\n  {text}")


@pytest.fixture(scope="module")
def record():
    motion = rf.GroundMotion.read(record_path("PEERSMD_CHICHI_TCU128-N.AT2"))
    assert len(motion) == 18_000
    return motion


def test_spectrum_of_an_accelerogram(record):
    eqsig = pytest.importorskip("eqsig")
    response_spectrum(record, (PERIODS[:2], "s"))  # compiles at the first call
    mine = best(lambda: response_spectrum(record, (PERIODS, "s")))
    signal = record.si.horizontal
    yours = best(
        lambda: eqsig.sdof.true_response_spectra(signal.samples, signal.time_step, PERIODS, 0.05),
        3,
    )
    say(
        f"500 periods of 18 000 samples: {1e3 * mine:.0f} ms, eqsig {1e3 * yours:.0f} ms, "
        f"ratio {yours / mine:.1f}"
    )
    assert mine < 0.15
    assert yours / mine > 1.0


def test_intensity_measures_of_an_accelerogram(record):
    block = rf.Block(width="1 m", height="4 m", mass="1 t")
    intensity_measures(record, block=block)
    mine = best(lambda: intensity_measures(record, block=block))
    say(f"intensity measures of 18 000 samples: {1e3 * mine:.0f} ms")
    assert mine < 0.3


def test_spectrum_without_compilation(record, tmp_path):
    np.savez(tmp_path / "record.npz", samples=record.si.horizontal.samples, periods=PERIODS)
    code = (
        "import sys, time, numpy as np, rockframe as rf;"
        "from rockframe.measures import response_spectrum;"
        "held = np.load(sys.argv[1]); samples = (held['samples'], 'm/s^2');"
        f"motion = rf.GroundMotion.from_arrays(samples, '{record.si.time_step!r} s');"
        "periods = (held['periods'], 's'); response_spectrum(motion, ['1 s']);"
        "start = time.perf_counter(); response_spectrum(motion, periods);"
        "print(time.perf_counter() - start)"
    )
    done = subprocess.run(
        [sys.executable, "-c", code, str(tmp_path / "record.npz")],
        env=os.environ | {"ROCKFRAME_COMPILE": "0"}, capture_output=True, text=True, check=True,
    )  # fmt: skip
    plain = float(done.stdout)
    say(f"500 periods of 18 000 samples without compilation: {plain:.2f} s")
    assert plain < 3.0
