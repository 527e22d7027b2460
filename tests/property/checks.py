"""Checks that every scene must pass on any base."""

import numpy as np
import pytest
from property.scenarios import GRAVITY

from rockframe.dynamics.protocol import IMPACT_LOSS, REPINNING_LOSS, Start
from rockframe.results.variables.requests import FORCE_SCALARS
from rockframe.solve.accuracy import accuracy_of
from rockframe.solve.integrate import integrate

FULL, LEFT, RIGHT, FLIGHT = range(4)

OF_HISTORIES = [row.name for row in FORCE_SCALARS]


def check_flight(response, *, within):
    """Check time and number of flights against the events."""
    time = np.concatenate([[0.0], response.event_time.values])
    end = np.append(time[1:], response.attrs["solver_end_time"])
    after = response.contact_state_after.values
    before = response.contact_state_before.values
    first = before[:1] if before.size else np.array([FULL], dtype=np.int8)
    state = np.concatenate([first, after])
    flying = (end - time)[state == FLIGHT].sum()
    assert response.flight_time.item() == pytest.approx(flying, rel=1e-9, abs=within)
    into = (state[1:] == FLIGHT) & (state[:-1] != FLIGHT)
    assert response.flight_count.item() == into.sum() + (state[0] == FLIGHT)


def stored_energy(model, mode, state):
    """Return a model's stored energy, and the magnitude of its parts."""
    kinetic, gravity, elastic, from_rest = model.system.energies(int(mode), state)
    return kinetic + gravity + from_rest, max(abs(kinetic), abs(gravity), abs(elastic))


def check_energy_at_events(scenario, accuracy, *, stop_at_overturning):
    """Check that energy never rises at an event, and that the memory holds the loss."""
    model = scenario.system.setting.compile()
    start = scenario.initial.si
    run = integrate(
        model,
        Start(start.rotation, start.angular_velocity),
        scenario.motion.si,
        accuracy_of(accuracy),
        duration=scenario.motion.si.duration + 2.0,
        output_step=None,
        stop_at_overturning=stop_at_overturning,
    )
    lost = [run.start_memory, *run.events.memory]
    for i in range(len(run.events.time)):
        before, size = stored_energy(model, run.events.mode_before[i], run.events.state_before[i])
        after, _ = stored_energy(model, run.events.mode_after[i], run.events.state_after[i])
        # a rigid block's impact is located to 1e-15 of theta, and its energy accordingly
        slack = 1e-11 * size + 1e-14 * GRAVITY * scenario.radius
        assert after <= before + slack
        change = lost[i + 1] - lost[i]
        booked = change[IMPACT_LOSS] + change[REPINNING_LOSS]
        assert before - after == pytest.approx(booked, abs=slack)


def scalars(response):
    return response.drop_dims(["time", "event"], errors="ignore")


def assert_same_scalars(one, other):
    bare = "peak_base_shear" not in one or "peak_base_shear" not in other
    left_out = OF_HISTORIES if bare else ()
    one, other = (scalars(each).drop_vars(left_out, errors="ignore") for each in (one, other))
    assert set(one.data_vars) == set(other.data_vars)
    for name in one.data_vars:
        np.testing.assert_array_equal(one[name].values, other[name].values, err_msg=name)


def check_output_step(scenario, step):
    """Check that the output step changes nothing but the samples."""
    own = scenario.run()
    other = scenario.run(output_step=step)
    none = scenario.run(outputs=None)
    more = scenario.run(output_step=step, outputs="energy")
    for response in (other, none, more):
        assert_same_scalars(own, response)
        for name in own.data_vars:
            if own[name].dims == ("event",):
                np.testing.assert_array_equal(own[name].values, response[name].values)
    assert "time" not in none.dims
    for name in other.data_vars:
        np.testing.assert_array_equal(other[name].values, more[name].values)
