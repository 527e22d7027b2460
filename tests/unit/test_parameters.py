"""Attributes of parts, copies with changes, signatures and docstrings."""

import copy
import inspect
import math
import pickle

import pint
import pytest
from unit import own_parts as own

import rockframe as rf
from rockframe.components import Component, Member, Ratio, RegularFrame, component_from_dict
from rockframe.components.parameters import REQUIRED
from rockframe.errors import AssemblyError, ComponentError, ModelWarning, SchemaError, UnitsError
from rockframe.units import QuantityLike

pytestmark = pytest.mark.unit

UNIT = pint.get_application_registry()
PADS = rf.TwoSpringSupport(stiffness="12 MN/m", damping_ratio=0.1)
SOIL = rf.WinklerSoil(stiffness="9 MPa", damping_ratio="20 %")
CAP = rf.CushionCap(height="0.9 m", mass="36 t", width="5 m")
CAST = rf.CushionCap(height="0.9 m", density="2500 kg/m^3", depth="4 m")
BLOCK = rf.Block(width="2 m", height="8 m", mass="50 t")
MEMBER = Member(name="tank", mass="4 t", x="1 m", y="7 m", width="2 m", height="1.5 m")
FRAME = RegularFrame(
    storeys=3, height="9 m", width="4 m", column_width="0.25 m", beam_height="0.30 m",
    beam_width="0.25 m", density="2500 kg/m^3",
)  # fmt: skip
TILTED = rf.InitialState(rotation="5 deg")
KINDS = [type(part) for part in (PADS, SOIL, CAP, BLOCK, MEMBER, FRAME, TILTED, rf.RigidGround())]
KINDS.append(rf.FrameEquivalent)


def test_only_arguments_that_may_be_left_out_may_be_none():
    signature = inspect.signature(rf.CushionCap)
    height, mass = signature.parameters["height"], signature.parameters["mass"]
    assert (height.annotation, height.default) == (QuantityLike, inspect.Parameter.empty)
    assert (mass.annotation, mass.default) == (QuantityLike | None, None)
    assert inspect.signature(Member).parameters["inertia"].annotation == QuantityLike | None
    assert signature.return_annotation is None


@pytest.mark.parametrize(
    ("part", "name", "value"),
    [
        (PADS, "stiffness", "12 MN/m"),
        (PADS, "damping_ratio", 0.1),
        (PADS, "frequency_ratio", None),
        (PADS, "damping", None),
        (PADS, "restitution", None),
        (rf.TwoSpringSupport(frequency_ratio=20, damping="80 kN*s/m"), "frequency_ratio", 20.0),
        (rf.TwoSpringSupport(frequency_ratio=20, damping="80 kN*s/m"), "damping", "80 kN*s/m"),
        (SOIL, "stiffness", "9 MPa"),
        (SOIL, "damping_ratio", 0.2),
        (SOIL, "damping", None),
        (SOIL, "separation", "displacement"),
        (CAP, "height", "0.9 m"),
        (CAP, "mass", "36 t"),
        (CAP, "width", "5 m"),
        (CAP, "density", None),
        (CAST, "mass", None),
        (CAST, "density", "2500 kg/m^3"),
        (CAST, "depth", "4 m"),
        (CAST, "width", None),
        (rf.RigidGround(restitution=0.9), "restitution", 0.9),
        (BLOCK, "shape_factor", 3.0),
        (BLOCK.replace(inertia="3e5 kg*m^2"), "inertia", "3e5 kg*m^2"),
        (MEMBER, "mass", "4 t"),
        (MEMBER, "density", None),
        (MEMBER, "width", "2 m"),
        (MEMBER, "depth", None),
        (MEMBER, "name", "tank"),
        (MEMBER, "kind", None),
        (FRAME, "storeys", 3),
        (FRAME, "column_width", "0.25 m"),
        (FRAME, "column_depth", "0.25 m"),
        (FRAME, "depth", "4 m"),
        (FRAME, "slab_thickness", "0.12 m"),
        (FRAME, "infill_thickness", "0.15 m"),
        (FRAME.replace(infill_thickness=None), "infill_thickness", None),
        (TILTED, "rotation", "5 deg"),
        (TILTED, "vertical_displacement", None),
    ],
)
def test_parameters_are_readable_as_attributes(part, name, value):
    found = getattr(part, name)
    if isinstance(found, UNIT.Quantity):
        wanted = UNIT.Quantity(value)
        assert found.m_as(wanted.units) == pytest.approx(wanted.magnitude, rel=1e-14)
    else:
        assert found == value
        assert isinstance(found, type(value))


