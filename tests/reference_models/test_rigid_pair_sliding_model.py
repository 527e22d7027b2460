"""The reference model of two rigid blocks that slide and rock: limits, closed forms, balances."""

import math
from dataclasses import replace

import numpy as np
import pytest
from reference_models.monoliths.slide_rock import Block
from reference_models.rigid_pair import random_scenes as rigid_scenes
from reference_models.rigid_pair import simulate as plain
from reference_models.rigid_pair.ground import Piece, harmonic, pieces_of, still
from reference_models.rigid_pair.pair import ENDS, GRAVITY, Body, Pair
from reference_models.rigid_pair_sliding.choices import strike
from reference_models.rigid_pair_sliding.contacts import (
    INTERFACES,
    Bearing,
    Friction,
    Pattern,
    contact,
    height,
    on_top,
    tidied,
    upright_places,
)
from reference_models.rigid_pair_sliding.events import OffTheTopError
from reference_models.rigid_pair_sliding.random_scenes import draw
from reference_models.rigid_pair_sliding.simulate import simulate, simulate_pair

pytestmark = [pytest.mark.reference_models, pytest.mark.long]

HELD = {"ground": Friction(), "joint": Friction()}
ROUGH = Pair(Body(1000.0, 120.0, 0.35, 0.5, 0.55, 0.02), Body(800.0, 90.0, 0.2, 0.6, 0.5), 0.02)
FLAT = Pair(Body.uniform(3.0, 0.4, 2000.0), Body.uniform(1.0, 0.2, 1000.0))


def constant_acceleration(acceleration, length, free, up=0.0):
    """Return ground with a constant acceleration for some time."""
    return [
        Piece(0.0, length, lambda t: acceleration, lambda t: up, linear=True),
        still(length, length + free),
    ]


# kinematics ------------------------------------------------------------------------------------


def test_contact_rows_are_derivatives_of_positions():
    rng = np.random.default_rng(1)
    for _ in range(5):
        place = upright_places(ROUGH) + rng.uniform(-0.4, 0.4, 6)
        speed, bend = rng.uniform(-2.0, 2.0, 6), rng.uniform(-5.0, 5.0, 6)
        size = 1e-4
        ahead, back = (place + w * size * speed + 0.5 * size**2 * bend for w in (1.0, -1.0))
        for end in ENDS:
            row = contact(ROUGH, place, speed, "joint", end)
            at, far, near = (np.array(on_top(ROUGH, p, end)) for p in (place, ahead, back))
            rates = (far - near) / (2.0 * size)
            assert [np.dot(row.along, speed), np.dot(row.normal, speed)] == pytest.approx(
                rates, abs=1e-6
            )
            accelerations = (
                np.array([np.dot(row.along, bend), np.dot(row.normal, bend)]) + row.turns
            )
            assert accelerations == pytest.approx((far - 2.0 * at + near) / size**2, abs=1e-4)
            row = contact(ROUGH, place, speed, "ground", end)
            low = [height(ROUGH, p, end) for p in (place, ahead, back)]
            assert np.dot(row.normal, speed) == pytest.approx(
                (low[1] - low[2]) / (2 * size), abs=1e-6
            )
            accelerations = np.dot(row.normal, bend) + row.turns[1]
            assert accelerations == pytest.approx(
                (low[1] - 2 * low[0] + low[2]) / size**2, abs=1e-4
            )


def test_projected_positions_touch_at_bearing_ends():
    rng = np.random.default_rng(2)
    for ground, joint in [
        (ENDS, ENDS),
        (("left",), ENDS),
        (ENDS, ("right",)),
        (("right",), ("left",)),
    ]:
        place = upright_places(ROUGH) + rng.uniform(-1e-3, 1e-3, 6)
        pattern = Pattern(Bearing(ground), Bearing(joint))
        projected = tidied(ROUGH, pattern, place)
        for end in ground:
            assert height(ROUGH, projected, end) == pytest.approx(0.0, abs=1e-15)
        for end in joint:
            assert on_top(ROUGH, projected, end)[1] == pytest.approx(0.0, abs=1e-15)
        assert projected == pytest.approx(place, abs=5e-3)
        assert projected[0] == place[0]
        assert tidied(ROUGH, pattern, projected) == pytest.approx(projected, abs=1e-15)


# limits ----------------------------------------------------------------------------------------


