"""The hand-written integrations against closed forms, balances and symmetries."""

from __future__ import annotations

import math

import numpy as np
import pytest
from reference_models.monoliths import rigid_block, two_spring

# tests of a reference model that rarely changes
pytestmark = [pytest.mark.reference_models, pytest.mark.long]

G = 9.80665
RULES = ("contact-state", "leading-corner", "centre")
LOOSE = {"rtol": 1e-9, "atol": 1e-11, "steps_per_period": 10.0}
"""Options for tests that need no tight tolerance."""


def block(radius, slenderness):
    theta = math.atan(1.0 / slenderness)
    return {
        "half_width": radius * math.sin(theta),
        "half_height": radius * math.cos(theta),
        "shape_factor": 3.0,
    }


def one_sine(gravity=G):
    def value(t):
        return -gravity * math.sin(2.0 * math.pi * t) if t < 1.0 else 0.0

    return {"acceleration": value, "breakpoints": (1.0,), "gravity": gravity}


GOLDEN = {**block(5.0, 4.0), "frequency_ratio": 20.0, "damping_ratio": 0.1}


def bed(frequency_ratio, radius=5.0, gravity=G):
    """Return the spring of one corner, and its compression under half the weight."""
    omega = math.sqrt(0.75 * gravity / radius)
    stiffness = (frequency_ratio * omega) ** 2 / 2.0
    return omega, stiffness, gravity / (2.0 * stiffness)


def resting_on_one_corner(alpha, frequency_ratio, radius=5.0, slenderness=4.0):
    """Return the displacement at which the right corner alone carries the weight."""
    _, stiffness, delta = bed(frequency_ratio, radius)
    size = block(radius, slenderness)
    below = delta - G / stiffness
    return (
        below - size["half_height"] * (1.0 - math.cos(alpha)) + size["half_width"] * math.sin(alpha)
    )


def noisy_record(seed=3, count=121, step=0.02, peak=4.0):
    rng = np.random.default_rng(seed)
    rough = np.cumsum(rng.normal(size=count))
    rough -= np.linspace(rough[0], rough[-1], count)
    return step, peak * rough / np.abs(rough).max()


# two springs ------------------------------------------------------------------------------


@pytest.mark.parametrize("rotation", ["finite", "small"])
def test_lossless_free_rocking_conserves_energy(rotation):
    start = 0.1
    run = two_spring.simulate(
        **{**GOLDEN, "damping_ratio": 0.0},
        restitution=1.0,
        restraint="leading-corner",
        rotation=rotation,
        duration=8.0,
        initial=(start, resting_on_one_corner(start, 20.0), 0.0, 0.0),
    )
    kinds = {event.kind for event in run.events}
    assert {"leave", "land"} <= kinds
    assert run.landing_count >= 4
    assert abs(run.final_energy - run.initial_energy) < 1e-10 * abs(run.initial_energy)
    assert abs(run.repinning_loss) + abs(run.impact_loss) + abs(run.dashpot_work) < 1e-11
    assert run.energy_residual < 1e-10


@pytest.mark.parametrize("rotation", ["finite", "small"])
@pytest.mark.parametrize("restraint", RULES)
def test_the_balance_of_energy_closes_under_the_pulse(restraint, rotation):
    run = two_spring.simulate(
        **GOLDEN, **one_sine(), restraint=restraint, rotation=rotation, duration=10.0
    )
    assert run.energy_residual < 1e-9
    assert run.impact_count == 1
    assert run.overturned
    assert 3.08 < run.overturning_time < 3.12
    assert min(event.repinning_loss for event in run.events) > -1e-14
    assert min(event.impact_loss for event in run.events) >= 0.0


def test_the_restraint_rules_coincide_for_small_rotation():
    times = np.linspace(0.0, 3.0, 31)
    runs = [
        two_spring.simulate(
            **GOLDEN,
            **one_sine(),
            restraint=rule,
            rotation="small",
            duration=3.0,
            sample_times=times,
        )
        for rule in RULES
    ]
    for other in runs[1:]:
        np.testing.assert_allclose(other.rotation, runs[0].rotation, rtol=0, atol=1e-12)


