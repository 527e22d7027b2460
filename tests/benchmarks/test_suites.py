"""Times to read a suite and to compute its spectra.

Run with ``python -m pytest tests/benchmarks -m benchmarks -s``.
"""

import time

import numpy as np
import pytest
from unit.motion.motion_files import at2

import rockframe as rf

MOTIONS = 200
SAMPLES = 8_000
STEP = 0.005  # s
PERIODS = (np.geomspace(0.05, 10.0, 100), "s")


def best(function, repeats: int = 3) -> float:
    times = []
    for _ in range(repeats):
        start = time.perf_counter()
        function()
        times.append(time.perf_counter() - start)
    return min(times)


def noise(seed: int) -> np.ndarray:
    values = np.convolve(np.random.default_rng(seed).normal(size=SAMPLES), np.ones(8), mode="same")
    place = np.arange(SAMPLES) / SAMPLES
    return 0.05 * values * 20.0 * place * np.exp(-8.0 * place)


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    path = tmp_path_factory.mktemp("suite")
    for k in range(MOTIONS):
        event = f"Made, 10/18/1989, Station {k // 2}, {90 * (k % 2)}"
        text = at2(f"NPTS=   {SAMPLES}, DT=   {STEP:.4f} SEC,", noise(k), event=event)
        name = f"RSN{k // 2 + 1}_MADE_S{90 * (k % 2):03d}.AT2"
        (path / name).write_text(text, encoding="ascii")
    return path


@pytest.fixture(scope="module")
def suite(folder):
    return rf.read_suite(folder)


def test_reading_a_folder(folder, suite):
    taken = best(lambda: rf.read_suite(folder))
    print(f"\n  {MOTIONS} AT2 files of {SAMPLES} samples: {taken:.2f} s")
    assert len(suite) == MOTIONS
    assert taken < 2.0


def test_response_spectra(suite):
    rf.response_spectrum(suite.only(list(suite)[:2]), (PERIODS[0][:2], "s"))  # compile first
    taken = best(lambda: suite.response_spectrum(PERIODS))
    print(f"\n  {MOTIONS} motions of {SAMPLES} samples at 100 periods: {taken:.2f} s")
    assert taken < 3.0


def test_rotated_spectra(suite):
    pairs = suite.pairs
    assert len(pairs) == MOTIONS // 2
    rf.rotated_spectrum(dict(list(pairs.items())[:2]), (PERIODS[0][:2], "s"))
    taken = best(lambda: rf.rotated_spectrum(pairs, PERIODS), 1)
    print(f"\n  {len(pairs)} pairs in 180 directions at 100 periods: {taken:.2f} s")
    assert taken < 60.0


def test_measures_and_selection(suite):
    taken = best(suite.intensity_measures, 1)
    print(f"\n  intensity measures of {MOTIONS} motions: {taken:.2f} s")
    target = rf.TargetSpectrum.eurocode_8("0.25 g_0", "B").with_deviation(0.5)
    chosen = best(lambda: suite.selection_for(target, 30, bounds=None), 1)
    print(f"  30 of {MOTIONS} motions chosen for a target: {chosen:.2f} s")
    kept = best(suite.to_dataset, 1)
    print(f"  as a dataset: {kept:.2f} s")
    assert taken < 60.0
    assert chosen < 10.0
