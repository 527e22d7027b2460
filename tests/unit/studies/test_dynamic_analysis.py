"""Incremental dynamic analyses: their brackets, capacities and fragilities."""

import itertools
from functools import cache

import numpy as np
import pytest
import xarray as xr
from unit.studies.small_analyses import (
    FAST,
    QUIET,
    SYSTEM,
    assert_valid_file,
    complete_analysis,
    motions,
)

import rockframe as rf
from rockframe.errors import ComponentError, ModelWarning, SchemaError, SolverWarning, warn
from rockframe.results.outcome import overturns
from rockframe.studies import line_scan as of_lines
from rockframe.studies.line_scan import (
    VERDICT_DIM,
    Bracket,
    LineScan,
    LineVerdicts,
    bisect_brackets,
    bracket_arrays,
    find_brackets,
)
from rockframe.studies.sweeps import execution


@pytest.fixture
def analysis():
    return complete_analysis()


# dynamic analysis ----------------------------------------------------------------------------


def test_brackets_agree_with_single_runs(analysis, tmp_path):
    assert assert_valid_file(analysis, tmp_path)
    assert analysis.limit_state.values.tolist() == ["uplift", "rotation 0.4", "overturning"]
    assert analysis.capacity_scale.dims == ("limit_state", "motion")
    several = 0
    for name, motion in motions().items():
        one = analysis.sel(motion=name)
        uplift = float(one.capacity_scale.sel(limit_state="uplift"))
        pga = motion.peak_acceleration.m_as("m/s^2")
        assert uplift * pga == pytest.approx(9.80665 / 4.0, rel=1e-3)
        flips = int(one.flip_count.sel(limit_state="overturning"))
        several += flips > 1
        for place in range(flips):
            flip = one.isel(flip=place).sel(limit_state="overturning")
            below, above = float(flip.scale_below), float(flip.scale_above)
            assert 0.0 < above - below <= 1e-3 * above
            fell = [
                bool(
                    SYSTEM.simulate(motion.scaled(s), free_vibration="4 s", outputs=None).overturned
                )
                for s in (below, above)
            ]
            assert fell == [not flip.exceeds_above, bool(flip.exceeds_above)]
    assert several, "none of the motions shows more than one crossing"


@pytest.mark.long
def test_mirrored_motions_give_the_same_dynamic_analysis(analysis):
    mirrored = rf.incremental_dynamic_analysis(
        SYSTEM, motions(-1.0), scale=np.arange(0.5, 6.1, 0.5), limits=["uplift", 0.4],
        free_vibration="4 s", **QUIET,
    )  # fmt: skip
    for name in ("capacity_scale", "scale_below", "flip_count", "peak_rotation"):
        xr.testing.assert_equal(
            mirrored[name].drop_vars("motion"), analysis[name].drop_vars("motion")
        )


@pytest.mark.wide
def test_a_dynamic_analysis_agrees_with_the_critical_scale(analysis):
    for name, motion in motions().items():
        least = analysis.capacity_scale.sel(motion=name, limit_state="overturning").item()
        critical = rf.critical_scale(SYSTEM, motion, largest=6.0, free_vibration="4 s", runs=200)
        assert critical.critical_scale.item() <= least * (1.0 + 1e-3)


