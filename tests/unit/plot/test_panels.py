"""Axes, units and windows of figures; several runs in one figure."""

import re
from pathlib import Path

import numpy as np
import pytest
from matplotlib import pyplot as plt
from matplotlib.axes import Axes
from matplotlib.colors import to_hex, to_rgb

import rockframe as rf
from rockframe.errors import ComponentError, SchemaError, UnitsError
from rockframe.plot._artists import SOIL_COLOUR
from rockframe.plot._axes import COLOURS, GREY
from rockframe.plot._overturning import MAP_COLOURS
from rockframe.plot._response import CONTACT_COLOURS, history_names
from rockframe.units.display import display_units

BLOCK = rf.Block(width="0.8 m", height="4 m", mass="2 t", centre_of_mass=("2 m", "0.05 m"))
PADS = rf.TwoSpringSupport(frequency_ratio=20, damping_ratio=0.1)
SYSTEM = rf.System(BLOCK, PADS)
PULSE = rf.GroundMotion.sine_pulse("2 m/s^2", "1 Hz")


@pytest.fixture(scope="module")
def runs():
    named = {"whole": 1.0, "less": 0.8}
    return {
        name: SYSTEM.simulate(
            PULSE.scaled(scale), free_vibration="3 s", outputs=("energy", "reaction")
        )
        for name, scale in named.items()
    }


def lines(axes, least=3):
    return [line for line in axes.get_lines() if len(line.get_xdata()) >= least]


def test_passing_axes_creates_no_new_figure(runs):
    before = plt.get_fignums()
    panels = rf.plot.response(runs["whole"])
    assert panels.figure.number in plt.get_fignums()
    assert all(isinstance(axes, Axes) for axes in panels)
    assert repr(panels).startswith("<4 panels: 'ground [m s$^{-2}$]', 'rotation ")
    figure, (left, right) = plt.subplots(1, 2)
    open_now = plt.get_fignums()
    returned = rf.plot.response(runs["whole"], panels="rotation", ax=left)
    assert returned[0] is left
    assert rf.plot.phase(runs["whole"], ax=right) is right
    returned_again = rf.plot.response(runs["less"], ax=panels, title="both")
    assert list(returned_again) == list(panels)
    assert panels[0].get_title() == "both"
    assert plt.get_fignums() == open_now
    assert returned.figure is figure
    assert len(before) + 2 == len(open_now)


def test_invalid_plot_arguments_are_refused_without_a_figure(runs):
    figure, axes = plt.subplots(2, 1)
    count = len(plt.get_fignums())
    message = r"ax must be 4 Axes, for ground, rotation, vertical, contact, got 2 Axes"
    with pytest.raises(ComponentError, match=message):
        rf.plot.response(runs["whole"], ax=axes)
    with pytest.raises(ComponentError, match="ax must be one Axes, got"):
        rf.plot.phase(runs["whole"], ax=figure)
    with pytest.raises(ComponentError, match=r"panels are some of 'ground', .* got 'ground floor'"):
        rf.plot.response(runs["whole"], panels="ground floor")
    with pytest.raises(UnitsError, match="rotation needs an angle"):
        rf.plot.response(runs["whole"], rotation="mm")
    with pytest.raises(UnitsError, match="window needs a time"):
        rf.plot.response(runs["whole"], window=(1.0, 2.0))
    with pytest.raises(ComponentError, match="window must end after it starts"):
        rf.plot.response(runs["whole"], window=("2 s", "1 s"))
    with pytest.raises(ComponentError, match="holds 0 of the run's samples, which go from 0 s"):
        rf.plot.response(runs["whole"], window=("200 s", None))
    assert len(plt.get_fignums()) == count


