"""The dataset of every scene has the documented layout, types and attributes."""

import math
import re
from dataclasses import replace
from inspect import signature
from types import SimpleNamespace

import cf_xarray  # noqa: F401
import numpy as np
import pytest
import xarray as xr
from contract.scenes import (
    MODELS,
    MOTIONS,
    ON_PADS,
    ON_SOIL,
    SCENES,
    STACKED,
    has_cap,
    overturning_angle,
    pulse,
    record,
)

import rockframe as rf
from rockframe.dynamics.protocol import Ending
from rockframe.errors import SolverWarning
from rockframe.results.outcome import verdict
from rockframe.results.schema import ENERGIES, SCHEMA
from rockframe.solve.accuracy import accuracy_of
from rockframe.solve.trajectory import Summary
from rockframe.solve.workspace import Status
from rockframe.system.bodies import OverturningAngles

pytestmark = pytest.mark.contract

HISTORIES = {
    "rotation",
    "angular_velocity",
    "vertical_displacement",
    "vertical_velocity",
    "horizontal_displacement",
    "relative_rotation",
    "contact_state",
    "ground_acceleration",
    "base_shear",
}
CORNERS = {"left_reaction", "right_reaction"}
BED = {"soil_reaction", "contact_length"}
CAP = {
    "cap_rotation",
    "cap_angular_velocity",
    "cap_vertical_displacement",
    "cap_vertical_velocity",
    "soil_contact_state",
}
ON_CAP = {"rotation_on_cap", "vertical_displacement_on_cap"}
CARRIED = {"cap_acceleration", "cap_vertical_acceleration"}
SCALARS = {
    "overturned",
    "overturning_time",
    "overturning_direction",
    "peak_rotation",
    "peak_relative_rotation",
    "first_uplift_time",
    "impact_count",
    "flight_time",
    "energy_residual",
    "status",
    "overturning_angle",
    "uplift_angle",
}
EVENTS = {"event_time", "event_kind", "contact_state_before", "contact_state_after"}
BOTH_SIDES = {"angular_velocity_before", "angular_velocity_after"}
SOIL_EVENTS = {"soil_contact_state_before", "soil_contact_state_after"}


def histories_of(scene):
    """Return the names of the histories that a scene has by default."""
    model = MODELS[scene]
    names = set(HISTORIES)
    if model in ON_PADS or model == "rigid ground":
        names |= CORNERS
    if model != "rigid ground":
        names.add("relative_vertical_displacement")
    if model in ON_SOIL:
        names |= BED
    if has_cap(scene):
        names |= CAP
    if model in STACKED:
        names |= ON_CAP
    return names | CARRIED if model == "cascade" else names


CHECKS = []


def check(function):
    """Add a check of the dataset of every scene under every motion."""
    CHECKS.append(function)
    return function


@check
def variables_and_dimensions_match_schema(scene, motion_name, response):
    assert isinstance(response, xr.Dataset)
    assert set(response.dims) == {"time", "event"}
    assert set(response.coords) == {"time"}
    assert set(response.data_vars) >= SCALARS | EVENTS | BOTH_SIDES
    assert ("vertical_ground_acceleration" in response) == ("vertical" in motion_name)
    found = {name for name in response.data_vars if response[name].dims == ("time",)}
    found.discard("vertical_ground_acceleration")
    assert found == histories_of(scene) | set(ENERGIES)
    assert (set(response.data_vars) >= SOIL_EVENTS) == (MODELS[scene] in STACKED)
    for name, variable in response.variables.items():
        assert name in SCHEMA
        assert variable.dims == SCHEMA[name].dims, name
        assert variable.dtype == SCHEMA[name].dtype, name


@check
def time_axis_starts_at_zero(response):
    time = response.time.values
    assert time.dtype == np.float64
    assert time[0] == 0.0
    assert (np.diff(time) > 0.0).all()
    assert response.indexes["time"].is_unique
    assert response.time.attrs["units"] == "s"


@check
def floats_have_units_and_long_names(response):
    for name, variable in response.variables.items():
        assert isinstance(variable.data, np.ndarray), name
        assert variable.data.flags.writeable or name == "time", name
        assert variable.attrs["long_name"], name
        if variable.dtype.kind == "f":
            assert variable.dtype == np.float64, name
            assert isinstance(variable.attrs["units"], str), name
        for value in variable.attrs.values():
            assert isinstance(value, str | np.ndarray), name
        assert "_FillValue" not in variable.attrs, name


