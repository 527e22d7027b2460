"""Round trips through datasets, in memory and in files, preserve every bit."""

import json

import cf_units
import numpy as np
import pytest
import xarray as xr
from unit.motion.motion_files import at2, check_same, numbers

from rockframe.errors import SchemaError
from rockframe.motion import GroundMotion

RNG = np.random.default_rng(3)


def plain():
    return GroundMotion.from_arrays((RNG.normal(size=101), "g_0"), "0.0051 s", name="plain ü")


def with_vertical():
    up = (RNG.normal(size=101), "m/s^2")
    return GroundMotion.from_arrays((RNG.normal(size=101), "m/s^2"), "5 ms", up).scaled(0.3)


def pulse():
    return GroundMotion.sine_pulse("0.3 g_0", "1.7 Hz", 1.3)


def two_pulses():
    return pulse().with_vertical(pulse().scaled(0.5)).window("0.1 s", "0.6 s")


@pytest.fixture(params=[plain, with_vertical, pulse, two_pulses])
def motion(request):
    return request.param()


def test_motion_survives_dataset_round_trip(motion):
    check_same(GroundMotion.from_dataset(motion.to_dataset()), motion)


@pytest.mark.parametrize("format_name", ["NETCDF4", "NETCDF3_64BIT"])
def test_motion_survives_netcdf_round_trip(motion, tmp_path, format_name):
    path = tmp_path / "motion.nc"
    motion.to_dataset().to_netcdf(path, engine="netcdf4", format=format_name)
    with xr.open_dataset(path, engine="netcdf4") as stored:
        check_same(GroundMotion.from_dataset(stored), motion)
        assert "_FillValue" not in stored["time"].encoding
        assert stored["time"].dtype == np.float64


def test_record_survives_netcdf_round_trip(write, tmp_path):
    read = GroundMotion.read(write(at2("NPTS= 30, DT= .005 SEC", numbers(30))))
    path = tmp_path / "motion.nc"
    read.to_dataset().to_netcdf(path)
    with xr.open_dataset(path) as stored:
        found = GroundMotion.from_dataset(stored)
    check_same(found, read)
    assert found.metadata["component"] == "67"


def test_layout(motion):
    dataset = motion.to_dataset()
    assert dataset["acceleration"].dims == ("time",)
    assert dataset["acceleration"].values.tolist() == motion.si.horizontal.samples.tolist()
    assert ("vertical_acceleration" in dataset) == (motion.si.vertical is not None)
    assert dataset["time"].attrs["units"] == "s"
    assert dataset["time"].values[-1] == motion.si.duration
    assert np.all(np.diff(dataset["time"].values) > 0.0)
    for name in dataset.variables:
        attributes = dataset[name].attrs
        assert dataset[name].dtype == np.float64
        assert attributes["long_name"]
        assert cf_units.Unit(attributes["units"]).is_convertible("s" if name == "time" else "m s-2")
        assert dataset[name].encoding["_FillValue"] is None
    assert all(isinstance(value, str | int | float) for value in dataset.attrs.values())
    assert dataset.attrs["Conventions"] == "CF-1.11"
    assert json.loads(dataset.attrs["metadata"]) == dict(motion.metadata)


def test_changing_the_dataset_leaves_the_motion_alone():
    motion = plain()
    digest = motion.sha256
    dataset = motion.to_dataset()
    dataset["acceleration"].values[:] = 0.0
    assert motion.si.digest == digest


def test_polynomials_without_samples_are_refused():
    dataset = two_pulses().to_dataset().drop_vars("vertical_acceleration")
    with pytest.raises(SchemaError, match="vertical_pieces without vertical samples"):
        GroundMotion.from_dataset(dataset)


def test_changed_samples_are_noticed():
    dataset = plain().to_dataset()
    dataset["acceleration"].values[3] += 1.0
    with pytest.raises(SchemaError, match="motion_sha256"):
        GroundMotion.from_dataset(dataset)


