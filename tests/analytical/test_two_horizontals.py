"""Two horizontal components against SciPy, rotated motions, closed forms and pyRotD."""

import math

import numpy as np
import pytest
from records import record_path
from scipy.signal import StateSpace, lsim

import rockframe as rf
from rockframe.compiled import COMPILED
from rockframe.errors import ComponentError, RecordError, RecordWarning
from rockframe.signals import spectra

pytestmark = [
    pytest.mark.analytical,
    # the oracle takes the same straight lines
    pytest.mark.filterwarnings("ignore:.*is coarse for periods:rockframe.errors.RecordWarning"),
]

PERIODS = np.array([0.1, 0.2, 0.5, 1.0, 2.0, 4.0])
NAMES = (
    "median_rotated_acceleration",
    "greatest_rotated_acceleration",
    "geometric_mean_acceleration",
)

# pyrotd 0.6.1: calc_rotated_spec_accels(step, first, second, 1/PERIODS, 0.05,
# percentiles=[50, 100], max_freq_ratio=60, method="rigorous") and calc_spec_accels, with 40 000
# zeros behind the components (5000 behind the record), since its transform is a circular one
PYROTD = {
    "made": {
        NAMES[0]: [1.841519562822481, 2.0347383067297584, 2.726732591193433,
                   2.138346792563917, 1.6223965699290317, 0.9548880501804545],
        NAMES[1]: [2.32884667482889, 2.3176207359672634, 3.80602438870514,
                   2.828612767879797, 1.9364164242235302, 1.223594688206038],
        NAMES[2]: [1.7410259565515993, 1.7452556267981916, 2.5108699993719465,
                   1.9431787541422203, 1.5375588870740928, 0.7347579047609418],
    },
    "recorded": {
        NAMES[0]: [0.305628088310542, 0.24022108319574698, 0.03618568433099387,
                   0.008423394574242094, 0.002287963206258876, 0.0005816297989773916],
        NAMES[1]: [0.41243475730106605, 0.3390235984809483, 0.048955641719802725,
                   0.011912478848113112, 0.0032356685965019335, 0.0008225487499941641],
        NAMES[2]: [0.22274604044218815, 0.15010429180887136, 0.03665101910206775,
                   0.007910709900529483, 0.002075625027837425, 0.0005179906570973199],
    },
}  # fmt: skip
STEP = 0.0025


def components() -> tuple[np.ndarray, np.ndarray]:
    """Return sums of sines below 9 Hz that rise and fade."""
    time = np.arange(0.0, 20.0, STEP)
    envelope = (time / 4.0) ** 2 * np.exp(2.0 - time / 2.0)
    first = sum(
        np.sin(2 * np.pi * f * time + f * f) / (1.0 + f / 3.0)
        for f in (0.3, 0.7, 1.1, 1.9, 2.9, 4.3, 6.1, 8.7)
    )
    second = sum(
        np.cos(2 * np.pi * f * time - 1.7 * f) / (1.0 + f / 3.0)
        for f in (0.4, 0.6, 1.3, 1.7, 3.1, 4.1, 6.7, 8.3)
    )
    return 0.5 * envelope * first, 0.4 * envelope * second


def synthetic_pair() -> rf.HorizontalPair:
    return rf.HorizontalPair(
        *(rf.GroundMotion.from_arrays((one, "m/s^2"), f"{STEP} s") for one in components())
    )


def noise(seed: int, count: int = 300) -> rf.GroundMotion:
    samples = np.convolve(np.random.default_rng(seed).normal(size=count), np.ones(4))
    return rf.GroundMotion.from_arrays((samples, "m/s^2"), "0.02 s", name=f"noise {seed}")


def recorded_pair() -> rf.HorizontalPair:
    pair = rf.HorizontalPair.read(record_path("GEONET_20180212_211557_WPWS_20.V2A"))
    # pyrotd takes a record as band-limited, not as linear between its samples
    return rf.HorizontalPair(pair.first.resampled("0.0025 s"), pair.second.resampled("0.0025 s"))