@pytest.mark.parametrize("number", [3, 13, 14, 16, 57])
def test_infinite_friction_matches_pair_without_slip(number):
    """Scenes with pulses whose upper body is the narrower one."""
    scene = rigid_scenes.draw(np.random.default_rng([11, number]))
    pieces, period = rigid_scenes.pieces_for(scene.motion)
    one = plain.simulate(scene.pair, pieces, 0.01, quickest=period)
    two = simulate_pair(scene.pair, HELD, pieces, 0.01, quickest=period)
    assert one.overturned == two.overturned
    kinds = {"uplift", "flight", "impact", "rest", "overturning"}
    of_both = [[e for e in run.events if e.kind in kinds] for run in (one, two)]
    until = min(one.unique_until, two.unique_until)
    times = [[e.time for e in events if e.time < until] for events in of_both]
    assert times[0] == pytest.approx(times[1], abs=1e-9)
    within = one.time[: len(two.time)] < until
    places = [(run.place - run.place[0])[: len(two.time)][within] for run in (one, two)]
    assert np.max(np.abs(places[0][:, [2, 5]])) > 1e-3
    assert places[1] == pytest.approx(places[0], abs=1e-9)


def draw_lone_block(rng):
    """Draw a block, its friction, noise that makes it slide and rock, and its reference model."""
    width = float(rng.uniform(0.4, 1.0))
    rise = width * float(rng.uniform(0.5, 1.5))
    body = Body.uniform(width, 2.0 * rise, 1000.0)
    slender = 0.5 * width / rise
    static = slender * float(rng.uniform(0.8, 1.4))
    kinetic = static * float(rng.choice([1.0, rng.uniform(0.5, 1.0)]))
    across = rng.normal(size=26) * 0.9 * min(slender, static) * GRAVITY
    across[0] = across[-1] = 0.0
    times = np.append(0.1 * np.arange(26), [2.5 + 1e-9, 10.0])
    along = np.append(across, [0.0, 0.0])
    limits = (math.atan(slender), math.atan(slender))
    block = Block(
        0.5 * width, 0.5 * width, rise, body.inertia / body.mass, static, kinetic, GRAVITY,
        times, along, np.zeros_like(times), limits,
    )  # fmt: skip
    return body, Friction(static, kinetic), across, block


# it slides, rocks, does both, and slips in impacts. Scenes with a long series of ever smaller
# impacts during slip are excluded: the programs truncate such series differently, to 1e-5
@pytest.mark.parametrize("number", [1, 7, 8, 11, 33])
def test_upper_body_on_heavy_body_matches_lone_block(number):
    heavy = Body.uniform(30.0, 1.0, 1e12)
    body, friction, across, block = draw_lone_block(np.random.default_rng([3, number]))
    pieces = [*pieces_of(0.1, across), still(2.5, 3.5)]
    run = simulate_pair(Pair(heavy, body), {"ground": Friction(), "joint": friction}, pieces, 0.05)
    assert all(e.admissible == 1 and e.kind != "flight" for e in run.events)
    assert {e.after.ground for e in run.events} <= {Bearing(ENDS)}
    # Routh's law, of the other program, would have a second phase of slip
    assert all(e.before[1].slip * e.after[1].slip >= 0 for e in run.events if e.kind == "impact")
    other = block.simulate(0.0, 3.5)
    assert run.peak_slips[1] > 1e-5
    assert run.overturned == other["fell"]
    assert run.peaks[1] == pytest.approx(other["peak"], rel=1e-7)
    assert run.peak_slips[1] == pytest.approx(other["peak_slip"], rel=1e-7)
    if not run.overturned:
        across = run.final[3] - run.final[0] - body.beside
        assert across == pytest.approx(other["state"][0], abs=1e-7 * run.peak_slips[1])


# closed forms ----------------------------------------------------------------------------------


@pytest.mark.parametrize(("times", "share"), [(2.0, 0.5), (4.0, 1.0), (1.5, 0.7)])
@pytest.mark.parametrize("key", INTERFACES)
def test_newmarks_distance(key, times, share):
    """For a pulse of constant acceleration a and yield acceleration c: a t² (a / c - 1) / 2."""
    friction = Friction(0.1, 0.1 * share)
    gives = 0.1 * share * GRAVITY
    length, pulse = 0.3, 0.1 * times * GRAVITY
    run = simulate_pair(
        FLAT, {**HELD, key: friction}, constant_acceleration(pulse, length, 3.0), 0.01
    )
    distance = 0.5 * pulse * length**2 * (pulse / gives - 1.0)
    which = INTERFACES.index(key)
    assert run.slip[-1, which] == pytest.approx(-distance, rel=1e-10)
    assert run.slip[-1, 1 - which] == 0.0
    assert run.peak_slips[which] == pytest.approx(distance, rel=1e-10)
    assert [e.kind for e in run.events] == ["slip", "stick"]
    stop = length * pulse / gives
    assert run.events[-1].time == pytest.approx(stop, rel=1e-12)
    pressed = (3000.0, 1000.0)[which] * GRAVITY
    burnt = 0.1 * share * pressed * distance
    assert run.energies[key] == pytest.approx(burnt, rel=1e-10)


