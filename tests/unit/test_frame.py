"""The frame as an equivalent block: its members, its properties, refusals."""

import dataclasses
import itertools
import json
import math
import pickle
import re

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from unit.frames import EXAMPLES, MIDDLE, OUTLINE, REGULAR, SIZE, core, tank

import rockframe as rf
from rockframe.components import (
    Block,
    FrameEquivalent,
    Member,
    component_from_dict,
)
from rockframe.errors import ComponentError, ModelWarning, UnitsError

pytestmark = pytest.mark.unit


FRAMES = [name for name, part in EXAMPLES.items() if isinstance(part, FrameEquivalent)]


@pytest.mark.parametrize("name", FRAMES)
def test_members_survive_json_round_trip(name):
    frame = EXAMPLES[name]
    again = component_from_dict(json.loads(json.dumps(frame.to_dict())))
    assert again.members == frame.members
    assert [member.si for member in again.members] == [member.si for member in frame.members]
    assert again.space_proportion == frame.space_proportion
    assert again.depth == frame.depth
    assert again.centre_of_mass_height == frame.centre_of_mass_height
    if frame.members:
        assert again.members_table().identical(frame.members_table())


# frames as blocks ----------------------------------------------------------------


@pytest.mark.parametrize("name", FRAMES)
def test_a_frame_is_a_block(name):
    frame = EXAMPLES[name]
    block = Block(
        width=frame.width,
        height=frame.height,
        mass=frame.mass,
        shape_factor=frame.shape_factor,
        centre_of_mass=frame.centre_of_mass,
    )
    assert isinstance(frame, Block)
    assert frame.si == block.si
    assert frame.noun == block.noun
    assert frame.frequency == block.frequency


def test_a_frame_is_not_equal_to_the_block_with_its_numbers():
    frame = FrameEquivalent(**SIZE, shape_factor=1.153)
    block = Block(**SIZE, shape_factor=1.153)
    assert frame != block
    assert block != frame
    assert len({frame, block}) == 2


@pytest.mark.parametrize("name", ["regular", "members"])
def test_a_system_takes_a_frame_and_gives_the_same_numbers(name):
    frame = EXAMPLES[name]
    block = Block(
        width=frame.width,
        height=frame.height,
        mass=frame.mass,
        shape_factor=frame.shape_factor,
        centre_of_mass=frame.centre_of_mass,
    )
    pads = rf.TwoSpringSupport(frequency_ratio=40, damping_ratio=0.10)
    runs = [
        rf.System(part, pads).simulate(
            duration="2 s", initial=rf.InitialState(rotation="0.1 rad"), output_step="0.1 s"
        )
        for part in (frame, block)
    ]
    np.testing.assert_array_equal(runs[0].rotation, runs[1].rotation)
    assert "FrameEquivalent.from_members" in rf.System(frame, pads).describe()
    again = rf.System.from_dataset(runs[0])  # the dataset is sufficient
    assert again.describe() == rf.System(frame, pads).describe()
    assert repr(frame) in re.sub(r"(?<=,)\s+", " ", again.describe())


# from equivalent parameters -----------------------------------------------------------------


def test_a_frame_needs_its_shape_factor():
    with pytest.raises(ComponentError, match=r"shape_factor or inertia; neither .* hollow"):
        FrameEquivalent(**SIZE)
    with pytest.raises(ComponentError, match="shape_factor or inertia, not both"):
        FrameEquivalent(**SIZE, shape_factor=1.2, inertia="4e5 kg*m^2")
    with pytest.raises(ComponentError, match="shape_factor or inertia; neither"):
        FrameEquivalent.from_size(radius="5 m", slenderness=2, mass="40 t")
    frame = FrameEquivalent.from_size(radius="5 m", slenderness=2, mass="40 t", shape_factor=2.8)
    assert type(frame) is FrameEquivalent
    assert frame.shape_factor == 2.8


def test_the_density_of_a_hollow_frame_gives_no_mass():
    with pytest.raises(ComponentError, match="hollow"):
        FrameEquivalent.from_density(
            width="4 m", height="9 m", depth="4 m", density="2500 kg/m^3", shape_factor=1.153
        )


