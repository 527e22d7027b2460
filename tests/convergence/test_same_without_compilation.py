"""Compiled and plain runs share their source and give the same numbers to the last bit.

So do steps that call the equations, steps with the equations compiled into them, and machine code
that plain Python calls.
"""

from contextlib import contextmanager
from functools import partial

import numpy as np
import pytest
from plain_python import plain_python

import rockframe as rf
from rockframe.compiled import COMPILED, bind, bound
from rockframe.compiled.callbacks import call_machine_code
from rockframe.solve import driver, equations, integrate
from rockframe.solve import workspace as at
from rockframe.solve.equations import equations_of
from rockframe.solve.evaluation import InlinedEquations
from rockframe.solve.march import march_by_tolerance, march_fixed, march_fixed_by_rates

pytestmark = [
    pytest.mark.skipif(not COMPILED, reason="this run does without compilation"),
    pytest.mark.filterwarnings("ignore::rockframe.errors.RockframeWarning"),
]

RNG = np.random.default_rng(3)
ACROSS, UP = (np.convolve(RNG.normal(size=201), np.ones(5) / 5, "same") for _ in range(2))
MOTION = rf.GroundMotion.from_arrays((8 * ACROSS, "m/s^2"), "0.02 s", vertical=(4 * UP, "m/s^2"))
SHORT = MOTION.window("0 s", "0.8 s")
BLOCK = rf.Block.from_size(radius="3 m", slenderness=3, mass="2 t")
PADS = rf.TwoSpringSupport(frequency_ratio=15, damping_ratio=0.1)
LIGHT = rf.CushionCap(width="3 m", height="0.2 m", mass="0.4 t")
CAP = rf.CushionCap(height="0.5 m", mass="1 t")
SOIL = rf.WinklerSoil(stiffness="2 MPa", damping_ratio=0.2)
BED = rf.WinklerSoil(stiffness="3 MPa", damping_ratio=0.1)
PRESSED = BED.replace(separation="pressure")

SCENES = {
    "rigid ground": (MOTION, (), {}),
    "pads": (MOTION, (PADS,), {}),
    "pads, leading corner": (MOTION, (PADS,), {"restraint": "leading-corner"}),
    "pads, centre": (MOTION, (PADS,), {"restraint": "centre"}),
    "pads, small rotations": (MOTION, (PADS,), {"rotation": "small"}),
    "coupled": (SHORT, (PADS, LIGHT, BED), {}),
    "coupled, leading corner": (SHORT, (PADS, LIGHT, PRESSED), {"restraint": "leading-corner"}),
    "cascade": (SHORT, (PADS, LIGHT, BED), {"coupling": "cascade"}),
    "cascade, leading corner": (
        SHORT, (PADS, LIGHT, PRESSED), {"restraint": "leading-corner", "coupling": "cascade"},
    ),
    "fast on rigid ground": (MOTION, (), {"accuracy": "fast"}),
    "fast on pads": (MOTION, (PADS,), {"restraint": "leading-corner", "accuracy": "fast"}),
    "fast on soil": (MOTION, (SOIL,), {"accuracy": "fast"}),
    "fast, coupled": (MOTION, (PADS, CAP, SOIL), {"accuracy": "fast"}),
    "fast, cascade": (MOTION, (PADS, CAP, SOIL), {"coupling": "cascade", "accuracy": "fast"}),
}  # fmt: skip
STACKS = {
    f"{accuracy}, {name}": (rf.Stack(BLOCK, BLOCK, interfaces=[base]), base, accuracy)
    for name, base in {"pads": PADS, "rigid joints": rf.RigidGround(friction=0.3)}.items()
    for accuracy in ("fast", "standard")
}
SECOND_LOOKS = {
    "fast, rigid joints", "standard, pads", "pads, leading corner", "coupled", "cascade",
    "fast on pads", "fast on soil", "coupled, leading corner", "cascade, leading corner",
    "fast, cascade",
}  # fmt: skip
"""Scenes whose equations are mostly compiled by another scene."""


@contextmanager
def uncompiled_loop(monkeypatch):
    """Let runs in this block proceed in plain Python that calls machine code."""
    calls = []

    def call(source, words):
        calls.append(source.function)
        return call_machine_code(source, words)

    with monkeypatch.context() as patch:
        patch.setattr(integrate, "advance", driver.advance._plain)
        patch.setattr(bound, "call_machine_code", call)
        yield
    assert {march_by_tolerance, march_fixed, march_fixed_by_rates} & {*calls}