def test_flight_keeps_rate_and_horizontal_speed():
    times = np.linspace(0.0, 4.0, 4001)
    run = two_spring.simulate(
        **{**GOLDEN, **block(5.0, 2.0), "frequency_ratio": 40.0, "damping_ratio": 0.05},
        **one_sine(),
        duration=4.0,
        sample_times=times,
    )
    assert run.flight_count > 2
    assert run.energy_residual < 1e-9
    flights = [event.time for event in run.events if event.contact_after == "flight"]
    ends = [event.time for event in run.events if event.contact_before == "flight"]
    checked = 0
    for event in run.events:
        if event.kind != "leave" or event.contact_after != "flight" or event.time < 1.0:
            continue
        stop = min(one for one in ends if one > event.time)
        inside = (times > event.time) & (times < stop)
        after = times[inside] - event.time
        _, y, x, rate, y_rate, x_rate = event.after
        assert set(run.contact[inside]) <= {"flight"}
        np.testing.assert_allclose(run.rotation_rate[inside], rate, rtol=0, atol=1e-13)
        np.testing.assert_allclose(run.horizontal[inside], x + x_rate * after, atol=1e-12)
        parabola = y + y_rate * after - 0.5 * G * after**2
        np.testing.assert_allclose(run.vertical[inside], parabola, atol=1e-12)
        checked += inside.sum()
    assert flights
    assert checked > 10


@pytest.mark.parametrize("restraint", RULES)
def test_mirror_symmetry(restraint):
    step, record = noisy_record()
    _, upward = noisy_record(seed=8, peak=2.0)
    times = np.linspace(0.0, 4.0, 81)
    runs = [
        two_spring.simulate(
            **GOLDEN,
            restraint=restraint,
            time_step=step,
            acceleration=sign * record,
            vertical=upward,
            duration=4.0,
            initial=(sign * 0.05, 0.0, 0.0, 0.0),
            sample_times=times,
            **LOOSE,
        )
        for sign in (1.0, -1.0)
    ]
    assert runs[0].landing_count > 0
    np.testing.assert_allclose(runs[0].rotation, -runs[1].rotation, rtol=0, atol=1e-12)
    np.testing.assert_allclose(runs[0].vertical, runs[1].vertical, rtol=0, atol=1e-12)
    np.testing.assert_allclose(runs[0].horizontal, -runs[1].horizontal, rtol=0, atol=1e-12)
    assert [event.kind for event in runs[0].events] == [event.kind for event in runs[1].events]


def test_restarting_at_knots_does_not_change_result():
    step, record = noisy_record(count=61)
    common = {**GOLDEN, "duration": 2.0, "sample_times": np.linspace(0.0, 2.0, 21)}
    grid = step * np.arange(record.size)
    ground = {"time_step": step, "acceleration": record}

    def interpolated(t):
        return float(np.interp(t, grid, record)) if t <= grid[-1] else 0.0

    runs = [
        two_spring.simulate(**common, **ground),
        two_spring.simulate(**common, **ground, restart_every_knot=False),
        two_spring.simulate(**common, acceleration=interpolated, breakpoints=grid),
    ]
    assert runs[0].peak_rotation > 0.01
    for other in runs[1:]:
        np.testing.assert_allclose(other.rotation, runs[0].rotation, rtol=0, atol=1e-9)
        assert other.peak_rotation == pytest.approx(runs[0].peak_rotation, rel=1e-8)


@pytest.mark.parametrize("restraint", RULES)
def test_flat_drop_causes_no_rotation(restraint):
    _, _, delta = bed(20.0)
    height = 0.05
    run = two_spring.simulate(
        **GOLDEN,
        restraint=restraint,
        duration=3.0,
        initial=(0.0, delta + height, 0.0, 0.0),
        sample_times=np.linspace(0.0, 3.0, 61),
    )
    assert not run.rotation.any()
    assert run.peak_rotation == 0.0
    landing = next(event for event in run.events if event.kind == "land")
    assert sorted(landing.corners) == ["L", "R"]
    assert landing.contact_after == "full"
    assert landing.time == pytest.approx(math.sqrt(2.0 * height / G), abs=1e-12)
    eps = 1.0 - 1.5 * math.sin(math.atan(0.25)) ** 2
    assert landing.after[4] == pytest.approx(-eps * math.sqrt(2.0 * G * height), rel=1e-11)
    assert landing.impulses[0] == pytest.approx(landing.impulses[1])
    assert all(event.corners in ("LR", "RL") for event in run.events)
    assert run.energy_residual < 1e-10


