"""Spectral matching: misfit, preserved character, reported changes."""

import warnings

import numpy as np
import pytest
from records import record_path
from scipy import signal

import rockframe as rf
from rockframe.errors import ComponentError, RecordWarning, UnitsError
from rockframe.motion.matching.iteration import (
    PEAKS,
    MatchingGoal,
    matching_changes,
    unusual_changes,
)
from rockframe.signals import Signal
from rockframe.signals.integrals import ground_path
from rockframe.signals.motion import knots_of

# test_matching_reports_changes_of_other_measures checks the warning of other changes
pytestmark = pytest.mark.filterwarnings("ignore:(?s).*the wavelets have changed")

EUROCODE = rf.TargetSpectrum.eurocode_8("0.3 g_0", "B")
ASCE = rf.TargetSpectrum.asce_7("1 g_0", "0.6 g_0")
RANGE = ("0.2 s", "0.6 s")


def example():
    return rf.GroundMotion.example("loma-prieta").window("5 s", "20 s", taper="0.5 s")


@pytest.fixture(scope="module")
def quickly_matched():
    return example().matched(EUROCODE, periods=RANGE)


def spectrum_over_target(motion, target, periods):
    """Ratios computed by SciPy's first-order hold, independently of rockframe."""
    samples, step = motion.si.horizontal.samples, motion.si.time_step
    peaks = np.empty(periods.size)
    for place, period in enumerate(periods):
        parts = int(np.ceil(60.0 * step / period))  # peaks are resolved to 0.14 %
        fine = np.interp(
            np.arange((samples.size - 1) * parts + 1) / parts, np.arange(samples.size), samples
        )
        frequency = 2.0 * np.pi / period
        drag = 2.0 * target.damping_ratio * frequency
        matrices = (
            np.array([[0.0, 1.0], [-(frequency**2), -drag]]),
            np.array([[0.0], [-1.0]]),
            np.array([[frequency**2, 0.0]]),
            np.zeros((1, 1)),
        )
        *discrete, _ = signal.cont2discrete(matrices, step / parts, "foh")
        numerator, denominator = signal.ss2tf(*discrete)
        rest = np.zeros(round(period * parts / step) + 1)
        history = signal.lfilter(numerator[0], denominator, np.concatenate([fine, rest]))
        peaks[place] = np.abs(history).max()
    return peaks / target.at((periods, "s"))


def paths(motion):
    return [knots_of(path) for path in ground_path(motion.si.horizontal)]


FULL = [
    ("loma-prieta", EUROCODE, ("0.2 s", "2 s")),
    ("waipukurau", ASCE, ("0.2 s", "2 s")),
    ("NIS090.AT2", EUROCODE, ("0.1 s", "1 s")),
    ("PEERSMD_IMPVALL_IELC180.AT2", ASCE, ("0.1 s", "2 s")),
    ("RSN763_LOMAP_GIL067.AT2", EUROCODE, ("0.2 s", "1 s")),
]


def assert_matched(motion, matched, target, periods):
    """Check that a matched motion has the target spectrum and keeps its character."""
    low, high = (float(period.split()[0]) for period in periods)
    checked = np.geomspace(low, high, 601)  # only the ends are periods of the matching
    ratios = spectrum_over_target(matched, target, checked)
    assert np.abs(ratios - 1.0).max() < 0.0505
    metadata = matched.metadata
    assert metadata["target_reached"] == 1
    stated = metadata["largest_spectral_misfit"]
    assert (
        stated - 0.008 < np.abs(ratios - 1.0).max() < stated + 0.004
    )  # cusps lie between the periods of both
    assert np.abs(ratios - 1.0).mean() == pytest.approx(metadata["mean_spectral_misfit"], abs=5e-4)
    root_mean_square = np.sqrt(np.mean(np.log(ratios) ** 2))
    assert root_mean_square == pytest.approx(metadata["spectral_misfit"], abs=5e-4)
    before = motion.scaled(metadata["scale_factor"])
    assert len(matched) == len(motion)
    build_ups = [np.cumsum(period.si.horizontal.samples**2) for period in (before, matched)]
    assert np.corrcoef(*build_ups)[0, 1] > 0.97
    for old, new in zip(paths(before), paths(matched), strict=True):  # velocity, displacement
        assert abs(new[-1] - old[-1]) < 1e-9 * np.abs(old).max()
        assert 1 / 3 < np.abs(new).max() / np.abs(old).max() < 3.0
    return True


