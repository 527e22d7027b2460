"""The hand-written block on pads, cap and soil against closed forms, balances and limits."""

from __future__ import annotations

import functools
import math

import numpy as np
import pytest
from reference_models.monoliths import coupled, two_spring, winkler
from scipy.linalg import expm

# tests of a reference model that rarely changes
pytestmark = [pytest.mark.reference_models, pytest.mark.long]

G = 9.80665
RULES = winkler.RULES
TIGHT = {"rtol": 1e-10, "atol": 1e-13, "steps_per_period": 12.0}

B, H, M = 1.2, 3.0, 8.0e4
B_C, H_C, M_C = 1.6, 0.4, 3.0e4
BLOCK = {"half_width": B, "half_height": H, "shape_factor": 3.0}
CAP = {"cap_half_width": B_C, "cap_half_height": H_C, "cap_mass": M_C}
INERTIA = M * (B**2 + H**2) / 3.0
CAP_INERTIA = M_C * (B_C**2 + H_C**2) / 3.0


def tower(beta=12.0, xi=0.1, settlement=0.03, soil_xi=0.2):
    stiffness = (M + M_C) * G / (2.0 * B_C * settlement)
    return {
        **BLOCK,
        **CAP,
        "mass": M,
        "frequency_ratio": beta,
        "damping_ratio": xi,
        "bed_stiffness": stiffness,
        "bed_damping": soil_xi * math.sqrt(2.0 * B_C * stiffness * (M + M_C)) / B_C,
    }


def pads(size):
    """Stiffness and damping of one pad, and its compression under half the weight."""
    omega = math.sqrt(0.75 * G / math.hypot(B, H))
    omega_v = size["frequency_ratio"] * omega
    return M * omega_v**2 / 2.0, size["damping_ratio"] * M * omega_v, G / omega_v**2


def pulse(factor, sign=1.0):
    def value(t):
        return -sign * factor * G * math.sin(2.0 * math.pi * t) if t < 1.0 else 0.0

    return {"acceleration": value, "breakpoints": (1.0,)}


@functools.cache
def leap(rule="centre", sign=1.0):
    """A run thrown upwards with spin: cap and block both leave their bases."""
    start = (None, sign * 0.01, None, sign * -0.02, 2.2, sign * 0.2, 0.4, sign * 0.3)
    return coupled.simulate(
        **tower(beta=8.0, xi=0.05, soil_xi=0.05),
        restraint=rule,
        duration=1.2,
        initial=start,
        sample_times=np.linspace(0.0, 1.2, 601),
        **TIGHT,
    )


def block_velocity(q, v):
    """Return the velocity of the block's centre from coordinates in the moving frame of the cap."""
    _, _, phi, reach, r, _ = q
    v_x, v_y, v_phi, v_along, v_r, _ = v
    height = H_C + H + r
    t = np.array([np.cos(phi), -np.sin(phi)])
    n = np.array([np.sin(phi), np.cos(phi)])
    # d t/d phi = -n and d n/d phi = t
    return np.array([v_x, v_y]) + (v_along + v_phi * height) * t + (v_r - v_phi * reach) * n


def coordinates(run):
    return np.array(
        [
            run.cap_horizontal,
            run.cap_vertical,
            run.cap_rotation,
            run.slide,
            run.pad_vertical,
            run.pad_rotation,
        ]
    )


# the equations ------------------------------------------------------------------------------


def matrices(size):
    """Return mass, damping and stiffness matrices of (Y, phi, r, psi) at rest, derived by hand."""
    k, c, _ = pads(size)
    k0, c0 = size["bed_stiffness"], size["bed_damping"]
    high = H + 2.0 * H_C
    mass = np.zeros((4, 4))
    mass[0, 0], mass[0, 2], mass[2, 2] = M + M_C, M, M
    mass[1, 1] = CAP_INERTIA + M_C * H_C**2 + INERTIA + M * high**2
    mass[1, 3] = INERTIA + M * H * high
    mass[3, 3] = INERTIA + M * H**2
    stiffness = np.zeros((4, 4))
    stiffness[0, 0], stiffness[2, 2] = 2.0 * B_C * k0, 2.0 * k
    stiffness[1, 1] = 2.0 / 3.0 * k0 * B_C**3 - M * G * high - M_C * G * H_C
    stiffness[1, 3] = -M * G * H
    stiffness[3, 3] = 2.0 * k * B**2 - M * G * H
    damping = np.diag([2.0 * B_C * c0, 2.0 / 3.0 * c0 * B_C**3, 2.0 * c, 2.0 * c * B**2])
    return [np.maximum(mass, mass.T), damping, stiffness + np.triu(stiffness, 1).T]


