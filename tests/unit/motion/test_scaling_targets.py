"""Scaling a motion to a target: peak velocity, spectral acceleration."""

import numpy as np
import pytest

import rockframe as rf
from rockframe.errors import ComponentError, RecordWarning, UnitsError

NOISE = np.random.default_rng(7).normal(size=600)


def record(vertical=None):
    up = None if vertical is None else (vertical, "m/s^2")
    return rf.GroundMotion.from_arrays((NOISE, "m/s^2"), "0.01 s", up, name="noise")


@pytest.mark.parametrize(
    "record_or_pulse", [record(), rf.GroundMotion.sine_pulse("3 m/s^2", "0.7 Hz", 1.3)]
)
def test_the_peak_velocity_is_reached(record_or_pulse):
    scaled = record_or_pulse.scaled(peak_velocity="35 cm/s")
    assert float(rf.intensity_measures(scaled).peak_ground_velocity) == pytest.approx(
        0.35, rel=1e-12
    )
    assert "to a peak velocity of 0.35 m s^-1" in scaled.history[-1]


def test_scaling_of_sine_to_peak_velocity_is_exact():
    """v = a/omega (1 - cos omega t), at most 2 a/omega."""
    pulse = rf.GroundMotion.sine_pulse("1 m/s^2", "1 Hz").scaled(peak_velocity="1 m/s")
    assert pulse.si.peak == pytest.approx(np.pi, rel=1e-12)


@pytest.mark.parametrize("period", ["0.2 s", "1.1 s"])
@pytest.mark.parametrize("damping_ratio", [None, 0.0, 0.2])
def test_the_spectral_acceleration_is_reached(period, damping_ratio):
    scaled = record(NOISE[::-1]).scaled(
        spectral_acceleration="0.4 g_0", period=period, damping_ratio=damping_ratio
    )
    damping = 0.05 if damping_ratio is None else damping_ratio
    spectrum = rf.response_spectrum(scaled, [period], damping_ratios=(damping,))
    assert spectrum.pseudo_spectral_acceleration.item() == pytest.approx(0.4 * 9.80665, rel=1e-12)
    ratio = scaled.si.horizontal.samples[5] / NOISE[5]
    assert scaled.si.vertical.samples == pytest.approx(ratio * NOISE[::-1], rel=1e-14)


@pytest.mark.parametrize(
    ("arguments", "error", "words"),
    [
        ({"peak_velocity": "0 m/s"}, ComponentError, "peak_velocity must be greater than zero"),
        ({"peak_velocity": "1 m"}, UnitsError, "peak_velocity needs a velocity"),
        ({"spectral_acceleration": "1 m/s^2"}, ComponentError, "and period together"),
        ({"period": "1 s", "peak": "1 m/s^2"}, ComponentError, "and period together"),
        ({"damping_ratio": 0.1, "factor": 2}, ComponentError, "and period together"),
        (
            {"spectral_acceleration": "1 m/s^2", "period": "1 Hz"},
            UnitsError,
            "period needs a time",
        ),
        (
            {"spectral_acceleration": "1 m/s^2", "period": "1 s", "damping_ratio": 1.5},
            ComponentError,
            "damping_ratio must be from 0 to 1",
        ),
        (
            {"spectral_acceleration": "1 m/s^2", "period": "1e-12 s"},
            ComponentError,
            "need .* steps",
        ),
        ({"peak": "1 m/s^2", "peak_velocity": "1 m/s"}, ComponentError, "give one of"),
    ],
)
def test_targets_that_are_refused(arguments, error, words):
    with pytest.raises(error, match=words):
        record().scaled(**arguments)


@pytest.mark.parametrize(
    "target",
    [{"peak_velocity": "1 m/s"}, {"spectral_acceleration": "1 m/s^2", "period": "1 s"}],
)
def test_still_ground_reaches_no_target(target):
    still = rf.GroundMotion.from_arrays((np.zeros(9), "m/s^2"), "0.01 s")
    with pytest.raises(ComponentError, match="no horizontal acceleration"):
        still.scaled(**target)


def test_period_too_short_for_record_warns():
    with pytest.warns(
        RecordWarning, match=r"coarse for periods from 0.06 s.*resampled\('0.005 s'\)"
    ):
        record().scaled(spectral_acceleration="1 m/s^2", period="0.06 s")
