"""Inclinations: accepted values, refusals, and effects on runs and analyses."""

import math
import warnings

import numpy as np
import pytest

import rockframe as rf
from rockframe.errors import AssemblyError, ComponentError, ModelWarning
from rockframe.signals import Motion
from rockframe.signals.motion import Incline

BLOCK = rf.Block(width="0.6 m", height="2 m", mass="1 t")
SOFT = rf.TwoSpringSupport(stiffness="60 kN/m", damping_ratio=0.1)


def test_inclination_needs_an_angle_below_90_degrees():
    for angle, words in ((3.0, "bare number"), ("3", "no unit"), ("3 m", "angle"),
                         ("90 deg", "between -90° and 90°")):  # fmt: skip
        with pytest.raises(AssemblyError, match=words):
            rf.System(BLOCK, inclination=angle)
    assert rf.System(BLOCK, inclination="-0 deg") == rf.System(BLOCK)
    assert rf.System(BLOCK, inclination="3 deg") != rf.System(BLOCK)
    turned = rf.System(BLOCK, inclination="3 deg").inclination
    assert turned.m_as("rad") == math.radians(3.0)


def test_block_falling_by_its_own_weight_is_refused():
    for angle, side in (("17 deg", "left"), ("-17 deg", "right")):
        for parts in ((BLOCK,), (BLOCK, rf.TwoSpringSupport(stiffness="1 GN/m", damping_ratio=1))):
            with pytest.raises(AssemblyError, match=f"falls to the {side} by its own weight"):
                rf.System(*parts, inclination=angle)
    with pytest.warns(ModelWarning, match="since its base is inclined"):
        rf.System(BLOCK, SOFT.replace(stiffness="120 kN/m"), inclination="3 deg")


def test_free_decay_is_fitted_on_a_level_base_only():
    with pytest.raises(ComponentError, match="the base is inclined by"):
        rf.fit_free_decay(rf.System(BLOCK, inclination="1 deg"), peaks=([5.0, 4.0], "deg"))


def test_description_states_slope_and_both_sides():
    text = rf.System(BLOCK, inclination="-3 deg").describe()
    for words in ("higher on the left", "to the left 0.343817 rad", "to the right 0.239097 rad",
                  "sin(theta s + i - a)", "friction to stand"):  # fmt: skip
        assert words in text, words


def test_inclined_motion_is_rotated_and_includes_gravity():
    slope = Incline(math.radians(30.0), 10.0)
    samples = np.array([0.0, 2.0, -1.0])
    felt = slope.resolved(
        Motion.of_samples(0.5, samples, 2.0 * samples), duration=2.0, interval=0.01
    )
    s, c = 0.5, math.sqrt(0.75)
    for signal, part, lasting in (
        (felt.horizontal, c + 2.0 * s, 5.0),
        (felt.vertical, 2.0 * c - s, 0.0),
    ):
        time = np.array([0.0, 0.25, 0.5, 0.75])
        np.testing.assert_allclose(
            signal.at(time), part * np.interp(time, [0.0, 0.5, 1.0], samples) + lasting
        )
        np.testing.assert_allclose(signal.at(np.array([1.2, 1.7, 2.0])), lasting, atol=1e-15)
    still = slope.resolved(None, duration=1.0, interval=0.01)
    np.testing.assert_allclose(still.horizontal.at(np.linspace(0.0, 1.0, 7)), 5.0)
    assert slope.normal_gravity == pytest.approx(10.0 * c)


def test_equations_of_sliding_have_the_components_of_gravity():
    """Friction must bear g sin(i) too: the level equations would hold the block up to mu_s g."""
    ground = rf.RigidGround(friction=0.5)
    words = "g cos(i) in the place of g, and xg'' with g sin(i)"
    texts = [
        " ".join(rf.System(BLOCK, ground, inclination=angle).describe().split())
        for angle in ("0 deg", "5 deg")
    ]
    assert [text.count(words) for text in texts] == [0, 2]


def test_ladder_certificate_and_critical_scale_use_the_slope():
    pads = rf.TwoSpringSupport(frequency_ratio=20, damping_ratio=0.1)
    system = rf.System(BLOCK, pads, inclination="3 deg")
    for rung in rf.model_ladder(system).values():
        assert rung.inclination == system.inclination
    block = rf.System(BLOCK, inclination="3 deg")
    pulse = rf.GroundMotion.sine_pulse("1 m/s^2", "1 Hz")
    found = rf.critical_scale(block, pulse, scales=12, runs=24, bracket_width=0.05, largest=6.0)
    least = 9.80665 * math.tan(math.atan(0.3) - math.radians(3.0))
    assert found.uplift_scale.item() == pytest.approx(least, rel=1e-6)
    assert found.critical_scale.item() > least
    below = block.simulate(pulse.scaled(0.9 * least), certify=rf.Certification(runs=60))
    assert math.isnan(below.first_uplift_time.item())
    assert not below.overturned.item()
    assert below.verdict_margin.item() > 1e-4
    assert block.simulate(pulse.scaled(1.001 * least)).first_uplift_time.item() > 0.0


@pytest.mark.parametrize(("peak", "leaves"), [("-9.9 m/s^2", False), ("-10.1 m/s^2", True)])
def test_separation_warning_uses_gravity_normal_to_the_slope(peak, leaves):
    """On a slope only g cos(i) presses, so that a smaller normal acceleration separates."""
    angle, gravity = math.radians(12.0), 10.2
    size = float(peak.split()[0])
    assert (-size > gravity * math.cos(angle)) == leaves
    assert -size < gravity
    time = np.linspace(0.0, 1.0, 101)
    normal = size * np.sin(math.pi * time) ** 2
    motion = rf.GroundMotion.from_arrays(
        (-normal * math.sin(angle), "m/s^2"),
        "10 ms",
        vertical=(normal * math.cos(angle), "m/s^2"),
    )
    system = rf.System(BLOCK, inclination="12 deg", gravity=f"{gravity} m/s^2")
    with warnings.catch_warnings(record=True, action="always") as caught:
        system.simulate(motion, outputs=None)
    assert any("leave the rigid ground" in str(one.message) for one in caught) == leaves