@check
def histories_are_finite(response):
    for name, variable in response.variables.items():
        if variable.dims:
            assert np.isfinite(variable.values).all(), name


@check
def flags_have_meanings(response):
    state = response.contact_state
    assert state.dtype == np.int8
    assert state.attrs["flag_values"].dtype == np.int8
    assert state.attrs["flag_meanings"] == "full left right flight"
    flying = state.cf == "flight"
    np.testing.assert_array_equal(flying.values, state.values == 3)
    np.testing.assert_array_equal((state.cf == "full").values, state.values == 0)
    words = ["full", "left", "right", "flight"]
    counts = [int((state.cf == word).sum()) for word in words]
    assert sum(counts) == state.size
    assert counts[0] > 0
    assert counts[1] > 0
    assert counts[2] > 0
    assert bool((response.status.cf == "completed").item())
    direction = response.overturning_direction
    assert bool((direction.cf == "none").item())
    impacts = (response.event_kind.cf == "impact") | (response.event_kind.cf == "rest")
    assert (impacts.sum() == response.impact_count).item()
    flagged = ["event_kind", "status", "overturning_direction", "contact_state"]
    if "soil_contact_state" in response:
        flagged.append("soil_contact_state")
        assert {0, 1, 2} <= set(response.soil_contact_state.values.tolist())
        assert response.soil_contact_state.attrs["flag_meanings"] == "full left right flight"
    for name in flagged:
        flags = response[name].attrs["flag_values"]
        assert np.isin(response[name].values, flags).all(), name


@check
def contact_states_match_reactions(scene, response):
    if MODELS[scene] in ON_SOIL:
        check_soil(scene, response)
    if MODELS[scene] == "Winkler":
        return
    left = response.left_reaction.values
    right = response.right_reaction.values
    state = response.contact_state.values
    assert (left >= -1e-6).all()
    assert (right >= -1e-6).all()
    assert (left[(state == 2) | (state == 3)] == 0.0).all()
    assert (right[(state == 1) | (state == 3)] == 0.0).all()


def check_soil(scene, response):
    state = response["soil_contact_state" if has_cap(scene) else "contact_state"].values
    length, width = response.contact_length.values, 3.2 if has_cap(scene) else 2.4
    assert (length >= 0.0).all()
    assert (length <= width * (1.0 + 1e-12)).all()
    assert (length[state == 3] == 0.0).all()
    assert (response.soil_reaction.values[state == 3] == 0.0).all()
    assert (length[(state == 1) | (state == 2)] < width * (1.0 + 1e-12)).all()
    if "pressure" in scene:
        assert (response.soil_reaction.values >= -1e-6).all()
    else:
        np.testing.assert_allclose(length[state == 0], width, rtol=1e-15)


@check
def cap_moves_with_block(scene, response):
    if not has_cap(scene):
        assert not (CAP | ON_CAP) & set(response.variables)
        return
    if MODELS[scene] not in STACKED:
        np.testing.assert_array_equal(response.cap_rotation, response.rotation)
        np.testing.assert_array_equal(response.soil_contact_state, response.contact_state)
        return
    total = response.cap_rotation.values + response.rotation_on_cap.values
    np.testing.assert_allclose(response.rotation, total, rtol=0.0, atol=1e-16)
    if MODELS[scene] == "cascade":
        np.testing.assert_array_equal(response.rotation, total)


@check
def scalars_agree_with_histories(scene, response):
    assert response.overturned.dtype == bool
    theta = response.overturning_angle.item()
    assert theta == pytest.approx(overturning_angle(scene), rel=1e-14)
    relative = response.rotation.values / theta
    np.testing.assert_array_equal(response.relative_rotation.values, relative)
    peak = response.peak_rotation.item()
    largest = np.abs(response.rotation.values).max()
    assert largest <= peak * (1.0 + 1e-9)
    assert largest >= 0.99 * peak
    assert response.peak_relative_rotation.item() == peak / theta
    assert 0.0 <= response.energy_residual.item() < 1e-5
    lifted = response.time.values[response.contact_state.values != 0]
    first = response.first_uplift_time.item()
    assert first <= lifted[0]
    assert lifted[0] - first <= 0.0101
    assert math.isnan(response.overturning_time.item())


