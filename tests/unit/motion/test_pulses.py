"""Analytic motions compared with their exact functions."""

import math

import numpy as np
import pytest

from rockframe.errors import ComponentError, UnitsError
from rockframe.motion import GroundMotion


def test_default_sine_pulse_is_equation_17():
    pulse = GroundMotion.sine_pulse()
    assert pulse.si.duration == 1.0
    time = np.linspace(0.0, 1.0, 4001)
    assert pulse.si.at(time) == pytest.approx(-9.81 * np.sin(2.0 * np.pi * time), abs=1e-11)
    assert pulse.si.at([1.0 + 1e-9, 2.0]).tolist() == [0.0, 0.0]
    assert pulse.si.horizontal.samples[[0, 64, 128]].tolist() == [0.0, 0.0, 0.0]
    assert pulse.si.horizontal.samples[32] == -9.81
    assert pulse.si.peak == 9.81


@pytest.mark.parametrize("frequency", [0.013, 1.0, 7.3])
@pytest.mark.parametrize("cycles", [0.5, 1, 0.8, 3.7])
def test_pieces_have_documented_accuracy(frequency, cycles):
    pulse = GroundMotion.sine_pulse("2 m/s^2", f"{frequency} Hz", cycles)
    time = np.linspace(0.0, pulse.si.duration, 20011)
    exact = 2.0 * np.sin(2.0 * np.pi * frequency * time)
    # bound: (2 pi/128)^6/(64 * 720) of the amplitude, and rounding of the argument
    assert np.max(np.abs(pulse.si.at(time) - exact)) < 2.0 * 3.2e-13 + 2e-14 * cycles
    assert pulse.si.duration == pytest.approx(cycles / frequency, rel=1e-14)


def test_pieces_meet_with_value_slope_and_curvature():
    si = GroundMotion.harmonic("3 m/s^2", "2 Hz", "1.3 s", "0.4 rad").si
    pieces = si.horizontal.pieces
    powers = np.arange(6)
    assert pieces.sum(axis=1) == pytest.approx(si.horizontal.samples[1:], abs=1e-14)
    assert (pieces @ powers)[:-1] == pytest.approx(pieces[1:, 1], abs=1e-13)
    assert (pieces @ (powers * (powers - 1)))[:-1] == pytest.approx(2.0 * pieces[1:, 2], abs=1e-12)
    slope = 3.0 * np.cos(2.0 * np.pi * 2.0 * np.arange(len(pieces)) * si.time_step + 0.4)
    assert pieces[:, 1] == pytest.approx(slope * 4.0 * np.pi * si.time_step, rel=1e-9)


@pytest.mark.parametrize("phase", [None, "0.3 rad", "90 deg", "-2 rad", "25 rad"])
def test_harmonic_motion_with_a_phase(phase):
    motion = GroundMotion.harmonic("0.2 g_0", "1.7 Hz", "3.3 s", phase)
    radians = {None: 0.0, "0.3 rad": 0.3, "90 deg": 0.5 * math.pi, "-2 rad": -2.0, "25 rad": 25.0}
    time = np.linspace(0.0, motion.si.duration, 5003)
    exact = 0.2 * 9.80665 * np.sin(2.0 * np.pi * 1.7 * time + radians[phase])
    assert motion.si.at(time) == pytest.approx(exact, abs=2e-12)
    assert motion.si.duration == pytest.approx(3.3, rel=1e-14)


@pytest.mark.parametrize("phase", ["0.01 rad", "1 rad", "-0.7 rad"])
def test_peak_between_samples_is_found(phase):
    motion = GroundMotion.harmonic("5 m/s^2", "1 Hz", "2 s", phase)
    assert np.max(np.abs(motion.si.horizontal.samples)) < 5.0 - 1e-6
    assert motion.si.peak == pytest.approx(5.0, rel=1e-12)


def test_zero_amplitude_is_a_still_ground():
    assert GroundMotion.sine_pulse("0 m/s^2").si.peak == 0.0


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ({"amplitude": -9.81}, "amplitude needs an acceleration"),
        ({"amplitude": "9.81 m/s"}, "amplitude needs an acceleration"),
        ({"amplitude": "1 kg"}, "amplitude needs an acceleration"),
        ({"frequency": 1.0}, "frequency needs a cyclic frequency"),
        ({"frequency": "6.28 rad/s"}, "divided by 2 pi"),
        ({"frequency": "1 s"}, "frequency needs a cyclic frequency"),
        ({"frequency": "0 s"}, "frequency needs a cyclic frequency"),
        ({"cycles": "1 s"}, "cycles needs a pure ratio"),
    ],
)
def test_wrong_units(arguments, words):
    with pytest.raises(UnitsError, match=words):
        GroundMotion.sine_pulse(**arguments)


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ({"amplitude": "nan m/s^2"}, "amplitude must be finite"),
        ({"frequency": "0 Hz"}, "frequency must be greater than zero"),
        ({"frequency": "-1 Hz"}, "frequency must be greater than zero"),
        ({"frequency": "1e-320 Hz"}, "outside what can be sampled"),
        ({"cycles": 0}, "cycles must be greater than zero"),
        ({"cycles": 1e12}, "more than can be sampled"),
    ],
)
def test_values_out_of_range(arguments, words):
    with pytest.raises(ComponentError, match=words):
        GroundMotion.sine_pulse(**arguments)


def test_duration_out_of_range():
    with pytest.raises(ComponentError, match="duration must be greater than zero"):
        GroundMotion.harmonic("1 m/s^2", "1 Hz", "0 s")
    with pytest.raises(UnitsError, match="phase needs an angle"):
        GroundMotion.harmonic("1 m/s^2", "1 Hz", "1 s", 0.3)
