"""Maps of overturning on rigid ground at small rotations against closed forms."""

import math

import numpy as np
import pytest
from analytical.rigid import (
    BANDS,
    GRAVITY,
    P,
    half_sine_threshold,
    one_sine_threshold,
    rigid_block,
)

import rockframe as rf

pytestmark = pytest.mark.analytical

THETA = 0.1
UPLIFT = GRAVITY * THETA
LONG = f"{60.0 / P!r} s"


@pytest.mark.long  # the short tests find one of its gaps by critical_scale
def test_the_gap_of_zhang_and_makris():
    """Blocks that overturn after an impact, stand, and overturn without one."""
    ratios = np.array(list(BANDS))
    found = rf.overturning_map(
        rigid_block(THETA, restitution=0.9, rotation="small"),
        rf.GroundMotion.sine_pulse,
        amplitude=(np.linspace(1.05, 12.0, 31) * UPLIFT, "m/s^2"),
        frequency=(ratios * P / (2.0 * math.pi), "Hz"),
        impacts=1,
        bracket_width=1e-8,
        free_vibration=LONG,
        accuracy="reference",
        progress=False,
    )
    assert found.relative_pulse_frequency.values == pytest.approx(ratios, rel=1e-12)
    assert found.relative_peak_ground_acceleration.values[0] == pytest.approx(1.05, rel=1e-12)
    assert found.boundary_count.values.tolist() == [3, 3, 3]
    below, above = found.amplitude_below / UPLIFT, found.amplitude_above / UPLIFT
    # at 2 p the gap lies between two neighbouring amplitudes of the first runs
    assert found.impacts_before_overturning.isel(frequency=0).isnull().sum() == 1
    for place, (ratio, [(lower, upper)]) in enumerate(BANDS.items()):
        expected = [lower, upper, one_sine_threshold(ratio)]
        assert above.values[place] == pytest.approx(expected, abs=1e-6)
        assert below.values[place, 2] <= expected[2] <= above.values[place, 2] * (1.0 + 1e-9)
    for names, impacts in (
        ("impacts_above", [1.0, np.nan, 0.0]),
        ("impacts_below", [np.nan, 1.0, np.nan]),
    ):
        assert np.array_equal(found[names].values, [impacts] * 3, equal_nan=True)


def test_relative_amplitudes_use_peak_ground_acceleration():
    """A tenth of a sine has its peak at sin(0.2 pi) of its amplitude."""
    levels = np.array([1.0, 3.0]) * UPLIFT
    axes = {"amplitude": (levels, "m/s^2"), "frequency": ([1.0, 2.0], "Hz"), "progress": False}
    block = rigid_block(THETA, restitution=0.9, rotation="small")
    short = rf.GroundMotion.sine_pulse("1 m/s^2", "1 Hz", cycles=0.1)
    found = rf.overturning_map(block, short, **axes)
    expected = math.sin(0.2 * math.pi) * np.array([1.0, 3.0])
    assert found.relative_peak_ground_acceleration.values == pytest.approx(expected, rel=1e-9)

    def longer(amplitude, frequency):
        cycles = 0.1 * frequency.m_as("Hz")
        return rf.GroundMotion.sine_pulse(amplitude, frequency, cycles=cycles)

    found = rf.overturning_map(block, longer, **axes)  # any function of an amplitude
    assert "relative_peak_ground_acceleration" not in found.coords
    assert rf.plot.overturning_map(found).get_ylabel().startswith("amplitude")


def test_rectangular_pulses():
    """(A - 1)(exp(p t1) - 1) = 1: the free motion ends in unstable equilibrium."""

    def rectangle(amplitude, frequency):
        level = amplitude.m_as("m/s^2")
        length = float(1.0 / frequency.m_as("Hz"))
        return rf.GroundMotion.from_arrays((np.full(2, level), "m/s^2"), f"{length!r} s")

    lengths = np.array([3.0, 1.0, 0.5])  # p t1
    found = rf.overturning_map(
        rigid_block(THETA, rotation="small"),
        rectangle,
        amplitude=(np.linspace(0.5, 3.0, 6) * UPLIFT, "m/s^2"),
        frequency=(P / lengths, "Hz"),
        bracket_width=1e-9,
        free_vibration=LONG,
        accuracy="reference",
        progress=False,
    )
    first = found.amplitude_above.isel(boundary=0).values / UPLIFT
    assert first == pytest.approx(1.0 / (1.0 - np.exp(-lengths)), rel=2e-9)
    assert (found.impacts_above.isel(boundary=0) == 0.0).all()


def test_overturning_spectrum_matches_closed_form_for_all_sizes():
    """Amplitude over g theta depends only on the pulse's frequency over p."""
    scale = rf.overturning_spectrum(
        rigid_block(THETA, rotation="small"),
        rf.GroundMotion.sine_pulse("1 m/s^2", "1 Hz", 0.5),
        periods=([1.0, 2.0, 4.0], "s"),
        scale=np.geomspace(0.5, 8.0, 9),
        bracket_width=1e-8,
        free_vibration="30 s",
        accuracy="reference",
        progress=False,
    )
    tangent = math.tan(THETA)
    expected = [half_sine_threshold(period) * GRAVITY * THETA for period in (1.0, 2.0, 4.0)]
    assert scale.slenderness.item() == pytest.approx(1.0 / tangent, rel=1e-12)
    assert scale.capacity_scale.squeeze().values == pytest.approx(expected, rel=1e-7)
    assert scale.capacity_intensity.squeeze().values == pytest.approx(expected, rel=1e-7)
