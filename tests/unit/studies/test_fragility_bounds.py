"""Bounds of fragilities: covariances by hand, coverage, and warnings."""

import numpy as np
import pytest
from pages import table
from scipy import optimize, stats

import rockframe as rf
from rockframe.studies.fragility import labelling
from rockframe.studies.fragility.labelling import BoundSettings, fragility_dataset
from rockframe.studies.fragility.likelihood import (
    Bands,
    FragilityStatus,
    boundary,
    fit,
    gap,
    sandwich,
)
from rockframe.studies.fragility.ordered import ordered_fits
from rockframe.studies.fragility.trials import StructureTrials, Trials
from rockframe.studies.fragility.words import COVERAGE, bound_sentences, enough_trials

SCALES = np.array([0.5, 1.0, 1.5, 2.0, 3.0, 4.0, 6.0])
MEASURE = ("peak_ground_acceleration", {"units": "m s^-2"})


def runs_of(rng, motions, dispersion):
    """Return runs of motions at all scales, with lognormal capacities of median 1."""
    logs = rng.normal(np.log(0.5), 0.4, motions)[:, None] + np.log(SCALES)
    over = logs > rng.normal(0.0, dispersion, motions)[:, None]
    return logs.ravel(), over.ravel().astype(float), np.repeat(np.arange(motions), len(SCALES))


def sandwich_fit(logs, over, cluster):
    """Return fit and sandwich covariance of a probit regression, from the definition."""
    rows = np.column_stack([np.ones(len(logs)), logs])

    def loss(at):
        return -np.sum(stats.norm.logcdf(np.where(over == 1.0, 1.0, -1.0) * (rows @ at)))

    best = optimize.minimize(loss, [0.0, 1.0], method="Nelder-Mead",
                             options={"xatol": 1e-10, "fatol": 1e-13}).x  # fmt: skip
    eta = rows @ best
    density, share = stats.norm.pdf(eta), stats.norm.cdf(eta)
    score = rows * (density * (over - share) / (share * (1.0 - share)))[:, None]
    step = 1e-4
    curvature = np.empty((2, 2))
    for i, j in np.ndindex(2, 2):
        a, b = step * np.eye(2)[i], step * np.eye(2)[j]
        cross = loss(best + a + b) - loss(best + a - b) - loss(best - a + b) + loss(best - a - b)
        curvature[i, j] = cross / (4.0 * step**2)
    names = np.unique(cluster)
    filling = sum(np.outer(*[score[cluster == one].sum(axis=0)] * 2) for one in names)
    inverse = np.linalg.inv(curvature)
    return best, len(names) / (len(names) - 1.0) * inverse @ filling @ inverse


@pytest.mark.parametrize("motions", [3, 6])
def test_sandwich_covariance_follows_its_definition(motions):
    """The factor for few clusters is 1.5 with three of them, 1.2 with six."""
    logs, over, cluster = runs_of(np.random.default_rng(4), motions, 0.5)
    best, covariance = sandwich_fit(logs, over, cluster)
    found = fit(Trials.from_verdicts(logs[:, None], over, np.ones(len(over)), cluster),
                Bands.SANDWICH)  # fmt: skip
    assert found.coefficients == pytest.approx(best, rel=1e-5, abs=1e-6)
    assert found.covariance == pytest.approx(covariance, rel=1e-4, abs=1e-6)


def test_sandwich_of_two_clusters_is_twice_that_of_known_scores():
    """The factor n / (n - 1) is 2 for two clusters."""
    inverse = np.diag([2.0, 3.0])
    two = sandwich(inverse, np.array([[1.0, 0.5], [0.0, 1.0]]), np.ones(2))
    np.testing.assert_allclose(two, 2.0 * np.array([[4.0, 3.0], [3.0, 9.0 * 1.25]]))


