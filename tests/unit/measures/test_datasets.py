"""Datasets of results: names, units, descriptions, files."""

import math
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

import rockframe as rf
from rockframe.measures import (
    fourier_spectrum,
    intensity_measures,
    response_spectrum,
    velocity_and_displacement,
)
from rockframe.results.schema import SCHEMA

BLOCK = rf.Block(width="1 m", height="4 m", mass="1 t")
GUIDE = Path(__file__).resolve().parents[3] / "docs" / "guide" / "intensity_measures.md"
ANSWERS = {
    "measures": lambda motion: intensity_measures(motion, block=BLOCK),
    "path": velocity_and_displacement,
    "vertical path": lambda motion: velocity_and_displacement(motion, component="vertical"),
    "response": lambda motion: response_spectrum(motion, (["0", "0.5"], "s"), (0.02, 0.05)),
    "fourier": fourier_spectrum,
}
AXES = {"response": ["damping_ratio", "period"], "fourier": ["frequency"]}


@pytest.fixture(scope="module")
def motion():
    rng = np.random.default_rng(7)
    across, upwards = (np.convolve(rng.normal(size=300), np.ones(5)) for _ in range(2))
    return rf.GroundMotion.from_arrays(
        (across, "m/s^2"), "0.02 s", vertical=(upwards, "m/s^2"), name="noise"
    )


@pytest.fixture(params=ANSWERS)
def answer(request, motion):
    return request.param, ANSWERS[request.param](motion)


def test_variables_follow_schema(answer):
    kind, dataset = answer
    for name, variable in dataset.data_vars.items():
        row = SCHEMA[name]
        assert variable.dims == row.dims
        assert variable.dtype == np.float64
        assert variable.attrs == row.attributes()
        assert np.isfinite(variable.values).all()
    assert list(dataset.coords) == AXES.get(kind, ["time"] if "path" in kind else [])
    for name, axis in dataset.coords.items():
        assert axis.dims == (name,)
        assert axis.attrs["units"] == SCHEMA[name].attributes()["units"]
        assert axis.attrs["long_name"]


def test_attributes_name_motion_and_references(answer, motion):
    _, dataset = answer
    assert dataset.attrs["Conventions"] == "CF-1.11"
    assert dataset.attrs["motion"] == "noise"
    assert dataset.attrs["motion_sha256"] == motion.sha256
    assert dataset.attrs["component"] in ("horizontal", "vertical")
    assert "Nigam and Jennings" in dataset.attrs["references"]
    assert all(isinstance(value, str | int | float) for value in dataset.attrs.values())


def test_dataset_survives_netcdf_round_trip(answer, tmp_path):
    _, dataset = answer
    dataset.to_netcdf(tmp_path / "answer.nc")
    with xr.open_dataset(tmp_path / "answer.nc") as stored:
        xr.testing.assert_identical(stored.load(), dataset)
        for name in dataset.coords:
            assert "_FillValue" not in stored[name].encoding


def test_changing_dataset_does_not_change_motion(motion):
    path = velocity_and_displacement(motion)
    path.ground_acceleration[:] = 0.0
    assert np.abs(motion.si.horizontal.samples).max() > 0.0


def test_guide_documents_every_variable():
    text = GUIDE.read_text(encoding="utf-8")
    motion = rf.GroundMotion.sine_pulse().with_vertical(rf.GroundMotion.sine_pulse())
    for make in ANSWERS.values():
        dataset = make(motion)
        for name in (*dataset.data_vars, *dataset.coords):
            assert f"`{name}`" in text, name


def test_block_measures_require_block(motion):
    plain, with_block = intensity_measures(motion), intensity_measures(motion, block=BLOCK)
    assert set(plain.data_vars) < set(with_block.data_vars)
    assert "block" not in plain.attrs
    for name in plain.data_vars:
        assert plain[name].item() == with_block[name].item()
    assert with_block.overturning_angle.item() == math.atan(0.25)