def test_units_and_windows_apply_to_data_and_labels(runs):
    run = runs["whole"]
    ground, rotation, vertical, _ = rf.plot.response(
        run, rotation="deg", vertical="mm", acceleration="g_0", window=("0.5 s", "2 s")
    )
    inside = run.sel(time=slice(0.5, 2.0))
    expected = (
        (ground, inside.ground_acceleration / 9.80665, "[g]"),
        (rotation, np.degrees(inside.rotation), "rotation [°]"),
        (vertical, 1e3 * inside.vertical_displacement, "[mm]"),
    )
    for axes, values, words in expected:
        plotted = lines(axes)[0]
        np.testing.assert_allclose(plotted.get_ydata(), values, rtol=1e-12)
        np.testing.assert_array_equal(plotted.get_xdata(), inside.time)
        assert words in axes.get_ylabel()
        assert axes.get_xlim() == (inside.time[0], inside.time[-1])


def test_secondary_axes_show_degrees_and_millimetres(runs):
    """The body overturns at a smaller angle to the right."""
    run = runs["whole"]
    panels = rf.plot.response(run)
    panels.figure.canvas.draw()
    share, millimetres = panels[1].child_axes[0], panels[2].child_axes[0]
    low, high = panels[1].get_ylim()
    left, right = run.left_overturning_angle.item(), run.right_overturning_angle.item()
    assert left > right
    ends = np.degrees([low * left, high * right])
    np.testing.assert_allclose(share.get_ylim(), ends, rtol=1e-9)
    settlement = 1e3 * SYSTEM.equilibrium().pad_settlement.item()
    converted = np.array(panels[2].get_ylim()) * settlement
    np.testing.assert_allclose(millimetres.get_ylim(), converted, rtol=1e-9)


def test_several_runs_have_a_line_a_label_and_a_strip_each(runs):
    panels = rf.plot.response(runs)
    assert len(panels) == 3 + 2
    lines_by_label = {line.get_label(): line for line in lines(panels[1])}
    for name, run in runs.items():
        np.testing.assert_array_equal(lines_by_label[name].get_ydata(), run.relative_rotation)
    styles = {
        (lines_by_label[name].get_color(), lines_by_label[name].get_linestyle()) for name in runs
    }
    assert len(styles) == 2
    assert len({style for _, style in styles}) == 2
    assert [axes.get_ylabel() for axes in panels[3:]] == list(runs)
    phase_axes = rf.plot.phase(list(runs.values()))
    # scaled motions have equal names, so runs are numbered
    words = [text.get_text() for text in phase_axes.get_legend().get_texts()]
    assert words == ["run 1", "run 2"]
    other = SYSTEM.simulate(rf.GroundMotion.sine_pulse("1 m/s^2", "2 Hz"))
    words = rf.plot.phase([runs["whole"], other]).get_legend().get_texts()
    assert [text.get_text() for text in words] == [
        run.attrs["motion"] for run in (runs["whole"], other)
    ]
    with pytest.raises(SchemaError, match="got a value of type list"):
        rf.plot.response([runs["whole"], 3])


def test_runs_whose_keys_are_spelled_alike_are_all_drawn(runs):
    run = next(iter(runs.values()))
    (axes,) = rf.plot.response({1: run, "1": run}, panels="rotation")
    assert {"1: 1", "2: 1"} <= set(axes.get_legend_handles_labels()[1])


def test_event_markers_are_at_event_times(runs):
    run = runs["whole"]
    axes = rf.plot.response(run, panels="rotation", rotation="deg", events=True)[0]
    marks = {line.get_label(): line for line in axes.get_lines() if line.get_marker() != "None"}
    kinds = run.event_kind.to_numpy()
    impacts = kinds == 2
    assert impacts.any()
    np.testing.assert_array_equal(marks["impact"].get_xdata(), run.event_time[impacts])
    plotted = marks["impact"].get_ydata()
    np.testing.assert_allclose(plotted, np.degrees(run.event_rotation[impacts]), rtol=1e-12)
    assert "pivot change" not in marks


