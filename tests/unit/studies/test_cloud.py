"""Cloud analysis: independent least squares and logistic regression, curves and coverage."""

import math

import numpy as np
import pytest
import xarray as xr
from scipy import stats

import rockframe as rf
from rockframe.errors import ComponentError, StudyError, UnitsError
from rockframe.results.variables.analyses import FragilityStatus
from rockframe.results.variables.runs import RunStatus
from rockframe.studies.cloud_fit import Cloud, Regression, fit_logistic

SYSTEM = rf.System(rf.Block(width="0.5 m", height="2 m", mass="400 kg"))
COUNT = 40


@pytest.fixture(scope="module")
def base():
    pulse = rf.GroundMotion.sine_pulse("1 m/s^2", "1 Hz")
    motions = {f"m{k:02d}": pulse.scaled(1.0 + 0.01 * k) for k in range(COUNT)}
    return rf.sweep(SYSTEM, motions, accuracy="fast", progress=False)


def synthetic_runs(base, seed=0, *, falls=True, rests=False):
    """Return responses about a line, with overturning drawn from a logistic curve."""
    rng = np.random.default_rng(seed)
    logs = rng.normal(0.0, 0.6, COUNT)
    response = np.exp(-1.5 + 1.3 * logs + 0.35 * rng.standard_normal(COUNT))
    fell = falls & (rng.random(COUNT) < 1.0 / (1.0 + np.exp(2.0 - 2.5 * logs)))
    if rests:
        response = np.where(
            ~fell & (rng.random(COUNT) > 1 / (1 + np.exp(-2 - 3 * logs))), 0.0, response
        )
    status = np.where(fell, RunStatus.OVERTURNED, RunStatus.COMPLETED).astype(np.int8)
    dims = base.status.dims
    runs = base.assign(
        peak_relative_rotation=(dims, response.reshape(base.status.shape), {"units": "1"}),
        status=(dims, status.reshape(base.status.shape), base.status.attrs),
    )
    return runs.assign_coords(strength=("motion", np.exp(logs), {"units": "m"}))


def logistic_by_weights(logs, verdict):
    """Fit a logistic curve by iteratively reweighted least squares."""
    design = np.column_stack([np.ones(len(logs)), logs])
    at = np.zeros(2)
    for _ in range(50):
        share = 1.0 / (1.0 + np.exp(-design @ at))
        weight = share * (1.0 - share)
        working = design @ at + (verdict - share) / weight
        at = np.linalg.solve(design.T @ (weight[:, None] * design), design.T @ (weight * working))
    return at, np.linalg.inv(design.T @ (weight[:, None] * design))


def test_cloud_without_overturning_equals_lognormal_least_squares(base):
    runs = synthetic_runs(base, falls=False)
    found = rf.cloud_analysis(runs, "strength", limits=[0.1, 0.4])
    logs, response = (
        np.log(runs.strength.values),
        np.log(runs.peak_relative_rotation.values.ravel()),
    )
    line = stats.linregress(logs, response)
    assert found.regression_slope.item() == pytest.approx(line.slope, rel=1e-12)
    assert found.regression_intercept.item() == pytest.approx(line.intercept, rel=1e-12)
    assert found.regression_slope_error.item() == pytest.approx(line.stderr, rel=1e-12)
    assert found.determination.item() == pytest.approx(line.rvalue**2, rel=1e-12)
    spread = np.std(response - line.intercept - line.slope * logs) * math.sqrt(COUNT / (COUNT - 2))
    assert found.residual_dispersion.item() == pytest.approx(spread, rel=1e-12)
    rng = np.random.default_rng(0)
    for level, one in zip((0.1, 0.4), (0, 1), strict=True):
        state = found.isel(limit_state=one)
        median = math.exp((math.log(level) - line.intercept) / line.slope)
        assert state.median_intensity.item() == pytest.approx(median, rel=1e-9)
        assert state.dispersion.item() == pytest.approx(spread / line.slope, rel=1e-9)
        curve = stats.norm.cdf(np.log(found.strength / median) * line.slope / spread)
        np.testing.assert_allclose(state.exceedance_probability, curve, rtol=1e-9)
        # bounds of 95 %, by the distributions of the coefficients
        chi = np.sqrt(rng.chisquare(COUNT - 2, (200_000, 1)) / (COUNT - 2))
        at = np.log(found.strength.values[::50])
        error = np.sqrt(1.0 / COUNT + (at - logs.mean()) ** 2 / (COUNT * logs.var()))
        drawn = chi * stats.norm.ppf(curve[::50]) + error * rng.standard_normal((200_000, at.size))
        for end, share in (("lower", 0.025), ("upper", 0.975)):
            bound = stats.norm.ppf(state[f"exceedance_probability_{end}_bound"][::50])
            far = abs(bound - np.quantile(drawn, share, axis=0))
            assert (far < 0.1 * drawn.std(axis=0)).all(), end
    assert found.fragility_status.values.tolist()[-1] == FragilityStatus.NONE_EXCEEDED
    assert found.median_intensity.attrs["units"] == "m"


