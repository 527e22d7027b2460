"""Speed and accuracy: measured errors and times, recommendations."""

import importlib
import itertools
import json
import re

import numpy as np
import pytest
import xarray as xr
from matplotlib.backends.backend_agg import FigureCanvasAgg

import rockframe as rf
from rockframe.errors import ComponentError, ModelWarning, SchemaError, SolverError, UnitsError

BLOCK = rf.Block.from_size(radius="5 m", slenderness=4, mass="50 t")
PADS = rf.TwoSpringSupport(frequency_ratio=20, damping_ratio=0.10)
SYSTEM = rf.System(BLOCK, PADS)
PULSE = rf.GroundMotion.sine_pulse("-4 m/s^2", "1 Hz")
ACCURACIES = (1e-3, 1e-6, "standard", rf.Accuracy(rtol=1e-11, steps_per_period=40.0))


@pytest.fixture(scope="module")
def measured():
    return rf.tradeoff(SYSTEM, PULSE, accuracies=ACCURACIES, repeats=2, free_vibration="3 s")


def test_tradeoff_has_model_and_accuracy_axes(measured):
    assert measured.sizes == {"model": 4, "accuracy": 4}
    assert measured.model.values.tolist() == list(rf.model_ladder(SYSTEM))
    assert measured.accuracy.values.tolist() == [
        "rtol 0.001",
        "rtol 1e-06",
        "standard",
        "rtol 1e-11, steps_per_period 40.0",
    ]


def test_times_are_ordered_and_positive(measured):
    least, median, greatest = (
        measured[name].values for name in ("run_time_least", "run_time", "run_time_greatest")
    )
    assert (least > 0.0).all()
    assert (least <= median).all()
    assert (median <= greatest).all()


def test_outcomes_equal_single_runs(measured):
    run = SYSTEM.simulate(PULSE, free_vibration="3 s", accuracy="standard")
    cell = measured.sel(model="two pads", accuracy="standard")
    assert float(cell.peak_rotation) == float(run.peak_rotation)
    assert float(cell.energy_residual) == float(run.energy_residual)


def test_errors_fall_with_the_tolerance(measured):
    errors = measured.numerical_history_error.sel(model="two pads").values
    assert errors[0] >= errors[1] > errors[2] > 10.0 * errors[3]
    assert errors[3] < 1e-9


def test_errors_match_their_definitions(measured):
    reference = rf.Accuracy(rtol=1e-12)
    scene = SYSTEM.simulate(PULSE, free_vibration="3 s", accuracy=reference)
    rigid = rf.System(BLOCK).simulate(PULSE, free_vibration="3 s", accuracy="standard")
    cell = measured.sel(model="rigid ground", accuracy="standard")
    count = min(rigid.time.size, scene.time.size)
    difference = np.abs(rigid.rotation.values[:count] - scene.rotation.values[:count])
    peak = float(np.abs(scene.rotation).max())
    assert float(cell.history_error) == pytest.approx(difference.max() / peak, rel=1e-9)
    expected = abs(float(rigid.peak_rotation) - float(scene.peak_rotation))
    assert float(cell.peak_error) == pytest.approx(expected / float(scene.peak_rotation), rel=1e-9)
    assert bool(cell.verdict_agrees)


def test_numerical_errors_compare_with_the_same_model(measured):
    rigid = rf.System(BLOCK)
    reference, run = (
        rigid.simulate(PULSE, free_vibration="3 s", accuracy=rf.Accuracy(rtol=rtol))
        for rtol in (1e-12, 1e-3)
    )
    cell = measured.sel(model="rigid ground", accuracy="rtol 0.001")
    peak = float(reference.peak_rotation)
    off = abs(float(run.peak_rotation) - peak)
    assert float(cell.numerical_peak_error) == pytest.approx(off / peak, rel=1e-9)
    off = np.abs(run.rotation - reference.rotation).max() / np.abs(reference.rotation).max()
    assert float(cell.numerical_history_error) == pytest.approx(float(off), rel=1e-9)
    off = np.abs(run.event_time.values - reference.event_time.values).max()
    assert off > 0.0
    assert float(cell.event_time_error) == pytest.approx(off, rel=1e-9)


