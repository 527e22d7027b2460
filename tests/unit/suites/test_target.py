"""Target spectra from tables and codes agree with the printed equations."""

import copy
import pickle

import numpy as np
import pytest

import rockframe as rf
from rockframe.errors import ComponentError, RecordWarning, SchemaError, UnitsError

G = 9.80665


def test_table_is_interpolated_in_logarithms():
    periods, values = np.array([0.1, 0.5, 2.0]), np.array([4.0, 3.0, 0.5])
    target = rf.TargetSpectrum.from_table(
        (periods, "s"), (values, "m/s^2"), standard_deviations=[0.4, 0.6, 0.8], name="site"
    )
    np.testing.assert_allclose(target.at((periods, "s")), values, rtol=1e-14)
    middle = np.sqrt(periods[1:] * periods[:-1])
    np.testing.assert_allclose(target.at((middle, "s")), np.sqrt(values[1:] * values[:-1]))
    np.testing.assert_allclose(target.deviations_at(middle), [0.5, 0.7])
    assert target.limits == (0.1, 2.0)
    with pytest.raises(ComponentError, match=r"from 0.05 s to 0.05 s, but the target 'site' is"):
        target.at(["0.05 s"])
    assert target.scaled(2).at(["0.5 s"])[0] == pytest.approx(6.0)
    assert target.with_deviation(0.3).deviations_at(periods).tolist() == [0.3] * 3


@pytest.mark.parametrize("kind", [1, 2])
@pytest.mark.parametrize("ground", list("ABCDE"))
def test_eurocode_8(kind, ground):
    soil, first, second, third = {
        (1, "A"): (1.0, 0.15, 0.4, 2.0), (1, "B"): (1.2, 0.15, 0.5, 2.0),
        (1, "C"): (1.15, 0.20, 0.6, 2.0), (1, "D"): (1.35, 0.20, 0.8, 2.0),
        (1, "E"): (1.4, 0.15, 0.5, 2.0), (2, "A"): (1.0, 0.05, 0.25, 1.2),
        (2, "B"): (1.35, 0.05, 0.25, 1.2), (2, "C"): (1.5, 0.10, 0.25, 1.2),
        (2, "D"): (1.8, 0.10, 0.30, 1.2), (2, "E"): (1.6, 0.05, 0.25, 1.2),
    }[kind, ground]  # fmt: skip
    for damping, eta in ((0.05, 1.0), (0.15, np.sqrt(0.5)), (0.9, 0.55)):
        target = rf.TargetSpectrum.eurocode_8(
            "2 m/s^2", ground, spectrum_type=kind, damping_ratio=damping
        )
        for period in (0.0, 0.6 * first, first, 0.5 * (first + second), second, 1.1, third, 3.9):
            if period <= first:  # EN 1998-1, (3.2) to (3.5)
                shape = 1.0 + period / first * (eta * 2.5 - 1.0)
            elif period <= second:
                shape = eta * 2.5
            elif period <= third:
                shape = eta * 2.5 * second / period
            else:
                shape = eta * 2.5 * second * third / period**2
            assert target.at([f"{period!r} s"])[0] == pytest.approx(2.0 * soil * shape, rel=1e-12)


def test_eurocode_8_with_parameters_of_an_annex():
    target = rf.TargetSpectrum.eurocode_8(
        "0.3 g_0", soil_factor=1.3, corner_periods=["0.1 s", "0.45 s", "1.8 s"]
    )
    assert target.at(["0.3 s"])[0] == pytest.approx(0.3 * G * 1.3 * 2.5)
    assert target.at(["0.9 s"])[0] == pytest.approx(0.3 * G * 1.3 * 2.5 * 0.5)


def test_asce_7():
    target = rf.TargetSpectrum.asce_7("1.2 g_0", "0.6 g_0", long_period="6 s")
    for period, value in (
        (0.0, 0.48),
        (0.05, 0.84),
        (0.1, 1.2),
        (0.12, 1.2),
        (0.5, 1.2),
        (1.5, 0.4),
        (12.0, 0.025),
    ):
        assert target.at([f"{period} s"])[0] == pytest.approx(value * G, rel=1e-12), period


