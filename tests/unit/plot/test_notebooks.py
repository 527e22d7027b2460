"""Notebook cards, and summaries and plots of datasets."""

import re
from html import escape
from html.parser import HTMLParser

import numpy as np
import pytest
import xarray as xr

import rockframe as rf
from rockframe.errors import ComponentError, ModelWarning, SchemaError, SolverWarning
from rockframe.notebook import number_with_unit, readable_arguments, sparkline

BLOCK = rf.Block(width="0.8 m", height="4 m", mass="2 t", centre_of_mass=("2 m", "0.1 m"))
PADS = rf.TwoSpringSupport(frequency_ratio=20, damping_ratio=0.1)
CAP = rf.CushionCap(height="0.2 m", width="1 m", mass="500 kg")
SOIL = rf.WinklerSoil(stiffness="9 MPa", damping_ratio=0.2)
PULSE = rf.GroundMotion.sine_pulse("2 m/s^2", "1 Hz")
NASTY = rf.GroundMotion.from_arrays(([0.0, 1.0, -3.0], "m/s^2"), "0.5 s", name="<b>&\"'")


class Balanced(HTMLParser):
    """Fails if elements are not closed in order."""

    def __init__(self):
        super().__init__()
        self.open, self.text = [], []

    def handle_starttag(self, tag, attrs):
        self.open.append(tag)

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_data(self, data):
        self.text.append(data)


def card_of(thing):
    """Text and HTML of a card; check that it is complete and sets no colours of text or page."""
    html = thing._repr_html_()
    page = Balanced()
    page.feed(html)
    assert not [tag for tag in page.open if tag not in ("path", "polyline", "polygon", "circle")]
    assert not re.search(r"(?<![-\w])color:(?!inherit)", html)
    assert "background:white" not in html
    return " ".join(page.text), html


def test_notebook_cards_show_parameters():
    text, html = card_of(rf.System(BLOCK, PADS, CAP, SOIL))
    for words in ("coupled", "width 0.8 m", "mass 2 t", "frequency ratio 20", "stiffness 9 MPa",
                  "to the left", "uplift angle"):  # fmt: skip
        assert words in text
    assert html.count("<polygon") == 5  # soil, cap, two pads, block
    text, html = card_of(BLOCK)
    assert "eccentricity" in text
    assert html.count("<polygon") == html.count("<circle") == 1
    assert card_of(SOIL)[1].count("<svg") == 0
    text, _ = card_of(PULSE)
    assert "2 m/s² (0.204 g)" in text


def test_notebook_cards_list_restrainers_and_bodies():
    ties = [
        rf.Restrainer(on=("-0.4 m", "3 m"), to=("-1 m", "3 m"), stiffness=f"{k} MN/m", name=name)
        for k, name in ((2, "upper"), (3, "other"))
    ]
    block = rf.Block(width="0.8 m", height="4 m", mass="2 t")
    text, _ = card_of(rf.System(block, *ties))
    assert "name upper" in text
    assert "name other" in text
    joint = rf.TwoSpringSupport(stiffness="20 MN/m", damping_ratio=0.1)
    plinth = rf.Block(width="1.5 m", height="1 m", mass="3 t")
    stack = rf.Stack(block, plinth, interfaces=[joint], offsets=["3 cm"])
    text, _ = card_of(rf.System(stack, rf.RigidGround(friction=0.3)))
    for words in ("width 1.5 m", "height 4 m", "stiffness 20 MN", "offsets 0.03 m", "friction 0.3"):
        assert words in text
    frame = rf.RockingFrame(block, columns=2, beam_mass="10 t")
    text, _ = card_of(rf.System(frame))
    assert "height 4 m" in text


def test_block_drawing_is_to_scale():
    _, html = card_of(BLOCK)
    corners = re.search(r'<polygon points="([^"]*)"', html)[1].split()
    places = np.array([[float(part) for part in pair.split(",")] for pair in corners])
    width, height = np.ptp(places, axis=0)
    assert height / width == pytest.approx(5.0, rel=0.01)
    dot = re.search(r'cx="([\d.]*)" cy="([\d.]*)"', html)
    across = (float(dot[1]) - places[:, 0].min()) / width
    assert across == pytest.approx(0.5 + 0.1 / 0.8, abs=0.01)


def test_user_names_are_escaped_in_html():
    for thing in (NASTY, rf.MotionSuite({"<i>": NASTY})):
        text, html = card_of(thing)
        assert "<b>" not in html.replace("<div><b>", "").replace("</b></div>", "")
        assert "<i>" not in html
        assert "3 m/s²" in text


