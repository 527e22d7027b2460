"""Ensembles, samples and maps: one population, runs without a result, few cases."""

import numpy as np
import pytest
import xarray as xr

import rockframe as rf
from rockframe.errors import ComponentError
from rockframe.results.variables.runs import RunStatus
from rockframe.studies.dynamic_analysis import verdict_of_analysis
from rockframe.studies.probability import _with_probability, rank_parameters

SYSTEM = rf.System(rf.Block(width="0.5 m", height="2 m", mass="400 kg"))
OPTIONS = {"free_vibration": "3 s", "progress": False}


def motions(count=5):
    return {f"seed {k}": rf.GroundMotion.stochastic(6.3, "8 km", seed=k) for k in range(count)}


def fail(runs, **place):
    runs.status[place] = RunStatus.REFUSED
    for name in ("peak_relative_rotation", "peak_rotation", "overturned"):
        runs[name] = runs[name].astype(float)
        runs[name][place] = np.nan


def test_sweep_over_structures_needs_pooling():
    runs = rf.sweep(SYSTEM, motions(), scale=[1.0, 2.0], width=["0.4 m", "0.5 m"], **OPTIONS)
    with pytest.raises(ComponentError, match=r"over scale, width .*pooled=\('scale', 'width'\)"):
        rf.ensemble_statistics(runs)
    with pytest.raises(ComponentError, match="goes over scale beside motions"):
        rf.ensemble_statistics(runs.isel(width=0))
    one = rf.ensemble_statistics(runs.isel(width=0, scale=0))
    assert one.member_count.item() == 5
    assert one.cumulative_probability_lower_bound.notnull().all()
    assert one.verdict == "5 members; bands of confidence 0.95"
    every = rf.ensemble_statistics(runs, pooled=["width", "scale"])
    assert every.member_count.item() == 20
    assert "no bounds, for several members are of one motion" in every.verdict
    bounds = [name for name in every if str(name).endswith("_bound")]
    # no confidence is needed if a fractile includes the whole ensemble
    assert all(every[name][:-1].isnull().all() for name in bounds)
    table = rf.sweep(SYSTEM, motions(), cases={"width": ["0.4 m", "0.5 m"]}, **OPTIONS)
    with pytest.raises(ComponentError, match="over case"):
        rf.ensemble_statistics(table)


def test_cautions_of_runs_follow_into_what_is_computed_from_them():
    runs = rf.sweep(SYSTEM, motions(8), scale=[2.0, 4.0, 8.0, 12.0], **OPTIONS)
    texts = runs.message.copy(data=runs.message.to_numpy())
    texts[:2, 0] = "not one to trust"
    runs = runs.assign_coords(message=texts)
    stated = "2 of 32 cases: not one to trust"
    fit = rf.fragility(runs, "PGA", limits=[])
    hazard = {"intensity": ([0.5, 1.0, 9.0, 80.0], "m/s^2"), "rate": [0.1, 0.01, 1e-3, 1e-8]}
    for found in (
        rf.ensemble_statistics(runs, pooled=["scale"]),
        rf.ensemble_statistics(runs.peak_relative_rotation, pooled=["scale"]),
        rf.compare_intensities(runs, ["PGA", "PGV"]),
        rf.cloud_analysis(runs, "PGA", limits=[]),
        fit,
        rf.annual_rate(fit, hazard),
    ):
        assert found.attrs["cautions"] == stated, found.attrs["title"]


def test_members_without_a_result_are_counted():
    runs = rf.sweep(SYSTEM, motions(), scale=[2.0], **OPTIONS)
    fail(runs, motion=1)
    found = rf.ensemble_statistics(runs)
    assert (found.member_count.item(), found.left_out_count.item()) == (4, 1)
    assert found.verdict == "4 members; 1 without a result are left out; bands of confidence 0.95"


def test_one_result_for_each_motion_has_bounds_over_several_scales():
    """Runs of several scales are independent if each motion has a result at one of them."""
    runs = rf.sweep(SYSTEM, motions(4), scale=[1.0, 2.0], **OPTIONS)
    for k in range(4):
        fail(runs, motion=k, scale=k % 2)
    found = rf.ensemble_statistics(runs, pooled=["scale"])
    assert found.verdict == "4 members; 4 without a result are left out; bands of confidence 0.95"
    assert found.cumulative_probability_lower_bound.notnull().all()


