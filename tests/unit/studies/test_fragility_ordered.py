"""Fragilities with one dispersion: an independent fit, ordered curves, refusals."""

import itertools

import numpy as np
import pytest
from scipy import optimize, stats

import rockframe as rf
from rockframe.errors import ComponentError, StudyError
from rockframe.studies.fragility.likelihood import Bands, FragilityStatus, fit
from rockframe.studies.fragility.ordered import ordered_fits
from rockframe.studies.fragility.trials import Trials

NAMES = ("slight", "moderate", "complete")


def sample(seed, count=80, dispersion=0.5):
    rng = np.random.default_rng(seed)
    logs = rng.normal(0.0, 0.8, count)
    demand = logs + dispersion * rng.standard_normal(count)
    return logs, np.stack([(demand > level).astype(float) for level in (-0.8, 0.0, 0.9)])


@pytest.mark.parametrize("seed", range(3))
def test_ordered_fit_matches_nelder_mead(seed):
    logs, verdicts = sample(seed)
    fits = ordered_fits(logs, verdicts, np.arange(len(logs)), NAMES, Bands.SANDWICH)
    count = verdicts.sum(axis=0).astype(int)

    def negative(at):
        medians, spread = np.cumsum([at[0], *np.exp(at[1:3])]), np.exp(at[3])
        over = stats.norm.cdf((logs[:, None] - medians) / spread)  # of each limit state
        edges = np.column_stack([np.ones(len(logs)), over, np.zeros(len(logs))])
        rows = np.arange(len(logs))
        return -np.log(edges[rows, count] - edges[rows, count + 1]).sum()

    found = optimize.minimize(
        negative, [-0.5, -0.5, -0.5, -0.5], method="Nelder-Mead",
        options={"xatol": 1e-9, "fatol": 1e-12, "maxiter": 20_000, "maxfev": 20_000},
    ).x  # fmt: skip
    medians = np.cumsum([found[0], *np.exp(found[1:3])])
    for one, median in zip(fits, medians, strict=True):
        intercept, slope = one.coefficients
        assert 1.0 / slope == pytest.approx(np.exp(found[3]), rel=1e-6)
        assert -intercept / slope == pytest.approx(median, abs=1e-6)


def test_single_limit_state_reduces_to_the_usual_fit():
    logs, verdicts = sample(4)
    trials = Trials.from_verdicts(
        logs[:, None], verdicts[1], np.ones(len(logs)), np.arange(len(logs))
    )
    for bands in (Bands.SANDWICH, Bands.JACKKNIFE):
        usual = fit(trials, bands)
        (one,) = ordered_fits(logs, verdicts[1:2], np.arange(len(logs)), NAMES[1:2], bands)
        np.testing.assert_allclose(one.coefficients, usual.coefficients, rtol=1e-8)
        np.testing.assert_allclose(one.covariance, usual.covariance, rtol=1e-6)


@pytest.mark.parametrize("seed", [111, 654, 675, 719])
def test_ordered_fit_of_scattered_intensities_matches_the_usual_fit(seed):
    """Without halving, steps from the start diverge for some of such samples."""
    rng = np.random.default_rng(seed)
    logs = 3.0 * rng.standard_t(1.2, 28)
    exceeded = (logs + 10.0 * rng.standard_t(1.5, 28) > 0.0).astype(float)
    trials = Trials.from_verdicts(logs[:, None], exceeded, np.ones(28))
    usual = fit(trials, Bands.PROFILE)
    (one,) = ordered_fits(logs, exceeded[None], np.arange(28), NAMES[:1], Bands.SANDWICH)
    assert one.status is usual.status
    np.testing.assert_allclose(one.coefficients, usual.coefficients, rtol=1e-7, atol=1e-9)


@pytest.mark.long
def test_jackknife_bounds_cover_median_and_dispersion():
    """60 samples of 40 runs, jackknife bounds on logarithms, nominally 95 %."""
    held = np.zeros(2)
    for seed in range(60):
        logs, verdicts = sample(100 + seed, 40)
        fits = ordered_fits(logs, verdicts, np.arange(40), NAMES, Bands.JACKKNIFE)
        intercept, slope = fits[1].coefficients
        rows, _ = fits[1].leave_one_out
        each = np.stack([-rows[:, 0] / rows[:, 1], -np.log(rows[:, 1])], axis=1)
        best = np.array([-intercept / slope, -np.log(slope)])
        error = np.sqrt(39 / 40 * ((each - best) ** 2).sum(axis=0))
        held += np.abs(best - [0.0, np.log(0.5)]) <= stats.t.ppf(0.975, 39) * error
    assert (held / 60 >= 0.90).all()


