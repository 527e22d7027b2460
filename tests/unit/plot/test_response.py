"""The figure of a run: contact strips, title and labels."""

import numpy as np
import pytest
import xarray as xr
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.colors import to_rgb
from records import record_path

import rockframe as rf
from rockframe.errors import ComponentError, SolverWarning
from rockframe.plot import _response
from rockframe.plot._response import CONTACT_COLOURS, mean_colours
from rockframe.solve.workspace import Status

BLOCK = rf.Block(width="1 m", height="6 m", mass="10 t")
PULSE = rf.GroundMotion.sine_pulse("-2 m/s^2", "1 Hz")
FULL, LEFT, RIGHT = (np.array(to_rgb(CONTACT_COLOURS[name])) for name in ("full", "left", "right"))


def strip(times, states):
    flags = {"flag_values": np.arange(4), "flag_meanings": "full left right flight"}
    return xr.DataArray(states, {"time": times}, "time", attrs=flags)


def pixels(figure, axes, start, end):
    """Colours between two times, at half the height of a panel."""
    canvas = FigureCanvasAgg(figure)
    canvas.draw()
    image = np.asarray(canvas.buffer_rgba())[::-1, :, :3] / 255.0
    corners = axes.get_xaxis_transform().transform([(start, 0.5), (end, 0.5)])
    (left, height), (right, _) = np.round(corners).astype(int)
    return image[height, left + 2 : right - 1]


def test_contact_strip_averages_colours_over_time():
    state = strip([0.0, 1.0, 1.5, 3.0, 4.0], [0, 1, 2, 1, 2])
    expected = [FULL, 0.5 * LEFT + 0.5 * RIGHT, RIGHT, LEFT]
    np.testing.assert_allclose(mean_colours(state, 4), expected, atol=1e-12)
    np.testing.assert_allclose(mean_colours(state, 1), [np.mean(expected, axis=0)], atol=1e-12)


@pytest.mark.wide
@pytest.mark.parametrize("dpi", [60, 100, 300])
def test_contact_states_narrower_than_a_pixel_are_blended(dpi):
    run = rf.System(BLOCK).simulate(PULSE, duration="40 s", output_step="1 ms")
    time = run["time"].values
    chatter = np.where(np.arange(time.size) % 2 == 0, 1, 2)
    states = np.where(time < 10.0, 0, np.where(time < 20.0, 1, np.where(time < 30.0, chatter, 2)))
    figure = rf.plot.response(
        run.assign(contact_state=run["contact_state"].copy(data=states))
    ).figure
    figure.set_dpi(dpi)
    for start, colour in ((0, FULL), (10, LEFT), (20, 0.5 * (LEFT + RIGHT)), (30, RIGHT)):
        colours = pixels(figure, figure.axes[-1], start + 0.5, start + 9.5)
        np.testing.assert_allclose(colours, np.tile(colour, (len(colours), 1)), atol=0.02)


def test_chattering_block_has_a_blended_contact_strip():
    motion = rf.GroundMotion.read(record_path("NIS090.AT2"))
    run = rf.System(BLOCK).simulate(motion, free_vibration="5 s")
    rocking = run["contact_state"].sel(time=slice(24.6, 26.9)).values
    assert np.mean(rocking == 1) == pytest.approx(0.5, abs=0.03)
    assert np.mean(rocking == 2) == pytest.approx(0.5, abs=0.03)
    figure = rf.plot.response(run).figure
    colours = pixels(figure, figure.axes[-1], 24.6, 26.9)
    np.testing.assert_allclose(colours.mean(axis=0), 0.5 * (LEFT + RIGHT), atol=0.03)


LONGEST = (
    "Did not overturn: peak rotation 0.05804 rad, 26.5 % of the overturning angle; 267 impacts, "
    "no uplift from the pads, 0.123 s in flight. Not finished: stopped at 12.3456 s, because no "
    "step was small enough for the requested accuracy."
)


