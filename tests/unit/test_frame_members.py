"""Regular frames, the table of members, and refusals."""

import itertools
import math

import numpy as np
import pint
import pytest
from unit.frames import EXAMPLES, OUTLINE, REGULAR, UNEQUAL, core, tank

from rockframe.components import (
    FrameEquivalent,
    Member,
    RegularFrame,
    component_from_dict,
)
from rockframe.errors import ComponentError, RockframeError, UnitsError
from rockframe.units import Unit

pytestmark = pytest.mark.unit


# the regular frame --------------------------------------------------------------------------


def bounds(member):
    si = member.si
    return (
        si.x - si.width / 2.0,
        si.x + si.width / 2.0,
        si.y - si.height / 2.0,
        si.y + si.height / 2.0,
    )


def test_regular_frame_has_expected_members():
    frame = EXAMPLES["regular, all measures"]
    kinds = [member.kind for member in frame.members]
    assert {kind: kinds.count(kind) for kind in set(kinds)} == {
        "column": 4, "slab": 9, "beam": 12, "wall": 6,
    }  # fmt: skip
    by_name = {member.name: member for member in frame.members}
    assert len(by_name) == len(frame.members)
    assert bounds(by_name["column right back"]) == pytest.approx((1.75, 2.0, 0.0, 9.4))
    assert bounds(by_name["slab 2 middle"]) == pytest.approx((-1.75, 1.75, 6.3, 6.5))
    assert bounds(by_name["slab 2 left"]) == pytest.approx((-2.0, -1.75, 6.3, 6.5))
    assert bounds(by_name["beam 3 left"]) == pytest.approx((-2.0, -1.75, 9.1, 9.2))
    assert bounds(by_name["beam 3 front"]) == pytest.approx((-1.75, 1.75, 9.1, 9.2))
    assert bounds(by_name["wall 2 back"]) == pytest.approx((-1.75, 1.75, 3.5, 6.2))
    depths = {name: by_name[name].si.depth for name in by_name if "2" in name or "column" in name}
    assert depths["column left front"] == pytest.approx(0.4)
    assert depths["slab 2 middle"] == pytest.approx(6.1)
    assert depths["slab 2 left"] == pytest.approx(6.1 - 0.8)
    assert depths["beam 2 front"] == pytest.approx(0.25)
    assert depths["beam 2 right"] == pytest.approx(6.1 - 0.8)
    assert depths["wall 2 front"] == pytest.approx(0.2)
    assert frame.height.m_as("m") == pytest.approx(9.4)


def test_regular_frame_volume_matches_hand_calculation():
    frame = EXAMPLES["regular"]
    clear = 4.0 - 2 * 0.25
    columns = 4 * 0.25**2 * 9.0
    slab = (4.0**2 - 4 * 0.25**2) * 0.12
    beams = 4 * clear * (0.30 - 0.12) * 0.25
    walls = 2 * clear * (3.0 - 0.30) * 0.15
    volume = columns + 3 * (slab + beams + walls)
    assert frame.mass.m_as("kg") == pytest.approx(2500.0 * volume, rel=1e-14)
    assert frame.space_proportion == pytest.approx(volume / 144.0, rel=1e-14)


def test_no_two_members_of_a_regular_frame_overlap():
    def occupied(member):
        # perpendicular to the plane: positions of members of this kind and side
        front = {"front": -1.0, "back": 1.0}.get(member.name.split()[-1], 0.0)
        half = member.si.depth / 2.0
        middle = front * (2.0 - half)
        return (*bounds(member), middle - half, middle + half)

    boxes = [occupied(member) for member in EXAMPLES["regular"].members]
    for first, second in itertools.combinations(boxes, 2):
        overlaps = [min(first[k + 1], second[k + 1]) - max(first[k], second[k]) for k in (0, 2, 4)]
        assert min(overlaps) < 1e-9


def test_equal_storeys_may_be_listed_individually():
    equal = EXAMPLES["regular"]
    for heights in (["3 m"] * 3, "3 m; 300 cm; 3 m", pint.Quantity([3.0, 3.0, 3.0], "m")):
        listed = FrameEquivalent.from_members(**UNEQUAL, storey_heights=heights)
        assert listed.si == equal.si
        assert listed.members == equal.members
    one = RegularFrame(**UNEQUAL, storey_heights=pint.Quantity(4.0, "m"))
    assert one.storeys == 1
    assert "storey_heights" not in one.parameters()  # no single number that could be scaled
    assert len([member for member in one.members if member.kind == "wall"]) == 2


