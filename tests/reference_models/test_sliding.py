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

# on corner and base, with flights, on slopes, released tilted, and overturning; a second each
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


def mark_others_long(numbers, *kept):
    """Return the numbers, marked long but for those kept."""
    return [
        pytest.param(number, marks=[pytest.mark.long] * (number not in kept)) for number in numbers
    ]


@pytest.mark.parametrize("number", mark_others_long(TIED, 16, 22, 30))
def test_random_scenes_with_ties(number):
    assert_agreement(compare(draw_tied(np.random.default_rng([40, number]))))


@pytest.mark.parametrize("number", mark_others_long(TIED_ON_BASES, 1, 3))
def test_random_scenes_with_ties_on_pads_and_beds(number):
    assert_agreement(compare(draw_tied_on_base(np.random.default_rng([41, number]))))


@pytest.mark.parametrize("number", [2, 5])
def test_random_scenes_before_elastic_walls(number):
    assert_agreement(compare(draw_walled(np.random.default_rng([50, number]))))


@pytest.mark.parametrize("number", mark_others_long((1, 9), 1))
def test_random_scenes_before_elastic_walls_on_pads_and_beds(number):
    assert_agreement(compare(draw_walled_on_base(np.random.default_rng([51, number]))))


@pytest.mark.parametrize("number", SCENES)
def test_random_scenes(number):
    assert_agreement(compare(draw(np.random.default_rng([30, number]))))


@pytest.mark.parametrize("number", mark_others_long(ON_BASES, 2, 10, 18, 20))
def test_random_scenes_on_pads_and_beds(number):
    assert_agreement(compare(draw_on_base(np.random.default_rng([31, number]))))


def assert_agreement(comparison):
    assert [kind for _, kind in comparison["ours"]] == [kind for _, kind in comparison["theirs"]]
    assert comparison["peak"] <= 1e-6
    assert comparison["slip"] <= 1e-6 * max(comparison["slips"], 1e-3)
    assert comparison["balance"] <= 1e-8
    times = np.array([[t for t, _ in comparison[program]] for program in ("ours", "theirs")])
    np.testing.assert_allclose(times[0], times[1], rtol=0.0, atol=1e-6)
