"""Putting a system together and asking it to run: what fits, what does not, what is said."""

import copy
import inspect
import itertools
import json
import math
import multiprocessing
import pickle
import re
import sys

import numpy as np
import pytest

import rockframe as rf
from rockframe.errors import AssemblyError, ModelWarning, RockframeError, SchemaError, SolverError

pytestmark = pytest.mark.unit


def block(**changed):
    return rf.Block(**{"width": "2 m", "height": "8 m", "mass": "50 t", **changed})


def pads(**changed):
    return rf.TwoSpringSupport(**{"frequency_ratio": 20, "damping_ratio": 0.1, **changed})


def cap(**changed):
    return rf.CushionCap(**{"height": "0.4 m", "mass": "20 t", "width": "2.5 m", **changed})


def soil(**changed):
    return rf.WinklerSoil(**{"stiffness": "9 MPa", "damping_ratio": 0.2, **changed})


def pulse():
    return rf.GroundMotion.sine_pulse("-3 m/s^2")


def faults(*parts, **options):
    with pytest.raises(AssemblyError) as caught:
        rf.System(*parts, **options)
    return caught.value


SCENES = {
    "rigid ground": (block(),),
    "rigid ground by name": (block(), rf.RigidGround()),
    "two-spring": (block(), pads()),
    "Winkler": (block(), soil()),
    "Winkler with a cap": (block(), cap(), soil()),
    "coupled": (block(), pads(), cap(), soil()),
    "cascade": (block(), pads(), cap(), soil()),
}
OPTIONS = {"cascade": {"coupling": "cascade"}}
MODELS = {name: name.split(" by ")[0].split(" with ")[0] for name in SCENES}


def assembled(name, *others, **options):
    return rf.System(*SCENES[name], *others, **OPTIONS.get(name, {}), **options)


# parts -------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", SCENES)
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


def test_the_assembly_picks_the_model():
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
def test_parts_that_make_no_scene_are_refused(parts, words):
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
def test_faults_that_no_other_scene_would_mend_do_not_bring_the_scenes(parts, options, words):
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
def test_a_system_survives_the_way_through_text(name, motion):
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
def test_what_describes_no_system_is_refused(description):
    with pytest.raises(SchemaError, match="does not describe a system"):
        rf.System.from_dict(description)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda told: told.pop("parts"), "found no 'parts'; expected a list of them"),
        (
            lambda told: told.update(gravitiy="9 m/s^2"),
            "found 'gravitiy'; was 'gravity' meant.; expected parts, .*gravity",
        ),
        (
            lambda told: told["parts"][0].update(hight="2 m"),
            "found 'hight' in Block; was 'height' meant.; .*height",
        ),
    ],
)
def test_what_is_wrong_in_a_description_is_named(change, words):
    told = json.loads(json.dumps(assembled("coupled").to_dict()))
    change(told)
    with pytest.raises(SchemaError, match=f"does not describe a system: {words}"):
        rf.System.from_dict(told)


def test_a_path_is_no_dataset():
    words = r"System\.from_dataset: found 'run\.nc'; .*xr\.open_dataset first"
    with pytest.raises(SchemaError, match=words):
        rf.System.from_dataset("run.nc")


def test_a_system_is_immutable():
    system = assembled("coupled")
    for name in ("parts", "gravity", "restraint", "brand_new"):
        with pytest.raises(AttributeError):
            setattr(system, name, None)
    assert system.gravity.m_as("m/s^2") == 9.80665


def test_calls_that_do_not_fit_are_refused_in_the_name_of_the_system():
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


def test_a_cap_exactly_as_wide_as_the_building_fits():
    for width in ("2 m", "200 cm", f"{2.0 / 0.3048!r} ft", None):
        rf.System(block(), cap(width=width), soil())
    for width in ("1.99999 m", "1.999999999 m"):
        error = faults(block(), cap(width=width), soil())
        assert "narrower" in str(error)
    told = str(faults(block(), cap(width="1.999999999 m"), soil()))
    wide, building = re.search(r"is (\S+) m wide, narrower than the (\S+) m", told).groups()
    assert wide != building, told


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
    def test_strings_and_members_are_taken(self, name, values):
        for value in values:
            system = rf.System(block(), pads(), **{name: value})
            member = getattr(system, name)
            assert member == value
            assert str(member) == value
            assert rf.System(block(), pads(), **{name: member}).to_dict() == system.to_dict()
            assert system.to_dict()[name] == value

    @pytest.mark.parametrize("bad", ["", "Finite", "CENTRE", None, True, 0, [], {}, object, "x"])
    def test_others_are_refused_with_the_choice(self, name, values, bad):
        error = faults(block(), pads(), **{name: bad})
        assert name in str(error)
        assert repr(bad) in str(error)
        for value in values:
            assert repr(value) in str(error)