def test_matched_record_reaches_code_spectrum_and_keeps_character(quickly_matched):
    assert assert_matched(example(), quickly_matched, EUROCODE, RANGE)


@pytest.mark.parametrize(
    ("name", "target", "periods"),
    [
        pytest.param(*FULL[0], marks=pytest.mark.wide),
        *(pytest.param(*case, marks=pytest.mark.long) for case in FULL[1:]),
    ],
    ids=lambda case: str(case)[:20],
)
def test_matched_records_reach_code_spectra_and_keep_character(name, target, periods):
    motion = (
        rf.GroundMotion.read(record_path(name)) if "." in name else rf.GroundMotion.example(name)
    )
    assert assert_matched(motion, motion.matched(target, periods=periods), target, periods)


def test_matched_spectrum_agrees_with_eqsig(quickly_matched):
    pytest.importorskip("eqsig")
    from eqsig import sdof

    fine = quickly_matched.resampled("0.001 s", interpolation="linear").si.horizontal
    periods = np.geomspace(0.2, 0.6, 97)
    displacement = sdof.nigam_and_jennings_response(fine.samples, fine.time_step, periods, 0.05)[0]
    acceleration = (2.0 * np.pi / periods) ** 2 * np.abs(displacement).max(axis=1)
    assert np.abs(acceleration / EUROCODE.at((periods, "s")) - 1.0).max() < 0.0505


def test_matching_is_documented_in_metadata_and_history(quickly_matched):
    metadata, sentence = quickly_matched.metadata, quickly_matched.history[-1]
    assert metadata["target_spectrum"] == EUROCODE.name
    assert metadata["matching_steps"] > 0
    assert "tapered cosine wavelets" in sentence
    assert "from 0.2 s to 0.6 s" in sentence
    assert quickly_matched.name == example().name
    assert quickly_matched.to_dict()["constructor"] is None
    twice = example().scaled(2.0)
    rematched = type(twice)(twice.si, metadata={"scale_factor": 2.0}).matched(
        EUROCODE, periods=RANGE
    )
    assert rematched.metadata["scale_factor"] == pytest.approx(metadata["scale_factor"], rel=1e-9)


def test_matching_reports_changes_of_other_measures(quickly_matched):
    weak = example().resampled("0.02 s").filtered(low="1.5 Hz")
    target = rf.TargetSpectrum.eurocode_8("0.3 g_0", "D")
    with pytest.warns(RecordWarning, match=r"spectrum 4\.\d+ times at 2\.\d+ s, beyond the range"):
        grown = weak.matched(target, periods=("0.4 s", "2 s"))
    for motion, matched in ((example(), quickly_matched), (weak, grown)):
        metadata = matched.metadata
        for stage, record in (
            ("before", motion.scaled(metadata["scale_factor"])),
            ("after", matched),
        ):
            measures = rf.intensity_measures(record).squeeze()
            for name in ("acceleration", "velocity", "displacement"):
                peak = float(measures[f"peak_ground_{name}"])
                assert metadata[f"peak_ground_{name}_{stage}_matching"] == pytest.approx(
                    peak, rel=1e-3
                )
            indicator = record.velocity_pulse().indicator
            assert metadata[f"pulse_indicator_{stage}_matching"] == pytest.approx(
                indicator, rel=1e-6
            )
        period = (metadata["period_of_spectral_growth"], "s")
        before, after = (
            float(rf.response_spectrum(record, period).pseudo_spectral_acceleration.squeeze())
            for record in (motion.scaled(metadata["scale_factor"]), matched)
        )
        assert metadata["spectral_growth_beyond_range"] == pytest.approx(after / before, rel=1e-3)


