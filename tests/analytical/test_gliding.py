"""A gliding corner is the limit of dry friction, keeps its level, burns, and has no side."""

from itertools import pairwise

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from rockframe.dynamics.pad import CONTACTS
from rockframe.dynamics.protocol import EventKind, Start
from rockframe.dynamics.two_spring import GLIDING
from rockframe.dynamics.two_spring_model import two_spring
from rockframe.dynamics.winkler_model import winkler
from rockframe.solve.accuracy import accuracy_of
from rockframe.solve.ground_table import Ground
from rockframe.solve.integrate import integrate

pytestmark = pytest.mark.analytical

G, B, H = 9.81, 0.5, 2.0
INERTIA = (B * B + H * H) / 3.0
K, C = 4e3, 60.0  # of one pad, per unit mass
DELTA = 0.5 * G / K
TILT, SPIN = 1.0, -1.5  # far beyond overturning, and on its way back
STILL = Ground(time_step=1.0, horizontal=np.zeros(2), vertical=np.zeros(2))
TIME = 0.12


def lever(alpha, side):
    return H * np.sin(alpha) + side * B * np.cos(alpha)


def level(alpha, y, side):
    return y + H * (1.0 - np.cos(alpha)) + side * B * np.sin(alpha)


def pads(restraint=0):
    return two_spring(
        half_width=B,
        half_height=H,
        shape_factor=3.0,
        mass=1.0,
        stiffness=K,
        damping=C,
        restitution=0.9,
        restraint=restraint,
        small_rotation=False,
        gravity=G,
    )


def bed(restraint=0):
    return winkler(
        half_width=B,
        centre_height=H,
        inertia=INERTIA,
        mass=1.0,
        stiffness=K / B,
        damping=C / B,
        by_pressure=False,
        restraint=restraint,
        small_rotation=False,
        gravity=G,
    )


def drop(model, sign=1.0, speed=-0.05, duration=TIME):
    """Let the block down on its lower corner, turning, without sway."""
    y = DELTA * (1.0 + 1e-9) - H * (1.0 - np.cos(TILT)) + B * np.sin(TILT)
    # the lower corner comes down at `speed`
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


def by_friction(start, coefficient, times):
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


