"""A user-defined link, from the example's file."""

import importlib.util
import itertools
import math
import sys
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest
from plain_python import plain_python

import rockframe as rf
from rockframe import extension as ext
from rockframe.errors import AssemblyError, ComponentError, SolverWarning
from rockframe.solve.driver import advance

FILE = Path(__file__).parents[2] / "examples" / "own_link.py"
PAGE = Path(__file__).parents[2] / "docs" / "guide" / "own_link.md"
BLOCK = rf.Block(width="1 m", height="4 m", mass="4 t")
PADS = rf.TwoSpringSupport(frequency_ratio=20, damping_ratio=0.1)
POINTS = {"on": ("-0.5 m", "3 m"), "to": ("-1.5 m", "3 m"), "stiffness": "50 kN/m"}
PULSE = rf.GroundMotion.sine_pulse(amplitude="-4 m/s^2", frequency="1 Hz")
NUMBERS = itertools.count()


@pytest.fixture(scope="module")
def example():
    spec = importlib.util.spec_from_file_location("own_link", FILE)
    module = importlib.util.module_from_spec(spec)
    sys.modules["own_link"] = module  # required by its machine code
    spec.loader.exec_module(module)  # registers the rope; reading results needs no more
    return module


def test_rope_runs_and_energy_balances(example):
    system = rf.System(BLOCK, PADS, example.Rope(**POINTS, reach="0.1 m"))
    with plain_python():  # with links of other laws it is compiled
        run = system.simulate(PULSE, free_vibration="1 s")
    assert float(run.energy_residual) < 1e-8
    assert float(run.peak_restrainer_force[0]) > 0.0
    assert rf.System.from_dict(system.to_dict()) == system


@pytest.mark.long
def test_rope_with_negligible_hardening_matches_restrainer(example):
    rope = example.Rope(**POINTS, reach="1e6 m")
    with plain_python():
        runs = [
            rf.System(BLOCK, PADS, one).simulate(PULSE, duration="0.4 s", accuracy="reference")
            for one in (rope, rf.Restrainer(**POINTS))
        ]
    np.testing.assert_allclose(runs[0].rotation, runs[1].rotation, rtol=0, atol=1e-9)
    held = [
        rf.System(BLOCK, PADS, one).moment_rotation(([0.05], "rad")).restoring_moment
        for one in (rope, rf.Restrainer(**POINTS))
    ]
    np.testing.assert_allclose(held[0], held[1], rtol=1e-9)


def test_page_names_existing_files():
    text = PAGE.read_text()
    root = FILE.parents[1]
    for name in (
        "rockframe/dynamics/links.py",
        "rockframe/system/links.py",
        "examples/own_link.py",
    ):
        assert f"`{name}`" in text
        assert (root / name).exists()
    assert "import rockframe" in FILE.read_text()
    assert "rockframe.dynamics" not in FILE.read_text()


@pytest.mark.wide
@pytest.mark.parametrize(
    "entries",
    # the long tests compile the law in outputs and energies
    [(), pytest.param((advance,), marks=pytest.mark.long)],
    ids=["in plain Python", "compiled"],
)
def test_links_of_several_laws_work_in_one_scene(example, entries):
    rope, tie = example.Rope(**POINTS, reach="1 m", name="rope"), rf.Restrainer(**POINTS)
    load = rf.Load(at=("0 m", "3 m"), vertical="2 kN")
    with plain_python(*entries):
        found = rf.System(BLOCK, PADS, rope, tie, load).simulate(
            PULSE, free_vibration="1 s", outputs=("energy",)
        )
    assert found.restrainer.values.tolist() == ["rope", "restrainer 2"]
    assert float(found.energy_residual) < 1e-8
    assert float(found.peak_restrainer_force.min()) > 0.0
    # each moves as alone with a second link that is never taut
    idle = tie.replace(slack="1 km")
    with plain_python():
        single, combined = (
            rf.System(BLOCK, PADS, rope, *others).simulate(PULSE, free_vibration="0.5 s")
            for others in ((), (idle,))
        )
    assert abs(combined.rotation - single.rotation).max() < 1e-8


def test_invalid_link_law_raises_with_all_faults():
    class Nameless(NamedTuple):
        guard: float

        def force(self, state, stretch, own):
            return self.guard

        def states(self):
            return 2

    with pytest.raises(TypeError) as error:
        ext.link_law(Nameless)
    assert str(error.value).split("; ") == [
        "Nameless has no method energy",
        "Nameless has a field 'guard', which is a method of laws",
        "give it another name",
        "Nameless has only some of states, guard and switch",
    ]
    with pytest.raises(TypeError, match="int is no NamedTuple"):
        ext.link_law(int)


