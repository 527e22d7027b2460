"""Blocks before walls against a program of their own; hundreds in benchmarks/walls.py."""

import numpy as np
import pytest
from reference_models.walls import compare


@pytest.mark.parametrize("seed", range(8))
def test_random_walls_match_independent_program(seed):
    apart, ours, theirs = compare(seed)
    assert apart < 1e-7
    assert bool(ours.overturned) == theirs.overturned
    assert abs(int(ours.impact_count) - len(theirs.impacts)) <= 1  # the last of a dying series
    found = ours.event_time[ours.event_kind.isin([2, 6])].to_numpy()  # those that end in rest, too
    shared = min(len(found), len(theirs.impacts))
    np.testing.assert_allclose(found[:shared], theirs.impacts[:shared], rtol=0.0, atol=1e-8)
