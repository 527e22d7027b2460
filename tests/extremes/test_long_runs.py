"""Runs over ten thousand cycles and of an hour accumulate little error."""

import math
import tracemalloc

import numpy as np
import pytest

import rockframe as rf

CYCLES = 10_000
BLOCK = rf.Block.from_size(radius="5 m", slenderness=4, mass="50 t")
THETA = BLOCK.si.overturning_angle
GROUND = rf.RigidGround(restitution=1.0)
BOUNCY = rf.TwoSpringSupport(frequency_ratio=10, damping_ratio=0.0, restitution=1.0)
SCENES = {
    "rigid ground": ((BLOCK, GROUND), {}, 0.5),
    "rigid ground, small rotations": ((BLOCK, GROUND), {"rotation": "small"}, 0.5),
    "pads": ((BLOCK, BOUNCY), {"restraint": "leading-corner"}, 0.3),
}


@pytest.mark.filterwarnings("ignore:restitution 1 exceeds")
@pytest.mark.parametrize(
    "name",
    [pytest.param(name, marks=[pytest.mark.long] * (name != "rigid ground")) for name in SCENES],
)
def test_ten_thousand_lossless_cycles_conserve_energy(name):
    parts, options, share = SCENES[name]
    system = rf.System(*parts, **options)
    # Housner's period, which pads only lengthen; with half as many cycles again as a margin
    period = 4.0 * math.acosh(1.0 / (1.0 - share)) / BLOCK.si.frequency
    run = system.simulate(
        duration=f"{2.0 * CYCLES * period!r} s",
        initial=rf.InitialState(rotation=f"{share * THETA!r} rad"),
        accuracy="reference",
        outputs=None,
    )
    assert int(run.status) == 0
    # two landings a cycle
    assert int(run.impact_count) >= 2 * CYCLES
    assert float(run.energy_residual) < 1e-6
    # the last swing is as large as the first: little energy is lost
    assert float(run.peak_rotation) == pytest.approx(share * THETA, rel=1e-5)


@pytest.mark.long
@pytest.mark.parametrize(
    "parts",
    [
        (BLOCK, rf.TwoSpringSupport(frequency_ratio=20, damping_ratio=0.1)),
        (BLOCK, rf.WinklerSoil(stiffness="12 MPa", damping_ratio=0.1)),
    ],
    ids=["pads", "soil"],
)
def test_one_hour_record_runs_in_bounded_memory(parts):
    rng = np.random.default_rng(5)
    noise = np.convolve(rng.normal(size=720_000), np.hanning(41), "same")
    noise *= 0.35 * 9.80665 * math.tan(THETA) / np.abs(noise).max()
    motion = rf.GroundMotion.from_arrays((noise, "m/s^2"), "0.005 s")
    system = rf.System(*parts)
    system.simulate(motion.window(end="200 s"), outputs=None)  # compiles, events too
    tracemalloc.start()
    run = system.simulate(motion, outputs=None)
    _, most = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert int(run.status) in (0, 1)
    assert float(run.attrs["solver_end_time"]) > 3000.0
    assert float(run.energy_residual) <= 1e-5
    # without histories: one or two copies of the motion, and the events
    assert most < 6 * noise.nbytes
