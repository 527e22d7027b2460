"""The reference model of two rigid blocks on rigid ground: exact values, limits, balances."""

import math
from dataclasses import replace

import numpy as np
import pytest
import sympy as sp
from reference_models.monoliths import rigid_block
from reference_models.rigid_pair.choices import (
    ALL,
    choose_pattern,
    complementary,
    patterns,
    projected,
    strike,
)
from reference_models.rigid_pair.compare import compare_scene
from reference_models.rigid_pair.count_impacts import KINDS, count_impacts, draw_impact, draw_pair
from reference_models.rigid_pair.ground import harmonic, still
from reference_models.rigid_pair.pair import GRAVITY, Body, Pair, Pattern, Phase
from reference_models.rigid_pair.random_scenes import draw, pieces_for, records_available
from reference_models.rigid_pair.simulate import simulate

pytestmark = pytest.mark.reference_models

EQUAL = Pair(Body.uniform(1.0, 2.0, 1.0), Body.uniform(1.0, 2.0, 1.0), 0.0, 1.0)
SMALLER = Pair(Body.uniform(1.0, 2.0, 1.0), Body.uniform(0.5, 1.0, 0.25), 0.1, 1.0)
SQUAT = Pair(Body.uniform(2.0, 1.0, 4.0), Body.uniform(1.0, 2.0, 1.0), 0.0, 1.0)
NARROW = Pair(Body.uniform(1.0, 2.0, 1.0), Body.uniform(0.5, 2.0, 0.5), 0.1, 1.0)
TOGETHER, UPPER = Pattern("right", "both"), Pattern("both", "right")


def landing(pair, pattern, rate):
    """Return positions and velocities of bodies that land upright."""
    phase = Phase(pair, pattern, pair.offset)
    place = phase.placed(np.zeros(phase.size))
    speed = phase.motions(0.0, 0.0)[0] @ np.full(phase.size, rate)
    return place, speed


@pytest.mark.parametrize(
    ("pair", "before", "rate", "after", "rates", "energy"),
    [
        (EQUAL, TOGETHER, -1, ("left", "both"), (-31 / 34, -31 / 34), 961 / 1156),
        (EQUAL, UPPER, -1, ("left", "left"), (-9 / 49, -47 / 98), 109 / 196),
        (SMALLER, UPPER, -1, ("left", "left"), (-3630 / 190819, -124099 / 190819), 94819 / 190819),
        (SMALLER, Pattern("both", "left"), 1, ("right", "right"),
         (5670 / 194539, 122059 / 194539), 98539 / 194539),
        (SMALLER, TOGETHER, -1, ("left", "left"), (-150079 / 190819, -182659 / 190819),
         1990604923 / 3018184123),
        (SMALLER, Pattern("left", "both"), 1, ("right", "right"),
         (157879 / 194539, 169099 / 194539), 2058693523 / 3123712723),
        (SQUAT, UPPER, -1, ("both", "left"), (0, -0.7), 0.49),
        (SQUAT, TOGETHER, -1, ("both", "left"), (0, -1.15), 529 / 2900),
    ],
)  # fmt: skip
def test_landings_in_exact_numbers(pair, before, rate, after, rates, energy):
    place, speed = landing(pair, before, rate)
    outcome = strike(pair, pair.offset, place, speed, ALL)
    assert outcome.pattern == after
    assert outcome.admissible == 1
    assert outcome.motion[[2, 5]] == pytest.approx(rates, abs=1e-14)
    energy_before = 0.5 * pair.masses @ speed**2
    assert 1.0 - outcome.lost / energy_before == pytest.approx(energy, rel=1e-13)


def test_exact_landing_rates_follow_from_angular_momentum():
    """Momentum about the corner on the ground, and of the upper block about its own corner."""
    third = sp.Rational(1, 3)
    half, one = sp.Rational(1, 2), sp.Integer(1)
    inertia = third * (half**2 + one)
    first, second = sp.symbols("first second")
    # positions of the centres of mass from the left corners, the centres of rotation
    lower, upper, arm = (half, one), (half, 3 * one), (half, one)

    def across(rate, place):
        return rate * place[1], -rate * place[0]

    def about(place, speed):
        return place[1] * speed[0] - place[0] * speed[1]

    # before: the upper block turns about its right corner at -1
    before = across(-1, (-half, one))
    total = about(upper, before) - inertia
    own = about(arm, before) - inertia
    ride = across(first, (0, 2))
    turn = across(second, arm)
    speed = (ride[0] + turn[0], ride[1] + turn[1])
    after = about(upper, speed) + inertia * second
    after += about(lower, across(first, lower)) + inertia * first
    solved = sp.solve([after - total, about(arm, speed) + inertia * second - own], [first, second])
    impact = strike(EQUAL, 0.0, *landing(EQUAL, UPPER, -1), ALL)
    assert impact.pattern == ("left", "left")
    rates = [float(solved[rate]) for rate in (first, second)]
    assert impact.motion[[2, 5]] == pytest.approx(rates, abs=1e-14)


