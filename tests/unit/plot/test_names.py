"""Names of data in figures are shown verbatim and fit into the available space."""

import numpy as np
import pytest
from matplotlib import cbook, pyplot

import rockframe as rf

NAMES = ("cost $5 and $6", "_hidden 50%", f"{'a long name of a record, ' * 6}component 270")
SYSTEM = rf.System(rf.Block(width="0.8 m", height="4 m", mass="2 t"))
MOTIONS = {
    name: rf.GroundMotion.sine_pulse(f"{size} m/s^2", "1 Hz")
    for name, size in zip(NAMES, (2.2, 2.4, 2.6), strict=True)
}


@pytest.fixture(scope="module")
def runs():
    return {name: SYSTEM.simulate(motion, accuracy="fast") for name, motion in MOTIONS.items()}


@pytest.fixture(scope="module")
def swept():
    return rf.sweep(SYSTEM, MOTIONS, scale=[0.5, 1.0], accuracy="fast", progress=False)


@pytest.fixture(scope="module")
def fragility():
    """A fragility whose limit states have the same unusual names."""
    counts = {"intensity": ([2, 4, 8], "m/s^2"), "exceeded": [1, 6, 19], "trials": 20}
    result = rf.fragility(counts, "PGA")
    return (
        result.expand_dims("limit_state")
        .isel(limit_state=[0] * 3)
        .assign_coords(limit_state=[*NAMES])
    )


def legend_texts(figure):
    """Return the texts of all legends."""
    legends = [axes.get_legend() for axes in figure.axes] + figure.legends
    return [text.get_text() for legend in legends if legend for text in legend.get_texts()]


PLOTS = {
    "response": lambda runs, swept, fragility: rf.plot.response(runs, panels="rotation"),
    "phase": lambda runs, swept, fragility: rf.plot.phase(runs),
    "motion": lambda runs, swept, fragility: rf.plot.motion(MOTIONS),
    "spectra": lambda runs, swept, fragility: rf.plot.spectra(MOTIONS),
    "suite": lambda runs, swept, fragility: rf.plot.suite(MOTIONS),
    "sweep": lambda runs, swept, fragility: rf.plot.sweep(swept),
    "fragility": lambda runs, swept, fragility: rf.plot.fragility(fragility),
}


@pytest.mark.parametrize("name", PLOTS)
def test_legend_shows_names_verbatim(runs, swept, fragility, name):
    figure = PLOTS[name](runs, swept, fragility).figure
    texts = [text for text in legend_texts(figure) if text not in ("median", "mean", "overturned")]
    assert len(texts) == len(NAMES)
    assert not any(cbook.is_math_text(text) for text in texts)
    assert r"cost \$5 and \$6" in texts
    assert any(text.strip() == "_hidden 50%" for text in texts)
    assert any(text.startswith("a long name") and text.endswith("270") for text in texts)
    pyplot.close(figure)


@pytest.mark.parametrize("name", PLOTS)
def test_long_names_do_not_shrink_the_axes(runs, swept, fragility, name):
    figure = PLOTS[name](runs, swept, fragility).figure
    figure.canvas.draw()
    inside = figure.bbox.get_points()
    widest = max(axes.get_window_extent().width for axes in figure.axes)
    assert widest > 0.75 * figure.bbox.width
    for axes in figure.axes:
        if legend := axes.get_legend():
            ends = legend.get_window_extent().get_points()
            assert np.all(ends >= inside[0] - 2.0)
            assert np.all(ends <= inside[1] + 2.0)
    pyplot.close(figure)


def test_contact_strips_and_ticks_shorten_long_names(runs, swept):
    for axes_or_figure in (rf.plot.response(runs), rf.plot.sweep(swept.isel(scale=0))):
        figure = axes_or_figure.figure
        figure.canvas.draw()
        assert all(axes.get_window_extent().width > 0.6 * figure.bbox.width for axes in figure.axes)
        pyplot.close(figure)


def test_shortened_names_remain_distinct(runs):
    run = next(iter(runs.values()))
    names = [f"{'a' * 60}{k}{'b' * 60}" for k in (1, 2)]
    axes = rf.plot.phase(dict.fromkeys(names, run))
    first, second = legend_texts(axes.figure)
    assert first != second
    pyplot.close(axes.figure)


def test_point_labels_and_titles_are_verbatim():
    motion = rf.GroundMotion.from_arrays(
        (np.sin(np.arange(99.0)), "m/s^2"), "0.01 s", name=NAMES[0]
    )
    run = SYSTEM.simulate(motion, points={"$x$": ("0 m", "2 m")}, accuracy="fast")
    axes = rf.plot.state(run)
    panels = rf.plot.motion(motion)
    texts = [text.get_text() for text in axes.texts] + [panels.figure.get_suptitle()]
    assert texts == [r"\$x\$", r"cost \$5 and \$6"]
    pyplot.close("all")
