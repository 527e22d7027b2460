"""Every figure takes and uses `units`, `ax` and `title`; the player has no `ax`."""

import inspect

import numpy as np
import pytest
from matplotlib import pyplot as plt
from matplotlib.ticker import FuncFormatter

import rockframe as rf
from rockframe.errors import ComponentError, UnitsError
from rockframe.plot import _checks
from rockframe.plot._checks import KINDS, figure_function_name

BLOCK = rf.Block(width="0.8 m", height="4 m", mass="2 t")
SYSTEM = rf.System(BLOCK, rf.TwoSpringSupport(frequency_ratio=20, damping_ratio=0.1))
RIGID = rf.System(BLOCK)
PULSE = rf.GroundMotion.sine_pulse("2.2 m/s^2", "1 Hz")
MOTIONS = {"slow": PULSE, "quick": rf.GroundMotion.sine_pulse("3 m/s^2", "2 Hz")}
OUTPUTS = ("energy", "base_overturning_moment", "reaction")
COUNTS = {"intensity": ([2, 4, 8], "m/s^2"), "exceeded": [1, 6, 19], "trials": 20}


def _run():
    return SYSTEM.simulate(PULSE, free_vibration="1 s", outputs=OUTPUTS)


def _spread():
    spread = {"width": ("uniform", "0.7 m", "0.9 m")}
    return rf.probability_of_overturning(RIGID, PULSE, spread=spread, cases=60, progress=False)


def _rare():
    spread = {"scale": ("lognormal", 1.7, 0.2)}
    return rf.subset_simulation(RIGID, PULSE, spread=spread, limit=0.5, cases=200, progress=False)


def _decay():
    system = rf.System(BLOCK, rf.RigidGround(restitution=0.9))
    run = system.simulate(duration="3 s", initial=rf.InitialState(rotation="0.05 rad"))
    return rf.fit_free_decay(system, run["rotation"])


def _sweep():
    runs = rf.sweep(RIGID, {"pulse": PULSE}, scale=[0.5, 1.0, 1.2], progress=False)
    return runs.drop_vars("peak_relative_rotation").rename(
        peak_rotation="peak_relative_rotation"  # the default
    )


def _cloud():
    runs = rf.sweep(RIGID, {f"{k}": PULSE.scaled(0.8 + 0.1 * k) for k in range(8)}, progress=False)
    return rf.cloud_analysis(runs, "PGA", limits=[0.2])


def _rates():
    hazard = {"intensity": ([0.1, 1.0, 10.0, 100.0], "m/s^2"), "rate": [1.0, 1e-2, 1e-5, 1e-9]}
    return rf.annual_rate(rf.fragility(COUNTS, "PGA"), hazard)


