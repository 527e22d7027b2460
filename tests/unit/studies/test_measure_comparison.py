"""Comparison of intensity measures against independent regressions and artificial samples."""

import math

import numpy as np
import pandas as pd
import pytest
import xarray as xr
from scipy import stats

import rockframe as rf
from rockframe.errors import ComponentError, StudyError
from rockframe.results.variables.runs import RunStatus
from rockframe.studies.cloud_fit import Cloud
from rockframe.studies.measure_comparison import _residual_trend

SYSTEM = rf.System(rf.Block(width="0.5 m", height="2 m", mass="400 kg"))
COUNT = 60


@pytest.fixture(scope="module")
def runs():
    pulse = rf.GroundMotion.sine_pulse("1 m/s^2", "1 Hz")
    motions = {f"m{k:02d}": pulse.scaled(1.0 + 0.01 * k) for k in range(COUNT)}
    found = rf.sweep(SYSTEM, motions, accuracy="fast", progress=False)
    rng = np.random.default_rng(2)
    true, magnitude = rng.normal(0.0, 0.5, COUNT), rng.uniform(5.5, 7.5, COUNT)
    response = np.exp(-1.5 + 1.2 * true + 0.3 * rng.standard_normal(COUNT))
    shape, dims = found.status.shape, found.status.dims
    fell = np.exp(2.0 * true) > 3.5 * rng.uniform(0.5, 1.5, COUNT)
    status = np.where(fell, RunStatus.OVERTURNED, RunStatus.COMPLETED).astype(np.int8)
    return found.assign(
        peak_relative_rotation=(dims, response.reshape(shape), {"units": "1"}),
        status=(dims, status.reshape(shape), found.status.attrs),
    ).assign_coords(
        good=("motion", np.exp(true), {"units": "m"}),
        # the response depends on magnitude only through the measure; for the other measure it does
        poor=("motion", np.exp(true + 0.6 * (magnitude - 6.5)), {"units": "m"}),
        magnitude=("motion", magnitude, {"units": "1"}),
    )


def test_measures_are_compared_as_regressions_are(runs):
    found = rf.compare_intensities(runs, ["poor", "good"], against=["magnitude"])
    assert found.measure.values.tolist() == ["poor", "good"]
    fell = runs.status.values.ravel() == RunStatus.OVERTURNED
    response = np.log(runs.peak_relative_rotation.values.ravel())
    for name in ("poor", "good"):
        one, logs = found.sel(measure=name), np.log(runs[name].values)
        line = stats.linregress(logs[~fell], response[~fell])
        residual = response[~fell] - line.intercept - line.slope * logs[~fell]
        spread = math.sqrt((residual**2).sum() / ((~fell).sum() - 2))
        assert one.regression_slope.item() == pytest.approx(line.slope, rel=1e-12)
        assert one.residual_dispersion.item() == pytest.approx(spread, rel=1e-12)
        assert one.efficiency_ratio.item() == pytest.approx(spread / line.slope, rel=1e-12)
        # the t-test of the slope of the residuals, from its definition
        m = runs.magnitude.values[~fell] - runs.magnitude.values[~fell].mean()
        slope = (m @ residual) / (m @ m)
        remainder = residual - slope * m
        error = math.sqrt((remainder @ remainder) / (len(m) - 2) / (m @ m))
        assert one.sufficiency_slope.item() == pytest.approx(slope, rel=1e-9)
        chance = 2.0 * stats.t.sf(abs(slope / error), len(m) - 2)
        assert one.sufficiency_p_value.item() == pytest.approx(chance, rel=1e-9)
    assert found.sufficiency_p_value.sel(measure="poor").item() < 1e-3
    assert found.sufficiency_p_value.sel(measure="good").item() > 0.05
    assert found.verdict == (
        f"Of 2 measures good is the most efficient, with {found.efficiency_ratio[1]:.3g} of "
        "dispersion over power; residuals go with a covariate (p < 0.05): poor with magnitude."
    )


def test_proportional_measures_are_equally_efficient(runs):
    """As those of runs under one motion at several scales."""
    double = (2.0 * runs.good).rename("double").assign_attrs(units="m")
    found = rf.compare_intensities(runs, ["good", double])
    assert found.verdict == (
        f"Of 2 measures all are equally efficient, with {found.efficiency_ratio[0]:.3g} of "
        "dispersion over power."
    )


def test_relative_sufficiency_is_mean_log_likelihood_difference(runs):
    found = rf.compare_intensities(runs, ["poor", "good"])
    fell = runs.status.values.ravel() == RunStatus.OVERTURNED
    response = np.log(runs.peak_relative_rotation.values.ravel())
    likely = []
    for name in ("poor", "good"):
        logs, one = np.log(runs[name].values), found.sel(measure=name)
        cloud = rf.cloud_analysis(runs, name)
        falls = 1 / (
            1 + np.exp(-cloud.logistic_intercept.item() - cloud.logistic_slope.item() * logs)
        )
        middle = cloud.regression_intercept.item() + one.regression_slope.item() * logs
        density = stats.norm.pdf(response, middle, one.residual_dispersion.item())
        likely.append(np.log2(np.where(fell, falls, (1 - falls) * density)))
    more = likely[1] - likely[0]
    assert found.relative_sufficiency.values.tolist() == pytest.approx([0.0, more.mean()], rel=1e-9)
    error = more.std(ddof=1) / math.sqrt(COUNT)
    assert found.relative_sufficiency_error.values[1] == pytest.approx(error, rel=1e-9)
    assert more.mean() > 0.5