@pytest.mark.parametrize("which", PYROTD)
def test_rotated_spectra_match_stored_pyrotd_values(which):
    pair = synthetic_pair() if which == "made" else recorded_pair()
    found = rf.rotated_spectrum(pair, (PERIODS, "s"))
    for name, expected in PYROTD[which].items():
        np.testing.assert_allclose(found[name].values[0], expected, rtol=0.005, err_msg=name)
    # the average over its own ordinates
    average = rf.average_spectral_acceleration(pair, (PERIODS, "s"))
    for name, mine in (
        (NAMES[0], "average_median_rotated_acceleration"),
        (NAMES[2], "average_geometric_mean_acceleration"),
    ):
        expected = np.exp(np.mean(np.log(PYROTD[which][name])))
        assert float(average[mine]) == pytest.approx(expected, rel=0.005)


def test_rotated_spectra_match_installed_pyrotd():
    pyrotd = pytest.importorskip("pyrotd", reason="pyrotd is not installed")
    padded = [np.concatenate([one, np.zeros(40_000)]) for one in components()]
    theirs = pyrotd.calc_rotated_spec_accels(
        STEP, *padded, 1.0 / PERIODS, 0.05, percentiles=[50, 100], max_freq_ratio=60
    )
    found = rf.rotated_spectrum(synthetic_pair(), (PERIODS, "s"))
    for name, percentile in zip(NAMES, (50, 100), strict=False):
        expected = theirs.spec_accel[theirs.percentile == percentile]
        np.testing.assert_allclose(found[name].values[0], expected, rtol=0.005)


def displacement(samples: np.ndarray, step: float, period: float, damping: float) -> np.ndarray:
    """Return the displacement of an oscillator under a piecewise linear motion, by SciPy."""
    omega = 2.0 * np.pi / period
    parts = max(10, math.ceil(200.0 * step / period))
    time = np.arange(0.0, (samples.size - 1) * step + 4.0 * period, step / parts)
    ground = np.interp(time, step * np.arange(samples.size), samples, right=0.0)
    system = StateSpace(
        [[0.0, 1.0], [-(omega**2), -2.0 * damping * omega]], [[0.0], [-1.0]], [[1.0, 0.0]], [[0.0]]
    )
    return lsim(system, ground, time)[1]


def test_rotated_spectra_match_scipy():
    pair = rf.HorizontalPair(noise(1), noise(2, 250), noise(3))
    periods, ratios = np.array([0.07, 0.3, 5.0]), (0.02, 0.1)
    found = rf.rotated_spectrum(pair, (periods, "s"), ratios)
    angles = np.pi * np.arange(180) / 180
    for i, damping in enumerate(ratios):
        for j, period in enumerate(periods):
            u, v = (displacement(one.samples, 0.02, period, damping) for one in pair.signals)
            peaks = np.abs(np.outer(np.cos(angles), u) + np.outer(np.sin(angles), v)).max(axis=1)
            peaks *= (2.0 * np.pi / period) ** 2
            at = {"damping_ratio": i, "period": j}
            for name, expected in zip(
                NAMES, (np.median(peaks), peaks.max(), np.sqrt(peaks[0] * peaks[90])), strict=True
            ):
                assert float(found[name].isel(at)) == pytest.approx(expected, rel=1e-3), name
            direction = float(found["direction_of_greatest"].isel(at))
            assert abs(math.sin(direction - angles[peaks.argmax()])) < math.sin(math.radians(2.5))
            upwards = displacement(pair.vertical.si.horizontal.samples, 0.02, period, damping)
            vertical = np.abs(upwards).max() * (2.0 * np.pi / period) ** 2
            ratio = float(found["vertical_to_horizontal_ratio"].isel(at))
            assert ratio == pytest.approx(vertical / np.median(peaks), rel=1e-3)