def spring(energy_beyond=lambda _: 0.0, force_beyond=lambda _: 0.0, **methods):
    """Return a registered link that is a spring but for some methods, and beyond 1 mm."""

    class Spring(NamedTuple):
        stiffness: float

        def force(self, state, stretch, own):
            e = stretch.elongation
            return self.stiffness * e + (force_beyond(e) if e > 1e-3 else 0.0)

        def energy(self, state, stretch, own):
            e = stretch.elongation
            return 0.5 * self.stiffness * e * e + (energy_beyond(e) if e > 1e-3 else 0.0)

    for name, method in methods.items():
        setattr(Spring, name, method)
    ext.link_law(Spring)

    def law(self, mass):
        stiffness = self.si.stiffness / mass
        return ext.LinkNumbers(Spring(stiffness), stiffness)

    measure = ext.Measure("a stiffness", ext.Unit.NEWTON_PER_METRE, "2 MN/m")
    name = f"Bar{next(NUMBERS)}"
    stiffness = ext.Parameter(measure, ext.POSITIVE, doc="Stiffness.")
    members = {"__module__": __name__, "__qualname__": name, "law": law, "stiffness": stiffness}
    bar = type(ext.OwnLink)(name, (ext.OwnLink,), members)
    rf.register(bar)
    return bar(**POINTS, name="bar")


TWO_STATES = {
    "states": lambda self: 2,
    "guard": lambda self, which, state, stretch, own: (0.05 - stretch.elongation, -stretch.rate),
    "switch": lambda self, which, state, stretch, own: ext.LinkEvent(1 - state, 0, 0.0),
}


@pytest.mark.parametrize(
    ("methods", "words"),
    [
        ({"force": lambda self, state, stretch, own: "1"}, "force must be a finite number, got '1"),
        ({"energy": lambda self, state, stretch, own: math.nan}, "energy must be a finite number"),
        ({"power": lambda self, state, stretch, own: (1.0,)}, r"power must be .* got \(1.0,\)"),
        ({"power": lambda self, stretch: 0.0}, "takes 2 positional arguments but 4 were given"),
        ({"variables": lambda self: -1}, "variables must be a whole number from 0 up, got -1"),
        ({**TWO_STATES, "states": lambda self: 0}, "states must be a whole number from 1 up"),
        ({"starting": lambda self, stretch, own: 1}, "starting must give one of 1 states, got 1"),
        ({**TWO_STATES, "guard": lambda *_: (math.nan, 0.0)}, "guard must be a finite number"),
        ({**TWO_STATES, "guard": lambda *_: 1.0}, "guard must be a tuple of 2 numbers, got 1.0"),
        ({**TWO_STATES, "switch": lambda *_: 1}, "switch must return a LinkEvent, got 1"),
        (
            {**TWO_STATES, "switch": lambda *_: ext.LinkEvent(2, 0, 0.0)},
            "switch gives an unknown state or event",
        ),
        ({"shown": lambda self, state: 9}, "shown gives unknown states of restrainers, .9."),
    ],
)
def test_law_is_tried_when_its_scene_is_built(methods, words):
    with pytest.raises(AssemblyError, match=rf"bar: Spring.*{words}"):
        rf.System(BLOCK, PADS, spring(**methods))


def test_error_in_a_run_names_the_failing_method():
    def fail(_):
        return math.sqrt(-1.0)

    with plain_python():
        system = rf.System(BLOCK, PADS, spring(force_beyond=fail))
        with pytest.raises(ComponentError, match=r"Spring\.force raised ValueError: .*") as error:
            system.simulate(PULSE)
        assert error.traceback[-1].name == "fail"  # where a user finds the fault
        with pytest.warns(SolverWarning, match=r"of them: Spring\.force raised ValueError: "):
            rf.sweep(system, PULSE, scale=[0.5, 1.0])


def test_nan_energies_give_infinite_residual():
    system = rf.System(BLOCK, PADS, spring(energy_beyond=lambda _: math.nan))
    with (
        plain_python(),
        pytest.warns(SolverWarning, match="energies of the scene are not all numbers"),
    ):
        run = system.simulate(PULSE)
    assert float(run.energy_residual) == math.inf
