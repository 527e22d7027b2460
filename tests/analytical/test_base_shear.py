"""The base shear equals the rate of momentum of all bodies on the ground: Newton's second law.

Independently of the equations of motion, displacements of a run with fine outputs are
differentiated twice. The stencil has nine points, its error is of the eighth order of the
output step. With steps of 1 ms and motions that change within some 10 ms (the vibrations of pads
and soil) that is below 1e-8 of the accelerations. Rounding: displacements of some 0.1 m are
known to 1e-17 m, their second difference over 1 ms to 1e-10 m/s^2; outputs between steps are
interpolated within the tolerance of 1e-10, from step to step, which adds some 1e-8. Samples whose
stencil contains an event, or an end of the pulse, are omitted: the accelerations jump there.
"""

import math

import numpy as np
import pytest

import rockframe as rf
from rockframe.dynamics.events import EventKind

pytestmark = pytest.mark.wide

AGREEMENT = 1e-6  # of the largest base shear
STEP = 1e-3
STENCIL = np.array([-1 / 560, 8 / 315, -1 / 5, 8 / 5, -205 / 72, 8 / 5, -1 / 5, 8 / 315, -1 / 560])
SIDE = len(STENCIL) // 2

BLOCK_MASS, CAP_MASS = 50e3, 10e3
CAP_HEIGHT = 0.4
BLOCK = rf.Block(width="2.4 m", height="9.6 m", mass="50 t")
SQUAT = rf.Block(width="4 m", height="6 m", mass="50 t")
PADS = rf.TwoSpringSupport(frequency_ratio=20, damping_ratio=0.1)
CAP = rf.CushionCap(width="3.2 m", height="0.4 m", mass="10 t")
SOIL = rf.WinklerSoil(stiffness="30 MPa", damping_ratio=0.1)
PULSE = rf.GroundMotion.sine_pulse("-5 m/s^2", "1 Hz")
LIFTED = PULSE.with_vertical(rf.GroundMotion.sine_pulse("3 m/s^2", "1 Hz"))


def run(*parts, motion=LIFTED, duration="2 s", block=BLOCK, **options):
    response = rf.System(block, *parts, **options).simulate(
        motion, duration=duration, output_step=f"{STEP} s", accuracy="reference"
    )
    assert not response.overturned
    return response


def acceleration(displacement):
    """Differentiate twice, without the first and last samples."""
    return np.convolve(displacement, STENCIL, "valid") / STEP**2


def inside(history):
    """Return the samples at which accelerations are known."""
    return history.to_numpy()[SIDE:-SIDE]


def is_smooth(response):
    """Return which of these samples have no event or end of the pulse in their stencil."""
    time, moves = inside(response.time), response.ground_acceleration.to_numpy() != 0.0
    end = response.time.to_numpy()[np.flatnonzero(moves)[-1] + 1]
    breaks = np.append(response.event_time.to_numpy(), [0.0, end])
    return np.abs(time[:, None] - breaks).min(axis=1) > (SIDE + 0.5) * STEP


def assert_newton(response, force):
    """Compare a force from differentiation with the base shear."""
    shear, smooth = inside(response.base_shear), is_smooth(response)
    assert smooth.mean() > 0.9
    largest = np.abs(response.base_shear.to_numpy()).max()
    assert largest > 0.1 * BLOCK_MASS * 9.8
    assert np.abs(force - shear)[smooth].max() <= AGREEMENT * largest


def force_on(response, mass):
    """Return mass times horizontal acceleration of one body."""
    sway = acceleration(response.horizontal_displacement.to_numpy())
    return mass * (sway + inside(response.ground_acceleration))


@pytest.mark.parametrize("rotation", ["finite", "small"])
def test_on_rigid_ground(rotation):
    response = run(rotation=rotation)
    assert int(response.impact_count) > 0
    assert_newton(response, force_on(response, BLOCK_MASS))


@pytest.mark.parametrize("rotation", ["finite", "small"])
@pytest.mark.parametrize("rule", ["contact-state", "leading-corner", "centre"])
def test_on_pads(rule, rotation):
    response = run(PADS, restraint=rule, rotation=rotation)
    assert int(response.impact_count) > 0
    assert_newton(response, force_on(response, BLOCK_MASS))


@pytest.mark.parametrize("rule", ["contact-state", "leading-corner", "centre"])
def test_on_soil(rule):
    response = run(SOIL, restraint=rule)
    assert float(response.first_uplift_time) < 1.0
    assert_newton(response, force_on(response, BLOCK_MASS))


def test_block_and_cap_as_one_body_on_soil():
    response = run(CAP, SOIL)
    assert_newton(response, force_on(response, BLOCK_MASS + CAP_MASS))


@pytest.mark.parametrize("rotation", ["finite", "small"])
def test_coupled_stack_on_soil(rotation):
    """Both bodies move with the ground, and the cap's centre sways about the middle of its base."""
    response = run(PADS, CAP, SOIL, restraint="centre", rotation=rotation)
    assert int(response.impact_count) > 0
    tilt = response.cap_rotation.to_numpy()
    sway = 0.5 * CAP_HEIGHT * (np.sin(tilt) if rotation == "finite" else tilt)
    on_cap = CAP_MASS * (acceleration(sway) + inside(response.ground_acceleration))
    assert_newton(response, force_on(response, BLOCK_MASS) + on_cap)


