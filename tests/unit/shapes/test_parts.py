"""Bodies composed of parts: parallel-axis theorem, base, invalid arguments."""

import json

import numpy as np
import pytest

import rockframe as rf
from rockframe.components import component_from_dict
from rockframe.errors import ComponentError, ModelWarning, UnitsError

pytestmark = pytest.mark.unit

CASE = {"width": "0.8 m", "height": "1.9 m", "mass": "40 kg"}
BOOKS = {"width": "0.4 m", "height": "0.3 m", "mass": "25 kg", "at": ("0.15 m", "1.5 m")}
CLOCK = {"mass": "5 kg", "at": ("-0.3 m", "1.9 m")}
L_SHAPE = [(0.0, 0.0), (1.0, 0.0), (1.0, 3.0), (0.4, 3.0), (0.4, 4.0), (0.0, 4.0)]


def numbers(block):
    si = block.si
    return [si.width, si.height, si.mass, si.centre_height, si.eccentricity, si.inertia]


def summed(masses):
    """Return mass, centre and inertia of several (mass, x, y, inertia), by moments about zero."""
    m, x, y, own = np.array(masses).T
    total = m.sum()
    centre = (m @ x / total, m @ y / total)
    about_zero = (own + m * (x * x + y * y)).sum()
    return total, *centre, about_zero - total * (centre[0] ** 2 + centre[1] ** 2)


def test_a_bookcase_by_the_parallel_axis_theorem():
    block = rf.Block.from_parts({"case": CASE, "books": BOOKS, "clock": CLOCK})
    mass, x, y, inertia = summed([
        (40.0, 0.0, 0.95, 40.0 * (0.64 + 3.61) / 12.0),
        (25.0, 0.15, 1.65, 25.0 * (0.16 + 0.09) / 12.0),
        (5.0, -0.3, 1.9, 0.0),
    ])  # fmt: skip
    assert numbers(block) == pytest.approx([0.8, 1.9, mass, y, x, inertia], rel=1e-14)
    rebuilt = component_from_dict(json.loads(json.dumps(block.to_dict())))
    assert rebuilt == block
    assert rebuilt.si == block.si


def test_one_part_is_the_body_itself():
    properties = {"width": "2 m", "height": "8 m", "mass": "40 t"}
    block = rf.Block(**properties)
    assert numbers(rf.Block.from_parts({"all": properties})) == pytest.approx(
        numbers(block), rel=4e-16
    )
    body = rf.Block.from_parts({"all": {"body": block}})
    assert numbers(body) == pytest.approx(numbers(block), rel=4e-16)
    outline = rf.Block.from_outline((L_SHAPE, "m"), mass="1 t")
    same = rf.Block.from_parts({"all": {"outline": (L_SHAPE, "m"), "mass": "1 t"}})
    assert numbers(same) == pytest.approx(numbers(outline), rel=1e-15)
    cylinder = rf.Block.cylinder(diameter="1 m", height="3 m", mass="1 t")
    moved = rf.Block.from_parts({"all": {"body": cylinder, "at": ("7 m", "0 m")}})
    assert numbers(moved) == pytest.approx(numbers(cylinder), rel=1e-14)


def test_an_outline_is_the_sum_of_its_rectangles():
    density = {"density": "2000 kg/m^3", "depth": "0.5 m"}
    body = rf.Block.from_outline((L_SHAPE, "m"), **density)
    parts = rf.Block.from_parts(
        {
            "lower": {"width": "1 m", "height": "3 m", "at": ("0.5 m", "0 m"), **density},
            "upper": {"width": "0.4 m", "height": "1 m", "at": ("0.2 m", "3 m"), **density},
        }
    )
    assert numbers(parts) == pytest.approx(numbers(body), rel=1e-14)