def test_attributes_describe_the_comparison(measured):
    assert measured.scene == "two pads"
    assert measured.benchmark_rtol == 1e-12
    assert measured.repeats == 2
    settings = json.loads(measured.settings)
    assert list(settings) == measured.accuracy.values.tolist()
    assert settings["rtol 1e-06"]["rtol"] == 1e-6
    assert settings["standard"]["rtol"] == rf.Accuracy(rtol=2e-8).rtol


def test_the_time_is_the_median_of_runs_without_histories(monkeypatch):
    module = importlib.import_module("rockframe.comparison.tradeoff")
    times, steps = iter([5.0, 1.0, 2.0]), []
    monkeypatch.setattr(
        module, "_time_of_run", lambda _, plan: steps.append(plan.output_step) or next(times)
    )
    comparison = rf.tradeoff(SYSTEM, PULSE, models=["two pads"], accuracies=["fast"], repeats=3)
    least, median, greatest = (
        comparison[name].item() for name in ("run_time_least", "run_time", "run_time_greatest")
    )
    assert (least, median, greatest) == (1.0, 2.0, 5.0)
    assert steps == [None] * 3


SINGLE = {"models": ["two pads"], "accuracies": [1e-4], "repeats": 1}


def test_explicit_motion_overrides_motion_of_the_system():
    other = PULSE.scaled(0.5)
    system = rf.System(BLOCK, PADS, other)
    own, explicit = rf.tradeoff(system, **SINGLE), rf.tradeoff(system, PULSE, **SINGLE)
    for comparison, motion in ((own, other), (explicit, PULSE)):
        run = SYSTEM.simulate(motion, accuracy=rf.Accuracy(rtol=1e-4))
        assert comparison.peak_rotation.item() == float(run.peak_rotation)
        assert comparison.motion_sha256 == motion.sha256


def test_start_duration_and_output_step_are_used():
    start = rf.InitialState(rotation="0.1 rad")
    arguments = {"duration": "2 s", "initial": start, "output_step": "0.3 s"}
    comparison = rf.tradeoff(SYSTEM, **SINGLE, **arguments)
    run, reference = (
        SYSTEM.simulate(**arguments, accuracy=rf.Accuracy(rtol=rtol)) for rtol in (1e-4, 1e-12)
    )
    assert run.time.size == 7
    assert comparison.energy_residual.item() == float(run.energy_residual)
    off = np.abs(run.rotation - reference.rotation).max() / np.abs(reference.rotation).max()
    assert comparison.history_error.item() == pytest.approx(float(off), rel=1e-9)


def test_runs_that_overturn_end_there():
    comparison = rf.tradeoff(SYSTEM, PULSE.scaled(8.0), **SINGLE, free_vibration="3 s")
    assert bool(comparison.overturned.item())
    assert comparison.peak_rotation.item() == pytest.approx(BLOCK.si.overturning_angle, rel=1e-6)


def test_models_retain_requested_order():
    names = ["two pads", "rigid ground"]
    comparison = rf.tradeoff(SYSTEM, PULSE, models=names, accuracies=["fast"], repeats=1)
    assert comparison.model.values.tolist() == names


def test_rungs_do_not_emit_model_warnings():
    """The ground would have to pull at a block without pads."""
    motion = PULSE.with_vertical(PULSE.scaled(peak="1.2 g_0"))
    with pytest.warns(ModelWarning):
        rf.System(BLOCK).simulate(motion)
    rf.tradeoff(SYSTEM, motion, models=["rigid ground"], accuracies=["fast"], repeats=1)


def test_the_scene_has_no_error_of_the_model(measured):
    top = measured.sel(model="two pads")
    np.testing.assert_array_equal(top.peak_error, top.numerical_peak_error)
    assert (measured.peak_error.sel(model="rigid ground") > 1e-3).all()


def test_tradeoff_survives_netcdf_round_trip(measured, tmp_path):
    measured.to_netcdf(tmp_path / "ladder.nc")
    with xr.open_dataset(tmp_path / "ladder.nc") as stored:
        xr.testing.assert_identical(stored, measured)