def decay(time, start, frequency, ratio):
    damped = frequency * math.sqrt(1.0 - ratio**2)
    wave = np.cos(damped * time) + ratio * frequency / damped * np.sin(damped * time)
    return start * np.exp(-ratio * frequency * time) * wave


def test_vertical_motion_in_contact_is_a_damped_oscillator():
    omega, _, delta = bed(20.0)
    times = np.linspace(0.0, 2.0, 101)
    run = two_spring.simulate(
        **GOLDEN, duration=2.0, initial=(0.0, -0.8 * delta, 0.0, 0.0), sample_times=times
    )
    assert not run.events
    exact = decay(times, -0.8 * delta, 20.0 * omega, 0.1)
    np.testing.assert_allclose(run.vertical, exact, rtol=0, atol=1e-12 * delta + 1e-14)


def test_nonzero_final_sample_drops_to_zero_at_once():
    omega, _, delta = bed(20.0)
    push, last = 2.0, 0.4
    times = np.linspace(0.0, 1.2, 61)
    run = two_spring.simulate(
        **GOLDEN,
        time_step=0.1,
        acceleration=np.zeros(5),
        vertical=np.full(5, push),
        duration=1.2,
        sample_times=times,
    )
    level = -push / (20.0 * omega) ** 2
    exact = level - decay(times, level, 20.0 * omega, 0.1)
    late = times > last
    exact[late] -= level - decay(times[late] - last, level, 20.0 * omega, 0.1)
    np.testing.assert_allclose(run.vertical, exact, rtol=0, atol=1e-10 * delta)


@pytest.mark.parametrize("rotation", ["finite", "small"])
def test_slight_rocking_in_full_contact_is_a_damped_oscillator(rotation):
    omega, stiffness, _ = bed(20.0)
    size = block(5.0, 4.0)
    b, h = size["half_width"], size["half_height"]
    inertia = 25.0 / 3.0 + h**2
    frequency = math.sqrt((2.0 * stiffness * b**2 - G * h) / inertia)
    ratio = 2.0 * 0.1 * 20.0 * omega * b**2 / (2.0 * inertia * frequency)
    times = np.linspace(0.0, 4.0, 41)
    start = 1e-6
    run = two_spring.simulate(
        **GOLDEN,
        rotation=rotation,
        duration=4.0,
        initial=(start, 0.0, 0.0, 0.0),
        sample_times=times,
        atol=1e-15,
    )
    exact = decay(times, start, frequency, ratio)
    np.testing.assert_allclose(run.rotation, exact, rtol=0, atol=1e-7 * start)


def test_landing_scales_the_speed_of_the_corner():
    run = two_spring.simulate(**{**GOLDEN, "restitution": 0.6}, **one_sine(), duration=3.0)
    size = block(5.0, 4.0)
    b, h = size["half_width"], size["half_height"]
    landings = [event for event in run.events if event.kind == "land"]
    assert landings
    for event in landings:
        sign = 1.0 if event.corners == "L" else -1.0
        alpha = event.before[0]
        arm = h * math.sin(alpha) + sign * b * math.cos(alpha)
        # re-pinning to full contact first: the momentum about the middle of the base
        base = sign * b  # only the other corner was in contact
        old = h * math.cos(alpha) + base * math.sin(alpha)
        new = h * math.cos(alpha)
        inertia = 25.0 / 3.0
        rate = event.before[3] * (inertia + new * old) / (inertia + new**2)
        before = event.before[4] + arm * rate
        after = event.after[4] + arm * event.after[3]
        assert before < 0.0
        assert after == pytest.approx(0.6 * before, rel=1e-9)
        momentum = (event.after[3] - rate) * (inertia + new**2)
        assert momentum == pytest.approx(arm * (event.after[4] - event.before[4]), rel=1e-9)


def test_re_engagement_does_not_chatter():
    run = two_spring.simulate(
        **{**GOLDEN, **block(10.0, 4.0), "frequency_ratio": 10.0}, **one_sine(), duration=10.0
    )
    kinds = [event.kind for event in run.events]
    assert kinds.count("engage") == 1
    assert len(kinds) < 30
    assert 0.0 < run.peak_tension < 1e-3 * G
    assert run.energy_residual < 1e-9