def test_storey_heights_may_be_listed():
    frame = FRAME.replace(storey_heights=["3 m", "3.5 m"])
    assert frame.storeys == 2
    assert frame.height.m_as("m") == 6.5
    assert frame.storey_heights.m_as("m").tolist() == [3.0, 3.5]
    assert FRAME.storey_heights.m_as("m").tolist() == [3.0] * 3
    assert FRAME.replace(storey_heights=FRAME.storey_heights).si == FRAME.si


# replacement -----------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("part", "changes", "cleared"),
    [
        (PADS, {"damping_ratio": 0.2}, ()),
        (PADS, {"frequency_ratio": 20}, ("stiffness",)),
        (PADS, {"damping": "80 kN*s/m", "restitution": 0.9}, ("damping_ratio",)),
        (PADS.replace(restitution=0.9), {"restitution": None}, ()),
        (SOIL, {"damping": "0 Pa*s", "separation": "pressure"}, ("damping_ratio",)),
        (CAP, {"density": "2500 kg/m^3", "depth": "4 m"}, ("mass",)),
        (CAST, {"mass": "9 t"}, ("density", "depth")),
        (CAST, {"depth": "5 m"}, ()),
        (BLOCK.replace(shape_factor=2.9), {"inertia": "3e5 kg*m^2"}, ("shape_factor",)),
        (BLOCK, {"mass": 60.0 * UNIT.tonne}, ()),
        (MEMBER, {"inertia": "0 kg*m^2"}, ("width", "height")),
        (FRAME, {"storey_heights": "3 m; 4 m"}, ("storeys", "height")),
        (FRAME, {"slab_thickness": "0.2 m", "width": "5 m"}, ()),
        (TILTED, {"angular_velocity": "1 rad/s"}, ()),
    ],
)
def test_a_part_is_changed_by_copying(part, changes, cleared):
    before = part.to_dict()
    changed = part.replace(**changes)
    arguments = {name: value for name, value in before.items() if name not in ("type", *cleared)}
    assert changed == type(part)(**{**arguments, **changes})
    assert changed != part
    assert part.to_dict() == before
    assert part.replace() == part


def test_replace_validates_like_the_constructor():
    with pytest.raises(UnitsError, match="TwoSpringSupport: stiffness needs a stiffness"):
        PADS.replace(stiffness=12e6)
    with pytest.raises(ComponentError, match="damping_ratio must be zero or more"):
        PADS.replace(damping_ratio=-0.1)
    with pytest.raises(ComponentError, match="give damping_ratio or damping; both were given"):
        PADS.replace(damping_ratio=0.1, damping="80 kN*s/m")
    with pytest.raises(ComponentError, match="neither was given"):
        PADS.replace(stiffness=None)
    with pytest.raises(ComponentError, match="density and depth go together; only density was"):
        CAP.replace(density="2500 kg/m^3")
    with pytest.raises(TypeError, match="unexpected keyword argument 'frequency'"):
        PADS.replace(frequency=3)
    with pytest.warns(ModelWarning, match="'5 %' meant") as caught:
        assert PADS.replace(damping_ratio=5).damping_ratio == 5.0
    assert caught[0].filename == __file__


def test_replace_changes_dimensions_of_a_regular_frame():
    measures = {
        "width": "4 m", "column_width": "0.25 m", "beam_height": "0.30 m",
        "beam_width": "0.25 m", "density": "2500 kg/m^3",
    }  # fmt: skip
    frame = rf.FrameEquivalent.from_members(storeys=3, height="9 m", **measures)
    changed = frame.replace(storeys=6, height="18 m")
    assert changed == rf.FrameEquivalent.from_members(storeys=6, height="18 m", **measures)
    unequal = frame.replace(storey_heights=["3 m", "4 m"])
    assert unequal.height.m_as("m") == 7.0
    with pytest.raises(TypeError, match="'mass'"):
        frame.replace(mass="50 t")
    listed = rf.FrameEquivalent.from_members(frame.members, width="4 m", height="9 m")
    assert listed.replace(depth="4 m").space_proportion == pytest.approx(frame.space_proportion)
    plain = rf.FrameEquivalent(width="4 m", height="9 m", mass="45.8 t", shape_factor=1.153)
    assert plain.replace(inertia="4e5 kg*m^2").inertia.m_as("kg*m^2") == pytest.approx(4e5)


# signatures and docs -------------------------------------------------------------------------