def test_overturning_is_fitted_by_logistic_regression(base):
    runs = synthetic_runs(base, seed=3)
    found = rf.cloud_analysis(runs, "strength", limits=[0.3])
    fell = runs.status.values.ravel() == RunStatus.OVERTURNED
    logs = np.log(runs.strength.values)
    at, covariance = logistic_by_weights(logs, fell.astype(float))
    assert found.logistic_intercept.item() == pytest.approx(at[0], rel=1e-7)
    assert found.logistic_slope.item() == pytest.approx(at[1], rel=1e-7)
    assert found.logistic_slope_error.item() == pytest.approx(math.sqrt(covariance[1, 1]), rel=1e-6)
    line = stats.linregress(logs[~fell], np.log(runs.peak_relative_rotation.values.ravel()[~fell]))
    x = np.log(found.strength.values)
    collapse = 1.0 / (1.0 + np.exp(-at[0] - at[1] * x))
    eta = (line.intercept + line.slope * x - math.log(0.3)) / found.residual_dispersion.item()
    total = collapse + (1.0 - collapse) * stats.norm.cdf(eta)
    np.testing.assert_allclose(found.exceedance_probability.isel(limit_state=0), total, rtol=1e-6)
    np.testing.assert_allclose(
        found.exceedance_probability.isel(limit_state=1), collapse, rtol=1e-6
    )
    over = found.sel(limit_state="overturning")
    assert over.median_intensity.item() == pytest.approx(math.exp(-at[0] / at[1]), rel=1e-4)
    # a logistic curve reaches Phi(1) at this logit
    reach = math.log(stats.norm.cdf(1.0) / stats.norm.cdf(-1.0)) / at[1]
    assert over.dispersion.item() == pytest.approx(reach, rel=1e-3)
    assert int(found.cloud_overturned_count) == fell.sum() == np.isinf(found.cloud_response).sum()
    assert found.verdict.startswith(
        f"Of 40 runs {fell.sum()} overturned; the peak relative rotation"
    )
    for end, sign in (("lower", -1), ("upper", 1)):
        band = found[f"exceedance_probability_{end}_bound"]
        assert (sign * (band - found.exceedance_probability) > 0.0).all()


def test_resting_runs_are_modelled_separately(base):
    runs = synthetic_runs(base, seed=5, rests=True)
    found = rf.cloud_analysis(runs, "strength", limits=[0.1])
    response = runs.peak_relative_rotation.values.ravel()
    fell = runs.status.values.ravel() == RunStatus.OVERTURNED
    logs = np.log(runs.strength.values)
    assert int(found.resting_count) == (response[~fell] == 0.0).sum() > 0
    falls, _ = logistic_by_weights(logs, fell.astype(float))
    moves, _ = logistic_by_weights(logs[~fell], (response[~fell] > 0.0).astype(float))
    between = ~fell & (response > 0.0)
    line = stats.linregress(logs[between], np.log(response[between]))
    x = np.log(found.strength.values)
    shares = [1.0 / (1.0 + np.exp(-a - b * x)) for a, b in (falls, moves)]
    eta = (line.intercept + line.slope * x - math.log(0.1)) / found.residual_dispersion.item()
    total = shares[0] + (1.0 - shares[0]) * shares[1] * stats.norm.cdf(eta)
    np.testing.assert_allclose(found.exceedance_probability.isel(limit_state=0), total, rtol=1e-6)
    floored = rf.cloud_analysis(runs, "strength", limits=[0.1], least=0.1)
    assert int(floored.resting_count) == (response[~fell] < 0.1).sum()


