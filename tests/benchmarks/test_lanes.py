"""Lanes against the loop of single runs: packed instructions and their gain."""

import re
from time import perf_counter

import numpy as np
import pytest

import rockframe as rf
from rockframe.compiled import COMPILED
from rockframe.compiled.bound import structure_of
from rockframe.dynamics.protocol import Start
from rockframe.solve.accuracy import LEVELS, AccuracyLevel
from rockframe.solve.integrate import integrate, run_start

pytestmark = [
    pytest.mark.benchmarks,
    pytest.mark.skipif(not COMPILED, reason="lanes are compiled"),
]

FAST = LEVELS[AccuracyLevel.FAST]
PADS = rf.TwoSpringSupport(frequency_ratio=20, damping_ratio=0.1)
SOIL = rf.WinklerSoil(stiffness="9 MPa", damping_ratio=0.2)
BASES = {"rigid ground": (), "pads": (PADS,), "soil": (SOIL,)}
LEAST = {"rigid ground": 1.2, "pads": 2.0, "soil": 2.0}
"""Required gain; on rigid ground a run has an impact in every twentieth step."""


def model_on(*parts):
    block = rf.Block.from_size(radius="5 m", slenderness=4, mass="50 t")
    return rf.System(block, *parts).assembly.model


@pytest.mark.parametrize("fixed", [True, False])
@pytest.mark.parametrize("base", BASES)
def test_lanes_use_packed_instructions(base, fixed):
    from rockframe.compiled.calls import register_kernels
    from rockframe.compiled.jobs import Job
    from rockframe.solve.lanes.steps import steps_in_lanes

    system = model_on(*BASES[base]).system
    structure = structure_of(system)
    register_kernels()
    step = steps_in_lanes(system, fixed_steps=fixed)
    code = Job(step, structure, is_bound=True, in_lanes=True)._compiled(keep=False)
    text = code._library.get_asm_str()
    if "xmm" not in text:
        pytest.skip("not the instructions of an x86 processor")
    packed = len(re.findall(r"\tv?(?:mul|add|sub)pd\t", text))
    alone = len(re.findall(r"\tv?(?:mul|add|sub)sd\t", text))
    print(f"{base}: {packed} packed, {alone} alone")
    # each loop has a scalar remainder for lanes beyond the last full register
    assert packed > 0.4 * alone


@pytest.mark.parametrize("base", BASES)
def test_lanes_are_faster_than_single_runs(base):
    from rockframe.solve.lanes.integrate import LaneRun, integrate_lanes

    motion = rf.GroundMotion.stochastic(
        6.5, "10 km", seed=4, time_step="0.02 s", source="one corner"
    ).si
    model = model_on(*BASES[base])
    options = {"duration": motion.duration, "output_step": None}
    start = run_start(
        model, Start(), FAST, interval=motion.time_step, stop_at_overturning=True, **options
    )
    motions = [motion.each(lambda one, f=f: scaled(one, f)) for f in np.linspace(0.2, 2.0, 128)]
    none = np.zeros(len(motions), dtype=np.int64)
    lanes, alone = [], []
    for _ in range(5):
        began = perf_counter()
        result = integrate_lanes([LaneRun(model, start)], motions, none, np.arange(len(motions)))
        lanes.append(perf_counter() - began)
        began = perf_counter()
        runs = [integrate(model, Start(), one, FAST, **options) for one in motions]
        alone.append(perf_counter() - began)
    assert result.clock.shape[0] == len(runs)
    gain = min(alone[1:]) / min(lanes[1:])
    print(f"{base}: {1e6 * min(lanes) / len(motions):.0f} us a run in lanes, {gain:.1f} times")
    assert gain > LEAST[base]


def scaled(signal, factor):
    return type(signal)(signal.time_step, signal.samples * factor)
