"""Components as values: contents, refusals, representations."""

import copy
import inspect
import itertools
import json
import math
import pickle
from typing import ClassVar

import numpy as np
import pint
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from overdamping import overdamped
from unit import frames

import rockframe as rf
from rockframe.components import Link, PointLink, component_from_dict
from rockframe.components.registry import registered_classes
from rockframe.errors import AssemblyError, ComponentError, ModelWarning, SchemaError, UnitsError

pytestmark = pytest.mark.unit

SIZE = {"width": "2 m", "height": "8 m", "mass": "50 t"}
PADS = {"frequency_ratio": 20, "damping_ratio": 0.1}
SOIL = {"stiffness": "9 MPa", "damping_ratio": 0.2}
CAP = {"height": "0.9 m", "mass": "36 t"}


def examples():
    return {
        "block": rf.Block(**SIZE),
        "block with shape factor": rf.Block(**SIZE, shape_factor=1.153),
        "block with inertia": rf.Block(**SIZE, inertia="283333.3 kg*m^2"),
        "pads by ratios": rf.TwoSpringSupport(**PADS),
        "pads by constants": rf.TwoSpringSupport(
            stiffness="12 MN/m", damping="80 kN*s/m", restitution=0.7
        ),
        "pads mixed": rf.TwoSpringSupport(stiffness="12 MN/m", damping_ratio=0),
        "ground": rf.RigidGround(),
        "ground with restitution": rf.RigidGround(restitution=0.9),
        "initial state at rest": rf.InitialState(),
        "initial state": rf.InitialState(
            rotation="5 deg",
            angular_velocity="-0.1 rad/s",
            vertical_displacement="0 mm",
            vertical_velocity="1 mm/s",
        ),
        "soil": rf.WinklerSoil(**SOIL),
        "soil with a damping constant": rf.WinklerSoil(stiffness="9 MPa", damping="400 kN*s/m^2"),
        "soil without damping": rf.WinklerSoil(stiffness="9 MPa", damping_ratio=0),
        "soil that lets go by pressure": rf.WinklerSoil(**SOIL, separation="pressure"),
        "soil from a subgrade modulus": rf.WinklerSoil.from_subgrade_modulus(
            "20 MN/m^3", depth="4 m", damping_ratio=0.2
        ),
        "cap": rf.CushionCap(**CAP),
        "cap with a width": rf.CushionCap(**CAP, width="5 m"),
        "cap from its density": rf.CushionCap(
            height="0.9 m", density="2500 kg/m^3", depth="4 m", width="5 m"
        ),
        "cap from its density, as wide as the building": rf.CushionCap(
            height="0.9 m", density="2500 kg/m^3", depth="4 m"
        ),
        "plate": rf.CushionCap(height="0 m", mass="0 kg"),
        **frames.examples(),
    }


EXAMPLES = examples()


@pytest.fixture(params=list(EXAMPLES))
def name(request):
    return request.param


@pytest.fixture
def component(name):
    return EXAMPLES[name]


