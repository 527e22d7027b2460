"""Fragilities: Baker's numbers, brute force, coverage, and samples without a fit."""

import numpy as np
import pandas as pd
import pytest
import xarray as xr
from scipy import optimize, stats

import rockframe as rf
from rockframe.errors import ComponentError, FileError, SchemaError, StudyError, UnitsError
from rockframe.results.variables.analyses import FragilityStatus
from rockframe.studies.confidence import clopper_pearson
from rockframe.studies.fragility.likelihood import Bands, boundary, fit, log_likelihood
from rockframe.studies.fragility.trials import Trials

LEVELS = [0.2, 0.3, 0.4, 0.6, 0.7, 0.8, 0.9, 1.0]
EXCEEDED = [0, 0, 0, 4, 6, 13, 12, 16]
GRAVITY = 9.80665


def fragility_of_counts(intensity, exceeded, trials, measure="PGA", **options):
    counts = {"intensity": intensity, "exceeded": exceeded, "trials": trials}
    return rf.fragility(counts, measure, **options)


def fragility_of_baker(**options):
    return fragility_of_counts((LEVELS, "g_0"), EXCEEDED, 40, **options)


def parameters(found):
    intercept, slope = found.coefficients
    return -intercept / slope, 1.0 / slope


def test_fit_reproduces_published_baker_example():
    found = fragility_of_baker()
    assert found.median_intensity.item() / GRAVITY == pytest.approx(1.0761158, abs=6e-8)
    assert found.dispersion.item() == pytest.approx(0.4292372, abs=6e-8)
    assert found.log_median_error.item() == pytest.approx(0.07166, abs=6e-6)
    assert found.dispersion_error.item() == pytest.approx(0.08387, abs=6e-6)
    assert found.median_intensity.units == found.peak_ground_acceleration.units == "m s^-2"
    assert found.dispersion.units == "1"
    at = found.exceedance_probability.interp(peak_ground_acceleration=0.8 * GRAVITY).item()
    log = np.log(0.8 / 1.0761158) / 0.4292372
    assert at == pytest.approx(stats.norm.cdf(log), abs=1e-4)


def test_profile_intervals_match_brute_force():
    """The other parameter is optimised anew for each value of one parameter."""
    found = fragility_of_baker(confidence=0.9)
    logs, over = np.log(LEVELS), np.array(EXCEEDED)

    def fall(median, spread):
        chance = stats.norm.cdf((logs - median) / spread)
        return -stats.binom.logpmf(over, 40, chance).sum()

    best = fall(np.log(1.0761158), 0.4292372)
    drop = 0.5 * stats.chi2.ppf(0.9, 1)

    def beyond(value, which):
        def other(one):
            return fall(*((value, one) if which == 0 else (one, value)))

        bounds = (0.05, 4.0) if which == 0 else (-2.0, 3.0)
        least = optimize.minimize_scalar(other, bounds=bounds, method="bounded")
        return least.fun - best - drop

    middle = np.log(1.0761158), 0.4292372
    names = "median_intensity", "dispersion"
    for which, far in ((0, (-0.5, 2.0)), (1, (0.1, 3.0))):
        for end, edge in zip(("lower", "upper"), far, strict=True):
            expected = optimize.brentq(beyond, edge, middle[which], args=(which,))
            bound = found[f"{names[which]}_{end}_bound"].item()
            bound = np.log(bound / GRAVITY) if which == 0 else bound
            assert bound == pytest.approx(expected, abs=2e-4), (names[which], end)


def test_clopper_pearson_bounds_match_scipy():
    cases = [(0, 40), (4, 40), (40, 40), (1, 3)]
    lower, upper = clopper_pearson(*np.array(cases).T, 0.95)
    for (over, count), low, high in zip(cases, lower, upper, strict=True):
        exact = stats.binomtest(over, count).proportion_ci(0.95, method="exact")
        assert (low, high) == pytest.approx((exact.low, exact.high), abs=1e-12)
    assert list(clopper_pearson(np.array([0]), np.array([0]), 0.9)) == [[0.0], [1.0]]
    found = fragility_of_baker()
    assert found.stripe_exceedances.values.tolist() == EXCEEDED
    assert found.stripe_trials.values.tolist() == [40] * 8
    assert found.stripe_fraction.values.tolist() == [over / 40 for over in EXCEEDED]
    assert found.stripe_intensity.values == pytest.approx(np.array(LEVELS) * GRAVITY)