def test_a_statue_on_its_pedestal():
    statue = rf.Block.from_outline((L_SHAPE, "m"), mass="1 t")
    pedestal = {"width": "1.6 m", "height": "1 m", "mass": "3 t"}
    block = rf.Block.from_parts(
        {
            "pedestal": pedestal,
            "statue": {"body": statue, "at": ("0.1 m", "1 m")},
        }
    )
    si = statue.si
    mass, x, y, inertia = summed(
        [
            (3e3, 0.0, 0.5, 3e3 * (1.6**2 + 1.0) / 12.0),
            (1e3, 0.1 + si.eccentricity, 1.0 + si.centre_height, si.inertia),
        ]
    )
    assert numbers(block) == pytest.approx([1.6, 5.0, mass, y, x, inertia], rel=1e-13)
    # the origin of the outline is the lower left corner of the statue
    placed = {"outline": (L_SHAPE, "m"), "mass": "1 t", "at": ("-0.4 m", "1 m")}
    same = rf.Block.from_parts({"pedestal": pedestal, "statue": placed})
    assert numbers(same) == pytest.approx(numbers(block), rel=1e-13)


def test_point_masses_and_part_with_inertia_are_summed():
    table = {
        "left": {"mass": "1 kg", "at": ("-0.2 m", "1 m")},
        "right": {"mass": "1 kg", "at": ("0.2 m", "1 m")},
        "top": {"mass": "2 kg", "at": ("0 m", "2 m"), "inertia": "0.5 kg*m^2"},
    }
    block = rf.Block.from_parts(table, base=("-0.3 m", "0.5 m"))
    assert numbers(block) == pytest.approx(
        [0.8, 2.0, 4.0, 1.5, -0.1, 0.5 + 4 * 0.25 + 2 * 0.04], rel=1e-14
    )


def test_order_does_not_matter_and_mirroring_flips_eccentricity():
    parts = {"case": CASE, "books": BOOKS, "clock": CLOCK}
    block = rf.Block.from_parts(parts)
    turned = rf.Block.from_parts(dict(reversed(parts.items())))
    assert numbers(turned) == pytest.approx(numbers(block), rel=1e-15)
    mirrored = {
        name: {**part, "at": (f"{-float(part['at'][0].split()[0])} m", part["at"][1])}
        for name, part in parts.items()
        if "at" in part
    }
    other = rf.Block.from_parts({"case": CASE, **mirrored})
    expected = numbers(block)
    expected[4] = -expected[4]
    assert numbers(other) == expected


def test_base_spans_parts_on_ground():
    leg = {"width": "0.1 m", "height": "1 m", "mass": "2 kg"}
    legs = {
        "left leg": {**leg, "at": ("-0.4 m", "0 m")},
        "right leg": {**leg, "at": ("0.3 m", "0 m")},
    }
    top = {"width": "1 m", "height": "0.4 m", "mass": "20 kg", "at": ("0 m", "1 m")}
    block = rf.Block.from_parts({**legs, "top": top})
    assert block.si.width == pytest.approx(0.8, rel=1e-15)
    assert block.si.eccentricity == pytest.approx(-0.2 / 24.0 + 0.05, rel=1e-13)
    explicit = rf.Block.from_parts({"top": top}, base=("-0.45 m", "0.35 m"))
    assert explicit.si.width == pytest.approx(0.8, rel=1e-15)
    assert explicit.si.centre_height == 1.2
    # feet wider than the body above them
    wide = rf.Block.from_parts({"case": CASE}, base=("-0.5 m", "0.5 m"))
    assert (wide.si.width, wide.si.eccentricity) == (1.0, 0.0)


def test_low_overhanging_part_warns():
    def drawer(height):
        return {"width": "1.2 m", "height": "0.1 m", "mass": "1 kg", "at": ("0.3 m", height)}

    rf.Block.from_parts({"case": CASE, "drawer": drawer("0.6 m")})
    with pytest.warns(ModelWarning, match="to the right, a corner of part 'drawer'") as caught:
        rf.Block.from_parts({"case": CASE, "drawer": drawer("0.02 m")})
    assert len(caught) == 1
    assert caught[0].filename == __file__