@pytest.mark.parametrize("dispersion", ["each", "common"])
@pytest.mark.parametrize("bands", ["jackknife", "sandwich"])
def test_runs_under_one_motion_have_no_standard_errors(bands, dispersion):
    """By the jackknife they were zero, or an error of NumPy with a common dispersion."""
    logs, over, cluster = runs_of(np.random.default_rng(1), 40, 0.6)
    verdicts = np.stack([over, (logs > np.log(1.5)) * over])
    if dispersion == "common":
        fits = ordered_fits(logs, verdicts, 0 * cluster, ("light", "heavy"), Bands(bands))
    else:
        trials = Trials.from_verdicts(logs[:, None], over, np.ones(len(logs)), 0 * cluster)
        fits = [fit(trials, Bands(bands))]
    for one in fits:
        assert one.status is FragilityStatus.FITTED
        assert np.isnan(one.covariance).all()
    structure = StructureTrials(
        Trials.from_verdicts(logs[:, None], over, np.ones(len(logs)), 0 * cluster),
        (np.exp(logs)[:, None], over), 0, 1,
    )  # fmt: skip
    found = fragility_dataset(
        [structure], {"limit_state": 1}, [MEASURE], BoundSettings(Bands(bands), 0.95), {}, fits[:1]
    )
    assert np.isfinite(found.median_intensity).all()
    for name in ("log_median_error", "dispersion_error", "median_intensity_lower_bound"):
        assert np.isnan(found[name]).all(), name
    ones = np.array([1])
    (sentence,) = bound_sentences(Bands(bands), 0.95, ones, 280 * ones, kind="motions")
    assert sentence.startswith("There are no bounds: 1 motion is too few, ")


def test_bands_of_counts_treat_each_trial_as_a_cluster():
    logs, over, count = np.log([0.5, 1.0, 2.0]), np.array([1.0, 2.0, 3.0]), np.full(3, 4.0)
    counted = Trials.from_verdicts(logs[:, None], over, count)
    found = fit(counted, Bands.SANDWICH)
    each = [(one, 1.0) for one, k in zip(logs, over, strict=True) for _ in range(int(k))]
    each += [(one, 0.0) for one, k in zip(logs, count - over, strict=True) for _ in range(int(k))]
    alone, verdict = np.array(each).T
    best, covariance = sandwich_fit(alone, verdict, np.arange(len(alone)))
    assert found.coefficients == pytest.approx(best, rel=1e-5, abs=1e-6)
    assert found.covariance == pytest.approx(covariance, rel=1e-4, abs=1e-6)
    apart = Trials.from_verdicts(alone[:, None], verdict, np.ones(12), np.arange(12))
    one, other = (fit(trials, Bands.JACKKNIFE) for trials in (counted, apart))
    assert one.clusters == other.clusters == 12.0
    assert one.covariance == pytest.approx(other.covariance, rel=1e-7)


def test_the_jackknife_leaves_out_each_motion_in_turn():
    logs, over, cluster = runs_of(np.random.default_rng(4), 6, 0.5)
    trials = Trials.from_verdicts(logs[:, None], over, np.ones(len(over)), cluster)
    found = fit(trials, Bands.JACKKNIFE)
    rows = np.array(
        [
            sandwich_fit(*(each[cluster != one] for each in (logs, over, cluster)))[0]
            for one in range(6)
        ]
    )
    assert found.leave_one_out[0] == pytest.approx(rows, rel=1e-4, abs=1e-5)
    spread = rows - found.coefficients
    assert found.covariance == pytest.approx(5.0 / 6.0 * spread.T @ spread, rel=1e-3, abs=1e-5)


