"""Two rigid blocks that slide and rock, against the reference model."""

import pytest
from reference_models.rigid_pair.compare import AGREES
from reference_models.rigid_pair.random_scenes import records_available
from reference_models.rigid_pair_sliding.compare import compare_scene
from reference_models.rigid_pair_sliding.random_scenes import draw, draw_compliant

pytestmark = [pytest.mark.wide, pytest.mark.reference_models]

# on pads and on beds, below and above the rigid base; in 199 a slipping corner separates into
# flight, in 283 one separates as the held point below changes
ON_SPRINGS = (2, 6, 8, 199, 283)


@pytest.mark.skipif(not records_available(), reason="recorded motions are not available")
@pytest.mark.filterwarnings("ignore::rockframe.errors.ModelWarning")
@pytest.mark.parametrize(
    "number",
    [pytest.param(number, marks=[pytest.mark.long] * (number in (0, 2))) for number in range(6)],
)
def test_random_scenes(number):
    comparison = compare_scene(draw([7, number]))
    assert max(comparison.rotation, comparison.slip) < AGREES
    assert comparison.same_verdict


@pytest.mark.filterwarnings("ignore::rockframe.errors.ModelWarning")
@pytest.mark.parametrize(
    "number",
    [
        pytest.param(number, marks=[pytest.mark.long] * (number in (6, 199)))
        for number in ON_SPRINGS
    ],
)
def test_random_scenes_with_one_compliant_base_match_rockframe(number):
    comparison = compare_scene(draw_compliant([8, number]))
    assert max(comparison.rotation, comparison.slip) < AGREES
    assert not comparison.missing
    assert comparison.same_verdict