def test_vertical_acceleration_changes_friction_force():
    run = simulate_pair(
        FLAT, {**HELD, "ground": Friction(0.1, 0.1)},
        constant_acceleration(3.0, 0.3, 2.0, up=-4.0), 0.01,
    )  # fmt: skip
    first = 3.0 - 0.1 * (GRAVITY - 4.0)
    distance = 0.5 * first * 0.09 + 0.5 * (first * 0.3) ** 2 / (0.1 * GRAVITY)
    assert run.slip[-1, 0] == pytest.approx(-distance, rel=1e-10)


def test_two_sliders_in_closed_form():
    """Both slip back under a pulse of the ground; the lower one stops first, then the upper one."""
    lower, upper = Friction(0.45, 0.4), Friction(0.25, 0.2)
    m1, m2, pulse, length = 2000.0, 1000.0, 0.8 * GRAVITY, 0.2
    run = simulate_pair(
        FLAT, {"ground": lower, "joint": upper}, constant_acceleration(pulse, length, 1.5), 0.005
    )
    c2 = 0.2 * GRAVITY
    c1 = (0.4 * (m1 + m2) - 0.2 * m2) * GRAVITY / m1
    distances = [0.5 * pulse * length**2 * (pulse / c - 1.0) for c in (c1, c2)]
    assert run.slip[-1] == pytest.approx([-distances[0], distances[0] - distances[1]], rel=1e-10)
    assert run.displacement[-1] == pytest.approx([-one for one in distances], rel=1e-10)
    assert [(e.kind, e.where) for e in run.events] == [
        ("slip", "ground"), ("stick", "ground"), ("stick", "joint"),
    ]  # fmt: skip
    assert run.events[0].after == (Bearing(ENDS, -1), Bearing(ENDS, -1))
    stops = [length * pulse / c for c in (c1, c2)]
    assert [e.time for e in run.events[1:]] == pytest.approx(stops, rel=1e-11)
    assert run.imbalance < 1e-12


def test_the_upper_body_drags_the_lower_one():
    """With less friction on the ground than above, both bodies slide together."""
    frictions = {"ground": Friction(0.1, 0.1), "joint": Friction(0.3, 0.3)}
    run = simulate_pair(FLAT, frictions, constant_acceleration(0.25 * GRAVITY, 0.2, 1.0), 0.01)
    assert run.slip[-1, 1] == 0.0
    assert run.slip[-1, 0] == pytest.approx(-0.5 * 0.25 * GRAVITY * 0.04 * 1.5, rel=1e-10)


def rolls_over(slender, friction):
    """Return rotation and slip rates after and before an impact of a rectangle, from one corner."""
    t, mu = slender, friction
    whole = 1.0 + 4.0 * t**2 - 3.0 * mu * t
    return (1.0 - 2.0 * t**2 + 3.0 * mu * t) / whole, 2.0 * t * (
        3.0 * t - 4.0 * mu - mu * t**2
    ) / whole


@pytest.mark.parametrize("key", INTERFACES)
@pytest.mark.parametrize(("slender", "friction"), [(0.4, 0.1), (0.4, 0.25), (0.6, 0.3), (0.3, 0.5)])
def test_impacts_of_one_rectangle_in_closed_form(key, slender, friction):
    """Below a friction of 3 t / (4 + t²) the striking corner slips throughout the impact."""
    body = Body.uniform(2.0 * slender, 2.0, 1.0)
    if key == "joint":
        pair = Pair(Body.uniform(50.0, 1.0, 1e14), body)
        k = 3
    else:
        pair = Pair(body, Body.uniform(1e-3 * slender, 1e-3, 1e-13))
        k = 0
    place, speed = upright_places(pair), np.zeros(6)
    speed[k : k + 3] = -1.0, -slender, -1.0  # about the right corner, back onto the left one
    if key == "ground":
        speed[3:] = -(2.0 + 5e-4), -slender, -1.0
    touching = {"ground": ENDS, "joint": ENDS}
    outcome = strike(pair, {**HELD, key: Friction(2.0, friction)}, place, speed, touching)
    assert outcome.admissible == 1
    housner = 1.0 - 1.5 * slender**2 / (1.0 + slender**2)
    slips = friction < 3.0 * slender / (4.0 + slender**2)
    rates = rolls_over(slender, friction) if slips else (housner, 0.0)
    motion = outcome.answer.motion
    assert -motion[k + 2] == pytest.approx(rates[0], rel=1e-9)
    slip = motion[k] - motion[k + 2]
    assert abs(slip) == pytest.approx(abs(rates[1]), abs=1e-9)
    stuck = strike(pair, {**HELD, key: Friction(2.0, friction, True)}, place, speed, touching)
    assert -stuck.answer.motion[k + 2] == pytest.approx(housner, rel=1e-9)


