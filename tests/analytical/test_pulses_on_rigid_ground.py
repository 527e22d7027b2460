"""Overturning by half-sine and one-sine pulses on rigid ground, in closed form."""

import math

import numpy as np
import pytest
from analytical.rigid import (
    BANDS,
    GRAVITY,
    P,
    half_sine_threshold,
    one_sine_threshold,
    rigid_block,
)

import rockframe as rf

pytestmark = pytest.mark.analytical

THETA = 0.1
TOPPLED = 2


def shaken(amplitude, ratio, cycles, restitution=None, theta=THETA, motion=None):
    """Run the linearised block until it has fallen flat or returned.

    `amplitude` is that of the ground over g theta, `ratio` the pulse's angular
    frequency over p. The run continues beyond theta: the second half of a sine
    may still return the block.
    """
    system = rigid_block(theta, restitution=restitution, rotation="small")
    if motion is None:
        motion = rf.GroundMotion.sine_pulse(
            f"{-amplitude * GRAVITY * theta!r} m/s^2", f"{ratio * P / (2.0 * math.pi)!r} Hz", cycles
        )
    return system.simulate(
        motion,
        free_vibration=f"{60.0 / P!r} s",
        accuracy="reference",
        overturning="continue",
        outputs=None,
    )


def falls(response):
    return response.status.item() == TOPPLED


# half a sine ---------------------------------------------------------------------------------

HALF_SINE = {
    1: 1.322397,
    2: 1.800724,
    3: 2.293872,
    4: 2.790798,
    5: 3.289147,
    6: 3.788155,
    8: 4.787071,
    10: 5.786522,
}


def sampled_half_sine(amplitude, ratio, count):
    length = math.pi / (ratio * P)
    samples = -amplitude * GRAVITY * THETA * np.sin(np.linspace(0.0, math.pi, count))
    samples[[0, -1]] = 0.0
    return rf.GroundMotion.from_arrays((samples, "m/s^2"), f"{length / (count - 1)!r} s")


@pytest.mark.parametrize(("ratio", "printed"), HALF_SINE.items())
def test_half_sine(ratio, printed):
    threshold = half_sine_threshold(ratio)
    assert threshold == pytest.approx(printed, abs=6e-7)
    above = shaken(threshold * (1.0 + 1e-6), ratio, 0.5)
    below = shaken(threshold * (1.0 - 1e-6), ratio, 0.5)
    assert falls(above)
    assert above.impact_count.item() == 0
    assert above.overturning_direction.item() == 1
    assert not falls(below)
    assert not below.overturned.item()
    assert below.impact_count.item() > 0
    assert below.peak_relative_rotation.item() == pytest.approx(1.0, abs=1e-2)


@pytest.mark.parametrize("ratio", [1, 4, 10])
def test_half_sine_from_samples(ratio):
    """Linear interpolation of 20 001 samples makes the pulse weaker by 1.7e-9."""
    threshold = half_sine_threshold(ratio)
    for factor, expected in ((1.0 + 1e-6, True), (1.0 - 1e-6, False)):
        motion = sampled_half_sine(threshold * factor, ratio, 20001)
        assert falls(shaken(None, ratio, None, motion=motion)) is expected


# one sine ------------------------------------------------------------------------------------

ONE_SINE = {
    1: 1.418315,
    2: 2.349903,
    3: 3.631150,
    4: 5.238964,
    5: 7.168129,
    6: 9.416966,
    8: 14.871352,
}


@pytest.mark.parametrize(("ratio", "printed"), ONE_SINE.items())
def test_one_sine_without_impact(ratio, printed):
    threshold = one_sine_threshold(ratio)
    assert threshold == pytest.approx(printed, abs=6e-7)
    above = shaken(threshold * (1.0 + 1e-6), ratio, 1.0, restitution=0.9)
    below = shaken(threshold * (1.0 - 1e-6), ratio, 1.0, restitution=0.9)
    assert falls(above)
    assert above.impact_count.item() == 0
    assert not falls(below)
    assert below.impact_count.item() > 0


@pytest.mark.parametrize(
    ("ratio", "edge", "falls_above"),
    [
        (ratio, edge, falls_above)
        for ratio, bands in BANDS.items()
        for band in bands
        for edge, falls_above in zip(band, (True, False), strict=True)
    ],
)
def test_one_sine_with_impact(ratio, edge, falls_above):
    above = shaken(edge + 1e-6, ratio, 1.0, restitution=0.9)
    below = shaken(edge - 1e-6, ratio, 1.0, restitution=0.9)
    assert falls(above) is falls_above
    assert falls(below) is not falls_above
    inside = above if falls_above else below
    assert inside.impact_count.item() > 0


@pytest.mark.parametrize("ratio", BANDS)
def test_safe_gap_lies_between_overturning_modes(ratio):
    upper = BANDS[ratio][-1][1]
    threshold = one_sine_threshold(ratio)
    assert upper < threshold
    for share in (0.05, 0.5, 0.95):
        amplitude = upper + share * (threshold - upper)
        assert not falls(shaken(amplitude, ratio, 1.0, restitution=0.9))
    inside = 0.5 * sum(BANDS[ratio][-1])
    assert falls(shaken(inside, ratio, 1.0, restitution=0.9))
    assert falls(shaken(2.0 * threshold, ratio, 1.0, restitution=0.9))


