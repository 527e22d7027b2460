"""Dynamic analysis, maps, spectra, probabilities, ensembles: labels, brute force, files."""

import itertools
from functools import cache

import numpy as np
import pytest
import xarray as xr
from scipy import stats

import rockframe as rf
from rockframe.errors import ComponentError, ModelWarning, SchemaError, SolverWarning, StudyError
from rockframe.results.schema import SCHEMA
from rockframe.studies import lines as of_lines
from rockframe.studies.lines import Bracket, bracket_arrays, brackets_of, narrowed
from rockframe.studies.probability import ranked
from rockframe.studies.sweeps import execution

BLOCK = rf.Block(width="0.5 m", height="2 m", mass="400 kg")
SYSTEM = rf.System(BLOCK)
QUIET = {"progress": False}
FAST = {"accuracy": "fast", "free_vibration": "4 s", **QUIET}


def motions(sign=1.0):
    return {name: one.scaled(sign) for name, one in made().items()}


@cache
def made():
    return {
        f"seed {k}": rf.GroundMotion.stochastic(
            6.6, "5 km", seed=k, stress_drop="20 MPa", source="one corner"
        )
        for k in range(4)
    }


@pytest.fixture(scope="module")
def analysis():
    return rf.incremental_dynamic_analysis(
        SYSTEM, motions(), scale=np.arange(0.5, 6.1, 0.5), limits=["uplift", 0.4],
        intensity="PGA", free_vibration="4 s", **QUIET,
    )  # fmt: skip


def checked(dataset, tmp_path):
    """Whether variables have the units of the schema, and files hold the dataset."""
    for name, one in dataset.variables.items():
        assert one.attrs.get("long_name"), name
        if name in SCHEMA and SCHEMA[name].unit is not None:
            assert "units" in one.attrs, name
    dataset.to_netcdf(tmp_path / "found.nc")
    with xr.open_dataset(tmp_path / "found.nc") as again:
        xr.testing.assert_identical(again.load().drop_attrs(), dataset.drop_attrs())
    return True


# dynamic analysis ----------------------------------------------------------------------------


def test_brackets_of_a_dynamic_analysis_are_those_of_single_runs(analysis, tmp_path):
    assert checked(analysis, tmp_path)
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


def test_a_dynamic_analysis_is_that_of_the_mirrored_motions(analysis):
    mirrored = rf.incremental_dynamic_analysis(
        SYSTEM, motions(-1.0), scale=np.arange(0.5, 6.1, 0.5), limits=["uplift", 0.4],
        free_vibration="4 s", **QUIET,
    )  # fmt: skip
    for name in ("capacity_scale", "scale_below", "flip_count", "peak_rotation"):
        xr.testing.assert_equal(
            mirrored[name].drop_vars("motion"), analysis[name].drop_vars("motion")
        )


def test_a_dynamic_analysis_agrees_with_the_critical_scale(analysis):
    for name, motion in motions().items():
        least = analysis.capacity_scale.sel(motion=name, limit_state="overturning").item()
        looked = rf.critical_scale(SYSTEM, motion, largest=6.0, free_vibration="4 s", runs=200)
        assert looked.critical_scale.item() <= least * (1.0 + 1e-3)


@pytest.mark.long
def test_the_period_of_a_spectral_intensity_is_kept_and_told():
    from matplotlib import pyplot

    measure = "pseudo_spectral_acceleration"
    asked = {"intensity": measure, "period": "1.7 s"}
    suite = motions()
    some = {"scale": [0.5, 1.5, 4.0], **FAST}
    analysis = rf.incremental_dynamic_analysis(SYSTEM, suite, **asked, **some)
    critical = rf.critical_scale(SYSTEM, suite["seed 0"], scales=20, runs=30, **asked, **QUIET)
    found = rf.fragility(analysis, "SA", period="1.7 s")
    pair = rf.fragility(analysis, ["PGA", "SA"], period="1.7 s")
    spectrum = rf.overturning_spectrum(SYSTEM, suite, periods=(["1.7 s"]), **asked, **some)
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
    plain = rf.incremental_dynamic_analysis(SYSTEM, suite, intensity="PGA", **some)
    assert "intensity_period" not in plain.attrs
    assert rf.plot.dynamic_analysis(plain)[0].get_ylabel().startswith("peak ground acceleration [")


