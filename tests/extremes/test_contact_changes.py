"""Separations whose own re-pinning would hold the corner again at the same instant."""

import numpy as np
import pytest

import rockframe as rf

pytestmark = pytest.mark.filterwarnings("ignore::rockframe.errors.ModelWarning")

CASES = [
    (2.3246231155778894, 12.816816816816818),
    (2.3246231155778894, 13.975975975975976),
    (2.3246231155778894, 13.981981981981981),
    (2.6060301507537686, 13.873873873873872),
    (3.0, 12.372372372372372),
]
"""Scales of the motion and frequency ratios; found among 200 000 runs."""


def shaking(scale):
    samples = 4.0 * scale * np.sin(0.314 * np.arange(120))
    return rf.GroundMotion.from_arrays((samples, "m/s^2"), "0.02 s")


@pytest.mark.parametrize(("scale", "frequency_ratio"), CASES)
def test_a_corner_that_would_be_held_again_at_once_does_not_leave(scale, frequency_ratio):
    block = rf.Block.from_size(radius="3 m", slenderness=4.5, mass="50 t")
    pads = rf.TwoSpringSupport(frequency_ratio=frequency_ratio, damping_ratio=0.1)
    system = rf.System(block, pads)
    runs = {
        level: system.simulate(shaking(scale), free_vibration="2 s", accuracy=level)
        for level in ("fast", "standard", "reference")
    }
    for run in runs.values():
        assert run.status == 0
        assert run.sizes["event"] < 20
        apart = abs(run.peak_rotation / runs["reference"].peak_rotation - 1.0)
        assert apart < (2e-3 if run.attrs["accuracy"] == "fast" else 1e-7)
    assert runs["reference"].energy_residual < 1e-10
    assert runs["standard"].energy_residual < 1e-7
