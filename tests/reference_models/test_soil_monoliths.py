"""The hand-written body on a Winkler bed against closed forms, balances and symmetries."""

from __future__ import annotations

import math

import numpy as np
import pytest
from reference_models.monoliths import two_spring, winkler

# tests of a reference model that rarely changes
pytestmark = [pytest.mark.reference_models, pytest.mark.long]

G = 9.80665
RULES = winkler.RULES
SEPARATIONS = ("displacement", "pressure")
TIGHT = {"rtol": 1e-11, "atol": 1e-13, "steps_per_period": 16.0}

MASS, WIDTH, HEIGHT = 2.0e4, 1.2, 2.4  # half a width, half a height


def body(settlement=0.004, damping_ratio=0.1, half_width=WIDTH, half_height=HEIGHT, mass=MASS):
    """Return a solid rectangle on a bed of given settlement and vertical damping."""
    stiffness = mass * G / (2.0 * half_width * settlement)
    damping = damping_ratio * math.sqrt(2.0 * half_width * stiffness * mass) / half_width
    return {
        "half_width": half_width,
        "half_height": half_height,
        "shape_factor": 3.0,
        "mass": mass,
        "bed_stiffness": stiffness,
        "bed_damping": damping,
    }


def noisy_record(seed=3, count=61, step=0.02, peak=6.0):
    rng = np.random.default_rng(seed)
    smooth = np.convolve(rng.normal(size=count), np.ones(5) / 5.0, "same")
    return peak * smooth / np.abs(smooth).max()


def random_ground(seed=3, peak=6.0, upward=0.0, sign=1.0):
    ground = {"time_step": 0.02, "acceleration": sign * noisy_record(seed, peak=peak)}
    if upward:
        ground["vertical"] = noisy_record(seed + 99, peak=upward)
    return ground


def decay(time, start, frequency, ratio):
    damped = frequency * math.sqrt(1.0 - ratio**2)
    wave = np.cos(damped * time) + ratio * frequency / damped * np.sin(damped * time)
    return start * np.exp(-ratio * frequency * time) * wave


# the bed ------------------------------------------------------------------------------------


@pytest.mark.parametrize("separation", SEPARATIONS)
@pytest.mark.parametrize("finite", [True, False])
def test_resultants_are_those_of_many_small_springs(separation, finite):
    rng = np.random.default_rng(11)
    size = 40000
    s = (np.arange(size) + 0.5) / size * 2.0 * WIDTH - WIDTH
    piece = 2.0 * WIDTH / size
    stretches = set()
    for _ in range(200):
        bed = winkler.Bed(
            half_width=WIDTH, height=HEIGHT, stiffness=700.0, damping=40.0, settlement=0.01,
            separation=separation, finite=finite,
        )  # fmt: skip
        alpha, y = rng.normal(scale=0.01), rng.normal(scale=0.01)
        alpha_dot, y_dot = rng.normal(scale=0.3), rng.normal(scale=0.3)
        ends = bed.ends(alpha, y, alpha_dot, y_dot)
        for name, end in ends.items():
            bed.end[name] = winkler.RELAXING if end.depth > 0.0 else winkler.CLEAR
        bed.read(ends, {"L": 0.0, "R": 0.0})
        stretches.add(bed.bounds)
        sine, cosine = (math.sin(alpha), math.cos(alpha)) if finite else (alpha, 1.0)
        drop = HEIGHT * (1.0 - cosine) if finite else HEIGHT * alpha**2 / 2.0
        depth = 0.01 - (y + drop - s * sine)
        arm = HEIGHT * sine - s * cosine
        rate = y_dot + arm * alpha_dot
        pressure = 700.0 * depth - 40.0 * rate
        below = depth > 0.0
        bears = below & (pressure > 0.0) if separation == "pressure" else below
        dissipated = np.where(bears, 40.0 * rate**2, np.where(below, 700.0 * depth * rate, 0.0))
        found = bed.resultants(ends, alpha, y, alpha_dot, y_dot)
        brute = [
            np.sum(pressure * bears) * piece,
            np.sum(pressure * arm * bears) * piece,
            np.sum(dissipated) * piece,
        ]
        np.testing.assert_allclose(found, brute, rtol=1e-3, atol=5e-3)
        stored = np.sum(np.where(below, 350.0 * depth**2, 0.0)) * piece
        assert bed.energy(alpha, y) == pytest.approx(stored, rel=1e-3, abs=1e-6)
    inside = {("level", "pressure"), ("pressure", "level")}
    assert (inside <= stretches) == (separation == "pressure")
    assert {None, ("end", "end"), ("end", "level"), ("level", "end")} <= stretches