def test_a_scan_that_starts_too_high_says_that_capacities_lie_below(analysis):
    suite = motions()
    over = analysis.sel(limit_state="overturning").capacity_scale
    least = float(np.sort(over)[1:3].mean())  # some motions overturn below it, some above
    below = int(rf.sweep(SYSTEM, suite, scale=[least], **FAST).overturned.sum())
    assert 0 < below < 4
    scan = {"scale": [least, least + 1.0, least + 2.0], **FAST}
    told = rf"{below} of 4 motions overturn at its least scale, {least:.4g}, already"
    with pytest.warns(ModelWarning, match=f"starts too high.*{told}"):
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


def test_a_stored_analysis_goes_on_where_it_was(tmp_path, monkeypatch):
    options = {"scale": [1.0, 2.0, 4.0], **FAST}
    kept = rf.incremental_dynamic_analysis(SYSTEM, motions(), store=tmp_path / "s", **options)
    plain = rf.incremental_dynamic_analysis(SYSTEM, motions(), **options)
    folders = sorted(path.name for path in (tmp_path / "s").iterdir())
    assert {"finer 01", "round 01", "round 02"} <= {*folders}
    assert folders[-1] == "scan"
    from rockframe.studies.sweeps import execution

    def refuse(*given, **named):
        pytest.fail("what is kept was run again")

    monkeypatch.setattr(execution, "run_chunk", refuse)
    again = rf.incremental_dynamic_analysis(SYSTEM, motions(), store=tmp_path / "s", **options)
    for one in (kept, again):
        xr.testing.assert_identical(one.drop_attrs(), plain.drop_attrs())


@cache
def uninterrupted(resolution):
    return rf.incremental_dynamic_analysis(
        SYSTEM, motions(), scale=[1.0, 2.0, 4.0], resolution=resolution, **FAST
    ).drop_attrs()


@pytest.mark.parametrize("after", [0, 1, 2])
@pytest.mark.parametrize("kind", ["in a round", "between rounds", "with the last case"])
def test_an_interrupted_analysis_says_so_and_goes_on(tmp_path, monkeypatch, after, kind):
    # at a resolution of one brackets are narrowed at once
    some = {"scale": [1.0, 2.0, 4.0], "resolution": 1.0 if after != 2 else 0.02, **FAST}
    options = {**some, "store": tmp_path / "s"}
    run_study, rounds = of_lines.run_study, itertools.count()

    def cut(study, bar, **means):
        if next(rounds) <= after:
            return run_study(study, bar, **means)
        if kind == "between rounds":
            raise KeyboardInterrupt

        if kind == "with the last case":
            return run_study(study, bar, **means)[0], False

        def stop(*given, **named):
            raise KeyboardInterrupt

        with monkeypatch.context() as patch:
            patch.setattr(execution, "run_chunk", stop)
            return run_study(study, bar, **means)

    with monkeypatch.context() as patch:
        patch.setattr(of_lines, "run_study", cut)
        with pytest.warns(SolverWarning, match="interrupted; brackets are wider.*goes on"):
            found = rf.incremental_dynamic_analysis(SYSTEM, motions(), **options)
        rounds = itertools.count()
        with pytest.warns(SolverWarning, match="interrupted; brackets"):
            spectrum = rf.overturning_spectrum(SYSTEM, motions(), periods=["1.7 s"], **some)
    assert found.verdict.endswith("; interrupted.")
    assert spectrum.verdict.endswith("; interrupted.")
    if after == 2:
        assert found.capacity_resolution.max().item() > 0.02
    else:
        apart = (found.scale_above - found.scale_below).max().item()
        rounds_made = after + (kind == "with the last case")
        assert apart == pytest.approx(2.0 / 2**rounds_made)
    whole = rf.incremental_dynamic_analysis(SYSTEM, motions(), **options)
    xr.testing.assert_identical(whole.drop_attrs(), uninterrupted(some["resolution"]))
    assert "interrupted" not in whole.verdict


def test_a_verdict_of_one_motion_tells_one_scale(analysis):
    one = analysis.isel(motion=[0])
    scale = one.capacity_scale.sel(limit_state="overturning").item()
    start = f"Of 1 motion 1 overturned, from {scale:.4g} times the motion on"
    assert one.rockframe.verdict.startswith(start)


