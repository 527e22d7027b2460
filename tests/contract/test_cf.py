"""Files of every kind of dataset follow CF-1.11 and can be read by other libraries.

The sections are those of the CF conventions. Files are read by netCDF4, independently of xarray,
and in the classic format by SciPy, independently of netCDF's library.
"""

import re
from inspect import signature

import cf_units
import cf_xarray  # noqa: F401
import netCDF4
import numpy as np
import pytest
import scipy.io
import xarray as xr
from contract.scenes import block, cap, pads, pulse, record, soil

import rockframe as rf

pytestmark = pytest.mark.contract

NOISE = rf.GroundMotion.from_arrays(
    (np.random.default_rng(4).normal(size=100), "m/s^2"), "0.02 s", name="noise"
)
ON_PADS = rf.System(block(), pads())
STACK = rf.System(block(), pads(), cap(), soil())
FALL = rf.GroundMotion.sine_pulse("-9 m/s^2", "0.5 Hz")
FRAME = rf.FrameEquivalent.from_members(
    storeys=3,
    height="9 m",
    width="4 m",
    column_width="0.25 m",
    beam_height="0.30 m",
    beam_width="0.25 m",
    density="2500 kg/m^3",
)
PAIR = {"one": NOISE, "other": NOISE.scaled(-0.5)}
TARGET = rf.TargetSpectrum.eurocode_8("0.1 g_0").with_deviation(0.5)
DATASETS = {
    "stack": lambda: STACK.simulate(record(), outputs="energy"),
    "still": lambda: ON_PADS.simulate(duration="0.1 s"),
    "overturned": lambda: ON_PADS.simulate(FALL),
    "certified": lambda: ON_PADS.simulate(pulse(), certify=rf.Certification(runs=60)),
    "joined": lambda: rf.concat([ON_PADS.simulate(motion) for motion in (pulse(), FALL)], "case"),
    "rest": STACK.equilibrium,
    "held": lambda: STACK.moment_rotation(([-0.1, 0.0, 0.2], "rad")),
    "modes": STACK.frequencies,
    "tradeoff": lambda: rf.tradeoff(ON_PADS, pulse(), accuracies="fast", repeats=1),
    "members": FRAME.members_table,
    "motion": NOISE.to_dataset,
    "pulse": lambda: pulse().to_dataset(),
    "measures": lambda: rf.intensity_measures(NOISE, block=block()),
    "path": lambda: rf.measures.velocity_and_displacement(NOISE),
    "response spectrum": lambda: rf.response_spectrum(NOISE, ["0.5 s", "1 s"]),
    "Fourier spectrum": lambda: rf.fourier_spectrum(NOISE),
    "spectra of several": lambda: rf.response_spectrum(PAIR, ["0.5 s", "1 s"]),
    "rotated spectra": lambda: rf.rotated_spectrum(rf.HorizontalPair(*PAIR.values()), ["1 s"]),
    "principal axes": lambda: rf.measures.principal_axes({"r": rf.HorizontalPair(*PAIR.values())}),
    "average": lambda: rf.average_spectral_acceleration(PAIR, ["0.5 s", "1 s"]),
    "suite": lambda: rf.MotionSuite(PAIR, verticals={"V": pulse()}).to_dataset(),
    "scaled": lambda: rf.MotionSuite(PAIR).scaling_to(TARGET),
    "selected": lambda: rf.MotionSuite(PAIR).selection_for(TARGET, 1, bounds=None),
}  # fmt: skip
TEXT_LABELS = {
    "tradeoff": {"model", "accuracy"},
    "members": {"member"},
    **{
        name: {"motion"}
        for name in (
            "spectra of several",
            "principal axes",
            "average",
            "suite",
            "scaled",
            "selected",
        )
    },
}
"""Words as labels of a dimension, which CF would have beside it (6.1), and xarray on it."""

CHECKS = []


def check(function):
    """Add a check of a rule of CF, by section."""
    CHECKS.append(function)
    return function


def attributes(variable):
    return {name: variable.getncattr(name) for name in variable.ncattrs()}


@check
def types_2_2(file):
    for name, variable in file.variables.items():
        if variable.dtype is not str:
            assert variable.dtype.kind in "if", name
            assert not variable.dtype.metadata, name


@check
def names_2_3(file):
    names = [*file.variables, *file.dimensions, *file.ncattrs()]
    for variable in file.variables.values():
        names += [name for name in variable.ncattrs() if name != "_FillValue"]
    assert all(re.fullmatch(r"[A-Za-z][A-Za-z0-9_]*", name) for name in names)
    assert len({name.lower() for name in file.variables}) == len(file.variables)


@check
def fill_values_2_5_1(file):
    for name, variable in file.variables.items():
        fill = attributes(variable).get("_FillValue")
        assert fill is None or np.asarray(fill).dtype == variable.dtype, name
        if name in file.dimensions and variable.dtype is not str:
            assert fill is None, name
            assert np.isfinite(variable[...]).all(), name