def test_regression_coefficients_are_drawn_from_t_and_chi2():
    rng = np.random.default_rng(1)
    logs = rng.normal(size=15)
    line = Regression.fit(logs, 0.3 + 1.2 * logs + 0.4 * rng.standard_normal(15))
    intercept, slope, spread = line.draw_coefficients(np.random.default_rng(2), 40_000)
    error = np.sqrt(np.diag(line.covariance))
    for sample, middle, size in (
        (intercept, line.intercept, error[0]),
        (slope, line.slope, error[1]),
    ):
        assert stats.kstest((sample - middle) / size, stats.t(13).cdf).pvalue > 1e-3
    assert stats.kstest(13 * (line.dispersion / spread) ** 2, stats.chi2(13).cdf).pvalue > 1e-3
    correlation = line.covariance[0, 1] / error.prod()
    assert np.corrcoef(intercept, slope)[0, 1] == pytest.approx(correlation, abs=0.02)
    assert abs(correlation) > 0.1


def test_cloud_bounds_have_nominal_coverage():
    """Bounds of 95 % of a curve at an intensity, of 600 simulated samples of 30 runs."""
    rng = np.random.default_rng(7)
    held, at, level = 0, np.array([0.4]), 0.5
    truth = stats.norm.cdf((-1.0 + 1.3 * 0.4 - math.log(level)) / 0.4)
    for _ in range(600):
        logs = rng.normal(0.0, 0.6, 30)
        response = np.exp(-1.0 + 1.3 * logs + 0.4 * rng.standard_normal(30))
        curves = Cloud.fit(logs, response).draw_curves(at, level, rng, 1000)[:, 0]
        low, high = np.quantile(curves, [0.025, 0.975])
        held += low <= truth <= high
    assert 0.93 <= held / 600 <= 0.97


def test_curve_above_one_half_everywhere_has_zero_median_bound(base):
    """With few runs, the overturning probability decreases with intensity in many draws."""
    rng = np.random.default_rng(2)
    logs = rng.normal(0.5, 0.6, 12)
    response = np.exp(-2.0 + 1.5 * logs + 0.3 * rng.standard_normal(12))
    fell = np.arange(12) == np.argsort(logs)[-2]  # a single one
    cloud = Cloud.fit(logs, np.where(fell, np.inf, response))
    wide = np.linspace(logs.min() - 3.0, logs.max() + 3.0, 601)
    curves = cloud.draw_curves(wide, 0.1, np.random.default_rng(0), 4000)
    always = np.all(curves >= 0.5, axis=1)
    assert 0.05 < always.mean() < 0.95
    status = np.where(fell, RunStatus.OVERTURNED, RunStatus.COMPLETED).astype(np.int8)
    few = base.isel(motion=slice(12))
    dims, shape = few.status.dims, few.status.shape
    runs = few.assign(
        peak_relative_rotation=(dims, response.reshape(shape), {"units": "1"}),
        status=(dims, status.reshape(shape), few.status.attrs),
    ).assign_coords(strength=("motion", np.exp(logs), {"units": "m"}))
    found = rf.cloud_analysis(runs, "strength", limits=[0.1]).isel(limit_state=0)
    assert found.median_intensity_lower_bound == 0.0


def test_response_that_falls_with_the_intensity_is_said_to_fall(base):
    runs = synthetic_runs(base, falls=False)
    found = rf.cloud_analysis(runs.assign_coords(weakness=1.0 / runs.strength), "weakness")
    assert found.regression_slope < 0.0
    assert f"falls with power {-found.regression_slope.item():.3g} of" in found.verdict
    assert (found.fragility_status[:-1] == FragilityStatus.NOT_RISING).all()