def test_bracketed_capacities_are_fitted_as_censored_lognormals():
    """Narrow brackets give mean and standard deviation of logarithms; open ends are censored."""
    rng = np.random.default_rng(3)
    logs = rng.normal(0.4, 0.3, 60)
    every, none = np.ones(60, dtype=bool), np.zeros(60, dtype=bool)
    narrow = Trials(logs[:, None] - 1e-4, logs[:, None] + 1e-4, every, every, np.ones(60), None)
    assert parameters(fit(narrow, Bands.PROFILE)) == pytest.approx(
        (logs.mean(), logs.std()), abs=1e-6
    )
    known = logs < 0.5
    ends = np.where(known, logs, 0.5)[:, None]
    censored = Trials(ends - 1e-4, ends + 1e-4, every, known, np.ones(60), None)
    data = stats.CensoredData(uncensored=logs[known], right=np.full((~known).sum(), 0.5))
    mean, spread = stats.norm.fit(data)
    lower = np.where(known, logs - 1e-4, 0.5)[:, None]
    censored = Trials(lower, ends + 1e-4, every, known, np.ones(60), None)
    assert parameters(fit(censored, Bands.PROFILE)) == pytest.approx((mean, spread), abs=1e-4)
    assert fit(Trials(ends, ends, every, none, np.ones(60), None), Bands.PROFILE).status == (
        FragilityStatus.NONE_EXCEEDED
    )


def test_scores_and_information_are_derivatives_of_likelihood():
    rng = np.random.default_rng(5)
    lower = rng.normal(size=(30, 2))
    upper = lower + rng.uniform(0.01, 2.0, (30, 2))
    has = rng.random((2, 30)) < 0.7
    has[0] |= ~has[1]
    trials = Trials(lower, upper, has[0], has[1], rng.uniform(1.0, 3.0, 30), None)
    at = np.array([0.2, 0.8, 0.3])

    def value(coefficients):
        return log_likelihood(trials, np.asarray(coefficients)[:, None])[0]

    from rockframe.studies.fragility.likelihood import information, scores

    slope = optimize.approx_fprime(at, value, 1e-7)
    assert scores(trials, at).sum(axis=0) == pytest.approx(slope, rel=1e-4, abs=1e-4)
    step = 1e-5
    rows = [
        (scores(trials, at + step * one).sum(axis=0) - scores(trials, at - step * one).sum(axis=0))
        / (2.0 * step)
        for one in np.eye(3)
    ]
    assert information(trials, at) == pytest.approx(-np.array(rows), rel=1e-6, abs=1e-6)


def test_likelihood_is_accurate_in_the_tails():
    logs = np.log(np.array(LEVELS))[:, None]
    for weight in (1.0, 1e6):
        trials = Trials.from_verdicts(logs, weight * np.array(EXCEEDED), weight * np.full(8, 40.0))
        found = fit(trials, Bands.PROFILE)
        edge = boundary(trials, found, 0.95)
        drop = 2.0 * (
            log_likelihood(trials, found.coefficients[:, None]) - log_likelihood(trials, edge)
        )
        assert drop == pytest.approx(stats.chi2.ppf(0.95, 1), rel=1e-5)
        assert parameters(found)[1] == pytest.approx(0.4292372, abs=1e-6)
    far = Trials.from_verdicts(
        np.array([[0.0], [1.0], [9.0]]), np.array([1, 0, 1.0]), np.array([2, 1, 2.0])
    )
    assert np.isfinite(log_likelihood(far, np.array([[-300.0], [40.0]]))).all()


