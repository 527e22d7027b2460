"""Datasets survive a file of plain xarray, and their system reproduces the run bit for bit."""

import json
from inspect import signature

import cf_xarray  # noqa: F401
import netCDF4
import numpy as np
import pytest
import xarray as xr
from contract.scenes import MOTIONS, RULES, SCENES, block, cap, pads, pulse, record, soil

import rockframe as rf
from rockframe.errors import RecordWarning, SchemaError

pytestmark = pytest.mark.contract

TIMESTAMPS = ("history",)


def through_file(dataset, folder, **options):
    path = folder / "response.nc"
    dataset.to_netcdf(path, **options)
    with xr.open_dataset(path, **options) as again:
        return again.load()


def round_trip_is_identical(response, again):
    xr.testing.assert_identical(again, response)
    for name, variable in response.variables.items():
        assert again[name].dtype == variable.dtype, name
        np.testing.assert_array_equal(again[name].values, variable.values)
    for name, value in response.attrs.items():
        assert np.array_equal(again.attrs[name], value, equal_nan=isinstance(value, float))
    assert ((again.contact_state.cf == "full") == (response.contact_state.cf == "full")).all()


def writing_does_not_change_dataset(response, before, path):
    xr.testing.assert_identical(before, response)
    response.to_netcdf(path.with_name("two.nc"))


def file_has_expected_attributes(path):
    with netCDF4.Dataset(path) as file:
        for name, variable in file.variables.items():
            attributes = variable.ncattrs()
            assert "long_name" in attributes
            if name == "time" or "flag_values" in attributes:
                assert "_FillValue" not in attributes, name
                assert "missing_value" not in attributes, name
            if "flag_values" in attributes:
                assert variable.dtype == np.int8
                assert variable.getncattr("flag_values").dtype == np.int8
            if variable.dtype == np.float64:
                assert "units" in attributes, name
            assert "coordinates" not in attributes, name
        assert not any(dimension.isunlimited() for dimension in file.dimensions.values())
        assert "coordinates" not in file.ncattrs()


def system_reproduces_the_run(scene, motion_name, again):
    system = rf.System.from_dataset(again)
    assert system.assembly.to_dict() == SCENES[scene]().to_dict()
    motion = system.motion
    if motion_name == "pulse and vertical":
        # two analytic pulses in one motion: only the digest is stored
        assert motion is None or motion.sha256 == MOTIONS[motion_name]().sha256
        motion = MOTIONS[motion_name]()
    assert motion is not None
    assert motion.sha256 == MOTIONS[motion_name]().sha256
    rerun = system.simulate(motion, free_vibration="0.5 s", outputs="energy")
    for attribute in TIMESTAMPS:
        del rerun.attrs[attribute], again.attrs[attribute]
    for name in again.variables:
        np.testing.assert_array_equal(rerun[name].values, again[name].values, err_msg=name)
    assert rerun.attrs["system_json"] == again.attrs["system_json"]
    assert rerun.attrs["motion_sha256"] == again.attrs["motion_sha256"]


CHECKS = (
    round_trip_is_identical,
    writing_does_not_change_dataset,
    file_has_expected_attributes,
    system_reproduces_the_run,
)


@pytest.mark.wide
def test_response_survives_netcdf_round_trip(subtests, scene, motion_name, response, tmp_path):
    before = response.copy(deep=True)
    known = {
        "scene": scene, "motion_name": motion_name, "response": response, "before": before,
        "again": through_file(response, tmp_path), "path": tmp_path / "response.nc",
    }  # fmt: skip
    for function in CHECKS:
        with subtests.test(function.__name__):
            function(**{name: known[name] for name in signature(function).parameters})


RESULTS = {
    "rest": lambda system: system.equilibrium(),
    "held": lambda system: system.moment_rotation(([-0.1, 0.0, 1e-3, 0.2], "rad")),
    "modes": lambda system: system.frequencies(),
}


@pytest.mark.parametrize("kind", RESULTS)
def test_static_results_survive_netcdf_and_rebuild_their_system(scene, kind, tmp_path):
    if kind == "modes" and scene.startswith("rigid"):
        pytest.skip("on rigid ground a block at rest has no modes")
    system = SCENES[scene]()
    answer = RESULTS[kind](system)
    again = through_file(answer, tmp_path)
    xr.testing.assert_identical(again, answer)
    rebuilt = rf.System.from_dataset(again)
    assert rebuilt.to_dict() == system.to_dict()
    assert RESULTS[kind](rebuilt).drop_attrs(deep=False).identical(answer.drop_attrs(deep=False))
    for name, row in answer.variables.items():
        assert row.attrs["long_name"], name
        assert ("units" in row.attrs) == ("flag_values" not in row.attrs), name
        assert "_FillValue" not in row.attrs, name
        if row.dtype.kind == "f":
            assert np.isfinite(row.values).all(), name
    assert answer.attrs["model"] == scene.split(",")[0]
    assert answer.attrs["Conventions"] == "CF-1.11"
    assert answer.attrs["model_description"] == system.describe()