@pytest.mark.parametrize(
    "arguments", [{"shape_factor": 0.38}, {"inertia": "3e6 kg*m^2"}, {"shape_factor": "99 %"}]
)
def test_a_shape_factor_below_one_is_warned_about_and_used(arguments):
    with pytest.warns(ModelWarning, match=r"not physical.*1 or more") as caught:
        frame = FrameEquivalent(**SIZE, **arguments)
    assert len(caught) == 1
    assert caught[0].filename == __file__
    assert frame.shape_factor < 1.0
    # no second warning: warnings are errors here
    assert pickle.loads(pickle.dumps(frame)) == frame  # noqa: S301
    assert component_from_dict(frame.to_dict()) == frame


def test_a_shape_factor_of_one_is_not_warned_about():
    assert FrameEquivalent(**SIZE, shape_factor=1).shape_factor == 1.0


@pytest.mark.parametrize("bad", [0, -1, math.nan, math.inf, "1.2 m"])
def test_a_shape_factor_must_be_a_positive_number(bad):
    with pytest.raises((ComponentError, UnitsError), match="shape_factor"):
        FrameEquivalent(**SIZE, shape_factor=bad)


def test_a_frame_from_parameters_knows_no_members():
    frame = EXAMPLES["by shape factor"]
    assert frame.members == ()
    assert frame.space_proportion is None
    assert frame.centre_of_mass_height is None
    assert frame.depth is None
    with pytest.raises(ComponentError, match="from_members"):
        frame.members_table()


# properties of the members -------------------------------------------------------------------


def by_brute_force(rectangles, width, height, cells=120):
    """Return mu of rectangles (mass, x, y, width, height), summed over grids of points."""
    grid = (np.arange(cells) + 0.5) / cells - 0.5
    mass = inertia = 0.0
    for m, x, y, w, h in rectangles:
        across, up = np.meshgrid(x + w * grid, y + h * grid - 0.5 * height)
        inertia += m * np.mean(across**2 + up**2)
        mass += m
    return mass * (width**2 + height**2) / 4.0 / inertia


@st.composite
def buildings(draw):
    """Draw the sizes of a building and rectangles that lie within it."""
    width = draw(st.floats(0.5, 30.0))
    height = width * draw(st.floats(0.75, 8.0))
    rectangles = []
    for _ in range(draw(st.integers(1, 6))):
        left, right = sorted(draw(st.tuples(st.floats(-0.5, 0.5), st.floats(-0.5, 0.5))))
        low, high = sorted(draw(st.tuples(st.floats(0.0, 1.0), st.floats(0.0, 1.0))))
        assume(right - left > 1e-6 and high - low > 1e-6)
        rectangles.append((
            draw(st.floats(1e-3, 1e6)),
            0.5 * (left + right) * width,
            0.5 * (low + high) * height,
            (right - left) * width,
            (high - low) * height,
        ))  # fmt: skip
    return width, height, rectangles


def as_members(rectangles):
    return [
        Member(
            name=str(number),
            mass=f"{m!r} kg",
            x=f"{x!r} m",
            y=f"{y!r} m",
            width=f"{w!r} m",
            height=f"{h!r} m",
        )
        for number, (m, x, y, w, h) in enumerate(rectangles)
    ]


@pytest.mark.filterwarnings("ignore::rockframe.errors.ModelWarning")
@given(buildings())
@settings(max_examples=100, deadline=None)
def test_shape_factor_matches_point_sum_and_is_at_least_one(building):
    width, height, rectangles = building
    points = by_brute_force(rectangles, width, height)
    assume(points < 1e4)  # otherwise all mass is near the middle, where the points are too coarse
    frame = FrameEquivalent.from_members(
        as_members(rectangles),
        width=f"{width!r} m",
        height=f"{height!r} m",
        centre_of_mass="middle",
    )
    assert frame.shape_factor >= 1.0
    assert frame.shape_factor == pytest.approx(points, rel=2e-4)
    assert frame.mass.m_as("kg") == pytest.approx(sum(m for m, *_ in rectangles), rel=1e-14)
    table = frame.members_table()
    assert float(table.inertia_about_middle.sum()) == pytest.approx(frame.si.inertia, rel=1e-12)


