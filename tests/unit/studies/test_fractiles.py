"""Fractile curves: by hand, by the duality of ranks, and with motions that never overturn."""

import numpy as np
import pytest

import rockframe as rf
from rockframe.errors import ComponentError, SchemaError, StudyError
from rockframe.results.variables.runs import RunStatus

SCALES = np.array([0.5, 1.0, 1.5, 2.0, 2.5])
SYSTEM = rf.System(rf.Block(width="0.5 m", height="2 m", mass="400 kg"))


def synthetic_runs(rows, fell, names="abcdefghijk"):
    """Return runs with given peaks and verdicts, a row for each motion."""
    pulse = rf.GroundMotion.sine_pulse("1 m/s^2", "1 Hz")
    motions = {name: pulse.scaled(1.0 + 0.01 * k) for k, name in enumerate(names[: len(rows)])}
    runs = rf.sweep(SYSTEM, motions, scale=SCALES, accuracy="fast", progress=False)
    status = np.where(fell, RunStatus.OVERTURNED, RunStatus.COMPLETED).astype(np.int8)
    dims = ("motion", "scale")
    attributes = runs["status"].attrs
    return runs.assign(
        peak_relative_rotation=(dims, np.array(rows, dtype=float), {"units": "1"}),
        status=(dims, status, attributes),
        overturned=(dims, np.array(fell, dtype=bool)),
    )


def test_fractiles_of_three_motions_match_hand_calculation():
    rows = [[0.1, 0.2, 0.3, 0.4, 0.5], [0.2, 0.3, 0.6, 1.0, 1.0], [0.3, 0.5, 1.0, 0.8, 1.0]]
    fell = [[0, 0, 0, 0, 0], [0, 0, 0, 1, 1], [0, 0, 1, 0, 1]]
    runs = synthetic_runs(rows, np.array(fell, dtype=bool))
    curves = rf.fractile_curves(runs, fractiles=[0.3, 0.5, 0.9], levels=[0.15, 0.55, 0.7])
    at = curves.sel(scale=[1.0, 1.5, 2.0], method="nearest")
    # the third motion overturns at 1.5 and stands again at 2; the second overturns from 2 on
    np.testing.assert_allclose(
        at.response_fractile, [[0.2, 0.3, 0.4], [0.3, 0.6, 0.8], [0.5, np.inf, np.inf]], atol=1e-12
    )
    assert at.overturned_count.values.tolist() == [0, 1, 1]
    # up to its fall a response is that of the last run that stands
    before = curves.motion_response.sel(scale=1.25, method="nearest")
    np.testing.assert_allclose(before, [0.25, 0.45, 0.5], atol=1e-12)
    # level 0.15: 0.75, and the others at the least scale; 0.55: never, 1 + 0.5 * 0.25 / 0.3, 1.5
    middle = 1.0 + 0.5 * 0.25 / 0.3
    np.testing.assert_allclose(
        curves.intensity_fractile,
        [[0.5, middle, 1.5], [0.5, 1.5, 2.0], [0.75, np.inf, np.inf]], atol=1e-12,
    )  # fmt: skip
    assert curves.unreached_count.values.tolist() == [0, 1, 1]
    assert curves.attrs["response"] == "peak_relative_rotation"
    assert curves.attrs["verdict"] == (
        "Of 3 motions 2 overturned at some scale from 0.5 to 2.5, half of them at 2.5."
    )


def test_response_and_intensity_fractiles_of_rising_curves_are_inverse():
    """For n rising curves, the k-th response at an intensity is the (n - k + 1)-th intensity."""
    rng = np.random.default_rng(4)
    rows = np.cumsum(rng.uniform(0.02, 0.2, size=(11, len(SCALES))), axis=1)
    runs = synthetic_runs(rows, np.zeros(rows.shape, dtype=bool))
    shares = [0.16, 0.5, 0.84]  # 11 q is not an integer
    curves = rf.fractile_curves(runs, fractiles=shares)
    levels = np.linspace(rows.min(), rows.max(), curves.sizes["scale"] + 1)[1:]
    np.testing.assert_allclose(curves.response_level, levels, rtol=1e-12)
    for share, rest in zip(shares, reversed(shares), strict=True):
        response = curves.response_fractile.sel(quantile=share).values
        level = rf.fractile_curves(
            runs, fractiles=[rest], levels=np.unique(response[20:-20])
        ).intensity_fractile
        np.testing.assert_allclose(level.squeeze(), curves.scale.values[20:-20], rtol=1e-9)
    every = np.stack([np.interp(curves.scale, SCALES, row) for row in rows])
    np.testing.assert_allclose(curves.motion_response, every, rtol=1e-12)
    expected = np.quantile(every, shares, axis=0, method="inverted_cdf")
    np.testing.assert_allclose(curves.response_fractile, expected, rtol=1e-12)