@pytest.fixture(scope="module")
def motions():
    return {name: rf.GroundMotion.stochastic(6.5, "20 km", seed=name) for name in (1, 2, 3)}


def converted(dataset, **units):
    """Return a dataset with variables in other units, each with its size in the unit it has."""
    for name, (unit, size) in units.items():
        values = dataset[name]
        changed = (values.dims, values.to_numpy() / size, {**values.attrs, "units": unit})
        dataset = (
            dataset.assign_coords({name: changed})
            if name in dataset.coords
            else (dataset.assign({name: changed}))
        )
    return dataset


def test_a_spectrum_in_other_units_is_the_same_target(motions):
    spectrum = rf.response_spectrum(motions, ["0.5 s", "1 s", "2 s"])
    logarithms = np.log(spectrum.pseudo_spectral_acceleration.isel(damping_ratio=0))
    in_g = converted(spectrum, pseudo_spectral_acceleration=("g_0", G), period=("ms", 1e-3))
    target = rf.TargetSpectrum.from_spectrum(in_g)
    assert target.at(["1 s"])[0] == pytest.approx(np.exp(logarithms.sel(period=1.0).mean()).item())
    assert target.limits == pytest.approx((0.5, 2.0))


def test_scaled_motions_do_not_depend_on_units_of_the_scaling(motions):
    suite = rf.MotionSuite({str(name): motion for name, motion in motions.items()})
    found = suite.scaling_to(rf.TargetSpectrum.eurocode_8("0.2 g_0"), conditioned_on=["1 s"])
    shown = converted(
        found, scale_factor=("percent", 0.01), target_spectral_acceleration=("g_0", G),
        period=("ms", 1e-3),
    )  # fmt: skip
    scaled = suite.scaled_to(shown)
    factor = found.scale_factor.sel(motion="1").item()
    expected = factor * np.abs(motions[1].si.horizontal.samples).max()
    assert scaled["1"].si.peak == pytest.approx(expected, rel=1e-12)
    # on the plateau, and at 1 s where velocities are constant
    assert scaled.target.at(["0.3 s", "1 s"]) == pytest.approx([0.5 * G, 0.2 * G], rel=1e-12)


def test_the_median_of_motions():
    motions = [rf.GroundMotion.stochastic(6, "20 km", seed=k) for k in range(4)]
    spectrum = rf.response_spectrum(
        {str(k): motion for k, motion in enumerate(motions)}, ([0.0, 0.2, 1.0], "s")
    )
    target = rf.TargetSpectrum.from_spectrum(spectrum)
    values = np.log(spectrum.pseudo_spectral_acceleration.values[:, 0, 1:])
    np.testing.assert_allclose(target.at(["0.2 s", "1 s"]), np.exp(values.mean(axis=0)))
    np.testing.assert_allclose(
        target.deviations_at(np.array([0.2, 1.0])), values.std(axis=0, ddof=1)
    )
    alone = rf.TargetSpectrum.from_spectrum(rf.response_spectrum(motions[0], ([0.2, 1.0], "s")))
    assert alone.deviation is None
    with pytest.raises(SchemaError, match="one damping ratio"):
        rf.TargetSpectrum.from_spectrum(rf.intensity_measures(motions[0]))


