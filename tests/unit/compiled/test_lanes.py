"""Fields of many runs in one array, and functions bound to the class of their systems."""

from typing import NamedTuple

import numpy as np
import pytest
from plain_python import plain_python

from rockframe.compiled import (
    COMPILED,
    LANES,
    BoundFunction,
    Vector,
    as_integers,
    bind_in_lanes,
    entry,
    inlined,
    kernel,
    lane_of,
    numbers_in,
)
from rockframe.compiled.bound import structure_of
from rockframe.compiled.language import tuple_from

pytestmark = pytest.mark.unit


class Spring(NamedTuple):
    stiffness: float
    count: int


class Oscillator(NamedTuple):
    spring: Spring
    mass: float
    hangs: bool

    @kernel
    def lanes_pull(self, x: float) -> float:
        pull = -self.spring.stiffness * self.spring.count * x / self.mass
        return pull - 9.81 if self.hangs else pull


@inlined
def pull_all(system_of, lanes: int, room: Vector) -> int:
    for lane in range(lanes):
        fields = lane_of(room, 0, lane)
        fields[1] = system_of(lane_of(room, 2, lane)).lanes_pull(fields[0])
        counts = lane_of(as_integers(room), 6, lane)
        counts[0] += 1 if fields[1] > 0.0 else 0
    return lanes


@entry
def pull_once(pulls: BoundFunction, room: Vector, numbers: Vector) -> int:
    return pulls.call(LANES, room, numbers)


def systems():
    return [Oscillator(Spring(2.0 + k, k), 0.5 + 0.1 * k, k % 3 == 0) for k in range(LANES)]


def filled_room():
    room = np.zeros((7, LANES))
    room[0] = np.linspace(-1.0, 1.0, LANES)
    room[2:6] = np.transpose([numbers_in(system) for system in systems()])
    return room


def test_tuple_is_rebuilt_from_its_numbers():
    system = systems()[3]
    rebuilt = tuple_from(structure_of(system))(numbers_in(system))
    assert rebuilt == system
    assert [type(value) for value in rebuilt] == [Spring, float, bool]


@pytest.mark.parametrize("mode", ["compiled", "plain"])
def test_each_lane_has_its_own_system(mode, tmp_path, monkeypatch):
    monkeypatch.setenv("ROCKFRAME_CACHE_DIR", str(tmp_path))
    room = filled_room()
    pulls = bind_in_lanes(pull_all, systems()[0])
    if mode == "plain":
        with plain_python():
            assert pulls.call(LANES, room.reshape(-1), np.zeros(0)) == LANES
    else:
        if not COMPILED:
            pytest.skip("compilation is off in this run")
        assert pull_once(pulls, room.reshape(-1), np.zeros(0)) == LANES
        assert pulls.source.address
    x = np.linspace(-1.0, 1.0, LANES)
    expected = [system.lanes_pull(float(place)) for system, place in zip(systems(), x, strict=True)]
    assert room[1].tolist() == expected
    assert room[6].view(np.int64).tolist() == [int(value > 0.0) for value in expected]
