"""Scenes to scale: positions of corners, pads, soil and cap agree with closed forms."""

from io import BytesIO
from shutil import which

import numpy as np
import pytest
from matplotlib.patches import Polygon

import rockframe as rf
from rockframe.errors import ComponentError, FileError, SchemaError, UnitsError
from rockframe.plot._animation import _FilmedFigure
from rockframe.plot._layout import LayoutBuilder
from rockframe.plot._runs import read_runs
from rockframe.plot._scene import SceneHistory
from rockframe.results.points import UPRIGHT, Placement
from rockframe.system.geometry import geometry_of
from rockframe.system.options import Restraint

BLOCK = rf.Block(width="0.8 m", height="4 m", mass="2 t", centre_of_mass=("1.8 m", "0.1 m"))
EVEN = rf.Block(width="2 m", height="8 m", mass="50 t")
PADS = rf.TwoSpringSupport(frequency_ratio=20, damping_ratio=0.1)
CAP = rf.CushionCap(height="0.4 m", mass="20 t", width="2.5 m")
SOIL = rf.WinklerSoil(stiffness="9 MPa", damping_ratio=0.2)
PULSE = rf.GroundMotion.sine_pulse("2.2 m/s^2", "1 Hz")


def placement_and_layout(system, run, place):
    moving = SceneHistory(run, "state", 1.0)
    return moving.placement_at(place), moving.builder.layout_at(moving.placement_at(place))


def rotated(point, about, angle):
    """Rotate a point clockwise."""
    across, up = np.array(point) - about
    sine, cosine = np.sin(angle), np.cos(angle)
    moved = np.array([across * cosine + up * sine, up * cosine - across * sine])
    return np.array(about) + moved


def test_block_on_rigid_ground_pivots_about_the_bearing_corner():
    run = rf.System(BLOCK).simulate(PULSE, free_vibration="2 s")
    corners = set()
    for place in range(0, run.sizes["time"], 7):
        angle = run.rotation[place].item()
        corner = 0.4 if angle > 0.0 else -0.4
        expected = [rotated(point, (corner, 0.0), angle) for point in
                    ((-0.4, 0.0), (0.4, 0.0), (0.4, 4.0), (-0.4, 4.0))]  # fmt: skip
        _, layout = placement_and_layout(None, run, place)
        np.testing.assert_allclose(layout.block, expected, atol=1e-9)
        np.testing.assert_allclose(
            layout.centres, [rotated((0.1, 1.8), (corner, 0.0), angle)], atol=1e-9
        )
        (touching,) = layout.contacts
        if int(run.contact_state[place]) != 0:
            np.testing.assert_allclose(touching, [(corner, 0.0)], atol=1e-9)
            corners.add(corner)
    assert corners == {-0.4, 0.4}


@pytest.mark.parametrize("parts", [(), (PADS,), (SOIL,), (CAP, SOIL), (PADS, CAP, SOIL)])
def test_drawn_points_match_point_displacements(parts):
    system = rf.System(EVEN, *parts)
    point = {"top": ("1 m", "7 m")}
    run = system.simulate(PULSE, free_vibration="1 s", points=point)
    moving = SceneHistory(run, "state", 1.0)
    below = 0.4 if len(parts) == 3 else 0.0  # points are measured from the base of the body
    lift = moving.builder.geometry.thickness(0) if len(parts) == 3 else 0.0
    for place in range(0, run.sizes["time"], 40):
        placement = moving.placement_at(place)
        (drawn_point,) = moving.builder.points_at(placement, np.array([(1.0, 7.0)]))
        moved = [
            run[f"point_{name}_displacement"][0, place].item()
            for name in ("horizontal", "vertical")
        ]
        raised = lift * np.array([np.sin(placement.cap_rotation), np.cos(placement.cap_rotation)])
        np.testing.assert_allclose(
            drawn_point, np.array([1.0, 7.0 + below]) + moved + raised, atol=1e-12
        )


