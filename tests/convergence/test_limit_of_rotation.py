"""The limit of rotation is found even where the rotation only touches it within a step."""

from dataclasses import replace

import pytest

import rockframe as rf
from rockframe.dynamics.protocol import Start
from rockframe.solve.accuracy import accuracy_of
from rockframe.solve.integrate import integrate
from rockframe.solve.workspace import Status

pytestmark = pytest.mark.convergence

BLOCK = rf.Block(width="1 m", height="4 m", mass="10 t")
PADS = rf.TwoSpringSupport(frequency_ratio=20, damping_ratio=0.1)
MODEL = rf.System(BLOCK, PADS).setting.compile()
PULSE = rf.GroundMotion.sine_pulse(amplitude="-3 m/s^2", frequency="1 Hz").si


def run(limit, accuracy):
    model = replace(MODEL, rotation_limits=(limit, limit))
    return integrate(
        model, Start(), PULSE, accuracy_of(accuracy), duration=3.0, output_step=None,
        stop_at_overturning=True,
    )  # fmt: skip


@pytest.mark.parametrize("accuracy", ["fast", "standard", "reference"])
def test_a_limit_just_below_the_peak_is_found(accuracy):
    free = run(1.0, accuracy)
    assert free.status is Status.COMPLETED
    # the rotation is above this share of its peak for a small part of a step
    for share in 1e-9, 1e-7, 1e-5:
        met = run(free.peak_rotation * (1.0 - share), accuracy)
        assert met.status is Status.OVERTURNED
        assert abs(met.ending.state[0]) == pytest.approx(free.peak_rotation, rel=2.0 * share)
    assert run(free.peak_rotation * (1.0 + 1e-9), accuracy).status is Status.COMPLETED