@pytest.mark.parametrize(
    ("parts", "words"),
    [
        ({}, "parts needs a mapping from names to parts"),
        ([CASE], "parts needs a mapping from names to parts"),
        ("case", "parts needs a mapping"),
        ({"case": "big"}, "part 'case' needs a mapping"),
        ({"case": rf.Block(**CASE)}, "part 'case' needs a mapping"),
        ({"case": {}}, "part 'case' needs width and height, .*; got nothing"),
        ({"case": {"depth": "1 m"}}, "part 'case' needs width and height, .*; got 'depth'"),
        ({"case": {**CASE, "colour": "red"}}, "part 'case' has 'colour'.*'width'.*width, height"),
        ({"case": {**CASE, "inertia": "1 kg*m^2"}}, "part 'case' has 'inertia'"),
        ({"case": {"width": "1 m", "mass": "1 kg"}}, "part 'case' .*height is missing"),
        ({"case": {"height": "1 m", "mass": "1 kg"}}, "part 'case' .*width is missing"),
        ({"case": {"width": "1 m", "height": "2 m"}}, "part 'case': give mass or density"),
        ({"case": {**CASE, "width": "0 m"}}, "part 'case': width must be greater than zero"),
        ({"case": CASE, "clock": {**CLOCK, "mass": "0 kg"}}, "part 'clock': mass must be"),
        ({"case": CASE, "clock": {**CLOCK, "at": "1 m"}}, "part 'clock': at needs two lengths"),
        ({"case": CASE, "clock": {**CLOCK, "at": ("1 m",)}}, "part 'clock': at needs two lengths"),
        ({"case": CASE, "a": {"body": 3}}, "part 'a' needs a Block as its body, got 3"),
        ({"case": CASE, "a": {"body": rf.RigidGround()}}, "part 'a' needs a Block"),
        (
            {"case": CASE, "a": {"outline": [("0 m", "0 m")], "mass": "1 kg"}},
            "part 'a': an outline needs three",
        ),
        ({"books": BOOKS}, "no part stands on the ground.* 'books', is 1.5 m above .* base="),
        ({"clock": {"mass": "1 kg"}}, "no part stands on the ground"),
        ({"case": {**CASE, "at": ("0 m", "-0.1 m")}}, "part 'case' reaches 0.1 m below the ground"),
        (
            {"a": {"outline": ([(0, 0), (1, 2), (-1, 2)], "m"), "mass": "1 kg"}},
            "the parts stand on one point, at x = 0 m",
        ),
        ({"case": CASE, "books": {**BOOKS, "at": ("2 m", "1 m")}}, "would fall on its own"),
    ],
)
def test_invalid_parts_are_refused(parts, words):
    with pytest.raises(ComponentError, match=words):
        rf.Block.from_parts(parts)


@pytest.mark.parametrize(
    ("base", "words"),
    [
        (("0.4 m", "-0.4 m"), "needs the left end, then the right end"),
        (("-0.4 m", "0.3 m"), "part 'case' stands on the ground at x = 0.4 m, beyond the base"),
        ("0.8 m", "base needs two lengths"),
    ],
)
def test_a_faulty_base_is_refused(base, words):
    with pytest.raises(ComponentError, match=words):
        rf.Block.from_parts({"case": CASE}, base=base)


def test_all_mass_in_one_point_is_refused():
    with pytest.raises(ComponentError, match="all mass is in one point"):
        rf.Block.from_parts({"ball": CLOCK}, base=("-1 m", "1 m"))


def test_parts_need_units():
    for part, words in (
        ({**CASE, "width": 0.8}, "part 'case': width needs a length"),
        ({**CASE, "mass": "40 N"}, "part 'case': mass needs a mass"),
        ({**CASE, "at": (0, 0)}, r"part 'case': at\[0\] needs a length"),
    ):
        with pytest.raises(UnitsError, match=words):
            rf.Block.from_parts({"case": part})


def test_overhanging_body_may_exceed_rectangle_inertia():
    mushroom = rf.Block.from_parts(
        {"cap": {"width": "3 m", "height": "0.1 m", "mass": "50 kg", "at": ("0 m", "1 m")}},
        base=("-0.3 m", "0.3 m"),
    )
    with pytest.warns(ModelWarning, match="not physical"):
        assert rf.Block(**{k: v for k, v in mushroom.to_dict().items() if k != "type"}) == mushroom