class TestEveryComponent:
    def test_it_is_immutable(self, component):
        before = repr(component)
        public = [word for word in dir(component) if not word.startswith("__")]
        for attribute in [*public, "brand_new"]:
            with pytest.raises(AttributeError):
                setattr(component, attribute, 1.0)
            with pytest.raises(AttributeError):
                delattr(component, attribute)
        with pytest.raises(AttributeError):
            setattr(component.si, next(iter(vars(component.si))), 0.1)
        assert repr(component) == before

    def test_to_dict_result_is_independent(self, component):
        description = component.to_dict()
        description.clear()
        assert component == copy.deepcopy(component)
        assert component.to_dict()["type"] == type(component).__name__

    def test_equals_only_identical_components(self, name, component):
        assert component == examples()[name]
        assert hash(component) == hash(examples()[name])
        others = [other for key, other in EXAMPLES.items() if key != name]
        assert all(component != other for other in others)
        assert component != component.to_dict()
        assert component != repr(component)
        assert component is not None
        assert len({component, examples()[name], *others}) == len(EXAMPLES)

    @pytest.mark.parametrize("protocol", range(pickle.HIGHEST_PROTOCOL + 1))
    def test_it_survives_pickling(self, component, protocol):
        again = pickle.loads(pickle.dumps(component, protocol))  # noqa: S301
        assert type(again) is type(component)
        assert again == component
        assert again.si == component.si
        with pytest.raises(AttributeError):
            again.si = None

    def test_it_survives_copying(self, component):
        assert copy.copy(component) == component
        assert copy.deepcopy(component).si == component.si

    def test_survives_json_round_trip_exactly(self, component):
        description = component.to_dict()
        assert all(isinstance(value, str | float) for value in description.values())
        text = json.dumps(description, allow_nan=False)
        again = component_from_dict(json.loads(text))
        assert again == component
        assert again.si == component.si
        assert json.dumps(again.to_dict()) == text

    def test_from_dict_refuses_another_type(self, component):
        kind = type(component)
        description = component.to_dict()
        assert kind.from_dict(description) == component
        assert kind.from_dict({k: v for k, v in description.items() if k != "type"}) == component
        other = {**component.to_dict(), "type": "Cupboard"}
        words = f"{kind.__name__}.from_dict: .* a component of type 'Cupboard'"
        with pytest.raises(ComponentError, match=words):
            kind.from_dict(other)

    def test_repr_evaluates_to_an_equal_component(self, component):
        space = {kind.__name__: kind for kind in (type(component),)}
        assert eval(repr(component), space) == component  # noqa: S307

    def test_has_noun_and_docstring(self, component):
        assert component.noun
        assert type(component).__doc__


POINTS = {"on": ("-1 m", "3 m"), "to": ("-2 m", "3 m")}
REPLACEABLE = (
    *(one for name, one in EXAMPLES.items() if name not in frames.EXAMPLES),
    rf.Block(**SIZE, centre_of_mass=("3 m", "5 cm")),
    rf.FrameEquivalent(**SIZE, shape_factor=2.5),
    rf.CushionCap(height="1 m", mass="5 t"),
    rf.WinklerSoil(stiffness="9 MPa", damping_ratio=0.1, friction=0.5),
    rf.RearWall(side="right", stiffness="2 MN/m", damping="1 kN*s/m", gap="5 mm", height="3 m"),
    rf.Restrainer(**POINTS, stiffness="2 MN/m", slack="5 mm", strength="20 kN", name="upper"),
    rf.Tendon(stiffness="5 MN/m", preload="200 kN", at="0.1 m", depth="1 m"),
    rf.Load(at=("0 m", "3 m"), vertical="1 kN", horizontal="2 kN"),
    rf.Member(name="x", mass="1 t", x="0 m", y="2 m", width="1 m", height="1 m"),
    rf.RegularFrame(
        storeys=3, width="4 m", height="9 m", column_width="0.4 m", beam_height="0.4 m",
        beam_width="0.3 m", density="2500 kg/m^3",
    ),
    rf.RockingFrame(rf.Block(**SIZE), columns=3, beam_mass="9 t", spacing="6 m"),
    rf.Stack(rf.Block(**SIZE), rf.Block(**SIZE).replace(width="3 m"),
             interfaces=[rf.RigidGround()], offsets=["2 cm"]),
)  # fmt: skip


def test_every_component_class_is_tested():
    own = {
        kind
        for kind in registered_classes().values()
        if kind.__module__.startswith("rockframe.components")
    }
    assert own - {Link, PointLink} == {type(one) for one in REPLACEABLE}


@pytest.mark.parametrize("component", REPLACEABLE, ids=lambda one: type(one).__name__)
def test_replace_accepts_own_property_values(component):
    for name in inspect.signature(type(component)).parameters:
        value = getattr(component, name)
        if value is not None:
            again = getattr(component.replace(**{name: value}), name)
            if isinstance(value, pint.Quantity):  # derived quantities may lose a digit
                np.testing.assert_allclose(again.magnitude, value.magnitude, rtol=1e-14)
                again, value = again.units, value.units
            assert repr(again) == repr(value)


# text representations ----------------------------------------------------------------

_size = st.floats(1e-3, 1e4)
_ratio = st.floats(1e-3, 1e3)