def test_fractile_curves_overturn_within_analysis_brackets():
    motions = {
        f"seed {k}": rf.GroundMotion.stochastic(7.0, "5 km", seed=k, stress_drop="20 MPa")
        for k in range(5)
    }
    analysis = rf.incremental_dynamic_analysis(
        SYSTEM, motions, scale=np.arange(0.5, 4.1, 0.5), intensity="PGA", free_vibration="4 s",
        accuracy="fast", progress=False,
    )  # fmt: skip
    curves = rf.fractile_curves(analysis, "PGA", fractiles=[0.5], levels=[0.999])
    over = analysis.capacity_scale.isel(limit_state=-1) * analysis.peak_ground_acceleration.sel(
        scale=1.0
    )
    assert curves.intensity_fractile.item() == pytest.approx(np.sort(over)[2], rel=1e-3)
    for name in motions:
        one = analysis.sel(motion=name, limit_state="overturning")
        scale_one = float(one.peak_ground_acceleration.sel(scale=1.0))
        fallen = np.zeros(curves.sizes["peak_ground_acceleration"], dtype=bool)
        at = curves.peak_ground_acceleration.values / scale_one
        for above, falls in zip(one.scale_above.values, one.exceeds_above.values, strict=True):
            if not np.isnan(above):
                fallen[at >= above] = bool(falls)
        assert np.array_equal(np.isinf(curves.motion_response.sel(motion=name)), fallen)
    twice = rf.fractile_curves(analysis.isel(limit_state=-1), "PGA", fractiles=[0.5])
    assert np.array_equal(twice.overturned_count, curves.overturned_count)


@pytest.mark.parametrize(
    ("options", "error", "words"),
    [
        ({"fractiles": [1.0]}, ComponentError, "above 0 and below 1"),
        ({"levels": [0.4, 0.2]}, ComponentError, "levels must be one or more, and increase"),
        ({"response": "peak_slipp"}, SchemaError, "the runs have no 'peak_slipp'"),
        ({"intensity": "PGB"}, ComponentError, "intensity must be one of"),
    ],
)
def test_invalid_fractile_arguments_are_refused(options, error, words):
    runs = synthetic_runs([[0.1] * 5, [0.2] * 5], np.zeros((2, 5), dtype=bool))
    with pytest.raises(error, match=words):
        rf.fractile_curves(runs, **options)
    with pytest.raises(StudyError, match="expected motions, and one scale"):
        rf.fractile_curves(runs.isel(scale=0))


def test_fractile_curves_of_a_varied_system_drop_the_stored_system():
    system = rf.System(rf.Block(width="0.5 m", height="2 m", mass="400 kg"))
    pulses = {f"{k}": rf.GroundMotion.sine_pulse(f"{3 + k} m/s^2", "1 Hz") for k in range(3)}
    options = {"scale": [1.0, 1.5], "accuracy": "fast", "progress": False}
    assert "system_json" in rf.fractile_curves(rf.sweep(system, pulses, **options)).attrs
    runs = rf.sweep(system, pulses, width=["0.5 m", "0.6 m"], **options)
    assert "system_json" not in rf.fractile_curves(runs.isel(width=1)).attrs


def test_verdict_states_the_capacity_rather_than_the_next_grid_point():
    """The least intensity at which half of the motions overturn is the intensity of a run."""
    rows = [[0.1, 0.2, 0.3, 1.0, 1.0], [0.2, 0.3, 0.6, 1.0, 1.0], [0.1, 0.1, 0.1, 0.1, 0.1]]
    fell = np.array([[0, 0, 0, 1, 1], [0, 0, 0, 1, 1], [0, 0, 0, 0, 0]], dtype=bool)
    runs = synthetic_runs(rows, fell).assign_coords(scale=[0.5, 1.0, 1.5, 1.9991, 2.5])
    verdict = rf.fractile_curves(runs).attrs["verdict"]
    assert verdict.endswith(
        "Of 3 motions 2 overturned at some scale from 0.5 to 2.5, half of them at 1.999."
    )
    alone = rf.fractile_curves(runs.isel(motion=[0])).attrs["verdict"]
    assert alone == "Of 1 motion 1 overturned at some scale from 0.5 to 2.5, first at 1.999."


def test_overturning_between_curve_points_is_counted():
    """The gap is narrower than the spacing of the points of the curves."""
    runs = rf.incremental_dynamic_analysis(
        SYSTEM, rf.GroundMotion.sine_pulse("4 m/s^2", "1 Hz"), scale=[0.5, 1, 1.5, 2, 50],
        free_vibration="5 s", progress=False,
    )  # fmt: skip
    capacity = float(runs.capacity_scale.sel(limit_state="overturning").squeeze())
    assert f"first at {capacity:.4g}" in rf.fractile_curves(runs).attrs["verdict"]


def test_omitted_runs_are_reported():
    runs = synthetic_runs([[0.1, 0.2, 0.3, 0.4, 0.5]] * 2, np.zeros((2, 5), dtype=bool))
    total = rf.fractile_curves(runs).attrs["verdict"]
    status = runs["status"].copy()
    status[0, 2] = RunStatus.NOT_RUN
    verdict = rf.fractile_curves(runs.assign(status=status)).attrs["verdict"]
    assert verdict == f"{total} 1 of 10 runs is left out, without a verdict, intensity or response."
