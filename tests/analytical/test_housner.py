"""Free rocking on rigid ground: Housner (1963), in closed form and to printed digits."""

import math

import numpy as np
import pytest
from analytical.rigid import (
    GRAVITY,
    RADIUS,
    P,
    free,
    impact_times,
    peaks_between_impacts,
    rigid_block,
)
from scipy.integrate import quad

import rockframe as rf
from rockframe.errors import ModelWarning

pytestmark = pytest.mark.analytical

QUARTERS = {0.25: 0.795365, 0.5: 1.316958, 0.9: 2.993223}
"""p T/4 by initial rotation over theta, as printed."""


@pytest.mark.parametrize("side", [1.0, -1.0])
@pytest.mark.parametrize("theta", [0.05, 0.25])
@pytest.mark.parametrize(("share", "printed"), QUARTERS.items())
def test_period_without_losses(share, printed, theta, side):
    quarter = math.acosh(1.0 / (1.0 - share))
    assert quarter == pytest.approx(printed, abs=6e-7)
    system = rigid_block(theta, restitution=1.0, rotation="small")
    response = free(system, side * share, 40.2 * quarter)
    impacts = impact_times(response)
    np.testing.assert_allclose(impacts, quarter * np.arange(1.0, 40.0, 2.0), rtol=1e-8)
    assert response.peak_relative_rotation.item() == pytest.approx(share, rel=1e-8)
    assert response.impact_count.item() == 20
    assert response.first_uplift_time.item() == 0.0


@pytest.mark.parametrize("share", QUARTERS)
def test_rotation_is_a_hyperbolic_cosine(share):
    theta = 0.2
    system = rigid_block(theta, rotation="small")
    quarter = math.acosh(1.0 / (1.0 - share))
    response = free(system, share, 0.999 * quarter, output_step="7 ms")
    pt = P * response.time.values
    expected = 1.0 - (1.0 - share) * np.cosh(pt)
    np.testing.assert_allclose(response.relative_rotation.values, expected, atol=1e-9)
    rate = -theta * P * (1.0 - share) * np.sinh(pt)
    np.testing.assert_allclose(response.angular_velocity.values, rate, atol=1e-9)


def decay(share, ratio, impacts):
    """Return peak rotations over theta after each impact of the linearised block."""
    shares = ratio ** np.arange(1, impacts + 1) * (1.0 - (1.0 - share) ** 2)
    return 1.0 - np.sqrt(1.0 - shares)


@pytest.mark.parametrize("share", [0.25, 0.5, 0.9])
@pytest.mark.parametrize("restitution", [0.9, 0.6])
def test_amplitude_decays_by_the_square_of_the_restitution(share, restitution):
    system = rigid_block(0.1, restitution=restitution, rotation="small")
    expected = decay(share, restitution**2, 5)
    quarters = np.arccosh(1.0 / (1.0 - expected))
    length = math.acosh(1.0 / (1.0 - share)) + 2.0 * float(quarters.sum())
    response = free(system, share, 0.9999 * length, output_step="2 ms")
    np.testing.assert_allclose(peaks_between_impacts(response), expected, rtol=1e-6)
    times = math.acosh(1.0 / (1.0 - share)) + 2.0 * np.cumsum(quarters[:-1])
    np.testing.assert_allclose(impact_times(response)[1:], times, rtol=1e-8)


def test_printed_decay_of_the_linearised_block():
    ratio = (1.0 - 1.5 * math.sin(0.2) ** 2) ** 2
    printed = [0.420192, 0.357775, 0.307206, 0.265345, 0.230191, 0.200365]
    np.testing.assert_allclose(decay(0.5, ratio, 6), printed, atol=6e-7)
    system = rigid_block(0.2, rotation="small")
    response = free(system, 0.5, 12.0, output_step="2 ms")
    np.testing.assert_allclose(peaks_between_impacts(response)[:6], printed, atol=1e-6)


def test_printed_decay_of_the_nonlinear_block():
    response = free(rigid_block(0.2), 0.5, 12.0, output_step="2 ms")
    times = [1.318504, 3.604495, 5.632523, 7.457080, 9.114102, 10.629155]
    peaks = [0.420356, 0.358023, 0.307494, 0.265648, 0.230494, 0.200658]
    np.testing.assert_allclose(impact_times(response), times, atol=1e-6)
    np.testing.assert_allclose(peaks_between_impacts(response), peaks, atol=1e-6)


