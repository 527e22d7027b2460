"""The dataset of a sweep: labels, CF, netCDF, and the package's other functions on it."""

import os
import subprocess
import sys

import cf_units
import netCDF4
import numpy as np
import pytest
import xarray as xr

import rockframe as rf
from rockframe.results.schema import SCHEMA
from rockframe.simulation.soundness import STILL_MOVING

pytestmark = pytest.mark.filterwarnings("ignore::rockframe.errors.SolverWarning")

BLOCK = rf.Block(width="0.8 m", height="3.6 m", mass="4 t")
CAP = rf.CushionCap(height="0.5 m", mass="2 t", width="1 m")
PADS = rf.TwoSpringSupport(frequency_ratio=20, damping_ratio=0.1)
SYSTEM = rf.System(BLOCK, PADS, CAP, rf.WinklerSoil(stiffness="20 MPa", damping_ratio=0.2))
PULSE = rf.GroundMotion.sine_pulse("2 m/s^2", "1 Hz")
OTHER = rf.GroundMotion.half_sine_pulse("3 m/s^2", "0.5 s")
AXES = {
    "TwoSpringSupport.damping_ratio": [0.1, 0.2],
    "Block.width": ["0.8 m", "2 m"],  # wider than the cap: refused
    "restraint": ["centre", "contact-state"],
    "coupling": ["coupled", "cascade"],
}


@pytest.fixture(
    scope="module", params=["grid", "table", "histories", "no motion", "all refused", "whole"]
)
def runs(request):
    fast = {"accuracy": "fast", "duration": "2 s"}
    if request.param == "grid":
        return rf.sweep(SYSTEM, [PULSE, OTHER], axes=AXES, scale=[0.5, 1.0], **fast)
    if request.param == "table":
        table = {"Block.width": ["0.8 m", "2 m", "0.9 m"], "motion": [1, 0, 1]}
        return rf.sweep(SYSTEM, [PULSE, OTHER], cases=table, scale=[0.5, 1.0], **fast)
    if request.param == "histories":
        return rf.sweep(
            SYSTEM, PULSE, axes=AXES, outputs=("acceleration", "toe_pressure", "contact_state"),
            output_step="0.1 s", **fast,
        )  # fmt: skip
    if request.param == "no motion":
        lean = rf.InitialState(rotation="0.03 rad")
        return rf.sweep(rf.System(BLOCK), initial=lean, width=["0.7 m", "0.8 m"], **fast)
    if request.param == "all refused":
        return rf.sweep(SYSTEM, PULSE, axes={"Block.width": ["2 m", "3 m"]}, outputs=(), **fast)
    return rf.sweep(SYSTEM, PULSE, scale=np.linspace(0.5, 1.5, 4), **fast)


def test_sweep_survives_netcdf_round_trip(runs, tmp_path):
    runs.to_netcdf(tmp_path / "runs.nc")
    runs.to_netcdf(tmp_path / "again.nc")
    with xr.open_dataset(tmp_path / "runs.nc") as again:
        again.load()
    xr.testing.assert_identical(again, runs)
    for name, variable in runs.variables.items():
        kinds = [one.dtype.kind.replace("U", "O") for one in (again[name], variable)]
        assert kinds[0] == kinds[1], name
    assert rf.System.from_dataset(again).to_dict() == rf.System.from_dataset(runs).to_dict()


def test_labels_follow_schema_and_cf(runs, tmp_path):
    for name, variable in runs.variables.items():
        attributes = variable.attrs
        assert attributes["long_name"], name
        if name in SCHEMA and name in runs.data_vars:
            row = SCHEMA[name]
            expected = row.attributes()
            assert attributes["long_name"] == expected["long_name"]
            assert attributes.get("units") == expected.get("units")
            assert variable.dims == (*runs.status.dims, *row.dims)
            # cases without a result leave gaps
            gaps = variable.dtype.kind == "f" and np.isnan(variable.values).any()
            assert variable.dtype == (np.float64 if gaps else row.dtype), name
            if "flag_values" in expected:
                assert attributes["flag_values"].dtype == (
                    np.int8 if variable.dtype == bool else variable.dtype
                )
                assert attributes["flag_meanings"] == expected["flag_meanings"]
        if variable.dtype.kind == "f" and "flag_values" not in attributes:
            assert not cf_units.Unit(attributes["units"]).is_unknown()
    for value in runs.attrs.values():
        assert isinstance(value, str | int | float | np.number)
    assert runs.attrs["Conventions"] == "CF-1.11"
    path = tmp_path / "runs.nc"
    runs.to_netcdf(path)
    with netCDF4.Dataset(path) as file:
        for name in (*runs.coords, "status"):
            assert "_FillValue" not in file[name].ncattrs(), name


def test_every_case_has_status_and_message(runs):
    assert runs.status.dtype == np.int8
    messages = runs.message
    assert messages.dtype == object
    assert all(isinstance(text, str) and text for text in messages.values.ravel())
    assert messages.shape == runs.status.shape
    refused = runs.status == 6
    assert (~messages.isin(["none", STILL_MOVING]) == refused).all()
    finished = runs.peak_rotation.notnull()
    assert (finished == ~refused).all()
    assert runs.attrs["verdict"].startswith(f"Of all {runs.status.size} cases of the sweep ")


def test_table_and_concat_accept_sweep(runs):
    table = rf.table(runs)
    assert len(table) == runs.status.size
    assert set(table["status"]) <= set(SCHEMA["status"].attributes()["flag_meanings"].split())
    assert table["overturned"].notna().sum() == int(runs.peak_rotation.notnull().sum())
    joined = rf.concat([runs, runs], "repeat")
    xr.testing.assert_equal(joined.peak_rotation.isel(repeat=1), runs.peak_rotation)
    if "time" in runs.dims and len(runs.data_vars) > 20:
        histories = rf.table(runs, "histories")
        assert len(histories) == runs.status.size * runs.time.size - histories_missing(runs)


def histories_missing(runs):
    """Count the times at which no history has a value."""
    names = [n for n, v in runs.data_vars.items() if "time" in v.dims]
    empty = runs[names].to_array().isnull().all("variable")
    return int(empty.sum())


@pytest.mark.long  # test_imports.py covers runs in the caller without tqdm
def test_sweep_runs_without_tqdm_and_dask():
    code = """
import sys
for name in ("tqdm", "distributed", "dask"):
    sys.modules[name] = None
import rockframe as rf
system = rf.System(rf.Block(width="0.8 m", height="3.6 m", mass="4 t"))
runs = rf.sweep(system, rf.GroundMotion.sine_pulse("2 m/s^2", "1 Hz"), scale=[0.5, 1.0])
assert runs.peak_rotation.notnull().all()
"""
    done = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, timeout=240,
        env=os.environ | {"ROCKFRAME_COMPILE": "0"},
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