def test_a_fragility_of_capacities(analysis):
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
    with pytest.raises(ComponentError, match=r"was not .* limits must name; it has uplift, "):
        rf.fragility(analysis, limits=[0.7])


@pytest.mark.long
def test_capacities_hang_neither_on_the_first_row_nor_on_its_step():
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
            # no range that is wider than the resolution falls below a capacity
            edges = np.flatnonzero(np.diff(np.r_[False, below.values, False].astype(int)))
            ranges = below.scale.values[edges[1::2] - 1] / below.scale.values[edges[::2]] - 1.0
            assert (ranges <= widest).all()
    assert float(found[0.5].capacity_resolution.max()) <= 0.02
    medians = [float(one.capacity_scale.median()) for one in found.values()]
    assert medians == pytest.approx([medians[1]] * 3, rel=0.05)


def test_what_was_not_exceeded_has_an_infinite_capacity_and_is_counted():
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


def test_a_fragility_of_an_analysis_is_that_of_its_runs_unless_asked_for_capacities(analysis):
    runs = rf.sweep(SYSTEM, motions(), scale=analysis.scale.values, free_vibration="4 s", **QUIET)
    every = rf.fragility(runs, limits=["uplift", 0.4])
    assert every.attrs["trials"] == "runs"
    xr.testing.assert_identical(rf.fragility(analysis).drop_attrs(), every.drop_attrs())
    with pytest.raises(SchemaError, match="incremental_dynamic_analysis"):
        rf.fragility(runs, trials="capacities")
    with pytest.raises(ComponentError, match="trials must be one of 'runs', 'capacities'"):
        rf.fragility(runs, trials="flips")


def test_brackets_split_where_a_third_verdict_lies_between():
    truth = [(1.234, 2.0), (1.301, -1.0), (3.3, 0.0), (9.0, 0.0)]

    def verdict(scale):
        return next((after for at, after in reversed(truth) if scale >= at), -1.0)

    scales = np.array([1.0, 1.5, 2.0, 3.0, 4.0])
    shown = np.array([[[verdict(s) for s in scales]]])
    assert [one.below for one in brackets_of(scales, shown)] == [3.0]
    scales = np.array([1.0, 1.25, 4.0])
    shown = np.array([[[verdict(s) for s in scales]]])
    runs = []

    def look(part, wanted):
        runs.append(part)
        return np.array([[verdict(s) for _, s in wanted]]), True

    found, whole = narrowed(brackets_of(scales, shown), look, width=1e-6)
    assert whole
    assert [one.above for one in found] == pytest.approx([1.234, 1.301, 3.3], rel=1e-6)
    assert [(one.before, one.after) for one in found] == [(-1.0, 2.0), (2.0, -1.0), (-1.0, 0.0)]
    assert runs == [f"round {k + 1:02d}" for k in range(len(runs))]
    below, above, before, _ = bracket_arrays([*found, Bracket(0, 1, 1.0, 2.0, 0.0, 1.0)], (1, 2))
    assert below.shape == above.shape == (1, 2, 3)
    assert np.isnan(before[0, 1]).tolist() == [False, True, True]
    nan = np.array([[[0.0, np.nan, 1.0]]])
    assert [(one.below, one.above) for one in brackets_of(scales, nan)] == [(1.0, 4.0)]


# maps and spectra ----------------------------------------------------------------------------


def test_a_map_has_its_labels_and_gives_cases_back(tmp_path):
    pulse = rf.GroundMotion.sine_pulse("-3 m/s^2", "2 Hz")
    options = {"amplitude": ([3, 6, 12], "m/s^2"), "frequency": (["1 Hz", "2 Hz"]), **FAST}
    found = rf.overturning_map(SYSTEM, pulse, **options)
    assert checked(found, tmp_path)
    assert found.impacts_before_overturning.dims == ("amplitude", "frequency")
    assert (found.amplitude.units, found.frequency.units) == ("m s^-2", "Hz")
    alone = rf.case(found, amplitude="6 m/s^2", frequency="2 Hz")
    again = rf.GroundMotion.sine_pulse("-6 m/s^2", "2 Hz")
    assert alone.motion.to_dict()["amplitude"].startswith("-")
    assert alone.motion.si.horizontal.samples == pytest.approx(again.si.horizontal.samples)
    picked = found.peak_rotation.sel(amplitude=6.0, frequency=2.0).item()
    assert alone.simulate().peak_rotation.item() == picked
    mirrored = rf.overturning_map(SYSTEM, rf.GroundMotion.sine_pulse, **options)
    for name in ("impacts_before_overturning", "amplitude_above", "impacts_above", "peak_rotation"):
        assert np.array_equal(mirrored[name].values, found[name].values, equal_nan=True), name