@pytest.mark.wide
def test_sandwich_bands_have_nominal_coverage():
    """Bands that assume independence are too narrow for clusters of dependent trials."""
    rng = np.random.default_rng(11)
    levels = np.log(np.geomspace(0.3, 3.0, 8))
    held = {Bands.PROFILE: 0, Bands.SANDWICH: 0}
    rounds, groups = 150, 40
    for _ in range(rounds):
        capacity = rng.normal(0.0, 0.4, groups)  # one for each motion, whatever its scale
        verdict = (capacity[:, None] < levels).astype(float).ravel()
        cluster = np.repeat(np.arange(groups), len(levels))
        logs = np.tile(levels, groups)[:, None]
        trials = Trials.from_verdicts(logs, verdict, np.ones(verdict.size), cluster)
        for bands in held:
            found = fit(trials, bands)
            row = np.array([1.0, 0.3])
            reach = 1.96 * np.sqrt(row @ found.covariance @ row)
            held[bands] += abs(found.coefficients @ row - 0.3 / 0.4) < reach
    assert 0.89 <= held[Bands.SANDWICH] / rounds <= 0.99
    assert held[Bands.PROFILE] < held[Bands.SANDWICH]


def test_two_measures_find_the_coefficients():
    rng = np.random.default_rng(2)
    first, second = np.exp(rng.normal(size=(2, 4000)) * 0.5)
    eta = -0.3 + 2.0 * np.log(first) + 1.0 * np.log(second)
    verdict = (rng.random(4000) < stats.norm.cdf(eta)).astype(float)
    trials = Trials.from_verdicts(np.log(np.column_stack([first, second])), verdict, np.ones(4000))
    found = fit(trials, Bands.SANDWICH)
    assert found.coefficients == pytest.approx([-0.3, 2.0, 1.0], abs=0.2)
    errors = np.sqrt(np.diag(found.covariance))
    assert (np.abs(found.coefficients - [-0.3, 2.0, 1.0]) < 3.5 * errors).all()


def test_verdict_tells_a_median_beyond_all_intensities():
    words = "The median is extrapolated: the intensities of all trials are from 1 to 3 m s^-2."
    for exceeded, is_beyond in (([0, 1, 4], True), ([1, 5, 9], False), ([7, 8, 9], True)):
        found = fragility_of_counts(([1.0, 2.0, 3.0], "m/s^2"), exceeded, 10)
        assert (words in found.verdict) is is_beyond
        cut = found.sel(peak_ground_acceleration=slice(1.9, 2.1))
        assert ("extrapolated" in cut.rockframe.verdict) is is_beyond


def test_counts_without_a_fit_have_a_status():
    cases = {
        FragilityStatus.NONE_EXCEEDED: [0, 0, 0],
        FragilityStatus.ALL_EXCEEDED: [5, 5, 5],
        FragilityStatus.SEPARATED: [0, 0, 5],
        FragilityStatus.NOT_RISING: [4, 3, 1],
    }
    for status, over in cases.items():
        found = fragility_of_counts(([1.0, 2.0, 4.0], "m/s^2"), over, 5)
        assert found.fragility_status.item() == status, status
        if status != FragilityStatus.SEPARATED:
            assert np.isnan(found.median_intensity.item())
    found = fragility_of_counts(([1.0, 2.0, 4.0], "m/s^2"), [0, 0, 5], 5)
    assert found.dispersion.item() == 0.0
    assert found.median_intensity.item() == pytest.approx(np.sqrt(8.0))
    gap = found.separation_lower_intensity.item(), found.separation_upper_intensity.item()
    assert gap == pytest.approx((2.0, 4.0))
    assert set(found.exceedance_probability.values.tolist()) == {0.0, 1.0}
    # 15 trials can be separated in 14 ways; at a bound this one has a 14th of five per cent
    dispersions = np.geomspace(0.01, 2.0, 2000)
    for end in ("lower", "upper"):
        median = found[f"median_intensity_{end}_bound"].item()
        eta = np.log(np.array([1.0, 2.0, 4.0]) / median)[:, None] / dispersions
        shares = stats.norm.cdf(np.array([[-1.0], [-1.0], [1.0]]) * eta)
        assert np.prod(shares**5, axis=0).max() == pytest.approx(0.05 / 14.0, rel=0.01)
    few = fragility_of_counts(([1.0, 2.0, 4.0], "m/s^2"), [0, 0, 1], 1)
    bounds = [few[name] for name in few if str(name).endswith("_bound")]
    assert all(np.isnan(one).all() for one in bounds if not one.name.startswith("stripe"))
    for rounding in (0.0, 1e-15):  # as for motions scaled to the intensity
        one = fragility_of_counts(([2.0, 2.0 + rounding, 2.0], "m/s^2"), [1, 2, 3], 5)
        assert one.fragility_status.item() == FragilityStatus.ONE_INTENSITY
    reversed_ = fragility_of_counts(([1.0, 2.0], "m/s^2"), [5, 0], 5)
    assert reversed_.fragility_status.item() == FragilityStatus.NOT_RISING


