"""Two pads that never lose contact: damped oscillators with exact solutions."""

import math
import re

import numpy as np
import pytest
from analytical.pads import Pads, oscillator, rough_record, zero_crossings
from overdamping import overdamped

import rockframe as rf
from rockframe.errors import ModelWarning

pytestmark = pytest.mark.analytical

GOLDEN = Pads(gravity=9.81)
RULES = ("contact-state", "leading-corner", "centre")
STEP = 0.005


def relative_error(found, expected):
    """Return the largest difference over the largest expected value."""
    return np.abs(found - expected).max() / np.abs(expected).max()


def number(text, label):
    found = re.search(rf"{label}\s*=?\s*([-+0-9.e]+)", text)
    assert found is not None, f"no {label} in {text}"
    return float(found.group(1))


# golden set --------------------------------------------------------------------------------


def test_golden_numbers_in_the_description():
    text = GOLDEN.system().describe()
    assert number(text, r"theta, Eq\. \(1\)") == pytest.approx(0.2449787, abs=6e-7)
    assert number(text, r"uplift angle, Eq\. \(16\)") == pytest.approx(0.0137441, abs=6e-8)
    assert number(text, r"omega, Eq\. \(6\)") == pytest.approx(1.2130540, abs=6e-6)
    assert number(text, r"settlement delta") == pytest.approx(0.0166667, abs=6e-8)
    periods = [float(found) for found in re.findall(r"period ([0-9.e+-]+) s", text)]
    assert periods == pytest.approx([0.2589821, 1.2400640], abs=6e-6)
    ratios = [float(found) for found in re.findall(r"damping ratio ([0-9.e+-]+)", text)]
    rocking = 0.5 * GOLDEN.rocking_damping / GOLDEN.omega_r
    assert ratios == pytest.approx([0.1, rocking], rel=1e-5)


def test_golden_numbers_in_the_dataset():
    response = GOLDEN.system().simulate(duration="0.01 s")
    assert response.overturning_angle.item() == pytest.approx(0.2449787, abs=6e-8)
    assert response.uplift_angle.item() == pytest.approx(0.0137441, abs=6e-8)
    relative = response.relative_vertical_displacement
    assert (relative.values == response.vertical_displacement.values / GOLDEN.delta).all()
    settled = GOLDEN.system().simulate(
        duration="0.01 s", initial=rf.InitialState(vertical_displacement="1 mm")
    )
    ratio = settled.vertical_displacement[0] / settled.relative_vertical_displacement[0]
    assert ratio.item() == pytest.approx(0.0166667, abs=6e-8)


def test_vertical_period():
    free = Pads(gravity=9.81, damping_ratio=0.0)
    response = free.system().simulate(
        duration="10 s",
        initial=rf.InitialState(vertical_displacement="1 mm"),
        output_step="1 ms",
        accuracy="reference",
    )
    crossings = zero_crossings(
        response.time.values,
        response.vertical_displacement.values,
        response.vertical_velocity.values,
    )
    period = 2.0 * np.diff(crossings).mean()
    assert period == pytest.approx(2.0 * math.pi / free.omega_v, rel=1e-9)
    assert period == pytest.approx(0.2589821, abs=6e-8)
    assert response.vertical_displacement.max().item() == pytest.approx(1e-3, rel=1e-9)
    assert (response.rotation.values == 0.0).all()


@pytest.mark.parametrize("rotation", ["small", "finite"])
def test_rocking_period(rotation):
    free = Pads(gravity=9.81, damping_ratio=0.0)
    response = free.system(rotation=rotation).simulate(
        duration="30 s",
        initial=rf.InitialState(rotation="1e-6 rad", vertical_displacement="0 m"),
        output_step="5 ms",
        accuracy="reference",
    )
    assert response.impact_count.item() == 0
    crossings = zero_crossings(
        response.time.values, response.rotation.values, response.angular_velocity.values
    )
    period = 2.0 * np.diff(crossings).mean()
    assert period == pytest.approx(2.0 * math.pi / free.omega_r, rel=1e-8)
    assert period == pytest.approx(1.2400640, abs=6e-8)


@pytest.mark.parametrize("stiffness", ["beta", "N/m"])
def test_stiffness_and_frequency_ratio_are_equivalent(stiffness):
    parameters = (
        {"frequency_ratio": GOLDEN.beta, "damping_ratio": 0.1}
        if stiffness == "beta"
        else {
            "stiffness": f"{GOLDEN.k * GOLDEN.mass!r} N/m",
            "damping": f"{GOLDEN.c * GOLDEN.mass!r} N*s/m",
        }
    )
    block = rf.Block.from_size(radius="5 m", slenderness=4, mass="50 t")
    response = rf.System(block, rf.TwoSpringSupport(**parameters), gravity="9.81 m/s^2").simulate(
        duration="1 s", initial=rf.InitialState(vertical_displacement="1 mm")
    )
    damped = 0.1 * GOLDEN.omega_v
    turning = math.sqrt(GOLDEN.omega_v**2 - damped**2)
    t = response.time.values
    expected = np.exp(-damped * t) * (np.cos(turning * t) + damped / turning * np.sin(turning * t))
    assert relative_error(response.vertical_displacement.values, 1e-3 * expected) < 1e-6