@pytest.mark.parametrize(
    ("pair", "shares"),
    [
        (NARROW, {
            0.2: ("both", "both", 0, 0), 0.3: ("both", "left", 0, -0.6 / 17),
            0.53: ("left", "both", -80 * 5.25 / 5219, -80 * 5.25 / 5219),
            2.8: ("left", "both", -80 * 62 / 5219, -80 * 62 / 5219),
        }),
        (EQUAL, {0.2: ("both", "both", 0, 0), 0.3: ("left", "both", -0.6 / 34, -0.6 / 34),
                 6.6: ("left", "both", -76.2 / 34, -76.2 / 34)}),
        (SQUAT, {0.4: ("both", "both", 0, 0), 1.5: ("both", "left", 0, -0.6)}),
    ],
)  # fmt: skip
def test_first_accelerations_in_exact_numbers(pair, shares):
    phase = Phase(pair, Pattern("both", "both"), pair.offset)
    place = phase.placed(np.zeros(0))
    for across, (ground, joint, *rates) in shares.items():
        outcome = choose_pattern(phase, place, np.zeros(6), ALL, across, 0.0)
        assert outcome.pattern == (ground, joint)
        assert outcome.admissible == 1
        assert outcome.motion[[2, 5]] == pytest.approx(rates, abs=1e-13)


@pytest.mark.parametrize(
    ("pair", "at", "before", "after"),
    [
        (NARROW, 0.25, ("both", "both"), ("both", "left")),
        (NARROW, 1335 / 3436, ("both", "left"), ("left", "left")),
        (NARROW, 11255 / 21472, ("left", "left"), ("left", "both")),
        (NARROW, 40265 / 14272, ("left", "both"), ("left", "right")),
        (EQUAL, 0.25, ("both", "both"), ("left", "both")),
        (EQUAL, 53 / 8, ("left", "both"), ("left", "right")),
        (SMALLER, 31085 / 5456, ("left", "both"), ("left", "right")),
        (SQUAT, 0.5, ("both", "both"), ("both", "left")),
        (SQUAT, 11 / 6, ("both", "left"), ("left", "left")),
    ],
)
def test_patterns_that_follow_a_jump_of_the_ground_acceleration(pair, at, before, after):
    phase = Phase(pair, Pattern("both", "both"), pair.offset)
    place = phase.placed(np.zeros(0))
    for across, wanted in ((at * (1 - 1e-6), before), (at * (1 + 1e-6), after)):
        outcome = choose_pattern(phase, place, np.zeros(6), ALL, across, 0.0)
        assert (outcome.pattern, outcome.admissible) == (wanted, 1)


# equations -------------------------------------------------------------------------------------