def test_cascade_has_base_shear_of_its_first_stage():
    """The first stage, block and cap as one body, stands on the ground."""
    response = run(PADS, CAP, SOIL, restraint="centre", coupling="cascade")
    both = BLOCK_MASS + CAP_MASS
    centre = (BLOCK_MASS * (CAP_HEIGHT + 4.8) + CAP_MASS * 0.5 * CAP_HEIGHT) / both
    sway = acceleration(centre * np.sin(response.cap_rotation.to_numpy()))
    assert_newton(response, both * (sway + inside(response.ground_acceleration)))
    alone = run(CAP, SOIL, restraint="centre")
    np.testing.assert_allclose(
        response.base_shear, alone.base_shear, rtol=0.0, atol=1e-6 * np.abs(alone.base_shear).max()
    )


def test_in_sliding_contact():
    """The corner touches without pressing: its contact slips and still transmits a force."""
    upwards = rf.GroundMotion.sine_pulse("5.65 m/s^2", "2 Hz")
    response = run(
        rf.TwoSpringSupport(frequency_ratio=27.27, damping_ratio=0.05),
        block=rf.Block(width="4 m", height="6.65 m", mass="50 t"),
        motion=rf.GroundMotion.sine_pulse("-13.7 m/s^2", "2 Hz").with_vertical(upwards),
        restraint="centre",
    )
    # under this rule the held point changes only after the slip of a corner has ended
    (ends,) = np.flatnonzero(response.event_kind == int(EventKind.PIVOT_CHANGE))
    begin, end = response.event_time.to_numpy()[[ends - 1, ends]]
    assert end - begin > 0.05
    slides = (response.time.to_numpy() > begin) & (response.time.to_numpy() < end)
    assert np.abs(response.base_shear.to_numpy()[slides]).max() > 0.01 * BLOCK_MASS
    for side in ("left", "right"):
        assert not response[f"{side}_reaction"].to_numpy()[slides].any()
    assert_newton(response, force_on(response, BLOCK_MASS))


def noise(across, upwards, seed):
    rng = np.random.default_rng(seed)
    both = [np.convolve(rng.normal(size=101), np.ones(5) / 5.0, "same") for _ in "xy"]
    return rf.GroundMotion.from_arrays(
        (across * both[0], "m/s^2"), "0.02 s", vertical=(upwards * both[1], "m/s^2")
    )


@pytest.mark.parametrize("rule", ["contact-state", "leading-corner", "centre"])
def test_base_shear_vanishes_in_flight_over_pads(rule):
    response = run(PADS, motion=noise(8.0, 14.0, 5), restraint=rule, block=SQUAT)
    flies = response.contact_state.to_numpy() == 3
    assert flies.sum() > 50
    shear = response.base_shear.to_numpy()
    assert (shear[flies] == 0.0).all()
    assert np.abs(shear[~flies]).max() > 0.1 * BLOCK_MASS * 9.8


def test_base_shear_vanishes_while_cap_flies_over_soil():
    """Up to rounding, since forces between block and cap are subtracted."""
    upwards = rf.GroundMotion.sine_pulse("25 m/s^2", "3 Hz")
    motion = rf.GroundMotion.sine_pulse("-2 m/s^2", "3 Hz").with_vertical(upwards)
    response = run(PADS, CAP, SOIL, motion=motion, duration="1 s")
    flies = response.soil_contact_state.to_numpy() == 3
    assert flies.sum() > 20
    shear = np.abs(response.base_shear.to_numpy())
    assert shear[flies].max() <= 1e-12 * shear.max()


@pytest.mark.parametrize("parts", [(), (PADS,), (SOIL,), (CAP, SOIL), (PADS, CAP, SOIL)])
def test_base_shear_vanishes_at_rest(parts):
    response = rf.System(BLOCK, *parts).simulate(duration="0.2 s")
    assert np.abs(response.base_shear.to_numpy()).max() <= 1e-9 * BLOCK_MASS


def test_base_shear_of_resting_block_is_mass_times_ground_acceleration():
    """Below tan(theta) times gravity a block on rigid ground stays at rest."""
    response = run(motion=rf.GroundMotion.sine_pulse("2 m/s^2", "1 Hz"))
    assert not response.rotation.any()
    np.testing.assert_allclose(
        response.base_shear, BLOCK_MASS * response.ground_acceleration, rtol=1e-14, atol=1e-9
    )


def test_base_shear_on_pads_settles_under_constant_acceleration():
    """The shear is then mass times acceleration, independent of the rotation."""
    motion = rf.GroundMotion.from_arrays(([-1.0, -1.0], "m/s^2"), "20 s")
    quiet = rf.TwoSpringSupport(frequency_ratio=20, damping_ratio=1.0)
    response = rf.System(BLOCK, quiet).simulate(motion, output_step="0.1 s")
    assert math.isclose(float(response.base_shear[-1]), -BLOCK_MASS, rel_tol=1e-6)
    assert float(response.rotation[-1]) > 1e-3