@pytest.mark.long
def test_period_of_a_spectral_intensity_is_stored_and_labelled():
    from matplotlib import pyplot

    measure = "pseudo_spectral_acceleration"
    intensity = {"intensity": measure, "period": "1.7 s"}
    suite = motions()
    scan = {"scale": [0.5, 1.5, 4.0], **FAST}
    analysis = rf.incremental_dynamic_analysis(SYSTEM, suite, **intensity, **scan)
    critical = rf.critical_scale(SYSTEM, suite["seed 0"], scales=20, runs=30, **intensity, **QUIET)
    found = rf.fragility(analysis, "SA", period="1.7 s")
    pair = rf.fragility(analysis, ["PGA", "SA"], period="1.7 s")
    spectrum = rf.overturning_spectrum(SYSTEM, suite, periods=(["1.7 s"]), **intensity, **scan)
    for one in (analysis, critical, found, pair, spectrum):
        assert one.attrs["intensity_period"] == 1.7
    words = "pseudo spectral acceleration at 1.7 s"
    assert f"median {words} {found.median_intensity[-1].item():.4g} m s^-2" in found.verdict
    assert f"peak ground acceleration and {words}" in pair.verdict
    axes = [
        rf.plot.fragility(found).get_xlabel(),
        rf.plot.dynamic_analysis(analysis)[0].get_ylabel(),
        rf.plot.dynamic_analysis(analysis, ax=pyplot.subplots(1, 2)[1])[1].get_ylabel(),
        rf.plot.overturning_spectrum(spectrum)[0].get_ylabel(),
        rf.plot.fragility(pair)[0].get_ylabel(),
    ]
    assert axes == [f"{words} [m s$^{{-2}}$]"] * 5
    plain = rf.incremental_dynamic_analysis(SYSTEM, suite, intensity="PGA", **scan)
    assert "intensity_period" not in plain.attrs
    assert rf.plot.dynamic_analysis(plain)[0].get_ylabel().startswith("peak ground acceleration [")


def test_scan_starting_too_high_warns_of_lower_capacities(analysis):
    suite = motions()
    over = analysis.sel(limit_state="overturning").capacity_scale
    least = float(np.sort(over)[1:3].mean())  # some motions overturn below it and others above
    below = int(rf.sweep(SYSTEM, suite, scale=[least], **FAST).overturned.sum())
    assert 0 < below < 4
    scan = {"scale": [least, least + 1.0, least + 2.0], **FAST}
    message = rf"{below} of 4 motions overturn at its least scale, {least:.4g}, already"
    with pytest.warns(ModelWarning, match=f"starts too high.*{message}"):
        found = rf.incremental_dynamic_analysis(SYSTEM, suite, **scan)
    most = found.capacity_scale.max().item()
    start = f"Of 4 motions 4 overturned, from at or below {least:.4g} to {most:.4g} times the"
    assert found.verdict.startswith(start)
    fitted = rf.fragility(found, trials="capacities")
    text = f"{below} of 4 capacities are only known to lie at or below the least scale."
    assert fitted.verdict.endswith(text)
    with pytest.warns(ModelWarning, match="4 of 4 motions"):
        found = rf.incremental_dynamic_analysis(SYSTEM, suite, scale=[7.0, 8.0], **FAST)
    assert (found.capacity_resolution.sel(limit_state="overturning") == 1.0).all()
    assert "4 overturned, at or below 7 times the motion" in found.verdict
    fitted = rf.fragility(found, trials="capacities")
    assert "no lognormal capacity fits" in fitted.verdict
    assert np.isnan(fitted.median_intensity).all()
    assert "only known" not in rf.fragility(analysis, trials="capacities").verdict


def test_stored_analysis_is_not_run_again(tmp_path, monkeypatch):
    options = {"scale": [1.0, 2.0, 4.0], **FAST}
    stored = rf.incremental_dynamic_analysis(SYSTEM, motions(), store=tmp_path / "s", **options)
    plain = rf.incremental_dynamic_analysis(SYSTEM, motions(), **options)
    folders = sorted(path.name for path in (tmp_path / "s").iterdir())
    assert {"finer 01", "round 01", "round 02"} <= {*folders}
    assert folders[-1] == "scan"
    from rockframe.studies.sweeps import execution

    def refuse(*args, **kwargs):
        pytest.fail("what is kept was run again")

    monkeypatch.setattr(execution, "run_chunk", refuse)
    again = rf.incremental_dynamic_analysis(SYSTEM, motions(), store=tmp_path / "s", **options)
    for one in (stored, again):
        xr.testing.assert_identical(one.drop_attrs(), plain.drop_attrs())


@cache
def uninterrupted(resolution):
    return rf.incremental_dynamic_analysis(
        SYSTEM, motions(), scale=[1.0, 2.0, 4.0], resolution=resolution, **FAST
    ).drop_attrs()