@pytest.mark.parametrize(
    ("words", "lines"),
    [
        pytest.param("short", ["short"], marks=pytest.mark.long),
        (LONGEST[:90], [LONGEST[:90]]),
        pytest.param(LONGEST[:120], [LONGEST[:77], LONGEST[78:120]], marks=pytest.mark.long),
        (LONGEST, [LONGEST[:77], LONGEST[78:134], LONGEST[135:]]),
        ("two\nlines", ["two", "lines"]),
        (" ".join(["word"] * 30), [" ".join(["word"] * 19), " ".join(["word"] * 11)]),
    ],
)
def test_long_title_is_wrapped_within_margins(words, lines):
    run = rf.System(BLOCK).simulate(PULSE, free_vibration="1 s")
    run.attrs["verdict"] = words
    figure = rf.plot.response(run).figure
    assert figure.get_suptitle().split("\n") == lines
    FigureCanvasAgg(figure).draw()
    texts = [text for text in figure.texts if text.get_text() == "\n".join(lines)]
    box = texts[0].get_window_extent()
    assert box.x0 > 0.03 * figure.bbox.width
    assert box.x1 < 0.97 * figure.bbox.width
    assert box.y0 > figure.axes[0].get_window_extent().y1


def test_the_verdict_of_a_run_that_was_not_finished_fits():
    few = rf.Accuracy(rtol=1e-6, max_steps=60)
    with pytest.warns(SolverWarning, match="Not finished"):
        run = rf.System(BLOCK).simulate(PULSE, free_vibration="5 s", accuracy=few)
    assert int(run["status"]) == Status.STEP_LIMIT
    figure = rf.plot.response(run).figure
    assert max(len(line) for line in figure.get_suptitle().split("\n")) <= 96
    assert figure.get_suptitle().replace("\n", " ") == run.attrs["verdict"]


@pytest.mark.parametrize("coupling", ["coupled", pytest.param("cascade", marks=pytest.mark.long)])
def test_settlement_label_names_the_pads_on_soil(coupling):
    block = rf.Block(width="2 m", height="8 m", mass="50 t")
    pads = rf.TwoSpringSupport(frequency_ratio=20, damping_ratio=0.1)
    cap = rf.CushionCap(height="0.4 m", mass="20 t", width="2.5 m")
    soil = rf.WinklerSoil(stiffness="9 MPa", damping_ratio=0.2)
    run = rf.System(block, pads, cap, soil, coupling=coupling).simulate(PULSE)
    label = rf.plot.response(run).figure.axes[2].get_ylabel()
    assert r"y/\delta" in label
    assert r"$\delta$ of the pads" in label
    alone = rf.System(block, pads).simulate(PULSE)
    assert "of the pads" not in rf.plot.response(alone).figure.axes[2].get_ylabel()


def test_slip_panel_shows_only_runs_with_slip():
    slides = rf.System(BLOCK, rf.RigidGround(friction=0.15)).simulate(PULSE)
    runs = {"held": rf.System(BLOCK).simulate(PULSE), "slides": slides}
    assert "slip" not in runs["held"]
    *_, slip, _, _ = rf.plot.response(runs)  # a contact strip for each run below
    assert slip.get_ylabel() == "slip\n[m]"
    assert [line.get_label() for line in slip.get_lines()][:1] == ["slides"]
    with pytest.raises(ComponentError, match=r"They hold .*'slip'"):
        rf.plot.response(runs, panels=["slipp"])


def words_of(axes):
    legend = axes.get_legend()
    return [] if legend is None else [text.get_text() for text in legend.get_texts()]