@pytest.mark.parametrize("of", ["rest", "overturning"])
def test_runs_that_do_not_rise_with_intensity_have_no_curve(base, of):
    rng = np.random.default_rng(3)
    logs = rng.normal(0.0, 0.6, COUNT)
    response = np.exp(-1.5 + 1.3 * logs + 0.35 * rng.standard_normal(COUNT))
    strong, weak = logs > np.quantile(logs, 0.7), logs < np.quantile(logs, 0.3)
    fell = weak if of == "overturning" else np.zeros(COUNT, bool)
    response = np.where(strong, 0.0, response) if of == "rest" else response
    status = np.where(fell, RunStatus.OVERTURNED, RunStatus.COMPLETED).astype(np.int8)
    dims, shape = base.status.dims, base.status.shape
    runs = base.assign(
        peak_relative_rotation=(dims, response.reshape(shape), {"units": "1"}),
        status=(dims, status.reshape(shape), base.status.attrs),
    ).assign_coords(strength=("motion", np.exp(logs), {"units": "m"}))
    found = rf.cloud_analysis(runs, "strength", limits=[0.1]).isel(limit_state=0)
    assert found.fragility_status == FragilityStatus.NOT_RISING
    assert np.isnan(found.median_intensity_upper_bound)


def test_degenerate_logistic_fits_have_a_status():
    logs = np.array([0.0, 1.0, 2.0, 3.0])
    parted = fit_logistic(logs, np.array([0, 0, 1, 1]))
    assert parted.status is FragilityStatus.SEPARATED
    assert parted.probability(np.array([1.4, 1.6])).tolist() == [0.0, 1.0]
    assert fit_logistic(logs, np.zeros(4)).probability(logs).tolist() == [0.0] * 4
    assert fit_logistic(logs, np.ones(4)).probability(logs).tolist() == [1.0] * 4
    assert fit_logistic(logs, np.array([1, 1, 0, 0])).status is FragilityStatus.NOT_RISING
    for same in (np.zeros(4), 1e-15 * logs):  # motions that were scaled to one intensity
        one = fit_logistic(same, np.array([0, 1, 0, 1]))
        assert one.status is FragilityStatus.ONE_INTENSITY
        assert np.isnan(one.probability(logs)).all()


def test_motions_of_one_intensity_have_no_fragility(base):
    runs = synthetic_runs(base, seed=3)
    rounding = 1.0 + 1e-15 * (np.arange(runs.sizes["motion"]) % 3)
    found = rf.cloud_analysis(runs.assign_coords(strength=("motion", rounding)), "strength")
    assert np.isnan(found.median_intensity).all()
    assert np.isnan(found.regression_slope)
    assert "of one intensity, for a line" in found.verdict


def test_motions_that_are_run_twice_have_no_bounds(base):
    runs = synthetic_runs(base, seed=3)
    twice = xr.concat([runs, runs], "motion", data_vars="minimal", combine_attrs="override")
    found = rf.cloud_analysis(twice, "strength", limits=[0.3])
    assert np.isnan(found.median_intensity_upper_bound).all()
    assert "no bounds, for motions were run more than once" in found.verdict
    once = rf.cloud_analysis(runs, "strength", limits=[0.3])
    np.testing.assert_allclose(found.median_intensity, once.median_intensity, rtol=1e-3)


def test_cloud_yields_annual_rates_and_writes_netcdf(base, tmp_path):
    runs = synthetic_runs(base, seed=3)
    found = rf.cloud_analysis(runs, "strength", limits=[0.3])
    hazard = {"intensity": (np.geomspace(0.01, 50, 9), "m"), "rate": np.geomspace(1, 1e-6, 9)}
    rates = rf.annual_rate(found, hazard)
    assert (rates.annual_rate[0] > rates.annual_rate[1]).item()
    # against a sum over a fine grid, of the curve by its coefficients
    x = np.geomspace(0.01, 50, 200_001)
    falls = 1.0 / (
        1.0 + np.exp(-found.logistic_intercept.item() - found.logistic_slope.item() * np.log(x))
    )
    rate = np.exp(np.interp(np.log(x), np.log(hazard["intensity"][0]), np.log(hazard["rate"])))
    total = -(0.5 * (falls[1:] + falls[:-1]) * np.diff(rate)).sum()
    assert rates.annual_rate[1].item() == pytest.approx(total, rel=1e-3)
    found.to_netcdf(tmp_path / "cloud.nc")