@pytest.mark.parametrize(("columns", "rows"), [(1, 1), (2, 3), (7, 4), (10, 25)])
def test_tiled_solid_rectangle_has_shape_factor_three(columns, rows):
    w, h = 4.0 / columns, 10.0 / rows
    tiles = [
        (1.0, -2.0 + (i + 0.5) * w, (j + 0.5) * h, w, h)
        for i, j in itertools.product(range(columns), range(rows))
    ]
    frame = FrameEquivalent.from_members(as_members(tiles), **OUTLINE)
    assert frame.shape_factor == pytest.approx(3.0, rel=1e-13)


def test_grid_of_points_converges_to_shape_factor_three():
    excess = []
    for n in (4, 8, 16):
        points = [
            Member(
                name=f"{i} {j}",
                mass="1 kg",
                x=f"{-2.0 + 4.0 * (i + 0.5) / n!r} m",
                y=f"{10.0 * (j + 0.5) / n!r} m",
                inertia="0 kg*m^2",
            )
            for i, j in itertools.product(range(n), repeat=2)
        ]
        excess.append(FrameEquivalent.from_members(points, **OUTLINE).shape_factor - 3.0)
    # 1/mu is too small by the share 1/n^2
    assert excess == pytest.approx([3.0 / (n * n - 1.0) for n in (4, 8, 16)], rel=1e-12)


def test_mass_in_the_corners_has_the_least_shape_factor():
    corners = [
        Member(name=f"{x} {y}", mass="1 t", x=x, y=y, inertia="0 kg*m^2")
        for x, y in itertools.product(("-2 m", "2 m"), ("0 m", "10 m"))
    ]
    assert FrameEquivalent.from_members(corners, **OUTLINE).shape_factor == 1.0


def test_cutting_a_member_in_two_changes_nothing():
    uncut = FrameEquivalent.from_members([core(), tank()], **OUTLINE, depth="3 m")
    halves = [
        core(name="lower", mass="4 t", y="2 m", height="4 m"),
        core(name="upper", mass="6 t", y="7 m", height="6 m"),
        tank(),
    ]
    cut = FrameEquivalent.from_members(halves, **OUTLINE, depth="3 m")
    assert cut.shape_factor == pytest.approx(uncut.shape_factor, rel=1e-14)
    assert cut.mass == uncut.mass


def test_small_building_matches_hand_calculation():
    frame = FrameEquivalent.from_members([core(), tank()], **MIDDLE, depth="5 m")
    about_middle = 10e3 * 104.0 / 12.0 + 800.0 + 1e3 * (0.25 + 4.0)
    assert frame.mass.m_as("kg") == 11e3
    assert frame.shape_factor == pytest.approx(11e3 * 29.0 / about_middle, rel=1e-14)
    assert frame.inertia.m_as("kg*m^2") == pytest.approx(about_middle, rel=1e-14)
    assert frame.centre_of_mass_height.m_as("m") == pytest.approx(57.0 / 11.0, rel=1e-14)
    assert frame.depth.m_as("m") == 5.0
    assert frame.space_proportion is None  # the tank's volume is not known
    alone = FrameEquivalent.from_members([core()], **OUTLINE, depth="5 m")
    assert alone.space_proportion == pytest.approx(60.0 / 200.0, rel=1e-14)
    assert FrameEquivalent.from_members([core()], **OUTLINE).space_proportion is None


def test_members_may_be_mappings_or_a_generator():
    built = FrameEquivalent.from_members([core(), tank()], **OUTLINE)
    plain = {"name": "core", "kind": "wall", "mass": "10 t", "x": "0 m", "y": "500 cm"}
    plain |= {"width": "2 m", "height": "10 m", "depth": "3 m"}
    assert FrameEquivalent.from_members((m for m in (plain, tank())), **OUTLINE) == built
    assert FrameEquivalent.from_members([core().to_dict(), tank()], **OUTLINE) == built


# centre of mass -----------------------------------------------------------------------------


def test_centre_of_mass_off_mid_height_warns():
    for y, warned in (("5.99 m", False), ("6.01 m", True), ("3.99 m", True), ("4.01 m", False)):
        point = tank(y=y, x="0 m")
        if not warned:
            FrameEquivalent.from_members([point], **MIDDLE)
            continue
        with pytest.warns(ModelWarning, match="above the base") as caught:
            frame = FrameEquivalent.from_members([point], **MIDDLE)
        assert len(caught) == 1
        assert caught[0].filename == __file__
        assert component_from_dict(frame.to_dict()) == frame  # without a warning
    with pytest.warns(ModelWarning, match=r"0\.3805 rad instead of 0\.2783 rad"):
        FrameEquivalent.from_members([tank(y="7 m", x="0 m")], **MIDDLE)