def test_unknown_options_are_refused():
    with pytest.raises(TypeError, match="restrain"):
        rf.System(block(), pads(), restrain="centre")


def test_gravity_is_standard_unless_given():
    assert rf.System(block()).options.gravity == 9.80665
    assert rf.System(block(), gravity="1 g_0").options.gravity == pytest.approx(9.80665)
    assert rf.System(block(), gravity="981 Gal").options.gravity == pytest.approx(9.81)
    for bad in ("0 m/s^2", "-9.81 m/s^2", "nan m/s^2", "9.81", 9.81, "9.81 N"):
        assert "gravity" in str(faults(block(), gravity=bad))


# description -----------------------------------------------------------------------------------


class TestDescription:
    def test_of_two_springs(self):
        text = rf.System(block(), pads(restitution=0.8)).describe()
        theta = math.atan(0.25)
        radius = math.sqrt(17.0)
        omega = math.sqrt(0.75 * 9.80665 / radius)
        uplift = math.asin(4.0 / (3.0 * 400.0 * math.sin(theta)))
        stiffness = 0.5 * 5e4 * (20.0 * omega) ** 2
        base = 5e4 * (17.0 / 3.0 + 16.0)
        rocking = math.sqrt((2.0 * stiffness - 5e4 * 9.80665 * 4.0) / base)
        damping = 0.1 * 5e4 * 20.0 * omega
        for word in (
            "Model: two-spring",
            "Block(",
            "TwoSpringSupport(",
            f"{theta:.6g} rad",
            f"{uplift:.6g} rad",
            f"{omega:.6g} rad/s",
            f"{20.0 * omega:.6g} rad/s",
            f"{rocking:.6g} rad/s",
            f"period {2.0 * math.pi / rocking:.6g} s",
            "damping ratio 0.1",
            f"damping ratio {damping / (base * rocking):.6g}",
            f"{stiffness:.6g} N/m",
            f"{0.5 * 5e4 * 9.80665 / stiffness:.6g} m",
            "0.8",
            "Eq. (12)",
            "Eq. (15)",
            "Eqs. (2)-(4)",
            "sliding",
            "tension",
        ):
            assert word in text, word
        states = re.findall(r"^  (full|left|right|flight|impact) ", text, re.MULTILINE)
        assert states == ["full", "left", "right", "flight", "impact"]

    @pytest.mark.parametrize("base", [pads, soil])
    def test_rocking_damps_by_both_sides_of_an_eccentric_base(self, base):
        """Springs and dashpots have the same levers, about the foot of the centre of mass."""
        part, e = base(), 0.1
        eccentric = block(centre_of_mass=("4 m", f"{e} m"))
        support = rf.System(eccentric, part).setting.support
        b, inertia = 1.0, eccentric.si.inertia + 5e4 * 4.0**2
        left, right = b + e, b - e
        if base is pads:
            springs = support.stiffness * (left**2 + right**2)
            dashpots = support.damping * (left**2 + right**2)
        else:
            springs = support.stiffness * (left**3 + right**3) / 3.0
            dashpots = support.damping * (left**3 + right**3) / 3.0
        rate = math.sqrt((springs - 5e4 * 9.80665 * 4.0) / inertia)
        text = rf.System(eccentric, part).describe()
        ratio = dashpots / (2.0 * inertia * rate)
        told = re.search(r"omega_r = (\S+) rad/s .*?damping ratio (\S+)", text, re.DOTALL)
        assert told.groups() == (f"{rate:.6g}", f"{ratio:.6g}")

    def test_of_rigid_ground(self):
        text = rf.System(block()).describe()
        for word in (
            "Model: rigid ground",
            "omega^2",
            "sin(theta s - a)",
            "Housner",
            f"{9.80665 * 0.25:.4g} m s^-2",
            f"{1.0 - 1.5 / 17.0:.6g}",
            "sliding",
            "flight",
        ):
            assert word in text, word

    @pytest.mark.parametrize("capped", [False, True])
    def test_of_soil(self, capped):
        parts = (block(), soil(), cap()) if capped else (block(), soil())
        text = rf.System(*parts).describe()
        mass, half, centre = 5e4, 1.0, 4.0
        about_base = 5e4 * (4.0 + 64.0) / 12.0 + 5e4 * 16.0
        if capped:
            mass, half = 7e4, 1.25
            centre = (5e4 * 4.4 + 2e4 * 0.2) / mass
            about_base = 5e4 * (68.0 / 12.0 + 4.4**2) + 2e4 * ((2.5**2 + 0.16) / 12.0 + 0.04)
        settled = 0.5 * mass * 9.80665 / (half * 9e6)
        vertical = math.sqrt(2.0 * half * 9e6 / mass)
        damping = 0.2 * mass * vertical / half
        rocking = math.sqrt((9e6 * half**3 / 1.5 - mass * 9.80665 * centre) / about_base)
        ratio = damping * half**3 / 3.0 / about_base / rocking
        for word in (
            "Model: Winkler",
            "WinklerSoil(",
            "CushionCap(" if capped else "Block(",
            f"{mass:.6g} kg",
            f"centre {centre:.6g} m",
            f"{9e6:.6g} Pa",
            f"{damping:.6g} Pa s",
            f"settlement delta                    {settled:.6g} m",
            f"{math.atan(half / centre):.6g} rad",
            f"{math.asin(settled / half):.6g} rad",
            f"omega_v = {vertical:.6g} rad/s",
            f"omega_r = {rocking:.6g} rad/s",
            f"period {2.0 * math.pi / rocking:.6g} s",
            "damping ratio 0.2",
            f"damping ratio {ratio:.6g}",
            "Eq. (18)",
            "Eq. (19)",
            "without impact law",
            "sliding",
        ):
            assert word in text, word
        states = re.findall(r"^  (full|left, right|flight|contact) ", text, re.MULTILINE)
        assert states == ["full", "left, right", "flight", "contact"]

    def test_of_a_stack(self):
        coupled = rf.System(block(), pads(), cap(), soil()).describe()
        cascade = rf.System(block(), pads(), cap(), soil(), coupling="cascade").describe()
        omega = math.sqrt(0.75 * 9.80665 / math.sqrt(17.0))
        for text in (coupled, cascade):
            for word in (
                "TwoSpringSupport(",
                "CushionCap(",
                f"{math.atan(0.25):.6g} rad",
                f"{20.0 * omega:.6g} rad/s",
                "2.5 m by 0.4 m, 20000 kg",
                "70000 kg",
                f"omega_v = {math.sqrt(2.5 * 9e6 / 7e4):.6g} rad/s",
                "Eq. (16)",
                "Eq. (18a)",
                "Eqs. (2)-(4)",
                "of the block on the cap and of the cap on the soil alike",
                "tension",
                "yielding of the soil",
            ):
                assert word in text, word
        assert "Model: coupled" in coupled
        assert "four degrees of freedom" in coupled
        assert "impulse between block and cap" in coupled
        assert "Eq. (20)" not in coupled
        assert "Model: cascade" in cascade
        assert "Eq. (20)" in cascade
        for stage in ("stage 1, full", "stage 1, flight", "stage 2, full", "stage 2, impact"):
            assert stage in cascade
        assert "what the block's motion on the pads does to cap and soil" in cascade

    @pytest.mark.parametrize("name", ["Winkler", "Winkler with a cap", "coupled", "cascade"])
    @pytest.mark.parametrize("rule", ["contact-state", "leading-corner", "centre"])
    def test_of_soil_names_the_restraint_rule(self, name, rule):
        text = assembled(name, restraint=rule).describe()
        others = {"contact-state", "leading-corner", "centre"} - {rule}
        assert f"{rule}:" in text
        assert not any(f"{other}:" in text for other in others)

    def test_of_soil_says_where_it_lets_go(self):
        texts = {
            separation: rf.System(block(), soil(separation=separation)).describe()
            for separation in ("displacement", "pressure")
        }
        assert "above the level of the unloaded bed" in texts["displacement"]
        assert "dashpots would pull" not in texts["displacement"]
        assert "dashpots would pull" in texts["pressure"]

    def test_of_soil_too_soft_says_never(self):
        with pytest.warns(ModelWarning, match="too soft") as caught:
            system = rf.System(block(), soil(stiffness="0.2 MPa"))
        assert caught[0].filename == __file__
        assert "never" in system.describe()
        with pytest.warns(ModelWarning, match="too soft"):
            rf.System(block(), pads(), cap(), soil(stiffness="0.2 MPa"))

    @pytest.mark.parametrize("rule", ["contact-state", "leading-corner", "centre"])
    def test_names_the_restraint_rule(self, rule):
        assert rule in rf.System(block(), pads(), restraint=rule).describe()
        others = {"contact-state", "leading-corner", "centre"} - {rule}
        text = rf.System(block(), pads(), restraint=rule).describe()
        assert not any(f"{other}:" in text for other in others)

    def test_says_when_rotations_are_small(self):
        for name, parts in SCENES.items():
            small = assembled(name, rotation="small").describe()
            assert "small rotation" in small
            assert small != assembled(name).describe()
            if len(parts) < 3 and "Winkler" not in name:  # Eq. (18) is named as that of small ones
                assert "small rotation" not in assembled(name).describe()

    def test_says_under_what_gravity(self):
        moon = rf.System(block(), pads(), gravity="1.62 m/s^2").describe()
        omega = math.sqrt(0.75 * 1.62 / math.sqrt(17.0))
        assert f"{omega:.6g} rad/s" in moon
        assert "1.62" in moon

    @pytest.mark.parametrize("coupling", ["coupled", "cascade"])
    def test_of_a_stack_says_whose_uplift_angle_is_whose(self, coupling):
        parts = (block(), pads(), cap(), soil())
        system = rf.System(*parts, coupling=coupling)
        rest = system.equilibrium()
        text = re.sub(r"\s+", " ", system.describe())
        on_soil = float(rest.soil_settlement) / 1.25
        for words in (
            f"uplift angle on the pads, Eq. (16) {float(rest.uplift_angle):.6g} rad",
            f"of block against cap, at a moment of {float(rest.uplift_moment):.6g} N m",
            f"uplift angle on the soil, arcsin(delta/b) {math.asin(on_soil):.6g} rad",
            f"of cap against ground, at a moment of {float(rest.soil_uplift_moment):.6g} N m",
        ):
            assert words in text, words
        assert text.count("uplift angle") == 2
        with pytest.warns(ModelWarning, match="too soft"):
            soft = rf.System(block(), pads(), cap(), soil(stiffness="0.1 MPa"), coupling=coupling)
        assert "arcsin(delta/b) never" in re.sub(r" +", " ", soft.describe())

    def test_stands_in_two_columns(self):
        for name in SCENES:
            lines = assembled(name).describe().splitlines()
            assert max(len(line) for line in lines) <= 100
            numbers = lines[lines.index("Numbers:") + 1 : lines.index("Left out:")]
            names = [line for line in numbers if not line.startswith("   ")]
            starts = {re.match(r"  (?:\S+ )*\S+  +", line).end() for line in names}
            assert len(starts) == 1, name
            (start,) = starts
            for line in numbers:
                assert line[start] != " ", line
                if line not in names:  # a line that goes on stands below what it goes on from
                    assert not line[:start].strip()

    def test_is_plain_text(self):
        for name in SCENES:
            text = assembled(name).describe()
            assert text.isascii()
            assert "nan" not in text
            assert not any(line != line.rstrip() for line in text.splitlines())
            assert not text.endswith("\n")