def test_overturning_mismatch_is_reported():
    """The block overturns on pads only, or on rigid ground only."""
    for amplitude in np.arange(4.0, 12.0, 0.25):
        motion = rf.GroundMotion.sine_pulse(f"{-amplitude} m/s^2", "1 Hz")
        fell = [
            bool(system.simulate(motion, free_vibration="3 s", outputs=None).overturned)
            for system in (SYSTEM, rf.System(BLOCK))
        ]
        if fell[0] != fell[1]:
            break
    comparison = rf.tradeoff(
        SYSTEM,
        motion,
        models=["rigid ground", "two pads"],
        accuracies=["standard"],
        repeats=1,
        free_vibration="3 s",
    )
    assert comparison.verdict_agrees.values.tolist() == [[False], [True]]
    assert rf.recommend(comparison, 1.0).model == "two pads"


def comparison_of(times, errors, agrees=True):
    """Build a comparison from times and errors of two models and two accuracies."""
    dims = ("model", "accuracy")
    return xr.Dataset(
        {
            "run_time": (dims, np.array(times)),
            "peak_error": (dims, np.array(errors)),
            "verdict_agrees": (dims, np.broadcast_to(agrees, (2, 2))),
        },
        {"model": ["rigid", "pads"], "accuracy": ["fast", "standard"]},
    )


TIMES, ERRORS = [[1e-3, 2e-3], [3e-3, 8e-3]], [[0.2, 0.1], [0.03, 1e-6]]


@pytest.mark.parametrize(
    ("tolerance", "rung", "met"),
    [
        (0.5, ("rigid", "fast"), True),
        (0.15, ("rigid", "standard"), True),
        (0.05, ("pads", "fast"), True),
        (1e-3, ("pads", "standard"), True),
        (1e-9, ("pads", "standard"), False),
    ],
)
def test_cheapest_rung_within_tolerance_is_recommended(tolerance, rung, met):
    advice = rf.recommend(comparison_of(TIMES, ERRORS), tolerance)
    assert (advice.model, advice.accuracy) == rung
    assert advice.met == met
    assert str(advice).count(".") >= 1
    assert ("No rung tried" in str(advice)) == (not met)


def test_recommendation_accepts_subsets_and_transposed_dimensions(measured):
    best = rf.recommend(measured, 0.01)
    assert rf.recommend(measured.transpose("accuracy", "model"), 0.01) == best
    chosen = measured.sel(accuracy=best.accuracy)
    assert rf.recommend(chosen, 0.01).model == best.model
    assert rf.recommend(chosen.sel(model=best.model), 0.01).met


def test_an_error_as_large_as_the_tolerance_meets_it():
    assert rf.recommend(comparison_of(TIMES, ERRORS), 0.1).accuracy == "standard"


def test_default_tolerance_is_one_percent():
    advice = rf.recommend(comparison_of(TIMES, ERRORS))
    assert (advice.model, advice.accuracy) == ("pads", "standard")


def test_recommendation_uses_the_requested_error():
    comparison = comparison_of(TIMES, ERRORS).assign(
        history_error=(("model", "accuracy"), ERRORS[::-1])
    )
    advice = rf.recommend(comparison, 0.05, error="history_error")
    assert (advice.model, advice.accuracy) == ("rigid", "fast")
    assert "off by 3 % in the rotation along time" in str(advice)


def test_recommendation_sentence():
    assert str(rf.recommend(comparison_of(TIMES, ERRORS), 0.05)) == (
        "For an error of at most 5 %, take 'pads' at accuracy 'fast': off by 3 % in the "
        "peak rotation, 3 ms a run, 2.67 times faster than the slowest rung."
    )


def test_recommendation_for_overturned_runs_suggests_history_error():
    overturned = comparison_of(TIMES, ERRORS)
    overturned = overturned.assign(overturned=xr.ones_like(overturned.peak_error, bool))
    hint = "error='history_error' compares them along time."
    assert str(rf.recommend(overturned, 0.05)).endswith(hint)
    history_based = overturned.assign(history_error=overturned.peak_error)
    assert hint not in str(rf.recommend(history_based, 0.05, error="history_error"))
    assert hint not in str(rf.recommend(overturned.assign(overturned=~overturned.overturned), 0.05))