def test_jackknife_bounds_follow_their_definition():
    """Student's t with one degree of freedom less than motions, about an unbiased dispersion."""
    motions = 6
    logs, over, cluster = runs_of(np.random.default_rng(4), motions, 0.5)
    trials = Trials.from_verdicts(logs[:, None], over, np.ones(len(over)), cluster)
    found = fragility_dataset(
        [StructureTrials(trials, None, 0, motions)], {"limit_state": 1}, [MEASURE],
        BoundSettings(Bands.JACKKNIFE, 0.9), {"trials": "runs"},
    ).isel(limit_state=0)  # fmt: skip

    def estimates(included):
        (intercept, slope), _ = sandwich_fit(logs[included], over[included], cluster[included])
        return np.array([-intercept / slope, -np.log(slope)])

    every = estimates(cluster >= 0)
    rest = np.array([estimates(cluster != one) for one in range(motions)])
    errors = np.sqrt((motions - 1.0) / motions * ((rest - every) ** 2).sum(axis=0))
    # the bias of the logarithm of the standard deviation of as many known capacities
    lacking = -0.5 * stats.chi2(motions - 1).expect(lambda q: np.log(q / motions))
    reach = stats.t.ppf(0.95, motions - 1) * errors
    for name, middle, error in zip(
        ("median_intensity", "dispersion"), every + np.array([0.0, lacking]), reach, strict=True
    ):
        for end, sign in (("lower", -1.0), ("upper", 1.0)):
            bound = found[f"{name}_{end}_bound"].item()
            assert np.log(bound) == pytest.approx(middle + sign * error, abs=2e-4), (name, end)


@pytest.mark.long
def test_bounds_by_jackknife_hold_with_few_motions():
    """With five motions; samples that an intensity separates have no bounds."""
    rng, samples = np.random.default_rng(9), []
    for _ in range(200):
        logs, over, cluster = runs_of(rng, 5, 0.4)
        trials = Trials.from_verdicts(logs[:, None], over, np.ones(len(over)), cluster)
        samples.append((trials, 5))
    shares, count = held(samples, 0.4, Bands.JACKKNIFE)
    assert count >= 5
    for share in shares:
        assert share >= 0.95 - 3.0 * np.sqrt(0.95 * 0.05 / count)


def test_separated_counts_have_the_bounds_of_their_likelihood():
    """If 3 of 5 exceed at one intensity, none below and all above, that intensity is the median."""
    found = rf.fragility(
        {"intensity": ([1.0, 2.0, 3.0, 4.0], "m/s^2"), "exceeded": [0, 0, 3, 5], "trials": 5}
    )
    assert found.fragility_status == FragilityStatus.SEPARATED
    drop = -2.0 * np.log(0.05 / 19.0)  # 20 trials can be separated in 19 ways
    dispersions = np.geomspace(0.01, 2.0, 400)[:, None, None]
    medians = np.linspace(1.0, 5.0, 801)[None, :, None]
    eta = np.log(np.array([1.0, 2.0, 3.0, 4.0]) / medians) / dispersions
    counts = np.array([0.0, 0.0, 3.0, 5.0])
    of_each = counts * stats.norm.logcdf(eta) + (5.0 - counts) * stats.norm.logcdf(-eta)
    greatest = 3.0 * np.log(0.6) + 2.0 * np.log(0.4)
    inside = 2.0 * (greatest - of_each.sum(axis=2)) <= drop
    rows, columns = np.nonzero(inside)
    least, most = medians[0, [columns.min(), columns.max()], 0]
    assert found.median_intensity_lower_bound == pytest.approx(least, abs=0.02)
    assert found.median_intensity_upper_bound == pytest.approx(most, abs=0.02)
    assert found.dispersion_upper_bound == pytest.approx(dispersions[rows.max(), 0, 0], rel=0.02)
    assert found.dispersion_lower_bound == 0.0
    assert "the median lies from" in found.verdict


def test_separated_single_runs_have_bounds_with_coverage():
    """One in three samples of ten runs is separated, and has bounds like the others."""
    rng, samples, runs = np.random.default_rng(5), [], 10
    for _ in range(150):
        logs = 0.6 * rng.standard_normal(runs)
        over = (0.4 * rng.standard_normal(runs) < logs).astype(float)
        trials = Trials.from_verdicts(logs[:, None], over, np.ones(runs))
        samples.append(StructureTrials(trials, None, 0, runs))
    found = fragility_dataset(
        samples, {"limit_state": len(samples)}, [MEASURE], BoundSettings(Bands.PROFILE, 0.95),
        {"trials": "runs"},
    )  # fmt: skip
    bounded = found.dispersion_upper_bound.notnull()
    separated = found.fragility_status == FragilityStatus.SEPARATED
    assert bounded.where(separated).sum() == separated.sum() > 0
    for name, truth in (("median_intensity", 1.0), ("dispersion", 0.4)):
        inside = (found[f"{name}_lower_bound"] <= truth) & (found[f"{name}_upper_bound"] >= truth)
        assert float(inside[bounded].mean()) >= 0.9, name


