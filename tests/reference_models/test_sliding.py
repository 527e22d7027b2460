"""Blocks that slide and rock, against a program in maximal coordinates on SciPy's DOP853."""

import numpy as np
import pytest
from reference_models.sliding import (
    compare,
    draw,
    draw_on_base,
    draw_tied,
    draw_tied_on_base,
    draw_walled,
    draw_walled_on_base,
)

pytestmark = [pytest.mark.wide, pytest.mark.reference_models, pytest.mark.filterwarnings("ignore")]

# on corner and base, with flights, on slopes, let go tilted, and overturning; each takes a second
SCENES = (2, 4, 8, 11, 15, 21, 33)


# pads and beds under each rule of restraint, with landings, flights, a slope, and overturning
ON_BASES = (1, 2, 8, 10, 13, 18, 20)


# with ties that become taut and slack, yield and break
TIED = (0, 5, 7, 12, 14, 16, 18, 22, 30)
TIED_ON_BASES = (
    1, 2, 3,
    59,  # begins in flight
    103,  # leaves its pad half a microsecond after it has begun to slip
)  # fmt: skip


def few(numbers, *kept):
    """Leave all others, which take longer, to the long run."""
    return [pytest.param(one, marks=[pytest.mark.long] * (one not in kept)) for one in numbers]


@pytest.mark.parametrize("number", few(TIED, 16, 22, 30))
def test_random_scenes_with_ties(number):
    check(compare(draw_tied(np.random.default_rng([40, number]))))


@pytest.mark.parametrize("number", few(TIED_ON_BASES, 1, 3))
def test_random_scenes_with_ties_on_pads_and_beds(number):
    check(compare(draw_tied_on_base(np.random.default_rng([41, number]))))


@pytest.mark.parametrize("number", [2, 5])
def test_random_scenes_before_elastic_walls(number):
    check(compare(draw_walled(np.random.default_rng([50, number]))))


@pytest.mark.parametrize("number", few((1, 9), 1))
def test_random_scenes_before_elastic_walls_on_pads_and_beds(number):
    check(compare(draw_walled_on_base(np.random.default_rng([51, number]))))


@pytest.mark.parametrize("number", SCENES)
def test_random_scenes(number):
    check(compare(draw(np.random.default_rng([30, number]))))


@pytest.mark.parametrize("number", few(ON_BASES, 2, 10, 18, 20))
def test_random_scenes_on_pads_and_beds(number):
    check(compare(draw_on_base(np.random.default_rng([31, number]))))


def check(found):
    assert [kind for _, kind in found["ours"]] == [kind for _, kind in found["theirs"]]
    assert found["peak"] <= 1e-6
    assert found["slip"] <= 1e-6 * max(found["slips"], 1e-3)
    assert found["balance"] <= 1e-8
    times = np.array([[t for t, _ in found[one]] for one in ("ours", "theirs")])
    np.testing.assert_allclose(times[0], times[1], rtol=0.0, atol=1e-6)