@pytest.mark.parametrize("stiffness", [30, 100, 200])
def test_cascade_stores_record_for_any_stage_steps(stiffness, tmp_path):
    motion = rf.GroundMotion.from_arrays(
        (np.random.default_rng(4).normal(size=200), "m/s^2"), "0.02 s", name="noise"
    )
    system = rf.System(block(), pads(), cap(), soil(stiffness=f"{stiffness} MPa"),
                       coupling="cascade")  # fmt: skip
    response = system.simulate(motion)
    np.testing.assert_array_equal(response.time.values, np.arange(200) * 0.02)
    again = rf.System.from_dataset(through_file(response, tmp_path))
    assert again.motion is not None
    assert again.motion.sha256 == motion.sha256
    assert again.simulate().drop_attrs(deep=False).identical(response.drop_attrs(deep=False))


@pytest.mark.parametrize("coupling", ["coupled", "cascade"])
@pytest.mark.parametrize("rule", RULES)
def test_stack_with_odd_numbers_survives_netcdf(rule, coupling, tmp_path):
    system = rf.System(
        rf.Block(width="7.77 ft", height="29.1 ft", mass="33.3 t", shape_factor=2.87),
        rf.TwoSpringSupport(stiffness="9.87 kN/mm", damping="71.3 kN*s/m", restitution=0.71),
        rf.CushionCap(height="13 inch", density="151.3 lb/ft^3", depth="3.3 yd", width="9.9 ft"),
        rf.WinklerSoil.from_subgrade_modulus(
            "77 N/cm^3", depth="3.3 yd", damping_ratio=0.17, separation="pressure"
        ),
        restraint=rule,
        coupling=coupling,
        gravity="0.997 g_0",
    )
    initial = rf.InitialState(rotation="-1.1 deg", angular_velocity="0.7 deg/s")
    options = {"initial": initial, "duration": "1 s"}
    response = system.simulate(pulse(), **options)
    again = rf.System.from_dataset(through_file(response, tmp_path))
    assert again.assembly.to_dict() == system.assembly.to_dict()
    assert again.coupling == coupling
    rerun = again.simulate(**options)
    assert rerun.drop_attrs(deep=False).identical(response.drop_attrs(deep=False))


@pytest.mark.parametrize("rule", RULES)
@pytest.mark.parametrize("gravity", ["9.81 m/s^2", "0.1654 g_0"])
@pytest.mark.parametrize("motion", [pulse, record])
def test_options_and_odd_numbers_survive_netcdf(rule, gravity, motion, tmp_path):
    system = rf.System(
        rf.Block(width="7.77 ft", height="29.1 ft", mass="33.3 t", shape_factor=2.87),
        rf.TwoSpringSupport(stiffness="9.87 kN/mm", damping="71.3 kN*s/m", restitution=0.71),
        restraint=rule,
        rotation="finite",
        gravity=gravity,
    )
    initial = rf.InitialState(rotation="-1.1 deg", angular_velocity="0.7 deg/s")
    options = {"initial": initial, "duration": "2.5 s"}
    response = system.simulate(motion(), **options)
    again = rf.System.from_dataset(through_file(response, tmp_path))
    assert again.assembly.to_dict() == system.assembly.to_dict()
    assert again.options.gravity == system.options.gravity
    rerun = again.simulate(**options)
    assert rerun.drop_attrs(deep=False).identical(response.drop_attrs(deep=False))


def test_run_options_are_stored_in_file(tmp_path):
    initial = rf.InitialState(rotation="-1 deg")
    response = SCENES["two-spring, centre, finite"]().simulate(
        record(),
        duration="2.5 s",
        initial=initial,
        accuracy="fast",
        output_step="20 ms",
        outputs=["input_energy"],
        overturning="continue",
    )
    plan = json.loads(through_file(response, tmp_path).attrs["run_json"])
    assert plan["duration"] == "2.5 s"
    assert (
        rf.InitialState.from_dict(
            {key: value for key, value in plan["initial"].items() if key != "type"}
        )
        == initial
    )
    accuracy = rf.Accuracy(**plan["accuracy"])
    rerun = SCENES["two-spring, centre, finite"]().simulate(
        record(),
        duration=plan["duration"],
        initial=initial,
        accuracy=accuracy,
        output_step=plan["output_step"],
        outputs=plan["outputs"],
        overturning=plan["overturning"],
    )
    assert rerun.drop_attrs(deep=False).identical(response.drop_attrs(deep=False))


@pytest.mark.parametrize(
    "options",
    [
        {"outputs": None},
        {"output_step": "33 ms"},
    ],
)
def test_incomplete_record_in_result_warns_and_is_left_out(options, tmp_path):
    response = SCENES["rigid ground, finite"]().simulate(record(), **options)
    with pytest.warns(RecordWarning, match="the system comes without a motion"):
        system = rf.System.from_dataset(through_file(response, tmp_path))
    assert system.motion is None
    assert system.to_dict() == SCENES["rigid ground, finite"]().to_dict()


def test_run_shorter_than_record_stores_whole_record(tmp_path):
    response = SCENES["rigid ground, finite"]().simulate(record(), duration="0.5 s")
    system = rf.System.from_dataset(through_file(response, tmp_path))
    assert system.motion is not None
    assert system.motion.sha256 == record().sha256


