"""Stochastic motions against the model that they sample, and against numbers of SMSIM.

Reference numbers are those of SMSIM 6.0, the program of D. M. Boore, for magnitude 6.0 at
20 km with the parameters of Boore and Thompson (2015) for western North America: its output of
15 January 2018, ``test-bt15_wna`` among the test data of pyRVT.
"""

import math
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from scipy.integrate import quad

import rockframe as rf
from rockframe.errors import ComponentError
from rockframe.motion import stochastic
from rockframe.motion.stochastic import WINDOW_LENGTH, Corners, PointSource, Site, accelerogram

pytestmark = pytest.mark.analytical

SMSIM = PointSource(magnitude=6.0, distance=20e3)
# Fourier amplitudes of velocity [cm] and acceleration [cm/s]; their ratio is 2 pi times the
# frequency, which is printed with fewer digits
SMSIM_SPECTRUM = [
    (0.878856, 0.276101),
    (1.73847, 1.10925),
    (3.22064, 4.72957),
    (3.57555, 10.6644),
    (2.52851, 15.3169),
    (1.44202, 17.0173),
    (0.657019, 15.7475),
    (0.221939, 10.8039),
    (0.0499448, 4.73642),
    (0.00490809, 0.906746),
]
STEP = 0.005


def peaks_over_seeds(model, seeds):
    return np.mean([np.abs(accelerogram(model, STEP, seed)).max() for seed in range(seeds)])


# two corners, against recorded motions -------------------------------------------------------

PERIODS = [1.0, 2.0, 3.0]
# mean (of logarithms) of the four NGA-West2 models of pyGMM 0.8 at PERIODS [g]: strike-slip on a
# vertical fault, 20 km, 760 m/s; depth to its top 3 km, 1.5 km and 0.5 km
RECORDED = {
    6.0: (0.0436, 0.0153, 0.0077),
    6.5: (0.0723, 0.0296, 0.0167),
    7.0: (0.0989, 0.0443, 0.0273),
}


@pytest.mark.parametrize("magnitude", RECORDED)
def test_two_corner_source_fits_recorded_long_periods_better(magnitude):
    ratios = {}
    for kind in ("one corner", "two corners", "unless given"):
        options = {} if kind == "unless given" else {"source": kind}
        motions = {
            seed: rf.GroundMotion.stochastic(magnitude, "20 km", seed, **options)
            for seed in range(12)
        }
        spectra = rf.response_spectrum(motions, (PERIODS, "s")).pseudo_spectral_acceleration
        mean = np.exp(np.log(spectra.squeeze().values).mean(axis=0)) / 9.80665
        ratios[kind] = mean / RECORDED[magnitude]
    assert ratios["one corner"].min() > 1.15
    assert ratios["one corner"].max() > 1.5
    assert ratios["two corners"].min() > 0.7
    assert ratios["two corners"].max() < 1.45
    assert ratios["unless given"].tolist() == ratios["two corners"].tolist()


@pytest.mark.parametrize(
    ("magnitude", "expected"), [(3.0, "one corner"), (5.99, "one corner"), (6.0, "two corners")]
)
def test_source_defaults_to_two_corners_for_large_magnitudes(magnitude, expected):
    motion = rf.GroundMotion.stochastic(magnitude, "20 km", 1)
    assert motion.metadata["source"] == expected
    assert motion == rf.GroundMotion.stochastic(magnitude, "20 km", 1, source=expected)
    old = {key: value for key, value in motion.to_dict().items() if key != "source"}
    one = rf.GroundMotion.stochastic(magnitude, "20 km", 1, source="one corner")
    assert rf.GroundMotion.from_dict(old) == one