@pytest.mark.parametrize("kind", KINDS)
class TestConstructor:
    def test_has_every_declared_parameter_as_keyword(self, kind):
        arguments = dict(inspect.signature(kind).parameters)
        if kind is rf.Block:  # stands for two declared parameters
            assert arguments.pop("centre_of_mass").default is None
        assert set(arguments) == set(kind._declared)
        for name, argument in arguments.items():
            assert argument.kind is inspect.Parameter.KEYWORD_ONLY
            required = kind._declared[name].default is REQUIRED
            assert (argument.default is inspect.Parameter.empty) == required

    def test_raises_type_error_for_wrong_arguments(self, kind):
        name = kind.__name__
        with pytest.raises(TypeError, match=rf"^{name}\.__init__\(\) got an unexpected .*'odd'"):
            kind(**dict.fromkeys(kind._declared, "1 m"), odd="2 m")
        with pytest.raises(TypeError, match=rf"^{name}\.__init__\(\) takes 1 positional"):
            kind("2 m")

    def test_docstring_documents_every_parameter(self, kind):
        text = inspect.getdoc(kind)
        assert text.count("\nParameters\n----------") == 1
        for name, declared in kind._declared.items():
            assert f"\n{name} : " in text
            if declared.unit:
                assert f"[{declared.unit}]" in text
            assert inspect.getdoc(getattr(kind, name)) == declared.words


@pytest.mark.parametrize("part", [PADS, SOIL, CAP, BLOCK, MEMBER, FRAME, TILTED])
def test_dir_lists_only_public_names(part):
    shown = dir(part)
    assert not [name for name in shown if name.startswith("_")]
    assert set(part._declared) | {"replace", "to_dict", "si", "given"} <= set(shown)


def test_value_containers_are_immutable():
    with pytest.raises(AttributeError, match="immutable"):
        PADS.given.stiffness = 1.0
    with pytest.raises(AttributeError, match="immutable"):
        del PADS.si.stiffness


# user-defined parts --------------------------------------------------------------------------


def pickled(part):
    return pickle.loads(pickle.dumps(part))  # noqa: S301


class TestOwnParts:
    def test_class_with_declarations_only(self):
        stop = own.Stop(strength="3 kN", gap="2 mm")
        assert stop.strength.m_as("kN") == pytest.approx(3.0)
        assert stop.gap.m_as("mm") == pytest.approx(2.0)
        assert stop.friction == 0.3
        assert stop.si.strength == 3000.0
        assert repr(stop) == "Stop(gap='0.002 m', strength='3000.0 N', friction=0.3)"
        assert stop.parameters() == ("gap", "strength", "friction")
        assert stop.with_scaled("gap", 2.0).gap.m_as("mm") == pytest.approx(4.0)
        assert str(inspect.signature(own.Stop)).startswith("(*, gap:")
        assert "Force at which it breaks; greater than zero [N]." in inspect.getdoc(own.Stop)

    def test_subclass_with_an_additional_parameter(self):
        pads = own.BreakingPads(frequency_ratio=20, damping_ratio=0.1, strength="80 kN")
        assert isinstance(pads, rf.TwoSpringSupport)
        assert pads.strength.m_as("kN") == pytest.approx(80.0)
        assert pads.frequency_ratio == 20.0
        assert list(inspect.signature(own.BreakingPads).parameters)[-1] == "strength"
        assert pads.replace(stiffness="12 MN/m").frequency_ratio is None
        with pytest.raises(ComponentError, match="BreakingPads: give frequency_ratio or stif"):
            own.BreakingPads(damping_ratio=0.1, strength="80 kN")
        with pytest.raises(UnitsError, match="BreakingPads: strength needs a force with a uni"):
            own.BreakingPads(frequency_ratio=20, damping_ratio=0.1, strength=80)
        with pytest.raises(TypeError, match=r"BreakingPads\.__init__\(\) missing 1 required keyw"):
            own.BreakingPads(frequency_ratio=20, damping_ratio=0.1)
        with pytest.warns(ModelWarning, match="BreakingPads: damping_ratio = 5 is 500 %"):
            own.BreakingPads(frequency_ratio=20, damping_ratio=5, strength="80 kN")

    @pytest.mark.parametrize("twin", [copy.copy, copy.deepcopy, pickled])
    def test_own_parts_survive_copy_pickle_and_dict_round_trip(self, twin):
        for part in (
            own.Stop(strength="3 kN", gap="2 mm"),
            own.BreakingPads(frequency_ratio=20, damping_ratio=0.1, strength="80 kN"),
            own.HeavyBlock(width="2 m", height="8 m", mass="50 t"),
        ):
            assert twin(part) == part
            assert type(twin(part)) is type(part)
            assert component_from_dict(part.to_dict()) == part
            assert hash(twin(part)) == hash(part)

    def test_a_subclass_never_equals_its_parent(self):
        size = {"width": "2 m", "height": "8 m", "mass": "50 t"}
        assert own.HeavyBlock(**size) != rf.Block(**size)
        assert rf.Block(**size) != own.HeavyBlock(**size)

    def test_part_with_unknown_parameter_is_not_simulated(self):
        pads = own.BreakingPads(frequency_ratio=20, damping_ratio=0.1, strength="80 kN")
        with pytest.raises(AssemblyError, match="BreakingPads adds strength to TwoSpringSupport"):
            rf.System(BLOCK, pads)

    def test_parameter_overriding_a_property_is_not_simulated(self):
        rounded = own.RoundedBlock(width="2 m", height="8 m", mass="50 t", radius="5 mm")
        with pytest.raises(AssemblyError, match="RoundedBlock adds radius to Block"):
            rf.System(rounded)

    def test_part_without_additions_is_simulated_as_its_parent(self):
        heavy = own.HeavyBlock(width="2 m", height="8 m", mass="50 t")
        assert rf.System(heavy, PADS).setting == rf.System(BLOCK, PADS).setting

    def test_system_with_own_part_survives_dict_round_trip(self):
        system = rf.System(own.HeavyBlock(width="2 m", height="8 m", mass="50 t"))
        again = rf.System.from_dict(system.to_dict())
        assert again == system
        assert type(again.parts.block) is own.HeavyBlock

    def test_second_class_of_the_same_name_is_refused(self):
        with pytest.raises(ComponentError, match=r"unit\.own_parts\.Stop; .* rename one of them"):
            type("Stop", (Component,), {"__module__": "elsewhere", "__qualname__": "Stop"})
        found = component_from_dict({"type": "Stop", "gap": "1 mm", "strength": "1 kN"})
        assert type(found) is own.Stop

    def test_class_may_be_redefined_in_its_module(self):
        made = [
            type("Redefined", (Component,), {"__module__": "notebook", "__qualname__": "Redefined"})
            for _ in range(2)
        ]
        assert type(component_from_dict({"type": "Redefined"})) is made[1]
        assert made[0]() != made[1]()

    def test_names_that_all_parts_have_are_refused(self):
        with pytest.raises(ComponentError, match="'si' is reserved"):
            type("Strange", (Component,), {"si": Ratio(doc="Nothing.")})

    def test_unknown_class_raises(self):
        with pytest.raises(SchemaError, match="in a module that has been imported"):
            component_from_dict({"type": "Unheard"})