def test_rotated_spectrum_matches_spectra_of_rotated_motions():
    pulse = rf.GroundMotion.sine_pulse("1 m/s^2", "1 Hz")
    other = rf.GroundMotion.from_arrays((np.zeros(len(pulse)), "m/s^2"), pulse.time_step)
    periods = ([0.0, 0.05, 0.3, 1.0, 5.0], "s")
    turned = pulse.rotated(pulse, "0 deg")
    for pair in (
        rf.HorizontalPair(noise(1), noise(2, 250)),
        rf.HorizontalPair(pulse, pulse.scaled(-0.5)),
        rf.HorizontalPair(turned, other),
    ):
        found = rf.rotated_spectrum(pair, periods, (0.05, 0.0), directions=12)
        each = np.array(
            [
                rf.response_spectrum(
                    pair.rotated(f"{15 * k} deg"), periods, (0.05, 0.0)
                ).pseudo_spectral_acceleration.values
                for k in range(12)
            ]
        )
        np.testing.assert_allclose(found[NAMES[0]], np.median(each, axis=0), rtol=1e-9, atol=1e-12)
        np.testing.assert_allclose(found[NAMES[1]], each.max(axis=0), rtol=1e-9, atol=1e-12)
        both = np.sqrt(each[0] * each[6])
        np.testing.assert_allclose(found[NAMES[2]], both, rtol=1e-9, atol=1e-9)


def test_motion_in_one_direction_only():
    """RotD50 has the factor of the median cosine, RotD100 equals the spectrum of the motion."""
    motion = noise(4)
    angle = math.radians(30.0)
    pair = rf.HorizontalPair(motion.scaled(math.cos(angle)), motion.scaled(math.sin(angle)))
    own = rf.response_spectrum(motion, (PERIODS, "s")).pseudo_spectral_acceleration.values
    found = rf.rotated_spectrum(pair, (PERIODS, "s"))
    np.testing.assert_allclose(found[NAMES[1]], own, rtol=1e-12)
    median = np.median(np.abs(np.cos(np.pi * np.arange(180) / 180 - angle)))
    np.testing.assert_allclose(found[NAMES[0]], median * own, rtol=1e-10)
    factor = math.sqrt(math.cos(angle) * math.sin(angle))
    np.testing.assert_allclose(found[NAMES[2]], factor * own, rtol=1e-10)
    np.testing.assert_allclose(found["direction_of_greatest"], angle, rtol=1e-12)
    axes = rf.measures.principal_axes(pair)
    assert float(axes.major_axis_angle) == pytest.approx(angle)
    assert float(axes.minor_arias_intensity) == pytest.approx(0.0, abs=1e-12)
    arias = rf.intensity_measures(motion).arias_intensity
    assert float(axes.major_arias_intensity) == pytest.approx(float(arias))


def test_rotated_spectra_do_not_depend_on_sensor_orientation():
    pair = rf.HorizontalPair(noise(1), noise(2))
    other = pair.in_axes("31 deg")
    mine, yours = (
        rf.rotated_spectrum(one, (PERIODS, "s"), directions=720) for one in (pair, other)
    )
    for name in NAMES[:2]:
        np.testing.assert_allclose(mine[name], yours[name], rtol=2e-4)
    before, after = (rf.measures.principal_axes(one) for one in (pair, other))
    turned = float(before.major_axis_angle) - math.radians(31.0)
    assert math.tan(float(after.major_axis_angle)) == pytest.approx(math.tan(turned), rel=1e-9)
    for name in ("major_arias_intensity", "minor_arias_intensity"):
        assert float(after[name]) == pytest.approx(float(before[name]), rel=1e-10)


def test_components_along_principal_axes_are_uncorrelated():
    pair = rf.HorizontalPair(noise(5), noise(6, 280))
    axes = rf.measures.principal_axes(pair)
    along = pair.in_axes(f"{float(axes.major_axis_angle)!r} rad")
    first, second = (one.samples for one in along.signals)
    weights = np.ones(first.size)
    weights[[0, -1]] = 0.5
    matrix = np.array([[np.sum(weights * a * b) for a in (first, second)] for b in (first, second)])
    assert abs(matrix[0, 1]) < 1e-10 * matrix[1, 1]
    factor = math.pi / (2.0 * 9.80665) * 0.02
    assert factor * matrix[0, 0] == pytest.approx(float(axes.major_arias_intensity), rel=1e-10)
    assert factor * matrix[1, 1] == pytest.approx(float(axes.minor_arias_intensity), rel=1e-10)
    measured = rf.intensity_measures({"major": along.first, "minor": along.second})
    assert measured.arias_intensity.values == pytest.approx(factor * np.diag(matrix))


