"""Arguments without a unit."""

import numpy as np
import pytest
import xarray as xr

import rockframe as rf
from rockframe.arguments import checked_integer
from rockframe.errors import ComponentError, RockframeError


@pytest.mark.parametrize("value", [3, np.int64(3), np.uint8(3), np.array(3)])
def test_python_and_numpy_integers_are_accepted(value):
    found = checked_integer(value, owner="Frame", name="storeys", lowest=3, highest=3)
    assert found == 3
    assert type(found) is int


@pytest.mark.parametrize(
    "value", [True, np.True_, 3.0, np.float64(3.0), "3", None, [3], np.array([3]), 2, 6, -3]
)
def test_non_integers_and_out_of_range_values_are_refused(value):
    with pytest.raises(ComponentError, match=r"Frame: storeys must be a whole number from 3 to 5"):
        checked_integer(value, owner="Frame", name="storeys", lowest=3, highest=5)


def test_without_an_upper_bound():
    assert checked_integer(10**30, owner="Frame", name="storeys", lowest=0) == 10**30
    with pytest.raises(ComponentError, match="storeys must be a whole number, 0 or more, got -1"):
        checked_integer(-1, owner="Frame", name="storeys", lowest=0)


@pytest.mark.parametrize("value", [np.array(0.5), xr.DataArray(0.5)])
def test_zero_dimensional_arrays_are_refused_as_lists(value):
    """A zero-dimensional array claims to be iterable, but has no elements."""
    system = rf.System(rf.Block(width="1 m", height="5 m", mass="1 t"))
    motion = rf.GroundMotion.sine_pulse("1 m/s^2", "1 Hz")
    for function in (
        lambda: rf.response_spectrum(motion, value),
        lambda: motion.through_storeys(value),
        lambda: rf.Block.from_outline(value, mass="1 t"),
        lambda: rf.Block.from_outline([value, value, value], mass="1 t"),
        lambda: rf.FrameEquivalent.from_members(value, width="1 m", height="3 m"),
        lambda: rf.MotionSuite(value),
        lambda: rf.read_suite(value),
        lambda: rf.sweep(system, value),
        lambda: rf.sweep(system, motion, width=value),
        lambda: rf.earthquake_sequences(system, value),
        lambda: rf.concat(value, "motion"),
        lambda: rf.table(value),
        lambda: system.simulate(motion, outputs=value),
        lambda: rf.report(system.simulate(motion, accuracy="fast"), "report.html", checks=value),
    ):
        with pytest.raises(RockframeError):
            function()
