"""Two rigid blocks that slide and rock, beside the independent program."""

import pytest
from reference_models.rigid_pair.compare import AGREES
from reference_models.rigid_pair.drawing import have_records
from reference_models.rigid_pair_sliding.compare import compared
from reference_models.rigid_pair_sliding.drawing import draw

pytestmark = pytest.mark.reference_models


@pytest.mark.skipif(not have_records(), reason="no recorded motions")
@pytest.mark.filterwarnings("ignore::rockframe.errors.ModelWarning")
@pytest.mark.parametrize("number", range(6))
def test_random_scenes(number):
    one = compared(draw([7, number]))
    assert max(one.rotation, one.slip) < AGREES
    assert one.same_verdict