# balances --------------------------------------------------------------------------------------


def draw_impact(rng):
    """Draw frictions, places and velocities just before an impact, and the ends that touch."""
    frictions = {key: Friction(1.0, float(rng.uniform(0.1, 0.9))) for key in INTERFACES}
    place, speed = upright_places(ROUGH), np.zeros(6)
    kind = int(rng.integers(4))
    touching = {"ground": ENDS, "joint": ENDS}
    if kind == 1:  # the lower body lands under a tilted upper one
        place[5], touching["joint"] = 0.1, ("right",)
    elif kind == 2:  # the upper body lands on a tilted lower one
        place[[2, 5]], touching["ground"] = 0.1, ("right",)
    elif kind == 3:
        place[2], touching["ground"], touching["joint"] = 0.1, ("right",), ("left",)
    place = tidied(ROUGH, Pattern(*(Bearing(touching[key]) for key in INTERFACES)), place)
    speed = rng.uniform(-1.0, 1.0, 6)
    speed[[1, 4]] -= 1.0
    return frictions, place, speed, touching


def test_impacts_keep_momentum_and_obey_coulombs_law():
    rng = np.random.default_rng(6)
    slips, holds = 0, 0
    for _ in range(150):
        frictions, place, speed, touching = draw_impact(rng)
        outcome = strike(ROUGH, frictions, place, speed, touching)
        assert outcome.admissible >= 1
        assert outcome.lost >= -1e-12
        normal, friction = outcome.answer.normal, outcome.answer.friction
        after = outcome.answer.motion
        change = ROUGH.masses * (after - speed)
        balance = np.zeros(6)
        size = 1e-9 * float(np.max(np.abs(change)))
        for key, bearing in zip(INTERFACES, outcome.pattern, strict=True):
            if not bearing.ends:
                continue
            # sum of forces and moments about the centres of mass
            tilt = 0.0 if key == "ground" else place[2]
            along = np.array([math.cos(tilt), -math.sin(tilt)])
            away = np.array([math.sin(tilt), math.cos(tilt)])
            body, k = (ROUGH.lower, 0) if key == "ground" else (ROUGH.upper, 3)
            total = sum(normal[key, end] for end in bearing.ends)
            for end in bearing.ends:
                share = 1.0 / len(bearing.ends)
                force = normal[key, end] * away + share * friction[key] * along
                x = (1.0 if end == "right" else -1.0) * body.half_width - body.beside
                c, s = math.cos(place[k + 2]), math.sin(place[k + 2])
                arm = np.array([x * c - body.below * s, -x * s - body.below * c])
                point = place[k : k + 2] + arm
                balance[k : k + 3] += *force, arm[1] * force[0] - arm[0] * force[1]
                if key == "joint":
                    arm = point - place[:2]
                    balance[:3] -= *force, arm[1] * force[0] - arm[0] * force[1]
                assert normal[key, end] >= -size
                parts = contact(ROUGH, place, after, key, end)
                assert np.dot(parts.normal, after) == pytest.approx(0.0, abs=1e-9)
            slip = float(np.dot(parts.along, after))
            if bearing.slip:
                assert friction[key] == pytest.approx(
                    -bearing.slip * frictions[key].kinetic * total, abs=size
                )
                assert slip * bearing.slip > -1e-9
                slips += 1
            else:
                assert slip == pytest.approx(0.0, abs=1e-9)
                assert abs(friction[key]) <= frictions[key].kinetic * total + size
                holds += 1
        assert balance == pytest.approx(change, abs=size)
        for key, bearing in zip(INTERFACES, outcome.pattern, strict=True):
            for end in set(touching[key]) - set(bearing.ends):
                assert np.dot(contact(ROUGH, place, after, key, end).normal, after) > -1e-9
    assert slips > 30
    assert holds > 30


