"""Figures of many lines, in small axes, in a dark style, and of parts of a study."""

import numpy as np
import pytest
from matplotlib import pyplot as plt
from matplotlib.colors import to_hex

import rockframe as rf
from rockframe.errors import SchemaError

BLOCK = rf.Block(width="0.8 m", height="4 m", mass="2 t")
SYSTEM = rf.System(BLOCK)
PULSE = rf.GroundMotion.sine_pulse("2.2 m/s^2", "1 Hz")
MOTIONS = {"slow": PULSE, "quick": PULSE.scaled(1.2)}
COUNTS = {"intensity": ([2, 4, 8], "m/s^2"), "exceeded": [1, 6, 19], "trials": 20}
HAZARD = {"intensity": ([0.1, 1.0, 10.0, 100.0], "m/s^2"), "rate": [1.0, 1e-2, 1e-5, 1e-9]}


@pytest.fixture(autouse=True)
def _closed():
    yield
    plt.close("all")


def assert_within(figure, artist):
    box, size = artist.get_window_extent(), figure.bbox
    assert -1.0 <= box.x0 < box.x1 <= size.width + 1.0
    assert -1.0 <= box.y0 < box.y1 <= size.height + 1.0


@pytest.mark.parametrize("draw", [rf.plot.motion, rf.plot.spectra])
def test_legend_of_many_motions_leaves_room_for_the_curves(draw):
    many = {f"record {k:02d} of a suite whose names are long, north": PULSE for k in range(30)}
    panels = draw(many)
    panels.figure.draw_without_rendering()
    (legend,) = panels.figure.legends
    words = [text.get_text() for text in legend.get_texts()]
    assert words[-1] == f"and {30 - len(words) + 1} more"
    assert legend.get_window_extent().height < 0.5 * panels.figure.bbox.height
    assert_within(panels.figure, legend)
    given = plt.figure(figsize=(12.0, 3.0), layout="constrained")
    last = draw(many, ax=given.subplots(1, 3))[-1]
    given.draw_without_rendering()
    below, above = last.get_legend().get_window_extent(), last.get_window_extent()
    assert above.y0 <= below.y0 < below.y1 <= above.y1 + 1.0


def test_labels_of_small_axes_are_broken_to_fit():
    figure = plt.figure(figsize=(3.0, 2.0), layout="constrained")
    axes = rf.plot.fragility(rf.fragility(COUNTS, "PGA"), ax=figure.subplots())
    figure.canvas.draw()
    for axis in (axes.xaxis, axes.yaxis):
        assert_within(figure, axis.label)


@pytest.mark.parametrize("height", [1.2, 4.0])
def test_legend_of_contact_is_near_its_strip(height):
    figure = plt.figure(figsize=(6.0, height + 1.0), layout="constrained")
    (axes,) = rf.plot.response(
        SYSTEM.simulate(PULSE), panels="contact", ax=[figure.subplots()]
    )  # fmt: skip
    figure.draw_without_rendering()
    figure.draw_without_rendering()
    assert_within(figure, axes.get_legend())
    assert axes.get_legend().get_window_extent().y1 < axes.xaxis.label.get_window_extent().y0


def test_results_are_visible_in_a_dark_style():
    spread = {"scale": ("lognormal", 1.7, 0.2)}
    rare = rf.subset_simulation(SYSTEM, PULSE, spread=spread, limit=0.5, cases=200, progress=False)
    rungs = rf.tradeoff(SYSTEM, PULSE, accuracies=["fast"], repeats=1)
    with plt.style.context("dark_background"):
        (container,) = rf.plot.subset_simulation(rare).containers
        assert container[0].get_color() == "white"
        lines = rf.plot.tradeoff(rungs)[0].get_lines()
    faces = {to_hex(line.get_markerfacecolor()) for line in lines}
    assert "#000000" in faces  # of small rotations
    assert "#ffffff" not in faces