def exact_quarter(theta, share):
    """Return p T/4 of the nonlinear block, by energy; a substitution removes the singularity."""
    start = share * theta

    def slowness(u):
        angle = start * (1.0 - u * u)
        gained = 2.0 * (
            2.0 * math.sin(theta - 0.5 * (angle + start)) * math.sin(0.5 * (start - angle))
        )
        return 2.0 * u * start / math.sqrt(gained)

    return quad(slowness, 0.0, 1.0, epsabs=1e-13, epsrel=1e-13)[0]


@pytest.mark.parametrize(
    ("theta", "ratios"),
    [
        (0.05, [1.000131, 1.000073, 1.000019]),
        (0.1, [1.000525, 1.000293, 1.000076]),
        (0.2, [1.002103, 1.001174, 1.000302]),
        (0.3, [1.004744, 1.002646, 1.000681]),
    ],
)
def test_nonlinear_period(theta, ratios):
    system = rigid_block(theta, restitution=1.0)
    for share, printed in zip(QUARTERS, ratios, strict=True):
        exact = exact_quarter(theta, share)
        quarter = math.acosh(1.0 / (1.0 - share))
        impacts = impact_times(free(system, share, 8.0 * exact))
        np.testing.assert_allclose(impacts, exact * np.arange(1.0, 8.0, 2.0), rtol=1e-8)
        assert impacts[0] / quarter == pytest.approx(printed, abs=1e-6)


@pytest.mark.parametrize("slenderness", [0.75, 1.0, 2.0, 4.0, 8.0])
def test_restitution_conserves_the_angular_momentum_about_the_new_corner(slenderness):
    b, h = 1.0, slenderness
    inertia = (b * b + h * h) / 3.0
    corner = inertia + b * b + h * h
    # rocking on one corner: angular momentum about the other one, per unit rate
    about_the_other = inertia + h * h - b * b
    system = rigid_block(math.atan(1.0 / slenderness))
    assert system.setting.restitution.left == pytest.approx(about_the_other / corner, rel=1e-13)
    response = free(system, 0.3, 3.0)
    kind = response.event_kind.values
    before = response.angular_velocity_before.values[kind == 2]
    after = response.angular_velocity_after.values[kind == 2]
    assert len(before) > 0
    np.testing.assert_allclose(after / before, about_the_other / corner, rtol=1e-13)


@pytest.mark.parametrize("rotation", ["finite", "small"])
def test_uplift_starts_at_its_threshold(rotation):
    theta = 0.25
    system = rigid_block(theta, rotation=rotation)
    threshold = GRAVITY * (theta if rotation == "small" else math.tan(theta))
    for sign in (1.0, -1.0):
        still = system.simulate(
            rf.GroundMotion.sine_pulse(f"{sign * threshold * (1.0 - 1e-9)!r} m/s^2", "1 Hz")
        )
        assert math.isnan(still.first_uplift_time.item())
        assert still.peak_rotation.item() == 0.0
        assert (still.contact_state.values == 0).all()
        moved = system.simulate(
            rf.GroundMotion.sine_pulse(f"{sign * threshold * 1.001!r} m/s^2", "1 Hz")
        )
        expected = math.asin(1.0 / 1.001) / (2.0 * math.pi)
        assert moved.first_uplift_time.item() == pytest.approx(expected, rel=1e-7)
        # the ground accelerates to the right: the block leans to the left
        first = np.flatnonzero(moved.rotation.values)[0]
        assert np.sign(moved.rotation.values[first]) == -sign


def test_slow_landing_on_tipping_ground_does_not_come_to_rest():
    """The block bounces on one corner for an instant, and rocks on over the other one."""
    b, h, restitution, ground = 0.5, 2.0, 0.3, -0.27 * GRAVITY
    block = rf.Block(width="1 m", height="4 m", mass="1 t")
    system = rf.System(block, rf.RigidGround(restitution=restitution), gravity=f"{GRAVITY!r} m/s^2")
    motion = rf.GroundMotion.from_arrays(([ground, ground], "m/s^2"), "0.02 s")
    # it lands so slowly that its rebound is below the share of the overturning angle taken as rest
    start, rate = 1e-10, -1e-5
    run = system.simulate(
        motion,
        initial=rf.InitialState(rotation=f"{start!r} rad", angular_velocity=f"{rate!r} rad/s"),
        accuracy="reference",
    )
    inertia = 4.0 * (b * b + h * h) / 3.0
    back = (GRAVITY * b - ground * h) / inertia  # about the left corner
    away = (-GRAVITY * b - ground * h) / inertia  # about the right one
    landing = math.sqrt(rate * rate - 2.0 * away * start)
    bounce = 2.0 * restitution * landing / back
    assert back > 0.0
    assert away > 0.0
    assert run.event_kind.values.tolist() == [2, 2]  # impacts, and no rest
    assert np.diff(run.event_time.values)[0] == pytest.approx(bounce, rel=1e-4)
    speeds = [-restitution * landing, restitution**2 * landing]
    assert run.angular_velocity_after.values == pytest.approx(speeds, rel=1e-6)