def test_equal_shares_at_all_intensities_do_not_rise():
    """The likelihood is greatest at a slope of zero, up to rounding of about 1e-15."""
    for over, trials in ((7, 16), (8, 16), (1, 3)):
        for levels in ([2.151, 2.456], [0.1, 0.3, 7.0]):
            found = fragility_of_counts((levels, "m/s^2"), [over] * len(levels), trials)
            assert found.fragility_status.item() == FragilityStatus.NOT_RISING
            assert np.isnan(found.median_intensity.item())


def test_bad_counts_are_refused():
    for unit in ("furlong", "m/s"):
        with pytest.raises(UnitsError, match="is in m s"):
            fragility_of_counts(([1.0], unit), [1], 2)
    for over, count in (([3], 2), ([-1], 2), ([0.5], 2), ([1, 1], 2)):
        with pytest.raises(ComponentError, match="number of exceedances"):
            fragility_of_counts((["1 m/s^2"]), over, count)
    with pytest.raises(ComponentError, match="bands"):
        fragility_of_baker(bands="wide")
    with pytest.raises(SchemaError, match="no sweep"):
        rf.fragility(xr.Dataset())


BLOCK = rf.Block(width="0.5 m", height="2 m", mass="400 kg")
SYSTEM = rf.System(BLOCK)


def motions():
    return {f"seed {k}": rf.GroundMotion.stochastic(6.3, "8 km", seed=k) for k in range(6)}


@pytest.fixture(scope="module")
def runs():
    return rf.sweep(
        SYSTEM, motions(), scale=[0.5, 1.5, 3.0, 5.0, 8.0], free_vibration="4 s", progress=False
    )


def test_runs_are_counted_by_exceeded_limit_state(runs):
    found = rf.fragility(runs, "PGA", limits=["uplift", 0.3])
    assert found.limit_state.values.tolist() == ["uplift", "rotation 0.3", "overturning"]
    assert found.rotation_limit.values.tolist() == [0.0, 0.3, 1.0]
    peaks = runs.peak_relative_rotation
    falls = runs.overturned.values
    for state, over in (
        ("uplift", (runs.impact_count.values > 0) | (peaks.values > 0)),
        ("rotation 0.3", (peaks.values >= 0.3) | falls),
        ("overturning", falls),
    ):
        assert found.sel(limit_state=state).stripe_exceedances.sum() == over.sum(), state
    uplift = found.sel(limit_state="uplift")
    assert uplift.fragility_status == FragilityStatus.SEPARATED
    assert uplift.separation_lower_intensity < GRAVITY / 4 < uplift.separation_upper_intensity
    pga = np.array([one.peak_acceleration.m_as("m/s^2") for one in motions().values()])
    logs = np.log(np.outer(runs.scale.values, pga)).ravel()[:, None]
    cluster = np.tile(np.arange(6), 5)
    trials = Trials.from_verdicts(logs, falls.astype(float).ravel(), np.ones(30), cluster)
    expected = fit(trials, Bands.SANDWICH)
    last = found.sel(limit_state="overturning")
    assert (np.log(last.median_intensity.item()), last.dispersion.item()) == pytest.approx(
        parameters(expected), rel=1e-6
    )
    assert found.attrs["bands"] == "jackknife"