@pytest.mark.parametrize("loaded", [1, 2])
def test_drawn_points_of_a_stack_with_a_mass_match_body_motion(loaded):
    """A mass beside the axis moves the centre of mass to which displacements refer."""
    mass = rf.Load(at=("0.3 m", "1 m"), moving_mass="1 t", on_body=loaded)
    stack = rf.Stack(BLOCK, rf.Block(width="2 m", height="3 m", mass="15 t"), interfaces=[PADS],
                     offsets=["5 cm"])  # fmt: skip
    system = rf.System(stack, PADS, mass)
    run = system.simulate(PULSE, duration="1 s", points={"top": ("0.4 m", "4 m")})
    moving = SceneHistory(run, "state", 1.0)
    lower = system.setting.bodies[1]
    for time in range(0, run.sizes["time"], 40):
        placement = moving.placement_at(time)
        (top,) = placement.block(np.array([(0.45, 7.0)]))
        moved = [
            run[f"point_{way}_displacement"][0, time].item() for way in ("horizontal", "vertical")
        ]
        np.testing.assert_allclose(top, np.array([0.45, 7.0]) + moved, atol=1e-12)
        centre = np.array([lower.eccentricity, lower.centre_height])
        (drawn,) = placement.lower(0, centre[None])
        across, up = (
            run[f"body_{way}_displacement"][1, time].item() for way in ("horizontal", "vertical")
        )
        np.testing.assert_allclose(drawn, centre + np.array([across, up]), atol=1e-12)


def test_drawn_soil_contact_matches_contact_length():
    run = rf.System(EVEN, SOIL).simulate(PULSE, free_vibration="2 s")
    lengths = run.contact_length.to_numpy()
    assert lengths.min() < 1.5
    for place in range(0, run.sizes["time"], 25):
        _, layout = placement_and_layout(None, run, place)
        length = sum(np.hypot(*(segment[-1] - segment[0])) for segment in layout.contacts)
        assert length == pytest.approx(lengths[place], abs=2.0 / 80 + 1e-9)


def test_drawn_pad_height_follows_block_corners():
    system = rf.System(EVEN, PADS)
    run = system.simulate(PULSE, free_vibration="2 s")
    free = system.equilibrium().pad_settlement.item()
    for place in range(0, run.sizes["time"], 25):
        placement, layout = placement_and_layout(system, run, place)
        corners = placement.block(np.array([(-1.0, 0.0), (1.0, 0.0)]))
        bearing = np.where(np.array(layout.pads_in_contact)[:, None], corners, np.nan)
        np.testing.assert_allclose(np.reshape(layout.contacts, (-1, 2)), bearing, atol=1e-12)
        for pad, corner, bears in zip(layout.pads, corners, layout.pads_in_contact, strict=True):
            assert pad[3, 1] == pytest.approx(min(corner[1], free), abs=1e-9)
            # a dashpot may hold a pad below its free level
            assert not bears or corner[1] <= free + 1e-9
            assert bears or corner[1] > -0.5 * free


