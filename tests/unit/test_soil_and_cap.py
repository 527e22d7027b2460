"""Soil and cap as values: contents, refusals, representations."""

import json
import math

import pint
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from overdamping import overdamped

import rockframe as rf
from rockframe.components import component_from_dict
from rockframe.errors import AssemblyError, ComponentError, RockframeError, UnitsError

pytestmark = pytest.mark.unit

SOIL = {"stiffness": "9 MPa", "damping_ratio": 0.2}
CAP = {"height": "0.9 m", "mass": "36 t"}


# values ------------------------------------------------------------------------------------------

_size = st.floats(1e-3, 1e9)


@overdamped
@given(_size, _size, st.floats(0.0, 10.0), st.sampled_from(["displacement", "pressure"]))
@settings(max_examples=100, deadline=None)
def test_soil_survives_json_round_trip_exactly(stiffness, damping, ratio, separation):
    for soil in (
        rf.WinklerSoil(
            stiffness=f"{stiffness!r} kN/m^2", damping=f"{damping!r} Pa*s", separation=separation
        ),
        rf.WinklerSoil(
            stiffness=f"{stiffness!r} Pa", damping_ratio=ratio, separation=separation
        ),
    ):  # fmt: skip
        again = component_from_dict(json.loads(json.dumps(soil.to_dict())))
        assert again.si == soil.si
        assert again == soil
    assert soil.si.stiffness == stiffness
    assert soil.si.damping_ratio == ratio
    assert str(soil.separation) == separation


@given(st.floats(0.0, 1e3), st.floats(0.0, 1e9), st.none() | st.floats(1e-3, 1e3))
@settings(max_examples=100, deadline=None)
def test_cap_survives_json_round_trip_exactly(height, mass, width):
    wide = None if width is None else f"{width!r} m"
    cap = rf.CushionCap(height=f"{height!r} m", mass=f"{mass!r} kg", width=wide)
    assert (cap.si.height, cap.si.mass, cap.si.width) == (height, mass, width)
    again = component_from_dict(json.loads(json.dumps(cap.to_dict())))
    assert again.si == cap.si
    assert again == cap


def test_equivalent_units_give_equal_values():
    for text in ("9 MPa", "9e6 N/m^2", "9000 kN/m^2", "9 N/mm^2", "9e6 kg/m/s^2"):
        soil = rf.WinklerSoil(stiffness=text, damping_ratio="20 %")
        assert soil.si.stiffness == pytest.approx(9e6, rel=1e-15)
        assert soil.si.damping_ratio == pytest.approx(0.2, rel=1e-15)
    for text in ("400 kPa*s", "400 kN*s/m^2", "0.4 N*s/mm^2"):
        soil = rf.WinklerSoil(stiffness="9 MPa", damping=text)
        assert soil.si.damping == pytest.approx(4e5, rel=1e-14)
    unit = pint.get_application_registry()
    assert rf.WinklerSoil(stiffness=9.0 * unit.megapascal, damping_ratio=0.2) == rf.WinklerSoil(
        **SOIL
    )
    cap = rf.CushionCap(height="900 mm", mass="36e3 kg", width=500.0 * unit.centimetre)
    assert cap.si == rf.CushionCap(**CAP, width="5 m").si


def test_subgrade_modulus_is_multiplied_by_depth():
    soil = rf.WinklerSoil.from_subgrade_modulus(
        "20 MN/m^3", depth="400 cm", damping="80 kPa*s", separation="pressure"
    )
    assert soil.si.stiffness == pytest.approx(8e7, rel=1e-15)
    assert soil.si.damping == 8e4
    assert soil.si.damping_ratio is None
    assert str(soil.separation) == "pressure"
    assert isinstance(soil, rf.WinklerSoil)
    for text in ("20 kPa/mm", "20e3 kN/m^3", "20 N/cm^3"):
        other = rf.WinklerSoil.from_subgrade_modulus(text, depth="4 m", damping_ratio=0.2)
        assert other.si.stiffness == pytest.approx(8e7, rel=1e-14)


