"""Maps, spectra, probabilities, ensembles, sequences: labels, single runs, files."""

import numpy as np
import pytest
import xarray as xr
from scipy import stats
from unit.studies.small_analyses import (
    BLOCK,
    FAST,
    QUIET,
    SYSTEM,
    assert_valid_file,
    complete_analysis,
    motions,
)

import rockframe as rf
from rockframe.errors import ComponentError, SchemaError, SolverWarning, StudyError, UnitsError
from rockframe.studies.probability import rank_parameters


@pytest.fixture
def analysis():
    return complete_analysis()


# maps and spectra ----------------------------------------------------------------------------


def test_overturning_map_has_labels_and_reproduces_its_cases(tmp_path):
    pulse = rf.GroundMotion.sine_pulse("-3 m/s^2", "2 Hz")
    options = {"amplitude": ([3, 6, 12], "m/s^2"), "frequency": (["1 Hz", "2 Hz"]), **FAST}
    found = rf.overturning_map(SYSTEM, pulse, **options)
    assert assert_valid_file(found, tmp_path)
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


def test_overturning_map_takes_a_pulse_of_a_period():
    options = {"amplitude": ([3, 6], "m/s^2"), "frequency": (["1 Hz", "3 Hz"]), **FAST}
    ricker = rf.GroundMotion.ricker_wavelet
    found = rf.overturning_map(SYSTEM, ricker("1 m/s^2", "7 s", antisymmetric=True), **options)
    expected = rf.overturning_map(
        SYSTEM, lambda a, f: ricker(a, 1 / f, antisymmetric=True), **options
    )
    assert np.array_equal(found.peak_rotation.values, expected.peak_rotation.values)
    assert not np.array_equal(found.peak_rotation[:, 0], found.peak_rotation[:, 1])


def test_rocking_spectrum_equals_single_runs_of_resized_blocks(tmp_path):
    found = rf.rocking_spectrum(
        SYSTEM, motions(), periods=([2.0, 3.0], "s"), slenderness=[3, 5], **FAST
    )
    assert assert_valid_file(found, tmp_path)
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
def test_bodies_defined_by_inertia_are_resized_at_constant_shape_factor(name):
    body = BODIES[name]
    motion = motions()["seed 1"]
    system = rf.System(body, gravity="9.7 m/s^2", inclination="0.5 deg", rotation="small")
    sizes = {"periods": ([2.0, 3.0], "s"), "slenderness": [3, 5]}
    found = rf.rocking_spectrum(system, {"seed 1": motion}, **sizes, **FAST)
    for period in (2.0, 3.0):
        case = rf.case(found, slenderness=5.0, rocking_period=period, motion="seed 1")
        block = case.system.parts.block_si
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


@pytest.mark.long
def test_an_overturning_spectrum_is_a_dynamic_analysis_of_each_block():
    scales, suite = [0.5, 1.0, 2.0, 4.0, 8.0], dict([*motions().items()][:2])
    found = rf.overturning_spectrum(SYSTEM, suite, periods=(["2 s", "4 s"]), scale=scales, **FAST)
    for place in range(2):
        sizes = found.isel(slenderness=0, rocking_period=place)
        width, height = (f"{sizes[name].item()!r} m" for name in ("width", "height"))
        system = rf.System(BLOCK.replace(width=width, height=height))
        dynamic = rf.incremental_dynamic_analysis(system, suite, scale=scales, **FAST)
        assert np.array_equal(sizes.capacity_scale, dynamic.capacity_scale[0], equal_nan=True)
    pga = [motion.peak_acceleration.m_as("m/s^2") for motion in suite.values()]
    assert found.capacity_intensity.units == "m s^-2"
    xr.testing.assert_allclose(
        found.capacity_intensity, found.capacity_scale * xr.DataArray(pga, dims="motion")
    )


# probability ---------------------------------------------------------------------------------


