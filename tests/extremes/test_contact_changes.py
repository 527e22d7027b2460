"""Contact changes that once followed one another without end."""

import numpy as np
import pytest

import rockframe as rf

pytestmark = pytest.mark.filterwarnings("ignore::rockframe.errors.ModelWarning")

HELD_AGAIN = [
    (2.3246231155778894, 12.816816816816818),
    (2.3246231155778894, 13.975975975975976),
    (2.3246231155778894, 13.981981981981981),
    (2.6060301507537686, 13.873873873873872),
    (3.0, 12.372372372372372),
]
"""Scales of the motion and frequency ratios; found among 200 000 runs."""
SLIP_FOR_A_MOMENT = [
    (2.7152542372881356, 19.214428857715433),
    (2.7627118644067794, 16.80160320641283),
    (2.9050847457627116, 18.541082164328657),
]
"""The same of sliding contacts that last for less than a fixed step."""


def shaking(scale):
    samples = 4.0 * scale * np.sin(0.314 * np.arange(120))
    return rf.GroundMotion.from_arrays((samples, "m/s^2"), "0.02 s")


def runs(slenderness, scale, frequency_ratio):
    block = rf.Block.from_size(radius="3 m", slenderness=slenderness, mass="50 t")
    pads = rf.TwoSpringSupport(frequency_ratio=frequency_ratio, damping_ratio=0.1)
    found = {
        level: rf.System(block, pads).simulate(shaking(scale), free_vibration="2 s", accuracy=level)
        for level in ("fast", "standard", "reference")
    }
    for level, run in found.items():
        assert run.status == 0
        assert run.sizes["event"] < 60
        apart = abs(run.peak_rotation / found["reference"].peak_rotation - 1.0)
        assert apart < (2e-3 if level == "fast" else 1e-7)
    assert found["reference"].energy_residual < 1e-10
    assert found["standard"].energy_residual < 1e-7
    return found


@pytest.mark.parametrize(("scale", "frequency_ratio"), HELD_AGAIN)
def test_a_corner_that_would_be_held_again_at_once_does_not_leave(scale, frequency_ratio):
    runs(4.5, scale, frequency_ratio)


@pytest.mark.parametrize(("scale", "frequency_ratio"), SLIP_FOR_A_MOMENT)
def test_a_slip_that_rises_and_falls_within_a_step_ends_where_it_falls(scale, frequency_ratio):
    found = runs(3.0, scale, frequency_ratio)
    # separation into sliding contact, and the end of the slip
    kinds, states = found["fast"].event_kind, found["fast"].contact_state_after
    slides = np.flatnonzero((kinds[:-1] == 1) & (states[:-1] != 3) & (kinds[1:] == 4))
    assert len(slides)
    times = found["fast"].event_time.to_numpy()
    assert (times[slides + 1] - times[slides] > 1e-4).any()