@pytest.mark.parametrize("magnitude", [4.0, 6.0, 7.5])
def test_two_corner_source_preserves_both_ends_of_spectrum(magnitude):
    one = PointSource(magnitude, 20e3)
    two = replace(one, corners=Corners.TWO)
    lower, upper, share = two.two_corners
    assert lower == pytest.approx(10.0 ** (2.181 - 0.496 * magnitude))
    assert share == pytest.approx(10.0 ** (0.605 - 0.255 * magnitude))
    assert lower < one.corner_frequency < upper
    ends = np.array([1e-4 * lower, 1e3 * upper])
    np.testing.assert_allclose(
        two.displacement_spectrum(ends), one.displacement_spectrum(ends), rtol=1e-4
    )
    between = two.displacement_spectrum(np.array([lower])) / one.displacement_spectrum(
        np.array([lower])
    )
    hand = (1.0 - share) / 2.0 + share / (1.0 + (lower / upper) ** 2)
    hand *= 1.0 + (lower / one.corner_frequency) ** 2
    assert between[0] == pytest.approx(hand, rel=1e-12)
    assert two.duration - one.duration == pytest.approx(
        0.5 / lower + 0.5 / upper - 1.0 / one.corner_frequency
    )


def test_two_corner_source_survives_dict_round_trip():
    motion = rf.GroundMotion.stochastic(6.5, "15 km", 3, source="two corners", vertical=0.5)
    assert motion.metadata["source"] == "two corners"
    assert rf.GroundMotion.from_dict(motion.to_dict()) == motion
    with pytest.raises(ComponentError, match="source must be 'one corner' or 'two corners'"):
        rf.GroundMotion.stochastic(6.5, "15 km", 3, source="three")
    with pytest.raises(ComponentError, match="take 'one corner'"):
        rf.GroundMotion.stochastic(6.5, "15 km", 3, source="two corners", stress_drop="1 kPa")


# the target, against SMSIM -------------------------------------------------------------------


def test_source_and_distance_are_those_of_smsim():
    assert SMSIM.moment == pytest.approx(1.122e18, rel=5e-4)
    assert SMSIM.corner_frequency == pytest.approx(0.3560, rel=2e-4)
    assert stochastic.saturation_length(6.0) == pytest.approx(7191.0, rel=1e-4)
    assert SMSIM.effective_distance == pytest.approx(21.25e3, rel=5e-4)
    assert stochastic.path_duration(SMSIM.effective_distance) == pytest.approx(4.651, rel=2e-4)
    assert SMSIM.duration == pytest.approx(7.459, rel=1e-4)


def test_spectrum_is_that_of_smsim():
    velocity, acceleration = np.transpose(SMSIM_SPECTRUM) / 100.0
    frequency = acceleration / (2.0 * math.pi * velocity)
    np.testing.assert_allclose(SMSIM.acceleration_spectrum(frequency), acceleration, rtol=2e-5)


def test_energy_is_that_of_smsim():
    frequency = np.linspace(0.0, 62.82, 200_001)
    power = 2.0 * np.trapezoid(SMSIM.acceleration_spectrum(frequency) ** 2, frequency)
    assert power == pytest.approx(0.422053, rel=1e-4)
    assert math.pi / (2.0 * 9.8) * power == pytest.approx(6.76e-2, rel=3e-3)


@pytest.mark.parametrize(
    ("magnitude", "kilometres"),
    [
        (5.0, 10.0 ** (-1.72 + 0.43 * 5.0)),
        (7.8, 10.0 ** (-0.405 + 0.235 * 7.8)),
    ],
)
def test_saturation_follows_its_two_lines_outside_the_transition(magnitude, kilometres):
    assert stochastic.saturation_length(magnitude) == pytest.approx(1e3 * kilometres, rel=1e-12)


def test_saturation_bends_smoothly():
    magnitudes = np.arange(4.0, 8.5, 0.001)
    lengths = np.log10([stochastic.saturation_length(m) for m in magnitudes])
    slopes = np.diff(lengths) / 0.001
    assert slopes[0] == pytest.approx(0.43)
    assert slopes[-1] == pytest.approx(0.235)
    assert np.all(np.diff(slopes) < 1e-9)
    assert np.abs(np.diff(slopes)).max() < 1.1e-4


# the target, against its limits --------------------------------------------------------------