@pytest.mark.parametrize(("runs", "capacity_spread"), [(10, 0.7), (20, 0.4)])
def test_bounds_hold_where_separation_is_rare(runs, capacity_spread):
    """One sample in seven, or in twenty, is separated, though the dispersion is large."""
    rng, samples = np.random.default_rng(6), []
    while len(samples) < 40:
        logs = 0.6 * rng.standard_normal(runs)
        over = (capacity_spread * rng.standard_normal(runs) < logs).astype(float)
        trials = Trials.from_verdicts(logs[:, None], over, np.ones(runs))
        if 0.0 < over.sum() < runs and gap(trials) is not None:
            samples.append(StructureTrials(trials, None, 0, runs))
    found = fragility_dataset(
        samples, {"limit_state": len(samples)}, [MEASURE], BoundSettings(Bands.PROFILE, 0.95),
        {"trials": "runs"},
    )  # fmt: skip
    for name, truth in (("median_intensity", 1.0), ("dispersion", capacity_spread)):
        inside = (found[f"{name}_lower_bound"] <= truth) & (found[f"{name}_upper_bound"] >= truth)
        assert float(inside.mean()) >= 0.85, name


def test_bracketed_capacities_have_likelihood_bounds():
    """Rays towards negative slopes, where brackets have no likelihood, end before them."""
    ends = np.log([[0.80, 0.75, 1.11, 0.54, 0.85], [1.07, 1.00, 1.67, 1.08, 1.28]])
    lower, upper = ends[:, :, None]
    known = np.ones(5, dtype=bool)
    trials = Trials(lower, upper, known, known, np.ones(5), None)
    intercept, slope = boundary(trials, fit(trials, Bands.PROFILE), 0.95)
    assert slope.min() > 0.0
    medians = np.linspace(-0.4, 0.4, 801)[:, None]
    dispersions = np.geomspace(0.01, 1.0, 600)
    shares = [
        stats.norm.cdf((up - medians) / dispersions) - stats.norm.cdf((low - medians) / dispersions)
        for low, up in zip(*ends, strict=True)
    ]
    with np.errstate(divide="ignore"):
        likely = 2.0 * np.log(shares).sum(axis=0)
    rows, columns = np.nonzero(likely >= likely.max() - stats.chi2.ppf(0.95, 1))
    found = -intercept / slope
    assert [found.min(), found.max()] == pytest.approx(medians[[rows[0], rows[-1]], 0], abs=2e-3)
    assert 1.0 / slope.min() == pytest.approx(dispersions[columns.max()], rel=0.02)


def held(samples, dispersion, bands):
    """Return the shares of samples whose bounds contain the median, 1, and the dispersion."""
    found = fragility_dataset(
        [StructureTrials(trials, None, 0, independent) for trials, independent in samples],
        {"limit_state": len(samples)}, [MEASURE], BoundSettings(bands, 0.95), {"trials": "runs"},
    )  # fmt: skip
    fitted = found.fragility_status == FragilityStatus.FITTED
    assert found.median_intensity_lower_bound.where(~fitted).isnull().all()
    fitted &= found.median_intensity_lower_bound.notnull()
    shares = []
    for name, truth in (("median_intensity", 1.0), ("dispersion", dispersion)):
        inside = (found[f"{name}_lower_bound"] <= truth) & (found[f"{name}_upper_bound"] >= truth)
        shares.append(float(inside[fitted].mean()))
    return shares, float(fitted.sum())