def test_plan_and_columns_default_to_square():
    explicit = FrameEquivalent.from_members(**REGULAR, depth="4 m", column_depth="0.25 m")
    assert explicit == EXAMPLES["regular"]
    thick = FrameEquivalent.from_members(
        **REGULAR, slab_thickness="12 cm", infill_thickness="0.15 m"
    )
    assert thick == EXAMPLES["regular"]


def test_density_changes_the_mass_and_not_the_shape_factor():
    lighter = FrameEquivalent.from_members(**{**REGULAR, "density": "1800 kg/m^3"})
    assert lighter.shape_factor == pytest.approx(EXAMPLES["regular"].shape_factor, rel=1e-14)
    assert lighter.mass.m_as("kg") == pytest.approx(
        0.72 * EXAMPLES["regular"].mass.m_as("kg"), rel=1e-14
    )


def test_regular_frame_may_lack_walls_and_beams():
    flat = RegularFrame(**{**REGULAR, "beam_height": "0.12 m"}, infill_thickness=None)
    assert {member.kind for member in flat.members} == {"column", "slab"}
    assert flat == RegularFrame(**{**REGULAR, "beam_height": "0.12 m"}, infill_thickness="none")


def test_a_regular_frame_can_be_added_to():
    regular = RegularFrame(**REGULAR)
    more = FrameEquivalent.from_members(
        [*regular.members, tank(inertia="0 kg*m^2")],
        width=regular.width,
        height=regular.height,
        depth=regular.depth,
    )
    assert more.mass.m_as("kg") == pytest.approx(46787.5, rel=1e-14)
    assert regular.storeys == 3
    assert regular.density.m_as("kg/m^3") == 2500.0


# the table ----------------------------------------------------------------------------------


def test_the_table_of_members(tmp_path):
    import xarray as xr

    frame = EXAMPLES["regular"]
    table = frame.members_table()
    assert table.sizes == {"member": 31}
    wall = table.sel(member="wall 3 front")
    expected = {
        "mass": 2500.0 * 3.5 * 2.7 * 0.15,
        "volume": 3.5 * 2.7 * 0.15,
        "x": 0.0,
        "y": 7.35,
        "width": 3.5,
        "height": 2.7,
        "depth": 0.15,
        "inertia": 2500.0 * 3.5 * 2.7 * 0.15 * (3.5**2 + 2.7**2) / 12.0,
        "distance": 2.85,
        "inertia_about_middle": 2500.0 * 3.5 * 2.7 * 0.15 * ((3.5**2 + 2.7**2) / 12.0 + 2.85**2),
    }
    for name, value in expected.items():
        assert float(wall[name]) == pytest.approx(value, rel=1e-12, abs=1e-12), name
        pint.Unit(table[name].attrs["units"])
        assert table[name].attrs["long_name"]
        assert table[name].dtype == np.float64
    assert set(table.data_vars) == set(expected)
    assert set(table.coords) == {"member", "kind"}
    assert table.y.attrs["units"] == Unit.METRE
    assert table.volume.attrs["units"] == "m^3"
    assert float(table.mass.sum()) == pytest.approx(table.attrs["mass"])
    assert table.attrs["shape_factor"] == frame.shape_factor
    assert table.attrs["space_proportion"] == frame.space_proportion
    assert table.groupby("kind").sum().mass.sel(kind="column") == pytest.approx(5625.0)
    table.to_netcdf(tmp_path / "members.nc")
    with xr.open_dataset(tmp_path / "members.nc") as again:
        assert again.identical(table)


def test_members_table_marks_unknown_values():
    table = EXAMPLES["members"].members_table()
    assert "space_proportion" not in table.attrs
    assert "depth" not in table.attrs
    row = table.sel(member="tank")
    assert all(math.isnan(row[name]) for name in ("volume", "width", "height", "depth"))
    assert row.kind == ""
    assert float(row.inertia) == 800.0