def test_curves_of_runs_do_not_cross():
    system = rf.System(rf.Block(width="0.4 m", height="1.8 m", mass="300 kg"))
    motions = {
        f"{k}": rf.GroundMotion.stochastic(7.0, "5 km", seed=k, stress_drop="20 MPa")
        for k in range(12)
    }
    runs = rf.sweep(
        system, motions, scale=[0.5, 0.8, 1, 1.5, 2, 3], free_vibration="4 s", accuracy="fast",
        progress=False,
    )  # fmt: skip
    limits = [0.2, 0.5]
    each = rf.fragility(runs, "PGV", limits=limits)
    common = rf.fragility(runs, "PGV", limits=limits, dispersion="common")
    assert len(set(common.dispersion.values.round(12).tolist())) == 1
    assert common.dispersion.min() > each.dispersion.min()
    assert common.dispersion.min() < each.dispersion.max()
    assert (np.diff(common.median_intensity) > 0.0).all()
    for light, heavy in itertools.pairwise(common.limit_state.values):
        below = common.exceedance_probability.sel(limit_state=heavy)
        assert (common.exceedance_probability.sel(limit_state=light) >= below).all()
    assert (common.dispersion_lower_bound < common.dispersion).all()
    once = rf.fragility(runs.isel(scale=3), "PGV", limits=limits, dispersion="common")
    assert common.attrs["bands"] == once.attrs["bands"] == "jackknife"
    assert common.attrs["dispersions"] == "common"
    assert rf.plot.fragility(common)


def test_limit_states_without_a_fit_do_not_affect_others():
    logs, verdicts = sample(6)
    nobody = np.zeros((1, len(logs)))
    fits = ordered_fits(
        logs, np.concatenate([verdicts[:2], nobody]), np.arange(len(logs)), NAMES, Bands.SANDWICH
    )
    assert [one.status for one in fits] == [
        FragilityStatus.FITTED, FragilityStatus.FITTED, FragilityStatus.NONE_EXCEEDED
    ]  # fmt: skip
    alike = ordered_fits(logs, verdicts[[0, 1, 1]], np.arange(len(logs)), NAMES, Bands.SANDWICH)
    np.testing.assert_array_equal(alike[1].coefficients, alike[2].coefficients)
    parted = np.stack([logs > -0.2, logs > 0.3]).astype(float)
    fits = ordered_fits(logs, parted, np.arange(len(logs)), NAMES[:2], Bands.SANDWICH)
    assert fits[0].status is FragilityStatus.SEPARATED
    ends = np.concatenate([nobody + 1.0, parted[:1], nobody])
    fits = ordered_fits(logs, ends, np.arange(len(logs)), NAMES, Bands.SANDWICH)
    assert [one.status for one in fits] == [
        FragilityStatus.ALL_EXCEEDED, FragilityStatus.SEPARATED, FragilityStatus.NONE_EXCEEDED
    ]  # fmt: skip
    same = 1e-15 * logs
    fits = ordered_fits(same, verdicts[:2], np.arange(len(logs)), NAMES[:2], Bands.SANDWICH)
    assert {one.status for one in fits} == {FragilityStatus.ONE_INTENSITY}


def test_unordered_limit_states_are_refused():
    logs, verdicts = sample(7)
    with pytest.raises(StudyError, match="runs exceed 'complete' and not 'moderate'"):
        ordered_fits(logs, verdicts[[0, 2, 1]], np.arange(len(logs)), NAMES, Bands.SANDWICH)
    system = rf.System(rf.Block(width="0.5 m", height="2 m", mass="400 kg"))
    runs = rf.sweep(
        system, rf.GroundMotion.sine_pulse("3 m/s^2", "1 Hz"), scale=[1.0, 2.0], progress=False
    )
    for options in ({"bands": "profile"}, {"intensity": ("PGA", "PGV/PGA")}, {"dispersion": "one"}):
        with pytest.raises(ComponentError, match="dispersion"):
            rf.fragility(runs, **{"dispersion": "common", **options})


def test_leave_one_out_merges_limit_states_exceeded_by_the_same_runs():
    """Without the one run that exceeds only the first limit state, both coincide."""
    logs = np.array([-1.2, -0.9, -0.5, -0.3, 0.0, 0.2, 0.3, 0.6, 0.8, 1.1, 1.3])
    count = np.array([0, 0, 0, 2, 1, 0, 2, 0, 2, 2, 2])
    verdicts = np.stack([count > 0, count > 1]).astype(float)
    motions = np.arange(len(logs))
    first, second = ordered_fits(logs, verdicts, motions, NAMES[:2], Bands.JACKKNIFE)
    included = count != 1
    one = Trials.from_verdicts(
        logs[included, None], verdicts[0, included], np.ones(included.sum()), motions[included]
    )
    expected = fit(one, Bands.PROFILE).coefficients
    for state in (first, second):
        assert state.leave_one_out is not None
        rows = state.leave_one_out[0]
        np.testing.assert_allclose(rows[4], expected, rtol=1e-6)
        assert np.isfinite(rows).all()


def test_leave_one_out_may_leave_a_limit_state_exceeded_by_all():
    logs = np.array([-1.2, -0.9, -0.5, -0.3, 0.0, 0.2, 0.3, 0.6])
    count = np.array([1, 1, 2, 0, 1, 2, 1, 2])
    verdicts = np.stack([count > 0, count > 1]).astype(float)
    fits = ordered_fits(logs, verdicts, np.arange(len(logs)), NAMES[:2], Bands.JACKKNIFE)
    assert not any(one.complete for one in fits)
