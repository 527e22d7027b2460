"""Scaling agrees with least squares of SciPy, selection with an exhaustive search."""

from itertools import combinations

import numpy as np
import pytest
from scipy.optimize import minimize_scalar
from unit.suites.downloads import Station, download, packed

import rockframe as rf
from rockframe.errors import ComponentError, SchemaError

PERIODS = (np.geomspace(0.1, 2.0, 12), "s")
STATIONS = tuple(
    Station(k, f"Quake {k % 4}", 6.0 + 0.1 * k, 10.0 + k, 300.0, vertical=k % 2 == 0)
    for k in range(1, 13)
)
SUITE = rf.read_suite(packed(download(STATIONS)))
FIRSTS = SUITE.select(axis="H1")
TARGET = rf.TargetSpectrum.eurocode_8("0.25 g_0", "B")


def spectra(suite, periods=PERIODS):
    dataset = rf.response_spectrum(suite, periods, 0.05)
    return dataset.pseudo_spectral_acceleration.values[:, 0]


def test_scale_factors_minimise_squared_misfit():
    scaling = FIRSTS.scaling_to(TARGET, periods=PERIODS, bounds=None)
    values, goal = spectra(FIRSTS), TARGET.at(PERIODS)
    for k in range(len(FIRSTS)):
        least = minimize_scalar(lambda x, row=values[k]: np.mean((x + np.log(row / goal)) ** 2))
        assert float(scaling.scale_factor[k]) == pytest.approx(np.exp(least.x), rel=1e-6)
        assert float(scaling.spectral_misfit[k]) == pytest.approx(np.sqrt(least.fun), rel=1e-6)
    scaled = scaling.scale_factor.values[:, None] * values
    np.testing.assert_allclose(scaling.scaled_spectral_acceleration, scaled, rtol=1e-12)
    np.testing.assert_allclose(scaling.set_median_acceleration, np.exp(np.log(scaled).mean(axis=0)))
    np.testing.assert_allclose(
        scaling.set_standard_deviation, np.log(scaled).std(axis=0, ddof=1), rtol=1e-10
    )
    np.testing.assert_allclose(scaling.target_spectral_acceleration, goal, rtol=1e-14)


def test_scaled_suite_has_predicted_spectra():
    scaling = FIRSTS.scaling_to(TARGET, periods=PERIODS)
    suite = FIRSTS.scaled_to(TARGET, periods=PERIODS)
    np.testing.assert_allclose(spectra(suite), scaling.scaled_spectral_acceleration, rtol=1e-12)
    for label, motion in suite.items():
        row = scaling.sel(motion=label)
        assert motion.metadata["scale_factor"] == float(row.scale_factor)
        assert motion.metadata["spectral_misfit"] == float(row.spectral_misfit)
        assert "scaled by" in motion.history[-1]
    twice = suite.changed(lambda motion: motion.scaled(1.0)).scaled_to(TARGET, periods=PERIODS)
    assert twice.table["scale_factor"].tolist() == pytest.approx(
        suite.table["scale_factor"].tolist()
    )


def test_conditioning_period_or_average_matches_target():
    at_period = FIRSTS.scaled_to(TARGET, conditioned_on=["0.7 s"], periods=PERIODS, bounds=None)
    np.testing.assert_allclose(
        spectra(at_period, ["0.7 s"])[:, 0], TARGET.at(["0.7 s"])[0], rtol=1e-12
    )
    several = (np.linspace(0.2, 1.5, 9), "s")
    many = FIRSTS.scaled_to(TARGET, conditioned_on=several, periods=PERIODS, bounds=None)
    averages = many.average_spectral_acceleration(several).average_spectral_acceleration
    goal = np.exp(np.log(TARGET.at(several)).mean())
    np.testing.assert_allclose(averages, goal, rtol=1e-12)


def test_scale_factors_respect_bounds():
    free = FIRSTS.scaling_to(TARGET, periods=PERIODS, bounds=None)
    low, high = np.quantile(free.scale_factor, [0.2, 0.7])
    bound = FIRSTS.scaling_to(TARGET, periods=PERIODS, bounds=(low, high))
    np.testing.assert_allclose(bound.scale_factor, np.clip(free.scale_factor, low, high))
    assert bound.attrs["factors_at_a_bound"] == int(
        ((free.scale_factor < low) | (free.scale_factor > high)).sum()
    )
    chosen = FIRSTS.selection_for(TARGET, 5, periods=PERIODS, bounds=(low, high))
    assert ((chosen.scale_factor >= low) & (chosen.scale_factor <= high)).all()
    with pytest.raises(
        ComponentError, match=r"of 12 motions have factors from .*too few for a set of 12"
    ):
        FIRSTS.selection_for(TARGET, 12, periods=PERIODS, bounds=(low, high))
    with pytest.raises(ComponentError, match=r"found 12 motions, too few .* of 13; lower count$"):
        FIRSTS.selection_for(TARGET, 13, periods=PERIODS, bounds=None)