def test_motions_and_spectra_are_plotted_in_requested_units():
    panels = rf.plot.motion(PULSE, acceleration="g_0", displacement="cm", window=(None, "0.5 s"))
    plotted = lines(panels[0])[0]
    inside = PULSE.si.horizontal.times <= 0.5
    np.testing.assert_allclose(
        plotted.get_ydata(), PULSE.si.horizontal.samples[inside] / 9.80665, rtol=1e-12
    )
    assert panels[2].get_ylabel() == "displacement\n[cm]"
    both = rf.plot.motion([PULSE, PULSE.scaled(0.5)])
    assert len(lines(both[1])) == 2
    assert len(both.figure.legends[0].get_texts()) == 2
    spectra = rf.plot.spectra({"a": PULSE, "b": PULSE.scaled(2)}, (["0.5", "1"], "s"))
    a, b = lines(spectra[1], 2)
    np.testing.assert_allclose(b.get_ydata(), 2.0 * a.get_ydata(), rtol=1e-9)


def test_a_scaled_motion_is_shown_with_its_factor():
    twice = PULSE.scaled(4.0).scaled(0.5)
    panels = rf.plot.motion(twice)
    assert panels[0].figure.get_suptitle() == f"2 times {PULSE.name}"
    panels = rf.plot.motion(PULSE.scaled(peak="5 m/s^2"))
    assert panels[0].figure.get_suptitle() == f"2.5 times {PULSE.name}"
    assert rf.plot.motion(PULSE)[0].figure.get_suptitle() == PULSE.name
    assert f"-1 times {PULSE.name}" in PULSE.scaled(-1.0)._repr_html_()
    (legend,) = rf.plot.motion([PULSE, twice])[0].figure.legends
    assert [text.get_text() for text in legend.get_texts()] == [PULSE.name, f"2 times {PULSE.name}"]


def test_stacked_energies_sum_to_input_energy(runs):
    run = runs["whole"]
    axes = rf.plot.energies(run, energy="J")
    tops = np.zeros(run.time.size)
    for area in axes.collections:
        corners = area.get_paths()[0].vertices
        assert np.isin(corners[:, 0], run.time).all()
    (line,) = [line for line in axes.get_lines() if line.get_label() == "input"]
    np.testing.assert_array_equal(line.get_ydata(), run.input_energy)
    names = ("kinetic", "potential", "elastic", "dissipated", "impact", "repinning")
    for name in names:
        values = run[f"{name}_energy"]
        tops = tops + values - (values[0] if name in names[:3] else 0.0)
    np.testing.assert_allclose(tops, run.input_energy, atol=1e-4 * float(run.input_energy.max()))
    with pytest.raises(SchemaError, match=r"outputs=\('energy',\)"):
        rf.plot.energies(run.drop_vars("kinetic_energy"))


def test_moment_rotation_and_phase_plots_match_the_run(runs):
    run = runs["whole"]
    axes = rf.plot.moment_rotation(SYSTEM, moment="N*m", rotation="rad")
    static = SYSTEM.moment_rotation(([0.05], "rad"))
    (line,) = [line for line in lines(axes) if line.get_label() == "of the base"]
    interpolated = np.interp(0.05, line.get_xdata(), line.get_ydata())
    assert interpolated == pytest.approx(static.base_moment.item(), rel=1e-4)
    curve = SYSTEM.moment_rotation(([0.0, 0.02, 0.04, 0.06], "rad"))
    line = lines(rf.plot.moment_rotation(curve, moment="N*m"))[0]
    np.testing.assert_allclose(line.get_ydata(), curve.base_moment)
    axes = rf.plot.moment_rotation(run)
    plotted = lines(axes)[1]
    np.testing.assert_allclose(plotted.get_ydata(), 1e-3 * run.base_overturning_moment, rtol=1e-12)
    assert axes.get_ylabel() == "moment of the base [kN m]"
    phase = rf.plot.phase(run, rotation="deg")
    np.testing.assert_allclose(
        lines(phase)[0].get_ydata(), np.degrees(run.angular_velocity), rtol=1e-12
    )
    assert phase.get_ylabel() == "rate of the rotation [° s$^{-1}$]"