def test_growth_is_sought_up_to_five_times_the_longest_period():
    """A slow wave is added, to which an oscillator of its period responds most."""
    time = np.arange(2001) * 0.01
    before = Signal(0.01, np.sin(2.0 * np.pi * time / 0.5) * np.exp(-0.3 * time))
    goal = MatchingGoal(np.ones_like, 0.4, 0.8, 0.05, 0.05)
    for slow, most in ((3.6, 3.6), (8.0, 4.0)):
        wave = 0.2 * np.sin(2.0 * np.pi * time / slow)
        changes = matching_changes(before, Signal(0.01, before.samples + wave), goal)
        found = changes["period_of_spectral_growth"]
        assert found <= 4.0 * (1.0 + 1e-9)
        assert found == pytest.approx(most, rel=0.1)


def test_unusual_changes_reports_growth_above_50_percent():
    usual = {f"{name}_{stage}_matching": 1.0 for name in PEAKS for stage in ("before", "after")}
    usual |= {
        "pulse_indicator_before_matching": 0.2,
        "pulse_indicator_after_matching": 0.84,
        "spectral_growth_beyond_range": 1.49,
        "period_of_spectral_growth": 3.0,
    }
    assert unusual_changes(usual) == []
    for name, value, words in (
        ("peak_ground_acceleration_after_matching", 1.6, "acceleration 1.6 times"),
        ("peak_ground_velocity_after_matching", 1.6, "velocity 1.6 times"),
        ("peak_ground_displacement_after_matching", 12.0, "displacement 12 times"),
        ("spectral_growth_beyond_range", 1.6, "spectrum 1.6 times at 3 s, beyond the range"),
        ("pulse_indicator_after_matching", 0.9, "a velocity pulse where none was"),
    ):
        (change,) = unusual_changes({**usual, name: value})
        assert words in change


def test_matched_motion_survives_serialization_round_trips(quickly_matched):
    assert rf.GroundMotion.from_dataset(quickly_matched.to_dataset()) == quickly_matched
    assert rf.GroundMotion.from_dict(quickly_matched.to_dict(samples=True)) == quickly_matched
    suite = rf.MotionSuite({"one": quickly_matched})
    assert rf.MotionSuite.from_dataset(suite.to_dataset())["one"].sha256 == quickly_matched.sha256
    system = rf.System(rf.Block(width="1 m", height="3 m", mass="1 t"))
    response = system.simulate(quickly_matched)
    rebuilt = rf.System.from_dataset(response).motion
    assert rebuilt is not None
    assert rebuilt.sha256 == quickly_matched.sha256


def test_a_motion_that_has_the_spectrum_is_not_changed(quickly_matched):
    rematched = quickly_matched.matched(EUROCODE, periods=RANGE)
    assert rematched.sha256 == quickly_matched.sha256
    assert rematched.history[-1].startswith("not changed to match")
    periods = np.geomspace(0.2, 0.6, 200)
    own = rf.TargetSpectrum.from_spectrum(rf.response_spectrum(example(), (periods, "s")))
    same = example().matched(own, periods=RANGE)
    assert same.sha256 == example().sha256
    assert same.metadata["matching_steps"] == 0
    assert same.metadata["scale_factor"] == 1.0
    pulse = rf.GroundMotion.stochastic(6, "20 km", seed=1)
    own = rf.TargetSpectrum.from_spectrum(rf.response_spectrum(pulse, (periods, "s")))
    unchanged = pulse.matched(own, periods=RANGE)
    assert rf.GroundMotion.from_dict(unchanged.to_dict()).sha256 == pulse.sha256


def test_matching_does_not_change_vertical_component():
    up = rf.GroundMotion.stochastic(6, "20 km", seed=2).resampled("0.005 s")
    both = example().with_vertical(up)
    matched = both.matched(EUROCODE, periods=("0.3 s", "0.5 s"))
    assert matched.si.vertical is both.si.vertical
    assert not np.array_equal(matched.si.horizontal.samples, both.si.horizontal.samples)


def test_matching_replaces_polynomials_of_pulse_by_lines():
    pulse = rf.GroundMotion.ricker_wavelet("3 m/s^2", "0.5 s")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RecordWarning)
        matched = pulse.matched(EUROCODE, periods=("0.3 s", "0.5 s"))
    assert not matched.si.analytic
    assert "replaced by straight lines" in matched.history[-1]


