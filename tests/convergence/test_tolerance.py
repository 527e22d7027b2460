"""The error falls with the tolerance, and so does the energy's imbalance."""

import numpy as np
import pytest

import rockframe as rf

TOLERANCES = (1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9)
BLOCK = rf.Block.from_size(radius="10 m", slenderness=4, mass="1 t")
PADS = rf.TwoSpringSupport(frequency_ratio=20, damping_ratio=0.1)
CAP = rf.CushionCap(width="6 m", height="0.5 m", mass="0.2 t")
SOIL, NO_SUCTION = (
    rf.WinklerSoil(stiffness="200 kPa", damping_ratio=0.1, separation=separation)
    for separation in ("displacement", "pressure")
)
SCENES = {
    "rigid ground": rf.System(rf.Block.from_size(radius="10 m", slenderness=6, mass="1 t")),
    "pads": rf.System(BLOCK, PADS),
    "soil": rf.System(BLOCK, SOIL),
    "soil that lets go by pressure": rf.System(BLOCK, NO_SUCTION),
    "coupled": rf.System(BLOCK, PADS, CAP, SOIL),
    "coupled, soil that lets go by pressure": rf.System(BLOCK, PADS, CAP, NO_SUCTION),
    "cascade": rf.System(BLOCK, PADS, CAP, SOIL, coupling="cascade"),
}


def errors(system: rf.System) -> tuple[np.ndarray, np.ndarray]:
    pulse = rf.GroundMotion.sine_pulse()
    run = {"duration": "6 s", "output_step": "0.01 s"}
    exact = system.simulate(pulse, accuracy=rf.Accuracy(rtol=1e-13), **run)
    error, residual = [], []
    for rtol in TOLERANCES:
        result = system.simulate(pulse, accuracy=rf.Accuracy(rtol=rtol), **run)
        error.append(float(abs(result.relative_rotation - exact.relative_rotation).max()))
        residual.append(float(result.energy_residual))
    return np.array(error), np.array(residual)


@pytest.mark.parametrize("scene", SCENES)
def test_error_falls_with_tolerance(scene):
    error, residual = errors(SCENES[scene])
    # steps end on the pulse's samples, so a loose tolerance is met with room to spare
    assert (error <= 100.0 * np.array(TOLERANCES)).all()
    assert error[-1] < 1e-3 * max(error[0], 1e-6)
    assert (residual <= 10.0 * np.array(TOLERANCES)).all()


@pytest.mark.parametrize("scene", SCENES)
def test_events_are_located_to_1e_10_s(scene):
    pulse = rf.GroundMotion.sine_pulse()
    runs = [
        SCENES[scene].simulate(pulse, duration="3 s", accuracy=rf.Accuracy(rtol=rtol))
        for rtol in (1e-12, 1e-13)
    ]
    times = [run.event_time.to_numpy() for run in runs]
    assert len(times[0]) == len(times[1]) > 1
    np.testing.assert_allclose(times[0], times[1], rtol=0.0, atol=1e-10)


@pytest.mark.parametrize("level", ["fast", "standard", "reference"])
def test_named_accuracy_levels_bound_energy_residual(level):
    result = SCENES["pads"].simulate(rf.GroundMotion.sine_pulse(), accuracy=level)
    bound = {"fast": 1e-2, "standard": 1e-5, "reference": 1e-8}[level]
    assert float(result.energy_residual) <= bound
    assert result.attrs["accuracy"] == level
