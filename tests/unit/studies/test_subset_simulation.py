"""Subset simulation: brute force, ties, stores, interrupts, labels, and refusals."""

import numpy as np
import pytest
import xarray as xr
from scipy import stats
from stored_sweep import assert_identical

import rockframe as rf
from rockframe.errors import ComponentError, ModelWarning, SolverWarning, StudyError
from rockframe.results.schema import SCHEMA
from rockframe.studies import line_scan as lines
from rockframe.studies.conditional_sampling import (
    subset_bounds,
    subset_levels,
    subset_probability,
    subset_variation,
)
from rockframe.studies.limit_states import LimitState, demands, exceeds, limit_states

SYSTEM = rf.System(rf.Block(width="0.5 m", height="2 m", mass="400 kg"))
PULSE = rf.GroundMotion.sine_pulse("2.8 m/s^2", "1.5 Hz")
MOTIONS = {"strong": PULSE, "slow": rf.GroundMotion.sine_pulse("2.5 m/s^2", "1.2 Hz")}
SPREAD = {"width": ("normal", "0.5 m", "2 cm"), "scale": ("lognormal", 0.8, 0.15)}
FAST = {"accuracy": "fast", "free_vibration": "4 s", "progress": False}


def simulated(**options):
    return rf.subset_simulation(SYSTEM, **{"motions": PULSE, "spread": SPREAD, **FAST, **options})


@pytest.fixture(scope="module")
def found():
    return simulated(cases=300, seed=5, motions=MOTIONS, correlation={("width", "scale"): 0.3})


def test_subset_simulation_dataset_is_labelled_and_described(found, tmp_path):
    for name, one in found.variables.items():
        assert one.attrs.get("long_name"), name
        if name in SCHEMA and SCHEMA[name].unit is not None:
            assert "units" in one.attrs, name
    assert found.width.attrs["units"] == "m"
    found.to_netcdf(tmp_path / "found.nc")
    with xr.open_dataset(tmp_path / "found.nc") as again:
        xr.testing.assert_identical(again.load().drop_attrs(), found.drop_attrs())
    assert found.sizes["sampling_level"] > 2
    assert found.attrs["limit_state"] == "overturning"
    assert "Au and Beck (2001)" in found.attrs["references"]
    assert f"{found.exceedance_probability.item():.2e}" in found.verdict
    assert (
        f"{found.run_count.item()} runs in {found.sizes['sampling_level']} levels" in found.verdict
    )
    assert "under these 2 motions" in found.verdict
    assert found.left_out_count.item() == 0


def test_levels_and_samples_are_consistent(found):
    product = float(found.conditional_probability.prod())
    assert found.exceedance_probability.item() == pytest.approx(product, rel=1e-12)
    assert (np.diff(found.demand_threshold) > 0.0).all()
    assert np.isinf(found.demand_threshold.values[-1])
    assert np.isnan(found.acceptance_rate.values[0])
    drawn = found.isel(case=found.sample_level.values == 1)  # by the given distributions
    assert (drawn.motion == "slow").mean().item() == pytest.approx(0.5, abs=0.1)
    correlation = np.corrcoef(drawn.width, np.log(drawn.scale))[0, 1]
    assert correlation == pytest.approx(0.3, abs=0.1)
    assert ((found.acceptance_rate[1:] > 0.2) & (found.acceptance_rate[1:] < 0.8)).all()
    falls = np.isinf(found.demand)
    np.testing.assert_array_equal(falls, found.overturned)
    weight = float(found.sample_weight.where(falls, 0.0).sum())
    assert weight == pytest.approx(product, rel=1e-12)
    assert float(found.sample_weight.sum()) == pytest.approx(1.0, rel=1e-12)
    # all samples of a level have reached the threshold before, and its weights count below its own
    for level in found.sampling_level.values[1:]:
        inside = found.demand.values[found.sample_level.values == level]
        assert inside.min() >= found.demand_threshold.values[level - 2]
    # the first sample, and a candidate for each sample that does not begin a chain
    counts = np.bincount(found.sample_level)[1:]
    begun = found.chain_count.values[1:].sum()
    assert found.run_count.item() == counts.sum() - begun


