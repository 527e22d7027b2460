"""rockframe against independent, hand-written SciPy (DOP853) integrations.

The monoliths share no code with the package. Histories must agree to 1e-7 of the
overturning angle, and every contact change must happen in the same order.
"""

import math

import numpy as np
import pytest
from records import record_path
from reference_models.monoliths import rigid_block, two_spring

import rockframe as rf

AGREEMENT = 1e-7  # of theta
TIGHT = {"rtol": 1e-10, "atol": 1e-12}  # gives the monoliths an error of about 1e-11
GRAVITY = 9.80665
RULES = ("contact-state", "leading-corner", "centre")
CONTACTS = ("full", "left", "right", "flight")


def pulse_between_samples(motion):
    """Return the analytic pulse as a function of time, with its breakpoints."""

    def acceleration(t):
        return -9.81 * math.sin(2.0 * math.pi * t) if t <= 1.0 else 0.0

    return acceleration, [0.0, 1.0]


def on_pads(block, beta, xi, motion, *, rule="contact-state", rotation="finite", **run):
    pads = rf.TwoSpringSupport(frequency_ratio=beta, damping_ratio=xi)
    system = rf.System(block, pads, restraint=rule, rotation=rotation)
    return system.simulate(motion, accuracy="reference", **run)


def assert_same(ours, theirs, theta):
    held = ~np.isnan(theirs.rotation)
    count = int(held.sum())
    assert count >= 0.99 * ours.sizes["time"]
    samples = ours.isel(time=slice(count))
    difference = np.abs(samples.rotation.to_numpy() - theirs.rotation[:count]).max()
    assert difference <= AGREEMENT * theta
    assert bool(ours.overturned) == theirs.overturned
    assert int(ours.impact_count) == theirs.impact_count
    assert float(ours.peak_rotation) == pytest.approx(theirs.peak_rotation, rel=1e-7)
    if theirs.overturned:
        assert float(ours.overturning_time) == pytest.approx(theirs.overturning_time, abs=1e-6)


def assert_same_on_pads(ours, theirs, theta):
    assert_same(ours, theirs, theta)
    held = ~np.isnan(theirs.rotation)
    samples = ours.isel(time=slice(int(held.sum())))
    size = np.abs(theirs.vertical[held]).max()
    np.testing.assert_allclose(
        samples.vertical_displacement, theirs.vertical[held], rtol=0.0, atol=1e-6 * size
    )
    np.testing.assert_allclose(
        samples.horizontal_displacement,
        theirs.horizontal[held],
        rtol=0.0,
        atol=1e-6 * np.abs(theirs.horizontal[held]).max(),
    )
    assert float(ours.flight_time) == pytest.approx(theirs.flight_time, abs=1e-6)
    names = np.array(CONTACTS)[samples.contact_state.to_numpy()]
    assert np.mean(names == theirs.contact[held]) > 0.995  # samples at an event may differ


def monolith_on_pads(block, beta, xi, *, rule="contact-state", rotation="finite", **options):
    return two_spring.simulate(
        half_width=0.5 * block.width.m_as("m"),
        half_height=0.5 * block.height.m_as("m"),
        shape_factor=block.shape_factor,
        frequency_ratio=beta,
        damping_ratio=xi,
        restraint=rule,
        rotation=rotation,
        gravity=GRAVITY,
        initial=options.pop("initial", (0.0, 0.0, 0.0, 0.0)),
        **TIGHT,
        **options,
    )


PULSES = (
    (5, 4, 20, 0.10), (10, 2, 10, 0.05), (1, 2, 40, 0.20), (10, 6, 40, 0.40), (5, 2, 10, 0.40)
)  # fmt: skip


@pytest.mark.parametrize(
    ("radius", "slenderness", "beta", "xi", "rule"),
    [
        # each rule in one or two scenes, and each scene once
        pytest.param(*pulse, rule, marks=[pytest.mark.long] * ((number + place) % 3 > 0))
        for number, pulse in enumerate(PULSES)
        for place, rule in enumerate(RULES)
    ],
)
def test_pulse_on_pads(radius, slenderness, beta, xi, rule):
    block = rf.Block.from_size(radius=f"{radius} m", slenderness=slenderness, mass="1 t")
    motion = rf.GroundMotion.sine_pulse()
    ours = on_pads(block, beta, xi, motion, rule=rule, duration="5 s", output_step="0.01 s")
    acceleration, breaks = pulse_between_samples(motion)
    theirs = monolith_on_pads(
        block, beta, xi, rule=rule, time_step=None, acceleration=acceleration,
        breakpoints=breaks, duration=5.0, sample_times=ours.time.to_numpy(),
    )  # fmt: skip
    assert_same_on_pads(ours, theirs, float(ours.overturning_angle))