@pytest.mark.wide
@pytest.mark.parametrize("motions", [10, 20])
def test_sandwich_bounds_have_documented_coverage(motions):
    rng, samples = np.random.default_rng(8), []
    for _ in range(200):
        logs, over, cluster = runs_of(rng, motions, 0.4)
        trials = Trials.from_verdicts(logs[:, None], over, np.ones(len(over)), cluster)
        samples.append((trials, motions))
    shares, count = held(samples, 0.4, Bands.SANDWICH)
    for share, documented in zip(shares, COVERAGE[Bands.SANDWICH][motions], strict=True):
        assert share == pytest.approx(
            documented, abs=3.0 * np.sqrt(documented * (1.0 - documented) / count)
        )


@pytest.mark.parametrize("count", [5, 10])
def test_profile_bounds_have_documented_coverage(count):
    """For known capacities, coverage follows from Student's t and the chi-squared distribution."""
    documented = COVERAGE[Bands.PROFILE][count]
    drop = stats.chi2.ppf(0.95, 1)
    # the likelihood ratio of a mean is n ln(1 + t^2 / (n - 1))
    reach = np.sqrt((count - 1) * np.expm1(drop / count))
    assert documented.median == pytest.approx(2.0 * stats.t.cdf(reach, count - 1) - 1.0, abs=0.006)

    # that of a deviation depends on n s^2 / beta^2, chi-squared with n - 1 degrees of freedom
    def ratio(q):
        return q - count - count * np.log(q / count) - drop

    ends = [optimize.brentq(ratio, 1e-6, count), optimize.brentq(ratio, count, 20.0 * count)]
    exact = np.diff(stats.chi2.cdf(ends, count - 1)).item()
    assert documented.dispersion == pytest.approx(exact, abs=0.006)


def test_too_few_motions_have_no_bounds():
    rng = np.random.default_rng(1)
    for bands, fewest in ((Bands.SANDWICH, 10), (Bands.PROFILE, 5)):
        assert not enough_trials(bands, fewest - 1)
        assert enough_trials(bands, fewest)
    logs, over, cluster = runs_of(rng, 9, 0.5)
    trials = Trials.from_verdicts(logs[:, None], over, np.ones(len(over)), cluster)
    for independent, lacking in ((9, True), (10, False)):
        found = fragility_dataset(
            [StructureTrials(trials, None, 0, independent)], {"limit_state": 1}, [MEASURE],
            BoundSettings(Bands.SANDWICH, 0.95), {"trials": "runs"},
        )  # fmt: skip
        assert found.median_intensity.notnull().all()
        for name in ("median_intensity", "dispersion", "exceedance_probability"):
            for end in ("lower", "upper"):
                assert found[f"{name}_{end}_bound"].isnull().all() == lacking, name


def test_verdict_describes_quality_of_bounds():
    def statement(bands, independent, trials=200, confidence=0.95, **more):
        counts = np.array([independent]), np.array([trials])
        return " ".join(bound_sentences(bands, confidence, *counts, kind="motions", **more))

    assert statement(Bands.SANDWICH, 6) == (
        "There are no bounds: 6 motions are too few, 10 are needed."
    )
    assert statement(Bands.SANDWICH, 12, confidence=0.9) == (
        "With 12 motions bounds of nominal 90 % are too narrow: of 10, those of 95 % held the "
        "median in 89 %, the dispersion in 80 % of simulated samples."
    )
    assert "of 20, those of 95 % held the median in 92 %" in statement(Bands.SANDWICH, 39)
    assert statement(Bands.SANDWICH, 12, measures=2) == (
        "With 12 motions bounds of nominal 95 % are too narrow."
    )
    assert statement(Bands.SANDWICH, 80) == ""
    assert "for independent" in statement(Bands.PROFILE, 20)
    assert statement(Bands.PROFILE, 20, trials=20) == ""
    counted = rf.fragility(
        {"intensity": ([1.0, 2.0, 4.0], "m/s^2"), "exceeded": [0, 1, 1], "trials": 1}
    )
    assert counted.verdict.endswith("all did from 2 on: so the dispersion is not known, only that "
                                    "it may be small, and there are no bounds.")  # fmt: skip