@pytest.mark.parametrize("eps", [1.0, None, 0.5])
def test_hard_springs_converge_to_greatest_restitution_of_rigid_block(eps):
    """An impulse at the new corner has no moment about it: only eps_max reduces the rate."""
    start = 0.5 * math.atan(0.25)
    times = np.linspace(0.0, 2.4, 1201)
    rigid = rigid_block.simulate(
        **block(5.0, 4.0), duration=2.4, initial=(start, 0.0), sample_times=times
    )
    run = two_spring.simulate(
        **{**GOLDEN, "frequency_ratio": 160.0, "damping_ratio": 1.0},
        restraint="leading-corner",
        restitution=eps,
        duration=2.4,
        initial=(start, resting_on_one_corner(start, 160.0), 0.0, 0.0),
        sample_times=times,
        **LOOSE,
    )
    assert run.rotation.min() == pytest.approx(rigid.rotation.min(), rel=0.01)
    assert run.events[0].time > 1.0


def test_run_stops_or_continues_at_overturning():
    size = {**GOLDEN, **block(1.0, 6.0)}
    theta = math.atan(1.0 / 6.0)
    times = [0.0, 0.2, 5.0]
    stopped = two_spring.simulate(**size, **one_sine(), duration=5.0, sample_times=times)
    assert stopped.overturned
    assert stopped.end_time == stopped.overturning_time
    assert stopped.peak_rotation == pytest.approx(theta, rel=1e-12)
    assert np.isnan(stopped.rotation[-1])
    assert stopped.contact[-1] == ""
    gone_on = two_spring.simulate(**size, **one_sine(), duration=5.0, overturning="continue")
    assert gone_on.overturning_time == stopped.overturning_time
    assert gone_on.peak_rotation == pytest.approx(0.5 * math.pi, rel=1e-12)


# rigid ground -----------------------------------------------------------------------------

TABLE = [
    (2, 1, 1, 1.30946, None),
    (2, 5, None, None, 0.26441),
    (2, 10, None, None, 0.12572),
    (4, 1, 0, 0.40662, None),
    (4, 5, 1, 2.69659, None),
    (4, 10, None, None, 0.42891),
    (6, 1, 0, 0.32916, None),
    (6, 5, 1, 3.12423, None),
    (6, 10, None, None, 0.82435),
]


@pytest.mark.parametrize(("slenderness", "radius", "impacts", "time", "peak"), TABLE)
def test_the_nine_blocks_on_rigid_ground(slenderness, radius, impacts, time, peak):
    run = rigid_block.simulate(**block(radius, slenderness), **one_sine(9.81), duration=10.0)
    assert run.energy_residual < 1e-10
    if time is None:
        assert not run.overturned
        theta = math.atan(1.0 / slenderness)
        assert run.peak_rotation / theta == pytest.approx(peak, abs=1e-5)
    else:
        assert run.overturning_time == pytest.approx(time, abs=1e-5)
        assert run.impact_count == impacts


def test_free_rocking_on_rigid_ground():
    theta, radius = 0.2, 3.0
    size = {
        "half_width": radius * math.sin(theta),
        "half_height": radius * math.cos(theta),
        "shape_factor": 3.0,
    }
    omega = math.sqrt(0.75 * G / radius)
    run = rigid_block.simulate(**size, duration=60.0 / omega, initial=(0.5 * theta, 0.0))
    impacts = [event for event in run.events if event.kind == "impact"]
    times = [event.time * omega for event in impacts[:6]]
    expected = [1.318504, 3.604495, 5.632523, 7.457080, 9.114102, 10.629155]
    np.testing.assert_allclose(times, expected, rtol=0, atol=1e-6)
    peaks = []
    for event in impacts[:6]:
        lift = 0.5 * 4.0 / 3.0 * radius * event.after[1] ** 2 / G
        peaks.append((theta - math.acos(math.cos(theta) + lift)) / theta)
    expected = [0.420356, 0.358023, 0.307494, 0.265648, 0.230494, 0.200658]
    np.testing.assert_allclose(peaks, expected, rtol=0, atol=1e-6)
    assert run.events[-1].kind == "rest"
    assert run.energy_residual < 1e-10


