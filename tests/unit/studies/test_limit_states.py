"""Limit states on variables of runs."""

import numpy as np
import pytest
import xarray as xr

import rockframe as rf
from rockframe.errors import ComponentError, SchemaError, UnitsError
from rockframe.studies.limit_states import demands, exceeds, limit_states

BLOCK = rf.Block(width="0.5 m", height="2 m", mass="400 kg")
SUITE = [rf.GroundMotion.stochastic(6.5, "10 km", seed=k) for k in range(6)]
OPTIONS = {"accuracy": "fast", "progress": False}
ROOF = ("peak_point_horizontal_acceleration", "6 m/s^2", "top")


@pytest.fixture(scope="module")
def runs():
    return rf.sweep(
        rf.System(BLOCK), SUITE, scale=[0.5, 1.0, 2.0, 3.0, 4.0],
        points={"foot": ("0 m", "0.1 m"), "top": ("0 m", "2 m")}, **OPTIONS,
    )  # fmt: skip


def test_limit_state_counts_runs_whose_variable_exceeds_it(runs):
    found = rf.fragility(runs, limits=[0.3, ROOF])
    name = "peak point horizontal acceleration top 6 m s^-2"
    assert found.limit_state.values.tolist() == ["rotation 0.3", name, "overturning"]
    assert np.isnan(found.rotation_limit.values).tolist() == [False, True, False]
    peaks = runs["peak_point_horizontal_acceleration"].sel(point="top")
    over = (abs(peaks) >= 6.0) | (runs.overturned == 1.0)
    assert 0 < int(over.sum()) < over.size
    counted = found.sel(limit_state=name)
    assert int(counted.stripe_exceedances.sum()) == int(over.sum())
    assert int(counted.trial_count) == over.size
    rotation = rf.fragility(runs, limits=[("peak_relative_rotation", 0.3)]).isel(limit_state=0)
    assert rotation.median_intensity == found.median_intensity[0]


def test_limit_states_retain_their_order(runs):
    found = rf.fragility(runs, limits=[ROOF, 0.5, "uplift", 0.2, 0.5])
    name = "peak point horizontal acceleration top 6 m s^-2"
    order = [name, "rotation 0.5", "uplift", "rotation 0.2", "overturning"]
    assert found.limit_state.values.tolist() == order


@pytest.mark.long
def test_dynamic_analysis_brackets_a_slip_limit_state():
    """A limit of slip is first exceeded between two runs."""
    slides = rf.System(BLOCK, rf.RigidGround(friction=0.1))
    found = rf.incremental_dynamic_analysis(
        slides, SUITE[:2], scale=[1.0, 2.0, 4.0], limits=[("peak_slip", "1 cm")], **OPTIONS
    )
    capacity = found.capacity_scale.isel(limit_state=0)
    assert found.limit_state.values[0] == "peak slip 0.01 m"
    assert np.isfinite(capacity).any()
    for name, least in zip(found.motion.values, capacity.values, strict=True):
        if np.isfinite(least):
            around = rf.sweep(slides, SUITE[:2], scale=[least * (1 - 2e-3), least], **OPTIONS)
            slips = around.peak_slip.sel(motion=name).values
            assert slips[0] < 0.01 <= slips[1]
    again = rf.fragility(found, trials="capacities")
    assert again.limit_state.values.tolist() == found.limit_state.values.tolist()
    one = rf.fragility(found.isel(limit_state=[0]))
    assert one.limit_state.values.tolist() == ["peak slip 0.01 m"]


def test_invalid_limit_states_are_refused(runs):
    for wrong, kind, match in (
        (("peak_slip", "5 cm"), SchemaError, "the runs have no 'peak_slip"),
        (("peak_slip", "5 kg"), UnitsError, "peak_slip needs a limit in a unit such as m"),
        (("peak_rotation", "-1 deg"), ComponentError, "peak_rotation must be zero or more"),
        (
            ("girth", 1),
            ComponentError,
            "is called 'girth'; a limit state is for example \\('peak_slip'",
        ),
        (ROOF[:2], ComponentError, "is of point; give one of 'foot', 'top'"),
        ((*ROOF[:2], "roof"), ComponentError, "got 'roof'"),
    ):
        with pytest.raises(kind, match=match):
            rf.fragility(runs, limits=[wrong])


def test_limits_that_agree_in_six_digits_are_refused(runs):
    for pair in (
        [0.1, 0.1000000001],
        [("peak_rotation", "1 mrad"), ("peak_rotation", "1.0000001 mrad")],
    ):
        with pytest.raises(ComponentError, match="two limit states are called"):
            rf.fragility(runs, limits=pair)
    again = [("peak_rotation", "1 mrad"), ("peak_rotation", "0.001 rad"), 0.3, 0.1 + 0.2]
    assert rf.fragility(runs, limits=again).sizes["limit_state"] == 3