def test_intensities_belong_to_the_scaled_motions(runs):
    from rockframe.studies.intensities import Intensity, intensity_of_runs

    motion = motions()["seed 2"].scaled(3.0)
    one = {"motion": "seed 2", "scale": 3.0}
    measures = rf.intensity_measures(motion)
    for name in ("PGA", "PGV", "CAV", "arias_intensity", "mean_period"):
        read = Intensity.read(name, None, owner="test")
        found = intensity_of_runs(runs, read, None, owner="test")
        found = found.sel({key: one[key] for key in found.dims})
        assert found.item() == pytest.approx(measures[read.name].item(), rel=1e-9), name
        assert found.attrs["units"] == measures[read.name].units
    read = Intensity.read("SA", "0.5 s", owner="test")
    spectrum = rf.response_spectrum(motion, ["0.5 s"]).pseudo_spectral_acceleration
    found = intensity_of_runs(runs, read, None, owner="test").sel(one)
    assert found.item() == pytest.approx(spectrum.item(), rel=1e-9)
    to_target = rf.sweep(
        SYSTEM, motions(), peak_ground_velocity=(["0.3 m/s"]), accuracy="fast", progress=False
    )
    pga = intensity_of_runs(
        to_target, Intensity.read("PGA", None, owner="test"), None, owner="test"
    )
    scaled = motions()["seed 2"].scaled(peak_velocity="0.3 m/s").peak_acceleration.m_as("m/s^2")
    assert pga.sel(motion="seed 2").item() == pytest.approx(scaled, rel=1e-9)


def test_fragility_accepts_two_measures_and_a_custom_measure(runs):
    both = rf.fragility(runs, ("PGA", "PGV/PGA"), limits=())
    assert both.exceedance_probability.dims == (
        "limit_state", "peak_ground_acceleration", "velocity_to_acceleration_ratio",
    )  # fmt: skip
    assert both.velocity_to_acceleration_ratio.units == "s"
    own = xr.DataArray(
        np.linspace(1.0, 2.0, 5), dims="scale", coords={"scale": runs.scale},
        name="storey", attrs={"units": "1"},
    )  # fmt: skip
    assert "storey" in rf.fragility(runs, own, limits=()).coords
    with pytest.raises(ComponentError, match="needs a period"):
        rf.fragility(runs, "SA")
    with pytest.raises(ComponentError, match="must be one of"):
        rf.fragility(runs, "magnitude")
    with pytest.raises(ComponentError, match="bands by profile are those of one intensity"):
        rf.fragility(runs, ("PGA", "PGV"), bands="profile")


def test_runs_without_a_finite_intensity_are_in_no_stripe(runs):
    own = runs.scale * xr.ones_like(runs.status, dtype=float)
    own = own.rename("mine").assign_attrs(units="1")
    own[{"scale": 0, "motion": 0}], own[{"scale": 0, "motion": 1}] = np.inf, 0.0
    found = rf.fragility(runs, own, limits=())
    counts = found.trial_count.item(), found.left_out_count.item()
    assert counts == (found.stripe_trials.sum().item(), 2)
    assert sum(counts) == runs.status.size
    both = rf.fragility(runs, (own, "PGA"), limits=())
    assert (both.trial_count.item(), both.left_out_count.item()) == counts


def test_custom_measure_is_aligned_by_labels(runs):
    measure = rf.intensity_measures(motions())
    own = (measure.peak_ground_velocity * runs.scale).rename("mine").assign_attrs(units="m s^-1")
    expected = rf.fragility(runs, own)
    more = xr.concat([own, own.isel(motion=[0]).assign_coords(motion=["none"])], "motion")
    for intensity in (own.isel(motion=slice(None, None, -1)), more.rename("mine")):
        found = rf.fragility(runs, intensity)
        np.testing.assert_array_equal(found.median_intensity, expected.median_intensity)
    with pytest.raises(ComponentError, match="has 2 values along 'motion', of which"):
        rf.fragility(runs, own.drop_vars("motion").isel(motion=slice(2)))
    twice = own.assign_coords(motion=["seed 0"] * own.sizes["motion"])
    with pytest.raises(ComponentError, match="labels that stand twice along 'motion'"):
        rf.fragility(runs, twice)