def test_slight_motion_is_that_of_the_linear_system():
    size = tower()
    mass, damping, stiffness = matrices(size)
    rates = np.block(
        [
            [np.zeros((4, 4)), np.eye(4)],
            [-np.linalg.solve(mass, stiffness), -np.linalg.solve(mass, damping)],
        ]
    )
    start = 1e-6 * np.array([1.0, 0.5, -0.7, 0.4, 3.0, -2.0, 5.0, 4.0])
    times = np.linspace(0.0, 1.0, 11)
    run = coupled.simulate(
        **size, duration=1.0, initial=start, sample_times=times, rtol=1e-11, atol=1e-16
    )
    assert not run.events
    exact = np.array([expm(rates * t) @ start for t in times]).T
    q = coordinates(run)
    np.testing.assert_allclose(q[[1, 2, 4, 5]], exact[:4], rtol=0, atol=2e-11)
    np.testing.assert_allclose(run.rates[[1, 2, 4, 5]], exact[4:], rtol=0, atol=1e-9)


@pytest.mark.parametrize("restraint", RULES)
def test_a_tower_at_rest_stays_at_rest(restraint):
    run = coupled.simulate(
        **tower(),
        restraint=restraint,
        duration=0.5,
        sample_times=np.linspace(0.0, 0.5, 6),
        **TIGHT,
    )
    assert not run.events
    assert not run.rotation.any()
    assert not run.cap_rotation.any()
    np.testing.assert_allclose(run.cap_vertical, 0.0, rtol=0, atol=1e-13)
    np.testing.assert_allclose(run.pad_vertical, 0.0, rtol=0, atol=1e-13)
    assert set(run.block_contact) == set(run.cap_contact) == {"full"}


def test_a_raised_block_starts_in_vertical_equilibrium():
    size = tower()
    k, _, delta = pads(size)
    run = coupled.simulate(
        **size, duration=0.01, initial=(None, 0.0, None, 0.2, 0, 0, 0, 0), sample_times=[0.0]
    )
    rise = run.pad_vertical[0] + H * (1.0 - math.cos(0.2)) - B * math.sin(0.2)
    assert k * (delta - rise) == pytest.approx(M * G, rel=1e-12)
    assert run.cap_vertical[0] == pytest.approx(0.0, abs=1e-15)
    assert run.slide[0] == pytest.approx(H * math.sin(0.2) + B * (1.0 - math.cos(0.2)), rel=1e-14)
    assert run.block_contact[0] == "right"


# balances -----------------------------------------------------------------------------------


def test_lossless_system_conserves_energy():
    run = coupled.simulate(
        **tower(xi=0.0, soil_xi=0.0, settlement=0.01),
        restitution=1.0,
        restraint="leading-corner",
        duration=1.0,
        initial=(None, 0.0, None, 0.06, 0.0, 0.0, 0.0, 0.0),
        **TIGHT,
    )
    kinds = {(event.kind, event.interface) for event in run.events}
    assert {("land", "pads"), ("leave", "soil")} <= kinds
    assert run.block_flight_time == 0.0
    lost = abs(run.repinning_loss) + abs(run.impact_loss) + abs(run.dashpot_work)
    assert lost < 1e-9 * run.initial_energy
    assert run.final_energy == pytest.approx(run.initial_energy, rel=1e-9)
    assert run.energy_residual < 1e-9


@pytest.mark.parametrize("restraint", RULES)
def test_the_balance_of_energy_closes(restraint):
    rule = {"restraint": restraint, **TIGHT}
    free = coupled.simulate(
        **tower(), **rule, duration=1.5, initial=(None, 0.0, None, 0.12, 0.0, 0.0, 0.0, 0.0)
    )
    forced = coupled.simulate(**tower(settlement=0.015), **rule, **pulse(0.9), duration=2.0)
    for run in (free, forced):
        kinds = {(event.kind, event.interface) for event in run.events}
        wanted = {(kind, where) for kind in ("leave", "land") for where in ("pads", "soil")}
        assert wanted <= kinds
        assert run.energy_residual < 1e-9
        assert run.dashpot_work > 0.0
        assert min(event.repinning_loss for event in run.events) > -1e-14
        assert min(event.impact_loss for event in run.events) >= 0.0
        assert run.impact_loss > 0.0
    assert forced.input_work != 0.0