# refusals ----------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"name": ""}, "name must be a text"),
        ({"name": 3}, "name must be a text"),
        ({"kind": " "}, "kind must be a text"),
        ({"mass": None}, "give mass or density, exactly one; got depth, height, width"),
        ({"density": "2500 kg/m^3"}, "give mass or density, exactly one"),
        ({"mass": None, "density": "2500 kg/m^3", "depth": None}, "density needs width, height"),
        ({"width": None}, "give width and height, or inertia"),
        ({"inertia": "3 kg*m^2"}, "give width and height, or inertia"),
        ({"width": None, "height": None}, "give width and height, or inertia"),
        ({"width": None, "height": None, "inertia": "3 kg*m^2"}, "depth goes with"),
        ({"mass": "0 kg"}, "mass must be greater than zero"),
        ({"mass": "-1 t"}, "mass must be greater than zero"),
        ({"width": "0 m"}, "width must be greater than zero"),
        ({"height": "-1 m"}, "height must be greater than zero"),
        ({"depth": "0 m"}, "depth must be greater than zero"),
        ({"x": "nan m"}, "x must be finite"),
        ({"width": "1e200 m"}, "floating-point numbers"),
    ],
)
def test_a_faulty_member_is_refused(changes, words):
    with pytest.raises(ComponentError, match=words) as caught:
        core(**changes)
    assert "Member" in str(caught.value)


@pytest.mark.parametrize("name", ["mass", "x", "y", "width", "height", "depth", "inertia"])
def test_a_member_needs_units(name):
    change = {name: 3.0}
    if name == "inertia":
        change |= {"width": None, "height": None, "depth": None}
    with pytest.raises(UnitsError, match=f"{name} needs"):
        core(**change)


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"storeys": 0}, "storeys must be a whole number from 1 to 1000, got '0'"),
        ({"storeys": -3}, "storeys must be a whole number"),
        ({"storeys": 2.5}, "storeys must be a whole number"),
        ({"storeys": 1e300}, "storeys must be a whole number"),
        ({"storeys": math.nan}, "storeys must be finite"),
        ({"width": "-4 m"}, "width must be greater than zero"),
        ({"depth": "0 m"}, "depth must be greater than zero"),
        ({"height": "-9 m"}, "height must be greater than zero"),
        ({"density": "0 kg/m^3"}, "density must be greater than zero"),
        ({"column_width": "2 m", "beam_width": "0.2 m"}, "column_width must be less than half"),
        ({"column_depth": "2.5 m"}, "column_depth must be less than half the depth, got 2.5 m"),
        ({"beam_height": "0.10 m"}, r"beam_height must be slab_thickness \(0.12 m\) or more"),
        ({"slab_thickness": "0.31 m"}, r"slab_thickness \(0.31 m\) or more, .* got 0.3 m"),
        ({"beam_height": "3 m"}, "beam_height must be less than the lowest storey's height"),
        ({"beam_width": "0.26 m"}, "beam_width must be the column's width and depth"),
        ({"infill_thickness": "2.1 m"}, "infill_thickness must be half the depth or less"),
        ({"infill_thickness": "0 m"}, "greater than zero, or None for no walls"),
        ({"slab_thickness": "0 m"}, "slab_thickness must be greater than zero"),
        ({"storey_heights": ["3 m"]}, "storey_heights determines storeys and height"),
        ({"storeys": None, "height": None, "storey_heights": []}, "storey_heights is empty"),
        (
            {"storeys": None, "height": None, "storey_heights": ["3 m", "0 m"]},
            r"storey_heights\[1\] must be greater than zero",
        ),
        (
            {"storeys": None, "height": None, "storey_heights": ["3 m", "0.2 m"]},
            r"lowest storey's height \(0.2 m\)",
        ),
        ({"storeys": None, "height": None, "storey_heights": ["1e308 m"] * 2}, "finite"),
        ({"density": None}, "give members, or the dimensions .* density is missing"),
        ({"storeys": None, "beam_width": None}, "storeys, beam_width are missing"),
        ({"height": None}, "height is missing"),
    ],
)
def test_a_faulty_regular_frame_is_refused(changes, words):
    with pytest.raises(ComponentError, match=words):
        FrameEquivalent.from_members(**{**REGULAR, **changes})


@pytest.mark.parametrize("name", [name for name in REGULAR if name != "storeys"])
def test_regular_frame_dimensions_need_units(name):
    with pytest.raises(UnitsError, match=f"{name} needs"):
        FrameEquivalent.from_members(**{**REGULAR, name: 0.25})


def test_regular_frame_requires_complete_arguments():
    with pytest.raises(ComponentError, match="give storeys and height, or storey_heights"):
        RegularFrame(**UNEQUAL)
    with pytest.raises(UnitsError, match=r"storey_heights\[0\] needs a length"):
        RegularFrame(**UNEQUAL, storey_heights=3)
    with pytest.raises(UnitsError, match="storeys needs a pure ratio"):
        RegularFrame(**{**REGULAR, "storeys": True})
    with pytest.raises(TypeError, match=r"missing 5 required .* 'width', 'column_width'"):
        RegularFrame(storeys=3)