# simulate ----------------------------------------------------------------------------------------


def refusal(error=AssemblyError, system=None, **arguments):
    chosen = rf.System(block(), pads()) if system is None else system
    with pytest.raises(error) as caught:
        chosen.simulate(arguments.pop("motion", pulse()), **arguments)
    return str(caught.value)


class TestSimulateRefuses:
    def test_nothing_to_do(self):
        with pytest.raises(AssemblyError, match="nothing to simulate"):
            rf.System(block()).simulate()
        with pytest.raises(AssemblyError, match="nothing to simulate"):
            rf.System(block()).simulate(initial=rf.InitialState(rotation="0.1 rad"))

    @pytest.mark.parametrize("bad", ["pulse", 3, [0.0, 1.0], rf.GroundMotion, np.zeros(3)])
    def test_what_is_no_motion(self, bad):
        assert "motion must be a GroundMotion" in refusal(motion=bad)

    @pytest.mark.parametrize("bad", ["0.1 rad", 0.1, {}, rf.InitialState])
    def test_what_is_no_initial_state(self, bad):
        assert "InitialState" in refusal(initial=bad)

    def test_two_lengths(self):
        message = refusal(duration="1 s", free_vibration="2 s")
        assert "duration or free_vibration, not both" in message

    @pytest.mark.parametrize("name", ["duration", "free_vibration", "output_step"])
    @pytest.mark.parametrize("bad", ["0 s", "-1 s", "nan s", "inf s", "1 m", "1", 1.0])
    def test_lengths_that_are_none(self, name, bad):
        assert name in refusal(RockframeError, **{name: bad})

    @pytest.mark.parametrize("sign", ["", "-"])
    def test_an_initial_rotation_beyond_overturning(self, sign):
        for name in SCENES:
            system = assembled(name)
            theta = system.equilibrium().overturning_angle.item()
            inside = rf.InitialState(rotation=f"{sign}{theta * (1.0 - 1e-9)!r} rad")
            system.simulate(pulse(), initial=inside, outputs=None)
            for angle in (theta, theta * (1.0 + 1e-9), 1.0):
                start = rf.InitialState(rotation=f"{sign}{angle!r} rad")
                message = refusal(system=system, initial=start)
                assert "initial rotation" in message
                assert "overturning angle" in message

    def test_a_vertical_start_on_rigid_ground(self):
        for start in (
            rf.InitialState(vertical_displacement="1 mm"),
            rf.InitialState(vertical_displacement="0 mm"),
            rf.InitialState(vertical_velocity="1 mm/s"),
        ):
            message = refusal(system=rf.System(block()), initial=start)
            assert "vertical_displacement" in message

    @pytest.mark.parametrize(
        "bad", ["x", ["rotations"], ["peak_rotation"], ["energy", "x"], [3], 3, [[]], [None], True]
    )
    def test_outputs_that_do_not_exist(self, bad):
        message = refusal(RockframeError, outputs=bad)
        assert "outputs" in message
        assert "kinetic_energy" in message

    @pytest.mark.parametrize("bad", ["Stop", "go on", None, True, 1, []])
    def test_other_ways_to_overturn(self, bad):
        message = refusal(overturning=bad)
        assert "'stop', 'continue'" in message
        assert repr(bad) in message

    @pytest.mark.parametrize("bad", ["best", "", None, 1, True, []])
    def test_other_accuracies(self, bad):
        message = refusal(RockframeError, accuracy=bad)
        for word in ("fast", "standard", "reference", "Accuracy", repr(bad)):
            assert word in message

    @pytest.mark.parametrize("bad", [0.1, 1e-15, math.nan, -1e-6])
    def test_tolerances_out_of_range(self, bad):
        assert "rtol must lie from 1e-13 to 0.01" in refusal(SolverError, accuracy=bad)

    def test_several_faults_at_once(self):
        message = refusal(
            duration="1 s",
            free_vibration="1 s",
            overturning="x",
            outputs=["y"],
            initial=rf.InitialState(rotation="1 rad"),
        )
        for word in ("not both", "overturning must", "'y'", "initial rotation"):
            assert word in message

    def test_an_output_step_of_no_use_even_without_histories(self):
        assert "output_step" in refusal(RockframeError, outputs=None, output_step="5")


