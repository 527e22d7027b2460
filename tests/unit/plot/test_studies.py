"""Figures of studies: overturned cases, missing values, readable axes."""

from itertools import pairwise

import numpy as np
import pytest
from matplotlib import pyplot

import rockframe as rf
from rockframe.errors import SchemaError
from rockframe.plot._axes import label_log_ticks
from rockframe.results.variables.runs import RunStatus

BLOCK = rf.Block(width="0.25 m", height="1 m", mass="100 kg")
SYSTEM = rf.System(BLOCK)
PULSE = rf.GroundMotion.sine_pulse("3 m/s^2", "1 Hz")
QUIET = {"accuracy": "fast", "progress": False}
COUNTS = {"intensity": ([2, 4, 8], "m/s^2"), "trials": 20}


def overturned_places(axes):
    """Return the points marked as overturned."""
    lines = [line for line in axes.get_lines() if line.get_label() == "overturned"]
    return {tuple(place) for line in lines for place in line.get_xydata().round(9).tolist()}


@pytest.mark.parametrize("widths", [3, 13])  # lines, and a map
def test_overturned_runs_are_marked_with_crosses(widths):
    scales, sizes = np.linspace(0.5, 3.0, 13).round(6), np.linspace(0.2, 0.4, widths).round(6)
    runs = rf.sweep(SYSTEM, PULSE, scale=scales.tolist(), width=(sizes, "m"), **QUIET)
    axes = rf.plot.sweep(runs, "peak_rotation")
    fell = (runs.status == RunStatus.OVERTURNED).isel(motion=0).transpose("scale", "width")
    assert 0 < fell.sum() < fell.size
    peaks = runs.peak_rotation.isel(motion=0).transpose("scale", "width").to_numpy()
    expected = {
        (sizes[column], scales[row]) if widths > 12 else (scales[row], peaks[row, column].round(9))
        for row, column in np.argwhere(fell.to_numpy()).tolist()
    }
    if widths > 12 and axes.get_xlabel().startswith("scale"):
        expected = {(up, across) for across, up in expected}
    assert overturned_places(axes) == {(float(x), float(y)) for x, y in expected}
    assert "overturned" in [text.get_text() for text in axes.get_legend().get_texts()]


def test_sweep_title_counts_cases_without_a_result():
    runs = rf.sweep(SYSTEM, PULSE, scale=[0.5, 0.6, 0.7], **QUIET)
    failed = runs.copy(deep=True)
    failed["status"][{"scale": 1}] = int(RunStatus.STEP_LIMIT)
    del failed.attrs["verdict"]
    assert "1 have no result" in rf.plot.sweep(failed).figure.get_suptitle()
    assert rf.plot.sweep(runs).figure.get_suptitle() == runs.attrs["verdict"]


def test_sweep_of_three_axes_is_drawn_as_a_mean():
    motions = dict.fromkeys(("a", "b"), PULSE)
    runs = rf.sweep(SYSTEM, motions, scale=[0.5, 0.6], gravity=["9.8 m/s^2", "10 m/s^2"], **QUIET)
    with pytest.raises(SchemaError, match=r"or draw a mean over one, runs\.mean\('motion'\)"):
        rf.plot.sweep(runs)
    (lower, upper) = rf.plot.sweep(runs.mean("motion"), "peak_rotation").get_lines()[:2]
    for line, gravity in ((lower, 9.8), (upper, 10.0)):
        expected = runs.peak_rotation.mean("motion").sel(gravity=gravity)
        np.testing.assert_array_equal(line.get_ydata(), expected)


def test_sweep_over_motions_draws_no_connecting_line():
    motions = dict.fromkeys(("a", "b", "c"), PULSE)
    axes = rf.plot.sweep(rf.sweep(SYSTEM, motions, **QUIET))
    assert axes.get_lines()[0].get_linestyle() == "None"
    axes = rf.plot.sweep(rf.earthquake_sequences(SYSTEM, [[PULSE, PULSE]], accuracy="fast"))
    assert axes.get_legend().get_texts()[0].get_text() == "sequence 1"