def euler_lagrange(pair: Pair, pattern: Pattern):
    """Derive Lagrange's equations from the energies by symbolic differentiation."""
    phase = Phase(pair, pattern, pair.offset)
    t, across, up = sp.symbols("t across up")
    q = [sp.Function(f"q{i}")(t) for i in range(phase.size)]
    exact = sp.nsimplify

    def turned(angle, point):
        x, y = (exact(lower, rational=True) for lower in point)
        return x * sp.cos(angle) + y * sp.sin(angle), y * sp.cos(angle) - x * sp.sin(angle)

    ground, joint = pattern
    turn = q[2] if ground == "none" else q[0] if ground != "both" else sp.Integer(0)
    if ground == "none":
        lower = (q[0], q[1])
    else:
        end = "left" if ground == "both" else ground
        lower = tuple(-c for c in turned(turn, phase.seats.ground[end]))
    if joint == "none":
        upper, upper_rotation = tuple(q[-3:-1]), q[-1]
    else:
        end = "left" if joint == "both" else joint
        upper_rotation = turn if joint == "both" else q[-1]
        base, lever = (
            turned(turn, phase.seats.below[end]),
            turned(upper_rotation, phase.seats.above[end]),
        )
        upper = tuple(a + b - c for a, b, c in zip(lower, base, lever, strict=True))
    masses = [exact(float(value), rational=True) for value in pair.masses]
    places = [*lower, turn, *upper, upper_rotation]
    kinetic = sum(m * sp.diff(x, t) ** 2 / 2 for m, x in zip(masses, places, strict=True))
    weights = sum(
        m * (across * x + (exact(pair.gravity, rational=True) + up) * y)
        for m, x, y in ((masses[0], *lower), (masses[3], *upper))
    )
    lagrangian = kinetic - weights
    rates = [sp.diff(lower, t) for lower in q]
    equations = [
        sp.diff(sp.diff(lagrangian, rate), t) - sp.diff(lagrangian, place)
        for place, rate in zip(q, rates, strict=True)
    ]
    plain = [sp.symbols(f"a{i} v{i} p{i}") for i in range(len(q))]
    for place, (a, v, p) in zip(q, plain, strict=True):
        equations = [
            lower.subs(sp.diff(place, t, 2), a).subs(sp.diff(place, t), v).subs(place, p)
            for lower in equations
        ]
    flat = [symbol for trio in plain for symbol in trio]
    return phase, sp.lambdify([*flat, across, up], equations)


@pytest.mark.parametrize(
    "pattern",
    [
        ("right", "left"), ("right", "both"), ("both", "left"), ("none", "right"),
        *(
            pytest.param(one, marks=pytest.mark.long)
            for one in (("left", "left"), ("left", "none"), ("none", "both"), ("none", "none"))
        ),
    ],
)  # fmt: skip
def test_accelerations_satisfy_lagranges_equations(pattern):
    rng = np.random.default_rng(8)
    lower = Body(3.0, 1.7, 0.6, 0.7, 0.9, 0.1)
    upper = Body(2.0, 0.9, 0.4, 0.8, 0.5, -0.07)
    phase, residual = euler_lagrange(Pair(lower, upper, 0.08), Pattern(*pattern))
    for _ in range(5):
        q, rates = rng.uniform(-0.6, 0.6, phase.size), rng.uniform(-2.0, 2.0, phase.size)
        across, up = rng.uniform(-8.0, 8.0, 2)
        place = phase.placed(q)
        jac, _ = phase.motions(place[2], place[5])
        speed = jac @ rates
        second_rates, full = phase.accelerate(place[2], place[5], speed[2], speed[5], across, up)
        flat = [one for trio in zip(second_rates, rates, q, strict=True) for one in trio]
        assert residual(*flat, across, up) == pytest.approx(np.zeros(phase.size), abs=1e-11)
        size = 1e-5
        ahead, back = (phase.placed(q + way * size * rates) for way in (1.0, -1.0))
        assert (ahead - back) / (2.0 * size) == pytest.approx(speed, abs=1e-8)
        bent = jac @ second_rates + (ahead - 2.0 * place + back) / size**2
        assert full == pytest.approx(bent, abs=2e-4)


def test_ends_at_rest_share_the_weights():
    pair = SMALLER
    phase = Phase(pair, Pattern("both", "both"), pair.offset)
    place = phase.placed(np.zeros(0))
    pressures = phase.pressures(place, phase.needed(np.zeros(6), 0.2, 0.0))
    # moments of weight and inertia about the left end of each base
    assert pressures["joint", "right"] == pytest.approx(0.25 * (0.25 - 0.2 * 0.5) / 0.5)
    moment = 1.0 * (0.5 - 0.2 * 1.0) + 0.25 * (0.6 - 0.2 * 2.5)
    assert pressures["ground", "right"] == pytest.approx(moment / 1.0)
    assert pressures["ground", "left"] + pressures["ground", "right"] == pytest.approx(1.25)


# limits ----------------------------------------------------------------------------------------

PULSE = {"frequency": 1.5, "cycles": 1}


