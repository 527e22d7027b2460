"""Names of data in figures: written letter by letter, all of them, in the room that there is."""

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
def counted():
    """A fragility whose limit states have the names of the rest."""
    counts = {"intensity": ([2, 4, 8], "m/s^2"), "exceeded": [1, 6, 19], "trials": 20}
    one = rf.fragility(counts, "PGA")
    return (
        one.expand_dims("limit_state").isel(limit_state=[0] * 3).assign_coords(limit_state=[*NAMES])
    )


def written(figure):
    """Return the texts of all legends."""
    legends = [axes.get_legend() for axes in figure.axes] + figure.legends
    return [text.get_text() for one in legends if one for text in one.get_texts()]


DRAWN = {
    "response": lambda runs, swept, counted: rf.plot.response(runs, panels="rotation"),
    "phase": lambda runs, swept, counted: rf.plot.phase(runs),
    "motion": lambda runs, swept, counted: rf.plot.motion(MOTIONS),
    "spectra": lambda runs, swept, counted: rf.plot.spectra(MOTIONS),
    "suite": lambda runs, swept, counted: rf.plot.suite(MOTIONS),
    "sweep": lambda runs, swept, counted: rf.plot.sweep(swept),
    "fragility": lambda runs, swept, counted: rf.plot.fragility(counted),
}


@pytest.mark.parametrize("name", DRAWN)
def test_legend_shows_names_verbatim(runs, swept, counted, name):
    figure = DRAWN[name](runs, swept, counted).figure
    texts = [text for text in written(figure) if text not in ("median", "mean", "overturned")]
    assert len(texts) == len(NAMES)
    assert not any(cbook.is_math_text(text) for text in texts)
    assert r"cost \$5 and \$6" in texts
    assert any(text.strip() == "_hidden 50%" for text in texts)
    assert any(text.startswith("a long name") and text.endswith("270") for text in texts)
    pyplot.close(figure)


@pytest.mark.parametrize("name", DRAWN)
def test_long_names_do_not_shrink_the_axes(runs, swept, counted, name):
    figure = DRAWN[name](runs, swept, counted).figure
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
    for drawn in (rf.plot.response(runs), rf.plot.sweep(swept.isel(scale=0))):
        figure = drawn.figure
        figure.canvas.draw()
        assert all(axes.get_window_extent().width > 0.6 * figure.bbox.width for axes in figure.axes)
        pyplot.close(figure)


def test_shortened_names_remain_distinct(runs):
    one = next(iter(runs.values()))
    names = [f"{'a' * 60}{k}{'b' * 60}" for k in (1, 2)]
    axes = rf.plot.phase(dict.fromkeys(names, one))
    first, second = written(axes.figure)
    assert first != second
    pyplot.close(axes.figure)


def test_point_labels_and_titles_are_verbatim():
    motion = rf.GroundMotion.from_arrays(
        (np.sin(np.arange(99.0)), "m/s^2"), "0.01 s", name=NAMES[0]
    )
    run = SYSTEM.simulate(motion, points={"$x$": ("0 m", "2 m")}, accuracy="fast")
    axes = rf.plot.state(run)
    panels = rf.plot.motion(motion)
    shown = [text.get_text() for text in axes.texts] + [panels.figure.get_suptitle()]
    assert shown == [r"\$x\$", r"cost \$5 and \$6"]
    pyplot.close("all")