def test_samples_changed_without_digest_lose_constructor():
    dataset = pulse().to_dataset()
    dataset["acceleration_pieces"].values[:] = 0.0
    del dataset.attrs["motion_sha256"]
    assert GroundMotion.from_dataset(dataset).to_dict()["constructor"] is None


def test_dataset_with_only_samples_and_time_is_accepted():
    acceleration = ("time", [0.0, 1.0, 2.0], {"units": "m s^-2"})
    dataset = xr.Dataset({"acceleration": acceleration}, coords={"time": [0.0, 0.02, 0.04]})
    motion = GroundMotion.from_dataset(dataset)
    assert motion.si.time_step == pytest.approx(0.02)
    assert motion.si.horizontal.samples.tolist() == [0.0, 1.0, 2.0]
    assert motion.name == "unnamed motion"


@pytest.mark.parametrize(
    ("damage", "words"),
    [
        (lambda d: d.drop_vars("acceleration"), "no variable 'acceleration'"),
        (lambda d: d.drop_vars("time"), "no variable 'time'"),
        (lambda d: d.isel(time=[0]), "two samples"),
        (lambda d: d.assign_attrs(time_step=-1.0), "time_step"),
        (lambda d: d.assign_attrs(time_step="often"), "holds no ground motion"),
        (lambda d: d.assign_attrs(metadata="{"), "'metadata' that is not JSON"),
        (lambda d: d.assign_attrs(metadata="[1]"), "not a JSON object"),
        (lambda d: d.assign(acceleration=d["acceleration"] * np.nan), "units|finite"),
        (lambda d: d.assign(acceleration=d["acceleration"].assign_attrs(units="g")), "units 'g'"),
        (lambda d: d.assign(acceleration_pieces=(("a", "b"), np.zeros((2, 2)))), "units None"),
    ],
)
def test_invalid_datasets_are_refused(damage, words):
    with pytest.raises(SchemaError, match=words):
        GroundMotion.from_dataset(damage(plain().to_dataset()))


@pytest.mark.parametrize(
    "change",
    [
        lambda d: d.isel(time=slice(None, None, 2)),
        lambda d: d.isel(time=slice(None, None, -1)),
        lambda d: d.drop_isel(time=[5, 6]),
        lambda d: d.interp(time=d["time"].values[:-1] + 0.3 * np.arange(len(d.time) - 1) * 1e-3),
    ],
    ids=["thinned", "reversed", "gap", "interpolated"],
)
def test_times_that_contradict_the_time_step_are_refused(change):
    changed = change(plain().to_dataset())
    del changed.attrs["motion_sha256"]
    with pytest.raises(SchemaError, match="step of the attribute 'time_step'"):
        GroundMotion.from_dataset(changed)


def test_the_step_of_changed_times_replaces_the_time_step():
    thinned = plain().to_dataset().isel(time=slice(None, None, 2))
    for name in ("motion_sha256", "time_step"):
        del thinned.attrs[name]
    motion = GroundMotion.from_dataset(thinned)
    assert motion.si.time_step == pytest.approx(2.0 * plain().si.time_step)


def test_times_in_single_precision_or_as_time_differences_are_read():
    motion = plain()
    dataset = motion.to_dataset()
    single = dataset.assign_coords(time=dataset["time"].astype(np.float32) + 100)
    differences = (dataset["time"].values * 1e9).round().astype("m8[ns]")
    for changed in (single, dataset.assign_coords(time=differences)):
        assert GroundMotion.from_dataset(changed) == motion


def test_uneven_time_axis_is_refused():
    acceleration = ("time", [0.0, 1.0, 2.0], {"units": "m s^-2"})
    dataset = xr.Dataset({"acceleration": acceleration}, coords={"time": [0.0, 0.02, 0.05]})
    with pytest.raises(SchemaError, match="uneven time axis"):
        GroundMotion.from_dataset(dataset)
