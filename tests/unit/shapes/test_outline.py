"""Bodies from outlines: closed forms, numerical integration, symmetries, invalid arguments."""

import json
import math
import warnings

import numpy as np
import pint
import pytest
import xarray as xr
from hypothesis import assume, given, settings
from hypothesis import strategies as st

import rockframe as rf
from rockframe.components import component_from_dict
from rockframe.errors import ComponentError, ModelWarning, UnitsError

pytestmark = pytest.mark.unit

RECTANGLE = [(0.0, 0.0), (2.0, 0.0), (2.0, 8.0), (0.0, 8.0)]
L_SHAPE = [(0.0, 0.0), (1.0, 0.0), (1.0, 3.0), (0.4, 3.0), (0.4, 4.0), (0.0, 4.0)]
# two legs, the left one wider, and a crossbeam over both
PORTAL = [
    (0.0, 0.0), (0.5, 0.0), (0.5, 2.0), (1.1, 2.0), (1.1, 0.0), (1.4, 0.0),
    (1.4, 2.0), (1.5, 2.0), (1.5, 3.0), (-0.1, 3.0), (-0.1, 2.0), (0.0, 2.0),
]  # fmt: skip
PORTAL_PARTS = [  # x, y of a lower left corner, width, height
    (0.0, 0.0, 0.5, 2.0), (1.1, 0.0, 0.3, 2.0), (-0.1, 2.0, 1.6, 1.0),
]  # fmt: skip


def outline(points, **changes):
    return rf.Block.from_outline((points, "m"), **{"mass": "1 t", **changes})


def numbers(block):
    si = block.si
    return [si.width, si.height, si.mass, si.centre_height, si.eccentricity, si.inertia]


# closed forms ---------------------------------------------------------------------------------


def test_a_rectangle_is_the_block_of_its_size():
    block = rf.Block(width="2 m", height="8 m", mass="40 t")
    for by_mass in (True, False):
        properties = {"mass": "40 t"} if by_mass else {"density": "2500 kg/m^3", "depth": "1 m"}
        rectangle = rf.Block.from_outline((RECTANGLE, "m"), **properties)
        assert numbers(rectangle) == pytest.approx(numbers(block), rel=4e-16, abs=0.0)
        assert rectangle.shape_factor == pytest.approx(3.0, rel=1e-15)
        assert rectangle.si.eccentricity == 0.0
        assert rectangle.overturning_angle == block.overturning_angle


def test_a_triangle():
    # right angle at the left end of the base; known: centroid at thirds, I = m (w^2 + h^2)/18
    block = outline([(0.0, 0.0), (1.2, 0.0), (0.0, 3.0)])
    assert numbers(block) == pytest.approx(
        [1.2, 3.0, 1e3, 1.0, 0.4 - 0.6, 1e3 * (1.2**2 + 3.0**2) / 18.0], rel=1e-14
    )


def test_a_trapezium():
    a, b, h = 1.4, 0.6, 3.0  # symmetric; lower width, upper width, height
    block = outline([(-0.7, 0.0), (0.7, 0.0), (0.3, 3.0), (-0.3, 3.0)])
    up = h * (a + 2.0 * b) / (3.0 * (a + b))
    # second moments of area about the centroid, over the area
    about_level = h**2 * (a * a + 4.0 * a * b + b * b) / (18.0 * (a + b) ** 2)
    about_axis = (a * a + b * b) / 24.0
    assert numbers(block) == pytest.approx(
        [1.4, 3.0, 1e3, up, 0.0, 1e3 * (about_level + about_axis)], rel=1e-14
    )


def test_an_l_shape_is_two_rectangles():
    block = outline(L_SHAPE, mass=None, density="2000 kg/m^3", depth="0.5 m")
    lower, upper = 2e3 * 0.5 * 3.0, 2e3 * 0.5 * 0.4  # masses
    mass = lower + upper
    x = (lower * 0.5 + upper * 0.2) / mass
    y = (lower * 1.5 + upper * 3.5) / mass
    inertia = lower * ((1.0 + 9.0) / 12.0 + (0.5 - x) ** 2 + (1.5 - y) ** 2)
    inertia += upper * ((0.16 + 1.0) / 12.0 + (0.2 - x) ** 2 + (3.5 - y) ** 2)
    assert numbers(block) == pytest.approx([1.0, 4.0, mass, y, x - 0.5, inertia], rel=1e-14)


def test_a_body_on_two_feet_stands_on_their_outer_ends():
    block = outline(PORTAL)
    assert block.si.width == pytest.approx(1.4, rel=1e-15)
    areas = np.array([w * h for _, _, w, h in PORTAL_PARTS])
    centres = np.array([(x + 0.5 * w, y + 0.5 * h) for x, y, w, h in PORTAL_PARTS])
    middle = areas @ centres / areas.sum()
    assert block.si.eccentricity == pytest.approx(middle[0] - 0.7, rel=1e-13)
    assert block.si.centre_height == pytest.approx(middle[1], rel=1e-14)