# exact recurrences -----------------------------------------------------------------------------


@overdamped
@pytest.mark.parametrize("xi", [0.0, 0.05, 0.4, 1.0, 3.0])
@pytest.mark.parametrize("beta", [10.0, 40.0])
def test_vertical_motion_is_a_damped_oscillator(beta, xi):
    pads = Pads(beta=beta, damping_ratio=xi)
    upwards = rough_record(401, STEP, 1.0 if xi else 0.2, seed=1)
    motion = rf.GroundMotion.from_arrays(
        (np.zeros(401), "m/s^2"), f"{STEP} s", vertical=(upwards, "m/s^2")
    )
    response = pads.system().simulate(motion, accuracy="reference")
    y, rate = oscillator(pads.omega_v, 2.0 * xi * pads.omega_v, -upwards, STEP)
    assert relative_error(response.vertical_displacement.values, y) < 1e-9
    assert relative_error(response.vertical_velocity.values, rate) < 1e-9
    assert (response.rotation.values == 0.0).all()
    assert (response.contact_state.values == 0).all()
    assert (response.vertical_ground_acceleration.values == upwards).all()
    reaction = pads.mass * (pads.k * (pads.delta - y) - pads.c * rate)
    for name in ("left_reaction", "right_reaction"):
        assert relative_error(response[name].values, reaction) < 1e-9


@pytest.mark.parametrize("rule", RULES)
@pytest.mark.parametrize("rotation", ["small", "finite"])
@pytest.mark.parametrize(("slenderness", "xi"), [(4.0, 0.1), (2.0, 0.0), (6.0, 0.4)])
def test_weak_horizontal_motion_is_a_damped_oscillator(slenderness, xi, rotation, rule):
    # the neglected terms are of second order in the rotation, and of first order where the
    # leading corner is held (x' = h + b |a|): both are negligible in so weak a motion
    pads = Pads(slenderness=slenderness, damping_ratio=xi)
    across = rough_record(401, STEP, 1e-5 if rule == "leading-corner" else 1e-4, seed=2)
    motion = rf.GroundMotion.from_arrays((across, "m/s^2"), f"{STEP} s")
    response = pads.system(rotation=rotation, restraint=rule).simulate(motion, accuracy="reference")
    force = -pads.h * across / pads.rocking_inertia
    angle, rate = oscillator(pads.omega_r, pads.rocking_damping, force, STEP)
    assert 1e-9 < np.abs(angle).max() < 1e-6
    assert relative_error(response.rotation.values, angle) < 1e-8
    assert relative_error(response.angular_velocity.values, rate) < 1e-8
    assert relative_error(response.horizontal_displacement.values, pads.h * angle) < 1e-6
    assert (response.contact_state.values == 0).all()
    assert (response.ground_acceleration.values == across).all()
    tilt = pads.k * pads.b * angle + pads.c * pads.b * rate
    difference = response.right_reaction.values - response.left_reaction.values
    assert relative_error(difference, 2.0 * pads.mass * tilt) < 1e-6
    assert response.peak_rotation.item() >= np.abs(response.rotation.values).max()


def test_motion_on_both_axes_superposes_at_small_rotation():
    pads = Pads()
    across = rough_record(401, STEP, 1e-6, seed=3)
    upwards = rough_record(401, STEP, 1e-6, seed=4)
    motion = rf.GroundMotion.from_arrays(
        (across, "m/s^2"), f"{STEP} s", vertical=(upwards, "m/s^2")
    )
    response = pads.system().simulate(motion, accuracy="reference")
    y, _ = oscillator(pads.omega_v, 2.0 * pads.c, -upwards, STEP)
    force = -pads.h * across / pads.rocking_inertia
    angle, _ = oscillator(pads.omega_r, pads.rocking_damping, force, STEP)
    assert relative_error(response.vertical_displacement.values, y) < 1e-6
    assert relative_error(response.rotation.values, angle) < 1e-6