@pytest.mark.parametrize(
    ("tolerance", "error", "words"),
    [
        (0.05, 2.6e-7, "at most 5 %, take 'pads' at accuracy 'fast': off by 2.6e-7 of the peak in"),
        (1e-4, 1e-4, "at most 0.01 %, take 'pads' at accuracy 'fast': off by 0.01 % in"),
        (2e-6, 1e-15, "at most 2e-6 of the peak, take 'pads' at accuracy 'fast': off by 1e-15 of"),
        (0.125, 0.0, "at most 12.5 %, take 'pads' at accuracy 'fast': off by 0 % in"),
        (0.999, 0.996, "at most 99.9 %, take 'pads' at accuracy 'fast': off by 100 % in"),
        (0.05, 4.96, "comes within 5 %; the nearest is 'pads' at accuracy 'fast': off by 496 % in"),
    ],
)
def test_no_percentage_has_an_exponent(tolerance, error, words):
    advice = str(
        rf.recommend(comparison_of([[8.0, 8.0], [1.2345, 8e3]], [[9, 9], [error, 9]]), tolerance)
    )
    assert words in advice
    assert not re.search(r"\de[-+]?\d+ %", advice)
    if "at most" in words:
        assert advice.endswith("rotation, 1234 ms a run, 6480 times faster than the slowest rung.")


@pytest.mark.parametrize(
    ("tolerance", "hint"),
    [
        (5, "got 5; for 5 % write 0.05"),
        (2.5, "got 2.5; for 2.5 % write 0.025"),
        ("500 %", "got '500 %'; for 5 % write 0.05"),
    ],
)
def test_tolerance_above_one_is_refused_with_a_hint(tolerance, hint):
    with pytest.raises(ComponentError, match=f"tolerance must be at most 1, .*{re.escape(hint)}"):
        rf.recommend(comparison_of(TIMES, ERRORS), tolerance)
    assert rf.recommend(comparison_of(TIMES, ERRORS), 1.0).met
    assert rf.recommend(comparison_of(TIMES, ERRORS), "5 %").sentence.startswith(
        "For an error of at most 5 %"
    )


def test_rungs_with_a_wrong_verdict_are_not_recommended():
    agrees = np.array([[False, True], [True, True]])
    assert rf.recommend(comparison_of(TIMES, ERRORS, agrees), 0.5).accuracy == "standard"
    unmet = rf.recommend(comparison_of(TIMES, ERRORS, agrees=False), 0.5)
    assert not unmet.met
    assert str(unmet) == "No rung tried has the verdict of the scene itself."


def test_the_only_rung_is_not_faster_than_itself():
    alone = comparison_of(TIMES, ERRORS).isel(model=[1], accuracy=[0])
    assert str(rf.recommend(alone, 0.05)).endswith("in the peak rotation, 3 ms a run.")


def test_runs_without_a_verdict_are_not_said_to_differ_from_the_scene():
    unknown = comparison_of(TIMES, np.full((2, 2), np.nan), agrees=False)
    advice = rf.recommend(unknown, 0.5)
    assert not advice.met
    assert str(advice).endswith("the scene itself or all rungs ended before their verdict.")


@pytest.mark.parametrize(
    ("arguments", "error", "words"),
    [
        ({"tolerance": 0.0}, ComponentError, "tolerance must be greater than zero"),
        ({"tolerance": "1 m"}, UnitsError, "tolerance needs a pure ratio"),
        ({"error": "colour"}, SchemaError, "'peak_error' or 'history_error'"),
        ({"error": "history_error"}, SchemaError, "expected one of tradeoff"),
        ({"dataset": "found.nc"}, SchemaError, "found 'found.nc'; expected a comparison of models"),
    ],
)
def test_invalid_recommendation_arguments_are_refused(arguments, error, words):
    with pytest.raises(error, match=words):
        rf.recommend(**{"dataset": comparison_of(TIMES, ERRORS), **arguments})


@pytest.mark.parametrize(
    ("arguments", "error", "words"),
    [
        ({"repeats": 0}, ComponentError, "repeats must be a whole number from 1"),
        ({"repeats": True}, ComponentError, "repeats must be a whole number from 1"),
        ({"models": ["soil"]}, ComponentError, "models must be some of 'rigid ground, small"),
        ({"models": []}, ComponentError, "models must be some of"),
        ({"accuracies": ["quick"]}, SolverError, "accuracy must be one of"),
        ({"accuracies": [2.0]}, SolverError, "rtol must lie from"),
    ],
)
def test_invalid_tradeoff_arguments_are_refused(arguments, error, words):
    with pytest.raises(error, match=words):
        rf.tradeoff(SYSTEM, PULSE, **arguments)


