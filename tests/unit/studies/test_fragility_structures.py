"""Fragilities of several structures: a curve for each; other datasets are refused."""

import numpy as np
import pytest
import xarray as xr

import rockframe as rf
from rockframe.errors import ComponentError, SchemaError, StudyError
from rockframe.results.variables.runs import RunStatus
from rockframe.studies.fragility.trials import at_scales, trials_of_capacities

SYSTEM = rf.System(rf.Block(width="0.5 m", height="2 m", mass="400 kg"))
OPTIONS = {"accuracy": "fast", "free_vibration": "3 s", "progress": False}
SCALES = [0.5, 1.0, 2.0, 3.0, 5.0, 8.0, 12.0]


def motions(first=0, count=6):
    every = range(first, first + count)
    return {f"seed {k}": rf.GroundMotion.stochastic(6.3, "8 km", seed=k) for k in every}


@pytest.fixture(scope="module")
def runs():
    return rf.sweep(SYSTEM, motions(), scale=SCALES, width=["0.4 m", "0.5 m", "0.8 m"], **OPTIONS)


def fail(runs, **place):
    """Return a sweep in which the runs at one place have no result."""
    runs.status[place] = RunStatus.REFUSED
    runs.peak_relative_rotation[place] = np.nan


def assert_same_fit(one, other):
    for name in ("median_intensity", "dispersion", "fragility_status", "stripe_trials"):
        assert one[name].sum() == other[name].sum(), name


def test_each_structure_has_a_curve_of_its_own(runs):
    found = rf.fragility(runs, "PGV", limits=[0.3])
    assert found.median_intensity.dims == ("width", "limit_state")
    assert found.exceedance_probability.dims == ("width", "limit_state", "peak_ground_velocity")
    assert found.width.values.tolist() == [0.4, 0.5, 0.8]
    assert found.width.units == "m"
    last = found.sel(limit_state="overturning")
    assert (np.diff(last.median_intensity) > 0.0).all()
    for k in range(3):
        alone = rf.fragility(runs.isel(width=[k]), "PGV", limits=[0.3])
        assert_same_fit(found.isel(width=[k]), alone)
        assert f"{alone.median_intensity[0, -1].item():.4g} m s^-1" in alone.verdict
        assert "structures" not in alone.verdict
    assert "(3 structures by width)" in found.verdict
    for end in (0, -1):
        assert f"{last.median_intensity[end].item():.4g}" in found.verdict


def test_structures_are_pooled_on_request(runs):
    found = rf.fragility(runs, "PGV", limits=(), pooled=("width",))
    assert found.median_intensity.dims == ("limit_state",)
    assert found.attrs["pooled"] == "width"
    assert "(pooled over width)" in found.verdict
    assert found.trial_count.item() == runs.status.size
    # its dispersion includes the differences of the structures
    alone = rf.fragility(runs, "PGV", limits=())
    assert found.dispersion.item() > 1.3 * alone.dispersion.max().item()
    # each structure has one run per motion; pooled ones have several, which are dependent
    once = runs.isel(scale=[3])
    assert rf.fragility(once, "PGV").attrs["bands"] == "profile"
    assert rf.fragility(once, "PGV", pooled="width").attrs["bands"] == "jackknife"
    with pytest.raises(ComponentError, match=r"pooled names 'depth'; .*: width"):
        rf.fragility(runs, pooled=["depth"])
    with pytest.raises(ComponentError, match="pooled names 'scale'"):
        rf.fragility(runs, pooled="scale")