@pytest.mark.wide
def test_stack_moments_are_plotted_over_relative_rotation():
    stack = rf.Stack(BLOCK, rf.Block(width="1 m", height="0.8 m", mass="2 t"), interfaces=[PADS])
    run = rf.System(stack, PADS).simulate(PULSE, outputs=("base_overturning_moment",))
    (plotted,) = lines(rf.plot.moment_rotation(run, rotation="rad", moment="N*m"))
    np.testing.assert_array_equal(plotted.get_xdata(), run.body_rotation_on_base.isel(body=0))
    np.testing.assert_array_equal(plotted.get_ydata(), run.base_overturning_moment)


def test_error_bars_show_bounds_of_stripe_fractions():
    result = rf.fragility(
        {"intensity": ([0.2, 0.4, 0.8], "m/s"), "exceeded": [1, 6, 19], "trials": 20}, "PGV"
    )
    axes = rf.plot.fragility(result)
    (bars,) = axes.containers
    reach = np.array([segment[:, 1] for segment in bars.lines[2][0].get_segments()])
    np.testing.assert_allclose(reach[:, 0], result.stripe_fraction_lower_bound.squeeze())
    np.testing.assert_allclose(reach[:, 1], result.stripe_fraction_upper_bound.squeeze())


def test_peaks_beyond_overturning_are_clipped():
    system = rf.System(rf.Block(width="0.5 m", height="2 m", mass="400 kg"))
    motions = {"weak": rf.GroundMotion.sine_pulse("3 m/s^2", "1 Hz")}
    result = rf.incremental_dynamic_analysis(
        system, motions, scale=[1.0, 2.0, 4.0], free_vibration="3 s", progress=False
    )
    far = result.assign(peak_relative_rotation=3.0 * result.peak_relative_rotation)
    plotted = [line.get_xdata() for line in rf.plot.dynamic_analysis(far)[0].get_lines()]
    assert max(np.nanmax(np.append(peaks, 0.0)) for peaks in plotted) == 1.0
    assert float(far.peak_relative_rotation.max()) > 1.0


def test_dynamic_analysis_plot_shows_runs_and_fractiles():
    system = rf.System(rf.Block(width="0.5 m", height="2 m", mass="400 kg"))
    motions = {
        f"{k}": rf.GroundMotion.sine_pulse(f"{2.6 + 0.2 * k} m/s^2", "1 Hz") for k in range(7)
    }
    result = rf.incremental_dynamic_analysis(
        system, motions, scale=[0.5, 1.0, 1.5, 2.0, 3.0], limits=[0.5], intensity="PGA",
        free_vibration="3 s", progress=False,
    )  # fmt: skip
    panels = rf.plot.dynamic_analysis(result)
    assert [axes.get_ylabel()[:24] for axes in panels] == ["peak ground acceleration", ""]
    named = {line.get_label(): line for line in panels[0].get_lines()}
    runs = [line for line in lines(panels[0]) if line.get_color() == GREY]
    assert len(runs) == len(motions)
    up = named["50 %"].get_ydata()
    peaks = np.sort([np.interp(up, line.get_ydata(), line.get_xdata()) for line in runs], axis=0)
    for label, place in (("16 %", 0.96), ("50 %", 3.0), ("84 %", 5.04)):
        plotted = named[label].get_xdata()
        below, above = peaks[int(place)], peaks[int(np.ceil(place))]
        between = below + (place - int(place)) * (above - below)
        np.testing.assert_allclose(plotted, np.where(above < 1.0, between, 1.0), atol=1e-12)
    np.testing.assert_allclose(named["50 %"].get_xdata(), peaks[3], rtol=1e-12)
    # half of the motions overturn where the median line becomes horizontal
    level = up[np.argmax(named["50 %"].get_xdata() >= 1.0)]
    capacity = np.sort(
        result.capacity_scale.sel(limit_state="overturning")
        * result.peak_ground_acceleration.sel(scale=1)
    )
    assert level == pytest.approx(capacity[3], abs=2.0 * (up[1] - up[0]))
    (legend,) = panels.figure.legends
    looks = [(to_hex(line.get_color()), line.get_linestyle()) for line in legend.get_lines()]
    assert len(set(looks)) == len(looks) > 4
    few = rf.plot.dynamic_analysis(result.isel(motion=slice(0, 3)))
    named = [line.get_label() for line in lines(few[0])]
    assert named == ["0", "1", "2"]