@pytest.mark.parametrize("function", [rf.tradeoff, rf.model_ladder])
def test_only_systems_are_accepted(function):
    with pytest.raises(ComponentError, match=f"{function.__name__}: system needs a System, got Bl"):
        function(BLOCK)


def test_single_model_and_accuracy_are_accepted_as_scalars():
    measured = rf.tradeoff(SYSTEM, PULSE, models="two pads", accuracies=1e-6, repeats=1)
    assert measured.model.values.tolist() == ["two pads"]
    assert measured.accuracy.values.tolist() == ["rtol 1e-06"]


def test_nearly_equal_tolerances_are_distinct():
    near = (1e-6, np.float64(1.0000001e-6))
    measured = rf.tradeoff(SYSTEM, PULSE, models="two pads", accuracies=near, repeats=1)
    assert measured.accuracy.values.tolist() == ["rtol 1e-06", "rtol 1.0000001e-06"]


def test_unfinished_rungs_are_not_recommended():
    short = rf.Accuracy(rtol=1e-3, max_steps=60)
    measured = rf.tradeoff(
        SYSTEM,
        PULSE,
        models=["two pads"],
        accuracies=(short, "standard"),
        repeats=1,
        free_vibration="3 s",
    )
    cells = [measured.isel(model=0, accuracy=i) for i in (0, 1)]
    assert [int(cell.status) for cell in cells] == [3, 0]
    assert [bool(cell.verdict_agrees) for cell in cells] == [False, True]
    for name in ("peak_error", "history_error", "numerical_peak_error", "event_time_error"):
        assert np.isnan(cells[0][name])
        assert np.isfinite(cells[1][name])
    for error in ("peak_error", "history_error"):
        assert rf.recommend(measured, 0.5, error=error).accuracy == "standard"


def test_tradeoff_figure_labels_models_and_axes(measured):
    figure = rf.plot.tradeoff(measured).figure
    FigureCanvasAgg(figure).draw()
    left, right = figure.axes
    names = right.get_yticklabels()
    assert [text.get_text() for text in names] == list(rf.model_ladder(SYSTEM))
    assert {text.get_color() for text in names} == {"black"}
    assert len(left.lines) >= 4 * 4
    assert "low and left is better" in left.get_title()
    assert "left is better" in right.get_title()


def test_times_over_many_decades_have_labels_that_do_not_overlap(measured):
    times = np.geomspace(4e-4, 2.5, measured.run_time.size).reshape(measured.run_time.shape)
    axes = rf.plot.tradeoff(measured.assign(run_time=measured.run_time.copy(data=times)))[0]
    FigureCanvasAgg(axes.figure).draw()
    low, high = axes.get_xlim()
    labels = [label for label in axes.get_xticklabels() if low <= label.get_position()[0] <= high]
    boxes = [label.get_window_extent() for label in labels]
    assert len(boxes) >= 3
    assert all(left.x1 < right.x0 for left, right in itertools.pairwise(boxes))


def legend(figure):
    return [text.get_text() for text in figure.legends[0].get_texts()]


def test_legend_explains_hollow_markers(measured):
    figure = rf.plot.tradeoff(measured).figure
    assert legend(figure)[-2:] == ["hollow: small rotations", "other verdict"]
    key = figure.legends[0].get_lines()[-2]
    assert key.get_markerfacecolor() == "white"
    finite = rf.plot.tradeoff(measured.sel(model=["rigid ground", "two pads"])).figure
    assert legend(finite) == [*measured.accuracy.values, "other verdict"]


def markers(axes):
    """Places of all markers, in pixels."""
    FigureCanvasAgg(axes.figure).draw()
    places = [line.get_xydata()[0] for line in axes.lines if line.get_marker() not in ("None", "x")]
    return axes.transData.transform(places)