@given(_size, st.floats(1.01, 100.0), st.floats(1e-6, 1e12), st.none() | st.floats(3.0, 4.0))
@settings(max_examples=200, deadline=None)
def test_block_survives_json_round_trip_exactly(width, slenderness, mass, shape_factor):
    height = width * slenderness
    block = rf.Block(
        width=f"{width!r} m", height=f"{height!r} m", mass=f"{mass!r} kg", shape_factor=shape_factor
    )
    assert (block.si.width, block.si.height, block.si.mass) == (width, height, mass)
    again = component_from_dict(json.loads(json.dumps(block.to_dict())))
    assert again.si == block.si
    assert again == block


@overdamped
@given(_ratio, _ratio, st.none() | st.floats(1e-9, 1.0))
@settings(max_examples=100, deadline=None)
def test_pads_survive_json_round_trip_exactly(first, second, restitution):
    for pads in (
        rf.TwoSpringSupport(frequency_ratio=first, damping_ratio=second, restitution=restitution),
        rf.TwoSpringSupport(
            stiffness=f"{first!r} kN/mm", damping=f"{second!r} kN*s/m", restitution=restitution
        ),
    ):
        again = component_from_dict(json.loads(json.dumps(pads.to_dict())))
        assert again.si == pads.si
        assert again == pads


@given(
    st.none() | st.floats(-1.5, 1.5),
    st.none() | st.floats(-1e3, 1e3),
    st.none() | st.floats(-1e3, 1e3),
)
@settings(max_examples=100, deadline=None)
def test_initial_state_survives_json_round_trip_exactly(rotation, rate, height):
    state = rf.InitialState(
        rotation=None if rotation is None else f"{rotation!r} rad",
        angular_velocity=None if rate is None else f"{rate!r} rad/s",
        vertical_displacement=None if height is None else f"{height!r} m",
    )
    again = component_from_dict(json.loads(json.dumps(state.to_dict())))
    assert again.si == state.si
    assert again == state


@pytest.mark.parametrize(
    ("description", "words"),
    [
        ({}, "None; expected"),
        ({"type": None}, "None; expected"),
        ({"type": "Brick", "width": "2 m"}, "'Brick'; was 'Block' meant"),
        ({"type": 3}, "3; expected"),
        ({"type": ["Block"]}, r"\['Block'\]; was 'Block' meant"),
    ],
)
def test_unknown_component_description_is_refused(description, words):
    with pytest.raises(SchemaError, match=f"^found a component of type {words}"):
        component_from_dict(description)


# the block -------------------------------------------------------------------------------


def test_properties_are_quantities_with_units():
    block = rf.Block(**SIZE)
    expected = {
        "width": (2.0, "m"),
        "height": (8.0, "m"),
        "mass": (5e4, "kg"),
        "radius": (math.sqrt(17.0), "m"),
        "overturning_angle": (math.atan(0.25), "rad"),
        "inertia": (5e4 * (4.0 + 64.0) / 12.0, "kg m^2"),
        "frequency": (math.sqrt(0.75 * 9.80665 / math.sqrt(17.0)), "rad s^-1"),
    }
    for name, (value, unit) in expected.items():
        quantity = getattr(block, name)
        assert isinstance(quantity, pint.Quantity), name
        assert quantity.units == pint.get_application_registry().Unit(unit), name
        assert quantity.magnitude == pytest.approx(value, rel=1e-15), name
    assert block.overturning_angle.to("deg").magnitude == pytest.approx(14.036243467926477)
    assert block.slenderness == 4.0
    assert block.shape_factor == 3.0
    assert block.maximum_restitution == pytest.approx(1.0 - 1.5 / 17.0, rel=1e-15)


def test_arguments_are_keyword_only_and_required():
    with pytest.raises(TypeError):
        rf.Block("2 m", "8 m", "50 t")
    for name in SIZE:
        with pytest.raises(TypeError):
            rf.Block(**{key: value for key, value in SIZE.items() if key != name})
        with pytest.raises(UnitsError, match=f"{name} needs"):
            rf.Block(**{**SIZE, name: None})