def test_low_frequency_level_follows_seismic_moment():
    level = SMSIM.displacement_spectrum(np.array([0.0, 1e-4]))
    # Boore's units: dyn cm, g/cm^3, km/s, km; centimetres come out
    constant = 0.55 * 0.707 * 2.0 / (4.0 * math.pi * 2.72 * 3.5**3) * 1e-20
    expected = constant * 10.0 ** (1.5 * 6.0 + 16.05) / (SMSIM.effective_distance / 1e3) / 100.0
    assert constant == pytest.approx(5.307e-24, rel=1e-4)  # printed by SMSIM
    assert level == pytest.approx([expected, expected], rel=1e-3)


def test_corner_frequency_in_the_units_of_its_source():
    moment = 10.0 ** (1.5 * 6.7 + 16.05)
    expected = 4.906e6 * 3.5 * (100.0 / moment) ** (1.0 / 3.0)
    found = PointSource(6.7, 20e3, stress_drop=10e6, shear_wave_velocity=3500.0).corner_frequency
    assert found == pytest.approx(expected, rel=1e-12)
    circle = 2.34 / (2.0 * math.pi) * (16.0 / 7.0) ** (1.0 / 3.0)
    assert pytest.approx(circle, rel=1e-4) == stochastic.CORNER
    assert stochastic.source_shape(np.array([0.0, found]), found).tolist() == [1.0, 0.5]


def test_high_frequencies_decay_with_kappa():
    frequency = np.linspace(1.0, 60.0, 60)
    ratio = SMSIM.acceleration_spectrum(frequency)
    ratio = ratio / replace(SMSIM, kappa=0.0).acceleration_spectrum(frequency)
    np.testing.assert_allclose(ratio, np.exp(-math.pi * 0.035 * frequency), rtol=1e-12)


def test_high_frequencies_scale_with_stress_drop_and_moment():
    frequency = np.array([40.0])

    def level(model):
        shape = stochastic.source_shape(frequency, model.corner_frequency)
        return model.moment * shape * frequency**2

    stressed = level(replace(SMSIM, stress_drop=20e6)) / level(SMSIM)
    assert stressed == pytest.approx(2.0 ** (2.0 / 3.0), rel=1e-3)
    larger = level(replace(SMSIM, magnitude=7.0)) / level(SMSIM)
    assert larger == pytest.approx(10.0**0.5, rel=1e-3)


def test_spreading_and_attenuation():
    assert stochastic.geometric_spreading(1e3) == 1.0
    assert stochastic.geometric_spreading(20e3) == pytest.approx(1.0 / 20.0)
    assert stochastic.geometric_spreading(160e3) == pytest.approx(1.0 / 80.0)
    decay = stochastic.crustal_attenuation(np.array([0.0, 1.0, 4.0]), 100e3, 180.0, 0.45)
    exponents = np.array([0.0, 1.0, 4.0**0.55]) * math.pi * 100.0 / (180.0 * 3.5)
    np.testing.assert_allclose(decay, np.exp(-exponents), rtol=1e-12)


def test_path_duration_goes_on_beyond_its_table():
    assert stochastic.path_duration(26e3) == pytest.approx(2.4 + 0.5 * 6.0)
    assert stochastic.path_duration(370e3) == pytest.approx(34.2 + 15.6)


@pytest.mark.parametrize("ground", list(Site))
def test_amplification_meets_its_table(ground):
    knots, values = np.transpose(stochastic.AMPLIFICATIONS[ground])
    np.testing.assert_allclose(stochastic.amplification(knots, ground), values, rtol=1e-12)
    ends = stochastic.amplification(np.array([0.0, 200.0]), ground)
    assert ends.tolist() == pytest.approx([values[0], values[-1]])
    assert np.all(np.diff(values) >= 0.0)


# many motions, against the target ------------------------------------------------------------


