"""Cost of fixed sub-steps compared with the tolerance of ``"standard"``, for the solver alone.

Run with ``python -m pytest tests/benchmarks/test_fast.py -m benchmarks -s``; it prints the
table of the guide's page "Accuracy".
"""

import time
from pathlib import Path

import numpy as np
import pytest
from records import record_path

import rockframe as rf
from rockframe.dynamics.events import SILENT
from rockframe.dynamics.protocol import Start
from rockframe.signals import Motion
from rockframe.solve.accuracy import accuracy_of
from rockframe.solve.integrate import integrate

ROUNDS = 20
STEP = 0.005
LENGTH = 60.0
LEAST = {
    "rigid ground": 1.3,
    "pads, beta 20": 1.7,
    "pads, beta 200": 3.0,
    "soil": 1.8,
    "coupled": 5.0,
    "cascade": 1.4,
}
"""Required ratio of the times of ``"standard"`` and ``"fast"``."""


def systems() -> dict[str, tuple[rf.System, float]]:
    """Return the scenes, and the factor on the record at which they rock without overturning."""
    block = rf.Block(width="4 m", height="18 m", mass="99 t")
    cap = rf.CushionCap(height="0.9 m", mass="36 t")
    soil = rf.WinklerSoil(stiffness="9 MPa", damping_ratio=0.20)

    def pads(ratio: float) -> rf.TwoSpringSupport:
        return rf.TwoSpringSupport(frequency_ratio=ratio, damping_ratio=0.10)

    return {
        "rigid ground": (rf.System(block), 2.0),
        "pads, beta 20": (rf.System(block, pads(20)), 1.5),
        "pads, beta 200": (rf.System(block, pads(200)), 1.5),
        "soil": (rf.System(block, soil), 1.0),
        "coupled": (rf.System(block, pads(40), cap, soil), 1.0),
        "cascade": (rf.System(block, pads(40), cap, soil, coupling="cascade"), 1.0),
    }


def solve(model, ground: Motion, level: str):
    options = {"duration": LENGTH, "output_step": STEP, "stop_at_overturning": False}
    return integrate(model, Start(), ground, accuracy_of(level), **options)


def rotation(model, run) -> np.ndarray:
    return run.state[:, : len(model.rotation_weights)] @ model.rotation_weights


@pytest.fixture(scope="module")
def ratios():
    record = rf.GroundMotion.read(Path(record_path("PEERSMD_CHICHI_TCU128-N.AT2")))
    samples = record.window("30 s", "90 s").si.horizontal.samples
    scenes = {
        name: (system.setting.compile(), Motion.of_samples(STEP, factor * samples))
        for name, (system, factor) in systems().items()
    }
    best: dict[tuple[str, str], float] = {}
    for _ in range(ROUNDS):
        for name, scene in scenes.items():
            for level in ("fast", "standard"):
                start = time.perf_counter()
                solve(*scene, level)
                spent = time.perf_counter() - start
                best[name, level] = min(best.get((name, level), spent), spent)
    print("\n| scene | events | time ratio | history | peak | energy residual |")
    for name, (model, ground) in scenes.items():
        fast, exact = solve(model, ground, "fast"), solve(model, ground, "reference")
        turn, truth = rotation(model, fast), rotation(model, exact)
        summary, true = (getattr(run, "summary", run) for run in (fast, exact))
        count = min(len(turn), len(truth))
        events = int((exact.events.kind != SILENT).sum())
        print(
            f"| {name} | {events} | {best[name, 'standard'] / best[name, 'fast']:.1f} "
            f"| {abs(turn[:count] - truth[:count]).max() / true.peak_rotation:.0e} "
            f"| {abs(summary.peak_rotation / true.peak_rotation - 1.0):.0e} "
            f"| {summary.energy_residual:.0e} |"
        )
    return {name: best[name, "standard"] / best[name, "fast"] for name in scenes}


@pytest.mark.parametrize("name", LEAST)
def test_fast_is_faster(ratios, name):
    assert ratios[name] >= LEAST[name]