@check
def conventions_and_description_2_6(file):
    assert file.Conventions == "CF-1.11"
    for name in ("title", "history"):
        assert file.getncattr(name).strip()


@check
def units_3_1(file):
    for name, variable in file.variables.items():
        attrs = attributes(variable)
        labels = variable.dtype is str
        assert ("units" in attrs) == (not labels and "flag_values" not in attrs), name
        if "units" in attrs:
            assert not cf_units.Unit(attrs["units"]).is_unknown(), name


@check
def long_names_3_2_and_standard_names_3_3(file):
    for name, variable in file.variables.items():
        assert attributes(variable)["long_name"].strip(), name
        # the table of standard names has none for rocking motion
        assert "standard_name" not in variable.ncattrs(), name


@check
def flags_3_5(file):
    for name, variable in file.variables.items():
        attrs = attributes(variable)
        assert ("flag_values" in attrs) == ("flag_meanings" in attrs), name
        if "flag_values" not in attrs:
            assert "dtype" not in attrs, name  # a boolean needs its meanings
            continue
        values = np.atleast_1d(attrs["flag_values"])
        assert values.dtype == variable.dtype, name
        meanings = attrs["flag_meanings"].split(" ")
        assert len(set(meanings)) == len(set(values.tolist())) == len(values) == len(meanings)
        assert all(re.fullmatch(r"[A-Za-z0-9_.+@-]+", word) for word in meanings), name
        assert np.isin(variable[...], values).all(), name


@check
def time_elapsed_is_no_time_coordinate_4_4(file):
    """A time coordinate has a reference date in its units; elapsed time is not one."""
    for name, variable in file.variables.items():
        attrs = attributes(variable)
        assert " since " not in attrs.get("units", ""), name
        assert "axis" not in attrs, name
        assert "calendar" not in attrs, name
    if "time" in file.variables:
        assert file["time"].units == "s"


@check
def coordinates_1_3_and_5(kind, file):
    text = TEXT_LABELS.get(kind, set())
    for name in set(file.dimensions) & set(file.variables):
        variable = file[name]
        assert variable.dimensions == (name,), name
        assert (variable.dtype is str) == (name in text), name
        if variable.dtype is not str and len(variable) > 1:
            steps = np.diff(variable[...])
            assert (steps > 0.0).all() or (steps < 0.0).all(), name
    for name, variable in file.variables.items():
        auxiliary = attributes(variable).get("coordinates", "").split()
        assert set(auxiliary) <= set(file.variables), name
        for other in auxiliary:
            assert set(file[other].dimensions) <= set(variable.dimensions), name


@check
def scipy_reads_the_same(dataset, tmp_path):
    """SciPy reads the classic format, without strings and long integers."""
    path = tmp_path / "classic.nc"
    dataset.to_netcdf(path, format="NETCDF3_64BIT")
    with scipy.io.netcdf_file(path, mmap=False) as classic:
        assert classic.Conventions.decode() == "CF-1.11"
        for name, values in dataset.variables.items():
            if values.dtype.kind in "fib":
                found = classic.variables[name]
                np.testing.assert_array_equal(found[...], values.values, err_msg=name)
                if "flag_values" in values.attrs:
                    assert found.flag_values.dtype == found[...].dtype.newbyteorder("=")
    with xr.open_dataset(path, engine="scipy") as again:
        xr.testing.assert_equal(again.load(), dataset)
        for name, values in dataset.variables.items():
            if values.dtype == bool:
                assert again[name].dtype == bool, name


@check
def xarray_reads_the_same(dataset, tmp_path):
    """xarray also writes what it has read."""
    with xr.open_dataset(tmp_path / "given.nc") as again:
        xr.testing.assert_identical(again.load(), dataset)
        again.to_netcdf(tmp_path / "again.nc")
    with xr.open_dataset(tmp_path / "again.nc") as twice:
        xr.testing.assert_identical(twice.load(), dataset)


@pytest.mark.parametrize("kind", DATASETS)
def test_files_follow_cf_conventions(subtests, kind, tmp_path):
    dataset = DATASETS[kind]()
    dataset.to_netcdf(tmp_path / "given.nc")
    with netCDF4.Dataset(tmp_path / "given.nc") as file:
        known = {"kind": kind, "file": file, "dataset": dataset, "tmp_path": tmp_path}
        for function in CHECKS:
            with subtests.test(function.__name__):
                function(**{name: known[name] for name in signature(function).parameters})


def test_flags_read_as_booleans_and_as_words():
    response = ON_PADS.simulate(FALL)
    assert response.overturned.dtype == bool
    assert (response.overturned.cf == "true").item()
    assert not (response.overturned.cf == "false").item()
