"""The cascade against its definition, Eq. (20): two separate runs, and their sum."""

import math

import numpy as np
import pytest

import rockframe as rf

pytestmark = pytest.mark.analytical

RULES = ("contact-state", "leading-corner", "centre")
FULL, FLIGHT = 0, 3


def block():
    return rf.Block(width="2.4 m", height="9.6 m", mass="50 t")


def pads(**changed):
    return rf.TwoSpringSupport(**{"frequency_ratio": 20, "damping_ratio": 0.1, **changed})


CAP = rf.CushionCap(width="3.2 m", height="0.4 m", mass="10 t")
SOIL = rf.WinklerSoil(stiffness="30 MPa", damping="300 kPa*s")
# block and cap as one body: heights above the soil, inertia about the common centre of mass
MASS, CENTRE = 60e3, (50e3 * 5.2 + 10e3 * 0.2) / 60e3
INERTIA = (
    50e3 * (2.4**2 + 9.6**2) / 12.0 + 50e3 * (5.2 - CENTRE) ** 2
    + 10e3 * (3.2**2 + 0.4**2) / 12.0 + 10e3 * (CENTRE - 0.2) ** 2
)  # fmt: skip
TOP = 0.4 - CENTRE
"""Height of the cap's top above the common centre of mass [m]."""


def cascade(**options):
    return rf.System(block(), pads(), CAP, SOIL, coupling="cascade", **options)


def body_on_soil(**options):
    body = rf.Block(
        width="3.2 m",
        height=f"{2.0 * CENTRE!r} m",
        mass=f"{MASS!r} kg",
        inertia=f"{INERTIA!r} kg*m^2",
    )
    return rf.System(body, SOIL, **options)


def pulse(peak=-3.0, vertical=0.0):
    motion = rf.GroundMotion.sine_pulse(f"{peak} m/s^2", "1 Hz")
    if not vertical:
        return motion
    return motion.with_vertical(rf.GroundMotion.sine_pulse(f"{vertical} m/s^2", "1 Hz"))


RUN = {"free_vibration": "1 s", "accuracy": "reference"}


# stage 1 ----------------------------------------------------------------------------------------


@pytest.mark.parametrize("rotation", ["finite", "small"])
@pytest.mark.parametrize("rule", RULES)
def test_the_first_stage_is_block_and_cap_as_one_body_on_the_soil(rule, rotation):
    options = {"restraint": rule, "rotation": rotation}
    run = {**RUN, "output_step": "5 ms"}
    complete = cascade(**options).simulate(pulse(vertical=2.0), **run)
    first = body_on_soil(**options).simulate(pulse(vertical=2.0), overturning="continue", **run)
    assert int((first.contact_state != FULL).sum()) > 20
    size = np.abs(first.rotation.values).max()
    sine, versine = np.sin(first.rotation), 2.0 * np.sin(0.5 * first.rotation) ** 2
    if rotation == "small":
        sine, versine = first.rotation, 0.5 * first.rotation**2
    offset = 0.2 - CENTRE
    lift = first.vertical_displacement - offset * versine
    for name, expected in {
        "cap_rotation": first.rotation,
        "cap_angular_velocity": first.angular_velocity,
        "cap_vertical_displacement": lift,
        "cap_vertical_velocity": first.vertical_velocity - offset * sine * first.angular_velocity,
        "contact_length": first.contact_length,
    }.items():
        scale = max(np.abs(expected.values).max(), size)
        np.testing.assert_allclose(
            complete[name] / scale, expected / scale, atol=1e-8, err_msg=name
        )
    np.testing.assert_allclose(complete.soil_reaction, first.soil_reaction, atol=1e-8 * MASS * 9.8)
    np.testing.assert_array_equal(complete.soil_contact_state, first.contact_state)
    soil_events = complete.event_kind.values >= 9
    np.testing.assert_allclose(complete.event_time[soil_events], first.event_time, rtol=1e-9)