def test_a_suite_shows_its_first_motions_and_counts_the_others():
    text, html = card_of(rf.MotionSuite({f"m{k}": PULSE for k in range(11)}))
    assert html.count("<svg") == 8
    assert "and 3 more" in text


def test_sparkline_preserves_extremes_with_few_points():
    values = np.zeros(100_000)
    values[54_321] = 1.0
    values[54_322] = -0.5
    svg = sparkline(values.tolist(), width=200.0, height=100.0)
    points = re.search(r'points="([^"]*)"', svg)[1].split()
    heights = [float(point.split(",")[1]) for point in points]
    assert len(points) <= 600
    assert min(heights) == pytest.approx(2.0)
    assert max(heights) == pytest.approx(74.0)


def test_numbers_use_readable_units():
    cases = {(99e3, "kg"): "99 t", (250.0, "kg"): "250 kg", (9e6, "Pa"): "9 MPa",
             (2.5e5, "N m^-1"): "250 kN m^-1", (4.0, "m"): "4 m", (0.5, "s"): "0.5 s"}  # fmt: skip
    for (size, unit), words in cases.items():
        assert number_with_unit(size, unit) == words
    assert readable_arguments({"type": "x", "shape_factor": 2.92}) == {"shape factor": "2.92"}


def test_dir_lists_only_public_names():
    run = rf.System(BLOCK).simulate(PULSE)
    for thing in (rf.System(BLOCK), BLOCK, PULSE, rf.MotionSuite({"a": PULSE}), run.rockframe):
        assert not [name for name in dir(thing) if name.startswith("_")]
    assert {"simulate", "describe", "parts"} <= set(dir(rf.System(BLOCK)))
    assert {"scaled", "window", "si"} <= set(dir(PULSE))


def test_a_dataset_read_back_plots_and_tabulates_itself(tmp_path):
    system = rf.System(BLOCK, PADS)
    run = system.simulate(PULSE, free_vibration="1 s")
    run.to_netcdf(tmp_path / "run.nc")
    with xr.open_dataset(tmp_path / "run.nc") as stored:
        line = stored.rockframe.plot(panels="rotation", rotation="rad")[0].get_lines()[0]
        np.testing.assert_array_equal(line.get_ydata(), run.rotation)
        xr.testing.assert_identical(
            stored.rockframe.table("events").to_xarray(), rf.table(run, "events").to_xarray()
        )
        restored = stored.rockframe.system
        assert (restored.parts.block, restored.parts.pads) == (BLOCK, PADS)
        summary = stored.rockframe.summary
    assert run.attrs["verdict"] in summary
    assert f"peak_rotation: {run.peak_rotation.item():.4g} rad" in summary


def test_summary_and_card_show_cautions():
    rocking = rf.System(rf.Block(width="1 m", height="4 m", mass="4 t"))
    pulse = PULSE.scaled(2.0)
    with pytest.warns(SolverWarning, match="still has the energy"):
        run = rocking.simulate(pulse)
    with pytest.warns(ModelWarning, match="a result to be careful with"):
        runs = rf.sweep(rocking, pulse, scale=[0.01, 1.0], progress=False)
    for result, words in ((run, run.attrs["cautions"]), (runs, "1 of 2 cases: the run ends")):
        assert f"to be used with care: {words}" in result.rockframe.summary
        html = result.rockframe._repr_html_()
        assert "to be used with care" in html
        assert escape(words) in html
    still = rocking.simulate(PULSE.scaled(0.01))
    assert "care" not in still.rockframe.summary
    assert "care" not in runs.isel(scale=0).rockframe.summary


def test_summary_omits_missing_values():
    still = rf.System(BLOCK).simulate(PULSE.scaled(0.01))
    assert np.isnan(still.overturning_time)
    assert "nan" not in repr(still.rockframe)
    assert "impact_count: 0" in repr(still.rockframe)