def _simulate(options):
    try:
        rf.System(block(), pads()).simulate(pulse(), **options)
    except RockframeError:
        sys.exit(7)
    sys.exit(0)


@pytest.mark.parametrize(
    "options", [{"duration": "1e12 s"}, {"output_step": "1e-13 s"}, {"free_vibration": "1e300 s"}]
)
def test_more_samples_than_any_machine_holds_are_refused(options):
    worker = multiprocessing.get_context("fork").Process(target=_simulate, args=(options,))
    worker.start()
    worker.join(20.0)
    alive = worker.is_alive()
    if alive:
        worker.kill()
        worker.join()
    assert not alive
    assert worker.exitcode == 7


class TestAccuracy:
    def test_it_is_a_frozen_value(self):
        accuracy = rf.Accuracy(rtol=1e-8)
        assert accuracy == rf.Accuracy(rtol=1e-8)
        assert hash(accuracy) == hash(rf.Accuracy(rtol=1e-8))
        with pytest.raises(AttributeError):
            accuracy.rtol = 1e-3

    @pytest.mark.parametrize(
        ("name", "bad"),
        [
            ("rtol", 0.0),
            ("rtol", -1e-7),
            ("rtol", 1.0),
            ("rtol", 1e-16),
            ("rtol", 0.9e-13),
            ("rtol", 1.1e-2),
            ("rtol", math.nan),
            ("rtol", math.inf),
            ("rtol", "1e-7"),
            ("rtol", None),
            ("rtol", True),
            ("steps_per_period", 0),
            ("steps_per_period", math.nan),
            ("max_steps", 0),
            ("max_steps", -5),
            ("max_steps", 10.5),
            ("floor", -0.1),
            ("floor", 2.0),
        ],
    )
    def test_settings_out_of_range_are_refused(self, name, bad):
        with pytest.raises(SolverError, match=name):
            rf.Accuracy(**{"rtol": 1e-7, name: bad})

    @pytest.mark.parametrize(
        ("name", "settings"),
        [
            ("fast", {"rtol": None, "substeps": "fewest", "steps_per_period": 10.0}),
            ("standard", {"rtol": 2e-8, "substeps": None, "steps_per_period": 8.0}),
            ("reference", {"rtol": 1e-11, "substeps": None, "steps_per_period": 8.0}),
        ],
    )
    def test_a_run_tells_its_settings(self, name, settings):
        response = rf.System(block(), pads()).simulate(pulse(), accuracy=name, outputs=None)
        assert settings.items() <= json.loads(response.run_json)["accuracy"].items()

    @pytest.mark.parametrize("name", ["fast", "standard", "reference"])
    def test_names_stand_for_settings(self, name):
        response = rf.System(block(), pads()).simulate(pulse(), accuracy=name, outputs=None)
        assert response.attrs["accuracy"] == name
        if name == "fast":
            assert math.isnan(response.attrs["solver_rtol"])
            assert response.attrs["solver_substeps"] >= 1
            assert "order 3" in response.attrs["solver_method"]
            own = rf.Accuracy(substeps=response.attrs["solver_substeps"])
        else:
            assert response.attrs["solver_substeps"] == 0
            assert "5(4)" in response.attrs["solver_method"]
            own = rf.Accuracy(rtol=response.attrs["solver_rtol"])
        again = rf.System(block(), pads()).simulate(pulse(), accuracy=own, outputs=None)
        assert float(again.peak_rotation) == float(response.peak_rotation)

    @pytest.mark.parametrize("given", [{}, {"rtol": 1e-6, "substeps": 4}, {"floor": 0.1}])
    def test_a_tolerance_or_substeps_but_not_both(self, given):
        with pytest.raises(SolverError, match=r"rtol .* or substeps"):
            rf.Accuracy(**given)

    @pytest.mark.parametrize("bad", [0, -1, 1.5, 2.0, True, "4", "most", math.nan, 10**7])
    def test_substeps_out_of_range_are_refused(self, bad):
        with pytest.raises(SolverError, match="substeps"):
            rf.Accuracy(substeps=bad)

    def test_fixed_steps_ask_for_more_steps_per_period(self):
        assert rf.Accuracy(rtol=1e-6, steps_per_period=6.0).steps_per_period == 6.0
        with pytest.raises(SolverError, match="steps_per_period"):
            rf.Accuracy(substeps="fewest", steps_per_period=6.0)

    def test_the_fewest_substeps_that_resolve_the_fastest_vibration(self):
        counts = []
        for frequency_ratio in (10, 20, 40, 80, 160):
            stiff = rf.TwoSpringSupport(frequency_ratio=frequency_ratio, damping_ratio=0.1)
            response = rf.System(block(), stiff).simulate(
                rf.GroundMotion.from_arrays((np.zeros(11), "m/s^2"), "0.02 s"), accuracy="fast"
            )
            counts.append(response.attrs["solver_substeps"])
        assert counts[0] >= 1
        for count, following in itertools.pairwise(counts):
            assert 2 * count - 1 <= following <= 2 * count

    @pytest.mark.parametrize("substeps", [3, "fewest"])
    def test_a_still_ground_is_stepped_likewise(self, substeps):
        response = rf.System(block(), pads()).simulate(
            duration="2 s", accuracy=rf.Accuracy(substeps=substeps)
        )
        expected = 200 * response.attrs["solver_substeps"]
        assert response.attrs["solver_steps"] == expected

    def test_own_settings_are_used(self):
        own = rf.Accuracy(rtol=3e-9)
        response = rf.System(block(), pads()).simulate(pulse(), accuracy=own, outputs=None)
        assert response.attrs["solver_rtol"] == 3e-9