def test_samples_can_be_reproduced_as_runs(found):
    for case in (0, found.sizes["case"] // 2, found.sizes["case"] - 1):
        alone = rf.case(found, case=case).simulate(outputs=None)
        assert alone.peak_rotation.item() == found.peak_rotation[case].item()


@pytest.mark.long
def test_same_seed_reproduces_the_result(found):
    options = {"cases": 300, "motions": MOTIONS, "correlation": {("width", "scale"): 0.3}}
    assert_identical(simulated(seed=5, chunk=17, **options), found)
    other = simulated(seed=8, **options)
    assert other.exceedance_probability.item() != found.exceedance_probability.item()


@pytest.mark.long
@pytest.mark.parametrize(
    ("limit", "scale"),
    [
        pytest.param("overturning", 1.0, marks=pytest.mark.long),
        (("peak_relative_rotation", 0.1), 0.8),
    ],
)
def test_probabilities_match_monte_carlo(limit, scale):
    options = {
        "motions": MOTIONS,
        "spread": {**SPREAD, "scale": ("lognormal", scale, 0.15)},
        "correlation": {("width", "scale"): 0.3},
    }
    plain = rf.probability_of_overturning(
        SYSTEM, cases=10_000, sampling="random", seed=1, **options, **FAST
    )
    (state, *_) = limit_states([limit], owner="here")
    count = int(exceeds(plain, state).sum())
    assert 15 < count < 300  # to 3e-2
    low, high = stats.binomtest(count, 10_000).proportion_ci(0.999, method="exact")
    held, every = 0, []
    for seed in range(4):
        one = simulated(cases=400, limit=limit, seed=seed, **options)
        ends = [float(one[f"exceedance_probability_{end}_bound"]) for end in ("lower", "upper")]
        held += ends[0] <= high
        held += ends[1] >= low
        every.append(float(one.exceedance_probability))
    assert held >= 7
    error = 4.0 * np.std(every, ddof=1) / np.sqrt(4)
    assert low - error < np.mean(every) < high + error


def test_demand_of_one_corresponds_to_exceedance():
    runs = rf.sweep(
        SYSTEM, MOTIONS, scale=np.linspace(0.6, 4.0, 40), points={"top": ("0 m", "2 m")}, **FAST
    )
    states = limit_states(
        [
            0.1,
            ("peak_relative_rotation", 0.5),
            ("peak_point_horizontal_acceleration", "4 m/s^2", "top"),
        ],
        owner="here",
    )
    for state in states:
        limit = np.inf if state == LimitState(1.0) else 1.0
        beyond = demands(runs, state) >= limit
        np.testing.assert_array_equal(beyond, exceeds(runs, state) == 1.0)
        assert 0 < int(beyond.sum()) < beyond.size


def test_a_limit_state_at_a_point():
    top = {
        "points": {"top": ("0 m", "2 m")},
        "limit": ("peak_point_horizontal_acceleration", "3 m/s^2", "top"),
    }
    found = simulated(cases=200, **top)
    fell = found.overturned.values == 1
    reached = found.peak_point_horizontal_acceleration.sel(point="top").values >= 3.0
    np.testing.assert_array_equal(found.demand >= 1.0, fell | reached)
    assert "Exceeds peak point horizontal acceleration top 3 m s^-2 with" in found.verdict


# ties --------------------------------------------------------------------------------------------


@pytest.mark.long
def test_samples_at_rest_share_one_level():
    """Most samples do not move, so that the first level has the share of those that do."""
    weak = rf.GroundMotion.sine_pulse("1.9 m/s^2", "1.2 Hz")
    spread = {"width": ("normal", "0.5 m", "2 cm"), "scale": ("lognormal", 0.8, 0.22)}
    found = simulated(motions=weak, spread=spread, cases=400)
    first = found.sample_level == 1
    moved = first & (found.demand > 0.0)
    assert 0 < int(moved.sum()) < 30
    assert found.conditional_probability[0].item() == int(moved.sum()) / 400
    assert found.chain_count[1].item() == int(moved.sum())


def test_samples_that_never_move_have_only_an_upper_bound():
    still = rf.GroundMotion.sine_pulse("0.5 m/s^2", "1 Hz")
    with pytest.warns(ModelWarning, match="all samples of the last demand 0, so that none leads"):
        found = simulated(motions=still, cases=100)
    assert found.exceedance_probability.item() == 0.0
    assert np.isinf(found.coefficient_of_variation)
    upper = stats.binomtest(0, 100).proportion_ci(0.95, method="exact").high
    assert found.exceedance_probability_upper_bound.item() == pytest.approx(upper, rel=1e-12)
    assert found.verdict.startswith("Overturns with a probability below 3.62e-02 with confidence")


def test_too_few_levels_give_only_an_upper_bound():
    with pytest.warns(ModelWarning, match=r"after 2 levels: the greatest demand is 0\.\d+; allow"):
        found = simulated(cases=60, levels=2, spread={"scale": ("lognormal", 0.9, 0.03)})
    assert found.exceedance_probability.item() == 0.0
    assert 0.1 < found.exceedance_probability_upper_bound.item() < 0.3


def steps(values):
    """Return levels of a demand that is a step function of one normal number."""
    return list(
        subset_levels(
            lambda _, scores: np.floor(values * scores[:, 0]) / values, 1, 3.0, count=2000,
            share=0.1, max_levels=12, rng=np.random.default_rng(3),
        )
    )  # fmt: skip


@pytest.mark.parametrize("values", [1.0, 2.0, 10.0])
def test_stepwise_demand_has_the_exact_probability(values):
    levels = steps(values)
    assert subset_probability(levels) == pytest.approx(
        stats.norm.sf(3.0), rel=4 * subset_variation(levels)
    )
    for one in levels[:-1]:
        assert not np.any(one.demands == one.threshold)


def test_samples_without_an_answer_are_left_out():
    def demand(_, scores):
        found = scores[:, 0].copy()
        found[scores[:, 1] > 0.0] = np.nan
        return found

    levels = list(
        subset_levels(
            demand, 2, 3.0, count=2000, share=0.1, max_levels=9, rng=np.random.default_rng(1)
        )
    )
    assert subset_probability(levels) == pytest.approx(
        stats.norm.sf(3.0), rel=4 * subset_variation(levels)
    )
    assert 900 < levels[0].left_out < 1100
    assert all(one.left_out > 0 for one in levels)
    assert not any(np.isnan(one.demands).any() for one in levels[1:])
    lower, upper = subset_bounds(levels, 0.999)
    assert lower < stats.norm.sf(3.0) < upper


@pytest.mark.filterwarnings("ignore::rockframe.errors.ModelWarning")  # of further rounds
def test_cases_that_cannot_be_assembled_are_counted():
    spread = {"height": ("normal", "2 m", "0.9 m"), "scale": ("lognormal", 1.0, 0.1)}
    with pytest.warns(SolverWarning, match="have no result"):
        found = simulated(spread=spread, cases=200, limit=0.9, levels=3)
    lost = int(found.demand.isnull().sum())
    assert 0 < lost <= found.left_out_count.item()
    assert f"{found.left_out_count.item()} without a verdict are left out" in found.verdict


# stores and interrupts ---------------------------------------------------------------------------


@pytest.mark.wide
def test_interrupted_subset_simulation_warns_and_resumes(tmp_path, monkeypatch):
    complete = simulated(cases=200)
    run = lines.run_study
    left = [14]

    def interrupted(*args, **kwargs):
        if not left[0]:
            raise KeyboardInterrupt
        left[0] -= 1
        return run(*args, **kwargs)

    with monkeypatch.context() as keys:
        keys.setattr(lines, "run_study", interrupted)
        with pytest.warns(SolverWarning, match="interrupted at level 3; the same call continues"):
            part = simulated(cases=200, store=tmp_path / "study")
        assert part.verdict.endswith("; interrupted.")
        assert np.isnan(part.exceedance_probability)
        assert part.sizes["sampling_level"] == 2
        assert part.exceedance_probability_lower_bound == 0.0
        bound = part.exceedance_probability_upper_bound.item()
        assert complete.exceedance_probability.item() < bound < 1.0
        with pytest.raises(StudyError, match=r"interrupted at level 1$"):
            simulated(cases=200)
    assert_identical(simulated(cases=200, store=tmp_path / "study"), complete)
    assert (tmp_path / "study" / "level 02 step 01").is_dir()


# refusals ---------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"limit": "uplift"}, r"limit 'uplift' is met or not, .* such as 0\.1"),
        ({"limit": ("peak_slip", None)}, "limit 'peak slip' is met or not"),
        ({"limit": ("peak_slip", "0 m")}, "limit 'peak slip 0 m' is met or not"),
        ({"limit": 1.5}, r"subset_simulation: limit must be above 0 and below 1, got '1\.5'"),
        ({"limit": [0.5, "overturning"]}, "limit must be one limit state"),
        ({"share": 0.7}, r"share must be from 0\.01 to 0\.5"),
        ({"cases": 40}, "share 0.1 of 40 cases are 4 chains; expected 5 at least: draw more"),
        ({"cases": 3}, "cases"),
        ({"levels": 0}, "levels"),
        ({"seed": -1}, "seed"),
        ({"confidence": 95}, "confidence"),
        ({"spread": {}}, "spread must give distributions by names"),
        ({"correlation": {("width", "height"): 0.2}}, "correlation needs pairs of two of width, s"),
    ],
)
def test_invalid_subset_simulation_arguments_are_refused(options, words):
    with pytest.raises(ComponentError, match=words):
        simulated(**options)


def test_missing_limit_variables_are_named():
    with pytest.raises(rf.errors.SchemaError, match="have no 'peak_point_horizontal_acceleration"):
        simulated(limit=("peak_point_horizontal_acceleration", "1 m/s^2"), cases=50)
    with pytest.raises(ComponentError, match=r"was 'peak_slip' or .* meant"):
        simulated(limit=("peak_slips", "1 m"))
    with pytest.raises(StudyError, match="girth"):
        simulated(spread={"girth": ("normal", 1.0, 0.1)})