def test_fragility_survives_netcdf_round_trip(runs, tmp_path):
    for found in (rf.fragility(runs), rf.fragility(runs, ("PGA", "PGV"))):
        found.to_netcdf(tmp_path / "fragility.nc")
        with xr.open_dataset(tmp_path / "fragility.nc") as again:
            xr.testing.assert_identical(again.load().drop_attrs(), found.drop_attrs())
            assert again.attrs["verdict"] == found.attrs["verdict"]


def test_fragility_of_a_reopened_sweep_requires_its_records(tmp_path):
    records = [
        rf.GroundMotion.from_arrays(
            (np.concatenate([[0.0], np.random.default_rng(k).normal(size=300), [0.0]]), "m/s^2"),
            "0.02 s",
        )
        for k in range(3)
    ]
    runs = rf.sweep(SYSTEM, records, scale=[0.5, 1.0, 3.0, 9.0], progress=False)
    found = rf.fragility(runs, limits=())
    runs.to_netcdf(tmp_path / "runs.nc")
    from rockframe.studies.sweeps import study

    study._cache.clear()
    again = xr.open_dataset(tmp_path / "runs.nc").load()
    with pytest.raises(StudyError, match=r"^fragility: the record .* must be given, as motions="):
        rf.fragility(again)
    xr.testing.assert_equal(rf.fragility(again, limits=(), motions=records), found)


def test_pelicun_export_writes_one_row(runs):
    found = rf.fragility(runs, "PGA", limits=[0.3])
    row = rf.export.to_pelicun(found, "E.1", demand="Peak Floor Acceleration", directional=True)
    assert row.index.tolist() == ["E.1"]
    head = "Incomplete,Demand-Type,Demand-Unit,Demand-Offset,Demand-Directional"
    limit = "LS{0}-Family,LS{0}-Theta_0,LS{0}-Theta_1,LS{0}-DamageStateWeights"
    assert row.to_csv().splitlines()[0] == f"ID,{head},{limit.format(1)},{limit.format(2)}"
    for place in range(2):
        median = found.median_intensity[place].item() / GRAVITY
        assert row[f"LS{place + 1}-Theta_0"].item() == pytest.approx(median, rel=1e-12)
        assert row[f"LS{place + 1}-Theta_1"].item() == found.dispersion[place].item()
    spectral = rf.fragility(runs, "SA", period="0.5 s", limits=())
    assert (
        rf.export.to_pelicun(spectral, "x")["Demand-Type"].item()
        == "Peak Spectral Acceleration|0.5"
    )
    with pytest.raises(ComponentError, match="'Peak Spectral Acceleration' is, got 'Peak Floor"):
        rf.export.to_pelicun(spectral, "x", demand="Peak Floor Acceleration")
    with pytest.raises(ComponentError, match="'uplift' has no lognormal fit"):
        rf.export.to_pelicun(rf.fragility(runs), "x")
    with pytest.raises(SchemaError, match="found no fragility over one of"):
        rf.export.to_pelicun(rf.fragility(runs, "CAV", limits=()), "x")


def test_exports_sort_limit_states_by_their_medians(runs, tmp_path):
    """Both programs take the last limit state that is exceeded for the most severe one."""
    found = rf.fragility(runs, "PGA", limits=[0.3])
    backwards = found.isel(limit_state=[1, 0])
    assert found.median_intensity[0] < found.median_intensity[1]
    pd.testing.assert_frame_equal(
        rf.export.to_pelicun(backwards, "x"), rf.export.to_pelicun(found, "x")
    )
    first, second = (
        rf.export.to_openquake({"x": one}, tmp_path / f"{k}.xml").read_text()
        for k, one in enumerate((found, backwards))
    )
    assert first == second