@pytest.mark.parametrize("rotation", ["finite", "small"])
def test_random_motion_with_vertical_component(rotation):
    rng = np.random.default_rng(7)
    step, count = 0.02, 151
    smooth = np.ones(5) / 5.0
    x = 5.0 * np.convolve(rng.normal(size=count), smooth, "same")
    y = 3.0 * np.convolve(rng.normal(size=count), smooth, "same")
    block = rf.Block.from_size(radius="3 m", slenderness=3, mass="1 t")
    motion = rf.GroundMotion.from_arrays((x, "m/s^2"), time_step=f"{step} s", vertical=(y, "m/s^2"))
    ours = on_pads(block, 15, 0.1, motion, rotation=rotation, free_vibration="1 s")
    theirs = monolith_on_pads(
        block, 15, 0.1, rotation=rotation, time_step=step, acceleration=x, vertical=y,
        duration=(count - 1) * step + 1.0, sample_times=ours.time.to_numpy(),
    )  # fmt: skip
    assert int(ours.impact_count) > 0
    assert_same_on_pads(ours, theirs, float(ours.overturning_angle))


@pytest.mark.parametrize(
    ("name", "window", "scale", "radius", "slenderness"),
    [
        ("ElCentro1940_Peknold.AT2", ("0 s", "10 s"), 1.0, 3, 5),
        pytest.param(
            "PEERSMD_CHICHI_TCU128-N.AT2", ("36 s", "44 s"), 2.0, 4, 6, marks=pytest.mark.long
        ),
    ],
)
def test_records_on_pads(name, window, scale, radius, slenderness):
    motion = rf.GroundMotion.read(record_path(name)).window(*window).scaled(scale)
    block = rf.Block.from_size(radius=f"{radius} m", slenderness=slenderness, mass="1 t")
    ours = on_pads(block, 20, 0.1, motion)
    theirs = monolith_on_pads(
        block, 20, 0.1, time_step=motion.si.time_step, acceleration=motion.si.horizontal.samples,
        duration=float(ours.time[-1]), sample_times=ours.time.to_numpy(),
    )  # fmt: skip
    assert int(ours.impact_count) > 0
    assert_same_on_pads(ours, theirs, float(ours.overturning_angle))


@pytest.mark.parametrize("rotation", ["finite", "small"])
@pytest.mark.parametrize("slenderness", [2, 4])
def test_pulse_on_rigid_ground(slenderness, rotation):
    block = rf.Block.from_size(radius="5 m", slenderness=slenderness, mass="1 t")
    motion = rf.GroundMotion.sine_pulse()
    ours = rf.System(block, rotation=rotation).simulate(
        motion, duration="3 s", output_step="0.01 s", accuracy="reference"
    )
    acceleration, breaks = pulse_between_samples(motion)
    theirs = rigid_block.simulate(
        half_width=0.5 * block.width.m_as("m"), half_height=0.5 * block.height.m_as("m"),
        shape_factor=3.0, rotation=rotation, gravity=GRAVITY, time_step=None,
        acceleration=acceleration, breakpoints=breaks, duration=3.0, initial=(0.0, 0.0),
        sample_times=ours.time.to_numpy(),
    )  # fmt: skip
    assert_same(ours, theirs, float(ours.overturning_angle))


def test_record_on_rigid_ground():
    motion = rf.GroundMotion.read(record_path("ElCentro1940_Peknold.AT2")).window("0 s", "8 s")
    block = rf.Block.from_size(radius="3 m", slenderness=5, mass="1 t")
    ours = rf.System(block).simulate(motion, accuracy="reference")
    theirs = rigid_block.simulate(
        half_width=0.5 * block.width.m_as("m"), half_height=0.5 * block.height.m_as("m"),
        shape_factor=3.0, gravity=GRAVITY, time_step=motion.si.time_step,
        acceleration=motion.si.horizontal.samples, duration=float(ours.time[-1]),
        initial=(0.0, 0.0), sample_times=ours.time.to_numpy(),
    )  # fmt: skip
    assert int(ours.impact_count) > 3
    assert_same(ours, theirs, float(ours.overturning_angle))