@pytest.mark.parametrize(
    ("kind", "after"),
    [
        ("between rounds", 0),
        ("in a round", 1),
        ("with the last case", 2),
        pytest.param("in a round", 0, marks=pytest.mark.long),
        pytest.param("with the last case", 0, marks=pytest.mark.long),
        pytest.param("between rounds", 1, marks=pytest.mark.long),
        pytest.param("with the last case", 1, marks=pytest.mark.long),
        pytest.param("in a round", 2, marks=pytest.mark.long),
        pytest.param("between rounds", 2, marks=pytest.mark.long),
    ],
)
def test_interrupted_analysis_warns_and_resumes(tmp_path, monkeypatch, after, kind):
    # at a resolution of one brackets are narrowed at once
    scan = {"scale": [1.0, 2.0, 4.0], "resolution": 1.0 if after != 2 else 0.02, **FAST}
    options = {**scan, "store": tmp_path / "s"}
    run_study, rounds = of_lines.run_study, itertools.count()

    def cut(study, bar, **means):
        if next(rounds) <= after:
            return run_study(study, bar, **means)
        if kind == "between rounds":
            raise KeyboardInterrupt

        if kind == "with the last case":
            return run_study(study, bar, **means)[0], False

        def stop(*args, **kwargs):
            raise KeyboardInterrupt

        with monkeypatch.context() as patch:
            patch.setattr(execution, "run_chunk", stop)
            return run_study(study, bar, **means)

    with monkeypatch.context() as patch:
        patch.setattr(of_lines, "run_study", cut)
        with pytest.warns(SolverWarning, match="interrupted; brackets are wider.*continues"):
            found = rf.incremental_dynamic_analysis(SYSTEM, motions(), **options)
        rounds = itertools.count()
        with pytest.warns(SolverWarning, match="interrupted; brackets"):
            spectrum = rf.overturning_spectrum(SYSTEM, motions(), periods=["1.7 s"], **scan)
    assert found.verdict.endswith("; interrupted.")
    assert spectrum.verdict.endswith("; interrupted.")
    if after == 2:
        assert found.capacity_resolution.max().item() > 0.02
    else:
        apart = (found.scale_above - found.scale_below).max().item()
        rounds_made = after + (kind == "with the last case")
        assert apart == pytest.approx(2.0 / 2**rounds_made)
    complete = rf.incremental_dynamic_analysis(SYSTEM, motions(), **options)
    xr.testing.assert_identical(complete.drop_attrs(), uninterrupted(scan["resolution"]))
    assert "interrupted" not in complete.verdict


def test_verdict_of_one_motion_names_one_scale(analysis):
    one = analysis.isel(motion=[0])
    scale = one.capacity_scale.sel(limit_state="overturning").item()
    start = f"Of 1 motion 1 overturned, from {scale:.4g} times the motion on"
    assert one.rockframe.verdict.startswith(start)


def test_fragility_can_be_fitted_to_capacities(analysis):
    found = rf.fragility(analysis, "PGA", trials="capacities")
    capacity = analysis.capacity_scale.sel(limit_state="overturning")
    pga = [one.peak_acceleration.m_as("m/s^2") for one in motions().values()]
    logs = np.log(capacity.values * pga)
    assert np.isfinite(logs).all()
    last = found.sel(limit_state="overturning")
    assert np.log(last.median_intensity.item()) == pytest.approx(logs.mean(), abs=1e-3)
    assert last.dispersion.item() == pytest.approx(logs.std(), abs=1e-3)
    assert found.sel(limit_state="uplift").median_intensity.item() == pytest.approx(
        9.80665 / 4.0, rel=1e-3
    )
    for trials in ("runs", "capacities"):
        every, chosen = (
            rf.fragility(analysis, trials=trials, **limits)[["median_intensity", "dispersion"]]
            for limits in ({}, {"limits": ["uplift"]})
        )
        xr.testing.assert_equal(chosen, every.sel(limit_state=["uplift", "overturning"]))
    with pytest.raises(ComponentError, match=r"has no limit state .* which has uplift, "):
        rf.fragility(analysis, limits=[0.7])