@pytest.mark.parametrize("soil", [None, SOIL])
def test_stack_bodies_are_drawn_with_contact_centre_and_outline(soil):
    low = rf.Block(width="2 m", height="3 m", mass="15 t")
    stone = rf.RigidGround()
    stack = rf.Stack(BLOCK, low, interfaces=[stone])
    run = rf.System(stack, soil or stone).simulate(
        rf.GroundMotion.sine_pulse("3 m/s^2", "1 Hz"), duration="1.2 s"
    )
    states = run.body_contact_state.to_numpy()
    assert len({*map(tuple, states.T)}) > 2
    for place in range(0, run.sizes["time"], 5):
        _, layout = placement_and_layout(None, run, place)
        *_, upper = layout.contacts
        if soil is None:
            upper, lower = layout.contacts
            ends = {
                0: layout.lower_bodies[0][:2],
                1: layout.lower_bodies[0][:1],
                2: layout.lower_bodies[0][1:2],
            }
            expected = ends.get(states[1, place], np.full((1, 2), np.nan))
            np.testing.assert_array_equal(lower, expected)
        else:
            assert np.isnan(layout.contacts[0]).any() == (states[1, place] == 3)
        ends = {0: layout.block[:2], 1: layout.block[:1], 2: layout.block[1:2]}
        np.testing.assert_array_equal(upper, ends.get(states[0, place], np.full((1, 2), np.nan)))
        moves = run.isel(time=place)
        rest = np.array([(0.1, 3.0 + 1.8), (0.0, 1.5)])
        across, up = moves.body_horizontal_displacement, moves.body_vertical_displacement
        np.testing.assert_allclose(layout.centres, rest + np.column_stack([across, up]), atol=1e-9)
    axes = rf.plot.state(run)
    dashed = [patch.get_xy()[:4] for patch in axes.patches if patch.get_linestyle() == "--"]
    upright = SceneHistory(run, "state", 1.0).upright
    rest = SceneHistory(run, "state", 1.0).builder.layout_at(upright)
    np.testing.assert_allclose(dashed, [rest.block, rest.lower_bodies[0]])
    labels = [axes.get_ylabel() for axes in rf.plot.response(run, panels=("contact",))]
    assert labels == ["body 1", "body 2"]


def test_pads_and_beds_of_a_stack_fill_the_gaps_between_its_bodies():
    middle, low = (rf.Block(width=f"{k} m", height="1 m", mass="9 t") for k in (2, 3))
    bed = rf.WinklerSoil(stiffness="90 MPa", damping_ratio=0.1)
    system = rf.System(rf.Stack(BLOCK, middle, low, interfaces=[PADS, bed], offsets=["5 cm"] * 2),
                       PADS)  # fmt: skip
    run = system.simulate(PULSE, duration="1 s")
    moving = SceneHistory(run, "state", 3.0)
    rest = moving.builder.layout_at(moving.upright)
    thick = [moving.geometry.thickness(k, 3.0) for k in range(3)]
    assert min(thick) > 0.04
    levels = [body[0, 1] for body in (rest.block, *rest.lower_bodies)]
    np.testing.assert_allclose(levels, [2.0 + thick[0] + thick[1], 1.0 + thick[1], 0.0])
    assert rest.ground[0, 1] == -thick[2]
    for layer, base in zip((*rest.pads, *rest.beds), (0, 0, 2, 2, 1), strict=True):
        low_high = layer[:, 1].min(), layer[:, 1].max()
        np.testing.assert_allclose(low_high, (levels[base] - thick[base], levels[base]))
    np.testing.assert_allclose(rest.pads[0][0, 0], rest.block[0, 0])  # beneath its ends
    np.testing.assert_allclose(rest.beds[0][:, 0].max(), rest.lower_bodies[0][1, 0])
    rocked = int(np.argmax(np.abs(run.rotation.to_numpy())))
    layout = moving.builder.layout_at(moving.placement_at(rocked))
    states = run.body_contact_state.to_numpy()[:, rocked]
    assert states[0] in (1, 2)
    assert layout.pads_in_contact[:2] == (states[0] == 1, states[0] == 2)
    free = layout.pads[1 if states[0] == 1 else 0]  # as thick as without a load
    height = np.hypot(*(free[3] - free[0]))
    np.testing.assert_allclose(height, thick[0] + 3.0 * moving.geometry.bases[0].settlement)
    card = system._repr_html_()
    assert card.count("<polygon") == 1 + 3 + 2 + 1 + 2


def test_magnified_displacements_close_the_gap_of_a_wall():
    wall = rf.RearWall(side="right", stiffness="50 MN/m", gap="2 cm")
    run = rf.System(SLIM, PADS, wall).simulate(PULSE, free_vibration="1 s")
    gaps = []
    for factor in (1.0, 6.0):
        moving = SceneHistory(run, "state", factor)
        layouts = [moving.builder.layout_at(moving.placement_at(k)) for k in range(run.time.size)]
        # from the corner that strikes to the wall
        gaps.append([layout.walls[0][0, 0] - layout.block[2, 0] for layout in layouts])
        assert layouts[0].walls[0][0, 1] == layouts[0].ground[0, 1]
        np.testing.assert_array_equal(layouts[-1].restrainers[0][:, 0], layouts[0].walls[0][0, 0])
    assert min(gaps[0]) < 1e-3  # the wall was struck
    np.testing.assert_allclose(gaps[1], 6.0 * np.array(gaps[0]), atol=1e-12)