def test_equal_table_rows_belong_to_one_structure(runs):
    widths = ["0.4 m"] * len(SCALES) + ["0.8 m"] * len(SCALES)
    table = rf.sweep(SYSTEM, motions(), cases={"width": widths, "scale": SCALES * 2}, **OPTIONS)
    found = rf.fragility(table, "PGV", limits=())
    assert found.case.values.tolist() == [0, len(SCALES)]
    assert found.width.values.tolist() == [0.4, 0.8]
    assert_same_fit(found, rf.fragility(runs.isel(width=[0, 2]), "PGV", limits=()))
    order = [*range(len(SCALES), 2 * len(SCALES)), *range(len(SCALES))]
    turned = rf.fragility(table.isel(case=order), "PGV", limits=())
    assert turned.case.values.tolist() == [len(SCALES), 0]
    assert turned.width.values.tolist() == [0.8, 0.4]
    assert turned.median_intensity.values.tolist() == found.median_intensity.values[::-1].tolist()
    apart = rf.sweep(
        SYSTEM, motions(), scale=SCALES, cases={"width": ["0.4 m", "0.8 m"]}, **OPTIONS
    )
    assert_same_fit(rf.fragility(apart, "PGV", limits=()), found)
    both = rf.fragility(apart, "PGV", limits=(), pooled="width")
    assert both.trial_count.item() == apart.status.size
    assert_same_fit(rf.fragility(apart, "PGV", limits=(), pooled="case"), both)
    with pytest.raises(SchemaError, match="without its coordinate 'width'"):
        rf.fragility(table.drop_vars("width"))


def test_dimensions_of_analyses_are_structures_or_motions():
    spectrum = rf.rocking_spectrum(
        SYSTEM, motions(), periods=([2, 4, 6], "s"), slenderness=[3, 5], **OPTIONS
    )
    found = rf.fragility(spectrum, limits=())
    assert found.median_intensity.dims == ("slenderness", "rocking_period", "limit_state")
    assert found.width.dims == ("slenderness", "rocking_period")
    pulses = rf.overturning_map(
        SYSTEM, rf.GroundMotion.sine_pulse, amplitude=([2, 4, 6], "m/s^2"),
        frequency=([1, 2], "Hz"), **OPTIONS,
    )  # fmt: skip
    assert rf.fragility(pulses, limits=()).median_intensity.dims == ("limit_state",)


def test_axis_used_as_intensity_does_not_separate_structures(runs):
    by_width = rf.fragility(runs, runs.width, limits=())
    assert by_width.median_intensity.dims == ("limit_state",)
    own = (runs.scale / runs.width).rename("relative_scale").assign_attrs(units="m^-1")
    assert rf.fragility(runs, own, limits=()).median_intensity.dims == ("width", "limit_state")


def test_one_structure_per_run_is_refused():
    sample = rf.probability_of_overturning(
        SYSTEM, motions(), cases=30, **OPTIONS,
        spread={"width": ("uniform", "0.4 m", "0.6 m"), "scale": ("uniform", 1.0, 8.0)},
    )  # fmt: skip
    with pytest.raises(ComponentError, match=r"pooled=\('width',\) takes all"):
        rf.fragility(sample)
    assert rf.fragility(sample, limits=(), pooled="width").trial_count.item() == 30


def test_concatenated_runs_and_sweeps_are_refused(runs):
    one, other = (
        rf.sweep(SYSTEM, motions(first), scale=SCALES[:3], **OPTIONS) for first in (0, 10)
    )
    run = SYSTEM.simulate(motions()["seed 0"])
    joined = rf.concat([run, SYSTEM.simulate(motions()["seed 1"])], "motion")
    for dataset, kind, words in (
        (run, SchemaError, "found a single run, which is no sweep"),
        (joined, SchemaError, "found joined runs, which is no sweep"),
        (
            xr.concat([one, other], "suite", join="outer"),
            StudyError,
            "the sweep had no dimension 'suite'",
        ),
        (
            xr.concat([one, other], "motion", join="outer"),
            StudyError,
            "the sweep had no motion 'seed 10'",
        ),
        (xr.concat([one, one], "motion"), StudyError, "'seed 0' stands twice along 'motion'"),
    ):
        with pytest.raises(kind, match=words):
            rf.fragility(dataset)
    for twice in (("PGA", "PGA"), ("PGA", "peak_ground_acceleration")):
        with pytest.raises(ComponentError, match="are one, peak_ground_acceleration"):
            rf.fragility(one, twice)
    both = rf.sweep(SYSTEM, {**motions(0), **motions(10)}, scale=SCALES[:3], **OPTIONS)
    assert_same_fit(rf.fragility(rf.concat([one, other], "motion")), rf.fragility(both))
    # parts joined along an axis of a sweep are one sweep; user-defined measures need no motions
    split = [runs.isel(scale=slice(0, 3)), runs.isel(scale=slice(3, None))]
    assert_same_fit(rf.fragility(xr.concat(split, "scale")), rf.fragility(runs))
    own = rf.fragility(xr.concat([one, one], "suite"), one.scale, limits=())
    assert own.median_intensity.dims == ("suite", "limit_state")