def test_annual_rate_without_a_fragility_is_plotted_with_a_note():
    undefined = rf.fragility({**COUNTS, "exceeded": [0, 0, 0]}, "PGA")
    hazard = {"intensity": ([0.1, 1.0, 10.0], "m/s^2"), "rate": [1.0, 1e-2, 1e-5]}
    axes = rf.plot.annual_rate(rf.annual_rate(undefined, hazard))
    assert axes.figure.get_suptitle().startswith("There is no fragility")


def test_shares_of_few_cases_are_plotted_without_empty_groups():
    """Twelve groups of fewer cases left some empty, with warnings about means of nothing."""
    spread = {"width": ("uniform", "0.2 m", "0.3 m")}
    found = rf.probability_of_overturning(SYSTEM, PULSE, spread=spread, cases=6, **QUIET)
    _, right = rf.plot.probability(found)
    (steps,) = right.patches
    assert len(steps.get_data().values) == 6
    assert np.isfinite(steps.get_data().values).all()


def test_equal_verdicts_are_plotted_without_sensitivity_indices():
    spread = {"width": ("uniform", "0.24 m", "0.26 m"), "mass": ("uniform", "90 kg", "110 kg")}
    small = {"a": PULSE.scaled(0.1), "b": PULSE.scaled(0.2)}
    result = rf.probability_of_overturning(SYSTEM, small, spread=spread, cases=20, progress=False)
    left, _ = rf.plot.probability(result)
    left.figure.canvas.draw()
    low, high = left.get_ylim()
    names = {
        text.get_text() for text in left.get_yticklabels() if low < text.get_position()[1] < high
    }
    assert names == {"width", "mass", "motion"}
    assert [text.get_text() for text in left.texts] == ["all verdicts are alike"]


@pytest.mark.parametrize(
    "ends", [(0.9, 1.35), (2.0, 4.0), (1.0, 9.0), (0.015, 4.0), (0.02, 30.0), (1e-3, 1e3)]
)
def test_logarithmic_axes_have_three_numbers_at_least_side_by_side(ends):
    _, axes = pyplot.subplots()
    axes.set(xscale="log", xlim=ends)
    label_log_ticks(axes, "x")
    axes.figure.canvas.draw()
    shown = [
        label.get_window_extent()
        for tick, label in zip(axes.get_xticks(), axes.get_xticklabels(), strict=True)
        if ends[0] <= tick <= ends[1]
    ]
    assert len(shown) >= 3
    assert all(left.x1 < right.x0 for left, right in pairwise(shown))
    pyplot.close(axes.figure)


def test_ensemble_legend_names_the_bands():
    motions = {f"{k}": PULSE.scaled(0.5 + 0.1 * k) for k in range(6)}
    statistics = rf.ensemble_statistics(rf.sweep(SYSTEM, motions, **QUIET), "peak_rotation")
    (legend,) = rf.plot.ensemble(statistics).figure.legends
    words = ["bounds everywhere at once", "bounds at each value"]
    assert [text.get_text() for text in legend.get_texts()] == words
    bare = (
        statistics.isel(confidence_level=0) if "confidence_level" in statistics.dims else statistics
    )
    unbounded = bare.assign(
        {name: bound * np.nan for name, bound in bare.items() if name.endswith("bound")}
    )
    assert rf.plot.ensemble(unbounded).figure.legends == []


def test_spectrum_without_overturning_is_plotted():
    result = rf.overturning_spectrum(
        SYSTEM, PULSE, periods=([8.0, 20.0], "s"), scale=[0.5, 1.0], free_vibration="2 s", **QUIET
    )
    assert np.isinf(result.capacity_intensity).all()
    (axes,) = rf.plot.overturning_spectrum(result)
    axes.figure.canvas.draw()
    assert axes.get_ylim() == (1.0, 10.0)
    pyplot.close(axes.figure)