def test_cases_without_a_result_are_omitted(runs):
    lacking = runs.assign(overturned=runs.overturned.astype(float)).copy(deep=True)
    for name in ("peak_relative_rotation", "peak_point_horizontal_acceleration"):
        lacking[name][{"motion": 0}] = np.nan
    lacking["overturned"][{"motion": 0}] = np.nan
    found = rf.fragility(lacking, limits=[ROOF]).isel(limit_state=0)
    assert int(found.left_out_count) == runs.sizes["scale"]
    assert isinstance(found, xr.Dataset)


# runs, fragilities and reports -------------------------------------------------------------------

ON_SOIL = rf.System(
    rf.Block(width="1 m", height="4 m", mass="10 t"),
    rf.WinklerSoil(stiffness="9 MPa", damping_ratio=0.2),
)
POINTS = {"base": ("0 m", "0 m"), "top": ("0 m", "4 m")}
LIMITS = {
    "residual settlement 0.001 m": ("residual_settlement", "1 mm"),
    # the drift of 1 % of the height
    "peak point horizontal displacement top 0.04 m": (
        "peak_point_horizontal_displacement", "4 cm", "top",
    ),
    "peak point vertical displacement base 0.01 m": (
        "peak_point_vertical_displacement", "1 cm", "base",
    ),
    "peak point horizontal acceleration top 6 m s^-2": ROOF,
}  # fmt: skip


def exceeding(runs, limit):
    """Count runs beyond a limit by hand."""
    name, value, *label = limit
    values = runs[name].sel(point=label[0]) if label else runs[name]
    unit, least = value.split()[1], float(value.split()[0])
    least *= {"mm": 1e-3, "cm": 1e-2, "m/s^2": 1.0}[unit]
    return int(((abs(values) >= least) | (runs.overturned == 1)).sum())


@pytest.mark.filterwarnings("ignore::rockframe.errors.ModelWarning")
def test_settlement_drift_and_acceleration_limits_reach_the_report(tmp_path):
    runs = rf.sweep(ON_SOIL, SUITE, scale=[1.0, 2.0, 4.0, 6.0, 8.0], points=POINTS, **OPTIONS)
    found = rf.fragility(runs, "PGA", limits=LIMITS.values())
    assert found.limit_state.values.tolist() == [*LIMITS, "overturning"]
    for name, limit in LIMITS.items():
        count = exceeding(runs, limit)
        assert int(found.sel(limit_state=name).stripe_exceedances.sum()) == count, name
    fitted = found.fragility_status.sel(limit_state=list(LIMITS)) == 0
    assert int(fitted.sum()) >= 3
    found.to_netcdf(tmp_path / "fragility.nc")
    from matplotlib import pyplot as plt

    axes = rf.plot.fragility(found, units={"acceleration": "g"})
    names = axes.get_legend_handles_labels()[1]
    assert all(any(text.startswith(name) for text in names) for name in LIMITS)
    plt.close(axes.figure)
    rf.report(found, tmp_path / "report.html")
    page = (tmp_path / "report.html").read_text(encoding="utf-8")
    for name, limit in LIMITS.items():
        assert name.split(" 0.")[0].split(" 6 ")[0] in page, limit


@pytest.mark.wide
def test_a_dynamic_analysis_narrows_limit_states_at_points():
    system, top = rf.System(BLOCK), {"top": ("0 m", "2 m")}
    drift = ("peak_point_horizontal_displacement", "4 cm", "top")
    found = rf.incremental_dynamic_analysis(
        system, SUITE[:2], scale=[1.0, 2.0, 4.0], limits=[ROOF, drift], points=top,
        outputs=["rotation"], output_step="0.05 s", **OPTIONS,
    )  # fmt: skip
    assert found.peak_point_horizontal_acceleration.dims == ("scale", "motion", "point")
    assert found.rotation.dims == ("scale", "motion", "time")
    narrowed = 0
    for state, (name, least) in enumerate(((ROOF[0], 6.0), (drift[0], 0.04))):
        for motion in found.motion.values:
            capacity = found.capacity_scale.isel(limit_state=state).sel(motion=motion).item()
            if not np.isfinite(capacity):
                continue
            around = rf.sweep(
                system, SUITE[:2], scale=[capacity * (1 - 2e-3), capacity], points=top, **OPTIONS
            )
            peaks = around[name].sel(motion=motion, point="top").values
            assert peaks[0] < least <= peaks[1]
            narrowed += 1
    assert narrowed >= 2
    curves = rf.fragility(found, trials="capacities")
    assert curves.sizes["limit_state"] == 3


