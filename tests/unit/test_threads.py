"""One system in several threads at a time."""

import sys
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from time import sleep

import pytest

import rockframe as rf
from rockframe.dynamics.protocol import Ground, Start

pytestmark = pytest.mark.unit

LOW = rf.Block(width="1 m", height="2 m", mass="3 t")
PADS = rf.TwoSpringSupport(frequency_ratio=20, damping_ratio=0.1, friction=0.35)
WORKERS = 4


@pytest.fixture(autouse=True)
def _frequent_switches() -> Iterator[None]:
    before = sys.getswitchinterval()
    sys.setswitchinterval(1e-5)
    yield
    sys.setswitchinterval(before)


def in_threads(function, values):
    with ThreadPoolExecutor(WORKERS) as pool:
        return list(pool.map(function, values))


@pytest.mark.parametrize("base", [PADS, rf.RigidGround(friction=0.5)])
def test_each_thread_has_its_own_equations_of_a_stack(base):
    system = rf.System(rf.Stack(LOW, LOW, interfaces=base), base)
    ground = Ground(1.0, 0.0)

    def forces(rotation):
        model = system.assembly.model
        mode, state, memory = model.initial(Start(rotation=rotation, angular_velocity=0.1))
        slope = model.system.accelerate(mode, state, ground)
        return [float(one) for one in model.system.observe(mode, state, slope, ground, memory)]

    rotations = [-0.2, -0.1, 0.05, 0.15]
    alone = [forces(one) for one in rotations]
    assert in_threads(forces, rotations * 40) == alone * 40


def test_one_thread_at_a_time_sets_the_precision_of_proofs():
    balls = pytest.importorskip("rockframe.proof.balls")
    before = balls.bits()

    def precision(wanted):
        with balls.working_precision(wanted):
            sleep(1e-4)
            return balls.bits()

    wanted = [106, 212, 424] * 20
    assert in_threads(precision, wanted) == wanted
    assert balls.bits() == before
