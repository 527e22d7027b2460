"""A sliding contact is the limit of dry friction, stays level, dissipates, and is symmetric.

Equations eq-sliding-contact, eq-partial-hold and eq-leaving-into-flight of the theory manual.
"""

from itertools import pairwise

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from rockframe.dynamics.base_numbers import bed_numbers, pads_numbers
from rockframe.dynamics.body import CENTRE
from rockframe.dynamics.events import EventKind
from rockframe.dynamics.on_base import is_lifted, speed_noise
from rockframe.dynamics.protocol import Start
from rockframe.dynamics.single_body import rigid_body, single_body
from rockframe.signals import Motion
from rockframe.solve.accuracy import accuracy_of
from rockframe.solve.integrate import integrate

pytestmark = pytest.mark.analytical

G, B, H = 9.81, 0.5, 2.0
INERTIA = (B * B + H * H) / 3.0
K, C = 4e3, 60.0  # of one pad, per unit mass
DELTA = 0.5 * G / K
TILT, SPIN = 1.0, -1.5  # far beyond overturning, and on its way back
STILL = Motion.of_samples(1.0, np.zeros(2), np.zeros(2))
TIME = 0.12


def lever(alpha, side):
    return H * np.sin(alpha) + side * B * np.cos(alpha)


def level(alpha, y, side):
    return y + H * (1.0 - np.cos(alpha)) + side * B * np.sin(alpha)


def block(half_width, height, restraint):
    return rigid_body(
        left=half_width,
        right=half_width,
        height=height,
        inertia=(half_width**2 + height**2) / 3.0,
        restraint=restraint,
        small_rotation=False,
        gravity=G,
    )


def on_pads(body, stiffness, damping):
    base = pads_numbers(body, stiffness=stiffness, damping=damping, restitution=(0.9, 0.9))
    return single_body("two-spring", body, base, mass=1.0)


def pads(restraint=0):
    return on_pads(block(B, H, restraint), K, C)


def bed(restraint=0):
    body = block(B, H, restraint)
    base = bed_numbers(body, stiffness=K / B, damping=C / B, by_pressure=False)
    return single_body("Winkler", body, base, mass=1.0)


def slides(model, modes):
    """Return in which modes an end of the base slides."""
    return np.array([model.system.part.mode_of(int(mode)).slides for mode in modes])


def drop(model, sign=1.0, speed=-0.05, duration=TIME):
    """Drop the rotating block on its lower corner, without sway."""
    y = DELTA * (1.0 + 1e-9) - H * (1.0 - np.cos(TILT)) + B * np.sin(TILT)
    # the lower corner lands at `speed`
    rate = speed - lever(TILT, -1.0) * SPIN
    return integrate(
        model,
        Start(sign * TILT, sign * SPIN, y, rate),
        STILL,
        accuracy_of("reference"),
        duration=duration,
        output_step=duration / 60.0,
        stop_at_overturning=False,
    )


def dry_friction_reference(start, coefficient, times):
    """Integrate the corner on its pad against dry friction while it slips."""

    def rates(t, z):
        alpha, y, _, spin, speed, sway = z
        arm, reach = lever(alpha, -1.0), H * np.cos(alpha) + B * np.sin(alpha)
        rate = speed + arm * spin
        pressing = max(K * (DELTA - level(alpha, y, -1.0)) - C * rate, 0.0)
        hold = -coefficient * pressing * np.sign(sway - reach * spin)
        turn = (pressing * arm - reach * hold) / INERTIA
        return [spin, speed, sway, turn, pressing - G, hold]

    return solve_ivp(
        rates, (0.0, times[-1]), start, method="DOP853", t_eval=times, rtol=1e-9, atol=1e-12,
        max_step=2e-4,
    ).y  # fmt: skip