def test_the_ground_of_the_second_stage_is_the_motion_of_the_cap_s_top():
    """Away from jumps, second differences of the position of the top are its acceleration."""
    step = 1e-3
    response = cascade(restraint="centre").simulate(
        pulse(vertical=2.0), output_step=f"{step} s", **RUN
    )
    first = body_on_soil(restraint="centre").simulate(
        pulse(vertical=2.0), output_step=f"{step} s", overturning="continue", **RUN
    )
    angle = first.rotation.values
    x = first.horizontal_displacement.values + TOP * np.sin(angle)
    y = first.vertical_displacement.values - TOP * 2.0 * np.sin(0.5 * angle) ** 2
    for place, ground, name in (
        (x, first.ground_acceleration.values, "cap_acceleration"),
        (y, first.vertical_ground_acceleration.values, "cap_vertical_acceleration"),
    ):
        expected = np.diff(place, 2) / step**2 + ground[1:-1]
        found = response[name].values[1:-1]
        # away from steps of the soil's dashpot forces
        bend = np.abs(np.diff(found, prepend=found[0]))
        calm = bend < 10.0 * np.median(bend)
        assert calm.mean() > 0.9
        assert np.abs(found - expected)[calm].max() < 2e-2 * np.abs(found).max(), name


# stage 2 ----------------------------------------------------------------------------------------


def jumps_of_top(first, rule):
    """Return times and sizes of jumps of the top's velocity, where the first body is re-pinned."""
    if rule != "contact-state":
        return []
    held = {FULL: 0.0, 1: -1.6, 2: 1.6}
    jumps = []
    for i, time in enumerate(first.event_time.values):
        before, after = (int(first[f"contact_state_{side}"][i]) for side in ("before", "after"))
        angle = first.event_rotation.item(i)
        sine, cosine = np.sin(angle), np.cos(angle)
        old, new = (first[f"angular_velocity_{side}"].item(i) for side in ("before", "after"))
        across = [
            ((CENTRE + TOP) * cosine + held[state] * sine) * rate
            for state, rate in ((before, old), (after, new))
        ]
        jumps.append((time, across[1] - across[0], -TOP * sine * (new - old)))
    return jumps


def reference_second_stage(step, rule):
    run = {"output_step": f"{step!r} s", **RUN}
    complete = cascade(restraint=rule).simulate(pulse(), **run)
    first = body_on_soil(restraint=rule).simulate(pulse(), overturning="continue", **run)
    across = complete.cap_acceleration.values.copy()
    upwards = complete.cap_vertical_acceleration.values.copy()
    for time, jump_x, jump_y in jumps_of_top(first, rule):
        # an impulse between two samples, with its area and its centre
        i, share = divmod(time / step, 1.0)
        for sample, weight in ((int(i), 1.0 - share), (int(i) + 1, share)):
            across[sample] += weight * jump_x / step
            upwards[sample] += weight * jump_y / step
    carried = rf.GroundMotion.from_arrays(
        (across, "m/s^2"), f"{step!r} s", vertical=(upwards, "m/s^2")
    )
    return complete, rf.System(block(), pads(), restraint=rule).simulate(
        carried, accuracy="reference"
    )


