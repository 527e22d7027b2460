"""Free-decay records from independent integrations, with noise, and their identification."""

import math
from functools import cache

import numpy as np
import pytest
from reference_models.monoliths import rigid_block, two_spring

import rockframe as rf
from rockframe.errors import ModelWarning

GRAVITY = 9.80665
HALF_WIDTH, HALF_HEIGHT = 0.15, 0.6
START = 0.1  # rad
HELD = 0.2  # s before the release
BLOCK = rf.Block(width="0.3 m", height="1.2 m", mass="200 kg")
TIME = np.arange(151) * 0.02
SHAPE = {"half_width": HALF_WIDTH, "half_height": HALF_HEIGHT, "shape_factor": 3.0}
PADS = ("frequency_ratio", "damping_ratio")


@cache
def on_rigid_ground(restitution=0.9):
    run = rigid_block.simulate(
        **SHAPE, restitution=restitution, duration=float(TIME[-1]), initial=(START, 0.0),
        sample_times=np.clip(TIME - HELD, 0.0, None), rest_rotation=1e-6,
    )  # fmt: skip
    return run.rotation


@cache
def on_pads(frequency_ratio=20.0, damping_ratio=0.1):
    stiffness = 0.375 * frequency_ratio**2 * GRAVITY / math.hypot(HALF_WIDTH, HALF_HEIGHT)
    settlement = 0.5 * GRAVITY / stiffness
    # one pad carries the weight: y - settlement + g / k is the height of the corner above it
    rise = HALF_HEIGHT * (1.0 - math.cos(START)) - HALF_WIDTH * math.sin(START)
    height = settlement - GRAVITY / stiffness - rise
    run = two_spring.simulate(
        **SHAPE, frequency_ratio=frequency_ratio, damping_ratio=damping_ratio,
        duration=float(TIME[-1]), initial=(START, height, 0.0, 0.0),
        sample_times=np.clip(TIME - HELD, 0.0, None),
    )  # fmt: skip
    return run.rotation


def pads(frequency_ratio=20.0, damping_ratio=0.1):
    return rf.System(
        BLOCK, rf.TwoSpringSupport(frequency_ratio=frequency_ratio, damping_ratio=damping_ratio)
    )


def read_back(system, rotation, parameters, noise=0.0, seed=0, offset=0.003):
    """Fit a record in degrees, with gauge offset and noise."""
    record = rotation + offset + noise * np.random.default_rng(seed).normal(size=rotation.size)
    return rf.fit_free_decay(system, ((TIME, "s"), (np.degrees(record), "deg")), parameters)


def errors(found, truth, offset=0.003):
    """Return errors of all unknowns over their standard errors."""
    circumstances = ("initial_rotation", "release_time", "gauge_offset")
    values = [*found.fitted_value.values, *(float(found[name]) for name in circumstances)]
    spread = [
        *found.standard_error.values,
        *(float(found[f"{name}_error"]) for name in circumstances),
    ]
    return (np.array(values) - [*truth, START, HELD, offset]) / spread


def test_restitution_without_noise():
    found = read_back(rf.System(BLOCK), on_rigid_ground(), "restitution")
    assert float(found.fitted_value[0]) == pytest.approx(0.9, rel=1e-6)
    assert float(found.initial_rotation) == pytest.approx(START, rel=1e-6)
    assert float(found.release_time) == pytest.approx(HELD, abs=1e-6)
    assert float(found.gauge_offset) == pytest.approx(0.003, rel=1e-5)


@pytest.mark.parametrize(
    ("frequency", "damping"),
    [
        (0.9, 1.1),
        *(pytest.param(*by, marks=pytest.mark.long) for by in ((1.1, 0.9), (0.9, 0.9), (1.1, 1.1))),
    ],
)
def test_pad_parameters_are_recovered_from_perturbed_start(frequency, damping):
    found = read_back(pads(20.0 * frequency, 0.1 * damping), on_pads(), PADS)
    np.testing.assert_allclose(found.fitted_value, [20.0, 0.1], rtol=1e-6)


def test_pad_restitution_is_recovered_with_other_parameters():
    start = rf.System(
        BLOCK, rf.TwoSpringSupport(frequency_ratio=21, damping_ratio=0.11, restitution=0.85)
    )
    with pytest.warns(ModelWarning, match="damping_ratio and restitution can hardly be told"):
        found = read_back(start, on_pads(), (*PADS, "restitution"))
    np.testing.assert_allclose(found.fitted_value, [20.0, 0.1, BLOCK.maximum_restitution], 1e-6)


@pytest.mark.long
def test_confidence_intervals_have_stated_coverage():
    system, rotation = rf.System(BLOCK), on_rigid_ground()
    fits = [read_back(system, rotation, "restitution", 1e-3, seed) for seed in range(24)]
    scores = np.array([errors(found, [0.9]) for found in fits])
    inside = np.mean(np.abs(scores) < 1.976, axis=0)  # of 147 degrees of freedom
    assert (inside >= 0.875).all()
    assert 0.90 <= inside.mean() <= 0.99


@pytest.mark.long
def test_confidence_intervals_of_pad_parameters_cover_true_values():
    fits = [read_back(pads(), on_pads(), PADS, 5e-4, seed) for seed in range(6)]
    scores = [errors(found, [20.0, 0.1]) for found in fits]
    assert np.mean(np.abs(scores) < 1.976) >= 0.85
    assert np.max(np.abs(scores)) < 5.0


def test_correlated_noise_warns():
    smooth = np.convolve(np.random.default_rng(3).normal(size=TIME.size + 9), np.ones(10), "valid")
    with pytest.warns(ModelWarning, match="each residual follows the one before"):
        found = read_back(rf.System(BLOCK), on_rigid_ground() + 3e-4 * smooth, "restitution")
    assert float(found.residual_autocorrelation) > 0.7
    assert "each residual" in found.attrs["cautions"]
