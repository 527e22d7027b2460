"""Assembling systems: parts that fit, refusals, options."""

import copy
import inspect
import itertools
import json
import pickle
import re

import pytest
from unit.usual_scenes import OPTIONS, SCENES, assembled, block, cap, pads, pulse, soil

import rockframe as rf
from rockframe.errors import AssemblyError, RockframeError, SchemaError

pytestmark = pytest.mark.unit


def faults(*parts, **options):
    with pytest.raises(AssemblyError) as caught:
        rf.System(*parts, **options)
    return caught.value


MODELS = {name: name.split(" by ")[0].split(" with ")[0] for name in SCENES}


MANY_PARTS = {"coupled": pytest.mark.wide, "cascade": pytest.mark.long}
"""Scenes of the same parts, of which there are many orders."""


# parts -------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "name",
    [pytest.param(name, marks=MANY_PARTS.get(name, [])) for name in SCENES],
)
def test_parts_come_in_any_order(name):
    motion = pulse()
    options = OPTIONS.get(name, {})
    orders = itertools.permutations((*SCENES[name], motion))
    systems = [rf.System(*order, **options) for order in orders]
    assert len({system.describe() for system in systems}) == 1
    assert len({repr(system) for system in systems}) == 1
    assert all(system.motion is motion for system in systems)
    assert all(system.to_dict() == systems[0].to_dict() for system in systems)
    first = systems[0].simulate()
    for system in systems[1 :: 1 + len(systems) // 12]:
        assert system.simulate().drop_attrs().identical(first.drop_attrs())


def test_parts_determine_the_model():
    for name, model in MODELS.items():
        assert assembled(name).describe().splitlines()[0] == f"Model: {model}"
        assert assembled(name).simulate(pulse(), outputs=None).attrs["model"] == model


def test_a_system_does_not_change_its_parts():
    parts = (block(), pads(), cap(), soil())
    before = [part.to_dict() for part in parts]
    system = rf.System(*parts)
    system.simulate(pulse(), outputs=None)
    assert [part.to_dict() for part in parts] == before
    assert rf.System(*parts).to_dict() == system.to_dict()


@pytest.mark.parametrize(
    ("parts", "words"),
    [
        ((), ["no Block"]),
        ((pads(),), ["no Block"]),
        ((rf.RigidGround(),), ["no Block"]),
        ((block(), block()), ["Block", "twice"]),
        ((block(), block(width="3 m")), ["Block", "twice", "3.0 m"]),
        ((block(), pads(), pads()), ["TwoSpringSupport", "twice"]),
        ((block(), pulse(), pulse()), ["GroundMotion", "twice"]),
        ((block(), rf.RigidGround(), rf.RigidGround()), ["RigidGround", "twice"]),
        ((block(), pads(), rf.RigidGround()), ["RigidGround", "TwoSpringSupport", "both"]),
        ((soil(),), ["no Block"]),
        ((cap(), soil()), ["no Block"]),
        ((pads(), cap(), soil()), ["no Block"]),
        ((block(), soil(), soil()), ["WinklerSoil", "twice"]),
        ((block(), soil(), soil(separation="pressure")), ["WinklerSoil", "twice", "pressure"]),
        ((block(), cap(), cap(), soil()), ["CushionCap", "twice"]),
        ((block(), soil(), rf.RigidGround()), ["RigidGround", "WinklerSoil", "both"]),
        ((block(), cap(), soil(), rf.RigidGround()), ["RigidGround", "CushionCap", "WinklerSoil"]),
        ((block(), cap()), ["CushionCap", "without a WinklerSoil"]),
        (
            (block(), cap(), soil(), rf.Tendon(stiffness="1 MN/m"), rf.Tendon(stiffness="2 MN/m")),
            ["a Tendon and a CushionCap", "lowest body of a Stack"],
        ),
        ((block(), pads(), cap()), ["CushionCap", "without a WinklerSoil"]),
        ((block(), pads(), soil()), ["TwoSpringSupport", "WinklerSoil", "without a CushionCap"]),
        ((block(), rf.WinklerSoil), ["WinklerSoil", "class itself"]),
        ((block(), rf.CushionCap, soil()), ["CushionCap", "class itself"]),
        ((block(), None), ["None is not a part"]),
        ((block(), "pads"), ["'pads' is not a part"]),
        ((block(), 3.5), ["3.5 is not a part"]),
        ((block(), rf.InitialState()), ["InitialState", "not a part"]),
        (([block(), pads()],), ["is not a part", "no Block"]),
        ((rf.Block,), ["class itself", "no Block"]),
        ((block(), rf.TwoSpringSupport), ["TwoSpringSupport", "class itself"]),
        ((block(), rf.RigidGround), ["RigidGround", "class itself"]),
        ((block(), rf.GroundMotion), ["GroundMotion", "class itself"]),
        ((block(), rf.GroundMotion.sine_pulse), ["not a part"]),
        ((block(), rf.System(block())), ["not a part"]),
    ],
)
def test_unsupported_part_combinations_are_refused(parts, words):
    error = faults(*parts)
    for word in words:
        assert word in str(error)
    assert "Supported scenes:" in str(error)
    for scene in (
        "rigid ground",
        "Block + TwoSpringSupport",
        "Block + WinklerSoil",
        "Block + CushionCap + WinklerSoil",
        "Block + TwoSpringSupport + CushionCap + WinklerSoil, coupling='coupled'",
        "Block + TwoSpringSupport + CushionCap + WinklerSoil, coupling='cascade'",
    ):
        assert scene in str(error)
    assert isinstance(error, RockframeError)


@pytest.mark.parametrize(
    ("parts", "options", "words"),
    [
        ((block(), cap(width="1.9 m"), soil()), {}, "1.9 m wide, narrower than the 2 m of the bui"),
        ((block(), pads(), cap(width="1.9 m"), soil()), {}, "1.9 m wide, narrower"),
        ((block(), pads()), {"gravity": 9.81}, "gravity needs an acceleration"),
        ((block(),), {"restraint": "center"}, "got 'center'"),
        ((block(), pads()), {"coupling": "xx"}, "got 'xx'"),
    ],
)
def test_unrelated_faults_do_not_list_supported_scenes(parts, options, words):
    error = faults(*parts, **options)
    assert words in str(error)
    assert "scenes" not in str(error)


@pytest.mark.parametrize("name", SCENES)
def test_systems_of_equal_parts_and_options_are_equal(name):
    motion = pulse()
    system = assembled(name, motion)
    assert rf.System(motion, *reversed(SCENES[name]), **OPTIONS.get(name, {})) == system
    assert hash(assembled(name, pulse())) == hash(system)
    assert rf.System.from_dataset(system.simulate(duration="0.1 s")) == system
    for other in (
        assembled(name),
        assembled(name, motion, restraint="leading-corner"),
        assembled(name, motion, rotation="small"),
        assembled(name, motion, gravity="9.8 m/s^2"),
        rf.System(motion, block(mass="51 t"), *SCENES[name][1:], **OPTIONS.get(name, {})),
    ):
        assert other != system
    assert system != SCENES[name]


@pytest.mark.parametrize("name", SCENES)
@pytest.mark.parametrize(
    "motion",
    [
        None,
        pulse(),
        pulse().with_vertical(pulse().scaled(0.5)),
        rf.GroundMotion.from_arrays(([0.0, 1.0, 0.3], "m/s^2"), "0.02 s", name="three"),
    ],
    ids=["still", "pulse", "two pulses", "record"],
)
def test_system_survives_json_pickle_and_copy(name, motion):
    others = () if motion is None else (motion,)
    system = assembled(name, *others, restraint="centre", gravity="9.8 m/s^2")
    text = json.dumps(system.to_dict(), allow_nan=False)
    again = rf.System.from_dict(json.loads(text))
    assert again == system
    assert again.to_dict() == system.to_dict()
    assert pickle.loads(pickle.dumps(system)) == system  # noqa: S301
    assert copy.deepcopy(system).describe() == system.describe()


@pytest.mark.parametrize(
    "description",
    [{}, {"parts": 3}, {"parts": []}, {"parts": [{"type": "Brick"}]}, 3, None, "Block"],
)
def test_invalid_system_description_is_refused(description):
    with pytest.raises(SchemaError, match="does not describe a system"):
        rf.System.from_dict(description)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda description: description.pop("parts"), "found no 'parts'; expected a list of them"),
        (
            lambda description: description.update(gravitiy="9 m/s^2"),
            "found 'gravitiy'; was 'gravity' meant.; expected parts, .*gravity",
        ),
        (
            lambda description: description["parts"][0].update(hight="2 m"),
            "found 'hight' in Block; was 'height' meant.; .*height",
        ),
    ],
)
def test_wrong_keys_in_a_description_are_named(change, words):
    description = json.loads(json.dumps(assembled("coupled").to_dict()))
    change(description)
    with pytest.raises(SchemaError, match=f"does not describe a system: {words}"):
        rf.System.from_dict(description)