@given(st.floats(0.5, 20.0), st.floats(0.75, 10.0))
@settings(max_examples=100, deadline=None)
def test_shape_factor_and_inertia_are_equivalent(width, slenderness):
    size = {"width": f"{width!r} m", "height": f"{width * slenderness!r} m", "mass": "50 t"}
    by_factor = rf.Block(**size, shape_factor=2.9)
    by_inertia = rf.Block(**size, inertia=by_factor.inertia)
    assert by_inertia.shape_factor == pytest.approx(2.9, rel=1e-14)
    assert by_inertia.frequency.magnitude == pytest.approx(by_factor.frequency.magnitude)
    solid = rf.Block(**size)
    assert solid.inertia.magnitude == pytest.approx(
        5e4 * width**2 * (1.0 + slenderness**2) / 12.0, rel=1e-14
    )


def test_shape_factor_and_inertia_are_mutually_exclusive():
    with pytest.raises(ComponentError, match="shape_factor or inertia, not both"):
        rf.Block(**SIZE, shape_factor=3, inertia="3e5 kg*m^2")


@pytest.mark.parametrize("bad", [0, -1, math.nan, math.inf])
def test_a_shape_factor_must_be_a_positive_number(bad):
    with pytest.raises(ComponentError, match="shape_factor"):
        rf.Block(**SIZE, shape_factor=bad)


@pytest.mark.parametrize(
    ("arguments", "least", "possible"),
    [
        ({"shape_factor": 0.2}, "1 or more", 1),
        ({"inertia": "1e6 kg*m^2"}, "1 or more", "1250 kg*m^2"),
        # all mass in the corners: m [(b + e) (b - e) + h (H - h)]
        ({"shape_factor": 1.2, "centre_height": "1.2 m"}, "1.397 or more", 1.4),
        ({"inertia": "1161 kg*m^2", "eccentricity": "0.3 m"}, "1.078 or more", "1160 kg*m^2"),
    ],
)
def test_unphysical_inertia_warns_and_is_used(arguments, least, possible):
    size = {"width": "1 m", "height": "2 m", "mass": "1 t"}
    with pytest.warns(ModelWarning, match=rf"Block: .*not physical.*{least}") as caught:
        block = rf.Block(**size, **arguments)
    assert len(caught) == 1
    assert caught[0].filename == __file__
    assert "corner" not in str(caught[0].message)
    assert pickle.loads(pickle.dumps(block)) == block  # noqa: S301
    name = next(iter(arguments))
    rf.Block(**size, **arguments | {name: possible})


def test_inertia_about_a_corner_warns():
    size = {"width": "1 m", "height": "2 m", "mass": "1 t"}
    position = {"centre_height": "0.9 m", "eccentricity": "0.1 m"}
    for arguments in (
        {"inertia": "1666.67 kg*m^2"},
        {"shape_factor": 0.745},
        {"inertia": f"{1000 * (5 / 12 + 0.81 + 0.36)!r} kg*m^2", **position},
        {"inertia": f"{1000 * (5 / 12 + 0.81 + 0.16)!r} kg*m^2", **position},
    ):
        with pytest.warns(ModelWarning, match="not physical.*solid rectangle about a corner"):
            rf.Block(**size, **arguments)


DRUM = rf.Block.cylinder(diameter="0.5 m", height="2 m", mass="400 kg")


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"mass": "1 t"}, r"mass: inertia, 139.6 kg m\^2; give inertia or shape_factor, too"),
        ({"width": "0.6 m"}, "give inertia or shape_factor, too"),
        ({"height": "3 m"}, "and centre_height, 1 m; give inertia or shape_factor, and centre_"),
        ({"height": "3 m", "inertia": "309 kg*m^2"}, "mass: centre_height, 1 m; give centre_hei"),
        ({"height": "3 m", "shape_factor": 3.02}, "mass: centre_height, 1 m; give centre_height"),
    ],
)
def test_resizing_with_explicit_inertia_warns(changes, words):
    with pytest.warns(ModelWarning, match=f"Block.replace: .*{words}") as caught:
        changed = DRUM.replace(**changes)
    assert len(caught) == 1
    assert caught[0].filename == __file__
    gone = {"inertia": None} if "shape_factor" in changes else {}
    assert changed == rf.Block.from_dict(DRUM.to_dict() | changes | gone)