def test_runs_without_a_verdict_are_counted(runs):
    lacking = runs.copy(deep=True)
    fail(lacking, width=0, motion=1)
    found = rf.fragility(lacking, limits=())
    assert found.left_out_count.squeeze().values.tolist() == [len(SCALES), 0, 0]
    assert (found.left_out_count + found.trial_count == len(SCALES) * 6).all()
    assert f"{len(SCALES)} of {runs.status.size} runs are left out" in found.verdict
    assert found.independent_count.squeeze().values.tolist() == [5, 6, 6]
    assert "left out" not in rf.fragility(runs).verdict


@pytest.mark.long
def test_unknown_capacities_are_omitted():
    """A motion whose runs failed is not counted as withstood."""
    analysis = rf.incremental_dynamic_analysis(
        SYSTEM, motions(count=12), scale=[1.0, 3.0, 6.0, 12.0], **OPTIONS
    )
    all_known = rf.fragility(analysis, trials="capacities")
    lacking = analysis.copy(deep=True)
    fail(lacking, motion=0)
    fail(lacking, motion=1, scale=slice(1, None))
    for name in ("capacity_scale", "scale_above", "scale_below", "exceeds_above"):
        lacking[name][{"motion": [0, 1]}] = np.nan
    found = rf.fragility(lacking, trials="capacities")
    assert found.left_out_count.item() == 1
    assert found.trial_count.item() == 11
    assert "1 of 12 capacities are left out" in found.verdict
    # for motion 1 only the least scale is known to be withstood
    without = rf.fragility(lacking.isel(motion=slice(2, None)), trials="capacities")
    assert found.median_intensity.item() == pytest.approx(without.median_intensity.item(), rel=0.02)
    assert all_known.left_out_count.item() == 0
    one = analysis.isel(limit_state=0)
    again = rf.fragility(one, trials="capacities")
    assert again.median_intensity.item() == all_known.median_intensity.item()
    with pytest.raises(SchemaError, match="at one scale"):
        rf.fragility(analysis.isel(scale=1), analysis.scale.isel(scale=1), trials="capacities")


def test_exports_require_a_single_structure(runs, tmp_path):
    found = rf.fragility(runs, limits=())
    with pytest.raises(ComponentError, match=r"several structures, by width; .*isel\(width=0\)"):
        rf.export.to_pelicun(found, "x")
    with pytest.raises(ComponentError, match="several structures"):
        rf.export.to_openquake({"x": found}, tmp_path / "x.xml")
    for one in (found.isel(width=0), found.isel(width=[0])):
        theta = rf.export.to_pelicun(one, "x")["LS1-Theta_0"].item()
        assert theta == pytest.approx(found.median_intensity[0].item() / 9.80665, rel=1e-12)