def test_polygonal_disc_converges_to_closed_form():
    # closed form of the polygon: m R^2/6 (2 + cos(2 pi/n)); its limit is m R^2/2
    for count in (16, 64, 1024):
        turn = 2.0 * math.pi * (np.arange(count) + 0.5) / count  # its lowest edge is horizontal
        points = np.column_stack([np.sin(turn), -np.cos(turn)])
        disc = {"outline": (points, "m"), "mass": "1 kg", "at": ("0 m", "1 m")}
        body = rf.Block.from_parts({"disc": disc}, base=("-0.9 m", "0.9 m"))
        exact = (2.0 + math.cos(2.0 * math.pi / count)) / 6.0
        assert body.si.inertia == pytest.approx(exact, rel=1e-13)
        assert body.si.inertia == pytest.approx(0.5, rel=7.0 / count**2)


@st.composite
def stars(draw):
    """Draw a simple polygon on a horizontal base, with corners in the order of their directions."""
    count = draw(st.integers(3, 12))
    width = draw(st.floats(0.5, 3.0))
    reach = draw(st.lists(st.floats(0.5, 2.0), min_size=count, max_size=count))
    turn = np.pi * (0.1 + 0.8 * np.arange(count) / (count - 1))
    over = np.column_stack([np.cos(turn), np.sin(turn)]) * np.array(reach)[:, None] * width
    left, right = [-0.5 * width, 0.0], [0.5 * width, 0.0]
    return np.array([left, right, *np.add(over, [0.0, 0.2 * width])])


def by_brute_force(points, cells=400):
    """Return the centroid and the mean square distance from it, by sums over a grid of points."""
    low, high = points.min(axis=0), points.max(axis=0)
    x, y = (low[k] + (high[k] - low[k]) * (np.arange(cells) + 0.5) / cells for k in (0, 1))
    x, y = np.meshgrid(x, y)
    inside = np.zeros(x.shape, dtype=bool)
    for (x1, y1), (x2, y2) in zip(points, np.roll(points, -1, axis=0), strict=True):
        between = (y1 > y) != (y2 > y)
        with np.errstate(divide="ignore", invalid="ignore"):
            inside ^= between & (x < x1 + (x2 - x1) * (y - y1) / (y2 - y1))
    x, y = x[inside], y[inside]
    area = inside.mean() * np.prod(high - low)
    return area, x.mean(), y.mean(), x.var() + y.var()