# the paper's nine cases on rigid ground ----------------------------------------------------------

RIGID_LIMIT = [
    # H/B, R0 [m], impacts, time of overturning [s], peak alpha/theta
    (2, 1, 1, 1.30946, None),
    (2, 5, None, None, 0.26441),
    # published as 0.12572; an independent eighth-order integration gives 0.1257277
    (2, 10, None, None, 0.12573),
    (4, 1, 0, 0.40662, None),
    (4, 5, 1, 2.69659, None),
    (4, 10, None, None, 0.42891),
    (6, 1, 0, 0.32916, None),
    (6, 5, 1, 3.12423, None),
    (6, 10, None, None, 0.82435),
]


@pytest.mark.parametrize("accuracy", ["standard", "reference"])
@pytest.mark.parametrize(("slenderness", "radius", "impacts", "time", "peak"), RIGID_LIMIT)
def test_one_g_sine_overturning_times_and_peaks(slenderness, radius, impacts, time, peak, accuracy):
    block = rf.Block.from_size(radius=f"{radius} m", slenderness=slenderness, mass="50 t")
    system = rf.System(block, gravity="9.81 m/s^2")
    response = system.simulate(
        rf.GroundMotion.sine_pulse(), free_vibration="9 s", accuracy=accuracy
    )
    if time is None:
        assert not response.overturned.item()
        assert math.isnan(response.overturning_time.item())
        assert response.peak_relative_rotation.item() == pytest.approx(peak, abs=6e-6)
        return
    assert response.overturned.item()
    assert response.overturning_time.item() == pytest.approx(time, abs=6e-6)
    assert response.impact_count.item() == impacts
    assert response.peak_relative_rotation.item() == pytest.approx(1.0, rel=1e-9)
    assert response.time.values[-1] == response.overturning_time.item()


def test_peak_before_impact_of_nearly_overturning_block():
    block = rf.Block.from_size(radius="5 m", slenderness=6, mass="50 t")
    response = rf.System(block, gravity="9.81 m/s^2").simulate(
        rf.GroundMotion.sine_pulse(), free_vibration="9 s", accuracy="reference"
    )
    impact = response.event_time.values[response.event_kind.values == 2][0]
    before = response.relative_rotation.values[response.time.values < impact]
    assert np.abs(before).max() == pytest.approx(0.976, abs=6e-4)


# a peak just above uplift, between the ends of the polynomials of the pulse --------------------


def just_uplifting(ground, excess, accuracy):
    """Return the response to a sine that slightly exceeds the uplift acceleration."""
    block = rf.Block(width="1 m", height="4 m", mass="1 t")
    motion = rf.GroundMotion.sine_pulse(f"{0.25 * (1.0 + excess)!r} g", "1 Hz", 0.7)
    signal = motion.si.horizontal
    assert (signal.samples.max() < 0.25 * GRAVITY) == (excess < 2e-5)
    return rf.System(block, ground).simulate(motion, accuracy=accuracy, outputs=None)


def time_of_uplift(excess):
    return np.arcsin(1.0 / (1.0 + excess)) / (2.0 * math.pi)


@pytest.mark.parametrize("accuracy", ["fast", "standard"])
@pytest.mark.parametrize("friction", [None, 0.8])
@pytest.mark.parametrize("excess", [1e-9, 1e-6, 1e-5, 2e-4])
def test_uplift_at_pulse_peak_within_a_step(excess, friction, accuracy):
    found = just_uplifting(rf.RigidGround(friction=friction), excess, accuracy)
    # the sine is a polynomial to some 1e-11 of its amplitude
    slack = 1e-11 / math.sqrt(2.0 * excess) / (2.0 * math.pi) + 1e-12
    assert found.first_uplift_time.item() == pytest.approx(time_of_uplift(excess), abs=slack)


def test_no_uplift_at_peak_below_threshold():
    found = just_uplifting(rf.RigidGround(), -1e-9, "standard")
    assert math.isnan(found.first_uplift_time.item())
    assert found.peak_rotation.item() == 0.0


def test_uplift_at_joint_peak_of_horizontal_and_vertical_motion():
    # both peak at 1/4 s; upward acceleration reduces the resistance by the factor tan(theta)
    block = rf.Block(width="1 m", height="4 m", mass="1 t")
    excess = 1e-8
    across = rf.GroundMotion.sine_pulse(f"{0.2 * (1.0 + excess)!r} g", "1 Hz", 0.45)
    downwards = rf.GroundMotion.sine_pulse(f"{-0.2 * (1.0 + excess)!r} g", "1 Hz", 0.9)
    motion = across.with_vertical(downwards)
    assert motion.si.horizontal.samples.max() < 0.2 * GRAVITY
    found = rf.System(block).simulate(motion, outputs=None)
    assert found.first_uplift_time.item() == pytest.approx(time_of_uplift(excess), abs=1e-7)