def test_small_errors_of_models_share_a_band(measured):
    error = np.add.outer([0.3, 0.1, 0.05, 0.0], [1e-3, 1e-7, 1e-10, 0.0])
    compared = measured.assign(history_error=(("model", "accuracy"), error))
    figure = rf.plot.tradeoff(compared).figure
    figure.canvas.draw()
    right = figure.axes[1]
    spots = markers(right)
    assert len(spots) == 16
    box = right.get_window_extent()
    assert (box.x0 < spots[:, 0]).all()
    assert (spots[:, 0] < box.x1).all()
    for spot in spots:  # markers do not overlap
        assert np.sort(np.hypot(*(spots - spot).T))[1] > 5.0
    labels = {text.get_text(): tick for tick, text in zip(
        right.get_xticks(), right.get_xticklabels(), strict=True)}  # fmt: skip
    edge = right.transData.transform((1e-6, 0.0))[0]
    assert (spots[:, 0] < edge).sum() == 3
    assert labels["below"] < 1e-6
    assert min(tick for text, tick in labels.items() if text != "below") == pytest.approx(1e-6)


def test_there_is_no_band_where_no_error_is_small(measured):
    figure = rf.plot.tradeoff(measured.assign(history_error=measured.history_error + 2e-3)).figure
    texts = [text.get_text() for text in figure.axes[1].get_xticklabels()]
    assert "below" not in texts
    assert figure.axes[1].get_xlim()[0] == 1e-6


@pytest.mark.parametrize("rungs", [{"model": [3], "accuracy": [0]}, {"model": slice(None)}])
def test_nothing_is_drawn_beyond_the_figure(measured, rungs):
    figure = rf.plot.tradeoff(measured.isel(rungs)).figure
    FigureCanvasAgg(figure).draw()
    for box in (
        *(axes.get_tightbbox() for axes in figure.axes),
        figure.legends[0].get_window_extent(),
    ):
        assert box.x0 >= 0.0
        assert box.y0 >= 0.0
        assert box.x1 <= figure.bbox.width
        assert box.y1 <= figure.bbox.height


def test_rung_is_timed_only_after_compilation(monkeypatch):
    module = importlib.import_module("rockframe.comparison.tradeoff")
    compiled = iter((False, False, True))
    done = []

    def compute_untimed(*arguments):
        done.append("untimed")
        return compute_response(*arguments)

    def timed(*_):
        done.append("timed")
        return 1.0

    compute_response = module.compute_response
    monkeypatch.setattr(module, "is_fully_compiled", lambda _: next(compiled))
    monkeypatch.setattr(module, "runs_as_python", lambda _: False)
    monkeypatch.setattr(module, "compute_response", compute_untimed)
    monkeypatch.setattr(module, "_time_of_run", timed)
    rf.tradeoff(SYSTEM, PULSE, models="two pads", accuracies="standard", repeats=1, duration="1 s")
    assert done == ["untimed", "untimed", "timed"]


def test_model_without_sliding_has_the_slip_as_error():
    floor = rf.RigidGround(friction=0.2, kinetic_friction=0.15)
    system = rf.System(rf.Block(width="0.8 m", height="3.2 m", mass="5.5 t"), floor)
    pulse = rf.GroundMotion.sine_pulse("2.3 m/s^2", "1 Hz")  # slides before it rocks
    comparison = rf.tradeoff(system, pulse, accuracies="standard", repeats=1)
    assert (comparison.peak_rotation == 0.0).all()
    assert comparison.peak_error.values.ravel() == pytest.approx([1.0, 1.0, 0.0], abs=1e-6)
    slip = float(system.simulate(pulse, outputs=None).peak_slip)
    assert comparison.peak_slip.values.ravel().tolist() == [0.0, 0.0, slip]
    assert slip > 0.03
    best = rf.recommend(comparison)
    assert best.model == "rigid ground, sliding"
    assert "in the peak rotation or slip" in best.sentence


def test_a_rung_that_rocks_where_the_scene_only_slides_has_its_verdict_but_no_finite_error():
    system = rf.System(
        rf.Block(width="0.8 m", height="2.4 m", mass="2 t"), rf.RigidGround(friction=0.3)
    )
    pulse = rf.GroundMotion.sine_pulse("5 m/s^2", "1 Hz")
    held = ["rigid ground, small rotations", "rigid ground"]
    found = rf.tradeoff(system, pulse, models=held, accuracies="standard", repeats=1)
    found["verdict_agrees"][0] = False
    assert np.isinf(found.peak_error).all()
    best = rf.recommend(found)
    assert (best.model, best.met) == ("rigid ground", False)
    assert "the scene itself does not rotate, but all rungs with its verdict do" in str(best)
