"""Costs of the models compared: same record, same accuracy, one run.

Run with ``python -m pytest tests/benchmarks -m benchmarks -s``.
"""

import time

import pytest
from records import record_path

import rockframe as rf

ROUNDS = 15
MOST = {
    "two-spring": 1.0,
    "soil": 1.5,
    "cap and soil": 1.5,
    "coupled": 4.0,
    "cascade": 3.0,
}
"""Largest allowed cost over that of the block on two pads."""


def systems():
    block = rf.Block(width="4 m", height="18 m", mass="99 t")
    pads = rf.TwoSpringSupport(frequency_ratio=40, damping_ratio=0.10)
    cap = rf.CushionCap(height="0.9 m", mass="36 t")
    soil = rf.WinklerSoil(stiffness="9 MPa", damping_ratio=0.20)
    return {
        "two-spring": rf.System(block, pads),
        "soil": rf.System(block, soil),
        "cap and soil": rf.System(block, cap, soil),
        "coupled": rf.System(block, pads, cap, soil),
        "cascade": rf.System(block, pads, cap, soil, coupling="cascade"),
    }


@pytest.fixture(scope="module")
def costs():
    record = rf.GroundMotion.read(record_path("PEERSMD_CHICHI_TCU128-N.AT2"))
    record = record.window("30 s", "90 s")
    scenes = systems()
    best, steps = dict.fromkeys(scenes, 1e9), {}
    for _ in range(ROUNDS + 1):
        for name, system in scenes.items():
            start = time.perf_counter()
            response = system.simulate(record, overturning="continue")
            best[name] = min(best[name], time.perf_counter() - start)
            steps[name] = response.attrs["solver_steps"]
            assert response.attrs["solver_end_time"] == pytest.approx(record.duration.m_as("s"))
    print()
    for name, cost in best.items():
        ratio = cost / best["two-spring"]
        print(f"  {name}: {1e3 * cost:.1f} ms, {steps[name]} steps, {ratio:.2f} times two pads")
    return {name: cost / best["two-spring"] for name, cost in best.items()}


@pytest.mark.parametrize("name", MOST)
def test_cost_relative_to_two_pads(costs, name):
    assert costs[name] <= MOST[name]