def test_small_rotation_on_rigid_ground_has_closed_forms():
    theta, radius, phi = 0.2, 3.0, 0.5
    size = {
        "half_width": radius * math.sin(theta),
        "half_height": radius * math.cos(theta),
        "shape_factor": 3.0,
    }
    omega = math.sqrt(0.75 * G / radius)
    run = rigid_block.simulate(
        **size, rotation="small", restitution=0.9, duration=6.0, initial=(phi * theta, 0.0)
    )
    impacts = [event.time for event in run.events if event.kind == "impact"]
    elapsed = math.acosh(1.0 / (1.0 - phi)) / omega
    for number, impact in enumerate(impacts[:4], start=1):
        assert impact == pytest.approx(elapsed, rel=1e-10)
        amplitude = 1.0 - math.sqrt(1.0 - 0.81**number * (1.0 - (1.0 - phi) ** 2))
        elapsed += 2.0 * math.acosh(1.0 / (1.0 - amplitude)) / omega


@pytest.mark.parametrize(
    ("cycles", "ratio", "threshold"),
    [(0.5, 2.0, 1.800724), (0.5, 4.0, 2.790798), (1.0, 2.0, 2.349903), (1.0, 4.0, 5.238964)],
)
def test_thresholds_of_overturning_without_impact(cycles, ratio, threshold):
    theta, radius = 0.2, 3.0
    omega = math.sqrt(0.75 * G / radius)
    frequency = ratio * omega
    end = 2.0 * math.pi * cycles / frequency

    def run(factor):
        peak = factor * threshold * G * theta
        return rigid_block.simulate(
            half_width=radius * math.sin(theta),
            half_height=radius * math.cos(theta),
            shape_factor=3.0,
            restitution=0.9,
            rotation="small",
            acceleration=lambda t: peak * math.sin(frequency * t) if t < end else 0.0,
            breakpoints=(end,),
            duration=30.0 / omega,
            overturning="continue",
        )

    above, below = run(1.0 + 1e-5), run(1.0 - 1e-5)
    assert above.impact_count == 0
    assert above.peak_rotation == pytest.approx(0.5 * math.pi)
    assert below.impact_count > 0
    # a whole sine carries the block past theta and back: reaching theta is not overturning
    assert below.overturned == (cycles == 1.0)


def test_rigid_block_rests_and_uplifts_again():
    size = block(2.0, 4.0)
    times = np.linspace(0.0, 12.0, 121)
    weak = 0.24 * G * np.sin(np.linspace(0.0, 6.0 * math.pi, 200))
    still = rigid_block.simulate(
        **size, time_step=0.05, acceleration=weak, duration=12.0, sample_times=times
    )
    assert not still.events
    assert set(still.state) == {"rest"}
    strong = np.concatenate([[0.0, 0.4 * G, 0.0], np.zeros(140), [0.0, -0.4 * G, 0.0]])
    run = rigid_block.simulate(
        **size, time_step=0.05, acceleration=strong, duration=12.0, sample_times=times
    )
    starts = [event.time for event in run.events if event.kind == "start"]
    rests = [event.time for event in run.events if event.kind == "rest"]
    assert len(starts) == len(rests) == 2
    uplift = 0.05 * 0.25 / 0.4
    assert starts == pytest.approx([uplift, 143 * 0.05 + uplift], abs=1e-10)
    assert starts[0] < rests[0] < starts[1] < rests[1]
    first = run.rotation[(times > starts[0]) & (times < 0.3)]
    assert first[0] < 0.0
    assert run.energy_residual < 1e-10


def test_rigid_mirror_symmetry():
    step, record = noisy_record(peak=6.0)
    _, upward = noisy_record(seed=8, peak=2.0)
    runs = [
        rigid_block.simulate(
            **block(5.0, 4.0),
            time_step=step,
            acceleration=sign * record,
            vertical=upward,
            duration=5.0,
            sample_times=np.linspace(0.0, 5.0, 51),
        )
        for sign in (1.0, -1.0)
    ]
    assert runs[0].impact_count > 0
    np.testing.assert_array_equal(runs[0].rotation, -runs[1].rotation)
