"""Motions stored by this package survive the round trip; damaged files are refused."""

import json
import pickle

import netCDF4
import numpy as np
import pytest
import xarray as xr
from unit.motion.binary_samples import netcdf
from unit.motion.format_samples import SAMPLES
from unit.motion.motion_files import check_same

import rockframe as rf
from rockframe.errors import RecordError, SchemaError
from rockframe.motion import GroundMotion

RNG = np.random.default_rng(5)


def record(folder):
    sample = SAMPLES["cwa pair"]
    motion = GroundMotion.read(sample.write(folder), component=sample.component)
    return motion.window("0.1 s", "1 s").scaled(1.5)


def arrays(folder):
    return GroundMotion.from_arrays((RNG.normal(size=101), "m/s^2"), "0.0051 s", name="plain ü")


def pulse(folder):
    return GroundMotion.sine_pulse("0.3 g_0", "1.7 Hz", 1.3)


def pulses(folder):
    return pulse(folder).with_vertical(pulse(folder).scaled(0.5)).window("0.1 s", "0.6 s")


@pytest.mark.parametrize("make", [record, arrays, pulse, pulses])
@pytest.mark.parametrize("format_name", ["NETCDF4", "NETCDF3_64BIT", "NETCDF3_CLASSIC"])
def test_motion_survives_netcdf_round_trip(make, format_name, tmp_path):
    motion = make(tmp_path)
    path = tmp_path / "stored.nc"
    motion.to_dataset().to_netcdf(path, engine="netcdf4", format=format_name)
    check_same(GroundMotion.read(path), motion)


def test_compression_makes_no_difference(tmp_path):
    motion = arrays(tmp_path)
    path = tmp_path / "stored.nc"
    motion.to_dataset().to_netcdf(path, encoding={"acceleration": {"zlib": True}})
    assert GroundMotion.read(path) == motion


@pytest.mark.parametrize("component", ["E", "090"])
def test_component_must_match_stored_one(component, tmp_path):
    path = tmp_path / "stored.nc"
    motion = record(tmp_path)
    motion.to_dataset().to_netcdf(path)
    assert GroundMotion.read(path, component=component) == motion
    assert GroundMotion.read(path, component=("E", "U")) == motion
    with pytest.raises(RecordError, match="expected the component 'N'"):
        GroundMotion.read(path, component="N")


def test_unit_and_time_step_must_match_stored_ones(tmp_path):
    path = tmp_path / "stored.nc"
    motion = arrays(tmp_path)
    motion.to_dataset().to_netcdf(path)
    assert GroundMotion.read(path, unit="m/s^2", time_step="5.1 ms") == motion
    with pytest.raises(RecordError, match=r"in m/s\^2; expected accelerations in the unit 'g'"):
        GroundMotion.read(path, unit="g")
    with pytest.raises(RecordError, match="given by the argument time_step"):
        GroundMotion.read(path, time_step="5 ms")


def changed(**attributes):
    def change(dataset):
        dataset.attrs.update(attributes)
        return dataset

    return change


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda dataset: dataset.drop_vars("acceleration"), "no variable 'acceleration'"),
        (lambda dataset: dataset * 2.0, "units None|differ from those"),
        (changed(time_step="soon"), "holds no ground motion"),
        (changed(time_step=-1.0), "holds no ground motion"),
        (changed(motion_sha256="0"), "differ from those"),
        (changed(metadata="["), "not JSON"),
        (changed(metadata="[" * 100_000), "cannot be read"),
        (changed(metadata='["a"]'), "not a JSON object"),
        (changed(metadata=json.dumps({"a": [1]})), r"metadata 'a' of the motion, \[1\]"),
        (changed(metadata='{"a": NaN}'), "metadata 'a' of the motion, nan"),
        (changed(metadata='{"a": true}'), "metadata 'a' of the motion, True"),
    ],
)
def test_invalid_stored_motion_is_refused(change, words, tmp_path):
    path = tmp_path / "stored.nc"
    change(arrays(tmp_path).to_dataset()).to_netcdf(path)
    with pytest.raises(RecordError, match=words):
        GroundMotion.read(path)


