"""Runs of more steps than are stored."""

import pytest

import rockframe as rf
from rockframe.errors import SolverWarning
from rockframe.solve import integrate

pytestmark = pytest.mark.unit


def test_long_run_stores_only_first_steps_and_warns(monkeypatch):
    block = rf.Block(width="1 m", height="3 m", mass="1 t")
    pads = rf.TwoSpringSupport(frequency_ratio=4000, damping_ratio=0.1)
    system, pulse = rf.System(block, pads), rf.GroundMotion.sine_pulse("-4 m/s^2", "1 Hz")
    reference = system.simulate(pulse, duration="0.5 s", outputs=["base_shear"])
    monkeypatch.setattr(integrate, "MAX_STEPS_KEPT", 400)
    with pytest.warns(SolverWarning, match="until 0.09"):
        run = system.simulate(pulse, duration="0.5 s", outputs=["base_shear"])
    for name in ("rotation", "base_shear", "event_time"):
        assert run[name].identical(reference[name])
    assert run.attrs["verdict"].split(". ")[0] == reference.attrs["verdict"].split(". ")[0]
    monkeypatch.undo()
    early = system.simulate(pulse, duration="0.09 s", outputs=["base_shear"])
    assert float(run.peak_base_shear) >= float(early.peak_base_shear)
    assert float(run.peak_base_shear) < float(reference.peak_base_shear)


def test_pausing_for_interrupts_does_not_change_the_run(monkeypatch):
    motion = rf.GroundMotion.harmonic("3 m/s^2", "2 Hz", duration="3 s")
    block = rf.Block(width="1 m", height="3 m", mass="1 t")
    system = rf.System(block, rf.TwoSpringSupport(frequency_ratio=40, damping_ratio=0.1))
    reference = system.simulate(motion)
    monkeypatch.setattr(integrate, "STEPS_BETWEEN_INTERRUPTS", 40)
    assert system.simulate(motion).drop_attrs().identical(reference.drop_attrs())


def test_run_stops_at_the_step_limit():
    block = rf.Block(width="1 m", height="3 m", mass="1 t")
    system = rf.System(block, rf.TwoSpringSupport(frequency_ratio=1e10, damping_ratio=0.1))
    accuracy = rf.Accuracy(substeps="fewest", steps_per_period=10.0, max_steps=100)
    pulse = rf.GroundMotion.sine_pulse("-4 m/s^2", "1 Hz")
    with pytest.warns(SolverWarning, match="the limit of steps was reached"):
        run = system.simulate(pulse, accuracy=accuracy)
    assert run.attrs["solver_steps"] == 100