def test_numbers_are_preserved_exactly():
    angle = 0.1 + 1e-17
    state = rf.InitialState(rotation=f"{angle!r} rad")
    assert state.si.rotation == angle
    assert state.rotation.magnitude == angle
    assert math.isclose(state.replace(rotation=state.rotation).si.rotation, angle, rel_tol=0.0)


MEASURES = {
    "width": "4 m", "column_width": "0.25 m", "beam_height": "0.30 m", "beam_width": "0.25 m",
    "density": "2500 kg/m^3",
}  # fmt: skip
TIE = {"on": ("-0.4 m", "3 m"), "to": ("-1 m", "3 m"), "stiffness": "1 MN/m"}


@pytest.mark.parametrize(
    "part",
    [
        BLOCK,
        rf.Block.from_outline([(0, 0), (1, 0), (0.6, 3)], unit="m", mass="1 t"),
        rf.Block.cylinder(diameter="1 m", height="4 m", density="2 t/m^3"),
        rf.FrameEquivalent(width="4 m", height="12 m", mass="90 t", shape_factor=2.5),
        rf.FrameEquivalent.from_members(storeys=3, height="9 m", **MEASURES),
        rf.FrameEquivalent.from_members(storey_heights=["4 m", "3 m"], **MEASURES),
        rf.FrameEquivalent.from_members([MEMBER], width="4 m", height="9 m"),
        rf.Stack(
            rf.FrameEquivalent.from_members(storeys=3, height="9 m", **MEASURES),
            rf.Block(width="5 m", height="1 m", mass="50 t"),
            interfaces=[SOIL],
        ),
        rf.RockingFrame(BLOCK, columns=3, beam_mass="40 t"),
        rf.RearWall(restitution="newton", wall_restitution=0.3),
        rf.RearWall(stiffness="1 MN/m", damping="3 kN*s/m", gap="1 cm", height="3 m"),
        rf.Restrainer(**TIE, slack="3 mm", strength="3 kN", damping="1 kN*s/m"),
        rf.Tendon(stiffness="1 MN/m", preload="3 kN", depth="1 m"),
        rf.Load(at=("0.1 m", "3 m"), vertical="1 kN", horizontal="1 kN"),
        rf.RigidGround(friction=0.4, kinetic_friction=0.3),
        PADS,
        CAST,
    ],
    ids=lambda part: type(part).__name__,
)
def test_every_parameter_that_is_named_can_be_scaled(part):
    """As certificates do; for a frame from members, those of the equivalent block."""
    for name in part.parameters():
        assert part.with_scaled(name, 0.999) != part