def test_a_rocking_spectrum_is_single_runs_of_blocks_of_that_size(tmp_path):
    found = rf.rocking_spectrum(
        SYSTEM, motions(), periods=([2.0, 3.0], "s"), slenderness=[3, 5], **FAST
    )
    assert checked(found, tmp_path)
    assert found.peak_relative_rotation.dims == ("slenderness", "rocking_period", "motion")
    one = {"slenderness": 5.0, "rocking_period": 3.0, "motion": "seed 1"}
    case = rf.case(found, **one)
    block = case.system.parts.block
    assert 2.0 * np.pi / block.frequency.m_as("rad/s") == pytest.approx(3.0, rel=1e-12)
    assert block.height.m_as("m") / block.width.m_as("m") == pytest.approx(5.0, rel=1e-12)
    assert case.simulate().peak_rotation.item() == found.peak_rotation.sel(one).item()
    for system, words in (
        (
            rf.System(
                rf.FrameEquivalent(width="4 m", height="18 m", mass="99 t", shape_factor=2.92)
            ),
            "Frame",
        ),
        (rf.System(BLOCK.replace(centre_of_mass=("0.8 m", "0 m"))), "centre of mass"),
    ):
        with pytest.raises(ComponentError, match=words):
            rf.rocking_spectrum(system, motions(), periods=(["2 s"]))


BODIES = {
    "cylinder": rf.Block.cylinder(diameter="0.5 m", height="2 m", mass="400 kg"),
    "outline": rf.Block.from_outline(
        [(0.0, 0.0), (0.5, 0.0), (0.6, 0.7), (0.5, 1.4), (0.0, 1.4), (-0.1, 0.7)],
        unit="m",
        mass="300 kg",
    ),
    "parts": rf.Block.from_parts(
        {
            "lower": {"width": "0.6 m", "height": "1 m", "mass": "90 kg"},
            "upper": {"width": "0.4 m", "height": "1 m", "mass": "90 kg", "at": ("0 m", "1 m")},
        }
    ),
    "inertia": BLOCK.replace(inertia="120 kg*m^2"),
    "centre of mass": BLOCK.replace(centre_of_mass=("1 m", "0 m")),
    # 3 times 0.1 is a little more than 0.3
    "rounded": BLOCK.replace(height="0.6 m", width="0.2 m", centre_height=f"{3 * 0.1!r} m"),
}


@pytest.mark.long
@pytest.mark.parametrize("name", BODIES)
def test_bodies_told_by_their_inertia_keep_their_shape_factor_at_other_sizes(name):
    body = BODIES[name]
    motion = motions()["seed 1"]
    system = rf.System(body, gravity="9.7 m/s^2", inclination="0.5 deg", rotation="small")
    sizes = {"periods": ([2.0, 3.0], "s"), "slenderness": [3, 5]}
    found = rf.rocking_spectrum(system, {"seed 1": motion}, **sizes, **FAST)
    for period in (2.0, 3.0):
        case = rf.case(found, slenderness=5.0, rocking_period=period, motion="seed 1")
        block = case.system.parts.the_block
        frequency = block.frequency_at(system.options.gravity)
        assert 2.0 * np.pi / frequency == pytest.approx(period, rel=1e-12)
        assert 1.0 / np.tan(block.overturning_angle) == pytest.approx(5.0, rel=1e-12)
        assert block.shape_factor == pytest.approx(body.shape_factor, rel=1e-12)
        assert block.mass == body.si.mass
        assert case.system.options == system.options
    sizes = {"periods": ([3.0], "s"), "slenderness": [5]}
    least = rf.overturning_spectrum(system, motion, **sizes, scale=[1.0, 4.0, 16.0], **FAST)
    plain = rf.Block(width="0.5 m", height="2 m", mass="1 t", shape_factor=body.shape_factor)
    same = rf.System(plain, gravity="9.7 m/s^2", inclination="0.5 deg", rotation="small")
    again = rf.overturning_spectrum(same, motion, **sizes, scale=[1.0, 4.0, 16.0], **FAST)
    np.testing.assert_allclose(least.capacity_scale, again.capacity_scale, rtol=2e-3)