def test_pulse_is_stored_without_histories(tmp_path):
    response = SCENES["rigid ground, finite"]().simulate(pulse(), outputs=None)
    system = rf.System.from_dataset(through_file(response, tmp_path))
    assert system.motion is not None
    assert system.motion.sha256 == pulse().sha256


def test_motion_among_parts_is_used_and_stored(tmp_path):
    motion = pulse()
    system = rf.System(motion, pads(), block())
    apart = rf.System(block(), pads())
    one, other = system.simulate(), apart.simulate(motion)
    assert one.drop_attrs(deep=False).identical(other.drop_attrs(deep=False))
    again = rf.System.from_dataset(through_file(one, tmp_path))
    assert again.motion is not None
    assert again.motion.sha256 == motion.sha256


def test_a_run_without_events_survives_the_file(tmp_path):
    response = SCENES["two-spring, centre, small"]().simulate(duration="0.1 s")
    assert response.sizes["event"] == 0
    xr.testing.assert_identical(through_file(response, tmp_path), response)


def test_an_overturned_run_survives_the_file(tmp_path):
    motion = rf.GroundMotion.sine_pulse("-9 m/s^2", "0.5 Hz")
    response = SCENES["two-spring, centre, small"]().simulate(motion)
    assert response.attrs["overturned"] == 1
    again = through_file(response, tmp_path)
    xr.testing.assert_identical(again, response)
    assert again.attrs["overturning_time"] == response.overturning_time.item()
    assert again.attrs["overturned"] == 1


def damaged(**changed):
    response = SCENES["rigid ground, finite"]().simulate(record(), duration="1.8 s")
    response.attrs.update(changed)
    return response


NO_SYSTEM = r"^the dataset's attribute 'system_json' does not describe a system: "
NO_MOTION = r"^the dataset's attributes 'motion...' do not describe a motion: "


@pytest.mark.parametrize(
    "text",
    [
        "",
        "nonsense",
        "[]",
        "3",
        "null",
        "{}",
        '{"parts": []}',
        '{"parts": 3}',
        '{"parts": [3]}',
        '{"parts": [{"type": "Brick"}]}',
        '{"parts": [{"type": "Block", "width": "2 m"}]}',
        '{"parts": [{"type": "Block", "width": "2 m", "height": "8 m", "mass": "1 t", "x": 1}]}',
        '{"parts": [{"type": "Block", "width": "2 m", "height": "8 m", "mass": "1 t"}], "x": 1}',
        '{"parts": [{"type": "Block", "width": "2 m", "height": "8 m", "mass": 5}]}',
        '{"parts": [{"type": "Block", "width": "2 m", "height": "8 m", "mass": "1 t"}], '
        '"gravity": 9.81}',
    ],
)
def test_a_damaged_description_of_the_system_is_refused(text):
    with pytest.raises(SchemaError, match=NO_SYSTEM):
        rf.System.from_dataset(damaged(system_json=text))


@pytest.mark.parametrize(
    "changed",
    [
        {"motion_json": "nonsense"},
        {"motion_json": "[]"},
        {"motion_json": "3"},
        {"motion_json": '{"constructor": "eval"}'},
        {"motion_json": '{"constructor": "sine_pulse", "wrong": 1}'},
        {"motion_time_step": "nonsense"},
        {"motion_samples": "nonsense"},
    ],
)
def test_a_damaged_description_of_the_motion_is_refused(changed):
    with pytest.raises(SchemaError, match=NO_MOTION):
        rf.System.from_dataset(damaged(**changed))


@pytest.mark.parametrize("name", ["motion_time_step", "motion_samples", "motion_sha256", "motion"])
def test_missing_motion_attribute_does_not_crash(name):
    response = damaged()
    del response.attrs[name]
    with pytest.raises(SchemaError, match=f"{NO_MOTION}there is no '{name}'"):
        rf.System.from_dataset(response)


def test_changed_samples_are_not_accepted_as_record():
    response = damaged()
    response.ground_acceleration.values[17] *= 1.0 + 1e-12
    with pytest.warns(RecordWarning, match="is not what the run had; the system comes without"):
        assert rf.System.from_dataset(response).motion is None


@pytest.mark.parametrize(
    ("change", "reason"),
    [
        (lambda response: response.isel(time=slice(None, None, 2)), "are not the motion's samples"),
        (lambda response: response.isel(time=slice(3, None)), "are not the motion's samples"),
        (lambda response: response.isel(time=slice(0, 20)), "end before the motion"),
        (lambda response: response.drop_vars("ground_acceleration"), "no history of the ground"),
        (lambda response: response.drop_dims("time"), "no history of the ground"),
    ],
)
def test_missing_samples_warn(change, reason):
    with pytest.warns(RecordWarning, match=reason) as caught:
        assert rf.System.from_dataset(change(damaged())).motion is None
    assert caught[0].filename == __file__


def test_a_foreign_dataset_is_refused():
    with pytest.raises(SchemaError, match="system_json"):
        rf.System.from_dataset(xr.Dataset({"rotation": ("time", [0.0, 1.0])}))