def test_figures_distinguish_structures(runs):
    from matplotlib import pyplot

    found = rf.fragility(runs, "PGV", limits=[0.3])
    panels = rf.plot.fragility(found)
    assert [axes.get_title() for axes in panels] == ["rotation 0.3", "overturning"]
    names = [text.get_text() for text in panels.figure.legends[0].get_texts()]
    assert names == ["width 0.4 m", "width 0.5 m", "width 0.8 m"]
    axes = rf.plot.fragility(found.isel(width=1))
    title = axes.figure.get_suptitle().replace("\n", " ")
    assert f"{found.median_intensity[1, 1].item():.4g}" in title
    assert "structures" not in title
    with pytest.raises(SchemaError, match="found 3 structures, by width; a figure shows 1"):
        rf.plot.fragility(rf.fragility(runs, ("PGA", "PGV"), limits=()))
    pyplot.close("all")


def test_an_axis_with_the_name_of_the_measure_is_refused() -> None:
    """The intensity is an argument of the scene function, not a peak of the motions."""
    system = rf.System(rf.Block(width="0.5 m", height="2 m", mass="400 kg"))
    pulse = rf.GroundMotion.sine_pulse("3 m/s^2", "1 Hz")
    runs = rf.sweep(
        lambda peak_ground_acceleration: system, [pulse, pulse.scaled(2.0)], duration="1 s",
        axes={"peak_ground_acceleration": [1.0, 2.0]},
    )  # fmt: skip
    with pytest.raises(ComponentError, match="which is also the name of the intensity measure"):
        rf.fragility(runs, "PGA")


def test_measure_named_like_an_axis_does_not_replace_the_axis(runs) -> None:
    """Runs of all widths were once counted as those of one structure."""
    own = xr.DataArray(np.arange(1.0, 7.0), dims="motion", name="width", attrs={"units": "m"})
    with pytest.raises(ComponentError, match="differ along width, which is also the name"):
        rf.fragility(runs, own)
    with pytest.raises(StudyError, match="of several structures, by width"):
        rf.cloud_analysis(runs.isel(scale=2), own)
    assert "width" not in rf.fragility(runs, runs.width).median_intensity.dims


def test_means_of_runs_are_refused(runs) -> None:
    """The mean of two status numbers is the number of a third status."""
    with xr.set_options(keep_attrs=True), pytest.raises(SchemaError, match="means of runs"):
        rf.fragility(runs.mean("width"), "PGA")


def test_capacities_of_an_analysis_lie_in_its_first_brackets():
    """Lines with two brackets, one below the scan, none, and one whose largest run failed."""
    none = np.nan
    analysis = xr.Dataset(
        {
            "capacity_scale": ("motion", [2.9, 1.0, np.inf, np.inf, none]),
            "scale_below": (("motion", "flip"), [[2.8, 6.0], [4.0, none], *[[none, none]] * 3]),
            "scale_above": (("motion", "flip"), [[2.9, 6.1], [4.1, none], *[[none, none]] * 3]),
        },
        coords={"scale": [1.0, 4.0, 16.0]},
    )
    known = xr.DataArray(np.ones((5, 3), dtype=bool), dims=("motion", "scale"))
    known[3, 2], known[4] = False, False
    # a peak in proportion to the scale, and a duration that does not depend on it
    peak = xr.DataArray([[2.0, 8.0, 32.0]] * 5, dims=("motion", "scale"))
    found = trials_of_capacities(analysis, known, [peak, xr.DataArray([5.0] * 5, dims="motion")])
    assert (found.left_out, found.independent) == (1, 4)
    trials = found.trials
    assert trials.has_lower.tolist() == [True, False, True, True]
    assert trials.has_upper.tolist() == [True, True, False, False]
    lower, upper = np.exp(trials.lower), np.exp(trials.upper)
    assert lower[trials.has_lower, 0] == pytest.approx([5.6, 32.0, 8.0])
    assert upper[trials.has_upper, 0] == pytest.approx([5.8, 2.0])
    assert [*lower[:, 1], *upper[:, 1]] == pytest.approx([5.0] * 8)
    squared = np.array([[3.0, 48.0]])  # a measure that grows with the square of the scale
    scales = np.array([1.0, 4.0])
    np.testing.assert_allclose(at_scales(squared, scales, 2.0), [12.0])