def test_from_dataset_refuses_a_path():
    words = r"System\.from_dataset: found 'run\.nc'; .*xr\.open_dataset first"
    with pytest.raises(SchemaError, match=words):
        rf.System.from_dataset("run.nc")


def test_a_system_is_immutable():
    system = assembled("coupled")
    for name in ("parts", "gravity", "restraint", "brand_new"):
        with pytest.raises(AttributeError):
            setattr(system, name, None)
    assert system.gravity.m_as("m/s^2") == 9.80665


def test_signature_errors_name_the_system():
    with pytest.raises(TypeError, match=r"System\.__init__\(\) got an unexpected .* 'block'"):
        rf.System(block=block())
    with pytest.raises(TypeError, match=r"System\.describe\(\) takes"):
        assembled("coupled").describe("all")
    assert next(iter(inspect.signature(rf.System).parameters)) == "parts"


def test_coupled_and_cascade_differ():
    assert assembled("coupled") != assembled("cascade")


def test_every_fault_is_listed_at_once():
    error = faults(
        pads(),
        pads(),
        rf.RigidGround(),
        "soil",
        rf.Block,
        restraint="left",
        rotation="large",
        coupling="loose",
        gravity="9.81",
    )
    expected = [
        "TwoSpringSupport is given twice",
        "'soil' is not a part",
        "class itself",
        "restraint must be one of 'contact-state', 'leading-corner', 'centre', got 'left'",
        "rotation must be one of 'finite', 'small', got 'large'",
        "coupling must be one of 'coupled', 'cascade', got 'loose'",
        "gravity needs an acceleration",
        "no Block is given",
        "both given",
    ]
    for words in expected:
        assert sum(words in fault for fault in error.faults) == 1, words
        assert words in str(error)
    assert len(error.faults) == len(expected)