@pytest.mark.parametrize(
    "name",
    [pytest.param(name, marks=[pytest.mark.long] * (name in SECOND_LOOKS)) for name in STACKS],
)
def test_stacks_match_with_and_without_compilation(name, monkeypatch):
    stack, base, accuracy = STACKS[name]
    system = rf.System(stack, base)
    compiled = system.simulate(SHORT, accuracy=accuracy, outputs=["energy"])
    with uncompiled_loop(monkeypatch):
        around = system.simulate(SHORT, accuracy=accuracy, outputs=["energy"])
    with plain_python():
        plain = system.simulate(SHORT, accuracy=accuracy, outputs=["energy"])
    for variable, values in compiled.variables.items():
        for other in (around, plain):
            np.testing.assert_array_equal(values, other.variables[variable], err_msg=variable)
    assert compiled.sizes["event"] > 1


@pytest.mark.parametrize(
    "name",
    [pytest.param(name, marks=[pytest.mark.long] * (name in SECOND_LOOKS)) for name in SCENES],
)
def test_compiled_and_uncompiled_runs_are_identical(name, monkeypatch):
    motion, parts, options = SCENES[name]
    accuracy = options.get("accuracy", "standard")
    rules = {key: value for key, value in options.items() if key != "accuracy"}
    system = rf.System(BLOCK, *parts, **rules)
    runs = {}
    for compiled_in in (False, True):
        monkeypatch.setattr(
            integrate, "equations_of", partial(equations_of, compiled_in=compiled_in)
        )
        runs[compiled_in] = system.simulate(motion, accuracy=accuracy, outputs=["energy"])
    with uncompiled_loop(monkeypatch):
        runs["around"] = system.simulate(motion, accuracy=accuracy, outputs=["energy"])
    with plain_python():
        plain = system.simulate(motion, accuracy=accuracy, outputs=["energy"])
    for compiled in runs.values():
        assert plain.variables.keys() == compiled.variables.keys()
        for variable, values in compiled.variables.items():
            np.testing.assert_array_equal(values, plain.variables[variable], err_msg=variable)
    if parts == (PADS,):
        assert plain.impact_count > (3 if "small" in name else 2)


def test_run_that_pauses_after_slow_functions_in_python_is_identical(monkeypatch):
    """A run returns from functions that are not compiled, to see whether they are by now."""
    stack, base, accuracy = next(iter(STACKS.values()))
    system = rf.System(stack, base)
    uninterrupted = system.simulate(SHORT, accuracy=accuracy, outputs=["energy"])
    monkeypatch.setattr(integrate, "SECONDS_CALLING_BACK", 0.0)
    with uncompiled_loop(monkeypatch):
        advance, results = integrate.advance, []
        monkeypatch.setattr(
            integrate, "advance", lambda *inputs: results.append(advance(*inputs)) or results[-1]
        )
        paused = system.simulate(SHORT, accuracy=accuracy, outputs=["energy"])
    assert results.count(at.PAUSED) > paused.sizes["event"]
    for variable, values in uninterrupted.variables.items():
        np.testing.assert_array_equal(values, paused.variables[variable], err_msg=variable)


def test_time_of_uncompiled_steps_is_counted(monkeypatch):
    """After some seconds the equations are compiled into the steps."""
    system = rf.System(BLOCK)
    (own,) = bind((march_by_tolerance,), InlinedEquations(system.assembly.model.system))
    monkeypatch.setattr(equations, "is_worth_calling", lambda _: False)
    counted = [own.source.fallback_seconds]
    for _ in range(3):
        system.simulate(MOTION)
        counted.append(own.source.fallback_seconds)
    assert np.all(np.diff(counted) > 0.0)
    monkeypatch.setattr(equations, "is_worth_calling", lambda _: True)
    system.simulate(MOTION)
    assert own.source.fallback_seconds == counted[-1]


def test_compilation_does_not_count_as_time_of_steps(monkeypatch):
    system = rf.System(BLOCK)
    system.simulate(MOTION)  # compiled by now
    called = equations_of(system.assembly.model.system, fixed_steps=False, compiled_in=False)
    own = called.march.fallback_for.source
    before = own.fallback_seconds
    python_time, clock = integrate.PythonTime(1.0, 0.01, 1.0), np.ones(at.CLOCK)
    address = called.march.source.address
    monkeypatch.setattr(called.march.source, "address", 0)
    with python_time.measured(called, clock):
        called.march.source.address = address
    assert own.fallback_seconds == before
    with python_time.measured(called, clock):
        np.linalg.norm(np.ones(1000))
    assert own.fallback_seconds > before