@pytest.mark.long
def test_unreachable_target_spectrum_warns():
    """The spectrum jumps, which no spectrum at 5 % damping can follow."""
    jump = rf.TargetSpectrum.from_table(
        (["0.1 s", "0.4 s", "0.401 s", "1 s"]), ([9, 9, 1, 1], "m/s^2")
    )
    with pytest.warns(RecordWarning, match=r"5 % was not reached in \d+ steps") as caught:
        matched = example().matched(jump, periods=RANGE)
    assert "from 'table' at 0.4" in str(caught[0].message)
    assert matched.metadata["target_reached"] == 0
    assert matched.metadata["largest_spectral_misfit"] > 0.05
    periods = np.geomspace(0.2, 0.6, 301)
    misfit, before = (
        np.abs(spectrum_over_target(record, jump, periods) - 1.0).max()
        for record in (matched, example().scaled(matched.metadata["scale_factor"]))
    )
    assert misfit < before
    assert misfit == pytest.approx(matched.metadata["largest_spectral_misfit"], rel=0.02)


def test_coarse_time_step_warns():
    coarse = example().resampled("0.02 s")
    with pytest.warns(
        RecordWarning, match=r"coarse for periods from 0.15 s.*resampled\('0.01 s'\)"
    ):
        coarse.matched(EUROCODE, periods=("0.15 s", "0.3 s"))


@pytest.mark.parametrize(
    ("arguments", "error", "words"),
    [
        ({"target": 3}, ComponentError, "target needs a TargetSpectrum, got 3"),
        ({"target": example()}, ComponentError, "target needs a TargetSpectrum"),
        ({"periods": ("0.1 s",)}, ComponentError, "the shortest and the longest"),
        ({"periods": ("2 s", "1 s")}, ComponentError, "the shortest and the longest"),
        ({"periods": ("0 s", "1 s")}, ComponentError, "the shortest and the longest"),
        ({"periods": [0.1, 1.0]}, UnitsError, "needs a time with a unit"),
        ({"periods": ("1 m", "2 m")}, UnitsError, "needs a time"),
        ({"periods": ("0.01 s", "1 s")}, ComponentError, "must be 4 time steps or more, 0.02 s"),
        ({"periods": ("0.1 s", "9 s")}, ComponentError, "it is 15 s long"),
        ({"tolerance": 0}, ComponentError, "tolerance must be from 0.01 to 0.5"),
        ({"tolerance": "5 m"}, UnitsError, "tolerance"),
        ({"damping_ratio": 0.05}, TypeError, "the target has one"),
        (
            {"target": rf.TargetSpectrum.eurocode_8("1 m/s^2", damping_ratio=0.6)},
            ComponentError,
            "damping_ratio must be from 0.01 to 0.5",
        ),
        (
            {"target": rf.TargetSpectrum.from_table((["0.3 s", "1 s"]), ([1, 1], "m/s^2"))},
            ComponentError,
            "is known from 0.3 s to 1 s",
        ),
        (
            {"target": rf.TargetSpectrum("dips", lambda period: np.maximum(period - 0.3, 0.0))},
            ComponentError,
            "'dips' must be above zero, which it is not at 0.2 s",
        ),
    ],
)  # fmt: skip
def test_invalid_arguments_raise(arguments, error, words):
    with pytest.raises(error, match=words):
        example().matched(**{"target": EUROCODE, "periods": RANGE, **arguments})


def test_still_ground_is_refused():
    still = rf.GroundMotion.from_arrays((np.zeros(2000), "m/s^2"), "0.01 s", name="calm")
    with pytest.raises(ComponentError, match="'calm' has no acceleration"):
        still.matched(EUROCODE)


def test_a_motion_of_hours_is_refused():
    samples = np.random.default_rng(1).normal(size=200_000)
    long = rf.GroundMotion.from_arrays((samples, "m/s^2"), "0.01 s")
    with pytest.raises(ComponentError, match="are too many; expected at most"):
        long.matched(EUROCODE)
