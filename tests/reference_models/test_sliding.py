"""Blocks that slide and rock, against a program in maximal coordinates on SciPy's DOP853."""

import numpy as np
import pytest
from reference_models.sliding import compare, draw

pytestmark = [pytest.mark.reference_models, pytest.mark.filterwarnings("ignore")]

# on corner and base, with flights, on slopes, let go tilted, and overturning; each takes a second
SCENES = (2, 4, 8, 11, 15, 21, 33)


@pytest.mark.parametrize("number", SCENES)
def test_random_scenes(number):
    found = compare(draw(np.random.default_rng([30, number])))
    assert [kind for _, kind in found["ours"]] == [kind for _, kind in found["theirs"]]
    assert found["peak"] <= 1e-6
    assert found["slip"] <= 1e-6 * max(found["slips"], 1e-3)
    assert found["balance"] <= 1e-8
    times = np.array([[t for t, _ in found[one]] for one in ("ours", "theirs")])
    np.testing.assert_allclose(times[0], times[1], rtol=0.0, atol=1e-6)