def test_an_overturning_spectrum_is_a_dynamic_analysis_of_each_block():
    scales, suite = [0.5, 1.0, 2.0, 4.0, 8.0], dict([*motions().items()][:2])
    found = rf.overturning_spectrum(SYSTEM, suite, periods=(["2 s", "4 s"]), scale=scales, **FAST)
    for place in range(2):
        sizes = found.isel(slenderness=0, rocking_period=place)
        width, height = (f"{sizes[name].item()!r} m" for name in ("width", "height"))
        system = rf.System(BLOCK.replace(width=width, height=height))
        one = rf.incremental_dynamic_analysis(system, suite, scale=scales, **FAST)
        assert np.array_equal(sizes.capacity_scale, one.capacity_scale[0], equal_nan=True)
    pga = [one.peak_acceleration.m_as("m/s^2") for one in suite.values()]
    assert found.capacity_intensity.units == "m s^-2"
    xr.testing.assert_allclose(
        found.capacity_intensity, found.capacity_scale * xr.DataArray(pga, dims="motion")
    )


# probability ---------------------------------------------------------------------------------


def test_a_probability_is_that_of_the_same_cases_run_alone(tmp_path):
    pulse = rf.GroundMotion.sine_pulse("4 m/s^2", "1.5 Hz")
    spread = {"width": ("normal", "0.5 m", "5 cm"), "scale": ("lognormal", 1.0, 0.4)}
    found = rf.probability_of_overturning(SYSTEM, pulse, spread=spread, cases=120, seed=3, **FAST)
    assert checked(found, tmp_path)
    falls = 0
    for k in range(0, 120, 10):
        block = BLOCK.replace(width=f"{found.width[k].item()!r} m")
        run = rf.System(block).simulate(
            pulse.scaled(found.scale[k].item()), accuracy="fast", free_vibration="4 s", outputs=None
        )
        assert run.overturned.item() == found.overturned[k].item()
        falls += run.overturned.item()
    count = int(found.overturned.sum())
    assert found.overturning_probability.item() == count / 120
    exact = stats.binomtest(count, 120).proportion_ci(0.95, method="exact")
    bounds = [found[f"overturning_probability_{end}_bound"].item() for end in ("lower", "upper")]
    assert bounds == pytest.approx([exact.low, exact.high], abs=1e-12)
    # a Latin hypercube has one case in each of as many classes
    share = stats.norm.cdf(found.width.values, 0.5, 0.05)
    assert sorted((share * 120).astype(int)) == list(range(120))
    share = stats.lognorm.cdf(found.scale.values, 0.4)
    assert sorted((share * 120).astype(int)) == list(range(120))
    again = rf.probability_of_overturning(SYSTEM, pulse, spread=spread, cases=120, seed=3, **FAST)
    xr.testing.assert_identical(found.drop_attrs(), again.drop_attrs())


def test_ways_to_draw_and_distributions():
    pulse = rf.GroundMotion.sine_pulse("4 m/s^2", "1.5 Hz")
    for sampling in ("random", "sobol", "latin"):
        found = rf.probability_of_overturning(
            SYSTEM, [pulse, pulse.scaled(0.5)], cases=64, sampling=sampling, **QUIET,
            spread={"height": (stats.uniform(1.8, 0.4), "m"), "scale": ("uniform", 0.5, 2.0)},
        )  # fmt: skip
        assert ((found.height >= 1.8) & (found.height <= 2.2)).all()
        names, counts = np.unique(found.motion.values.astype(str), return_counts=True)
        assert len(names) == 2
        assert counts.sum() == 64
        assert sorted(found.parameter.values) == ["height", "motion", "scale"]