def test_separation_defaults_to_displacement():
    assert rf.WinklerSoil(**SOIL).separation == "displacement"
    assert rf.WinklerSoil(**SOIL) == rf.WinklerSoil(**SOIL, separation="displacement")
    assert "separation" not in repr(rf.WinklerSoil(**SOIL))
    pulling = rf.WinklerSoil(**SOIL, separation="pressure")
    assert pulling.separation == "pressure"
    assert rf.WinklerSoil(**SOIL, separation=pulling.separation) == pulling
    assert "separation='pressure'" in repr(pulling)


def test_cap_width_defaults_to_block_width():
    block = rf.Block(width="2.4 m", height="9.6 m", mass="50 t")
    soil = rf.WinklerSoil(**SOIL)
    own = rf.System(block, rf.CushionCap(**CAP), soil)
    explicit = rf.System(block, rf.CushionCap(**CAP, width="2.4 m"), soil)
    assert own.equilibrium().drop_attrs().identical(explicit.equilibrium().drop_attrs())
    wider = rf.System(block, rf.CushionCap(**CAP, width="3 m"), soil)
    assert wider.equilibrium().soil_settlement < own.equilibrium().soil_settlement


def test_mass_and_inertia_of_a_solid_cap():
    by_mass = rf.CushionCap(height="0.9 m", mass="45 t", width="5 m").si
    by_density = rf.CushionCap(height="0.9 m", density="2.5 t/m^3", depth="4 m").si
    assert by_density.mass_at(5.0) == pytest.approx(45e3, rel=1e-15)
    assert by_density.mass_at(2.0) == pytest.approx(18e3, rel=1e-15)
    assert by_mass.mass_at(2.0) == 45e3
    for cap in (by_mass, by_density):
        inertia = 45e3 * (5.0**2 + 0.9**2) / 12.0
        assert cap.inertia_at(5.0) == pytest.approx(inertia, rel=1e-14)


# refusals -----------------------------------------------------------------------------


@pytest.mark.parametrize("bad", ["9 MN/m", "9e6 N/m", "9 MN/m^3", "9 N", "9 kg/m^2", "9 m", "9"])
def test_stiffness_of_wrong_dimension_is_refused(bad):
    with pytest.raises(UnitsError, match="stiffness needs") as caught:
        rf.WinklerSoil(stiffness=bad, damping_ratio=0.2)
    assert repr(bad) in str(caught.value)
    assert "per length of base" in str(caught.value)
    assert "Pa" in str(caught.value)


@pytest.mark.parametrize("bad", ["80 kN*s/m", "400 kPa", "400 kPa/s", "400 kN*s/m^3", "400"])
def test_damping_of_wrong_dimension_is_refused(bad):
    with pytest.raises(UnitsError, match="damping needs") as caught:
        rf.WinklerSoil(stiffness="9 MPa", damping=bad)
    assert repr(bad) in str(caught.value)


@pytest.mark.parametrize("bad", ["20 MPa", "20 MN/m^2", "20 MN/m", "20 MN/m^4", "20"])
def test_subgrade_modulus_of_wrong_dimension_is_refused(bad):
    with pytest.raises(UnitsError, match="modulus needs"):
        rf.WinklerSoil.from_subgrade_modulus(bad, depth="4 m", damping_ratio=0.2)


def test_bare_numbers_are_refused_by_name():
    with pytest.raises(UnitsError, match=r"stiffness needs.*9000000"):
        rf.WinklerSoil(stiffness=9_000_000, damping_ratio=0.2)
    with pytest.raises(UnitsError, match="damping needs"):
        rf.WinklerSoil(stiffness="9 MPa", damping=4e5)
    with pytest.raises(UnitsError, match="depth needs"):
        rf.WinklerSoil.from_subgrade_modulus("20 MN/m^3", depth=4.0, damping_ratio=0.2)
    sizes = {"height": "0.9 m", "density": "2500 kg/m^3", "depth": "4 m", "width": "5 m"}
    for name in sizes:
        with pytest.raises(UnitsError, match=f"{name} needs"):
            rf.CushionCap(**{**sizes, name: 3.0})
    with pytest.raises(UnitsError, match="mass needs"):
        rf.CushionCap(height="0.9 m", mass=36_000)
    with pytest.raises(UnitsError, match="damping_ratio"):
        rf.WinklerSoil(stiffness="9 MPa", damping_ratio="0.2 m")
    for bad in (True, None, [0.2], "much"):
        words = "damping_ratio needs a pure ratio" if bad is not None else "neither was given"
        with pytest.raises(RockframeError, match=words):
            rf.WinklerSoil(stiffness="9 MPa", damping_ratio=bad)