def block_or_none(points, **properties):
    """Make a body, or return None if it is refused because it would fall."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ModelWarning)
        try:
            return rf.Block.from_outline((points, "m"), **properties)
        except ComponentError as error:
            if "fall on its own" in str(error):
                return None
            raise


@given(stars())
@settings(max_examples=60, deadline=None)
def test_random_outlines_agree_with_brute_force(points):
    block = block_or_none(points, density="1000 kg/m^3", depth="1 m")
    assume(block is not None)
    area, x, y, square = by_brute_force(points)
    size = np.ptp(points, axis=0).max()
    si = block.si
    assert si.mass == pytest.approx(1e3 * area, rel=0.02)
    assert si.eccentricity == pytest.approx(x, abs=0.004 * size)
    assert si.centre_height == pytest.approx(y, abs=0.004 * size)
    assert si.inertia / si.mass == pytest.approx(square, rel=0.02)


def test_brute_force_tends_to_the_exact_inertia():
    points = np.array(L_SHAPE)
    exact = outline(L_SHAPE).si
    # edges fall between the cells
    _, _, _, square = by_brute_force(points, cells=1000)
    assert exact.inertia / exact.mass == pytest.approx(square, rel=1e-5)


# invariance -----------------------------------------------------------------------------------


@given(stars(), st.integers(0, 20))
@settings(max_examples=100, deadline=None)
def test_starting_point_and_direction_do_not_matter(points, start):
    block = block_or_none(points, mass="1 t")
    assume(block is not None)
    for other in (np.roll(points, start, axis=0), np.roll(points, start, axis=0)[::-1]):
        assert block_or_none(other, mass="1 t") == block  # to the last bit
    closed = np.vstack([points, points[:1]])
    assert block_or_none(closed, mass="1 t") == block
    doubled = np.repeat(points, 2, axis=0)
    assert block_or_none(doubled, mass="1 t") == block


@given(stars())
@settings(max_examples=100, deadline=None)
def test_the_mirror_image_has_its_centre_of_mass_on_the_other_side(points):
    block, mirror = (block_or_none(points * [sign, 1.0], mass="1 t") for sign in (1.0, -1.0))
    assert (block is None) == (mirror is None)
    assume(block is not None)
    assert mirror.si.eccentricity == pytest.approx(-block.si.eccentricity, rel=1e-12, abs=1e-13)
    for one, other in zip(numbers(mirror), numbers(block), strict=True):
        assert abs(one) == pytest.approx(abs(other), rel=1e-13, abs=1e-13)
    assert mirror.si.left == pytest.approx(block.si.right, rel=1e-12)


def test_origin_and_unit_do_not_matter():
    block = outline(L_SHAPE)
    far = outline(np.add(L_SHAPE, [1000.0, -500.0]))
    assert numbers(far) == pytest.approx(numbers(block), rel=1e-11)
    small = rf.Block.from_outline((np.array(L_SHAPE) * 1e3, "mm"), mass="1 t")
    assert numbers(small) == pytest.approx(numbers(block), rel=1e-14)


def test_points_accept_equivalent_forms():
    written = [(f"{x} m", f"{y} m") for x, y in L_SHAPE]
    forms = [
        written,
        tuple(written),
        (pair for pair in written),
        [(pint.Quantity(x, "m"), f"{1e3 * y!r} mm") for x, y in L_SHAPE],
        pint.Quantity(np.array(L_SHAPE), "m"),
        list(pint.Quantity(np.array(L_SHAPE), "m")),
        (np.array(L_SHAPE), "m"),
        (L_SHAPE, "m"),
    ]
    for points in forms:
        assert rf.Block.from_outline(points, mass="1 t") == outline(L_SHAPE)


# an ordinary block ----------------------------------------------------------------------------


def test_outline_gives_ordinary_block():
    block = outline(L_SHAPE)
    assert type(block) is rf.Block
    rebuilt = component_from_dict(json.loads(json.dumps(block.to_dict())))
    assert rebuilt == block
    assert rebuilt.si == block.si
    assert eval(repr(block), {"Block": rf.Block}) == block  # noqa: S307
    heavier = block.replace(mass="2 t", inertia=2 * block.inertia)
    assert heavier.shape_factor == pytest.approx(block.shape_factor, rel=1e-15)
    assert heavier.centre_of_mass == block.centre_of_mass


def test_a_class_derived_from_block_builds_its_own():
    class Statue(rf.Block):
        """A statue."""

    assert type(Statue.from_outline((RECTANGLE, "m"), mass="1 t")) is Statue


# overhanging parts ----------------------------------------------------------------------------


def overhanging(height, reach=0.5):
    """Return a block of 1 m by 4 m with a shelf to the right, at a height."""
    points = [(0.0, 0.0), (1.0, 0.0), (1.0, height), (1.0 + reach, height)]
    points += [(1.0 + reach, height + 0.01), (1.0, height + 0.01), (1.0, 4.0), (0.0, 4.0)]
    return points


def test_corner_that_touches_before_overturning_warns():
    with pytest.warns(ModelWarning, match=r"leaning to the right, points\[3\], at \(1.5 m, 0.1"):
        block = outline(overhanging(0.1))
    with pytest.warns(ModelWarning, match=r"at 0\.1974 rad, .* 0\.24\d* rad") as caught:
        outline(overhanging(0.1))
    assert len(caught) == 1
    assert caught[0].filename == __file__
    assert math.atan2(0.1, 0.5) == pytest.approx(0.1974, abs=5e-5)
    assert component_from_dict(block.to_dict()) == block  # no warning
    mirrored = np.array(overhanging(0.1)) * [-1.0, 1.0]
    with pytest.warns(ModelWarning, match=r"leaning to the left, points\[3\], at \(-1.5 m"):
        outline(mirrored)
    # at the limit, the shelf touches the ground at the overturning angle
    limit = math.tan(math.atan2(block.si.right, block.si.centre_height)) * 0.5
    outline(overhanging(1.02 * limit))
    with pytest.warns(ModelWarning, match="touches"):
        outline(overhanging(0.98 * limit))


# invalid arguments ----------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("points", "words"),
    [
        ([], "pairs of lengths"),
        ([(0, 0)] * 4, "three different points or more, got 0"),
        ([(0, 0), (1, 0)], "three different points or more, got 2"),
        ([(0, 0), (1, 0), (1, 0), (0, 0)], "three different points or more, got 2"),
        ([(0, 0), (1, 0), (2, 0)], "no area: all its points lie on one line"),
        ([(0, 0), (0.1, 0.7), (0.3, 2.1)], "no area"),
        ([(0, 0), (1, 2), (1, 0), (0, 2)], r"its edge from points\[0\] .* to points\[1\] .* meets"),
        (
            [(0, 0), (1, 0), (1, 3), (0.5, 3), (0.5, -1), (0.4, 3), (0, 3)],
            "crosses or touches itself",
        ),
        ([(0, 0), (1, 0), (1, 3), (0.5, 0), (0, 3)], "crosses or touches itself"),
        (
            [(0, 0), (1, 0), (1, 3), (1, 4), (1, 3.5), (0, 3)],
            r"turns back on itself at points\[3\]",
        ),
        (
            [(0, 0), (1, 0.02), (1, 3), (0, 3)],
            r"stands on one point, points\[0\] \(0 m, 0 m\); the next lowest, points\[1\] "
            r"\(1 m, 0.02 m\), is 0.02 m higher.* inclined by 1.146°",
        ),
        ([(0, 0), (1, 1), (0, 3), (-1, 1.5)], r"next lowest, points\[1\].*is 1 m higher"),
        (
            [(0, 0), (1, 0.5), (0.8, 3), (0.2, 3), (0.4, 2), (-1, 0.3)],
            r"next lowest, points\[5\]",
        ),
        (
            [(0, 0), (1, 0), (3, 4), (2, 4)],
            r"fall on its own: its centre of mass, at x = 1.5 m, .* from 0 m to 1 m",
        ),
        ([(0, 0), (1, 0), (math.nan, 3)], "not finite"),
        ([(0, 0), (1, math.inf), (0, 3)], "not finite"),
        ([(0, 0, 0), (1, 0, 0), (1, 3, 0)], r"shape \(n, 2\) .*; got shape \(3, 3\)"),
        ([0, 1, 2], r"got shape \(3,\)"),
        ([(0, 0), (1,)], "pairs of lengths"),
        ([("a", "b")], "pairs of lengths"),
    ],
)
def test_invalid_outlines_are_refused(points, words):
    with pytest.raises(ComponentError, match=words) as caught:
        outline(points)
    assert str(caught.value).startswith("Block")


def test_single_lowest_point_is_not_reported_as_inclined_edge():
    with pytest.raises(ComponentError, match=r"one height$"):
        outline([(0, 0), (1, 2), (0.6, 1), (0.9, 0.1), (2, 3), (-1, 3)])


def test_heights_are_compared_up_to_rounding():
    for rise, refused in ((1e-10, False), (1e-7, True)):
        points = [(0.0, rise), (2.0, 0.0), (2.0, 8.0), (0.0, 8.0)]
        if refused:
            with pytest.raises(ComponentError, match="stands on one point"):
                outline(points)
            continue
        assert outline(points).si.width == 2.0


@pytest.mark.parametrize(
    ("points", "words"),
    [
        (RECTANGLE, r"with their unit, \(points, 'm'\); got .*, bare numbers"),
        ([(0.0, 0.0), ("2 m", "0 m")], r"points\[0\]\[0\] needs a length with a unit, got 0.0"),
        (np.array(RECTANGLE), "bare numbers"),
        ([("0 m", "0 s")], r"points\[0\]\[1\] needs a length"),
        ((RECTANGLE, "kg"), "points needs a length"),
        (pint.Quantity(np.array(RECTANGLE), "s"), "points needs a length"),
    ],
)
def test_points_need_units_of_length(points, words):
    with pytest.raises(UnitsError, match=words):
        rf.Block.from_outline(points, mass="1 t")


@pytest.mark.parametrize("points", ["0 m", 3, None, {"x": "1 m"}, ["0 m", "1 m"], [("0 m",)]])
def test_points_must_be_pairs(points):
    with pytest.raises(ComponentError, match=r"points(\[0\])? needs"):
        rf.Block.from_outline(points, mass="1 t")


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ({}, "give mass or density; neither was given"),
        ({"mass": "1 t", "density": "2 t/m^3", "depth": "1 m"}, "both were given"),
        ({"density": "2 t/m^3"}, "density and depth go together; only density was given"),
        ({"mass": "0 t"}, "mass must be greater than zero"),
        ({"density": "-1 t/m^3", "depth": "1 m"}, "density must be greater"),
        ({"density": "1 t/m^3", "depth": "0 m"}, "depth must be greater"),
        ({"mass": "1 t", "depth": "1 m"}, "go together"),
        ({"density": "1e300 kg/m^3", "depth": "1e300 m"}, "a mass of inf"),
    ],
)
def test_outline_needs_either_mass_or_density(arguments, words):
    with pytest.raises(ComponentError, match=words) as caught:
        rf.Block.from_outline((RECTANGLE, "m"), **arguments)
    assert str(caught.value).startswith("Block.from_outline")


def test_contradicting_units_of_points_are_refused():
    points = xr.DataArray(np.array([[0, 0], [500, 0], [500, 2000], [0, 2000.0]]))
    points.attrs["units"] = "mm"
    assert rf.Block.from_outline(points, unit="mm", mass="1 t").si.width == pytest.approx(0.5)
    with pytest.raises(UnitsError, match="points has the unit 'mm', but 'm'"):
        rf.Block.from_outline(points, unit="m", mass="1 t")
