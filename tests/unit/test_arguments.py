"""Arguments without a unit."""

import numpy as np
import pytest

from rockframe.arguments import whole_number
from rockframe.errors import ComponentError


@pytest.mark.parametrize("given", [3, np.int64(3), np.uint8(3), np.array(3)])
def test_whole_numbers_of_python_and_numpy(given):
    found = whole_number(given, owner="Frame", name="storeys", lowest=3, highest=3)
    assert found == 3
    assert type(found) is int


@pytest.mark.parametrize(
    "given", [True, np.True_, 3.0, np.float64(3.0), "3", None, [3], np.array([3]), 2, 6, -3]
)
def test_what_is_none_or_out_of_range(given):
    with pytest.raises(ComponentError, match=r"Frame: storeys must be a whole number from 3 to 5"):
        whole_number(given, owner="Frame", name="storeys", lowest=3, highest=5)


def test_without_an_upper_bound():
    assert whole_number(10**30, owner="Frame", name="storeys", lowest=0) == 10**30
    with pytest.raises(ComponentError, match="storeys must be a whole number, 0 or more, got -1"):
        whole_number(-1, owner="Frame", name="storeys", lowest=0)