@pytest.mark.parametrize(
    ("name", "bad"),
    [
        ("stiffness", "0 MPa"),
        ("stiffness", "-9 MPa"),
        ("stiffness", "nan MPa"),
        ("stiffness", "inf Pa"),
        ("damping_ratio", -0.1),
        ("damping_ratio", math.nan),
        ("damping_ratio", math.inf),
    ],
)
def test_soil_out_of_range_is_refused(name, bad):
    with pytest.raises(ComponentError, match=name) as caught:
        rf.WinklerSoil(**{**SOIL, name: bad})
    assert "WinklerSoil" in str(caught.value)


def test_soil_damping_depth_and_modulus_out_of_range_are_refused():
    for bad in ("-1 kPa*s", "nan kPa*s", "inf Pa*s"):
        with pytest.raises(ComponentError, match="damping"):
            rf.WinklerSoil(stiffness="9 MPa", damping=bad)
    for arguments in ({"depth": "0 m"}, {"depth": "-4 m"}, {"depth": "nan m"}):
        with pytest.raises(ComponentError, match="depth"):
            rf.WinklerSoil.from_subgrade_modulus("20 MN/m^3", **arguments, damping_ratio=0.2)
    for modulus in ("0 MN/m^3", "-20 MN/m^3"):
        with pytest.raises(ComponentError, match="modulus"):
            rf.WinklerSoil.from_subgrade_modulus(modulus, depth="4 m", damping_ratio=0.2)
    rf.WinklerSoil(stiffness="9 MPa", damping="0 Pa*s")


@pytest.mark.parametrize(
    ("name", "bad"),
    [
        ("height", "-0.1 m"),
        ("height", "nan m"),
        ("mass", "-1 kg"),
        ("mass", "inf t"),
        ("width", "0 m"),
        ("width", "-5 m"),
    ],
)
def test_a_cap_out_of_range_is_refused(name, bad):
    with pytest.raises(ComponentError, match=name) as caught:
        rf.CushionCap(**{**CAP, name: bad})
    assert "CushionCap" in str(caught.value)


def test_cap_with_nonpositive_density_or_depth_is_refused():
    sizes = {"height": "0.9 m", "density": "2500 kg/m^3", "depth": "4 m"}
    for name, bad in (("density", "0 kg/m^3"), ("density", "-1 t/m^3"), ("depth", "0 m")):
        with pytest.raises(ComponentError, match=name):
            rf.CushionCap(**{**sizes, name: bad})


def test_conflicting_or_incomplete_arguments_are_refused():
    for arguments, words in (
        ({}, "damping or damping_ratio; neither"),
        ({"damping": "4 kPa*s", "damping_ratio": 0.1}, "damping or damping_ratio; both"),
    ):
        with pytest.raises(ComponentError, match=words):
            rf.WinklerSoil(stiffness="9 MPa", **arguments)
    for arguments, words in (
        ({}, "mass or density; neither"),
        ({"mass": "1 t", "density": "2 t/m^3", "depth": "1 m"}, "mass or density; both"),
        ({"density": "2 t/m^3"}, "only density was given"),
        ({"mass": "1 t", "depth": "1 m"}, "only depth was given"),
        ({"depth": "1 m"}, "neither"),
    ):
        with pytest.raises(ComponentError, match=words):
            rf.CushionCap(height="0.9 m", **arguments)