@pytest.mark.long
def test_one_panel_of_a_dynamic_analysis_fits_into_a_column():
    system = rf.System(rf.Block(width="0.5 m", height="2 m", mass="400 kg"))
    motions = {f"{a}": rf.GroundMotion.sine_pulse(f"{a} m/s^2", "1 Hz") for a in (2.6, 3.0)}
    result = rf.incremental_dynamic_analysis(
        system, motions, scale=[0.5, 1.0, 3.0], intensity="PGA", progress=False
    )
    both = rf.plot.dynamic_analysis(result)
    for name, panel in zip(("peaks", "shares"), both, strict=True):
        figure, axes = plt.subplots(figsize=(8.5 / 2.54, 7.0 / 2.54), layout="constrained")
        assert list(rf.plot.dynamic_analysis(result, panels=name, ax=axes)) == [axes]
        assert axes.get_xlabel() == panel.get_xlabel()
        assert axes.get_ylabel() == both[0].get_ylabel()
        plotted = [line.get_xydata() for line in axes.get_lines()]
        for points, other in zip(plotted, panel.get_lines(), strict=True):
            np.testing.assert_array_equal(points, other.get_xydata())
        figure.canvas.draw()
        out = (axes.get_tightbbox().extents - figure.bbox.extents) * np.array([-1, -1, 1, 1])
        assert (out <= 2.0).all()  # pixels
        # the legend is above the visible curves, not those beyond the end of the axis
        assert axes.get_ylim()[1] < 2.0 * both[0].get_ylim()[1]
    swapped = rf.plot.dynamic_analysis(result, panels=("shares", "peaks"))
    assert swapped[0].get_xlabel() == both[1].get_xlabel()
    with pytest.raises(ComponentError, match=r"2 Axes.*got 1 Axes; panels='peaks' draws one"):
        rf.plot.dynamic_analysis(result, ax=axes)
    for wrong in ("peak", (), ("peaks", "peaks"), 3):
        with pytest.raises(ComponentError, match="panels are one or more of 'peaks', 'shares'"):
            rf.plot.dynamic_analysis(result, panels=wrong)


def luminance(colour):
    """CIE lightness, from 0 to 100."""
    rgb = np.array(to_rgb(colour))
    linear = np.where(rgb <= 0.04045, rgb / 12.92, ((rgb + 0.055) / 1.055) ** 2.4)
    return 116.0 * (linear @ [0.2126, 0.7152, 0.0722]) ** (1.0 / 3.0) - 16.0


@pytest.mark.parametrize(
    ("colours", "apart"), [(COLOURS, 7.5), (CONTACT_COLOURS.values(), 11.0), (MAP_COLOURS, 7.5)]
)
def test_colours_differ_in_lightness(colours, apart):
    shades = np.sort([luminance(colour) for colour in colours])
    assert np.diff(shades).min() > apart
    assert shades.min() > 30.0  # on a black page
    assert luminance(CONTACT_COLOURS["right"]) - luminance(CONTACT_COLOURS["left"]) > 15.0


def test_all_figures_take_their_colours_from_the_palette():
    written = {
        (path.name, colour)
        for path in Path(rf.plot.__file__).parent.glob("*.py")
        for colour in re.findall(r"\"(#[0-9a-f]{6})\"", path.read_text())
        if path.name != "_axes.py"
    }
    known = {*CONTACT_COLOURS.values(), SOIL_COLOUR}
    assert {colour for _, colour in written} == known