def test_overturning_probability_equals_share_of_single_runs(tmp_path):
    pulse = rf.GroundMotion.sine_pulse("4 m/s^2", "1.5 Hz")
    spread = {"width": ("normal", "0.5 m", "5 cm"), "scale": ("lognormal", 1.0, 0.4)}
    found = rf.probability_of_overturning(SYSTEM, pulse, spread=spread, cases=120, seed=3, **FAST)
    assert assert_valid_file(found, tmp_path)
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


def test_sampling_methods_accept_scipy_and_named_distributions():
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


def test_all_faulty_spreads_are_reported_at_once():
    pulse = rf.GroundMotion.sine_pulse("4 m/s^2", "1.5 Hz")
    with pytest.raises(StudyError) as problem:
        rf.probability_of_overturning(
            SYSTEM, pulse,
            spread={"girth": ("normal", 1, 2), "width": ("normal", 1.0, 0.1),
                    "height": ("gamma", "1 m", "2 m"), "restraint": ("uniform", "centre", "x")},
        )  # fmt: skip
    assert len(problem.value.faults) == 4
    with pytest.raises(StudyError) as problem:
        rf.probability_of_overturning(
            SYSTEM, pulse,
            spread={"mass": ("normal", "400 kg", "0 kg"), "height": ("uniform", "2 m", "1.9 m"),
                    "scale": ("lognormal", -1.0, 0.2)},
        )  # fmt: skip
    needs = [fault.partition(" needs a ")[2].partition(",")[0] for fault in problem.value.faults]
    assert needs == ["standard deviation above zero", "greatest above the least",
                     "median above zero"]  # fmt: skip
    with pytest.raises(ComponentError, match="distributions by names"):
        rf.probability_of_overturning(SYSTEM, pulse, spread={})


def test_a_distribution_in_another_unit_is_refused():
    pulse = rf.GroundMotion.sine_pulse("4 m/s^2", "1.5 Hz")
    spread = {"scale": (stats.uniform(50, 100), "%"), "width": (stats.uniform(40, 20), "cm")}
    with pytest.raises(StudyError, match="scale needs a distribution of pure ratios, got one in %"):
        rf.probability_of_overturning(SYSTEM, pulse, spread=spread)
    with pytest.raises(StudyError, match="width needs a distribution in m, got one in cm"):
        rf.probability_of_overturning(SYSTEM, pulse, spread=spread)


def test_parameter_ranking_equals_first_order_sobol_indices():
    """Y = [a + 0.5 b > 0] of normal a, b: the first-order indices by integration."""
    rng = np.random.default_rng(8)
    a, b, c = rng.normal(size=(3, 40_000))
    verdict = (a + 0.5 * b > 0.0).astype(float)
    found = rank_parameters(
        {"c": c, "b": b, "a": a, "word": rng.choice(["x", "y"], 40_000)}, verdict
    )
    assert list(found)[:2] == ["a", "b"]
    grid = np.linspace(-8.0, 8.0, 20_001)
    for name, own, other in (("a", 1.0, 0.5), ("b", 0.5, 1.0)):
        share = stats.norm.cdf(own * grid / other)
        weight = stats.norm.pdf(grid)
        variance = np.trapezoid((share - 0.5) ** 2 * weight, grid)
        assert found[name].first_order == pytest.approx(variance / 0.25, abs=0.02)
    assert found["c"].first_order < 0.003
    assert found["a"].p_value < 1e-100
    assert found["c"].p_value > 1e-4
    expected = stats.ks_2samp(a[verdict == 1.0], a[verdict == 0.0]).statistic
    assert found["a"].distribution_distance == expected
    assert np.isnan(rank_parameters({"a": a}, np.ones(40_000))["a"].first_order)


# ensembles -----------------------------------------------------------------------------------


@pytest.mark.long
def test_ensemble_bands_have_nominal_coverage():
    rng = np.random.default_rng(4)
    held = {"pointwise": 0, "everywhere": 0, "quantile": 0}
    rounds, count = 400, 25
    for _ in range(rounds):
        found = rf.ensemble_statistics(
            xr.DataArray(rng.random(count), dims="motion", name="share"),
            quantiles=[0.5], confidence=0.9,
        )  # fmt: skip
        # the distribution function at a fixed value is a fixed number
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