@pytest.mark.parametrize(
    ("options", "error", "words"),
    [
        ({"limits": [-0.1]}, ComponentError, "limits must be greater than zero"),
        ({"limits": ["5 cm"], "response": "peak_rotation"}, UnitsError, "limits"),
        ({"intensity": "SA[T1]"}, ComponentError, "write intensity='SA', period='0.5 s'"),
        ({"intensity": "strenght"}, ComponentError, "intensity must be one of"),
    ],
)
def test_invalid_cloud_arguments_are_refused(base, options, error, words):
    with pytest.raises(error, match=words):
        rf.cloud_analysis(synthetic_runs(base), **{"intensity": "strength", **options})
    with pytest.raises(StudyError, match="3 runs have a verdict"):
        rf.cloud_analysis(synthetic_runs(base).isel(motion=slice(3)), "strength")
    with pytest.raises(StudyError, match="1 run has a verdict"):
        rf.cloud_analysis(synthetic_runs(base).isel(motion=slice(1)), "strength")


def test_sliding_runs_are_not_reported_as_at_rest():
    block, floor = (
        rf.Block(width="0.8 m", height="3.2 m", mass="5.5 t"),
        rf.RigidGround(friction=0.2),
    )
    pulses = {
        f"{k}": rf.GroundMotion.sine_pulse(f"{2.0 + 0.05 * k} m/s^2", "1 Hz") for k in range(6)
    }
    runs = rf.sweep(rf.System(block, floor), pulses, outputs=None, progress=False)
    assert (runs.peak_slip > 1e-5).all()
    assert "0 overturned and 6 show no peak relative rotation" in rf.cloud_analysis(runs).verdict


@pytest.fixture(scope="module")
def two_widths():
    pulse = rf.GroundMotion.sine_pulse("1 m/s^2", "1 Hz")
    motions = {f"m{k}": pulse.scaled(3.0 + 0.1 * k) for k in range(6)}
    return rf.sweep(SYSTEM, motions, width=["0.5 m", "0.6 m"], accuracy="fast", progress=False)


def test_several_structures_are_pooled_only_on_request(two_widths):
    with pytest.raises(StudyError, match=r"several structures, by width; .*isel\(width=0\)"):
        rf.cloud_analysis(two_widths, "PGA")
    pooled = rf.cloud_analysis(two_widths, "PGA", pooled=["width"])
    assert pooled.sizes["run"] == 12
    assert pooled.attrs["pooled"] == "width"
    assert rf.cloud_analysis(two_widths.isel(width=1), "PGA").sizes["run"] == 6
    with pytest.raises(ComponentError, match=r"pooled names 'wdth'; .*intensity: width"):
        rf.cloud_analysis(two_widths, "PGA", pooled=["wdth"])


def test_table_of_structures_is_pooled_only_by_case(two_widths):
    columns = {"width": ["0.5 m"] * 3 + ["0.6 m"] * 3, "motion": [*two_widths.motion.values]}
    motions = {
        f"m{k}": rf.GroundMotion.sine_pulse(f"{3 + 0.1 * k} m/s^2", "1 Hz") for k in range(6)
    }
    runs = rf.sweep(SYSTEM, motions, cases=columns, accuracy="fast", progress=False)
    with pytest.raises(StudyError, match=r"by width; take all of them for one"):
        rf.cloud_analysis(runs, "PGA")
    assert rf.cloud_analysis(runs, "PGA", pooled=["case"]).sizes["run"] == 6


def test_cloud_of_a_varied_system_drops_the_stored_system(two_widths):
    assert "system_json" not in rf.cloud_analysis(two_widths.isel(width=1), "PGA").attrs
    assert "system_json" in rf.cloud_analysis(two_widths.isel(width=1).drop_vars("width")).attrs