def test_energies_of_random_scenes_balance():
    kinds, balances, both = set(), [], 0
    for number in (35, 48, 54, 61, 64, 75):
        try:
            run = simulate(draw([7, number]), 0.05)
        except OffTheTopError as fault:
            run = fault.run
        kinds |= {e.kind for e in run.events}
        balances.append(run.imbalance)
        assert all(e.lost > -1e-9 for e in run.events if e.kind == "impact")
        assert run.energies["ground"] >= 0.0
        assert run.energies["joint"] >= 0.0
        both += bool(run.peaks.max() > 1e-3 and run.peak_slips.max() > 1e-3)
    assert max(balances) < 1e-9
    assert both > 3
    assert kinds >= {"slip", "stick", "reversal", "uplift", "impact", "rest", "overturning"}


@pytest.mark.parametrize("number", [79, 99])
def test_mirrored_scenes(number):
    scene = draw([7, number])
    one, two = simulate(scene), simulate(scene.mirrored())
    assert one.peaks.max() > 1e-3
    assert one.peak_slips.max() > 1e-3
    assert two.rotation == pytest.approx(-one.rotation, abs=1e-9)
    assert two.displacement == pytest.approx(-one.displacement, abs=1e-9)
    assert two.slip == pytest.approx(-one.slip, abs=1e-9)
    assert [e.kind for e in two.events] == [e.kind for e in one.events]


def test_tolerance_does_not_matter():
    scene = draw([7, 35])
    runs = [simulate(scene, accuracy=size) for size in (1e-12, 1e-9)]
    assert runs[1].rotation == pytest.approx(runs[0].rotation, abs=1e-8)
    assert runs[1].slip == pytest.approx(runs[0].slip, abs=1e-8)


def test_slip_equals_displacement_of_bearing_end():
    """Without flight, slip is that of a bearing end along the surface under it."""
    scene = draw([7, 48])
    run = simulate(scene)
    assert not any(e.kind == "flight" for e in run.events)
    final, slip = run.final, run.slip[-1]
    pair = scene.pair
    ends = run.events[-1].after
    start = [on_top(pair, upright_places(pair), end)[0] for end in ends.joint.ends]
    found = [on_top(pair, final[:6], end)[0] for end in ends.joint.ends]
    assert np.mean(np.subtract(found, start)) == pytest.approx(slip[1], abs=1e-9)


def test_falling_ground_leaves_bodies_in_flight():
    frictions = {"ground": Friction(0.5, 0.4), "joint": Friction(0.4, 0.35)}
    pieces = harmonic(0.3, -14.0, 2.0, 1, free=1.0)
    run = simulate_pair(ROUGH, frictions, pieces, 0.01, quickest=0.5)
    assert any(e.kind == "flight" for e in run.events)
    assert run.imbalance < 1e-9
    assert all(one.ends == ENDS for one in run.events[-1].after)


def test_upper_base_leaving_the_top_raises():
    frictions = {"ground": Friction(), "joint": Friction(0.1, 0.1)}
    pair = replace(FLAT, offset=0.9)
    with pytest.raises(OffTheTopError, match="leaves the top") as fault:
        simulate_pair(pair, frictions, constant_acceleration(-5.0, 0.3, 2.0), 0.01)
    along = on_top(pair, fault.value.run.final[:6], "right")[0]
    assert along == pytest.approx(FLAT.lower.half_width, abs=1e-6)
    with pytest.raises(ValueError, match="within the top"):
        simulate_pair(
            replace(FLAT, offset=1.1), frictions, constant_acceleration(5.0, 0.3, 2.0), 0.01
        )


def test_endless_events_end_run_as_chatter():
    """Alternating slip on both bases rocks the bodies with decaying amplitude."""
    pair = Pair(
        Body.uniform(0.86, 2.0, 6600.0), Body(4900.0, 1720.0, 0.333, 1.053, 1.109, 0.0134), -0.003
    )
    frictions = {"ground": Friction(0.27, 0.27), "joint": Friction(0.2325, 0.2325)}
    pieces = harmonic(-7.55, 5.764076163622018, 1.56, 0.5, 0.5 * math.pi, 1.0)
    run = simulate_pair(pair, frictions, pieces, 0.01, quickest=1.0 / 1.56)
    assert run.events[-1].kind == "chatter"
    assert run.unique_until == run.events[-1].time
    assert run.end < pieces[-1].stop
    assert run.imbalance < 1e-9