@pytest.mark.parametrize("seed", range(8))
def test_principal_axis_along_the_second_component_is_at_90_degrees(seed):
    # not at -90 degrees, by rounding
    moving = noise(seed, 280)
    pair = rf.HorizontalPair(moving.scaled(0.0), moving)
    assert rf.measures.principal_axes(pair).major_axis_angle == 0.5 * math.pi


def test_weak_orthogonal_pulse_does_not_turn_principal_axis():
    pulse = rf.GroundMotion.sine_pulse("1e-6 m/s^2", "1 Hz", cycles=2)
    noise = np.random.default_rng(0).normal(size=len(pulse))
    record = rf.GroundMotion.from_arrays((noise, "m/s^2"), (pulse.si.time_step, "s"))
    found = rf.measures.principal_axes(rf.HorizontalPair(record, pulse))
    assert found.major_axis_angle.item() == pytest.approx(0.0, abs=1e-6)
    other = rf.measures.principal_axes(rf.HorizontalPair(pulse, record))
    assert abs(other.major_axis_angle.item()) == pytest.approx(0.5 * np.pi, abs=1e-6)


def test_rotation_to_azimuth_includes_vertical_component():
    pair = rf.HorizontalPair.read(record_path("GEONET_20180212_211557_WPWS_20.V2A"))
    assert pair.first.metadata["component"] == "S16W"
    assert pair.vertical.metadata["component"] == "Up"
    north = pair.rotated(azimuth="0 deg")
    assert north.vertical_acceleration is not None
    angle = math.radians(196.0)
    first, second = (one.samples for one in pair.signals)
    # S16W points to 196 degrees, S74E to 106: components by their cosines
    expected = math.cos(angle) * first + math.cos(math.radians(106.0)) * second
    np.testing.assert_allclose(north.si.horizontal.samples, expected, atol=1e-12)


def test_components_of_a_file_keep_their_names_and_directions(tmp_path):
    file = tmp_path / "record.csv"
    rows = [f"{0.01 * k:.2f}, {0.1 * k:.1f}, {0.2 * k:.1f}, {0.3 * k:.1f}" for k in range(5)]
    file.write_text("\n".join(["time [s], N [g], E [g], UP [g]", *rows]))
    pair = rf.HorizontalPair.read(file)
    assert pair.name == "record.csv N, record.csv E"
    assert pair.vertical.name == "record.csv UP"
    peaks = [one.peak_acceleration.m_as("g_0") for one in (*pair.components, pair.vertical)]
    assert peaks == pytest.approx([0.4, 0.8, 1.2], rel=1e-12)
    assert pair.principal_axis.m_as("rad") == pytest.approx(math.atan(2.0), rel=1e-12)


def test_vertical_spectra_of_several_pairs_need_all_vertical_components():
    plain = rf.HorizontalPair(noise(1), noise(2))
    whole = rf.HorizontalPair(noise(1), noise(2), noise(3))
    for pairs, has_vertical in (((whole, plain), False), ((whole, whole), True)):
        found = rf.rotated_spectrum(dict(enumerate(pairs)), ["0.5 s"], directions=4)
        assert ("vertical_spectral_acceleration" in found) == has_vertical
        assert found.motion.values.tolist() == ["0", "1"]


def test_average_spectral_acceleration_is_geometric_mean():
    motion = noise(7)
    periods = np.linspace(0.2, 3.0, 15)
    spectrum = rf.response_spectrum(motion, (periods, "s"), 0.03).pseudo_spectral_acceleration
    found = rf.average_spectral_acceleration(motion, (periods, "s"), 0.03)
    expected = np.prod(spectrum.values) ** (1.0 / 15.0)
    assert float(found.average_spectral_acceleration) == pytest.approx(expected, rel=1e-12)
    assert found.attrs["damping_ratio"] == 0.03
    pairs = {"a": rf.HorizontalPair(noise(1), noise(2)), "b": rf.HorizontalPair(noise(3), motion)}
    several = rf.average_spectral_acceleration(pairs, (periods, "s"))
    for name, pair in pairs.items():
        alone = rf.average_spectral_acceleration(pair, (periods, "s"))
        for average, value in alone.items():
            assert several[average].sel(motion=name).item() == value.item(), (name, average)


