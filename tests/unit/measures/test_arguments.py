"""Valid and invalid arguments of the functions for measures."""

import warnings

import numpy as np
import pint
import pytest

import rockframe as rf
from rockframe.errors import ComponentError, RecordWarning, UnitsError
from rockframe.measures import (
    fourier_spectrum,
    intensity_measures,
    response_spectrum,
    velocity_and_displacement,
)

ALL = (intensity_measures, response_spectrum, fourier_spectrum, velocity_and_displacement)
PULSE = rf.GroundMotion.sine_pulse("1 m/s^2", "1 Hz")
BLOCK = rf.Block(width="1 m", height="4 m", mass="1 t")
PAIR = rf.HorizontalPair(PULSE, PULSE.scaled(0.5))


@pytest.mark.parametrize("function", ALL)
@pytest.mark.parametrize("argument", [None, 3.0, "record.AT2", np.zeros(5), BLOCK])
def test_only_a_motion_is_measured(function, argument):
    with pytest.raises(ComponentError, match=rf"{function.__name__}: motion needs a Ground"):
        function(argument)


@pytest.mark.parametrize("function", ALL)
def test_missing_or_unknown_component_raises(function):
    with pytest.raises(ComponentError, match="has no vertical acceleration"):
        function(PULSE, component="vertical")
    with pytest.raises(ComponentError, match="'horizontal' or 'vertical', got 'up'"):
        function(PULSE, component="up")


@pytest.mark.parametrize("function", ALL)
def test_the_vertical_component_is_measured_like_the_horizontal_one(function):
    rng = np.random.default_rng(3)
    across, upwards = (np.convolve(rng.normal(size=200), np.ones(5)) for _ in range(2))
    both = rf.GroundMotion.from_arrays(
        (across, "m/s^2"), "0.02 s", vertical=(upwards, "m/s^2"), name="both"
    )
    alone = rf.GroundMotion.from_arrays((upwards, "m/s^2"), "0.02 s")
    result, expected = function(both, component="vertical"), function(alone)
    assert result.attrs["component"] == "vertical"
    assert result.attrs["motion"] == "both"
    for name in expected.data_vars:
        key = name if name in result else f"vertical_{name}"
        np.testing.assert_array_equal(result[key].values, expected[name].values)


TWICE = {1: PULSE, "1": PULSE.scaled(2.0)}


@pytest.mark.parametrize(
    "measured",
    [
        lambda: intensity_measures(TWICE),
        lambda: response_spectrum(TWICE),
        lambda: rf.average_spectral_acceleration(TWICE, ["1 s"]),
        lambda: rf.rotated_spectrum({1: PAIR, "1": PAIR}),
        lambda: rf.measures.principal_axes({1: PAIR, "1": PAIR}),
        lambda: rf.codes.asce_7_22(BLOCK, TWICE, spectral_acceleration=1.0),
        lambda: rf.codes.circolare_2019(BLOCK, TWICE),
    ],
)
def test_labels_that_are_one_text_raise(measured):
    with pytest.raises(ComponentError, match="two entries are called '1'"):
        measured()


@pytest.mark.parametrize(
    ("motion", "arguments", "error", "words"),
    [
        (PULSE, {"damping_ratio": (0.02, 0.05)}, UnitsError, "damping_ratio needs a pure ratio"),
        (PAIR, {"damping_ratio": [0.02, 0.05]}, UnitsError, "damping_ratio needs a pure ratio"),
        (PULSE, {"damping_ratio": 1.01}, ComponentError, "damping_ratio must be from 0 to 1"),
        (PAIR, {"component": "vertical"}, ComponentError, "give its motion pair.vertical"),
        (PAIR, {"component": "up"}, ComponentError, "'horizontal' or 'vertical', got 'up'"),
    ],
)
def test_an_average_is_of_one_damping_ratio_and_one_component(motion, arguments, error, words):
    with pytest.raises(error, match=words):
        rf.average_spectral_acceleration(motion, ["0.5 s", "1 s"], **arguments)


@pytest.mark.parametrize(
    ("argument", "value"),
    [
        ("periods", [0.1, 0.2]),
        ("periods", np.linspace(0.1, 1.0, 4)),
        ("periods", 1.0),
        ("periods", ["0.1 s", "1 m"]),
        ("periods", ([0.1, 0.2], "Hz")),
        ("damping_ratios", "2 m"),
        ("damping_ratios", None),
    ],
)
def test_spectra_refuse_wrong_units(argument, value):
    with pytest.raises(UnitsError, match=f"response_spectrum: {argument}"):
        response_spectrum(PULSE, **{argument: value})