def test_sliding_contact_is_the_limit_of_dry_friction():
    model = pads()
    run = drop(model)
    landing = list(run.events.kind).index(EventKind.IMPACT)
    assert slides(model, run.events.mode_after)[landing]
    sliding = (run.time > run.events.time[landing]) & slides(model, run.mode)
    assert sliding.sum() > 20
    times = run.time[sliding] - run.events.time[landing]
    differences = []
    for coefficient in (40.0, 160.0, 640.0):
        z = dry_friction_reference(run.events.state_after[landing], coefficient, times)
        gap = np.abs(z[[0, 3, 5]] - run.state[sliding][:, [0, 3, 5]].T).max(axis=1)
        differences.append(gap)
    # the difference is proportional to the reciprocal of the coefficient
    for coarse, fine in pairwise(differences):
        assert (fine < 0.4 * coarse).all()
    assert differences[-1].max() < 5e-3


@pytest.mark.parametrize("model", [pads, bed])
@pytest.mark.parametrize("restraint", range(3))
def test_sliding_corner_stays_level_and_dissipates(model, restraint):
    one = model(restraint)
    run = drop(one)
    sliding = slides(one, run.mode)
    assert sliding.sum() > 5
    assert (one.moving(run.mode[sliding]) == 3).all()
    alpha, y, _, spin, speed, _ = run.state[sliding].T
    assert np.abs(level(alpha, y, -1.0) - DELTA).max() < 1e-9
    assert np.abs(speed + lever(alpha, -1.0) * spin).max() < 1e-9
    assert run.energy_residual < 1e-9
    stored = []
    for mode, state in zip(run.mode[sliding], run.state[sliding], strict=True):
        kinetic, gravity, _, from_rest = one.system.energies(int(mode), state)
        stored.append(kinetic + gravity + from_rest)
    assert (np.diff(stored) < 0.0).all()


@pytest.mark.parametrize("model", [pads, bed])
@pytest.mark.parametrize("restraint", range(3))
def test_sliding_on_the_left_mirrors_sliding_on_the_right(model, restraint):
    one, other = (drop(model(restraint), sign, duration=0.6) for sign in (1.0, -1.0))
    turned = np.array([-1.0, 1.0, -1.0, -1.0, 1.0, -1.0])
    # pads are mirrored bit for bit; positions along a bed are measured from its left end
    slack = 0.0 if model is pads else 1e-10
    np.testing.assert_allclose(other.state, one.state * turned, rtol=0.0, atol=slack)
    np.testing.assert_allclose(other.events.time, one.events.time, rtol=slack)
    np.testing.assert_array_equal(other.events.kind, one.events.kind)


def test_fast_landing_corner_does_not_slide():
    """It lands so fast that static friction cannot stop it."""
    model = pads()
    run = drop(model, speed=-3.0)
    landing = list(run.events.kind).index(EventKind.IMPACT)
    assert not slides(model, run.events.mode_after)[landing]


# separation into flight ---------------------------------------------------------------

SQUAT_B, SQUAT_H, SQUAT_K, SQUAT_C = 1.0, 1.7, 770.0, 20.0


def leaving(sign=1.0, duration=0.3):
    """Throw a squat block, held at the middle of its base, off its right pad."""
    model = on_pads(block(SQUAT_B, SQUAT_H, CENTRE), SQUAT_K, SQUAT_C)
    run = integrate(
        model,
        Start(sign * 0.5, sign * 1.86, None, 0.38),
        STILL,
        accuracy_of("reference"),
        duration=duration,
        output_step=1e-3,
        stop_at_overturning=False,
    )
    return model, run


def right_pad(alpha, y, spin, speed):
    """Return the force of the right pad's law."""
    b, h, k, c = SQUAT_B, SQUAT_H, SQUAT_K, SQUAT_C
    rise = y + h * (1.0 - np.cos(alpha)) - b * np.sin(alpha)
    rate = speed + (h * np.sin(alpha) - b * np.cos(alpha)) * spin
    return k * (0.5 * G / k - rise) - c * rate