@pytest.mark.skipif(not COMPILED, reason="this run does without compilation")
def test_compiled_and_uncompiled_spectra_agree(monkeypatch):
    rng = np.random.default_rng(3)
    held = [np.convolve(rng.normal(size=count), np.ones(3)) for count in (9000, 8000)]
    record = [rf.GroundMotion.from_arrays((one, "m/s^2"), "0.02 s") for one in held]
    pulse = rf.GroundMotion.sine_pulse("1 m/s^2", "1 Hz")
    periods = (np.concatenate([[0.0], np.geomspace(0.01, 20.0, 7)]), "s")
    for pair in (record, (pulse, pulse.scaled(0.3))):
        arguments = rf.HorizontalPair(*pair), periods, (0.0, 0.05)
        compiled = rf.rotated_spectrum(*arguments, directions=20)
        with monkeypatch.context() as patch:
            patch.setattr(spectra, "COMPILED", False)
            plain = rf.rotated_spectrum(*arguments, directions=20)
        assert plain.data_vars.keys() == compiled.data_vars.keys()
        for name, one in compiled.data_vars.items():
            np.testing.assert_allclose(
                one, plain[name], rtol=1e-9, atol=1e-10 * float(one.max()), err_msg=name
            )


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: rf.HorizontalPair(noise(1), "east.AT2"), "second needs a GroundMotion, got 'east"),
        (lambda: rf.HorizontalPair(noise(1), noise(2), 3.0), "vertical needs a GroundMotion"),
        (
            lambda: rf.HorizontalPair(noise(1), noise(2).resampled("0.01 s")),
            r"the time steps of first and second differ, 0\.02 s and 0\.01 s",
        ),
        (lambda: rf.rotated_spectrum(noise(1)), "pair needs two horizontal components"),
        (lambda: rf.rotated_spectrum({}), "found no motions"),
        (lambda: rf.rotated_spectrum({"a": noise(1)}), "those of a suite are suite.pairs"),
        (lambda: rf.rotated_spectrum(synthetic_pair(), directions=181), "directions must be even"),
        (lambda: rf.measures.principal_axes("pair"), "pair needs two horizontal components"),
        (lambda: rf.average_spectral_acceleration(noise(1), None), "periods must be given"),
        (lambda: rf.average_spectral_acceleration(noise(1), ["0 s"]), "above zero"),
        (lambda: rf.average_spectral_acceleration(3.0, ["1 s"]), "needs a GroundMotion"),
    ],
)
def test_invalid_pairs_are_refused(make, words):
    with pytest.raises(ComponentError, match=words):
        make()


def test_pair_requires_matching_azimuths_and_start_times():
    def metadata_motion(**metadata) -> rf.GroundMotion:
        motion = noise(1)
        return rf.GroundMotion(motion.si, metadata=metadata)

    rf.HorizontalPair(metadata_motion(azimuth=10), metadata_motion(azimuth=100))
    rf.HorizontalPair(metadata_motion(azimuth=350.5), metadata_motion(azimuth=260))
    with pytest.raises(ComponentError, match="point to 10° and 90°"):
        rf.HorizontalPair(metadata_motion(azimuth=10), metadata_motion(azimuth=90))
    with pytest.raises(ComponentError, match="first starts at 10:00, second at 10:01"):
        rf.HorizontalPair(
            metadata_motion(record_time="10:00"), metadata_motion(record_time="10:01")
        )


def test_vertical_motion_of_only_one_component_warns():
    one, other, upwards = (noise(seed) for seed in (1, 2, 3))
    with pytest.warns(RecordWarning, match="only the second component has a vertical one"):
        rf.HorizontalPair(one, other.with_vertical(upwards))
    for pair in (
        rf.HorizontalPair(one.with_vertical(upwards), other, upwards),
        rf.HorizontalPair(one.with_vertical(upwards), other.with_vertical(upwards)),
    ):
        assert all(each.si.vertical is not None for each in pair.components)


def test_file_without_two_horizontals_is_refused():
    with pytest.raises(RecordError, match="1 horizontal and 0 vertical components"):
        rf.HorizontalPair.read(b"time (s),acc (g)\n0,0\n0.01,0.1\n0.02,0\n")