def test_compared_lines_differ_without_colours():
    widths = ["0.6 m", "0.7 m", "0.8 m"]
    runs = rf.sweep(SYSTEM, MOTIONS, scale=[0.5, 1.0, 2.0, 4.0], width=widths, progress=False)
    analysis = rf.incremental_dynamic_analysis(
        SYSTEM, MOTIONS, scale=[0.5, 1.0, 2.0, 4.0], intensity="PGA", limits=[0.3], progress=False
    )
    run = SYSTEM.simulate(PULSE, points={"top": ("0 m", "4 m"), "lamp": ("0 m", "2 m")})
    peaks, shares = rf.plot.dynamic_analysis(analysis)
    lines = [
        rf.plot.sweep(runs.isel(motion=0)).get_lines(),
        peaks.get_lines(),
        shares.get_lines(),
        rf.plot.response(run, panels="point_horizontal_displacement")[0].get_lines(),
    ]
    for drawn, count in zip(lines, (3, 2, 2, 2), strict=True):
        labelled = [line for line in drawn if not line.get_label().startswith("_")]
        named = [line for line in labelled if line.get_label() != "overturned"]
        assert len(named) == count
        assert len({line.get_linestyle() for line in named}) == count


def test_one_motion_or_slenderness_of_a_spectrum_is_drawn():
    axes = {"periods": ([2.0, 3.0], "s"), "slenderness": [4.0, 5.0], "progress": False}
    rotation = rf.rocking_spectrum(SYSTEM, MOTIONS, **axes)
    capacity = rf.overturning_spectrum(SYSTEM, MOTIONS, scale=[1.0, 2.0, 4.0], **axes)
    for found, draw in ((rotation, rf.plot.rocking_spectrum),
                        (capacity, rf.plot.overturning_spectrum)):  # fmt: skip
        both = draw(found)
        (right,) = draw(found.isel(slenderness=1))
        assert right.get_title() == both[1].get_title() == "H/B = 5"
        one = draw(found.isel(motion=1))
        np.testing.assert_array_equal(
            one[0].get_lines()[0].get_xydata(), both[0].get_lines()[1].get_xydata()
        )


@pytest.mark.parametrize("name", ["annual_rate", "ensemble", "tradeoff", "dynamic_analysis"])
def test_a_part_without_an_axis_of_its_figure_is_refused(name):
    runs = rf.sweep(SYSTEM, MOTIONS, scale=[0.8, 1.0, 1.2], progress=False)
    make, dims = {
        "annual_rate": (lambda: rf.annual_rate(rf.fragility(COUNTS, "PGA"), HAZARD),
                        ["contributing_intensity"]),
        "ensemble": (lambda: rf.ensemble_statistics(runs, "peak_rotation", pooled=["scale"]),
                     ["rank"]),
        "tradeoff": (lambda: rf.tradeoff(SYSTEM, PULSE, accuracies=["fast"], repeats=1),
                     ["accuracy", "model"]),
        "dynamic_analysis": (lambda: rf.incremental_dynamic_analysis(
            SYSTEM, MOTIONS, scale=[0.5, 1.0, 2.0, 4.0], intensity="PGA", progress=False),
            ["limit_state", "motion", "scale"]),
    }[name]  # fmt: skip
    found, draw = make(), getattr(rf.plot, name)
    for dim in dims:
        message = rf"without values along '{dim}'; .* example dataset\.isel\({dim}=\[0\]\)"
        for picked in (0, slice(0)):
            with pytest.raises(SchemaError, match=message):
                draw(found.isel({dim: picked}))
    assert not plt.get_fignums()


def test_results_at_a_single_intensity_are_refused():
    runs = rf.sweep(SYSTEM, MOTIONS, scale=[0.5, 1.0, 2.0], progress=False)
    curves, fit = rf.fractile_curves(runs, "PGA"), rf.fragility(COUNTS, "PGA")
    with pytest.raises(SchemaError, match="one without values along 'peak_ground_acceleration'"):
        rf.plot.fractile_curves(curves.isel(peak_ground_acceleration=0))
    with pytest.raises(SchemaError, match="got one at a single intensity"):
        rf.plot.fragility(fit.isel(peak_ground_acceleration=0))
    found = rf.incremental_dynamic_analysis(SYSTEM, MOTIONS, scale=[0.5, 1.0], progress=False)
    with pytest.raises(SchemaError, match="got one with 1 value along 'scale'"):
        rf.plot.dynamic_analysis(found.isel(scale=[0]))
