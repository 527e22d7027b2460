"""Time to read a record.

Run with ``python -m pytest tests/benchmarks -m benchmarks -s``.
"""

import time
import tracemalloc

import numpy as np
import pytest
from unit.motion.format_samples import SAMPLES, cosmos_block
from unit.motion.motion_files import at2, numbers

from rockframe.motion import GroundMotion

REPEATS = 10
COUNT = 18_000


def best(path, **given) -> float:
    times = []
    for _ in range(REPEATS):
        start = time.perf_counter()
        GroundMotion.read(path, **given)
        times.append(time.perf_counter() - start)
    return min(times)


def table() -> str:
    rows = (f"{0.005 * k:.3f},{value:.7f}\n" for k, value in enumerate(numbers(COUNT)))
    return "time (s),acceleration (g)\n" + "".join(rows)


@pytest.mark.parametrize(
    ("name", "text", "limit"),
    [
        ("record.AT2", at2(f"NPTS= {COUNT}, DT= .00500 SEC", numbers(COUNT)), 0.030),
        ("record.V2c", cosmos_block("acceleration", 300.0 * numbers(COUNT)), 0.060),
        ("record.csv", table(), 0.120),
    ],
)
def test_18000_samples(tmp_path, name, text, limit):
    path = tmp_path / name
    path.write_text(text, encoding="ascii")
    assert len(GroundMotion.read(path)) == COUNT
    taken = best(path)
    print(f"\n  {name}: {COUNT} samples in {1e3 * taken:.1f} ms")
    assert taken < limit


def test_longest_text_is_read_within_time_and_memory(tmp_path):
    # no file may cost more than about a second and 200 MB
    count = 300_000
    path = tmp_path / "long.csv"
    values = 0.2 * np.sin(0.1 * np.arange(count))
    rows = (f"{0.005 * k:.3f},{value:.17f}\n" for k, value in enumerate(values))
    path.write_text("time (s),acceleration (g)\n" + "".join(rows), encoding="ascii")
    start = time.process_time()
    assert len(GroundMotion.read(path)) == count
    taken = time.process_time() - start
    tracemalloc.start()
    GroundMotion.read(path)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    print(f"\n  {path.stat().st_size / 2**20:.1f} MiB of text: {taken:.2f} s, {peak / 1e6:.0f} MB")
    assert taken < 1.0
    assert peak < 200e6


def test_small_files_of_every_format(tmp_path):
    for key, sample in SAMPLES.items():
        taken = best(sample.write(tmp_path), component=sample.component)
        print(f"  {key}: {1e3 * taken:.2f} ms")
        assert taken < 0.02