@pytest.mark.parametrize(
    ("argument", "value"),
    [
        ("periods", ([0.2, 0.1], "s")),
        ("periods", ([0.1, 0.1], "s")),
        ("periods", ([-0.1, 0.1], "s")),
        ("periods", ([], "s")),
        ("periods", (["nan", 0.1], "s")),
        ("damping_ratios", -0.01),
        ("damping_ratios", 1.01),
        ("damping_ratios", (0.05, 0.05)),
        ("damping_ratios", ()),
    ],
)
def test_spectra_refuse_values_out_of_range(argument, value):
    with pytest.raises(ComponentError, match=f"response_spectrum: {argument}"):
        response_spectrum(PULSE, **{argument: value})


def test_spectra_that_would_take_minutes_are_refused():
    with pytest.raises(ComponentError, match=r"need .* steps .* give fewer or longer periods"):
        response_spectrum(PULSE, ["1e-9 s"])
    slow = rf.GroundMotion.sine_pulse("1 m/s^2", "1e-9 Hz")
    with pytest.raises(ComponentError, match="intensity_measures"):
        intensity_measures(slow)
    assert response_spectrum(slow, "0 s").sizes == {"damping_ratio": 1, "period": 1}


def test_periods_and_damping_accept_equivalent_forms():
    expected = response_spectrum(PULSE, (["0.1", "0.5"], "s"), (0.05, 0.1))
    registry = pint.get_application_registry()
    for periods, ratios in (
        (["100 ms", "0.5 s"], ["5 %", 0.1]),
        (registry.Quantity([100.0, 500.0], "ms"), np.array([0.05, 0.1])),
        (([100, 500], "ms"), [registry.Quantity(5.0, "percent"), "10 %"]),
    ):
        spectra = response_spectrum(PULSE, periods, ratios)
        np.testing.assert_allclose(spectra.period, [0.1, 0.5], rtol=1e-15)
        np.testing.assert_allclose(spectra.damping_ratio, [0.05, 0.1], rtol=1e-15)
        np.testing.assert_allclose(
            spectra.spectral_displacement, expected.spectral_displacement, rtol=1e-12
        )


def test_default_periods():
    period = response_spectrum(PULSE).period.values
    assert period.size == 301
    assert period[0] == 0.01
    assert period[200] == 1.0
    assert period[-1] == 10.0


@pytest.mark.parametrize(
    ("argument", "value", "error"),
    [
        ("threshold", 0.05, UnitsError),
        ("threshold", "0.05 kg", UnitsError),
        ("threshold", "0 m/s^2", ComponentError),
        ("gravity", 9.81, UnitsError),
        ("gravity", "-9.81 m/s^2", ComponentError),
        ("damping_ratio", "5 m", UnitsError),
        ("damping_ratio", 2.0, ComponentError),
        ("block", rf.TwoSpringSupport(frequency_ratio=20, damping_ratio=0.1), ComponentError),
    ],
)
def test_intensity_measures_refuse_invalid_arguments(argument, value, error):
    with pytest.raises(error, match=f"intensity_measures: {argument}"):
        intensity_measures(PULSE, **{argument: value})


def test_block_measures_of_vertical_component_are_refused():
    motion = PULSE.with_vertical(PULSE)
    with pytest.raises(ComponentError, match="leave out block or component"):
        intensity_measures(motion, block=BLOCK, component="vertical")


def test_fourier_resolution():
    assert fourier_spectrum(PULSE).frequency.values[1] == pytest.approx(128.0 / 129.0)
    fine = fourier_spectrum(PULSE, resolution="0.1 Hz")
    assert fine.frequency.values[1] <= 0.1
    for resolution, error in (("0 Hz", ComponentError), (0.1, UnitsError)):
        with pytest.raises(error, match="fourier_spectrum: resolution"):
            fourier_spectrum(PULSE, resolution=resolution)
    with pytest.raises(ComponentError, match="too many samples"):
        fourier_spectrum(PULSE, resolution="1e-300 Hz")


def test_record_too_coarse_for_periods_warns():
    samples = np.sin(0.3 * np.arange(200))
    record, fine = (
        rf.GroundMotion.from_arrays((samples, "m/s^2"), step) for step in ("0.02 s", "0.005 s")
    )
    with pytest.warns(RecordWarning, match=r"the record is sampled every 0\.02 s"):
        response_spectrum(record, ["0 s", "0.15 s", "1 s"])
    with pytest.warns(RecordWarning, match=r"1 of 2 records are .* periods from 0\.15 s"):
        response_spectrum({"coarse": record, "fine": fine}, ["0.15 s"])
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        response_spectrum(record, ["0 s", "0.2 s", "1 s"])
        response_spectrum(record, ["0.05 s"], interpolation="band-limited")
        response_spectrum(rf.GroundMotion.sine_pulse(), ["0.01 s"])
        response_spectrum(record)  # default periods are documented in the manual