def test_ramp_lifts_block_at_uplift_threshold():
    theta = 0.25
    system = rigid_block(theta)
    ramp = rf.GroundMotion.from_arrays(([0.0, 4.0], "m/s^2"), "1 s")
    response = system.simulate(ramp, output_step="10 ms")
    expected = GRAVITY * math.tan(theta) / 4.0
    assert response.first_uplift_time.item() == pytest.approx(expected, rel=1e-10)


@pytest.mark.parametrize("vertical", [-3.0, 2.0])
def test_a_steady_vertical_acceleration_acts_as_gravity(vertical):
    share, quarter = 0.5, math.acosh(2.0)
    system = rigid_block(0.2, restitution=1.0, rotation="small")
    steady = rf.GroundMotion.from_arrays(
        ([0.0] * 3, "m/s^2"), "20 s", vertical=([vertical] * 3, "m/s^2")
    )
    response = system.simulate(
        steady,
        initial=rf.InitialState(rotation="0.1 rad"),
        accuracy="reference",
        output_step="0.1 s",
    )
    assert response.overturning_angle.item() == pytest.approx(0.2, rel=1e-14)
    rate = P * math.sqrt(1.0 + vertical / GRAVITY)
    times = response.event_time.values
    expected = quarter / rate * np.arange(1.0, 2.0 * len(times), 2.0)
    np.testing.assert_allclose(times, expected, rtol=1e-8)
    assert share == pytest.approx(response.peak_relative_rotation.item(), rel=1e-8)


# velocity step -----------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("slenderness", "height", "printed"), [(4.0, 2.0, 0.924895), (6.0, 6.0, 1.054801)]
)
def test_overturning_velocity_step_in_closed_form(slenderness, height, printed):
    """A sudden ground velocity V gives the angular momentum m h V about the corner."""
    theta = math.atan(1.0 / slenderness)
    radius = 0.5 * height / math.cos(theta)
    corner_inertia = 4.0 / 3.0 * radius**2
    for gravity in (9.80665, 9.81):
        closed = math.sqrt(8.0 * gravity * radius / 3.0 * (1.0 - math.cos(theta)))
        closed /= math.cos(theta)
        if gravity == 9.81:
            assert closed == pytest.approx(printed, abs=6e-7)
        block = rf.Block.from_size(radius=f"{radius!r} m", slenderness=slenderness, mass="1 t")
        system = rf.System(block, gravity=f"{gravity!r} m/s^2")
        for factor, overturns in ((1.0 + 1e-6, True), (1.0 - 1e-6, False)):
            rate = -0.5 * height * closed * factor / corner_inertia
            response = system.simulate(
                duration="30 s",
                initial=rf.InitialState(angular_velocity=f"{rate!r} rad/s"),
                accuracy="reference",
            )
            assert response.overturned.item() is overturns
            assert response.overturning_direction.item() == (-1 if overturns else 0)
            if overturns:
                assert response.impact_count.item() == 0
            else:
                assert response.peak_relative_rotation.item() == pytest.approx(1.0, abs=3e-3)


def test_a_short_strong_pulse_is_a_velocity_step():
    """The same by an acceleration of 1 microsecond, after which the rate is -h V m/I_corner."""
    system = rigid_block(0.2)
    speed, length = 0.3, 1e-6
    peak = 2.0 * speed / length
    blow = rf.GroundMotion.from_arrays(([0.0, peak, 0.0], "m/s^2"), f"{0.5 * length!r} s")
    response = system.simulate(blow, accuracy="reference")
    h = RADIUS * math.cos(0.2)
    expected = -h * speed / (4.0 / 3.0 * RADIUS**2)
    assert response.angular_velocity.values[-1] == pytest.approx(expected, rel=1e-4)


def test_ground_tension_warns():
    """A squat block at high speed: at impact m (g - R0 cos(theta) a'^2 ...) is negative."""
    system = rf.System(rf.Block(width="2 m", height="2 m", mass="1 t"))
    fast = rf.InitialState(rotation="0.1 rad", angular_velocity="-4 rad/s")
    with pytest.warns(ModelWarning, match=r"the ground would have to pull .* TwoSpringSupport"):
        response = system.simulate(duration="0.2 s", initial=fast)
    assert "the ground would have to pull" in response.attrs["cautions"]