def test_a_cap_that_moves_apart_has_its_centre():
    run = rf.System(EVEN, PADS, CAP, SOIL).simulate(PULSE, duration="1 s")
    moving = SceneHistory(run, "state", 1.0)
    assert moving.builder.layout_at(moving.upright).centres[1] == pytest.approx([0.0, 0.2])


def test_cap_under_pads_pivots_about_the_held_soil_end():
    geometry = geometry_of(rf.System(EVEN, PADS, CAP, SOIL).assembly)
    values = {
        "rotation": 0.0, "horizontal_displacement": 0.0, "vertical_displacement": 0.0,
        "contact_state": 0.0, "cap_rotation": 0.1, "soil_contact_state": 2.0,
    }  # fmt: skip
    bearing_end = (1.25, 0.0)
    outline = geometry.cap_outline
    for rule, moved in ((Restraint.CONTACT_STATE, bearing_end), (Restraint.CENTRE, (0.0, 0.0))):
        placement = Placement(geometry, values, rule)
        across = [rotated(point, moved, 0.1)[0] for point in outline]
        np.testing.assert_allclose(placement.cap(outline)[:, 0], across, atol=1e-12)
    # its rise equals that of its centre in the run
    (middle,) = placement.cap(np.array([(0.0, 0.2)]))
    assert middle[1] == pytest.approx(0.2)


def test_drawn_block_and_cap_remain_joined_on_pads():
    """The position of the cap along the base is not in the results; the gap shows its error."""
    run = rf.System(EVEN, PADS, CAP, SOIL).simulate(PULSE, free_vibration="2 s")
    rocked = float(np.abs(run.cap_rotation).max())
    for place in range(0, run.sizes["time"], 25):
        placement, _ = placement_and_layout(None, run, place)
        if int(run.contact_state[place]) != 0:
            continue
        (base,) = placement.block(np.array([(0.0, 0.4)]))
        (top,) = placement.cap(np.array([(0.0, 0.4)]))
        assert abs(base[0] - top[0]) < 1.3 * 1.25 * rocked**2 + 1e-3


def test_an_inclined_base_turns_the_drawing():
    level = LayoutBuilder(geometry_of(rf.System(EVEN, PADS).assembly))
    slope = LayoutBuilder(geometry_of(rf.System(EVEN, PADS, inclination="5 deg").assembly))
    values = dict(UPRIGHT)
    flat = level.layout_at(Placement(level.geometry, values, Restraint.CONTACT_STATE))
    layout = slope.layout_at(Placement(slope.geometry, values, Restraint.CONTACT_STATE))
    expected = [rotated(point, (0.0, 0.0), -np.radians(5.0)) for point in flat.block]
    np.testing.assert_allclose(layout.block, expected, atol=1e-12)
    assert layout.ground[1, 1] > layout.ground[0, 1]


def test_displacements_are_magnified_about_the_place_at_rest():
    run = rf.System(EVEN, PADS).simulate(PULSE, free_vibration="1 s")
    place = int(np.argmax(np.abs(run.rotation.to_numpy())))
    rest, once = (SceneHistory(run, "state", 1.0) for _ in range(2))
    at_rest = rest.builder.layout_at(rest.upright).block
    moved = once.builder.layout_at(once.placement_at(place)).block - at_rest
    thrice = SceneHistory(run, "state", 3.0)
    np.testing.assert_allclose(
        thrice.builder.layout_at(thrice.placement_at(place)).block - at_rest,
        3.0 * moved,
        atol=1e-12,
    )
    with pytest.raises(ComponentError, match="magnify must be greater than zero, got '0'"):
        rf.plot.state(run, magnify=0)