@pytest.mark.parametrize(
    ("make", "error", "words"),
    [
        (lambda: rf.TargetSpectrum.from_table(([0.1, 1.0], "s"), [1.0, 2.0]), UnitsError, "unit"),
        (lambda: rf.TargetSpectrum.from_table(([1.0], "s"), ([1.0], "g_0")), ComponentError, "two"),
        (
            lambda: rf.TargetSpectrum.from_table(([1.0, 0.5], "s"), ([1.0, 1.0], "g_0")),
            ComponentError,
            "increasing",
        ),
        (
            lambda: rf.TargetSpectrum.from_table(([0.5, 1.0], "s"), ([1.0, 2.0, 3.0], "g_0")),
            ComponentError,
            "accelerations must be 2, as the periods",
        ),
        (
            lambda: rf.TargetSpectrum.from_table(([0.5, 1.0], "s"), ([1.0, 0.0], "g_0")),
            ComponentError,
            "above zero",
        ),
        (
            lambda: rf.TargetSpectrum.from_table(
                ([0.5, 1.0], "s"), ([1.0, 1.0], "g_0"), standard_deviations=[0.1]
            ),
            ComponentError,
            "must be 2",
        ),
        (lambda: rf.TargetSpectrum.eurocode_8("0.2 kg"), UnitsError, "needs an acceleration"),
        (lambda: rf.TargetSpectrum.eurocode_8("0.2 g_0", "F"), ComponentError, "'A' or 'B'"),
        (
            lambda: rf.TargetSpectrum.eurocode_8("0.2 g_0", corner_periods=["1 s", "0.5 s", "2 s"]),
            ComponentError,
            "T_B, T_C and T_D",
        ),
        (
            lambda: rf.TargetSpectrum.asce_7("1 g_0", "1 g_0", long_period="0.5 s"),
            ComponentError,
            "must exceed",
        ),
    ],
)
def test_invalid_targets_are_refused(make, error, words):
    with pytest.raises(error, match=words):
        make()


def test_explicit_periods_too_short_for_record_warn():
    coarse = rf.GroundMotion.stochastic(6, "20 km", seed=1).resampled("0.02 s")
    suite = rf.MotionSuite([rf.GroundMotion.from_arrays(coarse.acceleration, "0.02 s")])
    target = rf.TargetSpectrum.eurocode_8("0.1 g_0")
    with pytest.warns(RecordWarning, match="MotionSuite.scaling_to: the record is .* from 0.1 s"):
        suite.scaling_to(target, periods=["0.1 s", "1 s"])
    with pytest.warns(RecordWarning, match="MotionSuite.scaling_to: the record is .* from 0.15 s"):
        suite.scaling_to(target, conditioned_on=["0.15 s"])
    suite.scaling_to(target)
    motion = suite["unnamed motion"]
    pair = rf.HorizontalPair(motion, motion)
    with pytest.warns(RecordWarning, match="rotated_spectrum: the record is .* from 0.1 s"):
        rf.rotated_spectrum(pair, ["0 s", "0.1 s", "1 s"])


EQUAL = {
    "table": lambda: rf.TargetSpectrum.from_table(
        (["0.1 s", "1 s"]), ([2.0, 0.2], "m/s^2"), standard_deviations=[0.4, 0.6]
    ),
    "Eurocode 8": lambda: rf.TargetSpectrum.eurocode_8("0.3 g_0", ground_type="B"),
    "ASCE 7": lambda: rf.TargetSpectrum.asce_7("1 g_0", "0.6 g_0"),
    "scaled": lambda: rf.TargetSpectrum.eurocode_8("0.3 g_0").scaled(2),
    "with a deviation": lambda: rf.TargetSpectrum.asce_7("1 g_0", "0.6 g_0").with_deviation(0.5),
}


@pytest.mark.parametrize("name", EQUAL)
def test_equal_targets_compare_and_hash_equal(name):
    target, periods = EQUAL[name](), np.array([0.1, 0.3, 1.0])
    pickled = pickle.loads(pickle.dumps(target))  # noqa: S301
    for copied in (EQUAL[name](), pickled, copy.deepcopy(target)):
        assert copied == target
        assert hash(copied) == hash(target)
        assert copied.at((periods, "s")).tolist() == target.at((periods, "s")).tolist()
        assert copied.deviations_at(periods).tolist() == target.deviations_at(periods).tolist()
    assert len({*(make() for make in EQUAL.values()), target}) == len(EQUAL)
    assert target != target.scaled(1.5)
    assert target != target.with_deviation(0.1)