@pytest.mark.parametrize(
    ("members", "words"),
    [
        ([], "members is empty"),
        ([core(), core()], "different names, got twice: core"),
        ([core(x="1.1 m")], "'core' reaches from x = 0.1 m to 2.1 m, beyond the building"),
        ([core(x="-1.1 m")], "reaches from x = -2.1 m"),
        ([core(y="5.1 m")], "reaches from y = 0.1 m to 10.1 m"),
        ([core(y="4.9 m")], "reaches from y = -0.1 m"),
        ([tank(x="2.1 m")], "beyond the building, which extends from -2 m to 2 m"),
        ([core(depth="6 m")], "depth of 6 m, more than the building's 5 m"),
        ([tank(inertia="25000 kg*m^2")], "at most 24750 kg m"),
        (
            [core(width="4 m", depth="5 m"), core(name="overlap", depth="5 m")],
            "together fill 1.5 times the building",
        ),
        ([tank(x="0 m", y="5 m", inertia="0 kg*m^2")], "all mass is in the middle"),
        (core(), "must be a list of Member"),
        ("core", "must be a list of Member"),
        (3, "must be a list of Member"),
        ([3], r"members\[0\] must be a Member or a mapping"),
        ([core(), {"name": "x"}], r"members\[1\] does not describe a Member"),
        ([{**tank().to_dict(), "colour": "red"}], "unexpected keyword argument 'colour'"),
        ([tank(mass="1e308 kg"), tank(mass="1e308 kg", name="other")], "mass must be finite"),
    ],
)
def test_members_that_make_no_building_are_refused(members, words):
    with pytest.raises(ComponentError, match=words):
        FrameEquivalent.from_members(members, **OUTLINE, depth="5 m")


def test_members_and_regular_frame_dimensions_are_mutually_exclusive():
    with pytest.raises(ComponentError, match="members or storeys, density, not both"):
        FrameEquivalent.from_members([core()], **OUTLINE, storeys=3, density="2500 kg/m^3")
    with pytest.raises(ComponentError, match="members or slab_thickness, infill_thickness"):
        FrameEquivalent.from_members(
            [core()], **OUTLINE, slab_thickness="0.2 m", infill_thickness=pint.Quantity("0.2 m")
        )
    with pytest.raises(ComponentError, match="need the height"):
        FrameEquivalent.from_members([core()], width="4 m")
    with pytest.raises(UnitsError, match="width needs a length"):
        FrameEquivalent.from_members([core()], width=4, height="10 m")
    with pytest.raises(TypeError, match=r"missing 1 required .* 'width'"):
        FrameEquivalent.from_members([core()], height="10 m")


@pytest.mark.parametrize("members", ["[{", 3.0, "{}", "[3]", '[{"name": "x"}]'])
def test_a_damaged_description_is_refused(members):
    description = {"type": "FrameEquivalent", "width": "4 m", "height": "9 m", "members": members}
    with pytest.raises(RockframeError, match="members"):
        component_from_dict(description)


@pytest.mark.parametrize(
    ("size", "words"),
    [
        ("1e200 m", "out of the range"), ("1e308 m", "out of the range"),
        ("1e-200 m", "out of the range"), ("5e-324 m", "is not the size of a building"),
        ("1e150 m", None), ("1e-150 m", None),
    ],
)  # fmt: skip
@pytest.mark.parametrize("depth", [None, "size"])
def test_extreme_sizes_are_refused_or_give_finite_properties(size, words, depth):
    sizes = {"width": size, "height": size, "depth": depth and size}
    point = Member(name="a", mass="1 kg", x="0 m", y="0 m", inertia="0 kg*m^2")
    with pytest.raises(ComponentError, match=r"in one point|is not the size of a building"):
        FrameEquivalent.from_members([point], **sizes)
    sheet = {"name": "b", "mass": "1 kg", "x": "0 m", "y": f"{float(size.split()[0]) / 2!r} m",
             "width": size, "height": size}  # fmt: skip
    if words is not None:
        with pytest.raises(ComponentError, match=words):
            FrameEquivalent.from_members([sheet], **sizes)
    else:
        frame = FrameEquivalent.from_members([sheet], **sizes)
        assert frame.shape_factor == pytest.approx(3.0, rel=1e-12)
        assert 0.0 < frame.si.inertia < math.inf