def test_factors_are_from_a_quarter_to_four_by_default():
    """Motions with 1/10, 1/3, 1, 3 and 10 times the spectrum of one that needs no factor."""
    one = rf.GroundMotion.stochastic(6.5, "20 km", seed=4)
    target = rf.TargetSpectrum.from_spectrum(rf.response_spectrum(one, PERIODS))
    shares = [0.1, 1.0 / 3.0, 1.0, 3.0, 10.0]
    suite = rf.MotionSuite({f"{share:g}": one.scaled(share) for share in shares})
    found = suite.scaling_to(target, periods=PERIODS)
    np.testing.assert_allclose(found.scale_factor, [4.0, 3.0, 1.0, 1.0 / 3.0, 0.25], rtol=1e-9)
    np.testing.assert_allclose(
        found.spectral_misfit, [np.log(2.5), 0.0, 0.0, 0.0, np.log(2.5)], atol=1e-9
    )
    assert found.attrs["factors_at_a_bound"] == 2
    chosen = suite.selection_for(target, 3, periods=PERIODS)["motion"].to_numpy()
    assert sorted(chosen.tolist()) == ["0.333333", "1", "3"]
    # of two motions the deviation is their distance over the square root of two
    pair = rf.MotionSuite({"weak": one.scaled(0.2), "strong": one.scaled(5.0)})
    spread = pair.scaling_to(target, periods=PERIODS).set_standard_deviation
    np.testing.assert_allclose(spread, np.log(1.25**2) / np.sqrt(2.0), rtol=1e-9)
    both = rf.TargetSpectrum.from_spectrum(rf.response_spectrum(pair, PERIODS))
    deviations = both.deviations_at(PERIODS[0])
    np.testing.assert_allclose(deviations, np.log(25.0) / np.sqrt(2.0), rtol=1e-9)


@pytest.mark.long
def test_components_of_pair_share_scale_factor():
    suite = rf.read_suite(packed(download(STATIONS[:4])))
    names = {
        "geometric mean": "geometric_mean_acceleration",
        "RotD50": "median_rotated_acceleration",
        "RotD100": "greatest_rotated_acceleration",
    }
    for combination, name in names.items():
        arguments = {"periods": PERIODS, "combination": combination}
        scaling = suite.scaling_to(TARGET, **arguments)
        assert scaling["motion"].to_numpy().tolist() == list(suite.pairs)
        values = suite.rotated_spectrum(PERIODS)[name].values[:, 0]
        factors = np.exp(np.log(TARGET.at(PERIODS) / values).mean(axis=1)).clip(0.25, 4.0)
        np.testing.assert_allclose(scaling.scale_factor, factors, rtol=1e-12)
        scaled = suite.scaled_to(TARGET, **arguments)
        assert len(scaled) == len(suite)
        assert len(scaled.verticals) == len(suite.verticals) > 0
        for label, motion in (*scaled.items(), *scaled.verticals.items()):
            factor = float(scaling.scale_factor.sel(motion=motion.metadata["record"]))
            before = suite.get(label, suite.verticals.get(label))
            np.testing.assert_allclose(
                motion.si.horizontal.samples, factor * before.si.horizontal.samples, rtol=1e-12
            )
    with pytest.raises(ComponentError, match="the suite has no pair"):
        FIRSTS.scaling_to(TARGET, combination="RotD50")


def misfit(residuals, chosen, deviations, weight) -> float:
    """Misfit of a set from its definition."""
    members = residuals[list(chosen)]
    spread = members.std(axis=0, ddof=1) if len(members) > 1 else np.zeros(members.shape[1])
    return float(np.sqrt(np.mean(members.mean(axis=0) ** 2 + weight * (spread - deviations) ** 2)))


@pytest.mark.parametrize(
    "count", [2, 4, *(pytest.param(n, marks=pytest.mark.long) for n in (1, 6))]
)
@pytest.mark.parametrize(
    ("deviation", "weight"), [(None, None), (0.3, None), (0.5, 0.5), (None, 2.0)]
)
@pytest.mark.parametrize("conditioned", [None, ["0.5 s"]])
def test_selected_set_is_global_optimum(count, deviation, weight, conditioned):
    target = TARGET if deviation is None else TARGET.with_deviation(deviation)
    selection = FIRSTS.selection_for(
        target, count, periods=PERIODS, conditioned_on=conditioned, bounds=None,
        spread_weight=weight,
    )  # fmt: skip
    fixed = PERIODS if conditioned is None else conditioned
    factors = np.exp(np.log(target.at(fixed) / spectra(FIRSTS, fixed)).mean(axis=1))
    residuals = np.log(factors[:, None] * spectra(FIRSTS) / target.at(PERIODS))
    weight_used = (0.0 if deviation is None else 1.0) if weight is None else weight
    spread = np.full(12, deviation or 0.0)
    misfits = {
        chosen: misfit(residuals, chosen, spread, weight_used)
        for chosen in combinations(range(12), count)
    }
    best = min(misfits, key=lambda chosen: misfits[chosen])
    assert float(selection.set_misfit) == pytest.approx(misfits[best], rel=1e-9)
    assert set(selection["motion"].to_numpy().tolist()) == {list(FIRSTS)[k] for k in best}
    assert (np.diff(selection.spectral_misfit) >= 0.0).all()