def monolith(width, height, peak, free):
    turn, stop = 2.0 * math.pi * PULSE["frequency"], PULSE["cycles"] / PULSE["frequency"]
    return rigid_block.simulate(
        half_width=0.5 * width, half_height=0.5 * height, shape_factor=3.0,
        acceleration=lambda t: peak * math.sin(turn * t) if t < stop else 0.0,
        breakpoints=(stop,), duration=stop + free, gravity=GRAVITY,
        sample_times=np.arange(0.0, stop + free, 0.01),
    )  # fmt: skip


def test_nearly_massless_upper_body_leaves_lower_block_alone():
    one = Body.uniform(0.5, 2.0, 1000.0)
    run = simulate(
        Pair(one, Body.uniform(0.4, 0.05, 1e-9)), harmonic(3.4, 0.0, **PULSE, free=1.5), 0.01
    )
    alone = monolith(0.5, 2.0, 3.4, 1.5)
    count = min(len(run.time), alone.time.size)
    assert sum(event.kind == "impact" for event in run.events) >= 2
    assert run.place[:count, 2] == pytest.approx(alone.rotation[:count], abs=1e-9)


def test_heavy_lower_body_acts_as_ground():
    squat = Body.uniform(4.0, 0.2, 1e9)
    run = simulate(
        Pair(squat, Body.uniform(0.5, 2.0, 1000.0)), harmonic(3.4, 0.0, **PULSE, free=1.5), 0.01
    )
    alone = monolith(0.5, 2.0, 3.4, 1.5)
    assert {event.after.ground for event in run.events} == {"both"}
    count = min(len(run.time), alone.time.size)
    assert run.place[:count, 5] == pytest.approx(alone.rotation[:count], abs=1e-9)


def test_halves_of_a_column_rock_as_one_body():
    half = Body.uniform(0.5, 1.0, 500.0)
    run = simulate(Pair(half, half), harmonic(3.4, 0.0, **PULSE, free=1.5), 0.01)
    alone = monolith(0.5, 2.0, 3.4, 1.5)
    assert {event.after.joint for event in run.events} == {"both"}
    assert sum(event.kind == "impact" for event in run.events) >= 2
    count = min(len(run.time), alone.time.size)
    assert run.place[:count, 5] == pytest.approx(alone.rotation[:count], abs=1e-9)


@pytest.mark.long
def test_decaying_rocking_ends_in_rest():
    """The intervals between impacts of a block alone have a finite sum."""
    half = Body.uniform(0.5, 1.0, 500.0)
    run = simulate(
        Pair(half, half), [still(0.0, 20.0)], 0.1, start=(Pattern("right", "both"), [0.05], [0.0])
    )
    assert run.events[-1].kind == "rest"
    assert run.events[-1].after == ("both", "both")
    assert run.place[-1, 2] == 0.0


# balances --------------------------------------------------------------------------------------

ROUGH = Pair(Body(1000.0, 120.0, 0.25, 0.5, 0.55, 0.02), Body(800.0, 90.0, 0.2, 0.6, 0.5), 0.02)


def test_energies_balance():
    run = simulate(ROUGH, harmonic(8.0, 3.0, 3.0, 1, free=1.0), 0.01, quickest=1.0 / 3.0)
    assert len(run.events) > 20
    assert {event.where for event in run.events if event.kind == "impact"} == {"ground", "joint"}
    assert all(event.lost > -1e-12 for event in run.events)
    assert run.imbalance < 1e-10


def test_energy_between_impacts():
    start = (Pattern("right", "left"), [0.1, -0.08], [0.3, -0.2])
    run = simulate(ROUGH, [still(0.0, 0.4)], 0.01, start=start)
    assert run.imbalance < 1e-10


def test_mirrored_motion():
    one = simulate(ROUGH, harmonic(8.0, 3.0, 3.0, 1, free=0.5), 0.01, quickest=1.0 / 3.0)
    pieces = harmonic(-8.0, 3.0, 3.0, 1, free=0.5)
    pieces[0] = replace(pieces[0], up=lambda t: 3.0 * math.sin(6.0 * math.pi * t))
    other = simulate(ROUGH.mirrored(), pieces, 0.01, quickest=1.0 / 3.0)
    assert other.place[:, 2] == pytest.approx(-one.place[:, 2], abs=1e-10)
    assert other.place[:, 5] == pytest.approx(-one.place[:, 5], abs=1e-10)


def test_tolerance_does_not_matter():
    one, other = (
        simulate(ROUGH, harmonic(8.0, 3.0, 3.0, 1), 0.01, accuracy=size) for size in (1e-12, 1e-10)
    )
    assert other.place == pytest.approx(one.place, abs=1e-9)