@pytest.mark.parametrize("rule", RULES)
def test_the_second_stage_is_the_block_on_its_pads_on_the_moving_cap(rule):
    """The cap's motion is linear between samples: the error falls with the step.

    Where the first body is re-pinned its acceleration jumps as well as its velocity, and
    straight lines over the jump are of first order only.
    """
    steps = (4e-3, 1e-3, 2.5e-4)
    errors = []
    for step in steps:
        complete, second = reference_second_stage(step, rule)
        assert second.impact_count.item() > 0
        scale = np.abs(second.rotation.values).max()
        errors.append(np.abs(complete.rotation_on_cap - second.rotation).max().item() / scale)
    assert errors[0] > errors[1] > errors[2]
    assert errors[0] > (4.0 if rule == "contact-state" else 32.0) * errors[2]
    assert errors[2] < 3e-5
    # the second stage equals the run by hand, the totals are sums
    for name in ("left_reaction", "right_reaction"):
        near = np.abs(complete[name].values - second[name].values) < 1e-2 * 50e3 * 9.8
        assert near.mean() > 0.99, name
    assert np.mean(complete.contact_state.values == second.contact_state.values) > 0.999
    assert complete.impact_count == second.impact_count
    first = body_on_soil(restraint=rule).simulate(
        pulse(), output_step=f"{steps[-1]!r} s", overturning="continue", **RUN
    )
    for name in ("rotation", "vertical_displacement", "horizontal_displacement"):
        total = first[name].values + second[name].values
        scale = np.abs(total).max()
        np.testing.assert_allclose(complete[name].values / scale, total / scale, atol=1e-4)


@pytest.mark.parametrize("rule", RULES)
def test_initial_rotation_goes_to_second_stage(rule):
    initial = rf.InitialState(rotation="0.1 rad", angular_velocity="-0.02 rad/s")
    run = {"duration": "4 s", "output_step": "5 ms", "accuracy": "reference", "initial": initial}
    complete = cascade(restraint=rule).simulate(**run)
    alone = rf.System(block(), pads(), restraint=rule).simulate(**run)
    assert alone.impact_count.item() > 1
    assert (complete.cap_rotation.values == 0.0).all()
    assert (complete.soil_contact_state.values == 0).all()
    np.testing.assert_allclose(complete.rotation, alone.rotation, atol=1e-9)
    np.testing.assert_allclose(complete.soil_reaction, MASS * 9.80665, rtol=1e-12)
    np.testing.assert_allclose(complete.cap_acceleration, 0.0, atol=1e-12)
    np.testing.assert_allclose(complete.event_time, alone.event_time, rtol=1e-9)


# the total ----------------------------------------------------------------------------------------


def test_total_rotation_decides_overturning():
    """Neither stage reaches theta, but their sum does."""
    fine = {"output_step": "0.2 ms", "free_vibration": "2 s", "accuracy": "reference"}
    motion = pulse(-6.5)
    stopped = cascade().simulate(motion, **fine)
    longer = cascade().simulate(motion, overturning="continue", **fine)
    theta = math.atan(0.25)
    time = stopped.overturning_time.item()
    assert stopped.overturned.item()
    assert stopped.overturning_angle.item() == pytest.approx(theta, rel=1e-14)
    assert stopped.time.values[-1] == time == stopped.attrs["solver_end_time"]
    assert abs(stopped.rotation.values[-1]) == pytest.approx(theta, rel=1e-14)
    assert (np.abs(stopped.rotation.values[:-1]) < theta).all()
    for name in ("cap_rotation", "rotation_on_cap"):
        assert 0.01 * theta < np.abs(stopped[name].values).max() < theta, name
    rows = np.flatnonzero(np.abs(longer.rotation.values) >= theta)
    assert longer.time.values[rows[0] - 1] <= time <= longer.time.values[rows[0]]
    assert longer.overturning_time.item() == pytest.approx(time, abs=1e-10)
    coarse = cascade().simulate(motion, free_vibration="2 s", output_step="37 ms", outputs=None)
    assert coarse.overturning_time.item() == pytest.approx(time, abs=1e-6)
    kinds = stopped.event_kind.values
    assert kinds[-1] == 7
    assert (kinds[:-1] != 7).all()
    assert stopped.event_time.values[-1] == time
    assert stopped.event_rotation.values[-1] == pytest.approx(stopped.rotation.values[-1], rel=1e-9)
    rate = stopped.angular_velocity.values[-1]
    assert stopped.angular_velocity_before.values[-1] == pytest.approx(rate, rel=1e-6)