def test_ensemble_statistics_have_units_of_their_variable(tmp_path):
    runs = rf.sweep(SYSTEM, motions(), scale=[1.0, 3.0], **FAST)
    found = rf.ensemble_statistics(runs, "peak_rotation", pooled=["scale"])
    assert assert_valid_file(found, tmp_path)
    assert found.ordered_value.units == found.quantile_value.units == "rad"
    assert found.ordered_value.values.tolist() == sorted(runs.peak_rotation.values.ravel())
    assert found.member_count.item() == 8
    with pytest.raises(SchemaError, match="expected one of"):
        rf.ensemble_statistics(runs, "height_of_fall")
    with pytest.raises(ComponentError, match="pooled names 'scael'; peak_rotation goes over"):
        rf.ensemble_statistics(runs, "peak_rotation", pooled=["scale", "scael"])
    with pytest.raises(ComponentError, match="no values"):
        rf.ensemble_statistics(xr.DataArray([np.nan], dims="motion", name="x"))


def test_study_figures_draw_their_dataset_and_refuse_others(analysis):
    figures = {
        "dynamic_analysis": analysis,
        "fragility": rf.fragility(analysis),
        "rocking_spectrum": rf.rocking_spectrum(
            SYSTEM, motions(), periods=(["2 s", "3 s"]), **FAST
        ),
        "ensemble": rf.ensemble_statistics(analysis.isel(scale=-1)),
    }
    for name, dataset in figures.items():
        figure = getattr(rf.plot, name)(dataset).figure
        figure.canvas.draw()
        with pytest.raises(SchemaError, match=f"rf.plot.{name} needs"):
            getattr(rf.plot, name)(xr.Dataset())
    with pytest.raises(SchemaError, match=r"rf\.plot\.fragility draws it"):
        rf.plot.ensemble(figures["fragility"])


# sequences -----------------------------------------------------------------------------------


def test_earthquake_sequence_equals_continued_runs(tmp_path):
    """Each earthquake starts where the one before ended, as a run continued from its dataset."""
    system = rf.System(BLOCK, rf.TwoSpringSupport(frequency_ratio=15, damping_ratio=0.1))
    one, two = list(motions().values())[:2]
    two = two.with_vertical(one.scaled(0.3))
    sequences = {"first": [one, two.scaled(0.9), one], "short": [two.scaled(4.0)]}
    found = rf.earthquake_sequences(system, sequences, pause="0.5 s", **QUIET)
    assert assert_valid_file(found, tmp_path)
    assert found.peak_rotation.dims == ("sequence", "earthquake")
    assert np.isnan(found.peak_rotation.sel(sequence="short").values[1:]).all()
    assert found.overturning_earthquake.values.tolist() == [0, 1]
    response = system.simulate(one, free_vibration="0.5 s", outputs=())
    peaks = [response.peak_rotation.item()]
    for motion in (two.scaled(0.9), one):
        response = system.simulate(motion, free_vibration="0.5 s", initial=response)
        peaks.append(max(peaks[-1], response.peak_rotation.item()))
    assert found.peak_rotation.sel(sequence="first").values == pytest.approx(peaks, rel=1e-4)


def test_sequence_without_a_verdict_does_not_count_as_standing():
    weak = motions()["seed 1"].scaled(0.1)
    steps = len(weak.acceleration) * 3 // 2  # enough for the first earthquake alone
    options = {"pause": "0.5 s", "accuracy": rf.Accuracy(substeps=1, max_steps=steps), **QUIET}
    sequences = {"both": [weak, weak], "one": [weak]}
    with pytest.warns(SolverWarning, match="1 of 3 cases have no result"):
        found = rf.earthquake_sequences(SYSTEM, sequences, **options)
    assert np.isnan(found.overturning_earthquake.sel(sequence="both"))
    assert found.overturning_earthquake.sel(sequence="one") == 0
    assert found.verdict == "Of all 2 sequences 0 overturned; 1 has no verdict."


@pytest.mark.parametrize("step", ["0.02 s", "0.004 s", "0.0125 s"])
@pytest.mark.parametrize("first", [0, 1])
def test_sequence_of_unlike_time_steps_equals_continued_runs(step, first):
    """Each earthquake is the same function of time as in a single run."""
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