def fragility_of_row(count):
    """Fit single trials at intensities that grow by 5 % each, of which those above 1 exceeded."""
    levels = np.exp(0.05 * (np.arange(count) - 20.0))
    over = (levels > 1.0).astype(int)
    return levels, rf.fragility(
        {"intensity": (levels, "m/s^2"), "exceeded": over, "trials": np.ones(count, dtype=int)}
    )


def test_many_intensities_are_counted_in_ten_groups():
    """41 of them at equal ratios: four in each group, and the greatest in the last one too."""
    levels, found = fragility_of_row(41)
    assert found.stripe_trials.values.tolist() == [4] * 9 + [5]
    assert found.stripe_exceedances.values.tolist() == [0] * 5 + [3, 4, 4, 4, 5]
    # from the 21st on, the middle of the trials of the sixth group, exceeded by 3 of 4
    np.testing.assert_allclose(found.stripe_intensity, levels[2::4], rtol=1e-9)
    lower, upper = stats.beta.ppf(0.025, 3, 2), stats.beta.ppf(0.975, 4, 1)
    assert found.stripe_fraction_lower_bound[5].item() == pytest.approx(lower)
    assert found.stripe_fraction_upper_bound[5].item() == pytest.approx(upper)
    # up to thirty remain apart
    levels, found = fragility_of_row(30)
    np.testing.assert_allclose(found.stripe_intensity, levels, rtol=1e-9)
    assert found.stripe_trials.values.tolist() == [1] * 30
    assert fragility_of_row(31)[1].sizes["stripe"] == 10


def test_capacities_are_counted_at_ten_of_them():
    """21 brackets end at the logarithms 0 to 20; counts are made at every other one."""
    ends, every = np.arange(21.0)[:, None], np.ones(21, dtype=bool)
    trials = Trials(ends - 0.1, ends, every, every, np.ones(21), None)
    [(intensities, verdicts)] = labelling._capacity_verdicts([trials])
    logs = np.log(intensities[:, 0]).reshape(21, 10)
    np.testing.assert_allclose(logs, np.tile(np.arange(1.0, 20.0, 2.0), (21, 1)))
    assert verdicts.reshape(21, 10).sum(axis=0).tolist() == list(range(2, 21, 2))
    # within a bracket, and beyond an open end, nothing is known
    wide = Trials(ends - 2.5, ends, every, every, np.ones(21), None)
    [(_, verdicts)] = labelling._capacity_verdicts([wide])
    verdicts = verdicts.reshape(21, 10)
    assert np.isnan(verdicts[:, 0]).tolist() == [k in (2, 3) for k in range(21)]
    assert verdicts[4, 0] == 0.0
    safe = Trials(ends, ends + 9.0, every, ~every, np.ones(21), None)
    [(_, verdicts)] = labelling._capacity_verdicts([safe])
    verdicts = verdicts.reshape(21, 10)
    np.testing.assert_array_equal(verdicts[:, 1], [np.nan] * 3 + [0.0] * 18)


def test_reshaping_varies_the_last_dimension_fastest():
    values = {"flat": np.arange(6), "deep": np.zeros((6, 4))}
    found = labelling._reshaped(values, {"width": 3, "limit_state": 2})
    assert found["flat"].tolist() == [[0, 1], [2, 3], [4, 5]]
    assert found["deep"].shape == (3, 2, 4)


def test_documented_coverage_table_matches_code():
    heads = {
        "guide/fragility.md": "| bounds by | of | the median in | the dispersion in |",
        "theory/fragility.md": "| bounds | independent | median | dispersion |",
    }
    for page, head in heads.items():
        rows = {(row[0], int(row[1].split()[0])): row[2:] for row in table(page, head)}
        for bands, known in COVERAGE.items():
            for count, shares in known.items():
                written = [
                    float(cell.removesuffix(" %")) for cell in rows[bands.name.lower(), count]
                ]
                assert written == pytest.approx([100.0 * one for one in shares]), (page, count)