@check
def events_are_ordered_and_connected(scene, response):
    time = response.event_time.values
    assert time.size > 0
    assert (np.diff(time) >= 0.0).all()
    assert time[0] >= 0.0
    assert time[-1] <= response.time.values[-1] + 0.0101
    for of in ("", "soil_") if MODELS[scene] in STACKED else ("",):
        before = response[f"{of}contact_state_before"].values
        after = response[f"{of}contact_state_after"].values
        state = response[f"{of}contact_state"].values
        np.testing.assert_array_equal(before[1:], after[:-1])
        assert before[0] == state[0]
        # between events the histories stay in the state after the last event
        held = np.concatenate([before[:1], after])
        row = np.searchsorted(time, response.time.values, side="left")
        np.testing.assert_array_equal(state, held[row])
    # a block comes to rest by an impact
    assert np.isin(response.event_kind.values, (2, 6)).sum() == response.impact_count.item()


@check
def rates_are_slopes_of_histories(scene, motion_name):
    """Between events, by the trapezoidal rule: its error is of third order in the step."""
    response = SCENES[scene]().simulate(
        MOTIONS[motion_name](), free_vibration="0.5 s", output_step="1 ms"
    )
    time = response.time.values
    events = np.unique(response.event_time.values)
    calm = np.searchsorted(events, time[:-1]) == np.searchsorted(events, time[1:])
    assert calm.mean() > 0.5
    step = np.diff(time)
    pairs = [
        ("rotation", "angular_velocity"),
        ("vertical_displacement", "vertical_velocity"),
    ]
    if has_cap(scene):
        pairs += [
            ("cap_rotation", "cap_angular_velocity"),
            ("cap_vertical_displacement", "cap_vertical_velocity"),
        ]
    for value, rate in pairs:
        y, v = response[value].values, response[rate].values
        error = np.abs(np.diff(y) - 0.5 * step * (v[1:] + v[:-1]))
        bend = np.abs(np.diff(v, 2))
        around = np.maximum(np.append(bend, 0.0), np.insert(bend, 0, 0.0))
        assert (error <= 0.25 * step * around + 1e-9 * np.abs(y).max())[calm].all(), value


@check
def attributes_are_strings_and_numbers(response):
    for name, value in response.attrs.items():
        assert isinstance(name, str)
        assert type(value) in (str, int, float), name
        if isinstance(value, str):
            assert value, name
            assert value.isprintable() or "\n" in value, name


@check
def attributes_describe_the_run(scene, motion_name, response):
    attrs = response.attrs
    assert attrs["Conventions"] == "CF-1.11"
    assert attrs["title"]
    assert re.match(r"\d{4}-\d\d-\d\dT\d\d:\d\d:\d\dZ ", attrs["history"])
    assert re.search(rf"rockframe {re.escape(rf.__version__)}\b", attrs["source"])
    assert "Winkler Foundation" in attrs["references"] or "doi" in attrs["references"].lower()
    assert attrs["model"] == MODELS[scene]
    assert attrs["model_description"] == SCENES[scene]().describe()
    assert attrs["overturned"] == 0
    assert type(attrs["overturned"]) is int
    assert math.isnan(attrs["overturning_time"])
    assert attrs["overturning_direction"] == "none"
    assert attrs["verdict"].endswith(".")
    assert "not overturn" in attrs["verdict"]
    assert attrs["solver_rtol"] == accuracy_of("standard").rtol
    assert attrs["solver_steps"] > 10
    assert re.fullmatch(r"[0-9a-f]{64}", attrs["motion_sha256"])
    assert attrs["motion_sha256"] == MOTIONS[motion_name]().sha256
    assert attrs["motion"] == MOTIONS[motion_name]().name
    assert attrs["system_json"].startswith("{")
    if "finite" in scene:
        assert "finite" in attrs.values()
    else:
        assert "small" in attrs.values()
    if MODELS[scene] != "rigid ground":
        assert attrs["restraint"] == scene.split(", ")[1]
    assert attrs.get("coupling") == (MODELS[scene] if MODELS[scene] in STACKED else None)