def test_openquake_reads_the_same_probabilities(runs, tmp_path):
    nrml = pytest.importorskip("openquake.hazardlib.nrml", reason="needs openquake.engine")
    pytest.importorskip("openquake.risklib.read_nrml", reason="needs openquake.engine")
    found = rf.fragility(runs, "PGV", limits=[0.3])
    model = nrml.to_python(str(rf.export.to_openquake({"block": found}, tmp_path / "f.xml")))
    ((_, functions),) = model.items()
    levels = 100.0 * found.peak_ground_velocity.to_numpy()
    for one, state in zip(functions.build(model.limitStates), found.limit_state, strict=True):
        curve = found.exceedance_probability.sel(limit_state=state).to_numpy()
        np.testing.assert_allclose(one(levels[1:]), curve[1:], rtol=1e-6)
        assert (one(levels[0] * np.array([1e-9, 0.1, 0.6, 0.99])) == 0.0).all()


def test_pelicun_samples_damage_at_the_exported_probability(tmp_path):
    pelicun = pytest.importorskip("pelicun.assessment", reason="needs pelicun")
    found = fragility_of_counts(([0.2, 0.3, 0.4, 0.6, 0.8], "g_0"), [1, 4, 6, 13, 16], 20)
    rf.export.to_pelicun(found, "cabinet").to_csv(tmp_path / "library.csv")
    library = pd.read_csv(tmp_path / "library.csv", index_col="ID")
    library = library.drop(columns="LS1-DamageStateWeights")
    heads = [(*name.split("-", 1), "")[:2] for name in library.columns]
    library.columns = pd.MultiIndex.from_tuples(heads)
    size, demand = 4000, 0.8 * found.median_intensity.item() / GRAVITY
    # the block rocks along the first axis of a plan; along the second motion is negligible
    axes = [("PGA", "0", "1"), ("PGA", "0", "2")]
    columns = pd.MultiIndex.from_tuples(axes, names=["type", "loc", "dir"])
    units = pd.DataFrame([["g", "g"]], columns=columns, index=["Units"])
    sample = pd.DataFrame(np.tile([demand, 1e-6], (size, 1)), columns=columns)
    piece = {
        "Units": "ea", "Location": "0", "Direction": "1", "Theta_0": "1", "Blocks": "1",
        "Family": None,
    }  # fmt: skip
    program = pelicun.Assessment({"PrintLog": False, "Seed": 1, "Verbose": False})
    program.demand.load_sample(pd.concat([units, sample]))
    program.stories = 0
    program.asset.load_cmp_model({"marginals": pd.DataFrame([piece], index=["cabinet"])})
    program.asset.generate_cmp_sample(size)
    program.damage.load_model_parameters([library], {"cabinet"})
    program.damage.calculate()
    shares = program.damage.ds_model.sample.mean()
    expected = stats.norm.cdf(np.log(0.8) / found.dispersion.item())
    assert shares["cabinet", "0", "1", "0", "1"] == pytest.approx(expected, abs=0.002)