def test_stack_response_labels_bodies_and_omits_uplift_line(monkeypatch):
    block = rf.Block(width="1 m", height="1.5 m", mass="1 t")
    joint = rf.TwoSpringSupport(stiffness="20 MN/m", damping_ratio=0.1)
    system = rf.System(rf.Stack(block, block, interfaces=[joint]), joint)
    run = system.simulate(rf.GroundMotion.sine_pulse("8 m/s^2", "1 Hz"))
    assert 2 in run.event_body.to_numpy()
    rotation, *strips = rf.plot.response(run, panels=("rotation", "contact"), events=True)
    assert words_of(rotation)[0] == "body 1"
    assert rotation.get_legend().get_title().get_text() == "events of all bodies"
    # uplift occurs at a rotation on the base; the rotation from upright is drawn
    assert "uplift" not in [line.get_label() for line in rotation.get_lines()]
    assert [strip.get_ylabel() for strip in strips] == ["body 1", "body 2"]
    first, _ = rf.plot.response([run, run], panels="contact")
    assert first.get_ylabel() == "run 1, body 1"
    (vertical,) = rf.plot.response(run, panels="vertical", vertical="mm")
    assert vertical.get_ylabel() == "vertical $y$\nof body 1 [mm]"
    monkeypatch.setattr(_response, "_MAX_STRIPS", 1)
    (strip,) = rf.plot.response(run, panels="contact")
    shares = (run.body_contact_state.to_numpy() != 0).mean(axis=1)
    assert strip.get_ylabel() == f"body {1 + int(np.argmax(shares))}"
    assert "rotation of body 1 [" in rf.plot.player(run).to_html()


def test_vertical_ground_motion_is_drawn_only_where_present():
    system = rf.System(rf.Block(width="0.8 m", height="4 m", mass="2 t"))
    across = rf.GroundMotion.sine_pulse("2 m/s^2", "1 Hz")
    runs = {
        name: system.simulate(
            across.with_vertical(rf.GroundMotion.sine_pulse(size, "1 Hz")) if size else across
        )
        for name, size in (("up", "1 m/s^2"), ("more", "2 m/s^2"), ("none", ""))
    }
    (ground,) = rf.plot.response(runs, panels="ground")
    upwards = [line for line in ground.get_lines() if line.get_linestyle() == ":"]
    assert [np.abs(line.get_ydata()).max().round(6) for line in upwards] == [1.0, 2.0]
    assert upwards[0].get_color() != upwards[1].get_color()


def test_axis_limits_follow_small_rotations():
    block = rf.Block(width="0.8 m", height="4 m", mass="2 t")
    system = rf.System(block, rf.TwoSpringSupport(frequency_ratio=20, damping_ratio=0.1))
    small = system.simulate(rf.GroundMotion.sine_pulse("1e-5 m/s^2", "1 Hz"))
    peak = small.peak_relative_rotation.item()
    (rotation,) = rf.plot.response(small, panels="rotation")
    assert rotation.get_ylim()[1] < 2.0 * peak
    assert rf.plot.phase(small).get_xlim()[1] < 1.2 * peak
    large = system.simulate(rf.GroundMotion.sine_pulse("2 m/s^2", "1 Hz"))
    (rotation,) = rf.plot.response(large, panels="rotation")
    assert "uplift" in words_of(rotation)
    assert rf.plot.phase(large).get_xlim()[1] > 1.0


def test_moment_rotation_before_a_wall_covers_only_the_free_side():
    block = rf.Block(width="0.8 m", height="4 m", mass="2 t")
    for side, sign in (("left", 1.0), ("right", -1.0)):
        axes = rf.plot.moment_rotation(rf.System(block, rf.RearWall(side=side)))
        angles = sign * axes.get_lines()[0].get_xdata()
        assert (angles.min(), angles.max()) == pytest.approx((0.0, 1.2 * 11.3099), abs=1e-3)


def test_time_of_overturning_does_not_cross_the_legend():
    """The line at the end of a run lies behind the words."""
    run = rf.System(rf.Block(width="0.5 m", height="2 m", mass="400 kg")).simulate(
        rf.GroundMotion.sine_pulse("6 m/s^2", "1 Hz")
    )
    rotation = rf.plot.response({"falls": run, "too": run}, panels="rotation")[0]
    (line,) = {line.get_zorder() for line in rotation.get_lines() if line.get_linestyle() == ":"}
    legend = rotation.get_legend()
    assert legend.get_frame_on()
    assert line < legend.get_zorder()