def test_bad_spreads_are_told_all_at_once():
    pulse = rf.GroundMotion.sine_pulse("4 m/s^2", "1.5 Hz")
    with pytest.raises(StudyError) as problem:
        rf.probability_of_overturning(
            SYSTEM, pulse,
            spread={"girth": ("normal", 1, 2), "width": ("normal", 1.0, 0.1),
                    "height": ("gamma", "1 m", "2 m"), "restraint": ("uniform", "centre", "x")},
        )  # fmt: skip
    assert len(problem.value.faults) == 4
    with pytest.raises(ComponentError, match="distributions by names"):
        rf.probability_of_overturning(SYSTEM, pulse, spread={})


def test_a_distribution_in_another_unit_is_refused():
    pulse = rf.GroundMotion.sine_pulse("4 m/s^2", "1.5 Hz")
    given = {"scale": (stats.uniform(50, 100), "%"), "width": (stats.uniform(40, 20), "cm")}
    with pytest.raises(StudyError, match="scale needs a distribution of pure ratios, got one in %"):
        rf.probability_of_overturning(SYSTEM, pulse, spread=given)
    with pytest.raises(StudyError, match="width needs a distribution in m, got one in cm"):
        rf.probability_of_overturning(SYSTEM, pulse, spread=given)


def test_the_ranking_is_that_of_sobol_indices():
    """Y = [a + 0.5 b > 0] of normal a, b: the first-order indices by integration."""
    rng = np.random.default_rng(8)
    a, b, c = rng.normal(size=(3, 40_000))
    verdict = (a + 0.5 * b > 0.0).astype(float)
    found = ranked({"c": c, "b": b, "a": a, "word": rng.choice(["x", "y"], 40_000)}, verdict)
    assert list(found)[:2] == ["a", "b"]
    grid = np.linspace(-8.0, 8.0, 20_001)
    for name, own, other in (("a", 1.0, 0.5), ("b", 0.5, 1.0)):
        share = stats.norm.cdf(own * grid / other)
        weight = stats.norm.pdf(grid)
        variance = np.trapezoid((share - 0.5) ** 2 * weight, grid)
        assert found[name].first_order == pytest.approx(variance / 0.25, abs=0.02)
    assert found["c"].first_order < 0.003
    assert found["a"].chance < 1e-100
    assert found["c"].chance > 1e-4
    expected = stats.ks_2samp(a[verdict == 1.0], a[verdict == 0.0]).statistic
    assert found["a"].distance == expected
    assert np.isnan(ranked({"a": a}, np.ones(40_000))["a"].first_order)


# ensembles -----------------------------------------------------------------------------------


@pytest.mark.long
def test_bands_of_ensembles_hold_as_often_as_they_say():
    rng = np.random.default_rng(4)
    held = {"pointwise": 0, "everywhere": 0, "quantile": 0}
    rounds, count = 400, 25
    for _ in range(rounds):
        found = rf.ensemble_statistics(
            xr.DataArray(rng.random(count), dims="motion", name="share"),
            quantiles=[0.5], confidence=0.9,
        )  # fmt: skip
        # the distribution function at a fixed place is a fixed number
        below = found.ordered_value.values <= 0.4
        low = found.cumulative_probability_lower_bound.values[below]
        high = found.cumulative_probability_upper_bound.values[below]
        held["pointwise"] += (
            (low[-1] if below.any() else 0.0) <= 0.4 <= (high[-1] if below.any() else 1.0)
        )
        value = found.ordered_value.values
        up, share = found.simultaneous_upper_bound.values, found.cumulative_probability.values
        reach = (up - share)[up < 1.0].max()
        jumps = np.concatenate([[0.0], share[:-1]])
        held["everywhere"] += bool(
            np.maximum(np.abs(share - value), np.abs(jumps - value)).max() <= reach
        )
        ends = found.quantile_value_lower_bound.item(), found.quantile_value_upper_bound.item()
        held["quantile"] += ends[0] <= 0.5 <= ends[1]
    assert held["pointwise"] / rounds >= 0.88
    assert 0.86 <= held["everywhere"] / rounds <= 0.94
    assert held["quantile"] / rounds >= 0.88