def test_resizing_with_new_or_scaled_inertia_does_not_warn():
    assert DRUM.replace(mass="1 t", inertia=DRUM.inertia).inertia == DRUM.inertia
    scaling = DRUM.replace(shape_factor=DRUM.shape_factor)
    for mass in (400.0, 1000.0):
        heavier = scaling.replace(mass=f"{mass!r} kg")
        assert heavier.si.inertia == pytest.approx(DRUM.si.inertia * mass / 400.0, rel=1e-14)
    DRUM.replace(height="3 m", inertia="309 kg*m^2", centre_of_mass=("1.5 m", "0 m"))
    DRUM.replace(centre_of_mass=("0.9 m", "0.01 m"))
    rf.Block(**SIZE, centre_height="3 m").replace(height="9 m", mass="60 t")
    frame = rf.FrameEquivalent(**SIZE, inertia="3e5 kg*m^2")
    with pytest.warns(ModelWarning, match=r"FrameEquivalent.replace: .*inertia, 3e\+05 kg m\^2"):
        frame.replace(mass="60 t")


def test_a_squat_block_is_refused_exactly_below_the_limit():
    limit = math.sqrt(0.5)
    for excess in (1e-9, 1e-12):
        rf.System(rf.Block(width="1 m", height=f"{limit * (1.0 + excess)!r} m", mass="1 t"))
        squat = rf.Block(width="1 m", height=f"{limit * (1.0 - excess)!r} m", mass="1 t")
        with pytest.raises(AssemblyError, match="cannot rock") as caught:
            rf.System(squat)
        assert "0.7071" in str(caught.value)
    for squat in (
        rf.Block.from_size(radius="1 m", slenderness=0.7, mass="1 t"),
        rf.Block.from_density(
            width="2 m", height="1 m", depth="1 m", density="2400 kg/m^3", shape_factor=3
        ),
    ):
        with pytest.raises(AssemblyError, match="cannot rock"):
            rf.System(squat)


@given(st.floats(0.05, 50.0), st.floats(0.05, 50.0))
@settings(max_examples=200, deadline=None)
def test_block_without_positive_maximum_restitution_is_refused(slenderness, mu):
    theta = math.atan(1.0 / slenderness)
    greatest = (1.0 + mu * math.cos(2.0 * theta)) / (1.0 + mu)
    size = {"width": "1 m", "height": f"{slenderness!r} m", "mass": "1 t", "shape_factor": mu}
    block = rf.Block.from_dict(size)  # below 1 the constructor warns
    assert block.maximum_restitution == pytest.approx(greatest, abs=1e-14)
    if greatest < -1e-12:
        with pytest.raises(AssemblyError, match="cannot rock"):
            rf.System(block)


def test_from_density_computes_mass():
    block = rf.Block.from_density(
        width="2 m", height="8 m", depth="150 cm", density="2.5 t/m^3", shape_factor=2.9
    )
    assert block.mass.m_as("kg") == pytest.approx(2.0 * 8.0 * 1.5 * 2500.0, rel=1e-15)
    assert block.shape_factor == 2.9
    for name in ("width", "height", "depth", "density"):
        size = {"width": "2 m", "height": "8 m", "depth": "1 m", "density": "2500 kg/m^3"}
        with pytest.raises(UnitsError, match=f"{name} needs"):
            rf.Block.from_density(**{**size, name: 2.0})
        with pytest.raises(ComponentError, match=f"{name} must be greater than zero"):
            rf.Block.from_density(**{**size, name: "0 " + size[name].split()[1]})


def test_slenderness_and_radius_change_independently():
    size = {"width": "1 m", "height": "4 m", "mass": "1 t"}
    for block in (rf.Block(**size), rf.Block(**size, centre_height="1 m", eccentricity="5 cm")):
        radius, slenderness = block.si.radius, block.slenderness
        slender = block.with_si({"slenderness": 5.0})
        assert slender.slenderness == pytest.approx(5.0, rel=1e-14)
        assert slender.si.radius == pytest.approx(radius, rel=1e-14)
        larger = block.with_si({"radius": 2.0 * radius})
        assert larger.slenderness == pytest.approx(slenderness, rel=1e-14)
        assert larger.si.radius == pytest.approx(2.0 * radius, rel=1e-14)
    with pytest.raises(ComponentError, match=r"radius must be larger than .* 1 m; got 0\.9 m"):
        block.with_si({"radius": 0.9})