def test_state_plot_shows_the_nearest_sample():
    run = rf.System(EVEN, PADS).simulate(PULSE, free_vibration="1 s")
    axes = rf.plot.state(run, "0.75 s")
    place = int(np.argmin(np.abs(run.time.to_numpy() - 0.75)))
    _, expected = placement_and_layout(None, run, place)
    patches = [patch.get_xy()[:-1] for patch in axes.patches if isinstance(patch, Polygon)]
    assert any(np.allclose(corners, expected.block) for corners in patches if len(corners) == 4)
    assert f"{run.time[place].item():.3f} s" in axes.figure.get_suptitle()
    with pytest.raises(ComponentError, match="the run goes from 0 s to 2 s, got time='9 s'"):
        rf.plot.state(run, "9 s")
    with pytest.raises(UnitsError, match="time needs a time"):
        rf.plot.state(run, 0.75)


def test_a_scene_names_its_parts_and_its_points():
    axes = rf.plot.scene(rf.System(EVEN, PADS, CAP, SOIL), points={"roof": ("0 m", "8 m")})
    words = " ".join(text.get_text() for text in axes.get_legend().get_texts())
    for part in ("Block", "mass 50 t", "TwoSpringSupport", "CushionCap", "stiffness 9 MPa"):
        assert part in words
    assert [text.get_text() for text in axes.texts] == ["roof"]
    with pytest.raises(ComponentError, match=r"rf\.plot\.scene needs a System, got a value"):
        rf.plot.scene(3.0)


def test_animation_frames_are_evenly_spaced_and_saved(tmp_path):
    from PIL import Image

    run = rf.System(EVEN, PADS).simulate(PULSE, free_vibration="1 s")
    moving = rf.plot.animation(run, frames_per_second=2)
    np.testing.assert_allclose(np.diff(moving.times), 0.5, atol=0.01)
    path = moving.save(tmp_path / "run.gif", dpi=40)
    with Image.open(path) as picture:
        assert picture.n_frames == moving.times.size == 5
    assert moving.save(tmp_path / "run.html").read_text() == rf.plot.player(run).to_html()
    with pytest.raises(FileError, match=r"ends in '\.avi'; that of an animation ends in \.gif or "):
        moving.save(tmp_path / "run.avi")
    assert rf.plot.animation(run, speed=2.0).times.size == 21


def test_a_film_draws_once_what_does_not_move(tmp_path, monkeypatch):
    from matplotlib.axis import Axis

    run = rf.System(EVEN, PADS, CAP, SOIL).simulate(PULSE)
    moving = rf.plot.animation(run, frames_per_second=5)
    assert moving.panels[1].get_legend() is not None
    canvas, size, dpi = moving.figure.canvas, moving.figure.get_size_inches(), moving.figure.dpi
    with _FilmedFigure.of(moving.figure, moving._draw, 60.0) as filmed:
        for filmed.number in range(moving.times.size):
            frames = [BytesIO(), BytesIO()]
            filmed.savefig(frames[0])
            for artist in moving._draw(filmed.number):
                artist.set_animated(False)
            moving.figure.savefig(frames[1], dpi=60, format="rgba")
            first, full = (np.frombuffer(one.getvalue(), np.uint8).astype(int) for one in frames)
            assert np.abs(first - full).max() <= 1
    drawn, draw = [], Axis.draw
    monkeypatch.setattr(Axis, "draw", lambda *given: (drawn.append(1), draw(*given))[1])
    moving.save(tmp_path / "run.gif", dpi=60)
    panels = len(moving.panels)
    assert len(drawn) == 2 * panels
    assert (moving.figure.canvas, moving.figure.dpi) == (canvas, dpi)
    np.testing.assert_array_equal(moving.figure.get_size_inches(), size)
    artists = [artist for axes in moving.panels for artist in axes.get_children()]
    assert not any(artist.get_animated() for artist in artists)