def test_an_ensemble_of_runs_has_the_units_of_its_variable(tmp_path):
    runs = rf.sweep(SYSTEM, motions(), scale=[1.0, 3.0], **FAST)
    found = rf.ensemble_statistics(runs, "peak_rotation", pooled=["scale"])
    assert checked(found, tmp_path)
    assert found.ordered_value.units == found.quantile_value.units == "rad"
    assert found.ordered_value.values.tolist() == sorted(runs.peak_rotation.values.ravel())
    assert found.member_count.item() == 8
    with pytest.raises(SchemaError, match="expected one of"):
        rf.ensemble_statistics(runs, "height_of_fall")
    with pytest.raises(ComponentError, match="no values"):
        rf.ensemble_statistics(xr.DataArray([np.nan], dims="motion", name="x"))


def test_figures_are_drawn_of_what_they_are_for(analysis):
    drawn = {
        "dynamic_analysis": analysis,
        "fragility": rf.fragility(analysis),
        "rocking_spectrum": rf.rocking_spectrum(
            SYSTEM, motions(), periods=(["2 s", "3 s"]), **FAST
        ),
        "ensemble": rf.ensemble_statistics(analysis.isel(scale=-1)),
    }
    for name, dataset in drawn.items():
        figure = getattr(rf.plot, name)(dataset).figure
        figure.canvas.draw()
        with pytest.raises(SchemaError, match=f"rf.plot.{name} needs"):
            getattr(rf.plot, name)(xr.Dataset())
    with pytest.raises(SchemaError, match=r"rf\.plot\.fragility draws it"):
        rf.plot.ensemble(drawn["fragility"])


# sequences -----------------------------------------------------------------------------------


def test_earthquakes_in_sequence_are_runs_that_go_on(tmp_path):
    """Each starts where the one before ended: the same as going on from its dataset."""
    system = rf.System(BLOCK, rf.TwoSpringSupport(frequency_ratio=15, damping_ratio=0.1))
    one, two = list(motions().values())[:2]
    two = two.with_vertical(one.scaled(0.3))
    given = {"first": [one, two.scaled(0.9), one], "short": [two.scaled(4.0)]}
    found = rf.earthquake_sequences(system, given, pause="0.5 s", **QUIET)
    assert checked(found, tmp_path)
    assert found.peak_rotation.dims == ("sequence", "earthquake")
    assert np.isnan(found.peak_rotation.sel(sequence="short").values[1:]).all()
    assert found.overturning_earthquake.values.tolist() == [0, 1]
    response = system.simulate(one, free_vibration="0.5 s", outputs=())
    peaks = [response.peak_rotation.item()]
    for motion in (two.scaled(0.9), one):
        response = system.simulate(motion, free_vibration="0.5 s", initial=response)
        peaks.append(max(peaks[-1], response.peak_rotation.item()))
    assert found.peak_rotation.sel(sequence="first").values == pytest.approx(peaks, rel=1e-4)


@pytest.mark.parametrize("step", ["0.02 s", "0.004 s", "0.0125 s"])
@pytest.mark.parametrize("first", [0, 1])
def test_earthquakes_of_unlike_time_steps_stay_what_they_are(step, first):
    """Each earthquake is the function of time that it is alone."""
    coarse = motions()["seed 1"].resampled(step)
    vertical = motions()["seed 0"]
    several = [coarse, vertical.with_vertical(vertical.scaled(0.4))]
    one, two = several[first], several[1 - first]
    found = rf.earthquake_sequences(SYSTEM, {"both": [one, two]}, pause="2 s", **QUIET)
    before = SYSTEM.simulate(one, free_vibration="2 s", outputs=None)
    after = SYSTEM.simulate(two, free_vibration="2 s", initial=before, outputs=None)
    peaks = [before.peak_rotation.item(), max(before.peak_rotation, after.peak_rotation).item()]
    assert found.peak_rotation.sel(sequence="both").values == pytest.approx(peaks, rel=1e-6)


def test_pulses_and_records_are_in_one_sequence():
    pulse = rf.GroundMotion.cosine_pulse("3 m/s^2", "1 Hz", 0.5)
    record = motions()["seed 0"]
    assert pulse.si.time_step != record.si.time_step
    found = rf.earthquake_sequences(SYSTEM, [[pulse, record]], pause="8 s", **QUIET)
    alone = SYSTEM.simulate(pulse, free_vibration="8 s", outputs=None)
    assert found.peak_rotation[0, 0].item() == pytest.approx(alone.peak_rotation.item(), rel=1e-9)