@pytest.mark.parametrize("finite", [True, False])
def test_guard_rates_match_finite_differences(finite):
    bed = winkler.Bed(
        half_width=WIDTH, height=HEIGHT, stiffness=700.0, damping=40.0, settlement=0.01,
        separation="pressure", finite=finite,
    )  # fmt: skip
    alpha, y, alpha_dot, y_dot, alpha_acc, y_acc = 0.3, 0.02, -0.7, 0.4, 2.0, -1.5

    def later(t):
        rotation = alpha + alpha_dot * t + 0.5 * alpha_acc * t**2
        rise = y + y_dot * t + 0.5 * y_acc * t**2
        return bed.ends(rotation, rise, alpha_dot + alpha_acc * t, y_dot + y_acc * t)

    step = 1e-6
    now, before, after = later(0.0), later(-step), later(step)
    accelerations = {
        name: y_acc + end.arm * alpha_acc + end.bend * alpha_dot**2 for name, end in now.items()
    }

    def slope(value):
        return (value(after) - value(before)) / (2.0 * step)

    for name, end in now.items():
        assert slope(lambda ends, n=name: ends[n].depth) == pytest.approx(-end.rate, rel=1e-8)
        assert slope(lambda ends, n=name: ends[n].rate) == pytest.approx(accelerations[name])
        for where in (name, "X"):
            rate = bed.cut_value(where, now, accelerations)[1]
            found = slope(lambda ends, w=where: bed.cut_value(w, ends, accelerations)[0])
            assert rate == pytest.approx(found, rel=1e-6)


def test_moment_and_rotation_of_a_static_push():
    settlement = 0.003
    bed = winkler.Bed(
        half_width=WIDTH, height=HEIGHT, stiffness=G / (2.0 * WIDTH * settlement), damping=0.0,
        settlement=settlement, separation="displacement", finite=False,
    )  # fmt: skip
    uplift = settlement / WIDTH
    ratios = (0.5, 1.0, 2.0, 4.0, 10.0, 100.0)
    expected = (1.0 / 6.0, 1.0 / 3.0, 0.528595, 0.666667, 0.789181, 0.933333)
    for ratio, moment in zip(ratios, expected, strict=True):
        alpha = ratio * uplift
        y = bed.rest(alpha, G)
        ends = bed.ends(alpha, y, 0.0, 0.0)
        for name, end in ends.items():
            bed.end[name] = winkler.TOUCHING if end.depth > 0.0 else winkler.CLEAR
        bed.read(ends, {})
        lift, turn, _ = bed.resultants(ends, alpha, y, 0.0, 0.0)
        assert lift == pytest.approx(G, rel=1e-12)
        # restoring moment: the bed's moment about the middle of the base
        assert (HEIGHT * alpha * lift - turn) / (G * WIDTH) == pytest.approx(moment, abs=1e-6)
        low, high = bed.place(bed.bounds, ends)
        length = 2.0 * WIDTH * min(1.0, math.sqrt(1.0 / ratio))
        assert high - low == pytest.approx(length, rel=1e-9)


# motion -------------------------------------------------------------------------------------