def test_mp4_animation_requires_ffmpeg(tmp_path, monkeypatch):
    moving = rf.plot.animation(rf.System(EVEN, PADS).simulate(PULSE), frames_per_second=4)
    film = tmp_path / "run.mp4"
    with monkeypatch.context() as without:
        without.setenv("PATH", str(tmp_path))
        with pytest.raises(FileError, match=r"needs the program ffmpeg, which was not found"):
            moving.save(film)
    if which("ffmpeg") is None:
        pytest.skip("ffmpeg is not installed")
    moving.save(film, dpi=41)
    assert b"ftyp" in film.read_bytes()[:16]
    moving.save(film, dpi=40)


def test_a_tendon_goes_through_its_body():
    tendon = rf.Tendon(stiffness="2 MN/m", preload="10 kN", at="0.3 m", depth="2 m")
    alone = rf.System(EVEN, PADS, tendon)
    upper = rf.Block(width="1 m", height="3 m", mass="5 t")
    stack = rf.System(rf.Stack(upper, EVEN, interfaces=[rf.RigidGround()]), PADS, tendon)
    for system, ends in ((alone, [(0.3, 8.0), (0.3, 0.0), (0.3, -2.0)]),
                         (stack, [(0.3, 11.0), (0.3, 8.0), (0.3, 6.0)])):  # fmt: skip
        assert geometry_of(system.assembly).links[0].points == pytest.approx(np.array(ends))


TIE = rf.Restrainer(
    on=("-0.4 m", "3 m"), to=("-1.5 m", "3 m"), stiffness="2 MN/m", strength="2 kN", name="$tie$"
)
SLIM = rf.Block(width="0.8 m", height="4 m", mass="2 t")


def test_a_restrainer_is_drawn_until_it_breaks():
    run = rf.System(SLIM, TIE).simulate(PULSE, free_vibration="1 s")
    kinds = dict(zip(run.event_kind.flag_meanings.split(), run.event_kind.flag_values, strict=True))
    (broke,) = run.event_time.to_numpy()[run.event_kind.to_numpy() == kinds["restrainer_fracture"]]
    moving = SceneHistory(run, "state", 1.0)
    for place in range(0, run.sizes["time"], 9):
        (tie,) = moving.builder.layout_at(moving.placement_at(place)).restrainers
        assert np.isnan(tie).all() == (run.time[place].item() >= broke)
    # it is shown broken in a window that begins later
    (shown,) = read_runs(run, "animation", (f"{broke + 0.1} s", None))
    later = SceneHistory(shown.dataset, "animation", 1.0)
    assert np.isnan(later.builder.layout_at(later.placement_at(0)).restrainers[0]).all()
    rf.plot.player(run, window=(f"{broke - 0.1} s", None))


def test_a_restrainer_stays_broken_in_a_run_that_continues_another():
    system = rf.System(SLIM, TIE)
    run = system.simulate(PULSE, free_vibration="1 s")
    assert run.broken_restrainer_count == 1
    later = SceneHistory(system.simulate(duration="0.2 s", initial=run), "state", 1.0)
    for place in (0, 5):
        assert np.isnan(later.builder.layout_at(later.placement_at(place)).restrainers[0]).all()


def test_sweep_case_with_a_broken_restrainer_is_refused():
    runs = rf.sweep(rf.System(SLIM, TIE), PULSE, scale=[0.1, 1.0], outputs=[], progress=False)
    rf.plot.state(runs.isel(scale=0, motion=0))
    broke = runs.isel(scale=1, motion=0)
    with pytest.raises(SchemaError, match=r"lacks 'restrainer_state'.*rf\.case"):
        rf.plot.state(broke)
    rf.plot.state(rf.case(broke).simulate())


def test_a_restrainer_without_a_length_is_seen():
    anchor = rf.Restrainer(on=("0.4 m", "0 m"), to=("0.4 m", "0 m"), stiffness="1 MN/m")
    axes = rf.plot.scene(rf.System(SLIM, anchor))
    (line,) = [
        line for line in axes.lines if len(line.get_xdata()) == 2 and line.get_marker() == "."
    ]
    np.testing.assert_allclose(line.get_xydata(), [(0.4, 0.0), (0.4, 0.0)], atol=1e-12)