def test_gaps_are_refined_when_only_a_lower_body_moves():
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


def test_rocking_spectrum_resizes_block_but_not_its_wall():
    block = rf.Block(width="0.8 m", height="3.2 m", mass="5.5 t")
    wall, pulse = rf.RearWall(side="left"), rf.GroundMotion.sine_pulse("-4 m/s^2", "1 Hz")
    found = rf.rocking_spectrum(rf.System(block, wall), pulse, periods=["4 s"], accuracy="fast")
    width, height = (float(found[name].item()) for name in ("width", "Block.height"))
    alone = rf.System(block.replace(width=f"{width!r} m", height=f"{height!r} m"), wall)
    expected = alone.simulate(pulse, accuracy="fast", outputs=None).peak_rotation.item()
    assert found.peak_rotation.item() == pytest.approx(expected, rel=1e-9)
    again = rf.case(found, slenderness=4.0, rocking_period=4.0).system.parts.block
    assert again.si.height == pytest.approx(height, rel=1e-12)


def test_rocking_spectrum_refuses_a_rocking_frame():
    frame = rf.RockingFrame(
        rf.Block(width="0.8 m", height="3.2 m", mass="5.5 t"), columns=2, beam_mass="1 t"
    )
    pulse = rf.GroundMotion.sine_pulse("4 m/s^2", "1 Hz")
    with pytest.raises(rf.errors.ComponentError, match="got a RockingFrame"):
        rf.rocking_spectrum(rf.System(frame), pulse, periods=["4 s"])


def test_sequence_reports_its_pause_in_whole_time_steps():
    """Pauses are whole time steps, and of each sequence its own."""
    fine = rf.GroundMotion.from_arrays((np.zeros(50), "m/s^2"), "4 ms")
    coarse = rf.GroundMotion.from_arrays((np.zeros(50), "m/s^2"), "10 ms")
    sequences = {"coarse": [coarse, coarse], "fine": [fine, fine]}
    found = rf.earthquake_sequences(SYSTEM, sequences, pause="4 ms", **QUIET)
    assert found.pause.dims == ("sequence",)
    assert found.pause.attrs["units"] == "s"
    np.testing.assert_allclose(found.pause, [0.01, 0.004], rtol=1e-12)
    assert "pause" not in found.attrs


@pytest.mark.parametrize(
    ("name", "arguments", "match"),
    [
        ("rocking_spectrum", {"scale": [2.0]}, "which rocking_spectrum runs as it is; scale the"),
        ("rocking_spectrum", {"PGA": ["2 m/s^2"]}, "which rocking_spectrum runs as it is"),
        ("overturning_spectrum", {"scale": [1, 2], "PGA": ["2 m/s^2"]}, "give scale alone"),
    ],
)
def test_axes_that_scale_the_motion_of_a_spectrum_are_refused_with_advice(name, arguments, match):
    system = rf.System(rf.Block(width="0.5 m", height="2 m", mass="400 kg"))
    pulse = rf.GroundMotion.sine_pulse("2 m/s^2", "1 Hz")
    with pytest.raises(StudyError, match=match):
        getattr(rf, name)(system, pulse, periods=["2 s"], **arguments)


@pytest.mark.parametrize(
    ("name", "arguments"),
    [
        ("rocking_spectrum", {"periods": ["2 m"]}),
        ("overturning_map", {"amplitude": (["0.5 m/s"]), "frequency": ["1 Hz"]}),
        ("incremental_dynamic_analysis", {"scale": ["1 m", "2 m"]}),
    ],
)
def test_a_value_with_another_unit_is_refused_by_the_analysis_that_was_called(name, arguments):
    system = rf.System(rf.Block(width="0.5 m", height="2 m", mass="400 kg"))
    pulse = rf.GroundMotion.sine_pulse("2 m/s^2", "1 Hz")
    with pytest.raises(UnitsError, match=f"^{name}: "):
        getattr(rf, name)(system, pulse, **arguments)