def test_free_vibration_equals_motion_padded_with_zeros():
    pads = Pads(damping_ratio=0.02)
    upwards = np.zeros(401)
    upwards[:41] = rough_record(41, STEP, 0.5, seed=5)
    combined = rf.GroundMotion.from_arrays(
        (np.zeros(401), "m/s^2"), f"{STEP} s", vertical=(upwards, "m/s^2")
    )
    short = rf.GroundMotion.from_arrays(
        (np.zeros(41), "m/s^2"), f"{STEP} s", vertical=(upwards[:41], "m/s^2")
    )
    expected, _ = oscillator(pads.omega_v, 2.0 * pads.c, -upwards, STEP)
    for response in (
        pads.system().simulate(combined, accuracy="reference"),
        pads.system().simulate(short, duration="2 s", accuracy="reference"),
        pads.system().simulate(short, free_vibration="1.8 s", accuracy="reference"),
    ):
        assert response.sizes["time"] == 401
        assert response.time.values[-1] == pytest.approx(2.0, abs=1e-12)
        assert relative_error(response.vertical_displacement.values, expected) < 1e-9


# statics -------------------------------------------------------------------------------------


@pytest.mark.parametrize("rule", RULES)
@pytest.mark.parametrize("side", [1.0, -1.0])
@pytest.mark.parametrize("slenderness", [2.0, 4.0, 6.0])
def test_vertical_equilibrium_start_supports_weight(slenderness, side, rule):
    pads = Pads(slenderness=slenderness)
    weight = pads.mass * pads.gravity
    for share in (0.01, 0.3, 0.999, 1.001, 2.0, 5.0):
        angle = share * math.asin(pads.delta / pads.b)
        response = (
            pads.system(restraint=rule)
            .simulate(duration="1 ms", initial=rf.InitialState(rotation=f"{side * angle!r} rad"))
            .isel(time=0)
        )
        left, right = response.left_reaction.item(), response.right_reaction.item()
        assert left + right == pytest.approx(weight, rel=1e-12)
        rise = pads.h * (1.0 - math.cos(angle))
        bearing = right if side > 0.0 else left
        if share < 1.0:
            assert response.contact_state.item() == 0
            expected = weight * 0.5 + pads.mass * pads.k * pads.b * math.sin(angle)
            y = -rise
        else:
            assert response.contact_state.item() == (2 if side > 0.0 else 1)
            expected = weight
            y = pads.b * math.sin(angle) - rise - pads.delta
        assert bearing == pytest.approx(expected, rel=1e-12)
        assert response.vertical_displacement.item() == pytest.approx(y, abs=1e-14)


@pytest.mark.parametrize("rotation", ["finite", "small"])
@pytest.mark.parametrize(("slenderness", "beta", "mu"), [(2.0, 10.0, 3.0), (6.0, 40.0, 1.153)])
def test_uplift_angle(slenderness, beta, mu, rotation):
    pads = Pads(slenderness=slenderness, beta=beta, mu=mu)
    ratio = (1.0 + mu) / (mu * beta**2 * math.sin(pads.theta))
    expected = math.asin(ratio) if rotation == "finite" else ratio
    system = pads.system(rotation=rotation)
    for factor, lifted in ((1.0 + 1e-9, True), (1.0 - 1e-9, False)):
        start = rf.InitialState(rotation=f"{expected * factor!r} rad")
        response = system.simulate(duration="1 us", initial=start)
        assert response.uplift_angle.item() == pytest.approx(expected, rel=1e-13)
        assert bool(response.contact_state.values[0] == 2) is lifted
        if lifted:
            assert response.first_uplift_time.item() == 0.0


def test_pads_too_soft_to_lift_have_no_uplift_angle():
    pads = Pads(beta=1.5, slenderness=1.0)
    ratio = (1.0 + pads.mu) / (pads.mu * pads.beta**2 * math.sin(pads.theta))
    response = pads.system().simulate(duration="1 ms")
    assert response.uplift_angle.item() == pytest.approx(math.asin(ratio), rel=1e-13)
    softer = Pads(beta=1.2, slenderness=1.0)
    with pytest.warns(ModelWarning, match="too soft"):
        system = softer.system()
    assert (1.0 + pads.mu) / (pads.mu * softer.beta**2 * math.sin(pads.theta)) > 1.0
    response = system.simulate(duration="1 ms")
    assert math.isnan(response.uplift_angle.item())
    assert "never" in system.describe()


def test_pads_below_stability_limit_warn_and_block_overturns():
    limit = math.sqrt(Pads().gravity * Pads().h) / Pads().b / Pads().omega
    Pads(beta=limit * (1.0 + 1e-9)).system()
    with pytest.warns(ModelWarning, match="too soft"):
        system = Pads(beta=limit * 0.9).system()
    response = system.simulate(
        duration="200 s",
        initial=rf.InitialState(rotation="1e-6 rad"),
        outputs=None,
    )
    assert response.overturned.item()