def squat_dry_friction_reference(start, coefficient, times):
    """Integrate the same block with regularised dry friction at the middle of its base."""
    b, h = SQUAT_B, SQUAT_H
    inertia = (b * b + h * h) / 3.0

    def rates(t, z):
        alpha, y, _, spin, speed, sway = z
        arm, reach = h * np.sin(alpha) - b * np.cos(alpha), h * np.cos(alpha)
        pressing = max(right_pad(alpha, y, spin, speed), 0.0)
        hold = -coefficient * pressing * np.tanh((sway - reach * spin) / 1e-5)
        return [spin, speed, sway, (pressing * arm - reach * hold) / inertia, pressing - G, hold]

    return solve_ivp(
        rates, (0.0, times[-1]), start, method="LSODA", t_eval=times, rtol=1e-9, atol=1e-12,
        max_step=1e-4,
    ).y  # fmt: skip


def test_corner_slides_along_relaxing_pad_until_flight():
    """It separates if held and is pressed at once if free: the limit of dry friction is between."""
    model, run = leaving()
    separates = run.events.kind == EventKind.SEPARATION
    left = np.flatnonzero(separates & slides(model, run.events.mode_after))[0]
    begin = run.events.time[left]
    sliding = (run.time > begin) & slides(model, run.mode)
    assert sliding.sum() > 50
    alpha, y, _, spin, speed, _ = run.state[sliding].T
    # below the level of the unloaded pad, without force
    rise = y + 1.7 * (1.0 - np.cos(alpha)) - np.sin(alpha)
    assert (rise < 0.99 * 0.5 * G / 770.0).sum() > 10
    assert np.abs(right_pad(alpha, y, spin, speed)).max() < 1e-9 * G
    assert run.energy_residual < 1e-11
    times = run.time[sliding] - begin
    gaps = []
    for coefficient in (20.0, 80.0, 320.0):
        z = squat_dry_friction_reference(run.events.state_after[left], coefficient, times)
        gaps.append(np.abs(z[[0, 3, 5]] - run.state[sliding][:, [0, 3, 5]].T).max(axis=1))
    for coarse, fine in pairwise(gaps):
        assert (fine < 0.4 * coarse).all()
    assert gaps[-1].max() < 5e-3


def test_separation_into_flight_is_mirror_symmetric():
    (_, one), (_, other) = leaving(), leaving(-1.0)
    turned = np.array([-1.0, 1.0, -1.0, -1.0, 1.0, -1.0])
    np.testing.assert_array_equal(other.state, one.state * turned)
    np.testing.assert_array_equal(other.events.kind, one.events.kind)


def test_fixed_steps_are_refined_while_corner_slides_on_fast_pad():
    """A weak dashpot relaxes within a sixth of the step required by the vibrations."""
    model = on_pads(block(1.0, 1.705, CENTRE), 840.0, 1.45)
    ground = Motion.of_samples(0.01, np.zeros(51), np.zeros(51))
    fast, exact = (
        integrate(
            model,
            Start(0.5422, 1.7868, None, 0.4153),
            ground,
            accuracy_of(level),
            duration=0.5,
            output_step=0.005,
            stop_at_overturning=False,
        )
        for level in ("fast", "reference")
    )
    assert 840.0 / 1.45 * 0.01 / fast.substeps > 3.0
    assert slides(model, fast.mode).sum() > 10
    assert fast.step_count > 1.5 * 50 * fast.substeps
    assert np.abs(fast.state - exact.state).max() < 2e-3
    assert fast.energy_residual < 1e-3


def test_rounding_error_of_speed_counts_as_zero():
    """An end is at rest, up to rounding, where the body's velocity cancels its rotation."""
    rng = np.random.default_rng(4)
    differing = 0
    for speed, lever in rng.normal(size=(200, 2)).tolist():
        rate = -speed / lever
        noise = speed_noise(speed, lever, rate)
        left = speed + lever * rate
        differing += left != 0.0
        assert is_lifted(left, left, noise)
        assert noise < 1e-14 * abs(speed)
        clearly = 1e-13 * abs(speed)
        assert not is_lifted(clearly, clearly, noise)  # it rises
        assert not is_lifted(-clearly, -clearly, noise)  # it moves down
        assert is_lifted(-clearly, clearly, noise)
    assert differing > 10