METRES, DEGREES = {"length": ("m", "mm", 1e-3)}, {"angle": ("rad", "mrad", 1e-3)}
GRAVITIES = {"acceleration": ("m/s^2", "g", 9.80665)}
PERIODS = {"periods": ([2.0, 3.0], "s"), "slenderness": [5.0], "progress": False}
DRAWN = {
    # function: (its argument, a kind of units that it shows, two of them and their ratio)
    "animation": (_run, DEGREES),
    "annual_rate": (_rates, GRAVITIES),
    "cloud": (_cloud, GRAVITIES),
    "fractile_curves": (
        lambda: rf.fractile_curves(
            rf.sweep(RIGID, MOTIONS, scale=[0.5, 1.0, 2.0, 4.0], progress=False), "PGA"
        ),
        GRAVITIES,
    ),
    "critical_scale": (lambda: rf.critical_scale(RIGID, PULSE, largest=3, progress=False), DEGREES),
    "dynamic_analysis": (
        lambda: rf.incremental_dynamic_analysis(
            RIGID, MOTIONS, scale=[0.5, 1.0, 2.0, 4.0], intensity="PGA", progress=False
        ),
        GRAVITIES,
    ),
    "energies": (_run, {"energy": ("J", "kJ", 1e3)}),
    "ensemble": (
        lambda: rf.ensemble_statistics(
            rf.sweep(RIGID, MOTIONS, scale=[0.8, 1.0, 1.2], progress=False), "peak_rotation",
            pooled=["scale"],
        ),
        DEGREES,
    ),
    "fragility": (lambda: rf.fragility(COUNTS, "PGA"), GRAVITIES),
    "free_decay": (_decay, DEGREES),
    "moment_rotation": (_run, {"moment": ("N*m", "kN*m", 1e3)}),
    "motion": (lambda: PULSE, {"velocity": ("m/s", "cm/s", 0.01)}),
    "overturning_map": (
        lambda: rf.overturning_map(
            RIGID, PULSE, amplitude=([2.0, 4.0, 8.0], "m/s^2"), frequency=([0.5, 1.0], "Hz"),
            progress=False,
        ),
        GRAVITIES,
    ),
    "overturning_spectrum": (
        lambda: rf.overturning_spectrum(RIGID, MOTIONS, scale=[1.0, 2.0, 4.0, 8.0], **PERIODS),
        GRAVITIES,
    ),
    "phase": (_run, DEGREES),
    "player": (_run, GRAVITIES),
    "probability": (_spread, METRES),
    "response": (_run, DEGREES),
    "subset_simulation": (_rare, {}),
    "rocking_spectrum": (lambda: rf.rocking_spectrum(RIGID, MOTIONS, **PERIODS), {}),
    "scene": (lambda: SYSTEM, METRES),
    "selection": (
        lambda: rf.MotionSuite(MOTIONS).scaling_to(
            rf.TargetSpectrum.eurocode_8("0.2 g_0"), bounds=None
        ),
        GRAVITIES,
    ),
    "spectra": (lambda: PULSE, GRAVITIES),
    "state": (_run, METRES),
    "suite": (lambda: MOTIONS, GRAVITIES),
    "sweep": (_sweep, DEGREES),
    "tradeoff": (
        lambda: rf.tradeoff(
            SYSTEM, PULSE, models=["two pads"], accuracies=["fast", "standard"], repeats=1
        ),
        {},
    ),
    "velocity_pulse": (lambda: PULSE.velocity_pulse(), {"velocity": ("m/s", "cm/s", 0.01)}),
}  # fmt: skip
"""Periods, times and shares have no unit that a reader chooses."""


@pytest.fixture(scope="module")
def plotted():
    made = {}
    return lambda name: made.setdefault(DRAWN[name][0], DRAWN[name][0]())


@pytest.fixture(autouse=True)
def _closed():
    yield
    plt.close("all")


def panels_of(figure):
    figure = getattr(figure, "panels", figure)
    return list(figure) if isinstance(figure, tuple) else [figure]


def spans(figure, unit):
    """Return the spans of all axes that have the unit."""
    found = []
    for axes in panels_of(figure):
        for axis, label, ends in (
            (axes.xaxis, axes.get_xlabel(), axes.dataLim.intervalx),
            (axes.yaxis, axes.get_ylabel(), axes.dataLim.intervaly),
        ):
            if label.endswith(f"[{unit}]"):
                formatter = axis.get_major_formatter()
                values = np.array(ends)
                # a scene is drawn in metres, and its tick labels are converted
                converted = isinstance(formatter, FuncFormatter) and axes.get_aspect() == 1.0
                found.append([float(formatter(place)) for place in values] if converted else values)
    return np.array(found)


def test_all_figures_take_units_ax_and_title():
    functions = {name for name in rf.plot.__all__ if name.islower()}
    assert functions == set(DRAWN)
    for name in functions:
        parameters = inspect.signature(getattr(rf.plot, name)).parameters
        shared = {"units", "title"} if name == "player" else {"units", "ax", "title"}
        assert shared <= set(parameters)
        assert all(parameters[argument].default is None for argument in shared)
        assert "mapping of str to str, optional\n    Units by quantity" in inspect.getdoc(
            getattr(rf.plot, name)
        )