def test_simulation_result_is_refused_with_advice(tmp_path):
    block = rf.Block(width="2 m", height="8 m", mass="40 t")
    excitation = pulse(tmp_path)
    response = rf.System(block).simulate(excitation, duration="0.1 s")
    response.to_netcdf(tmp_path / "run.nc")
    words = (
        r"run\.nc: found the result of a system; expected [^;]*; [^;]*from_dataset\(.*\)\.motion"
    )
    with pytest.raises(RecordError, match=words + "$"):
        GroundMotion.read(tmp_path / "run.nc")
    with pytest.raises(SchemaError, match="found the result of a system"):
        GroundMotion.from_dataset(response)
    assert rf.System.from_dataset(response).motion == excitation


def test_error_message_is_not_repeated_and_survives_pickling(tmp_path):
    path = tmp_path / "stored.nc"
    arrays(tmp_path).to_dataset().drop_vars("acceleration").to_netcdf(path)
    with pytest.raises(RecordError) as caught:
        GroundMotion.read(path)
    message = str(caught.value).removeprefix(str(path))
    assert message.count("found") == message.count("expected") == 1
    with pytest.raises(SchemaError) as plain:
        GroundMotion.from_dataset(xr.Dataset())
    assert str(pickle.loads(pickle.dumps(plain.value))) == str(plain.value)  # noqa: S301


def test_a_file_that_declares_more_than_it_holds_is_not_loaded(tmp_path):
    path = tmp_path / "huge.nc"
    with netCDF4.Dataset(path, "w") as file:
        file.createDimension("time", 10**12)
        for name in ("time", "acceleration"):
            variable = file.createVariable(name, "f8", ("time",), chunksizes=(1000,))
            variable.units = "s" if name == "time" else "m s^-2"
    assert path.stat().st_size < 100_000
    with pytest.raises(RecordError, match="2000000000000 numbers declared"):
        GroundMotion.read(path)


def test_strings_are_no_accelerations(tmp_path):
    path = tmp_path / "strings.nc"
    with netCDF4.Dataset(path, "w") as file:
        file.createDimension("time", 10**6)
        for name in ("time", "acceleration"):
            file.createVariable(name, str, ("time",), chunksizes=(1000,))
    with pytest.raises(RecordError, match="a variable 'time' without numbers"):
        GroundMotion.read(path)


def test_a_file_of_many_variables_is_no_motion(tmp_path):
    path = tmp_path / "many.nc"
    motion = arrays(tmp_path).to_dataset()
    motion.assign({f"v{k}": 0.0 for k in range(101)}).to_netcdf(path)
    with pytest.raises(RecordError, match="found 103 variables"):
        GroundMotion.read(path)


@pytest.mark.parametrize("share", [0.01, 0.3, 0.6, 0.95])
def test_a_part_of_a_file_is_refused(share, tmp_path):
    data = netcdf(tmp_path)
    path = tmp_path / "part.nc"
    path.write_bytes(data[: int(share * len(data))])
    with pytest.raises(RecordError):
        GroundMotion.read(path)


def test_other_netcdf_files_are_refused(tmp_path):
    path = tmp_path / "other.nc"
    xr.Dataset({"temperature": ("x", [1.0, 2.0])}).to_netcdf(path)
    with pytest.raises(RecordError, match="no variable 'acceleration'"):
        GroundMotion.read(path)


def test_suite_file_is_refused_with_advice(tmp_path):
    path = tmp_path / "suite.nc"
    suite = rf.MotionSuite({name: arrays(tmp_path) for name in ("one", "two")})
    suite.to_dataset().to_netcdf(path)
    with pytest.raises(RecordError, match=r"a suite of motions.*read_suite"):
        GroundMotion.read(path)
    assert list(rf.read_suite(path)) == ["one", "two"]


def test_text_is_no_netcdf(write):
    with pytest.raises(RecordError, match=r"begins with b'time,a'"):
        GroundMotion.read(write("time,a", "r.nc"), format="netcdf")