def test_every_fault_of_a_stack_is_listed_at_once():
    error = faults(
        block(),
        block(),
        soil(),
        soil(),
        cap(width="1 m"),
        pads(),
        rf.RigidGround(),
        coupling="loose",
    )
    expected = [
        "Block is given twice",
        "WinklerSoil is given twice",
        "coupling must be one of 'coupled', 'cascade', got 'loose'",
        "RigidGround and TwoSpringSupport and CushionCap and WinklerSoil",
        "1 m wide, narrower than the 2 m of the building on it",
    ]
    for words in expected:
        assert sum(words in fault for fault in error.faults) == 1, words
    assert len(error.faults) == len(expected)
    error = faults(block(), pads(), soil(), rf.RigidGround())
    assert len(error.faults) == 2


def test_cap_exactly_as_wide_as_the_block_is_accepted():
    for width in ("2 m", "200 cm", f"{2.0 / 0.3048!r} ft", None):
        rf.System(block(), cap(width=width), soil())
    for width in ("1.99999 m", "1.999999999 m"):
        error = faults(block(), cap(width=width), soil())
        assert "narrower" in str(error)
    message = str(faults(block(), cap(width="1.999999999 m"), soil()))
    wide, building = re.search(r"is (\S+) m wide, narrower than the (\S+) m", message).groups()
    assert wide != building, message


def test_a_single_fault_is_one_sentence():
    error = faults(pads())
    assert len(error.faults) == 1
    assert str(error).startswith(error.faults[0])


# options -------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("name", "values"),
    [
        ("restraint", ["contact-state", "leading-corner", "centre"]),
        ("rotation", ["finite", "small"]),
        ("coupling", ["coupled", "cascade"]),
    ],
)
class TestOptions:
    def test_options_accept_strings_and_enum_members(self, name, values):
        for value in values:
            system = rf.System(block(), pads(), **{name: value})
            member = getattr(system, name)
            assert member == value
            assert str(member) == value
            assert rf.System(block(), pads(), **{name: member}).to_dict() == system.to_dict()
            assert system.to_dict()[name] == value

    @pytest.mark.parametrize("bad", ["", "Finite", "CENTRE", None, True, 0, [], {}, object, "x"])
    def test_invalid_options_are_refused_listing_the_choices(self, name, values, bad):
        error = faults(block(), pads(), **{name: bad})
        assert name in str(error)
        assert repr(bad) in str(error)
        for value in values:
            assert repr(value) in str(error)


def test_unknown_options_are_refused():
    with pytest.raises(TypeError, match="restrain"):
        rf.System(block(), pads(), restrain="centre")


def test_gravity_defaults_to_standard():
    assert rf.System(block()).options.gravity == 9.80665
    assert rf.System(block(), gravity="1 g_0").options.gravity == pytest.approx(9.80665)
    assert rf.System(block(), gravity="981 Gal").options.gravity == pytest.approx(9.81)
    for bad in ("0 m/s^2", "-9.81 m/s^2", "nan m/s^2", "9.81", 9.81, "9.81 N"):
        assert "gravity" in str(faults(block(), gravity=bad))


def test_parts_are_iterable_and_indexed_by_slot():
    system = rf.System(pads(), block(), pulse())
    assert list(system.parts) == [block(), pads(), pulse()]
    assert len(system.parts) == 3
    assert system.parts["pads"] == pads()
    with pytest.raises(KeyError, match=r"the scene has no part 'soil'\. It has 'block'"):
        system.parts["soil"]
    with pytest.raises(KeyError, match=r"the scene has no part 'pad'; was 'pads' meant.*'block'"):
        system.parts["pad"]