@pytest.mark.parametrize("size", [pytest.param((8.0, 6.0), marks=pytest.mark.long), (4.0, 5.0)])
def test_legends_do_not_cover_curves(runs, size):
    figure = plt.figure(figsize=size, layout="constrained")
    rf.plot.response(runs["whole"], units={"force": "kN"}, events=True, ax=figure,
                     panels=("rotation", "left_reaction", "contact"))  # fmt: skip
    single, axes = plt.subplots(figsize=size)
    rf.plot.phase(runs, ax=axes)
    third, (_, axes) = plt.subplots(1, 2, figsize=size)
    rf.plot.energies(runs["whole"], ax=axes)
    for figure_drawn in (figure, single, third):
        figure_drawn.canvas.draw()
        for panel in figure_drawn.axes:
            if panel.get_legend() is None:
                continue
            box = panel.get_legend().get_window_extent()
            for line in lines(panel, 1):
                places = panel.transData.transform(np.column_stack(line.get_data()))
                in_data_units = line.get_transform() == panel.transData
                assert not in_data_units or not any(box.contains(*place) for place in places)


@pytest.mark.wide
def test_any_history_of_a_run_has_a_panel():
    block = rf.Block(width="0.8 m", height="4 m", mass="2 t")
    slide = rf.System(block, rf.RigidGround(friction=0.18))
    outputs = ("reaction", "acceleration", "base_shear", "friction_demand", "energy")
    points = {"top": ("0 m", "4 m"), "middle": ("0 m", "2 m")}
    run = slide.simulate(PULSE, free_vibration="1 s", outputs=outputs, points=points)
    assert {"slip", "horizontal_reaction", "horizontal_acceleration"} <= set(run.data_vars)
    units = {"force": "kN", "length": "mm", "acceleration": "g", "angle": "mrad"}
    histories = rf.table(run, "histories", units=units)
    for name in history_names(run):
        _, axes = plt.subplots()
        rf.plot.response(run, panels=name, units=units, ax=axes)
        label = " ".join(axes.get_ylabel().split())
        assert label.startswith(name.replace("_", " ")) or name in (
            "rotation",
            "ground_acceleration",
        )
        rows = lines(axes)
        assert len(rows) >= (2 if "point" in run[name].dims else 1)
        unit = display_units(units, owner="").of(run[name].attrs["units"])
        first = run[name] if run[name].ndim == 1 else run[name][0]
        if name != "rotation":
            np.testing.assert_allclose(rows[0].get_ydata(), unit.of(first), rtol=1e-12)
        plt.close(axes.figure)
    assert "slip [mm]" in histories


def test_end_of_dynamic_analysis_fractiles_is_labelled():
    """Two motions do not overturn: there are fewer curves above their largest intensity."""
    system = rf.System(rf.Block(width="0.5 m", height="2 m", mass="400 kg"))
    motions = {
        f"{a}": rf.GroundMotion.sine_pulse(f"{a} m/s^2", "1 Hz") for a in (0.3, 0.4, 3, 4, 5)
    }
    result = rf.incremental_dynamic_analysis(
        system,
        motions,
        scale=[0.5, 1.0, 2.0, 4.0],
        intensity="PGA",
        free_vibration="3 s",
        progress=False,
    )
    panel = rf.plot.dynamic_analysis(result)[0]
    named = {line.get_label(): line for line in panel.get_lines()}
    (end,) = np.unique(named["all were run up to here"].get_ydata())
    assert end == pytest.approx(1.2, rel=1e-3)  # four times the weakest motion
    assert all(named[f"{share} %"].get_ydata()[-1] == end for share in (16, 50, 84))
    strong = rf.plot.dynamic_analysis(result.isel(motion=[2, 3, 3, 4]))[0]  # all overturn
    assert "all were run up to here" not in [line.get_label() for line in strong.get_lines()]