@check
def ground_acceleration_equals_motion(motion_name, response):
    si = MOTIONS[motion_name]().si
    across = response.ground_acceleration.values
    np.testing.assert_array_equal(across[: si.horizontal.samples.size], si.horizontal.samples)
    assert (across[si.horizontal.samples.size :] == 0.0).all()
    if "vertical" in motion_name:
        upwards = response.vertical_ground_acceleration.values
        samples = si.vertical.samples
        np.testing.assert_allclose(upwards[: samples.size], samples, atol=1e-12)
        assert (upwards[samples.size :] == 0.0).all()


def test_every_dataset(subtests, scene, motion_name, response):
    known = {"scene": scene, "motion_name": motion_name, "response": response}
    for function in CHECKS:
        with subtests.test(function.__name__):
            function(**{name: known[name] for name in signature(function).parameters})


def falling(scene, **options):
    motion = rf.GroundMotion.sine_pulse("-9 m/s^2", "0.5 Hz")
    return SCENES[scene]().simulate(motion, **options)


class TestOverturning:
    def test_overturning_ends_run_and_is_reported(self, scene):
        response = falling(scene, free_vibration="5 s")
        time = response.overturning_time.item()
        assert response.overturned.item() is True
        assert 0.0 < time < 2.0
        assert response.time.values[-1] == time
        assert response.event_time.values[-1] == time
        assert bool(response.event_kind.cf.isin(["overturning"])[-1])
        theta = response.overturning_angle.item()
        # the total of a cascade is known at samples and interpolated by cubics
        close = 1e-8 if MODELS[scene] == "cascade" else 1e-12
        assert abs(response.rotation.values[-1]) == pytest.approx(theta, rel=close)
        assert response.peak_relative_rotation.item() == pytest.approx(1.0, rel=1e-12)
        assert bool((response.overturning_direction.cf == "right").item())
        assert bool((response.status.cf == "overturned").item())
        assert response.attrs["overturned"] == 1
        assert response.attrs["overturning_time"] == time
        assert response.attrs["overturning_direction"] == "right"
        assert "right" in response.attrs["verdict"]
        assert f"{time:.3f} s" in response.attrs["verdict"]

    def test_run_can_continue_until_block_lies_flat(self, scene):
        short = falling(scene, free_vibration="5 s")
        long = falling(scene, free_vibration="60 s", overturning="continue")
        assert bool((long.status.cf == "toppled").item())
        assert long.overturning_time.item() == short.overturning_time.item()
        close = 1e-8 if MODELS[scene] == "cascade" else 1e-12
        assert abs(long.rotation.values[-1]) == pytest.approx(0.5 * math.pi, rel=close)
        assert long.peak_rotation.item() == pytest.approx(0.5 * math.pi, rel=close)
        kinds = long.event_kind
        assert int((kinds.cf == "overturning").sum()) == 1
        assert bool((kinds.cf == "toppled")[-1])
        assert long.event_time.values[-1] == long.time.values[-1]
        assert (np.diff(long.time.values) > 0.0).all()
        count = short.sizes["time"] - 1
        np.testing.assert_array_equal(long.rotation.values[:count], short.rotation.values[:count])
        assert "flat" in long.attrs["verdict"]

    def test_overturning_to_the_left(self, scene):
        motion = rf.GroundMotion.sine_pulse("9 m/s^2", "0.5 Hz")
        response = SCENES[scene]().simulate(motion)
        assert bool((response.overturning_direction.cf == "left").item())
        assert "left" in response.attrs["verdict"]


