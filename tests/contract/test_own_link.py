"""A user-defined link, from the example's file."""

import importlib.util
import sys
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest
from plainly import plainly

import rockframe as rf
from rockframe import extension as ext
from rockframe.errors import ComponentError
from rockframe.solve.driver import advance

FILE = Path(__file__).parents[2] / "examples" / "own_link.py"
PAGE = Path(__file__).parents[2] / "docs" / "guide" / "own_link.md"
BLOCK = rf.Block(width="1 m", height="4 m", mass="4 t")
PADS = rf.TwoSpringSupport(frequency_ratio=20, damping_ratio=0.1)
POINTS = {"on": ("-0.5 m", "3 m"), "to": ("-1.5 m", "3 m"), "stiffness": "50 kN/m"}
PULSE = rf.GroundMotion.sine_pulse(amplitude="-4 m/s^2", frequency="1 Hz")


@pytest.fixture(scope="module")
def example():
    spec = importlib.util.spec_from_file_location("own_link", FILE)
    module = importlib.util.module_from_spec(spec)
    sys.modules["own_link"] = module  # required by its machine code
    spec.loader.exec_module(module)  # registers the rope; reading results needs no more
    return module


def test_rope_runs_and_energy_balances(example):
    system = rf.System(BLOCK, PADS, example.Rope(**POINTS, reach="0.1 m"))
    with plainly():  # with links of other laws it is compiled
        run = system.simulate(PULSE, free_vibration="1 s")
    assert float(run.energy_residual) < 1e-8
    assert float(run.peak_restrainer_force[0]) > 0.0
    assert rf.System.from_dict(system.to_dict()) == system


@pytest.mark.long
def test_rope_with_negligible_hardening_matches_restrainer(example):
    rope = example.Rope(**POINTS, reach="1e6 m")
    with plainly():
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


def test_registering_other_types_is_refused():
    with pytest.raises(ComponentError, match="OwnBase or OwnScene"):
        rf.register(int)


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
    with plainly(*entries):
        found = rf.System(BLOCK, PADS, rope, tie, load).simulate(
            PULSE, free_vibration="1 s", outputs=("energy",)
        )
    assert found.restrainer.values.tolist() == ["rope", "restrainer 2"]
    assert float(found.energy_residual) < 1e-8
    assert float(found.peak_restrainer_force.min()) > 0.0
    # each moves as alone with a second link that is never taut
    idle = tie.replace(slack="1 km")
    with plainly():
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

    with pytest.raises(TypeError) as caught:
        ext.link_law(Nameless)
    assert str(caught.value).split("; ") == [
        "Nameless has no method energy",
        "Nameless has a field 'guard', which is a method of laws",
        "give it another name",
        "Nameless has only some of states, guard and switch",
    ]
    with pytest.raises(TypeError, match="int is no NamedTuple"):
        ext.link_law(int)