@pytest.mark.parametrize("separation", SEPARATIONS)
@pytest.mark.parametrize("restraint", RULES)
def test_a_body_at_rest_stays_at_rest(restraint, separation):
    run = winkler.simulate(
        **body(),
        restraint=restraint,
        separation=separation,
        duration=0.5,
        sample_times=np.linspace(0.0, 0.5, 21),
        **TIGHT,
    )
    assert not run.events
    assert not run.rotation.any()
    np.testing.assert_allclose(run.vertical, 0.0, rtol=0, atol=1e-15)
    np.testing.assert_allclose(run.contact_length, 2.0 * WIDTH, rtol=1e-15)
    assert set(run.contact) == {"full"}


@pytest.mark.parametrize("separation", SEPARATIONS)
@pytest.mark.parametrize("rotation", ["finite", "small"])
def test_slight_motion_has_the_frequencies_of_full_contact(rotation, separation):
    size = body(damping_ratio=0.05)
    k0, c0 = size["bed_stiffness"], size["bed_damping"]
    inertia = MASS * ((WIDTH**2 + HEIGHT**2) / 3.0 + HEIGHT**2)
    frequency = math.sqrt((2.0 / 3.0 * k0 * WIDTH**3 - MASS * G * HEIGHT) / inertia)
    ratio = 2.0 / 3.0 * c0 * WIDTH**3 / (2.0 * inertia * frequency)
    times = np.linspace(0.0, 1.0, 41)
    start = 1e-6
    options = {"rotation": rotation, "separation": separation, "duration": 1.0}
    options.update(sample_times=times, atol=1e-15, steps_per_period=16.0)
    run = winkler.simulate(**size, **options, initial=(start, None, 0.0, 0.0))
    exact = decay(times, start, frequency, ratio)
    np.testing.assert_allclose(run.rotation, exact, rtol=0, atol=1e-7 * start)
    run = winkler.simulate(**size, **options, initial=(0.0, -0.002, 0.0, 0.0))
    exact = decay(times, -0.002, math.sqrt(2.0 * WIDTH * k0 / MASS), 0.05)
    np.testing.assert_allclose(run.vertical, exact, rtol=0, atol=1e-12)
    assert not run.rotation.any()
    assert not run.events


def test_bed_in_full_contact_matches_springs_at_gauss_points():
    """Integrands are quadratic along the base, so that two points suffice."""
    size = body(settlement=0.02, damping_ratio=0.2)
    b = WIDTH / math.sqrt(3.0)
    inertia = (WIDTH**2 + HEIGHT**2) / 3.0
    radius = math.hypot(b, HEIGHT)
    mu = radius**2 / inertia
    omega_v = math.sqrt(2.0 * WIDTH * size["bed_stiffness"] / MASS)
    times = np.linspace(0.0, 1.2, 61)
    options = {**random_ground(peak=1.0), "duration": 1.2, "sample_times": times}
    springs = two_spring.simulate(
        half_width=b,
        half_height=HEIGHT,
        shape_factor=mu,
        frequency_ratio=omega_v / math.sqrt(mu / (1.0 + mu) * G / radius),
        damping_ratio=0.2,
        **options,
    )
    run = winkler.simulate(**size, **options)
    assert not run.events
    assert not springs.events
    assert run.peak_rotation > 0.005
    np.testing.assert_allclose(run.rotation, springs.rotation, rtol=0, atol=1e-13)
    np.testing.assert_allclose(run.vertical, springs.vertical, rtol=0, atol=1e-14)
    np.testing.assert_allclose(run.horizontal, springs.horizontal, rtol=0, atol=1e-13)


@pytest.mark.parametrize("rotation", ["finite", "small"])
def test_lossless_free_rocking_conserves_energy(rotation):
    run = winkler.simulate(
        **body(damping_ratio=0.0),
        restraint="leading-corner",
        rotation=rotation,
        duration=4.0,
        initial=(0.1, None, 0.0, 0.0),
        **TIGHT,
    )
    kinds = [event.kind for event in run.events]
    assert kinds.count("land") >= 4
    assert kinds.count("leave") >= 4
    assert run.flight_count == 0
    assert abs(run.final_energy - run.initial_energy) < 1e-8 * MASS * G * HEIGHT * 0.01
    assert abs(run.repinning_loss) + abs(run.dashpot_work) < 1e-9
    assert run.energy_residual < 1e-9


