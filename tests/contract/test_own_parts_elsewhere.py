"""Users' own parts in other processes: the same results, or a clear error."""

import pickle
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context

import pytest
from user_examples import FILE, FOLDER, SCENE_FILE, example

import rockframe as rf
from rockframe.errors import AssemblyError

pytestmark = pytest.mark.contract

BLOCK = rf.Block(width="1 m", height="4 m", mass="10 t")
PADS = rf.TwoSpringSupport(frequency_ratio=20, damping_ratio=0.1)
PULSE = rf.GroundMotion.sine_pulse(amplitude="-4 m/s^2", frequency="1 Hz")
POINTS = {"on": ("-0.5 m", "3 m"), "to": ("-1.5 m", "3 m"), "stiffness": "50 kN/m"}
OWN = {
    FILE: lambda own: [
        own.YieldingPads(frequency_ratio=15, damping_ratio=0.05, strength=0.7, hardening=0.1)
    ],
    FOLDER / "own_link.py": lambda own: [PADS, own.Rope(**POINTS, reach="0.1 m")],
    SCENE_FILE: lambda own: [own.SlidingGround(friction=0.26)],
}


@pytest.mark.parametrize(("file", "parts_of"), OWN.items(), ids=lambda value: "")
def test_part_that_this_process_has_not_registered_is_named(file, parts_of):
    with example(file) as own:
        parts = parts_of(own)
        sent = pickle.dumps(rf.System(BLOCK, *parts))
    received = pickle.loads(sent)  # noqa: S301
    for use in (received.simulate, lambda motion: rf.sweep(received, motion, scale=[1, 2])):
        with pytest.raises(AssemblyError, match=f"{type(parts[-1]).__name__}.* registered"):
            use(PULSE)


@pytest.mark.wide
@pytest.mark.parametrize(("file", "parts_of"), OWN.items(), ids=lambda value: "")
def test_pool_gives_the_same_bits(file, parts_of, monkeypatch):
    monkeypatch.syspath_prepend(FOLDER)
    with example(file) as own:
        system = rf.System(BLOCK, *parts_of(own))
        arguments = {"scale": [0.3, 0.6, 0.9, 1.2], "free_vibration": "1 s", "chunk": 1}
        runs = rf.sweep(system, PULSE, **arguments)
        with ProcessPoolExecutor(2, mp_context=get_context("spawn")) as pool:
            again = rf.sweep(system, PULSE, **arguments, executor=pool)
    assert again.drop_attrs().identical(runs.drop_attrs())