# motion ------------------------------------------------------------------------------------------


def test_a_motion_given_to_simulate_goes_before_that_among_the_parts():
    system = rf.System(block(), pads(), pulse())
    other = rf.GroundMotion.sine_pulse("-1 m/s^2")
    response = system.simulate(other)
    assert response.attrs["motion_sha256"] == other.sha256
    assert abs(response.ground_acceleration.values).max() == pytest.approx(1.0)


def test_lengths_of_runs():
    system = rf.System(block(), pads())
    for options, length in (
        ({}, 1.0),
        ({"free_vibration": "0.5 s"}, 1.5),
        ({"duration": "0.25 s"}, 0.25),
        ({"duration": "3 s"}, 3.0),
    ):
        response = system.simulate(pulse(), output_step="0.25 s", **options)
        np.testing.assert_array_equal(
            response.time.values, np.arange(round(length / 0.25) + 1) * 0.25
        )
        assert response.attrs["solver_end_time"] == pytest.approx(length, rel=1e-12)
    still = system.simulate(free_vibration="2 s", output_step="1 s")
    assert still.time.values.tolist() == [0.0, 1.0, 2.0]


def test_a_weightless_block_on_rigid_ground_is_warned_about():
    flat = np.zeros(101)
    for lowest, warned in ((-9.0, False), (-10.0, True)):
        upwards = flat.copy()
        upwards[40:60] = lowest
        motion = rf.GroundMotion.from_arrays((flat, "m/s^2"), "10 ms", vertical=(upwards, "m/s^2"))
        if not warned:
            rf.System(block()).simulate(motion)
            continue
        with pytest.warns(ModelWarning, match="leave the rigid ground") as caught:
            rf.System(block()).simulate(motion)
        assert caught[0].filename == __file__
        rf.System(block(), pads()).simulate(motion)


