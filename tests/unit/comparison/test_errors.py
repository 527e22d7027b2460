"""Errors of a run relative to another, for runs written by hand."""

import math

import numpy as np
import pytest
import xarray as xr

from rockframe.comparison.tradeoff import (
    event_time_error,
    history_error,
    relative_peak_error,
    verdicts_agree,
)
from rockframe.solve.workspace import Status


def run_of(rotation=(), time=(), kinds=(), instants=(), status=Status.COMPLETED, overturned=False):
    return xr.Dataset(
        {
            "rotation": ("time", np.array(rotation, dtype=float)),
            "peak_rotation": float(np.max(np.abs(rotation), initial=0.0)),
            "overturned": overturned,
            "status": int(status),
            "event_kind": ("event", np.array(kinds, dtype=np.int8)),
            "event_time": ("event", np.array(instants, dtype=float)),
        },
        {"time": np.array(time, dtype=float)},
    )


TIME = [0.0, 0.1, 0.2, 0.3]
REFERENCE = run_of([0.0, 1.0, -4.0, 2.0], TIME)


@pytest.mark.parametrize("peak", [3.0, 5.0])
def test_peak_error_is_relative_to_the_reference(peak):
    assert relative_peak_error(run_of([0.0, peak], TIME[:2]), REFERENCE) == 0.25


def test_history_error_is_relative_to_the_reference_peak():
    """The largest rotation of the reference is to the left; that of the run does not matter."""
    assert history_error(run_of([0.0, 1.0, -6.0, 2.0], TIME), REFERENCE) == 0.5
    assert history_error(run_of([0.0, 1.0, -2.0, 2.0], TIME), REFERENCE) == 0.5


def test_final_sample_of_an_ended_run_is_not_compared():
    ended = run_of([0.0, 1.0, -3.0, 9.0], [0.0, 0.1, 0.2, 0.27])
    assert history_error(ended, REFERENCE) == 0.25
    # but it is the peak of the reference, by which errors of all runs are divided
    assert history_error(REFERENCE, ended) == pytest.approx(1.0 / 9.0)


def test_run_that_overturns_early_is_compared_with_the_peak_of_the_whole_reference():
    fell = run_of([0.0, 3.0, 9.0], [0.0, 0.1, 0.17], status=Status.OVERTURNED)
    assert history_error(fell, REFERENCE) == 0.5


def test_opposite_rotations_have_a_history_error_above_one():
    assert history_error(run_of([0.0, -1.0, 2.0, -2.0], TIME), REFERENCE) == 1.5


def test_errors_against_a_reference_at_rest_are_zero_or_infinite():
    still, moving = run_of([0.0] * 4, TIME), run_of([0.0, 0.0, 1e-9, 0.0], TIME)
    for error in (relative_peak_error, history_error):
        assert error(still, still) == 0.0
        assert error(moving, still) == math.inf


def test_event_time_error_is_the_largest_time_difference():
    reference = run_of(kinds=[1, 2, 3], instants=[1.0, 2.0, 3.0])
    early = run_of(kinds=[1, 2, 3], instants=[1.0, 1.5, 3.25])
    assert event_time_error(early, reference) == 0.5
    assert event_time_error(run_of(), run_of()) == 0.0


@pytest.mark.parametrize("kinds", [[1, 2], [1, 3, 3], [1, 2, 3, 4]])
def test_different_events_have_no_time_error(kinds):
    reference = run_of(kinds=[1, 2, 3], instants=[1.0, 2.0, 3.0])
    other = run_of(kinds=kinds, instants=range(1, len(kinds) + 1))
    assert math.isnan(event_time_error(other, reference))


@pytest.mark.parametrize("status", [Status.STEP_LIMIT, Status.STEP_TOO_SMALL, Status.CHATTER])
def test_unfinished_run_has_no_errors(status):
    cut = run_of([0.0, 1.0, -4.0], TIME[:3], status=status)
    for error in (relative_peak_error, history_error, event_time_error):
        assert math.isnan(error(cut, REFERENCE))
        assert math.isnan(error(REFERENCE, cut))
    assert not verdicts_agree(cut, REFERENCE)
    assert not verdicts_agree(cut, cut)
    # it exceeded the angle and went on: complete overturning is unknown
    overturned_run = run_of([0.0, 1.0, -4.0], TIME[:3], status=status, overturned=True)
    assert not verdicts_agree(overturned_run, run_of(status=Status.TOPPLED, overturned=True))
    assert not verdicts_agree(overturned_run, REFERENCE)


def test_verdicts_agree_by_the_overturning_criterion_of_the_run():
    completed = run_of(status=Status.COMPLETED, overturned=True)
    assert verdicts_agree(completed, REFERENCE)
    assert not verdicts_agree(completed, run_of(status=Status.TOPPLED, overturned=True))
    assert verdicts_agree(run_of(status=Status.OVERTURNED), run_of(status=Status.TOPPLED))