def test_gliding_is_the_limit_of_dry_friction():
    run = drop(pads())
    landing = list(run.events.kind).index(EventKind.IMPACT)
    assert run.events.mode_after[landing] // CONTACTS >= GLIDING
    gliding = (run.time > run.events.time[landing]) & (run.mode // CONTACTS >= GLIDING)
    assert gliding.sum() > 20
    times = run.time[gliding] - run.events.time[landing]
    differences = []
    for coefficient in (40.0, 160.0, 640.0):
        z = by_friction(run.events.state_after[landing], coefficient, times)
        gap = np.abs(z[[0, 3, 5]] - run.state[gliding][:, [0, 3, 5]].T).max(axis=1)
        differences.append(gap)
    # the distance falls with the reciprocal of the coefficient
    for coarse, fine in pairwise(differences):
        assert (fine < 0.4 * coarse).all()
    assert differences[-1].max() < 5e-3


@pytest.mark.parametrize("model", [pads, bed])
@pytest.mark.parametrize("restraint", range(3))
def test_a_gliding_corner_keeps_its_level_and_burns(model, restraint):
    one = model(restraint)
    run = drop(one)
    gliding = one.active[run.mode] == 3
    gliding &= one.contact[run.mode] != 3
    assert gliding.sum() > 5
    alpha, y, _, spin, speed, _ = run.state[gliding].T
    assert np.abs(level(alpha, y, -1.0) - DELTA).max() < 1e-9
    assert np.abs(speed + lever(alpha, -1.0) * spin).max() < 1e-9
    assert run.energy_residual < 1e-9
    out = np.zeros(4)
    stored = []
    for mode, state in zip(run.mode[gliding], run.state[gliding], strict=True):
        one.energy(int(mode), state, one.parameters, out)
        stored.append(out[0] + out[1] + out[3])
    assert (np.diff(stored) < 0.0).all()


@pytest.mark.parametrize("model", [pads, bed])
@pytest.mark.parametrize("restraint", range(3))
def test_gliding_on_the_left_mirrors_gliding_on_the_right(model, restraint):
    one, other = (drop(model(restraint), sign, duration=0.6) for sign in (1.0, -1.0))
    turned = np.array([-1.0, 1.0, -1.0, -1.0, 1.0, -1.0])
    # pads are mirrored bit for bit; along a bed places are counted from its left end
    slack = 0.0 if model is pads else 1e-10
    np.testing.assert_allclose(other.state, one.state * turned, rtol=0.0, atol=slack)
    np.testing.assert_allclose(other.events.time, one.events.time, rtol=slack)
    np.testing.assert_array_equal(other.events.kind, one.events.kind)


def test_a_corner_that_presses_after_the_hold_does_not_glide():
    """It comes down so fast that the hold cannot stop it."""
    run = drop(pads(), speed=-3.0)
    landing = list(run.events.kind).index(EventKind.IMPACT)
    assert run.events.mode_after[landing] // CONTACTS < GLIDING


# a corner that leaves into flight ---------------------------------------------------------------

SQUAT = {"half_width": 1.0, "half_height": 1.7, "stiffness": 770.0, "damping": 20.0}


def leaving(sign=1.0, duration=0.3):
    """Throw a squat block, held at the middle of its base, off its right pad."""
    model = two_spring(
        **SQUAT, shape_factor=3.0, mass=1.0, restitution=0.9, restraint=2, small_rotation=False,
        gravity=G,
    )  # fmt: skip
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
    """Give the force of the right pad's law."""
    b, h, k, c = SQUAT.values()
    rise = y + h * (1.0 - np.cos(alpha)) - b * np.sin(alpha)
    rate = speed + (h * np.sin(alpha) - b * np.cos(alpha)) * spin
    return k * (0.5 * G / k - rise) - c * rate


def squat_by_friction(start, coefficient, times):
    """Integrate the same block with dry friction at the middle of its base, regularised."""
    b, h, _, _ = SQUAT.values()
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


def test_a_corner_that_flight_would_press_glides_along_its_relaxing_pad():
    """Held it leaves, free it would be pressed at once: the limit of dry friction lies between."""
    _, run = leaving()
    left = next(
        i for i, mode in enumerate(run.events.mode_after)
        if run.events.kind[i] == EventKind.SEPARATION and mode // CONTACTS >= GLIDING
    )  # fmt: skip
    begin = run.events.time[left]
    gliding = (run.time > begin) & (run.mode // CONTACTS >= GLIDING)
    assert gliding.sum() > 50
    alpha, y, _, spin, speed, _ = run.state[gliding].T
    # below the level of the unloaded pad, with no force
    rise = y + 1.7 * (1.0 - np.cos(alpha)) - np.sin(alpha)
    assert (rise < 0.99 * 0.5 * G / 770.0).sum() > 10
    assert np.abs(right_pad(alpha, y, spin, speed)).max() < 1e-9 * G
    assert run.energy_residual < 1e-11
    times = run.time[gliding] - begin
    gaps = []
    for coefficient in (20.0, 80.0, 320.0):
        z = squat_by_friction(run.events.state_after[left], coefficient, times)
        gaps.append(np.abs(z[[0, 3, 5]] - run.state[gliding][:, [0, 3, 5]].T).max(axis=1))
    for coarse, fine in pairwise(gaps):
        assert (fine < 0.4 * coarse).all()
    assert gaps[-1].max() < 5e-3


def test_leaving_into_flight_has_no_side():
    (_, one), (_, other) = leaving(), leaving(-1.0)
    turned = np.array([-1.0, 1.0, -1.0, -1.0, 1.0, -1.0])
    np.testing.assert_array_equal(other.state, one.state * turned)
    np.testing.assert_array_equal(other.events.kind, one.events.kind)


def test_fixed_steps_are_cut_to_what_a_fast_pad_asks_for_while_a_corner_glides():
    """A weak dashpot relaxes in a sixth of the step that the vibrations need."""
    model = two_spring(
        half_width=1.0, half_height=1.705, stiffness=840.0, damping=1.45, shape_factor=3.0,
        mass=1.0, restitution=0.9, restraint=2, small_rotation=False, gravity=G,
    )  # fmt: skip
    ground = Ground(time_step=0.01, horizontal=np.zeros(51), vertical=np.zeros(51))
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
    assert (fast.mode // CONTACTS >= GLIDING).sum() > 10
    assert fast.step_count > 1.5 * 50 * fast.substeps
    assert np.abs(fast.state - exact.state).max() < 2e-3
    assert fast.energy_residual < 1e-3