def test_a_large_set_is_better_than_chance():
    rng = np.random.default_rng(5)
    target = TARGET.with_deviation(0.4)
    selection = SUITE.selection_for(target, 11, periods=PERIODS, bounds=None)
    factors = np.exp(np.log(target.at(PERIODS) / spectra(SUITE)).mean(axis=1))
    residuals = np.log(factors[:, None] * spectra(SUITE) / target.at(PERIODS))
    spread = np.full(12, 0.4)
    tried = [misfit(residuals, rng.choice(24, 11, replace=False), spread, 1.0) for _ in range(5000)]
    assert float(selection.set_misfit) < min(tried)


def test_per_event_limits_motions_of_one_earthquake():
    free = SUITE.chosen_for(TARGET, 8, periods=PERIODS, bounds=None)
    assert len(free) == 8
    bound = SUITE.chosen_for(TARGET, 8, periods=PERIODS, bounds=None, per_event=2)
    events = [motion.metadata["event"] for motion in bound.values()]
    assert max(events.count(event) for event in events) == 2
    with pytest.raises(ComponentError, match="at most 1 motions of an earthquake make no set of 8"):
        SUITE.chosen_for(TARGET, 8, periods=PERIODS, bounds=None, per_event=1)


def test_combination_selects_pairs_of_components():
    chosen = SUITE.chosen_for(TARGET, 3, periods=PERIODS, combination="RotD50")
    assert len(chosen) == 6
    assert len(chosen.pairs) == 3


@pytest.mark.parametrize(
    ("invalid", "words"),
    [
        ({"target": "EC8"}, "target needs a TargetSpectrum, got 'EC8'"),
        ({"bounds": (4.0, 0.25)}, "bounds must be the least and the greatest"),
        ({"bounds": (0.5,)}, "bounds must be the least and the greatest"),
        ({"combination": "SRSS"}, "combination must be 'each' or"),
        ({"count": 0}, "count must be a whole number"),
        ({"spread_weight": -1.0}, "spread_weight must be zero or more"),
        ({"periods": (["1 s", "0.5 s"])}, "increasing"),
    ],
)
def test_arguments_are_checked(invalid, words):
    arguments = {"target": TARGET, "count": 2, **invalid}
    with pytest.raises(ComponentError, match=words):
        FIRSTS.selection_for(**arguments)


def test_invalid_motions_and_targets_raise():
    still = rf.GroundMotion.from_arrays(([0.0, 0.0, 0.0], "m/s^2"), "0.01 s")
    with pytest.raises(ComponentError, match="'still' has no acceleration"):
        rf.MotionSuite({"still": still}).scaling_to(TARGET)
    with pytest.raises(SchemaError, match="expected a TargetSpectrum, or"):
        FIRSTS.scaled_to(FIRSTS.intensity_measures())
    scaling = SUITE.scaling_to(TARGET, periods=PERIODS)
    with pytest.raises(ComponentError, match="the suite has no 'RSN1_MADE_S1090'"):
        FIRSTS.scaled_to(scaling)
    short = rf.TargetSpectrum.from_table(([0.2, 1.0], "s"), ([1.0, 1.0], "m/s^2"))
    assert FIRSTS.scaling_to(short).period.values[[0, -1]].tolist() == [0.2, 1.0]
    with pytest.raises(ComponentError, match=r"is known from 0\.2 s to 1 s"):
        FIRSTS.scaling_to(short, periods=PERIODS)


def test_figure_shows_selection():
    target = TARGET.with_deviation(0.4)
    selection = SUITE.selection_for(target, 5, periods=PERIODS)
    figure = rf.plot.selection(selection).figure
    spectra_axes, misfits = figure.axes
    lines = {line.get_label(): line for line in spectra_axes.get_lines()}
    np.testing.assert_array_equal(
        lines["target"].get_ydata(), selection.target_spectral_acceleration
    )
    np.testing.assert_array_equal(lines["median"].get_ydata(), selection.set_median_acceleration)
    assert len(spectra_axes.get_lines()) == 5 + 2 * 3
    widths = [bar.get_width() for bar in misfits.patches]
    np.testing.assert_array_equal(widths, selection.spectral_misfit)
    with pytest.raises(SchemaError, match=r"rf\.plot\.selection needs a set of motions"):
        rf.plot.selection(FIRSTS.intensity_measures())