def test_bounds_of_ten_members_agree_with_printed_tables():
    """Kolmogorov's 0.409; the second and the ninth of ten about the median; a share of 1 in 10."""
    found = rf.ensemble_statistics(xr.DataArray(np.arange(1.0, 11.0), dims="test", name="peak"))
    share = np.arange(1, 11) / 10
    np.testing.assert_allclose(found.cumulative_probability, share)
    np.testing.assert_allclose(
        found.simultaneous_lower_bound, np.maximum(share - 0.409, 0.0), atol=5e-4
    )
    np.testing.assert_allclose(
        found.simultaneous_upper_bound, np.minimum(share + 0.409, 1.0), atol=5e-4
    )
    assert found.cumulative_probability_lower_bound[0].item() == pytest.approx(0.0025, abs=5e-5)
    assert found.cumulative_probability_upper_bound[0].item() == pytest.approx(0.4450, abs=5e-5)
    median = found.sel(quantile=0.5)
    assert median.quantile_value_lower_bound.item() == 2.0
    assert median.quantile_value_upper_bound.item() == 9.0
    assert median.quantile_value.item() == 5.0
    assert found.quantile_value_lower_bound[0].item() == -np.inf
    assert found.quantile_value_upper_bound[-1].item() == np.inf


def test_sample_verdict_reports_motions_and_omitted_cases():
    sample = rf.probability_of_overturning(
        SYSTEM, motions(), cases=40, spread={"scale": ("uniform", 2.0, 8.0)}, **OPTIONS
    )
    assert "by 40 cases under these 5 motions" in sample.verdict
    assert "left out" not in sample.verdict
    assert rf.ensemble_statistics(sample).member_count.item() == 40
    bare = sample.drop_dims("parameter").copy(deep=True)
    fail(bare, case=slice(0, 7))
    found = _with_probability(bare, ["scale"], several=True, level=0.95)
    assert found.verdict_count.item() == 33
    assert "7 without a verdict are left out" in found.verdict
    fail(bare, case=slice(None))
    none = _with_probability(bare, ["scale"], several=True, level=0.95)
    assert none.verdict_count.item() == 0
    assert np.isnan(none.overturning_probability)
    assert none.overturning_probability_lower_bound == 0.0
    assert none.overturning_probability_upper_bound == 1.0


@pytest.mark.long
def test_a_dynamic_analysis_counts_runs_without_a_verdict():
    analysis = rf.incremental_dynamic_analysis(SYSTEM, motions(3), scale=[1.0, 4.0, 9.0], **OPTIONS)
    assert "no verdict" not in analysis.verdict
    fail(analysis, motion=0, scale=slice(0, 2))
    assert "2 of 9 runs of the scan have no verdict" in verdict_of_analysis(analysis)


def test_map_masks_runs_without_a_verdict():
    from matplotlib import pyplot

    found = rf.overturning_map(
        SYSTEM, rf.GroundMotion.sine_pulse, amplitude=([1, 6], "m/s^2"),
        frequency=([1, 2], "Hz"), **OPTIONS,
    )  # fmt: skip
    images = {}
    for name in ("known", "failed"):
        axes = rf.plot.overturning_map(found)
        (legend,) = axes.figure.legends
        images[name] = (
            np.ma.getmaskarray(axes.collections[0].get_array()).ravel().tolist(),
            [text.get_text() for text in legend.get_texts()],
        )
        fail(found, amplitude=0, frequency=1)
    assert images["known"][0] == [False] * 4
    assert images["failed"][0] == [False, True, False, False]
    assert [words[-1] == "no verdict" for _, words in images.values()] == [False, True]
    pyplot.close("all")


def test_a_spectrum_counts_runs_without_a_verdict(monkeypatch):
    from rockframe.studies import spectra

    def counted():
        return rf.overturning_spectrum(
            SYSTEM, motions(1), periods=([2, 4], "s"), scale=[1.0, 2.0, 4.0], **OPTIONS
        ).left_out_count.values.tolist()

    assert counted() == [[[0], [0]]]
    overturned_counts = spectra.overturns
    monkeypatch.setattr(
        spectra, "overturns", lambda runs: overturned_counts(runs).where(runs.scale != 2.0)
    )
    assert counted() == [[[1], [1]]]


@pytest.mark.parametrize("count", [44, 90])
def test_first_order_index_is_the_adjusted_correlation_ratio(count):
    """One minus the variance within groups over the total, each by its degrees of freedom."""
    rng = np.random.default_rng(count)
    values = rng.normal(size=count)
    verdict = (values + rng.normal(size=count) > 0.0).astype(float)
    groups = count // 20
    parts = np.array_split(verdict[np.argsort(values)], groups)
    if count % groups:  # the function makes its first groups the larger ones
        place = np.arange(count) * groups // count
        parts = [verdict[np.argsort(values)][place == k] for k in range(groups)]
    within = sum(((part - part.mean()) ** 2).sum() for part in parts) / (count - groups)
    of_all = ((verdict - verdict.mean()) ** 2).sum() / (count - 1)
    found = rank_parameters({"a": values}, verdict)["a"]
    assert found.first_order == pytest.approx(1.0 - within / of_all, rel=1e-9)
    # each word is a group
    words = rng.choice(["x", "y", "z"], size=count)
    of_words = rank_parameters({"a": words}, (words == "y").astype(float))["a"]
    assert of_words.first_order == pytest.approx(1.0, rel=1e-12)
    assert np.isnan(of_words.distribution_distance)