def test_accessor_plot_selects_the_plot_function():
    rocking = rf.System(rf.Block(width="0.8 m", height="4 m", mass="2 t"))
    options = {"free_vibration": "2 s", "progress": False}
    runs = rf.sweep(rocking, {"pulse": PULSE}, scale=[0.5, 1.0, 1.5], **options)
    axes = runs.rockframe.plot()
    line = axes.get_lines()[0]
    np.testing.assert_array_equal(line.get_xdata(), [0.5, 1.0, 1.5])
    np.testing.assert_array_equal(
        line.get_ydata(), runs.peak_relative_rotation.transpose("motion", "scale")[0]
    )
    assert axes.get_xlabel() == "scale [-]"
    result = rf.critical_scale(rocking, PULSE, free_vibration="2 s")
    axes = result.rockframe.plot()
    (line,) = [line for line in axes.get_lines() if line.get_linestyle() == ":"]
    assert line.get_xdata()[0] == result.critical_scale.item()
    with pytest.raises(SchemaError, match=r"rf\.plot\.spectra draws them from the motion itself"):
        rf.response_spectrum(PULSE, (["0.1", "1"], "s")).rockframe.plot()
    with pytest.raises(
        SchemaError, match=r"the runs have no 'height'; they have .*'peak_rotation'"
    ):
        rf.plot.sweep(runs, "height")


def test_a_suite_is_drawn_with_its_median_and_target():
    suite = {"one": PULSE, "two": PULSE.scaled(4.0)}
    target = rf.TargetSpectrum.eurocode_8("0.2 g_0")
    periods = ([0.2, 0.5, 1.0], "s")
    axes = rf.plot.suite(suite, periods, target=target, acceleration="m/s^2")
    lines = {line.get_label(): line.get_ydata() for line in axes.get_lines()}
    single = rf.response_spectrum(PULSE, periods).pseudo_spectral_acceleration[0]
    np.testing.assert_allclose(lines["two"], 4.0 * lines["one"])
    np.testing.assert_allclose(lines["one"], single)
    np.testing.assert_allclose(lines["median"], 2.0 * single)  # geometric mean of 1 and 4
    np.testing.assert_allclose(lines["target"], target.at(periods))
    axes = rf.plot.suite(suite, periods, average="mean", named=False, compared=("0.2 s", "0.5 s"),
                         acceleration="m/s^2")  # fmt: skip
    lines = {line.get_label(): line.get_ydata() for line in axes.get_lines()}
    assert not {"one", "two", "median"} & set(lines)
    np.testing.assert_allclose(lines["mean"], 2.5 * single)
    (band,) = axes.patches
    assert (band.get_x(), band.get_x() + band.get_width()) == (0.2, 0.5)
    with pytest.raises(ComponentError, match="compared must be a pair of times"):
        rf.plot.suite(suite, periods, compared="0.2 s")
    with pytest.raises(ComponentError, match="average must be 'median' or 'mean'"):
        rf.plot.suite(suite, periods, average="middle")


def test_free_decay_fit_is_plotted_with_its_measurement():
    system = rf.System(rf.Block(width="0.8 m", height="4 m", mass="2 t"))
    run = system.simulate(
        duration="8 s", initial=rf.InitialState(rotation="0.1 rad"), output_step="0.02 s"
    )
    fit = rf.fit_free_decay(system, run.rotation)
    above, below = fit.rockframe.plot(rotation="rad")
    measured, fitted = above.get_lines()[:2]
    np.testing.assert_array_equal(measured.get_ydata(), fit.measured_rotation)
    np.testing.assert_array_equal(fitted.get_ydata(), fit.fitted_rotation)
    np.testing.assert_array_equal(below.get_lines()[0].get_ydata(), fit.rotation_residual)
    value = fit.attrs["verdict"].split(" (95 %)")[0]  # "Restitution 0.96 +- ..."
    assert above.figure.get_suptitle().startswith(value)


def test_run_card_begins_with_its_verdict():
    run = rf.System(BLOCK, PADS).simulate(PULSE, free_vibration="1 s")
    text, html = card_of(run.rockframe)
    assert run.attrs["verdict"] in " ".join(text.split())
    assert html.index(run.attrs["verdict"][:30]) < html.index("<table")
    assert f"{np.degrees(run.peak_rotation.item()):.4g}°" in text
    assert html.count("<polyline") == 1
    assert "nan" not in text
    assert html.count("<polygon") == 4  # ground, two pads, block
    bare = rf.System(BLOCK, PADS).simulate(PULSE, outputs=None)
    assert "<polyline" not in card_of(bare.rockframe)[1]
    alone = run.copy()
    del alone.attrs["system_json"]
    assert "<polygon" not in card_of(alone.rockframe)[1]
    runs = rf.sweep(rf.System(BLOCK), {"p": PULSE}, scale=[0.5, 1.0], progress=False)
    assert runs.attrs["verdict"][:20] in card_of(runs.rockframe)[0]
    assert card_of(xr.Dataset().rockframe)[0].split()[0] == "Dataset"
    named = rf.System(BLOCK).simulate(NASTY)
    assert "<b>&" not in card_of(named.rockframe)[1]