@pytest.mark.parametrize("separation", SEPARATIONS)
@pytest.mark.parametrize("restraint", RULES)
def test_the_balance_of_energy_closes(restraint, separation):
    rules = {"restraint": restraint, "separation": separation, **TIGHT}
    free = winkler.simulate(
        **body(damping_ratio=0.2), **rules, duration=2.0, initial=(0.15, None, 0.0, 0.0)
    )
    forced = winkler.simulate(**body(), **rules, **random_ground(peak=8.0), duration=2.0)
    for run in (free, forced):
        assert run.energy_residual < 1e-9
        assert {"leave", "land"} <= {event.kind for event in run.events}
        assert min(event.repinning_loss for event in run.events) > -1e-15
        assert run.dashpot_work > 0.0
    assert (run.repinning_loss > 1e-9 * MASS) == (restraint == "contact-state")
    if separation == "pressure":
        assert "clear" in {event.kind for event in run.events}


@pytest.mark.parametrize("separation", SEPARATIONS)
def test_flight_keeps_rate_and_horizontal_speed(separation):
    times = np.linspace(0.0, 2.0, 2001)
    run = winkler.simulate(
        **body(damping_ratio=0.05, half_width=2.0, half_height=2.0),
        separation=separation,
        duration=2.0,
        initial=(0.02, None, 0.1, 2.0),
        sample_times=times,
        **TIGHT,
    )
    assert run.flight_count > 2
    assert run.energy_residual < 1e-9
    checked = 0
    for number, event in enumerate(run.events):
        if event.contact_after != "flight":
            continue
        ends = [one.time for one in run.events[number:] if one.contact_after != "flight"]
        inside = (times > event.time) & (times < min(ends, default=2.0))
        after = times[inside] - event.time
        _, y, x, rate, y_rate, x_rate = event.after
        assert set(run.contact[inside]) <= {"flight"}
        assert not run.contact_length[inside].any()
        np.testing.assert_allclose(run.rotation_rate[inside], rate, rtol=0, atol=1e-13)
        np.testing.assert_allclose(run.horizontal[inside], x + x_rate * after, atol=1e-12)
        parabola = y + y_rate * after - 0.5 * G * after**2
        np.testing.assert_allclose(run.vertical[inside], parabola, atol=1e-12)
        checked += inside.sum()
    assert checked > 10


def test_landing_projects_the_momentum_on_the_point_held():
    run = winkler.simulate(
        **body(damping_ratio=0.05, half_width=2.0, half_height=2.0),
        **random_ground(peak=10.0, upward=20.0),
        duration=2.0,
        **TIGHT,
    )
    inertia = (2.0**2 + 2.0**2) / 3.0
    held = {"full": 0.0, "right": 2.0, "left": -2.0}
    changes = [one for one in run.events if one.contact_after not in ("flight", one.contact_before)]
    assert "flight" in {one.contact_before for one in changes}
    for event in changes:
        alpha, _, x, alpha_dot, y_dot, x_dot = event.before
        lever = 2.0 * math.cos(alpha) + held[event.contact_after] * math.sin(alpha)
        new = (inertia * alpha_dot + lever * x_dot) / (inertia + lever**2)
        np.testing.assert_allclose(event.after[3:], (new, y_dot, lever * new), rtol=1e-12)
        assert event.after[2] == x
        loss = 0.5 * (inertia * alpha_dot**2 + x_dot**2 - (inertia + lever**2) * new**2)
        assert event.repinning_loss == pytest.approx(loss, abs=1e-14)
        assert loss >= 0.0


