"""Peaks and durations from both ends and the inside of steps."""

import math

import numpy as np
import pytest

import rockframe as rf
from rockframe.results.along_steps import FRACTIONS, AlongSteps
from rockframe.results.forces import sliding_checks
from rockframe.solve.trajectory import Steps


def along(ends, starts, inside=None, length=0.5, events=None):
    """Make steps of equal length; `starts` maps steps after an event to their first values."""
    rows, values = [], []
    for step, end in enumerate(ends):
        if step in starts:
            rows.append([length * step, 0.0])
            values.append(starts[step])
        rows.append([length * (step + 1), length])
        values.append(end)
    codes = np.zeros((len(rows), 2), dtype=np.int64)
    steps = Steps(np.array(rows), codes, width=0, exact=True)
    values = {"demand": np.array(values)}

    def straight(which):
        start, end = values["demand"][which - 1, None], values["demand"][which, None]
        return {"demand": (start * (1.0 - FRACTIONS) + end * FRACTIONS).ravel()}

    return AlongSteps(steps, values, straight if inside is None else inside)


def demand(values):
    return values["demand"][None]


def test_peak_just_after_an_event_is_found():
    """The friction demand jumps at an event; samples before and long after it miss the peak."""
    found = along([1.0, 1.0, 1.0, 1.0], {0: 0.5, 2: 7.0})
    (peak,), (time,) = found.largest(demand)
    assert (peak, time) == (7.0, 1.0)
    first, duration = found.above(lambda values: values["demand"], 4.0)
    assert first == 1.0
    assert duration == pytest.approx(0.5 * (7.0 - 4.0) / (7.0 - 1.0))


def test_peak_just_before_an_event_is_found():
    found = along([1.0, 7.0, 1.0], {0: 0.5, 2: 1.0})
    (peak,), (time,) = found.largest(demand)
    assert (peak, time) == (7.0, 1.0)


@pytest.mark.parametrize("middle", [0.51, 0.54, 0.77, 0.96, 0.99])
def test_peak_inside_a_step_is_found_by_a_parabola(middle):
    def inside(which):
        place = 0.5 * (which[:, None] - 1 + FRACTIONS)
        return {"demand": (3.0 - (place - middle) ** 2).ravel()}

    ends = [3.0 - (t - middle) ** 2 for t in (0.5, 1.0, 1.5)]
    (peak,), (time,) = along(ends, {0: 3.0 - middle**2}, inside).largest(demand)
    assert peak == pytest.approx(3.0, rel=1e-14)
    assert time == pytest.approx(middle, rel=1e-12)


@pytest.mark.parametrize("friction", [0.298, 0.302])
def test_sliding_begins_at_a_peak_within_a_step(friction):
    def named(values):
        return dict.fromkeys(("friction_demand", "horizontal_reaction"), 0.1 * values)

    def inside(which):
        place = 0.5 * (which[:, None] - 1 + FRACTIONS)
        return named((3.0 - (place - 0.77) ** 2).ravel())

    found = along([3.0 - (t - 0.77) ** 2 for t in (0.5, 1.0, 1.5)], {0: 3.0 - 0.77**2})
    found = AlongSteps(found.steps, named(found.shown["demand"]), inside)
    block = rf.Block(width="0.5 m", height="2 m", mass="400 kg")
    system = rf.System(block, rf.RigidGround(friction=friction), sliding="checked")
    (check,) = sliding_checks(system.assembly, found)
    assert check.needed == pytest.approx(0.3, rel=1e-14)
    assert check.slides == (friction < 0.3)
    assert check.first == pytest.approx(0.77 if check.slides else math.nan, nan_ok=True)


def test_infinite_demand_is_interpolated_by_its_reciprocal():
    found = along([2.0, 0.0], {0: math.inf})
    (peak,), (time,) = found.largest(demand)
    assert (peak, time) == (math.inf, 0.0)
    first, duration = found.above(lambda values: values["demand"], 4.0)
    assert (first, duration) == (0.0, 0.25)  # 1/q from 0 to 1/2 passes 1/4 in the middle


def test_demand_never_above_limit_has_no_time():
    first, duration = along([1.0, 2.0], {0: 0.0}).above(lambda values: values["demand"], 2.0)
    assert math.isnan(first)
    assert duration == 0.0


@pytest.mark.parametrize("seed", range(6))
def test_time_above_a_level_in_magnitude_is_that_of_straight_lines(seed):
    ends = np.random.default_rng(seed).uniform(-3.0, 3.0, 13)
    first, duration = along(ends[1:], {0: ends[0]}).above(lambda values: values["demand"], 1.2)
    time, step = np.linspace(0.0, 6.0, 60_001, retstep=True)
    above = np.abs(np.interp(time, 0.5 * np.arange(13), ends)) > 1.2
    assert first == pytest.approx(time[above][0], abs=1.01 * step)
    assert duration == pytest.approx(step * above.sum(), abs=26 * step)


def test_first_of_equal_peaks_is_reported():
    found = along([1.0, 1.0, *[math.inf, 1.0] * 400], {0: 1.0})
    (peak,), (time,) = found.largest(demand)
    assert peak == math.inf
    assert 0.5 < time <= 1.5


def test_peak_at_step_end_is_found_among_many_candidate_steps():
    """Kinks of the ground motion have high bounds; the peak is at the end of a smooth rise."""
    kinks, rise = [1.0, 6.0] * 100, list(np.linspace(1.0, 7.0, 50))
    (peak,), (time,) = along(kinks + rise, {0: 1.0}).largest(demand)
    assert (peak, time) == (7.0, 125.0)


def test_peak_just_after_an_event_is_found_among_many_candidate_steps():
    kinks, fall = [1.0, 6.0] * 100, list(np.linspace(7.0, 1.0, 50))
    (peak,), (time,) = along(kinks + fall[1:], {0: 1.0, 200: 7.0}).largest(demand)
    assert (peak, time) == (7.0, 100.0)


@pytest.mark.parametrize("jump", [1, 4])
def test_no_parabola_is_fitted_through_a_kink(jump):
    """A base in renewed contact that slips needs its friction at once, and no more."""

    def inside(which):
        return {"demand": np.tile(np.where(np.arange(1, 8) < jump, 0.0, 0.4), len(which))}

    (peak,), _ = along([0.4, 0.4], {0: 0.0}, inside).largest(demand)
    assert peak == 0.4
