"""Rules of contact over random scenes.

Ranges: see `property.scenarios`.
"""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import example, given, settings
from property.checks import FLIGHT, LEFT, RIGHT, check_flight
from property.scenarios import CASE, GRAVITY, RULES, Scenario, scenarios

import rockframe as rf
from rockframe.errors import SolverWarning

pytestmark = pytest.mark.property


@given(scenarios(bases=RULES))
@example(
    Scenario(
        base="centre", radius=2.116, slenderness=1.305, beta=14.439, xi=0.481,
        rotation="finite", peak=0.965, frequency=2.268, cycles=2.5, vertical=-0.294, start=0.258,
    )
)  # fmt: skip
@example(
    Scenario(
        base="contact-state", radius=14.517, slenderness=1.52, beta=46.334, xi=0.457,
        rotation="small", peak=1.329, frequency=2.93, cycles=2.5, vertical=0.246, rate=-0.444,
    )
)  # fmt: skip
@settings(max_examples=100, deadline=None)
def test_pads_never_pull(scenario):
    response = scenario.run(output_step="2 ms", overturning="continue")
    slack = 1e-9 * scenario.mass * GRAVITY
    for name, free in (("left_reaction", (RIGHT, FLIGHT)), ("right_reaction", (LEFT, FLIGHT))):
        reaction = response[name].values
        assert reaction.min() >= -slack, f"{name} {reaction.min() / slack * 1e-9:.3g} of the weight"
        loose = np.isin(response.contact_state.values, free)
        assert (reaction[loose] == 0.0).all()


@given(scenarios())
@settings(max_examples=60, deadline=None)
def test_runs_end_completed_or_overturned(scenario):
    response = scenario.run(free_vibration="4 s")
    assert response.status.item() in (0, 1)
    theta = response.overturning_angle.item()
    peak = response.peak_rotation.item()
    assert response.overturned.item() == (response.status.item() == 1)
    assert response.overturned.item() == (peak >= theta * (1.0 - 1e-12))
    assert (np.diff(response.time.values) > 0.0).all()
    assert (np.diff(response.event_time.values) >= 0.0).all()
    for name, variable in response.variables.items():
        if variable.dims:
            assert np.isfinite(variable.values).all(), name


def test_landing_whose_hold_lifts_corner_again_does_not_chatter():
    """Far beyond overturning the hold would throw the corner up in an endless series.

    It acts only while the corner presses, so that the block falls flat.
    """
    scenario = Scenario(
        base="leading-corner",
        radius=0.554,
        slenderness=4.016,
        beta=41.82,
        xi=0.0,
        rotation="finite",
        peak=0.512,
        frequency=4.0,
        cycles=1.0,
        vertical=0.0,
        start=-0.437,
        rate=-0.437,
    )
    stopped = scenario.run()
    assert stopped.status.item() == 1
    response = scenario.run(overturning="continue")
    meanings = response.status.attrs["flag_meanings"].split()
    assert meanings[response.status.item()] == "toppled"
    assert response.overturning_time.item() == stopped.overturning_time.item()
    assert response.sizes["event"] < 100
    assert np.isfinite(response.rotation.values).all()


def test_unfinished_run_warns_and_returns_partial_result():
    scenario = replace(CASE, peak=0.4, vertical=0.0)
    with pytest.warns(SolverWarning, match="Not finished"):
        response = scenario.run(accuracy=rf.Accuracy(rtol=1e-8, max_steps=500))
    meanings = response.status.attrs["flag_meanings"].split()
    assert meanings[response.status.item()] == "step_limit"
    assert response.attrs["verdict"].startswith("Not finished")
    assert response.attrs["solver_end_time"] < 3.0
    assert np.isfinite(response.rotation.values).all()


@given(scenarios(bases=RULES))
@settings(max_examples=60, deadline=None)
def test_flight_time_is_time_between_flight_events(scenario):
    check_flight(scenario.run(outputs=None), within=1e-12)


@given(scenarios(bases=RULES))
@settings(max_examples=60, deadline=None)
def test_finer_tolerances_do_not_change_a_short_run(scenario):
    """Up to the second event after the motion's start; later, rocking may be chaotic."""
    one = scenario.run(output_step="2 ms", duration="1 s", free_vibration=None)
    other = scenario.run(
        output_step="2 ms", duration="1 s", free_vibration=None, accuracy="reference"
    )
    events = other.event_time.values
    horizon = events[2] if events.size > 2 else other.time.values[-1]
    count = int(np.searchsorted(other.time.values, horizon)) - 1
    count = min(count, one.sizes["time"], other.sizes["time"])
    theta = other.overturning_angle.item()
    difference = np.abs(one.rotation.values[:count] - other.rotation.values[:count])
    assert difference.max(initial=0.0) <= 1e-5 * theta