@given(st.floats(0.05, 100.0), st.floats(0.75, 20.0))
@settings(max_examples=100, deadline=None)
def test_from_size_has_requested_radius_and_slenderness(radius, slenderness):
    block = rf.Block.from_size(radius=f"{radius!r} m", slenderness=slenderness, mass="50 t")
    assert block.radius.m_as("m") == pytest.approx(radius, rel=1e-14)
    assert block.slenderness == pytest.approx(slenderness, rel=1e-14)
    assert math.tan(block.overturning_angle.m_as("rad")) == pytest.approx(1.0 / slenderness)
    expected = math.sqrt(0.75 * 9.80665 / radius)
    assert block.frequency.m_as("rad/s") == pytest.approx(expected, rel=1e-14)


def test_from_size_refuses_invalid_arguments():
    size = {"radius": "5 m", "slenderness": 4, "mass": "50 t"}
    for name, bad, error in (
        ("radius", 5, UnitsError),
        ("radius", "5 rad", UnitsError),
        ("radius", "-5 m", ComponentError),
        ("slenderness", "4 m", UnitsError),
        ("slenderness", 0, ComponentError),
        ("slenderness", math.nan, ComponentError),
        ("mass", 50, UnitsError),
        ("mass", "0 t", ComponentError),
    ):
        with pytest.raises(error, match=name):
            rf.Block.from_size(**{**size, name: bad})


@pytest.mark.parametrize(
    ("size", "sound"),
    [("1e200 m", "1e150 m"), ("1e308 m", "1e100 m"), ("1e-200 m", "1e-150 m"),
     ("5e-324 m", "1e-100 m")],
)  # fmt: skip
def test_extreme_sizes_are_refused_or_give_finite_properties(size, sound):
    with pytest.raises(ComponentError, match=r"out of the range of|is not within"):
        rf.Block(width=size, height=size, mass="1 t")
    si = rf.Block(width=sound, height=sound, mass="1 t").si
    for value in (si.radius, si.inertia, si.frequency, si.overturning_angle):
        assert math.isfinite(value)
        assert value > 0.0


# bases -----------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "maker",
    [
        lambda eps: rf.RigidGround(restitution=eps),
        lambda eps: rf.TwoSpringSupport(**PADS, restitution=eps),
    ],
    ids=["ground", "pads"],
)
class TestRestitution:
    @pytest.mark.parametrize("bad", [0, 0.0, -0.1, 1.0000001, 2, math.nan, math.inf])
    def test_outside_its_interval_is_refused(self, maker, bad):
        with pytest.raises(ComponentError, match="restitution"):
            maker(bad)

    @pytest.mark.parametrize("good", [1e-300, 0.5, 1, "50 %"])
    def test_inside_its_interval_is_accepted(self, maker, good):
        assert 0.0 < maker(good).restitution <= 1.0

    def test_restitution_defaults_to_none(self, maker):
        assert maker(None).restitution is None

    def test_above_the_maximum_warns(self, maker):
        block = rf.Block(**SIZE)
        greatest = block.maximum_restitution
        with pytest.warns(ModelWarning, match="eps_max") as caught:
            rf.System(block, maker(greatest + 1e-6))
        assert len(caught) == 1
        assert caught[0].filename == __file__
        # warnings are errors here
        rf.System(block, maker(greatest))
        rf.System(block, maker(greatest - 1e-6))
        rf.System(block, maker(None))


def test_pads_need_exactly_one_parameter_of_each_pair():
    first = {"frequency_ratio": 20, "stiffness": "12 MN/m"}
    second = {"damping_ratio": 0.1, "damping": "80 kN*s/m"}
    names = list(itertools.chain(first, second))
    for chosen in itertools.product([False, True], repeat=4):
        declared_names = [name for name, is_in in zip(names, chosen, strict=True) if is_in]
        arguments = {name: {**first, **second}[name] for name in declared_names}
        if chosen[0] != chosen[1] and chosen[2] != chosen[3]:
            rf.TwoSpringSupport(**arguments)
            continue
        with pytest.raises(ComponentError, match=r"(both were|neither was) given"):
            rf.TwoSpringSupport(**arguments)


@pytest.mark.parametrize("bad", [0, -20, math.nan, math.inf])
def test_a_frequency_ratio_must_be_a_positive_number(bad):
    with pytest.raises(ComponentError, match="frequency_ratio"):
        rf.TwoSpringSupport(frequency_ratio=bad, damping_ratio=0.1)