@pytest.mark.parametrize(("magnitude", "kilometres"), [(5.0, 20.0), (6.5, 100.0)])
def test_mean_power_spectrum_is_the_target(magnitude, kilometres):
    model, seeds = PointSource(magnitude, 1e3 * kilometres), 200
    total = 0.0
    for seed in range(seeds):
        total = total + np.abs(np.fft.rfft(accelerogram(model, STEP, seed)) * STEP) ** 2
    count = accelerogram(model, STEP, 0).size
    frequency = np.fft.rfftfreq(count, STEP)[1:]
    ratio = total[1:] / seeds / model.acceleration_spectrum(frequency) ** 2
    # |A|^2 is distributed exponentially; values one 1/length apart are independent
    window = stochastic.exponential_window(WINDOW_LENGTH * model.duration, STEP)
    length = STEP * np.sum(window**2) ** 2 / np.sum(window**4)
    edges = np.geomspace(0.5 * model.corner_frequency, 50.0, 13)
    for low, high in pairwise(edges):
        band = (frequency >= low) & (frequency < high)
        independent = seeds * max(1.0, (high - low) * length)
        assert np.mean(ratio[band]) == pytest.approx(1.0, abs=4.0 / math.sqrt(independent))


def test_each_power_is_distributed_exponentially():
    frequency, powers = 7.0, []
    turn = None
    for seed in range(400):
        samples = accelerogram(SMSIM, STEP, seed)
        if turn is None:
            turn = np.exp(-2j * math.pi * frequency * STEP * np.arange(samples.size))
        powers.append(abs(STEP * np.sum(samples * turn)) ** 2)
    powers = np.array(powers) / SMSIM.acceleration_spectrum(np.array([frequency])) ** 2
    assert np.mean(powers) == pytest.approx(1.0, abs=4.0 / 20.0)
    assert np.std(powers) == pytest.approx(1.0, abs=0.3)
    assert np.mean(powers > 1.0) == pytest.approx(math.exp(-1.0), abs=4.0 * 0.48 / 20.0)


# peaks, against random vibration theory and SMSIM --------------------------------------------


def peak_by_random_vibration(model, power):
    """Return the expected peak of Cartwright and Longuet-Higgins (1956) for the duration."""
    frequency = np.linspace(0.0, 80.0, 80_001)
    rate = 2.0 * math.pi * frequency
    squared = (model.displacement_spectrum(frequency) * rate**power) ** 2
    moments = [2.0 * np.trapezoid(rate**k * squared, frequency) for k in (0, 2, 4)]
    crossings = model.duration / math.pi * math.sqrt(moments[1] / moments[0])
    extrema = model.duration / math.pi * math.sqrt(moments[2] / moments[1])
    share = crossings / extrema
    factor = (
        math.sqrt(2.0)
        * quad(lambda z: 1.0 - (1.0 - share * math.exp(-(z**2))) ** extrema, 0.0, 8.0)[0]
    )
    return factor * math.sqrt(moments[0] / model.duration)


@pytest.mark.parametrize(("magnitude", "kilometres"), [(5.0, 30.0), (6.0, 20.0), (7.0, 60.0)])
def test_mean_peak_is_that_of_random_vibration_theory(magnitude, kilometres):
    model = PointSource(magnitude, 1e3 * kilometres)
    assert peaks_over_seeds(model, 150) == pytest.approx(
        peak_by_random_vibration(model, 2), rel=0.10
    )


@pytest.fixture(scope="module")
def many_motions():
    return [
        rf.GroundMotion.stochastic(6.0, "20 km", seed, source="one corner") for seed in range(200)
    ]


def test_mean_peaks_are_those_of_smsim(many_motions):
    mean = {"acceleration": 0.0, "velocity": 0.0, "displacement": 0.0}
    for motion in many_motions:
        history = rf.measures.velocity_and_displacement(motion)
        mean["acceleration"] += motion.si.peak / len(many_motions)
        mean["velocity"] += np.abs(history.ground_velocity.values).max() / len(many_motions)
        mean["displacement"] += np.abs(history.ground_displacement.values).max() / len(many_motions)
    # its own random vibration theory has an error of some per cent
    assert mean["acceleration"] == pytest.approx(0.810, rel=0.05)
    assert mean["velocity"] == pytest.approx(0.0567, rel=0.06)
    assert mean["displacement"] == pytest.approx(0.0181, rel=0.10)


