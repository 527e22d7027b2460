"""Two rigid blocks that slide and rock, beside the independent program."""

import pytest
from reference_models.rigid_pair.compare import AGREES
from reference_models.rigid_pair.random_scenes import have_records
from reference_models.rigid_pair_sliding.compare import compared
from reference_models.rigid_pair_sliding.random_scenes import draw, draw_giving

pytestmark = [pytest.mark.wide, pytest.mark.reference_models]

# on pads and on beds, below and above the rigid base; in 199 a corner that slips parts into a
# flight, in 283 one parts as the held point below changes
ON_SPRINGS = (2, 6, 8, 199, 283)


@pytest.mark.skipif(not have_records(), reason="no recorded motions")
@pytest.mark.filterwarnings("ignore::rockframe.errors.ModelWarning")
@pytest.mark.parametrize(
    "number",
    [pytest.param(number, marks=[pytest.mark.long] * (number in (0, 2))) for number in range(6)],
)
def test_random_scenes(number):
    one = compared(draw([7, number]))
    assert max(one.rotation, one.slip) < AGREES
    assert one.same_verdict


@pytest.mark.filterwarnings("ignore::rockframe.errors.ModelWarning")
@pytest.mark.parametrize(
    "number",
    [pytest.param(one, marks=[pytest.mark.long] * (one in (6, 199))) for one in ON_SPRINGS],
)
def test_random_scenes_with_one_compliant_base_match_rockframe(number):
    one = compared(draw_giving([8, number]))
    assert max(one.rotation, one.slip) < AGREES
    assert not one.missing
    assert one.same_verdict