def test_centre_of_mass_off_the_middle_warns():
    FrameEquivalent.from_members([tank(y="5 m", x="-0.39 m")], **MIDDLE)
    with pytest.warns(ModelWarning, match=r"0\.41 m left of the middle"):
        FrameEquivalent.from_members([tank(y="5 m", x="-0.41 m")], **MIDDLE)
    with pytest.warns(ModelWarning, match=r"right of the middle"):
        FrameEquivalent.from_members([tank(y="5 m", x="0.41 m")], **MIDDLE)


def test_centre_of_mass_follows_from_the_members():
    frame = EXAMPLES["members"]
    x, y = 0.5 / 11.0, 57.0 / 11.0
    # tank and core about the common centre, by the parallel-axis theorem
    inertia = 800.0 + 1e3 * ((0.5 - x) ** 2 + (7.0 - y) ** 2)
    inertia += 10e3 * (104.0 / 12.0 + x**2 + (5.0 - y) ** 2)
    assert frame.eccentricity.m_as("m") == pytest.approx(x, rel=1e-14)
    assert frame.centre_height.m_as("m") == pytest.approx(y, rel=1e-14)
    assert frame.inertia.m_as("kg*m^2") == pytest.approx(inertia, rel=1e-14)
    assert frame.centre_of_mass_height == frame.centre_height
    middle = frame.replace(centre_of_mass="middle")
    assert middle == EXAMPLES["members, in the middle"]
    assert middle.eccentricity.m_as("m") == 0.0
    assert middle.centre_height.m_as("m") == 5.0
    # from O to the centre of mass
    shift = 11e3 * (x**2 + (y - 5.0) ** 2)
    assert middle.inertia.m_as("kg*m^2") == pytest.approx(inertia + shift, rel=1e-14)


def test_regular_frame_centre_of_mass_defaults_to_the_middle():
    regular = EXAMPLES["regular"]
    explicit = FrameEquivalent.from_members(**REGULAR, centre_of_mass="middle")
    assert explicit == regular
    assert explicit.si == regular.si
    assert (regular.si.centre_height, regular.si.eccentricity) == (4.5, 0.0)
    own = FrameEquivalent.from_members(**REGULAR, centre_of_mass="members")
    listed = FrameEquivalent.from_members(regular.members, width="4 m", height="9 m")
    assert own.si == listed.si
    assert own != regular
    assert own.si.eccentricity == 0.0
    assert own.centre_height == regular.centre_of_mass_height
    assert component_from_dict(json.loads(json.dumps(own.to_dict()))) == own
    for bad in ("paper", ("5 m", "0 m"), 3):
        with pytest.raises(ComponentError, match="must be 'members' or 'middle'"):
            FrameEquivalent.from_members(**REGULAR, centre_of_mass=bad)


def test_a_taller_left_column_moves_the_centre_of_mass_to_the_left():
    left = core(name="left", x="-1.5 m", y="5 m", width="0.4 m", height="10 m")
    right = core(name="right", mass="6 t", x="1.5 m", y="3 m", width="0.4 m", height="6 m")
    frame = FrameEquivalent.from_members([left, right], **OUTLINE)
    assert frame.eccentricity.m_as("m") == pytest.approx(-1.5 * 4.0 / 16.0, rel=1e-14)
    assert frame.centre_height.m_as("m") == pytest.approx(68.0 / 16.0, rel=1e-14)
    mirrored = [
        member.replace(x=-1 * member.x, name=f"mirrored {member.name}") for member in (left, right)
    ]
    other = FrameEquivalent.from_members(mirrored, **OUTLINE)
    assert other.si == dataclasses.replace(frame.si, eccentricity=-frame.si.eccentricity)


def test_all_mass_in_one_point_is_refused():
    with pytest.raises(ComponentError, match="all mass is in one point"):
        FrameEquivalent.from_members([tank(inertia="0 kg*m^2")], **OUTLINE)
