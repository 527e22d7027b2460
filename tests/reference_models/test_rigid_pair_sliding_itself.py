"""The reference model of two rigid blocks that slide and rock, by itself."""

import math
from dataclasses import replace

import numpy as np
import pytest
from reference_models.monoliths.slide_rock import Block
from reference_models.rigid_pair import drawing as plain_drawing
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
    middle_slips,
    on_top,
    standing,
    tidied,
)
from reference_models.rigid_pair_sliding.drawing import draw
from reference_models.rigid_pair_sliding.simulate import OffTheTop, simulate, simulate_pair

pytestmark = pytest.mark.reference_models

HELD = {"ground": Friction(), "joint": Friction()}
ROUGH = Pair(Body(1000.0, 120.0, 0.35, 0.5, 0.55, 0.02), Body(800.0, 90.0, 0.2, 0.6, 0.5), 0.02)
FLAT = Pair(Body.uniform(3.0, 0.4, 2000.0), Body.uniform(1.0, 0.2, 1000.0))


def jolt(acceleration, length, free, up=0.0):
    """Ground that accelerates constantly for a while."""
    return [
        Piece(0.0, length, lambda t: acceleration, lambda t: up, linear=True),
        still(length, length + free),
    ]


# places ----------------------------------------------------------------------------------------


def test_rows_and_turns_are_derivatives_of_the_places():
    rng = np.random.default_rng(1)
    for _ in range(5):
        place = standing(ROUGH) + rng.uniform(-0.4, 0.4, 6)
        speed, bend = rng.uniform(-2.0, 2.0, 6), rng.uniform(-5.0, 5.0, 6)
        size = 1e-4
        ahead, back = (place + w * size * speed + 0.5 * size**2 * bend for w in (1.0, -1.0))
        for end in ENDS:
            one = contact(ROUGH, place, speed, "joint", end)
            at, far, near = (np.array(on_top(ROUGH, p, end)) for p in (place, ahead, back))
            rates = (far - near) / (2.0 * size)
            assert [np.dot(one.along, speed), np.dot(one.normal, speed)] == pytest.approx(
                rates, abs=1e-6
            )
            found = np.array([np.dot(one.along, bend), np.dot(one.normal, bend)]) + one.turns
            assert found == pytest.approx((far - 2.0 * at + near) / size**2, abs=1e-4)
            one = contact(ROUGH, place, speed, "ground", end)
            low = [height(ROUGH, p, end) for p in (place, ahead, back)]
            assert np.dot(one.normal, speed) == pytest.approx((low[1] - low[2]) / (2 * size), abs=1e-6)
            found = np.dot(one.normal, bend) + one.turns[1]
            assert found == pytest.approx((low[1] - 2 * low[0] + low[2]) / size**2, abs=1e-4)


def test_tidied_places_touch_where_they_bear():
    rng = np.random.default_rng(2)
    for ground, joint in [(ENDS, ENDS), (("left",), ENDS), (ENDS, ("right",)), (("right",), ("left",))]:
        place = standing(ROUGH) + rng.uniform(-1e-3, 1e-3, 6)
        pattern = Pattern(Bearing(ground), Bearing(joint))
        found = tidied(ROUGH, pattern, place)
        for end in ground:
            assert height(ROUGH, found, end) == pytest.approx(0.0, abs=1e-15)
        for end in joint:
            assert on_top(ROUGH, found, end)[1] == pytest.approx(0.0, abs=1e-15)
        assert found == pytest.approx(place, abs=5e-3)
        assert found[0] == place[0]
        assert tidied(ROUGH, pattern, found) == pytest.approx(found, abs=1e-15)


# limits ----------------------------------------------------------------------------------------


@pytest.mark.parametrize("number", [0, 3, 13, 14, 16, 25])
def test_friction_without_end_is_the_pair_that_is_held(number):
    """Numbers of scenes with pulses in which the upper body is the narrower one."""
    scene = plain_drawing.draw(np.random.default_rng([11, number]))
    pieces, period = plain_drawing.pieces_for(scene.motion)
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


def lone_block(rng):
    """Draw a block, its friction, and noise that makes it slide and rock; and its reference."""
    width = float(rng.uniform(0.4, 1.0))
    rise = width * float(rng.uniform(0.7, 1.5))
    body = Body.uniform(width, 2.0 * rise, 1000.0)
    slender = 0.5 * width / rise
    static = slender * float(rng.uniform(0.7, 1.4))
    kinetic = static * float(rng.choice([1.0, rng.uniform(0.7, 1.0)]))
    across = rng.normal(size=26) * 1.2 * min(slender, static) * GRAVITY
    across[0] = across[-1] = 0.0
    times = np.append(0.1 * np.arange(26), [2.5 + 1e-9, 10.0])
    along = np.append(across, [0.0, 0.0])
    limits = (math.atan(slender), math.atan(slender))
    block = Block(
        0.5 * width, 0.5 * width, rise, body.inertia / body.mass, static, kinetic, GRAVITY,
        times, along, np.zeros_like(times), limits,
    )  # fmt: skip
    return body, Friction(static, kinetic), across, block


def test_a_heavy_lower_body_leaves_the_upper_one_a_block_alone():
    both = 0
    heavy = Body.uniform(30.0, 1.0, 1e12)
    for number in range(12):
        body, friction, across, block = lone_block(np.random.default_rng([3, number]))
        pieces = [*pieces_of(0.1, across), still(2.5, 3.5)]
        run = simulate_pair(Pair(heavy, body), {"ground": Friction(), "joint": friction}, pieces, 0.05)
        if any(e.kind == "impact" and e.before[1].slip * e.after[1].slip < 0 for e in run.events):
            continue  # Routh's law, of the other program, has a second phase of slip there
        assert all(e.admissible == 1 and e.kind != "flight" for e in run.events)
        assert {e.after.ground for e in run.events} <= {Bearing(ENDS)}
        other = block.simulate(0.0, 3.5)
        assert run.overturned == other["fell"]
        assert run.peaks[1] == pytest.approx(other["peak"], rel=1e-7, abs=1e-12)
        assert run.peak_slips[1] == pytest.approx(other["peak_slip"], rel=1e-7, abs=1e-12)
        if not run.overturned:
            x = run.final[3] - run.final[0] - body.beside
            assert x == pytest.approx(other["state"][0], abs=1e-8)
        both += run.peaks[1] > 1e-3 and run.peak_slips[1] > 1e-3
    assert both >= 4
