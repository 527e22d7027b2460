"""Blocks before walls against an independent program; benchmarks/walls.py runs hundreds."""

import numpy as np
import pytest
from reference_models.walls import compare


@pytest.mark.parametrize("seed", range(8))
def test_random_walls_match_independent_program(seed):
    difference, ours, theirs = compare(seed)
    assert difference < 1e-7
    assert bool(ours.overturned) == theirs.overturned
    assert abs(int(ours.impact_count) - len(theirs.impacts)) <= 1  # the last of a decaying series
    impact_times = ours.event_time[
        ours.event_kind.isin([2, 6])
    ].to_numpy()  # impacts, also those that end in rest
    shared = min(len(impact_times), len(theirs.impacts))
    np.testing.assert_allclose(impact_times[:shared], theirs.impacts[:shared], rtol=0.0, atol=1e-8)