@pytest.mark.long
def test_falling_ground_leaves_bodies_in_flight():
    """The ground jolts up and then drops faster than free fall: the bodies fly, land and rest."""
    pieces = harmonic(0.3, -14.0, 2.0, 1, free=1.0)
    run = simulate(ROUGH, pieces, 0.01, quickest=0.5)
    assert any(event.kind == "flight" for event in run.events)
    assert run.imbalance < 1e-10
    assert all(one == "both" for one in run.events[-1].after)


@pytest.mark.long
@pytest.mark.skipif(not records_available(), reason="recorded motions are not available")
def test_pulling_hinge_that_would_close_at_once_is_held():
    """Opposite senses of rocking: a released light upper block would land on the lower one."""
    scene = draw(np.random.default_rng([11, 29]))
    pieces, period = pieces_for(scene.motion)
    run = simulate(scene.pair, pieces, 0.01, quickest=period)
    first = next(event for event in run.events if event.kind == "held")
    assert first.after in {("left", "right"), ("right", "left")}
    assert run.unique_until == first.time
    assert run.imbalance < 1e-10


@pytest.mark.long
def test_random_scenes_uplift_and_overturn():
    ends = []
    for number in range(30):
        scene = draw(np.random.default_rng([11, number]))
        if scene.motion["form"] == "record":
            continue
        pieces, period = pieces_for(scene.motion)
        run = simulate(scene.pair, pieces, 0.01, quickest=period)
        assert run.imbalance < 1e-9
        ends.append((bool(run.events), run.overturned))
    assert len(ends) > 15
    assert sum(lifted for lifted, _ in ends) > 0.8 * len(ends)
    assert 0.2 < sum(fallen for _, fallen in ends) / len(ends) < 0.8


@pytest.mark.parametrize(
    "number", [2, 11, *(pytest.param(one, marks=pytest.mark.long) for one in (0, 13))]
)
def test_rockframe_matches_reference_model(number):
    comparison = compare_scene(draw(np.random.default_rng([11, number])))
    assert comparison.same_verdict
    assert comparison.difference < 1e-8


# impacts ---------------------------------------------------------------------------------------


@pytest.mark.long
def test_number_of_admissible_patterns():
    rng = np.random.default_rng(5)
    found = {kind: count_impacts(rng, kind, 400) for kind in KINDS}
    for kind in KINDS[:2]:
        assert found[kind] == {"admissible": {1: 400}, "single as complementary": 400}
    assert set(found[KINDS[2]]["admissible"]) == {0, 1}
    assert set(found[KINDS[3]]["admissible"]) == {1, 2}


@pytest.mark.parametrize("kind", KINDS)
def test_impacts_lose_energy_and_keep_momentum(kind):
    rng = np.random.default_rng(6)
    for _ in range(100):
        pair, place, speed, touching = draw_impact(rng, kind)
        found = strike(pair, pair.offset, place, speed, touching)
        assert found.lost > -1e-12 * (pair.masses @ speed**2)
        phase = Phase(pair, found.pattern, pair.offset)
        if found.admissible:
            jac, _ = phase.motions(place[2], place[5])
            impulses = pair.masses * (found.motion - speed)
            assert jac.T @ impulses == pytest.approx(
                np.zeros(phase.size), abs=1e-9 * (pair.masses @ np.abs(speed))
            )


def test_complementary_impulses_match_projected_pattern():
    rng = np.random.default_rng(7)
    same = 0
    for _ in range(200):
        pair, place, speed, touching = draw_impact(rng, KINDS[2])
        seats = Phase(pair, Pattern("both", "both"), pair.offset).seats
        pattern, after = complementary(seats, pair.masses, place, speed, touching)
        if "none" not in pattern:
            same += 1
            phase = Phase(pair, pattern, pair.offset)
            assert after == pytest.approx(projected(phase, place, speed), abs=1e-9)
    assert same > 100


def test_patterns_cover_all_subsets_of_touching_ends():
    assert len(patterns(ALL)) == 16
    assert len(set(patterns(ALL))) == 16
    assert len(patterns({"ground": ("left",), "joint": ("left", "right")})) == 8
    assert draw_pair(np.random.default_rng(1)) == draw_pair(np.random.default_rng(1))