def test_block_returning_from_beyond_overturning_exceeds_reached_limits():
    """The run has not overturned, but its peaks are known only up to the overturning angle."""
    walled = rf.System(BLOCK, rf.RearWall(side="left", restitution=-0.3))
    pulse = rf.GroundMotion.sine_pulse("-6 m/s^2", "1 Hz")
    found = rf.sweep(
        walled, pulse, scale=[1.0], overturning="continue", free_vibration="8 s",
        points={"top": ("0 m", "2 m")}, **OPTIONS,
    )  # fmt: skip
    assert (found.overturned == 1).all()
    assert found.verdict == "Of 1 case of the sweep 0 overturned and 1 did not."
    count = int(found.impact_count.item())
    for limit, exceeded in (
        (("impact_count", count), 1.0),
        (("impact_count", count + 1), 0.0),
        (("peak_rotation", "30 deg"), 0.0),
        (("peak_point_horizontal_acceleration", "1e6 m/s^2"), 1.0),
        (0.5, 1.0),
        ("overturning", 0.0),
    ):
        state = limit_states([limit], owner="one")[0]
        assert exceeds(found, state).item() == exceeded
        least = np.inf if limit == "overturning" else 1.0
        assert (demands(found, state).item() >= least) == bool(exceeded)


def test_converted_responses_are_read_in_their_unit():
    """As for a figure: limit states, levels and measures are read in the unit that they have."""
    motions = {f"seed {k}": rf.GroundMotion.stochastic(6.8, "8 km", seed=k) for k in range(4)}
    block = rf.Block(width="0.6 m", height="2 m", mass="400 kg")
    runs = rf.sweep(rf.System(block), motions, scale=[2, 4, 6], **OPTIONS)
    turned = runs.assign(
        peak_rotation=np.rad2deg(runs.peak_rotation).assign_attrs(units="deg"),
        peak_relative_rotation=(100 * runs.peak_relative_rotation).assign_attrs(units="percent"),
    )
    for ask in (
        lambda dataset: rf.fragility(dataset, "PGA", limits=[("peak_rotation", "5 deg"), 0.3]),
        lambda dataset: rf.fractile_curves(dataset, "PGA", "peak_rotation", levels=([2, 4], "deg")),
        lambda dataset: rf.fractile_curves(dataset, "PGA"),
        lambda dataset: rf.cloud_analysis(
            dataset.isel(scale=1), "PGA", response="peak_rotation", limits=["5 deg"]
        ),
        lambda dataset: rf.compare_intensities(dataset.isel(scale=1), ["PGA", "PGV"]),
    ):
        xr.testing.assert_allclose(ask(turned), ask(runs), rtol=1e-12)
    wrong = runs.assign(peak_rotation=runs.peak_rotation.assign_attrs(units="m"))
    with pytest.raises(UnitsError, match=r"^fragility: peak_rotation"):
        rf.fragility(wrong, "PGA", limits=[("peak_rotation", "5 deg")])


@pytest.mark.long
def test_converted_scales_give_the_same_capacities():
    """Scales of a dynamic analysis are multiples of the motion, whatever their unit."""
    motions = {f"seed {k}": rf.GroundMotion.stochastic(6.8, "8 km", seed=k) for k in range(4)}
    block = rf.Block(width="0.6 m", height="2 m", mass="400 kg")
    runs = rf.incremental_dynamic_analysis(rf.System(block), motions, scale=[2, 4, 6, 8], **OPTIONS)
    turned = runs.assign_coords(scale=("scale", 100 * runs.scale.values, {"units": "percent"}))
    for ask in (
        lambda dataset: rf.fragility(dataset, "PGA", trials="capacities").median_intensity,
        lambda dataset: rf.fractile_curves(dataset, "PGA").response_fractile,
        lambda dataset: rf.fractile_curves(dataset).response_fractile,
    ):
        xr.testing.assert_allclose(ask(turned), ask(runs), rtol=1e-12)


@pytest.mark.parametrize(
    ("analysis", "options", "words"),
    [
        (rf.cloud_analysis, {"response": ["peak_slip"]}, r"the runs have no \['peak_slip'\]"),
        (rf.fractile_curves, {"response": "motion"}, "the runs have no 'motion'"),
        (rf.cloud_analysis, {"label": np.arange(3)}, r"got '\[0 1 2\]'"),
        (rf.fractile_curves, {"intensity": "motion"}, "'motion' has no numbers"),
        (rf.fragility, {"intensity": "motion"}, "'motion' has no numbers"),
        (rf.ensemble_statistics, {"name": "motion"}, "'motion' has no numbers"),
    ],
)
def test_non_scalar_names_of_variables_are_refused(analysis, options, words) -> None:
    motions = [rf.GroundMotion.sine_pulse(f"{a} m/s^2", "1 Hz") for a in (3, 4, 5, 6)]
    system = rf.System(rf.Block(width="0.5 m", height="2 m", mass="400 kg"))
    runs = rf.sweep(system, motions, scale=[1.0], duration="1 s", progress=False)
    with pytest.raises((ComponentError, SchemaError), match=words):
        analysis(runs, **options)
