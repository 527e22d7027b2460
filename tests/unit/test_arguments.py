"""Arguments without a unit."""

import numpy as np
import pytest
import xarray as xr

import rockframe as rf
from rockframe.arguments import checked_integer
from rockframe.errors import ComponentError, RockframeError


@pytest.mark.parametrize("given", [3, np.int64(3), np.uint8(3), np.array(3)])
def test_python_and_numpy_integers_are_accepted(given):
    found = checked_integer(given, owner="Frame", name="storeys", lowest=3, highest=3)
    assert found == 3
    assert type(found) is int


@pytest.mark.parametrize(
    "given", [True, np.True_, 3.0, np.float64(3.0), "3", None, [3], np.array([3]), 2, 6, -3]
)
def test_non_integers_and_out_of_range_values_are_refused(given):
    with pytest.raises(ComponentError, match=r"Frame: storeys must be a whole number from 3 to 5"):
        checked_integer(given, owner="Frame", name="storeys", lowest=3, highest=5)


def test_without_an_upper_bound():
    assert checked_integer(10**30, owner="Frame", name="storeys", lowest=0) == 10**30
    with pytest.raises(ComponentError, match="storeys must be a whole number, 0 or more, got -1"):
        checked_integer(-1, owner="Frame", name="storeys", lowest=0)


@pytest.mark.parametrize("given", [np.array(0.5), xr.DataArray(0.5)])
def test_zero_dimensional_arrays_are_refused_as_lists(given):
    """A zero-dimensional array claims to be iterable, but has no elements."""
    system = rf.System(rf.Block(width="1 m", height="5 m", mass="1 t"))
    motion = rf.GroundMotion.sine_pulse("1 m/s^2", "1 Hz")
    for function in (
        lambda: rf.response_spectrum(motion, given),
        lambda: motion.through_storeys(given),
        lambda: rf.Block.from_outline(given, mass="1 t"),
        lambda: rf.Block.from_outline([given, given, given], mass="1 t"),
        lambda: rf.FrameEquivalent.from_members(given, width="1 m", height="3 m"),
        lambda: rf.MotionSuite(given),
        lambda: rf.read_suite(given),
        lambda: rf.sweep(system, given),
        lambda: rf.sweep(system, motion, width=given),
        lambda: rf.earthquake_sequences(system, given),
        lambda: rf.concat(given, "motion"),
        lambda: rf.table(given),
        lambda: system.simulate(motion, outputs=given),
        lambda: rf.report(system.simulate(motion, accuracy="fast"), "report.html", checks=given),
    ):
        with pytest.raises(RockframeError):
            function()