@pytest.mark.long
def test_capacities_do_not_depend_on_scan_step():
    suite = motions()
    found = {
        step: rf.incremental_dynamic_analysis(
            SYSTEM, suite, scale=np.arange(0.5, 4.1, step), resolution=finest, **FAST
        ).sel(limit_state="overturning")
        for step, finest in ((0.5, 0.02), (0.02, 1.0), (3.5, 0.02))
    }
    truth = rf.sweep(SYSTEM, suite, scale=np.arange(0.5, 4.0, 0.005), **FAST).overturned == 1.0
    for one in found.values():
        assert one.attrs["capacity"] == "least scale found to exceed"
        for name in suite:
            least = float(one.capacity_scale.sel(motion=name))
            widest = float(one.capacity_resolution.sel(motion=name))
            below = truth.sel(motion=name, scale=slice(0.0, least * (1.0 - 1e-3))).squeeze()
            # no range wider than the resolution lies below a capacity
            edges = np.flatnonzero(np.diff(np.r_[False, below.values, False].astype(int)))
            ranges = below.scale.values[edges[1::2] - 1] / below.scale.values[edges[::2]] - 1.0
            assert (ranges <= widest).all()
    assert float(found[0.5].capacity_resolution.max()) <= 0.02
    medians = [float(one.capacity_scale.median()) for one in found.values()]
    assert medians == pytest.approx([medians[1]] * 3, rel=0.05)


def test_unexceeded_limit_states_have_infinite_counted_capacities():
    found = rf.incremental_dynamic_analysis(
        SYSTEM, motions(), scale=[0.5, 1.0, 1.7], limits=["uplift"], **FAST
    )
    capacity = found.capacity_scale.sel(limit_state="overturning")
    count = int(found.censored_count.sel(limit_state="overturning"))
    assert 0 < count < capacity.size
    assert int(np.isinf(capacity).sum()) == count
    assert not capacity.isnull().any()
    assert int(found.censored_count.sel(limit_state="uplift")) == 0
    statistics = rf.ensemble_statistics(capacity, quantiles=[0.01, 0.99])
    assert statistics.member_count == capacity.size
    assert np.isinf(statistics.quantile_value[-1])
    assert (found.capacity_resolution <= 0.02).all()


def test_fragility_of_an_analysis_uses_runs_by_default(analysis):
    runs = rf.sweep(SYSTEM, motions(), scale=analysis.scale.values, free_vibration="4 s", **QUIET)
    every = rf.fragility(runs, limits=["uplift", 0.4])
    assert every.attrs["trials"] == "runs"
    xr.testing.assert_identical(rf.fragility(analysis).drop_attrs(), every.drop_attrs())
    with pytest.raises(SchemaError, match="incremental_dynamic_analysis"):
        rf.fragility(runs, trials="capacities")
    with pytest.raises(ComponentError, match="trials must be one of 'runs', 'capacities'"):
        rf.fragility(runs, trials="flips")


def test_brackets_split_at_a_third_verdict():
    truth = [(1.234, 2.0), (1.301, -1.0), (3.3, 0.0), (9.0, 0.0)]

    def verdict(scale):
        return next((after for at, after in reversed(truth) if scale >= at), -1.0)

    scales = np.array([1.0, 1.5, 2.0, 3.0, 4.0])
    shown = np.array([[[verdict(s) for s in scales]]])
    assert [one.below for one in find_brackets(scales, shown)] == [3.0]
    scales = np.array([1.0, 1.25, 4.0])
    shown = np.array([[[verdict(s) for s in scales]]])
    runs = []

    def look(part, cases):
        runs.append(part)
        return np.array([[verdict(s) for _, s in cases]]), True

    found, whole = bisect_brackets(find_brackets(scales, shown), look, width=1e-6)
    assert whole
    assert [one.above for one in found] == pytest.approx([1.234, 1.301, 3.3], rel=1e-6)
    assert [(one.before, one.after) for one in found] == [(-1.0, 2.0), (2.0, -1.0), (-1.0, 0.0)]
    assert runs == [f"round {k + 1:02d}" for k in range(len(runs))]
    below, above, before, _ = bracket_arrays([*found, Bracket(0, 1, 1.0, 2.0, 0.0, 1.0)], (1, 2))
    assert below.shape == above.shape == (1, 2, 3)
    assert np.isnan(before[0, 1]).tolist() == [False, True, True]
    nan = np.array([[[0.0, np.nan, 1.0]]])
    assert [(one.below, one.above) for one in find_brackets(scales, nan)] == [(1.0, 4.0)]