def test_pulses_keep_their_polynomials_in_a_sequence():
    pulse = rf.GroundMotion.cosine_pulse("3 m/s^2", "1 Hz", 0.5)
    found = rf.earthquake_sequences(SYSTEM, [[pulse, pulse]], pause="8 s", **QUIET)
    alone = SYSTEM.simulate(pulse, free_vibration="8 s", outputs=None)
    peaks = found.peak_rotation.squeeze().values
    assert peaks == pytest.approx([alone.peak_rotation.item()] * 2, rel=1e-9)
    odd = rf.GroundMotion.from_arrays(([0.0, 1.0, 0.0], "m/s^2"), f"{np.pi / 500} s")
    with pytest.raises(ComponentError, match="no common part; resample"):
        rf.earthquake_sequences(SYSTEM, [[odd, motions()["seed 0"]]])
    for wrong in ({}, [[]], [["x"]], 3):
        with pytest.raises(ComponentError):
            rf.earthquake_sequences(SYSTEM, wrong)


def test_gaps_are_looked_into_where_a_lower_body_alone_moves():
    """The squat body on top never leaves its base."""
    squat = rf.Block(width="0.9 m", height="0.6 m", mass="900 kg")
    slender = rf.Block(width="0.95 m", height="5 m", mass="9 t")
    stone = rf.RigidGround()
    found = rf.incremental_dynamic_analysis(
        rf.System(rf.Stack(squat, slender, interfaces=[stone]), stone),
        rf.GroundMotion.sine_pulse("1 m/s^2", "0.6 Hz"), scale=[1.0, 8.0],
        resolution=0.5, bracket_width=0.1, free_vibration="4 s", accuracy="fast",
    )  # fmt: skip
    assert found.first_uplift_time.isnull().all()
    assert 0.0 < found.capacity_resolution.item() <= 0.5


def test_a_wall_that_has_a_height_leaves_that_of_the_block_to_spectra():
    block = rf.Block(width="0.8 m", height="3.2 m", mass="5.5 t")
    wall, pulse = rf.RearWall(side="left"), rf.GroundMotion.sine_pulse("-4 m/s^2", "1 Hz")
    found = rf.rocking_spectrum(rf.System(block, wall), pulse, periods=["4 s"], accuracy="fast")
    width, height = (float(found[name].item()) for name in ("width", "Block.height"))
    alone = rf.System(block.replace(width=f"{width!r} m", height=f"{height!r} m"), wall)
    expected = alone.simulate(pulse, accuracy="fast", outputs=None).peak_rotation.item()
    assert found.peak_rotation.item() == pytest.approx(expected, rel=1e-9)
    again = rf.case(found, slenderness=4.0, rocking_period=4.0).system.parts.block
    assert again.si.height == pytest.approx(height, rel=1e-12)


def test_spectra_name_what_is_no_block():
    frame = rf.RockingFrame(
        rf.Block(width="0.8 m", height="3.2 m", mass="5.5 t"), columns=2, beam_mass="1 t"
    )
    pulse = rf.GroundMotion.sine_pulse("4 m/s^2", "1 Hz")
    with pytest.raises(rf.errors.ComponentError, match="got a RockingFrame"):
        rf.rocking_spectrum(rf.System(frame), pulse, periods=["4 s"])


def test_a_sequence_tells_the_pause_that_it_made():
    """Pauses are whole time steps, and of each sequence its own."""
    fine = rf.GroundMotion.from_arrays((np.zeros(50), "m/s^2"), "4 ms")
    coarse = rf.GroundMotion.from_arrays((np.zeros(50), "m/s^2"), "10 ms")
    given = {"coarse": [coarse, coarse], "fine": [fine, fine]}
    found = rf.earthquake_sequences(SYSTEM, given, pause="4 ms", **QUIET)
    assert found.pause.dims == ("sequence",)
    assert found.pause.attrs["units"] == "s"
    np.testing.assert_allclose(found.pause, [0.01, 0.004], rtol=1e-12)
    assert "pause" not in found.attrs