@pytest.mark.parametrize("restraint", RULES)
def test_the_balance_of_energy_closes_in_flight(restraint):
    run = leap(restraint)
    assert run.cap_flight_time > 0.05
    assert run.block_flight_time > 0.05
    assert run.repinning_loss > 0.0
    assert run.energy_residual < 1e-9


def test_momenta_of_flying_system_are_those_of_free_bodies():
    run = leap()
    q, v = coordinates(run), run.rates
    free = run.cap_contact == "flight"
    both = free & (run.block_contact == "flight")
    assert free.sum() > both.sum() > 20
    block_v = block_velocity(q, v)
    cap_v = v[:2]
    momentum = M * block_v + M_C * cap_v
    cap_place = q[:2] + np.array([[0.0], [H_C]])
    block_place = np.array([run.horizontal, run.vertical + H + 2.0 * H_C])
    centre = (M * block_place + M_C * cap_place) / (M + M_C)
    centre_v = momentum / (M + M_C)

    def swirl(place, velocity):
        # clockwise, like the rotations
        (x, y), (v_x, v_y) = place - centre, velocity - centre_v
        return y * v_x - x * v_y

    spin = (
        INERTIA * (v[2] + v[5])
        + CAP_INERTIA * v[2]
        + M * swirl(block_place, block_v)
        + M_C * swirl(cap_place, cap_v)
    )
    flights = np.split(np.nonzero(free)[0], np.nonzero(np.diff(np.nonzero(free)[0]) > 1)[0] + 1)
    for flight in flights:
        x, y = momentum[:, flight]
        scale = np.abs(momentum[:, flight]).max()
        since = run.time[flight] - run.time[flight[0]]
        np.testing.assert_allclose(x, x[0], rtol=0, atol=1e-9 * scale)
        np.testing.assert_allclose(y, y[0] - (M + M_C) * G * since, rtol=0, atol=1e-9 * scale)
        np.testing.assert_allclose(spin[flight], spin[flight[0]], rtol=0, atol=1e-9 * scale)
    rate = (v[2] + v[5])[both]
    fall = block_v[:, both]
    same = np.diff(np.nonzero(both)[0]) == 1
    np.testing.assert_allclose(np.diff(rate)[same], 0.0, rtol=0, atol=1e-11)
    np.testing.assert_allclose(np.diff(fall[0])[same], 0.0, rtol=0, atol=1e-10)
    np.testing.assert_allclose(np.diff(fall[1])[same], -0.002 * G, rtol=0, atol=1e-10)


# contact ------------------------------------------------------------------------------------


@functools.cache
def rocked():
    """A rocking run under the rule whose held point, and so the rates, never change."""
    return coupled.simulate(
        **{**tower(settlement=0.015, xi=0.2), "restitution": 0.6},
        restraint="centre",
        **pulse(0.9),
        duration=2.0,
        sample_times=np.linspace(0.0, 2.0, 401),
        **TIGHT,
    )


def test_a_landing_scales_the_speed_of_the_corner():
    landings = [one for one in rocked().events if (one.kind, one.interface) == ("land", "pads")]
    assert landings
    for event in landings:
        assert event.struck
        q = np.array(event.before[:6])
        before, after = np.array(event.before[6:]), np.array(event.after[6:])
        sign = 1.0 if event.corners == "L" else -1.0
        arm = H * math.sin(q[5]) + sign * B * math.cos(q[5])
        speed = before[4] + arm * before[5]
        assert speed < 0.0
        assert after[4] + arm * after[5] == pytest.approx(0.6 * speed, rel=1e-9)
        # an impulse between block and cap conserves the sum of the vertical momenta
        change = after - before
        upward = M * block_velocity(q, change)[1] + M_C * change[1]
        assert abs(upward) < 1e-12 * M
        # moment of the impulse and of the hold about the centre of the block
        push = M * block_velocity(q, change) @ (math.sin(q[2]), math.cos(q[2]))
        drag = M * block_velocity(q, change) @ (math.cos(q[2]), -math.sin(q[2]))
        turn = INERTIA * (change[2] + change[5])
        assert turn == pytest.approx(push * arm - drag * H * math.cos(q[5]), rel=1e-8)
        assert push > 0.0