def test_mean_response_spectrum_is_that_of_smsim(many_motions):
    periods, printed = [0.05, 0.1, 0.2, 0.5], [1.291, 1.919, 1.897, 1.155]
    found = np.mean(
        [
            rf.response_spectrum(motion, (periods, "s")).pseudo_spectral_acceleration.values[0]
            for motion in many_motions[:100]
        ],
        axis=0,
    )
    np.testing.assert_allclose(found, printed, rtol=0.06)


# how motions scale ---------------------------------------------------------------------------


def test_peaks_grow_with_stress_drop_and_magnitude_and_fall_with_distance():
    base = peaks_over_seeds(SMSIM, 30)
    assert 1.3 < peaks_over_seeds(replace(SMSIM, stress_drop=20e6), 30) / base < 2.0
    by_magnitude = [peaks_over_seeds(replace(SMSIM, magnitude=m), 30) for m in (4.0, 5.0, 6.0, 7.0)]
    assert np.all(np.diff(by_magnitude) > 0.0)
    by_distance = [peaks_over_seeds(replace(SMSIM, distance=1e3 * r), 30) for r in (1, 5, 20, 80)]
    assert np.all(np.diff(by_distance) < 0.0)
    # the peak saturates near a large fault
    assert by_distance[0] / by_distance[1] < 1.3


def test_window_spends_its_energy_within_the_duration():
    """Boore and Thompson (2014) define the duration as twice the time from 20 % to 80 %."""
    window = stochastic.exponential_window(WINDOW_LENGTH, 1e-4)
    energy = np.cumsum(window**2) / np.sum(window**2)
    time = 1e-4 * np.arange(window.size)
    at = {share: np.interp(share / 100.0, energy, time) for share in (5, 20, 80, 95)}
    assert 2.0 * (at[80] - at[20]) == pytest.approx(1.0, abs=0.02)
    assert at[95] - at[5] == pytest.approx(1.0, abs=0.01)


@pytest.mark.long
def test_significant_duration_is_that_of_the_model(many_motions):
    found = [
        rf.intensity_measures(motion).significant_duration_5_95.item()
        for motion in many_motions[:60]
    ]
    assert np.mean(found) == pytest.approx(SMSIM.duration, rel=0.1)
    assert 0.5 * SMSIM.duration < min(found)
    assert max(found) < 1.5 * SMSIM.duration


# ends and time steps --------------------------------------------------------------------------


@pytest.mark.parametrize(("magnitude", "kilometres"), [(4.0, 5.0), (6.5, 15.0), (8.0, 200.0)])
def test_ground_is_at_rest_before_and_after(magnitude, kilometres):
    motion = rf.GroundMotion.stochastic(magnitude, f"{kilometres} km", seed=4, vertical=0.7)
    for component in ("horizontal", "vertical"):
        samples = getattr(motion.si, component).samples
        assert samples[0] == samples[-1] == 0.0
        velocity = STEP * np.cumsum(samples)
        displacement = STEP * np.cumsum(velocity)
        assert abs(velocity[-1]) < 1e-5 * np.abs(velocity).max()
        assert abs(displacement[-1]) < 1e-4 * np.abs(displacement).max()


def test_horizontal_and_vertical_components_are_uncorrelated():
    correlations = []
    for seed in range(40):
        si = rf.GroundMotion.stochastic(5.0, "20 km", seed, vertical=0.5).si
        correlations.append(np.corrcoef(si.horizontal.samples, si.vertical.samples)[0, 1])
    assert abs(np.mean(correlations)) < 4.0 * np.std(correlations) / math.sqrt(40.0)
    assert np.abs(correlations).max() < 0.5


def test_mean_peak_does_not_depend_on_time_step():
    fine, coarse = (
        np.mean([np.abs(accelerogram(SMSIM, step, seed)).max() for seed in range(60)])
        for step in (0.0025, 0.01)
    )
    assert fine == pytest.approx(coarse, rel=0.05)