def test_frame_is_accepted_as_block(motion):
    frame = rf.FrameEquivalent(width="4 m", height="18 m", mass="99 t", shape_factor=1.4)
    measures = intensity_measures(motion, block=frame)
    p = math.sqrt(1.4 / 2.4 * 9.80665 / math.hypot(2.0, 9.0))
    assert measures.relative_peak_ground_velocity.item() == pytest.approx(
        p * measures.peak_ground_velocity.item() / (9.80665 * 4.0 / 18.0)
    )


def test_measures_of_still_ground_are_zero_or_nan():
    at_rest = rf.GroundMotion.from_arrays((np.zeros(100), "m/s^2"), "0.01 s")
    measures = intensity_measures(at_rest, block=BLOCK)
    undefined = {"mean_period", "predominant_velocity_period", "relative_predominant_frequency"}
    of_the_block = {"overturning_angle", "uplift_acceleration"}
    for name, value in measures.data_vars.items():
        if name in undefined:
            assert math.isnan(value.item()), name
        elif name not in of_the_block:
            assert value.item() == 0.0, name
    assert (response_spectrum(at_rest).spectral_displacement == 0.0).all()
    assert (fourier_spectrum(at_rest).fourier_amplitude == 0.0).all()


@pytest.mark.parametrize(("peak", "counts"), [(0.3, False), (0.5, True)])
def test_standardized_absolute_velocity_interpolates_start_of_second(peak, counts):
    """The second from 1 s on begins with two thirds of the peak at 0.9 s, its largest value."""
    samples = [0.0, 0.0, 0.0, peak, 0.0, 0.0, 0.0]
    motion = rf.GroundMotion.from_arrays((samples, "m/s^2"), "0.3 s")
    measures = intensity_measures(motion, gravity="10 m/s^2")  # threshold 0.25 m/s^2
    standard = measures.standardized_cumulative_absolute_velocity.item()
    total = measures.cumulative_absolute_velocity.item()
    assert total == pytest.approx(0.3 * peak)
    assert (standard == pytest.approx(total)) is counts


@pytest.mark.parametrize("count", range(2, 12))
def test_standardized_absolute_velocity_of_a_strong_motion_is_the_whole(count):
    motion = rf.GroundMotion.from_arrays((np.ones(count), "m/s^2"), "0.25 s")
    measures = intensity_measures(motion)
    for name in ("cumulative_absolute_velocity", "standardized_cumulative_absolute_velocity"):
        assert measures[name].item() == pytest.approx(0.25 * (count - 1)), name


def test_standardized_absolute_velocity_leaves_out_weak_seconds():
    samples = np.concatenate([np.full(110, 0.2), np.full(80, 1.0), np.full(161, 0.1)])
    motion = rf.GroundMotion.from_arrays((samples, "m/s^2"), "0.01 s")
    measures = intensity_measures(motion, gravity="10 m/s^2")  # threshold 0.25 m/s^2
    total = 0.01 * (samples.sum() - 0.5 * (samples[0] + samples[-1]))
    assert measures.cumulative_absolute_velocity.item() == pytest.approx(total)
    second = 0.01 * (samples[100:200].sum() + 0.5 * (samples[200] - samples[100]))
    assert measures.standardized_cumulative_absolute_velocity.item() == pytest.approx(second)


@pytest.mark.parametrize(
    ("samples", "expected"),
    [
        ([0.0, 0.0, 1.0, 0.0, 0.0], 0.5),  # a peak at a full second belongs to both sides
        ([0.0, 0.0, -1.0, -1.0], 0.75),  # the last second is not whole
        ([0.0, 0.2, 0.0, 1.0, 0.0], 0.5),  # the first second is below 0.025 g
        ([0.0, 0.2, 0.0, 0.2, 0.0], 0.0),
    ],
)
def test_standardized_absolute_velocity_by_hand(samples, expected):
    record = rf.GroundMotion.from_arrays((samples, "m/s^2"), "0.5 s")
    found = intensity_measures(record).standardized_cumulative_absolute_velocity
    assert float(found) == pytest.approx(expected, rel=1e-12)