class TestRequests:
    def test_energies_only_on_request(self, scene):
        assert not set(ENERGIES) & set(SCENES[scene]().simulate(pulse()).variables)

    def test_one_energy_only(self, scene):
        first, *others = ENERGIES
        requests = [(name, name) for name in ENERGIES]
        if scene == next(iter(SCENES)):  # outputs are read before the scene is assembled
            requests += [(first, form) for form in ([first], (first,), {first})]
            requests += [(others[0], [others[0]])]
        for name, outputs in requests:
            response = SCENES[scene]().simulate(pulse(), duration="0.4 s", outputs=outputs)
            assert set(ENERGIES) & set(response.variables) == {name}

    def test_outputs_none_leaves_out_histories(self, scene):
        response = SCENES[scene]().simulate(pulse(), outputs=None)
        assert set(response.dims) == {"event"}
        assert set(response.variables) >= SCALARS | EVENTS
        assert not histories_of(scene) & set(response.variables)
        with_histories = SCENES[scene]().simulate(pulse())
        for name, row in response.data_vars.items():
            np.testing.assert_array_equal(row.values, with_histories[name].values, err_msg=name)

    def test_the_output_step(self, scene):
        response = SCENES[scene]().simulate(record(), duration="3 s", output_step="30 ms")
        np.testing.assert_array_equal(response.time.values, np.arange(101) * 0.03)
        own = SCENES[scene]().simulate(record(), duration="3 s")
        np.testing.assert_array_equal(own.time.values, np.arange(301) * 0.01)

    def test_run_without_motion(self, scene):
        response = SCENES[scene]().simulate(
            duration="1 s", initial=rf.InitialState(rotation="0.1 rad")
        )
        assert (response.ground_acceleration.values == 0.0).all()
        assert response.rotation.values[0] == 0.1
        assert response.time.values[-1] == pytest.approx(1.0, abs=1e-12)
        assert "motion_sha256" not in response.attrs
        assert response.attrs["motion"] == "none"

    def test_undisturbed_block_stays_at_rest(self, scene):
        response = SCENES[scene]().simulate(duration="1 s", outputs="energy")
        assert response.sizes["event"] == 0
        assert (response.rotation.values == 0.0).all()
        # weight and soil reaction balance up to rounding, for any mass
        rounding = 1e-16 if MODELS[scene] in ON_SOIL else 0.0
        assert (np.abs(response.vertical_displacement.values) <= rounding).all()
        assert math.isnan(response.first_uplift_time.item())
        assert response.peak_rotation.item() == 0.0
        assert response.energy_residual.item() <= rounding
        if set(response.variables) >= CORNERS:
            total = response.left_reaction.values + response.right_reaction.values
            np.testing.assert_allclose(total, 50e3 * 9.80665, rtol=1e-12)
        if MODELS[scene] in ON_SOIL:
            weight = (60e3 if has_cap(scene) else 50e3) * 9.80665
            np.testing.assert_allclose(response.soil_reaction, weight, rtol=1e-12)
            assert (response.contact_length.values == (3.2 if has_cap(scene) else 2.4)).all()
        if has_cap(scene):
            assert (response.cap_rotation.values == 0.0).all()
            assert (response.soil_contact_state.values == 0).all()
        assert "no uplift" in response.attrs["verdict"]


def test_scalars_of_a_study_concatenate():
    rows = []
    for scene in SCENES:
        for amplitude in ("-3 m/s^2", "-9 m/s^2"):
            motion = rf.GroundMotion.sine_pulse(amplitude, "0.5 Hz")
            rows.append(SCENES[scene]().simulate(motion, outputs=None).drop_dims("event"))
    assert set(rows[0].data_vars) >= SCALARS
    study = xr.concat(rows, dim="run", data_vars="all", coords="minimal", compat="override")
    assert study.sizes == {"run": len(rows)}
    for name in SCALARS:
        assert study[name].dims == ("run",)
        assert study[name].dtype == SCHEMA[name].dtype
        assert study[name].attrs["long_name"] == SCHEMA[name].long_name
    assert 0 < study.overturned.sum() < len(rows)
    assert (np.isnan(study.overturning_time) == ~study.overturned).all()


def test_number_as_accuracy_is_relative_tolerance():
    system = SCENES["two-spring, contact-state, finite"]()
    one = system.simulate(pulse(), accuracy=1e-6)
    other = system.simulate(pulse(), accuracy=rf.Accuracy(rtol=1e-6))
    assert one.attrs["solver_rtol"] == 1e-6
    assert one.drop_attrs(deep=False).identical(other.drop_attrs(deep=False))


@pytest.mark.parametrize(
    "base",
    [
        rf.TwoSpringSupport(frequency_ratio=40, damping_ratio=0.1),
        rf.WinklerSoil(stiffness="20 MPa", damping_ratio=0.1),
    ],
)
def test_relative_vertical_displacement_is_in_units_of_settlement(base):
    """g over the square of the vertical frequency."""
    system = rf.System(rf.Block(width="2 m", height="8 m", mass="50 t"), base)
    settlement = 9.80665 / float(system.frequencies().angular_frequency[-1]) ** 2
    start = rf.InitialState(vertical_displacement="-0.1 mm")
    response = system.simulate(duration="0.1 s", initial=start)
    assert response.relative_vertical_displacement.values == pytest.approx(
        response.vertical_displacement.values / settlement, rel=1e-9
    )