def test_sufficiency_p_values_are_uniform_under_independence():
    rng = np.random.default_rng(3)
    chances = []
    for _ in range(400):
        logs = rng.normal(size=25)
        cloud = Cloud.fit(logs, np.exp(0.5 + logs + 0.4 * rng.standard_normal(25)))
        chances.append(_residual_trend(cloud, rng.uniform(5, 7, 25))[1])
    assert stats.kstest(chances, "uniform").pvalue > 0.01


def test_covariates_are_accepted_in_several_forms(runs):
    values = runs.magnitude.values
    names = runs.motion.values.tolist()
    forms = [
        ["magnitude"], {"magnitude": values}, {"magnitude": dict(zip(names, values, strict=True))},
        {"magnitude": pd.Series(values[::-1], index=names[::-1])},
        {"magnitude": xr.DataArray(values, dims="motion", coords={"motion": names})},
    ]  # fmt: skip
    every = [rf.compare_intensities(runs, ["poor"], against=one) for one in forms]
    assert len({one.sufficiency_p_value.item() for one in every}) == 1
    backwards = runs.isel(motion=slice(None, None, -1))
    found = rf.compare_intensities(backwards, ["poor"], against=forms[-1]).sufficiency_p_value
    assert found.item() == pytest.approx(every[0].sufficiency_p_value.item(), rel=1e-12)
    holes = np.where(np.arange(COUNT) < 5, np.nan, values)
    assert np.isfinite(
        rf.compare_intensities(runs, ["poor"], against={"m": holes}).sufficiency_p_value
    ).all()


def test_spectral_measures_are_labelled_with_their_periods(runs):
    several = [("SA", "0.5 s"), ("SA", "1 s"), ("Sa_avg", (np.array([0.5, 1.0]), "s")), "PGA"]
    found = rf.compare_intensities(runs, several)
    assert found.measure.values.tolist() == [
        "pseudo spectral acceleration at 0.5 s", "pseudo spectral acceleration at 1 s",
        "average spectral acceleration, 0.5 to 1 s", "peak ground acceleration",
    ]  # fmt: skip
    # all motions are one scaled pulse, so that all measures are proportional
    np.testing.assert_allclose(
        found.residual_dispersion, found.residual_dispersion[0].item(), rtol=1e-6
    )
    frame = rf.table(found)
    assert len(frame) == 4


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"measures": []}, "measures must be one or more"),
        ({"measures": ["good", "good"]}, "named twice"),
        ({"measures": [("SA",)]}, "a measure with a period"),
        ({"measures": ["good"], "against": ["depth"]}, "which is no coordinate"),
        ({"measures": ["good"], "against": {"depth": [1, 2]}}, "2 numbers of depth for 60 motions"),
        ({"measures": ["good"], "against": {"depth": {"m00": 1}}}, "no depth of the motion 'm01'"),
        ({"measures": ["good"], "against": ["motion"]}, "'motion' has no numbers"),
        ({"measures": ["good"], "against": {"soil": ["rock"] * COUNT}}, "'soil' has no numbers"),
        (
            {"measures": ["good"], "against": {"depth": xr.DataArray(np.ones(COUNT), dims="x")}},
            "needs a name and dimensions among motion, got 'depth' over .'x',.",
        ),
        (
            {"measures": ["good"], "against": {"depth": xr.DataArray([1.0, 2.0], dims="motion")}},
            "'depth' has 2 values along 'motion', of which the runs have 60",
        ),
    ],
)
def test_invalid_comparison_arguments_are_refused(runs, options, words):
    with pytest.raises(ComponentError, match=words):
        rf.compare_intensities(runs, **options)


def test_several_structures_are_compared_only_on_request():
    pulse = rf.GroundMotion.sine_pulse("1 m/s^2", "1 Hz")
    motions = {f"m{k}": pulse.scaled(3.0 + 0.1 * k) for k in range(6)}
    runs = rf.sweep(SYSTEM, motions, width=["0.5 m", "0.6 m"], accuracy="fast", progress=False)
    with pytest.raises(StudyError, match="several structures, by width"):
        rf.compare_intensities(runs, ["PGA", "PGV"])
    assert rf.compare_intensities(runs, ["PGA"], pooled=["width"]).sizes["measure"] == 1


def test_no_measure_is_efficient_if_the_response_falls_with_all(runs):
    falling = {f"1 / {name}": (1.0 / runs[name]).rename(name) for name in ("good", "poor")}
    inverse = runs.assign_coords(
        {name: values.assign_attrs(units="1") for name, values in falling.items()}
    )
    found = rf.compare_intensities(inverse, list(falling))
    assert found.verdict == (
        "Of 2 measures none is efficient: the response grows with none of them."
    )