def test_counts_and_durations_stop_at_overturning():
    """Motion of the stages after the total has overturned is not part of the run."""
    t = np.arange(401) * 0.01
    across = np.where(t <= 2.0, -9.0 * np.sin(math.pi * t), 0.0)
    upwards = np.where(t >= 1.0, 25.0 * np.sin(2.0 * math.pi * t), 0.0)
    motion = rf.GroundMotion.from_arrays((across, "m/s^2"), "10 ms", vertical=(upwards, "m/s^2"))
    longer = cascade().simulate(motion, overturning="continue")
    stopped = cascade().simulate(motion)
    assert stopped.overturned.item()
    end = stopped.overturning_time.item()
    assert longer.flight_count.item() > 0
    time = np.concatenate([[0.0], stopped.event_time.values, [end]])
    state = np.concatenate([[FULL], stopped.contact_state_after.values])
    flying = np.diff(time)[state == FLIGHT].sum()
    assert longer.flight_time.item() > flying + 0.01  # the continued run has more flight
    assert stopped.flight_time.item() == pytest.approx(flying, abs=1e-9)
    into = (state[1:] == FLIGHT) & (state[:-1] != FLIGHT)
    assert stopped.flight_count.item() == into.sum()
    assert stopped.impact_count.item() == (stopped.event_kind.values == 2).sum()


@pytest.mark.parametrize("duration", [0.4, 0.4001, 0.403, 0.404])
def test_both_stages_end_at_the_same_instant(duration):
    """While the rotation grows, its peak is its last value."""
    run = {"duration": f"{duration} s", "accuracy": "reference"}
    response = cascade().simulate(pulse(), output_step="0.1 ms", **run)
    assert 0.0 <= duration - response.time.values[-1] < 1e-4 * (1.0 - 1e-9)
    last = response.rotation.values[-1]
    assert response.angular_velocity.values[-1] > 0.1
    assert response.peak_rotation.item() == pytest.approx(last, rel=1e-9)


def test_run_that_ends_before_overturning_time_does_not_overturn():
    motion = pulse(-6.5)
    end = cascade().simulate(motion, free_vibration="2 s").overturning_time.item()
    shorter = cascade().simulate(motion, duration=f"{end - 1e-4!r} s")
    assert not shorter.overturned.item()
    assert shorter.time.values[-1] <= end


def test_peak_of_total_rotation_is_found_between_samples():
    response = cascade().simulate(pulse(), output_step="0.1 ms", **RUN)
    coarse = cascade().simulate(pulse(), output_step="50 ms", **RUN)
    largest = np.abs(response.rotation.values).max()
    for run in (response, coarse):
        assert run.peak_rotation.item() == pytest.approx(largest, rel=1e-6)
        assert run.peak_rotation.item() >= np.abs(run.rotation.values).max() * (1.0 - 1e-9)


# impulses ---------------------------------------------------------------------------------------


def test_soil_events_cause_no_vertical_impulse_on_block():
    """The velocity of the cap's top jumps; pads act by forces, except along the cap."""
    soft = rf.WinklerSoil(stiffness="8 MPa", damping="100 kPa*s")
    system = rf.System(block(), pads(), CAP, soft, coupling="cascade")
    response = system.simulate(pulse(-6.0), outputs="impulse", **RUN)
    names = response.event_kind.attrs["flag_meanings"].split()
    kind = np.array(names)[np.searchsorted(
        response.event_kind.attrs["flag_values"], response.event_kind
    )]  # fmt: skip
    vertical = response.event_vertical_impulse.to_numpy()
    across = response.event_horizontal_impulse.to_numpy()
    strikes, below = kind == "impact", np.char.startswith(kind, "soil_")
    assert strikes.any()
    assert np.abs(across[below]).max() > 1.0
    assert np.abs(vertical[~strikes]).max() < 1e-9
    assert vertical[strikes].min() > 1e3
    demand = np.abs(across[strikes] / vertical[strikes]).max()
    assert response.peak_impulsive_friction_demand == pytest.approx(demand, rel=1e-9)