LONG_PULSE = rf.GroundMotion.half_sine_pulse("1 m/s^2", "20 s")
"""Overturns the block at scales little above that of its uplift, 9.80665 / 4."""


def test_gaps_in_which_nothing_moves_do_not_count():
    found = rf.incremental_dynamic_analysis(
        SYSTEM, LONG_PULSE, scale=[0.5, 2.0, 2.6], limits=["overturning"], resolution=1.0, **QUIET
    )
    assert found.capacity_resolution.item() == pytest.approx(0.6 / 2.6)


def scan_with(verdicts, **options):
    """Scan one pulse with verdicts of one's own."""
    lines = LineScan(SYSTEM, {"pulse": LONG_PULSE}, {}, {**QUIET, **options}, "scan", verdicts)
    return lines.run_scan(np.array([2.0, 2.6]), width=0.05, resolution=0.05)


def test_a_middle_without_a_verdict_is_tried_once(tmp_path):
    def verdicts(runs):
        middle = runs["scale"].round(12) == 2.3
        return overturns(runs).where(~middle).expand_dims(VERDICT_DIM)

    found = scan_with(verdicts, store=tmp_path / "runs")
    assert found.verdicts.scales.tolist() == [2.0, pytest.approx(2.3), 2.6]
    assert found.verdicts.resolution.item() == pytest.approx(0.6 / 2.6)
    assert [(one.below, one.above) for one in found.brackets] == [(2.0, 2.6)]
    folders = sorted(path.name for path in (tmp_path / "runs").iterdir())
    assert folders == ["finer 01", "round 01", "scan"]


def test_warnings_of_further_rounds_are_given_once():
    def verdicts(runs):
        if "motion" not in runs.dims:
            warn("two hinges", ModelWarning)
        return overturns(runs).expand_dims(VERDICT_DIM)

    with pytest.warns(ModelWarning, match="^scan: in further rounds: two hinges$") as caught:
        scan_with(verdicts)
    assert len(caught) == 1


def test_gaps_end_at_the_first_exceedance_and_skip_runs_without_a_verdict():
    """Four lines over five scales: two gaps, a wider one about a missing run, and special ones."""
    scales = np.array([1.0, 2.0, 4.0, 5.0, 10.0])
    none = np.nan
    verdicts = np.array(
        [[[0, 0, 1, 0, 1], [0, none, 0, 1, 1], [1, 0, 0, 0, 0], [none] * 5, [0] * 5]], float
    )
    moved = np.ones(verdicts.shape[1:], dtype=bool)
    moved[0, :2] = moved[4, :4] = False
    lines = LineVerdicts(scales, verdicts, moved)
    assert lines.resolution[0].tolist() == [0.5, 0.75, 1.0, 1.0, 0.5]
    np.testing.assert_array_equal(lines.first_exceedance[0], [4.0, 5.0, 1.0, none, np.inf])
    # of the lines' gaps above 0.3 of their upper ends: 2 to 4; 1 to 4; 5 to 10
    assert lines.gap_midpoints(0.3) == [(0, 3.0), (1, 2.5), (4, 7.5)]
    assert lines.gap_midpoints(0.5) == [(1, 2.5)]
    more = lines.with_runs([(1, 3.0), (4, 4.0)], np.array([[1.0, 1.0]]), np.array([True, False]))
    assert more.scales.tolist() == [1.0, 2.0, 3.0, 4.0, 5.0, 10.0]
    np.testing.assert_array_equal(more.verdicts[0, 0], [0.0, 0.0, none, 1.0, 0.0, 1.0])
    np.testing.assert_array_equal(more.verdicts[0, 1], [0.0, none, 1.0, 0.0, 1.0, 1.0])
    np.testing.assert_array_equal(more.verdicts[0, 4], [0.0, 0.0, none, 1.0, 0.0, 0.0])
    assert more.moved[0].tolist() == [False, False, True, True, True, True]
    assert more.first_exceedance[0].tolist()[:2] == [4.0, 3.0]
    assert more.resolution[0, :2].tolist() == [0.5, pytest.approx(2.0 / 3.0)]