def test_contact_is_determined_by_state():
    size = tower(settlement=0.015, xi=0.2)
    k, c, delta = pads(size)
    run = rocked()
    _, _, phi, _, r, psi = coordinates(run)
    *_, v_r, v_psi = run.rates
    touching, ends = [], []
    for sign in (1.0, -1.0):
        rise = r + H * (1.0 - np.cos(psi)) + sign * B * np.sin(psi)
        rate = v_r + (H * np.sin(psi) + sign * B * np.cos(psi)) * v_psi
        touching.append((rise < delta) & (k * (delta - rise) - c * rate > 0.0))
        settlement = 0.015 - (
            run.cap_vertical + H_C * (1.0 - np.cos(phi)) + sign * B_C * np.sin(phi)
        )
        ends.append(settlement > 0.0)
    names = {(True, True): "full", (True, False): "left", (False, True): "right"}
    for found, sides in ((run.block_contact, touching), (run.cap_contact, ends)):
        expected = [names.get(pair, "flight") for pair in zip(*sides, strict=True)]
        assert list(found) == expected
        assert len(set(expected)) > 2


# limits and symmetry ------------------------------------------------------------------------


def test_heavy_hard_footing_converges_to_block_on_two_springs():
    times = np.linspace(0.0, 1.2, 25)
    options = {**BLOCK, "frequency_ratio": 12.0, "damping_ratio": 0.1, "duration": 1.2}
    k, _, delta = pads(options)
    alpha = 0.12
    r = delta - M * G / k - H * (1.0 - math.cos(alpha)) + B * math.sin(alpha)
    alone = two_spring.simulate(
        **options, initial=(alpha, r, 0.0, 0.0), sample_times=times, rtol=1e-11
    )
    assert alone.impact_count > 0
    misses = []
    for factor in (1e3, 1e4):
        mass = factor * M
        run = coupled.simulate(
            **options,
            mass=M,
            cap_half_width=2.0,
            cap_half_height=0.4,
            cap_mass=mass,
            bed_stiffness=mass * 150.0**2 / 4.0,
            initial=(None, 0.0, r, alpha, 0.0, 0.0, 0.0, 0.0),
            sample_times=times,
            rtol=1e-10,
            steps_per_period=6.0,
        )
        misses.append(np.abs(run.rotation - alone.rotation).max())
        assert [one.kind for one in run.events] == [one.kind for one in alone.events]
    assert misses[1] < 1e-5
    assert misses[1] == pytest.approx(misses[0] / 10.0, rel=0.05)


def test_block_and_cap_on_hard_pads_converge_to_one_body():
    times = np.linspace(0.0, 0.7, 15)
    high = (M_C * H_C + M * (H + 2.0 * H_C)) / (M + M_C)
    inertia = INERTIA + CAP_INERTIA
    inertia += M * (H + 2.0 * H_C - high) ** 2 + M_C * (high - H_C) ** 2
    options = {"restraint": "leading-corner", "duration": 0.7, "sample_times": times, **TIGHT}
    misses = []
    for beta in (40.0, 80.0):
        size = tower(beta=beta, xi=0.2, settlement=0.03)
        whole = winkler.simulate(
            half_width=B_C,
            half_height=high,
            inertia=inertia,
            mass=M + M_C,
            bed_stiffness=size["bed_stiffness"],
            bed_damping=size["bed_damping"],
            initial=(0.0, None, 0.28, 0.0),
            **options,
        )
        run = coupled.simulate(
            **size, initial=(None, 0.0, None, 0.0, 0.0, 0.28, 0.0, 0.0), **options
        )
        assert "leave" in {event.kind for event in whole.events}
        assert set(run.block_contact) == {"full"}
        misses.append(np.abs(run.rotation - whole.rotation).max())
    assert whole.peak_rotation > 0.05
    assert misses[1] < 0.02 * whole.peak_rotation
    assert misses[1] == pytest.approx(misses[0] / 4.0, rel=0.1)


@pytest.mark.parametrize("restraint", ["contact-state", "leading-corner"])
def test_mirror_symmetry(restraint):
    one, other = leap(restraint), leap(restraint, -1.0)
    assert len(one.events) > 5
    np.testing.assert_allclose(one.rotation, -other.rotation, rtol=0, atol=1e-11)
    np.testing.assert_allclose(one.cap_vertical, other.cap_vertical, rtol=0, atol=1e-11)
    np.testing.assert_allclose(one.pad_vertical, other.pad_vertical, rtol=0, atol=1e-11)
    np.testing.assert_allclose(one.slide, -other.slide, rtol=0, atol=1e-11)
    assert [event.kind for event in one.events] == [event.kind for event in other.events]