def test_walls_points_and_the_block_at_rest_are_within_the_drawing():
    far = rf.RearWall(side="right", stiffness="2 MN/m", damping="10 kN*s/m", gap="1.5 m")
    wall = rf.plot.scene(rf.System(SLIM, far))
    assert wall.get_xlim()[1] > 0.4 + 1.5 + 0.8
    axes = rf.plot.scene(rf.System(SLIM), points={"lamp": ("2 m", "7 m")})
    assert axes.get_xlim()[1] > 2.0
    assert axes.get_ylim()[1] > 7.0
    pulse = rf.GroundMotion.sine_pulse("6 m/s^2", "1 Hz")
    flat = rf.System(SLIM).simulate(pulse, free_vibration="4 s", overturning="continue")
    lies = rf.plot.state(flat)
    assert lies.get_ylim()[1] > 4.0
    assert lies.figure.get_suptitle().endswith(f"90°, {9000 / 11.3099:.3g} % of overturning")


def test_scene_legend_lists_bases_loads_and_restrainers():
    def legend_words(*parts, **options):
        axes = rf.plot.scene(rf.System(*parts), **options)
        figure = axes.figure
        figure.canvas.draw()
        extent = axes.get_legend().get_window_extent()
        assert extent.x1 <= figure.bbox.width
        assert 0.0 <= extent.y0 < extent.y1 <= figure.bbox.height
        assert axes.get_tightbbox().x0 >= 0.0
        return "\n".join(text.get_text() for text in axes.get_legend().get_texts())

    load = rf.Load(at=("0.2 m", "4 m"), vertical="5 kN", name="floor")
    words = legend_words(SLIM, TIE, load)
    for entry in (r"\$tie\$", "stiffness 2 MN m⁻¹", "strength 2 kN", "floor, at (0.2, 4.0) m"):
        assert entry in words
    assert "friction 0.3" in legend_words(SLIM, rf.RigidGround(friction=0.3))
    joint = rf.TwoSpringSupport(stiffness="20 MN/m", damping_ratio=0.1)
    words = legend_words(rf.Stack(SLIM, SLIM, interfaces=[rf.RigidGround(friction=0.4)]), joint)
    for entry in (
        "body 2: Block",
        "on RigidGround, friction 0.4",
        "TwoSpringSupport\n   stiffness",
    ):
        assert entry in words
    drums = rf.Stack(*[SLIM] * 6, interfaces=rf.RigidGround(friction=0.4))
    tendons = [rf.Tendon(stiffness="1 MN/m", on_body=k, depth="1 m") for k in range(1, 7)]
    words = legend_words(drums, rf.RigidGround(friction=0.4), *tendons, load)
    assert "\nbodies 2 to 5: Block" in words
    assert "\nload" in words
    in_units = legend_words(SLIM, units={"length": "cm", "mass": "kg"})
    assert "width 80 cm\n   height 400 cm\n   mass 2000 kg" in in_units


def test_state_title_shows_small_unsigned_share():
    small = rf.System(SLIM, PADS).simulate(rf.GroundMotion.sine_pulse("1e-5 m/s^2", "1 Hz"))
    words = rf.plot.state(small).figure.get_suptitle()
    angle, share = np.degrees(small.peak_rotation.item()), small.peak_relative_rotation.item()
    assert f"{angle:.3g}°, {100.0 * share:.3g} % of overturning" in words.replace(": -", ": ")


def test_places_of_points_are_drawn_in_any_unit():
    run = rf.System(BLOCK).simulate(PULSE, points={"top": ("0 m", "4 m")})
    shown = run.assign_coords(
        {name: (1e3 * run[name]).assign_attrs(units="mm") for name in ("point_x", "point_y")}
    )
    limits = [rf.plot.state(dataset).axis() for dataset in (run, shown)]
    np.testing.assert_allclose(*limits, rtol=1e-12)