@pytest.mark.wide
@pytest.mark.parametrize("name", sorted(set(DRAWN) - {"player"}))
def test_figures_use_requested_units(name, plotted):
    draw, kinds = getattr(rf.plot, name), DRAWN[name][1]
    for kind, (plain, other, size) in kinds.items():
        words = {"m/s^2": "m s$^{-2}$", "m/s": "m s$^{-1}$", "cm/s": "cm s$^{-1}$"}
        words |= {"N*m": "N m", "kN*m": "kN m"}
        first, second = (
            spans(draw(plotted(name), units={kind: unit}), words.get(unit, unit))
            for unit in (plain, other)
        )
        assert first.size > 0
        assert np.abs(first).max() > 0.0
        np.testing.assert_allclose(first, size * second, rtol=1e-5)
    with pytest.raises(
        ComponentError,
        match=rf"plot\.{name}: units belong to kinds of quantities.*'angel'.*'angle'",
    ):
        draw(plotted(name), units={"angel": "deg"})
    with pytest.raises(UnitsError, match=rf"plot\.{name}.*force"):
        draw(plotted(name), units={"force": "mm"})


@pytest.mark.wide
@pytest.mark.parametrize("name", sorted(KINDS.keys() & DRAWN.keys()))
@pytest.mark.parametrize("order", [list, reversed])
def test_datasets_are_recognised_whatever_was_imported_first(name, order, plotted, monkeypatch):
    monkeypatch.setattr(_checks, "KINDS", dict(order(KINDS.items())))
    assert figure_function_name(plotted(name)) == name


@pytest.mark.wide
@pytest.mark.parametrize("name", sorted(set(DRAWN) - {"player"}))
def test_figures_are_drawn_on_given_axes(name, plotted):
    draw, argument = getattr(rf.plot, name), plotted(name)
    default = panels_of(draw(argument))
    plt.close("all")
    figure = plt.figure(figsize=(14.0, 6.0), layout="constrained")
    if len(default) == 1:
        axes = figure.subplots()
        panels = panels_of(draw(argument, ax=axes, title="given"))
        assert panels == [axes]
        assert axes.get_title() == "given"
        with pytest.raises(ComponentError, match="ax must be one Axes, got"):
            draw(argument, ax=figure)
    else:
        left, right = figure.subfigures(1, 2)
        for place in (left, right):
            panels = panels_of(draw(argument, ax=place, title="given"))
            assert len(panels) == len(default)
            assert all(axes.figure is place for axes in panels)
            assert place.get_suptitle() == "given"
        again = panels_of(draw(argument, ax=panels))
        assert all(one is other for one, other in zip(again, panels, strict=True))
    figure.canvas.draw()
    assert plt.get_fignums() == [figure.number]


def test_the_player_obeys_units_and_title(plotted):
    units = {"acceleration": "g", "angle": "mrad"}
    page = rf.plot.player(plotted("player"), units=units, title="Fall")
    assert "ground acceleration [g]" in page.to_html()
    assert "rotation [mrad]" in page.to_html()
    assert "Fall" in page.to_html()


def test_tables_obey_units(plotted):
    run = plotted("response")
    table = rf.table(run, "histories", units={"force": "kN", "angle": "deg"})
    np.testing.assert_allclose(table["left_reaction [kN]"], 1e-3 * run.left_reaction, rtol=1e-12)
    np.testing.assert_allclose(table["rotation [°]"], np.degrees(run.rotation), rtol=1e-12)
    assert "base_overturning_moment [N m]" in table
    with pytest.raises(ComponentError, match="table: units belong to kinds of quantities"):
        rf.table(run, units={"weight": "kN"})


SENTENCE = (
    "Overturned to the right after 4.345 s, at a peak ground velocity of 0.4512 m s^-1 and a peak "
    "ground acceleration of 12.31 m s^-2, where 100 kN m were reached"
)


@pytest.mark.wide
@pytest.mark.parametrize(
    ("width", "size"),
    [
        pytest.param(width, size, marks=[pytest.mark.long] * ((number + place) % 3 > 0))
        for number, width in enumerate([3.0, 3.4, 4.0, 4.6, 5.0, 5.6, 6.0, 7.0])
        for place, size in enumerate([8.0, 10.0, 14.0])
    ],
)
def test_titles_never_break_inside_a_unit(plotted, width, size):
    with plt.rc_context({"font.size": size}):
        figure = plt.figure(figsize=(width, 4.0), layout="constrained")
        rf.plot.response(plotted("response"), ax=figure, title=SENTENCE)
        text = figure.get_suptitle()
    assert "\n" in text
    assert text.replace("\n", " ") == SENTENCE
    for value in ("4.345 s", "0.4512 m s^-1", "12.31 m s^-2", "100 kN m"):
        assert value in text