def test_last_sample_is_present_despite_rounding_of_duration():
    assert 0.3 / 0.1 < 3.0
    system = SCENES["two-spring, contact-state, finite"]()
    assert system.simulate(duration="0.3 s", output_step="0.1 s").time.size == 4


STANDING = "Did not overturn: peak rotation 0.01 rad, 5 % of the overturning angle; "


@pytest.mark.parametrize(
    ("found", "pads_on_cap", "words"),
    [
        ({}, False, STANDING + "1 impact."),
        (
            {"impact_count": 2, "flight_time": 0.125},
            False,
            STANDING + "2 impacts, 0.125 s in flight.",
        ),
        (
            {"impact_count": 0, "first_uplift_time": math.nan},
            False,
            STANDING + "0 impacts, no uplift.",
        ),
        ({"first_uplift_time": math.nan}, True, STANDING + "1 impact, no uplift from the pads."),
        (
            {
                "overturning_time": 1.25,
                "overturning_direction": -1,
                "status": Status.OVERTURNED,
            },
            False,
            "Overturned to the left at 1.250 s, after 1 impact.",
        ),
        (
            {"overturning_time": 1.25, "overturning_direction": 1, "status": Status.TOPPLED},
            False,
            "Overturned to the right at 1.250 s, and fell flat at 2.000 s, after 1 impact.",
        ),
        (
            {"overturning_time": 1.25, "overturning_direction": -1, "status": Status.TOPPLED},
            False,
            "Passed the overturning angle to the left at 1.250 s, and fell flat to the right at "
            "2.000 s, after 1 impact.",
        ),
        (
            {"overturning_time": 1.25, "overturning_direction": -1},
            False,
            "Passed the overturning angle to the left at 1.250 s, and stands at the end, after 1 "
            "impact.",
        ),
        (
            {"status": Status.CHATTER},
            False,
            "Not finished: stopped at 2 s, because contact changes followed one another without "
            "end. Until then no overturning: peak rotation 0.01 rad, 5 % of the overturning angle; "
            "1 impact.",
        ),
    ],
)
def test_verdict_sentence(found, pads_on_cap, words):
    summary = Summary(
        status=Status.COMPLETED,
        end_time=2.0,
        peak_left=0.01,
        peak_right=0.005,
        overturning_time=math.nan,
        overturning_direction=0,
        first_uplift_time=0.5,
        flight_time=0.0,
        impact_count=1,
        flight_count=0,
        step_count=1,
        rejected_count=0,
        substeps=0,
        energy_residual=0.0,
        ending=Ending(0, np.zeros(6), np.zeros(5)),
    )
    angles = OverturningAngles(0.2, 0.2)
    setting = SimpleNamespace(
        overturning_angles=angles, leans=False, stacked=pads_on_cap, slips_of=lambda _: []
    )
    model = SimpleNamespace(
        system=None, links=0, shows_bodies=False, rotation_in=lambda _: 0.1,
        other_share_in=lambda _: 0.0,
    )  # fmt: skip
    assert verdict(replace(summary, **found), setting, model) == words
    of_several = SimpleNamespace(**vars(model) | {"shows_bodies": True})
    upper = verdict(replace(summary, first_uplift_time=math.nan), setting, of_several)
    assert pads_on_cap or "1 impact, no uplift of body 1." in upper
    if not summary.overturned and summary.status.finished and not found:
        setting.overturning_angles, setting.leans = OverturningAngles(0.2, 0.025), True
        sentence = verdict(summary, setting, model)
        assert "peak rotation 0.005 rad, 20 % of the overturning angle to the right;" in sentence


def test_unfinished_run_warns():
    system = SCENES["two-spring, contact-state, finite"]()
    with pytest.warns(SolverWarning, match="Not finished: stopped at") as caught:
        response = system.simulate(pulse(), accuracy=rf.Accuracy(rtol=1e-7, max_steps=50))
    assert caught[0].filename == __file__
    assert bool((response.status.cf == "step_limit").item())
    assert response.attrs["verdict"].startswith("Not finished: stopped at")
    assert response.attrs["cautions"] == response.attrs["verdict"]
    assert response.attrs["solver_steps"] <= 50
    assert response.time.values[-1] == response.attrs["solver_end_time"]
    assert response.attrs["solver_end_time"] < 1.0
    assert response.overturned.item() is False