@pytest.mark.parametrize(
    ("option", "chosen", "useless", "useful"),
    [
        ("coupling", "cascade", (block(), cap(), soil()), (block(), pads(), cap(), soil())),
        ("restraint", "centre", (block(), rf.RigidGround()), (block(), pads())),
        ("sliding", "checked", (block(), pads()), (block(), pads(friction=0.3))),
    ],
)
def test_options_that_a_scene_has_no_use_for_are_told(option, chosen, useless, useful):
    with pytest.warns(ModelWarning, match=f"{option}='{chosen}' changes nothing here") as caught:
        rf.System(*useless, **{option: chosen})
    assert len(caught) == 1
    assert caught[0].filename == __file__
    assert rf.System(*useful, **{option: chosen}).assembly.doubts == []
    assert rf.System(*useless).assembly.doubts == []


@pytest.mark.parametrize(
    "tie",
    [
        rf.Tendon(stiffness="5 MN/m", brittle=True),
        rf.Restrainer(on=("-0.5 m", "2 m"), to=("-1 m", "2 m"), stiffness="1 MN/m", brittle=False),
    ],
)
def test_a_tie_without_strength_that_would_break_or_yield_is_told(tie):
    with pytest.warns(ModelWarning, match=f"brittle={tie.brittle} changes nothing") as caught:
        rf.System(block(), tie)
    assert len(caught) == 1
    assert rf.System(block(), tie.replace(strength="20 kN")).assembly.doubts == []
    assert rf.System(block(), tie.replace(brittle=not tie.brittle)).assembly.doubts == []


def test_parts_are_iterated_over_and_found_by_their_slots():
    system = rf.System(pads(), block(), pulse())
    assert list(system.parts) == [block(), pads(), pulse()]
    assert len(system.parts) == 3
    assert system.parts["pads"] == pads()
    with pytest.raises(KeyError, match=r"the scene has no part 'pad'; was 'pads' meant.*'block'"):
        system.parts["pad"]