def test_suction_is_cut_and_an_inner_stretch_may_bear():
    """The right end is deeper but rises; the left end sinks but is clear."""
    alpha, rate, ratio = 0.01, -0.4, 1.0
    size = body(settlement=0.01, damping_ratio=ratio)
    lever = HEIGHT * math.sin(alpha)
    start = (alpha, 0.006, rate, -lever * rate)
    times = np.linspace(0.0, 0.02, 21)
    runs = {
        separation: winkler.simulate(
            **size, separation=separation, duration=0.6, initial=start, sample_times=times, **TIGHT
        )
        for separation in SEPARATIONS
    }
    for run in runs.values():
        assert run.energy_residual < 1e-9
        assert run.contact[0] == "right"
    b, k0, c0 = WIDTH, size["bed_stiffness"], size["bed_damping"]
    middle = 0.006 + HEIGHT * (1.0 - math.cos(alpha))
    level = (middle - 0.01) / math.sin(alpha)
    turn = (k0 * (0.01 - middle)) / (-k0 * math.sin(alpha) - c0 * math.cos(alpha) * rate)
    assert -b < level < turn < b
    assert runs["displacement"].contact_length[0] == pytest.approx(b - level, rel=1e-12)
    assert runs["pressure"].contact_length[0] == pytest.approx(turn - level, rel=1e-12)
    # the right end stays held until an end bears again
    assert runs["pressure"].events[0].kind in ("engage", "settle", "land")


@pytest.mark.parametrize("separation", SEPARATIONS)
@pytest.mark.parametrize("restraint", RULES)
def test_mirror_symmetry(restraint, separation):
    times = np.linspace(0.0, 1.0, 21)
    runs = [
        winkler.simulate(
            **body(),
            **random_ground(peak=8.0, upward=8.0, sign=sign),
            restraint=restraint,
            separation=separation,
            duration=1.0,
            initial=(sign * 0.02, None, 0.0, 0.0),
            sample_times=times,
            **TIGHT,
        )
        for sign in (1.0, -1.0)
    ]
    assert len(runs[0].events) > 3
    np.testing.assert_allclose(runs[0].rotation, -runs[1].rotation, rtol=0, atol=1e-12)
    np.testing.assert_allclose(runs[0].vertical, runs[1].vertical, rtol=0, atol=1e-12)
    np.testing.assert_allclose(runs[0].horizontal, -runs[1].horizontal, rtol=0, atol=1e-12)
    assert [one.kind for one in runs[0].events] == [one.kind for one in runs[1].events]


def test_the_restraint_rules_coincide_for_small_rotation():
    times = np.linspace(0.0, 1.5, 31)
    runs = [
        winkler.simulate(
            **body(),
            **random_ground(peak=8.0),
            restraint=rule,
            rotation="small",
            duration=1.5,
            sample_times=times,
            **TIGHT,
        )
        for rule in RULES
    ]
    assert runs[0].events
    for other in runs[1:]:
        np.testing.assert_allclose(other.rotation, runs[0].rotation, rtol=0, atol=1e-11)


def test_response_depends_only_on_stiffness_over_mass():
    times = np.linspace(0.0, 1.5, 31)
    runs = [
        winkler.simulate(
            **body(mass=mass), **random_ground(peak=8.0), duration=1.5, sample_times=times, **TIGHT
        )
        for mass in (1.0, MASS)
    ]
    np.testing.assert_allclose(runs[0].rotation, runs[1].rotation, rtol=0, atol=1e-11)
    assert runs[1].dashpot_work == pytest.approx(MASS * runs[0].dashpot_work, rel=1e-8)


def test_run_stops_or_continues_at_overturning():
    size = body(half_width=0.4, half_height=2.0)
    pulse = {"acceleration": lambda t: -G * math.sin(2.0 * math.pi * t), "breakpoints": (0.5,)}
    stopped = winkler.simulate(**size, **pulse, duration=2.0, sample_times=[0.0, 2.0], **TIGHT)
    assert stopped.overturned
    assert stopped.end_time == stopped.overturning_time
    assert stopped.peak_rotation == pytest.approx(math.atan2(0.4, 2.0), rel=1e-12)
    assert np.isnan(stopped.rotation[-1])
    assert stopped.contact[-1] == ""
    gone_on = winkler.simulate(**size, **pulse, duration=2.0, overturning="continue", **TIGHT)
    assert gone_on.overturning_time == stopped.overturning_time
    assert gone_on.peak_rotation == pytest.approx(0.5 * math.pi, rel=1e-12)