def test_openquake_export_writes_a_fragility_model(runs, tmp_path):
    from lxml import etree

    found = rf.fragility(runs, "PGA", limits=[0.3])
    baker = fragility_of_baker()
    with pytest.raises(ComponentError, match="same limit states"):
        rf.export.to_openquake({"block": found, "baker": baker}, tmp_path / "f.xml")
    file = rf.export.to_openquake({"block": found, "other": found}, tmp_path / "f.xml")
    root = etree.parse(file).getroot()
    space = "{http://openquake.org/xmlns/nrml/0.5}"
    assert root.tag == f"{space}nrml"
    (model,) = root
    assert dict(model.attrib) == {
        "id": "rockframe", "assetCategory": "contents", "lossCategory": "contents",
    }  # fmt: skip
    assert model.findtext(f"{space}limitStates") == "rotation_0_3 overturning"
    assert len(model.findall(f"{space}fragilityFunction")) == 2
    function = model.find(f"{space}fragilityFunction")
    levels = function.find(f"{space}imls")
    assert levels.get("imt") == "PGA"
    # no damage up to the least intensity, below which intensities must also be known
    least, most = (float(found.peak_ground_acceleration[k]) / GRAVITY for k in (0, -1))
    ends = [float(levels.get(name)) for name in ("minIML", "noDamageLimit", "maxIML")]
    assert ends == pytest.approx([0.5 * least, least, most], rel=1e-9)
    limited = rf.export.to_openquake({"block": found}, tmp_path / "l.xml", no_damage_limit=most)
    assert f'minIML="{least:.10g}" maxIML="{most:.10g}" noDamageLimit="{most:.10g}"' in (
        limited.read_text()
    )
    for place, one in enumerate(function.findall(f"{space}params")):
        theta, beta = found.median_intensity[place].item() / GRAVITY, found.dispersion[place].item()
        mean, deviation = stats.lognorm.stats(beta, scale=theta)
        assert float(one.get("mean")) == pytest.approx(mean, rel=1e-9)
        assert float(one.get("stddev")) == pytest.approx(np.sqrt(deviation), rel=1e-9)
    velocity = rf.fragility(runs, "PGV", limits=())
    text = rf.export.to_openquake({"b": velocity}, tmp_path / "v.xml").read_text()
    theta, beta = velocity.median_intensity.item(), velocity.dispersion.item()
    assert f'mean="{100.0 * theta * np.exp(0.5 * beta**2):.10g}"' in text
    for wrong in ({"a b": found}, {}):
        with pytest.raises(ComponentError):
            rf.export.to_openquake(wrong, tmp_path / "w.xml")
    mine = tmp_path / "mine.xml"
    mine.write_text("<nrml/>")
    with pytest.raises(FileError, match="not a fragility model that rockframe wrote"):
        rf.export.to_openquake({"b": velocity}, mine)
    with pytest.raises(FileError, match=r"ends in \.xml"):
        rf.export.to_openquake({"b": velocity}, tmp_path / "f.csv")
    assert mine.read_text() == "<nrml/>"
    assert rf.export.to_openquake({"b": velocity}, mine, overwrite=True).read_text() == text
    assert rf.export.to_openquake({"b": velocity}, file).read_text() == text  # its own


def test_median_beyond_float_range_is_infinite():
    counts = {"intensity": ([1.0, 2.0], "m/s^2"), "exceeded": [100_000, 100_010], "trials": 10**6}
    found = rf.fragility(counts, "PGA")
    assert found.median_intensity == np.inf
    np.testing.assert_allclose(found.exceedance_probability, 0.1, rtol=1e-3)
    assert "median" in found.verdict


def test_verdict_uses_another_limit_state_if_none_overturn():
    slides = rf.System(rf.Block(width="1 m", height="1.2 m", mass="300 kg"),
                       rf.RigidGround(friction=0.3))  # fmt: skip
    suite = {f"{f} Hz": rf.GroundMotion.sine_pulse("4 m/s^2", f"{f} Hz") for f in (0.8, 1, 1.3)}
    runs = rf.sweep(slides, suite, scale=[0.5, 1, 1.5, 2], free_vibration="1 s")
    found = rf.fragility(runs, "PGV", limits=[("peak_slip", "5 cm"), ("peak_slip", "1 km")])
    assert "Against overturning no lognormal" in found.verdict
    assert "exceeded. Against peak slip 0.05 m no lognormal" in found.verdict
    assert "None exceeded up to" in found.verdict
    rough = suite | {"later": rf.GroundMotion.stochastic(6, "10 km", seed=1).scaled(peak="4 m/s^2")}
    runs = rf.sweep(slides, rough, scale=[0.5, 1, 1.5, 2], free_vibration="1 s")
    found = rf.fragility(runs, "PGA", limits=[("peak_slip", "5 cm")])
    assert "Capacity against peak slip 0.05 m: median" in found.verdict