@pytest.mark.parametrize("bad", ["", "Pressure", "force", None, True, 1, []])
def test_other_rules_of_separation_are_refused(bad):
    with pytest.raises(ComponentError, match="'displacement' or 'pressure'") as caught:
        rf.WinklerSoil(**SOIL, separation=bad)
    assert repr(bad) in str(caught.value)


def test_arguments_are_keyword_only_and_required():
    with pytest.raises(TypeError):
        rf.WinklerSoil("9 MPa", 0.2)
    with pytest.raises(TypeError):
        rf.WinklerSoil(damping_ratio=0.2)
    with pytest.raises(TypeError):
        rf.CushionCap("0.9 m", "36 t")
    with pytest.raises(TypeError):
        rf.CushionCap(mass="36 t")
    with pytest.raises(TypeError):
        rf.WinklerSoil.from_subgrade_modulus("20 MN/m^3", damping_ratio=0.2)
    for missing in (None, [], object()):
        with pytest.raises(UnitsError, match="stiffness"):
            rf.WinklerSoil(stiffness=missing, damping_ratio=0.2)
        with pytest.raises(UnitsError, match="height"):
            rf.CushionCap(height=missing, mass="1 t")


@pytest.mark.filterwarnings("ignore::rockframe.errors.ModelWarning")
@pytest.mark.parametrize(
    ("size", "refused"),
    [
        ("1e308 m", ("high", "wide", "dense")), ("1e200 m", ("high", "wide", "dense")),
        ("1e140 m", ("wide", "dense")), ("1e100 m", ("dense",)), ("1e-200 m", ("wide",)),
    ],
)  # fmt: skip
def test_extreme_caps_are_refused_or_give_finite_statics(size, refused):
    block = rf.Block(width="2.4 m", height="9.6 m", mass="50 t")
    soil = rf.WinklerSoil(**SOIL)
    for kind, arguments in {
        "high": {"height": size, "mass": "1 t"},
        "wide": {"height": "1 m", "mass": "1 t", "width": size},
        "dense": {"height": size, "density": "1e200 kg/m^3", "depth": "1 m"},
    }.items():
        cap = rf.CushionCap(**arguments)
        if kind in refused:
            words = r"numbers cannot hold|is 1e-200 m wide, narrower"
            with pytest.raises(AssemblyError, match=words):
                rf.System(block, cap, soil)
            continue
        rest = rf.System(block, cap, soil).equilibrium()
        for name in ("soil_settlement", "static_soil_reaction", "overturning_angle"):
            assert math.isfinite(rest[name].item()), name
            assert rest[name].item() > 0.0, name


def test_block_and_cap_combine_mass_centre_and_inertia():
    """Sum over point masses with the mass, the centre and the inertia of each part."""
    block = rf.Block(width="2 m", height="6 m", mass="30 t", centre_of_mass=("2.5 m", "0.2 m"))
    cap = rf.CushionCap(height="0.8 m", mass="20 t", width="3 m")
    body = rf.System(block, cap, rf.WinklerSoil(**SOIL)).assembly.setting.body
    points = []
    for mass, x, y, inertia in (
        (30e3, 0.2, 0.8 + 2.5, block.inertia.m_as("kg m^2")),
        (20e3, 0.0, 0.4, 20e3 * (3.0**2 + 0.8**2) / 12.0),
    ):
        r = math.sqrt(inertia / mass)
        points += [(0.5 * mass, x - r, y), (0.5 * mass, x + r, y)]
    total = sum(mass for mass, _, _ in points)
    x, y = (sum(each[0] * each[k] for each in points) / total for k in (1, 2))
    inertia = sum(m * ((px - x) ** 2 + (py - y) ** 2) for m, px, py in points)
    assert body.mass == pytest.approx(total, rel=1e-14)
    assert body.half_width == pytest.approx(1.5, rel=1e-14)
    assert body.eccentricity == pytest.approx(x, rel=1e-12)
    assert body.centre_height == pytest.approx(y, rel=1e-12)
    assert body.inertia == pytest.approx(inertia, rel=1e-12)
    assert body.shape_factor == pytest.approx(total * (1.5**2 + y**2) / inertia, rel=1e-12)