# initial state -----------------------------------------------------------------------------


@pytest.mark.parametrize("bad", ["90 deg", "-90 deg", "10 rad", "-1.6 rad", "1 turn"])
def test_an_initial_rotation_of_a_right_angle_is_refused(bad):
    with pytest.raises(ComponentError, match="right angle"):
        rf.InitialState(rotation=bad)


def test_initial_state_defaults_to_rest():
    state = rf.InitialState()
    assert state.si.angular_velocity == state.si.vertical_velocity == 0.0
    assert state.si.rotation is None
    assert state.si.vertical_displacement is None
    assert rf.InitialState(vertical_displacement="0 m").si.vertical_displacement == 0.0


class TestCentreOfMass:
    SIZE: ClassVar = {"width": "0.6 m", "height": "2 m", "mass": "400 kg"}

    def test_defaults_to_the_middle(self):
        block = rf.Block(**self.SIZE)
        explicit = rf.Block(**self.SIZE, centre_of_mass=("1 m", "0 m"))
        assert vars(explicit.si) == vars(block.si)
        assert [each.m_as("m") for each in block.centre_of_mass] == [1.0, 0.0]

    def test_eccentric_block_has_different_angles_and_restitutions(self):
        """Angular momentum about the landing corner, :eq:`eq-eccentric-impact`."""
        block = rf.Block(**self.SIZE, inertia="150 kg*m^2", centre_of_mass=("0.7 m", "0.05 m"))
        body = rf.System(block).setting.body
        left, right = -0.35, 0.25
        assert body.overturning_angles == pytest.approx(
            (math.atan(0.35 / 0.7), math.atan(0.25 / 0.7))
        )
        inertia = 150.0 / 400.0
        kept = inertia + 0.7**2 + left * right
        expected = kept / (inertia + 0.7**2 + left**2), kept / (inertia + 0.7**2 + right**2)
        assert body.maximum_restitution == pytest.approx(expected, rel=1e-14)
        assert block.maximum_restitution == pytest.approx(min(expected), rel=1e-14)
        assert block.inertia.m_as("kg*m^2") == pytest.approx(150.0, rel=1e-14)

    def test_inertia_defaults_to_that_of_the_rectangle(self):
        block = rf.Block(**self.SIZE, centre_of_mass=("0.7 m", "0.05 m"))
        assert block.inertia.m_as("kg*m^2") == pytest.approx(400.0 * (0.6**2 + 4.0) / 12.0)

    def test_it_can_be_replaced(self):
        block = rf.Block(**self.SIZE, centre_of_mass=("0.7 m", "0.05 m"))
        other = block.replace(centre_of_mass=("80 cm", "-5 cm"))
        assert [each.m_as("m") for each in other.centre_of_mass] == pytest.approx([0.8, -0.05])
        assert block.replace(eccentricity="0 m").centre_height == block.centre_height

    @pytest.mark.parametrize(
        ("arguments", "words"),
        [
            ({"centre_of_mass": ("2.1 m", "0 m")}, r"is not within 2 m of height and 0\.3 m"),
            ({"centre_of_mass": ("1 m", "-0.3 m")}, r"is not within 2 m of height and 0\.3 m"),
            ({"centre_of_mass": "1 m"}, "needs two lengths"),
            ({"centre_of_mass": ("1 m", "0 m", "0 m")}, "needs two lengths"),
            ({"centre_of_mass": ("1 m", "0 m"), "eccentricity": "0 m"}, "give it alone"),
        ],
    )
    def test_invalid_positions_are_refused(self, arguments, words):
        with pytest.raises(ComponentError, match=words):
            rf.Block(**self.SIZE, **arguments)

    def test_large_lean_at_rest_warns(self):
        block = rf.Block(**self.SIZE, centre_of_mass=("1 m", "0.1 m"))
        with pytest.warns(ModelWarning, match="at rest the body leans by"):
            rf.System(block, rf.WinklerSoil(stiffness="1 MPa", damping_ratio=0.1))
        with pytest.raises(AssemblyError, match="falls to the right by its own weight"):
            rf.System(block, rf.WinklerSoil(stiffness="0.2 MPa", damping_ratio=0.1))
