"""Similar scenes, of millimetres to kilometres, have the same response to the last bit.

The exception is a square that a library rounds differently, in one scene of a thousand.

This reveals any length in metres, time in seconds or force in newtons in the code: an absolute
accuracy, a rounding floor, a speed that counts as zero.
"""

from zlib import crc32

import numpy as np
import pytest
from property.similar_scenes import DRAWN
from property.similarity import (
    differences,
    similar_arguments,
    similar_motion,
    similar_system,
)

import rockframe as rf

pytestmark = [
    pytest.mark.property,
    # random scenes may leave the range of their models, in both sizes
    pytest.mark.filterwarnings("ignore::rockframe.errors.ModelWarning"),
    pytest.mark.filterwarnings("ignore::rockframe.errors.SolverWarning"),
]

LENGTHS = (4.0**-5, 4.0**-3, 4.0**3, 4.0**5)
MASSES = (2.0**-20, 2.0**20)
ACCURACIES = ("standard", "fast", "reference")
OUTPUTS = ("energy", "acceleration", "reaction", "impulse")
FEW, MANY = 3, 200
NUDGES, MORE, LEAST = (1e-15, -2e-15, 3e-15), 1e3, 1e-10


def draw_scene(kind, number):
    """Return a scene of a kind, the arguments of its run, and the factors of lengths and masses."""
    system, motion, arguments = DRAWN[kind](np.random.default_rng([crc32(kind.encode()), number]))
    arguments |= {"accuracy": ACCURACIES[number % 3], "outputs": OUTPUTS}
    # a motion made from samples only
    return (
        system,
        similar_motion(motion, 1.0),
        arguments,
        LENGTHS[number // 3 % 4],
        MASSES[number % 2],
    )


def compare(kind, numbers):
    """Check that scenes have similar responses in another size."""
    for number in numbers:
        system, motion, arguments, length, mass = draw_scene(kind, number)
        response = system.simulate(motion, **arguments)
        other = similar_system(system, length, mass).simulate(
            similar_motion(motion, length), **similar_arguments(arguments, length, mass)
        )
        differing = differences(response, other, length, mass)
        if differing:  # by the rounding of a square, and not more than nudges of that size cause
            nudged = [
                differences(
                    response,
                    system.simulate(similar_motion(motion, 1.0, nudge), **arguments),
                    1.0,
                    1.0,
                )
                for nudge in NUDGES
            ]
            largest = {
                name: max(LEAST, MORE * max(each.get(name, 0.0) for each in nudged))
                for name in differing
            }
            assert all(difference <= largest[name] for name, difference in differing.items()), (
                kind,
                number,
                differing,
            )


@pytest.mark.wide
@pytest.mark.parametrize(
    "kind",
    # columns with ties take longest to compile; sliding blocks with ties remain
    [pytest.param(kind, marks=[pytest.mark.long] * (kind == "ties")) for kind in DRAWN],
)
def test_scaled_scene_gives_scaled_response(kind):
    compare(kind, range(FEW))


@pytest.mark.long
@pytest.mark.parametrize("kind", DRAWN)
def test_many_scaled_scenes_give_scaled_responses(kind):
    compare(kind, range(FEW, MANY))


@pytest.mark.parametrize("kind", ["pads", "coupled", "ties", "held", "stack of mixed bases"])
@pytest.mark.parametrize("length", LENGTHS)
def test_scaled_scene_has_scaled_statics(kind, length):
    system, *_ = draw_scene(kind, 0)
    other = similar_system(system, length, MASSES[0])
    assert not differences(system.equilibrium(), other.equilibrium(), length, MASSES[0])
    angles = (np.linspace(-0.2, 0.2, 9), "rad")
    response, two = (each.moment_rotation(angles) for each in (system, other))
    assert not differences(response, two, length, MASSES[0])


@pytest.mark.parametrize("length", LENGTHS[::3])
def test_critical_scale_and_sweep_do_not_depend_on_size(length):
    system, motion, *_ = draw_scene("slides", 0)
    sizes = (system, motion), (similar_system(system, length, 1.0), similar_motion(motion, length))
    found = [
        rf.critical_scale(*response, scales=8, runs=16, largest=20.0, progress=False)
        for response in sizes
    ]
    assert found[0].critical_scale > 0.0
    assert not differences(*found, length, 1.0)
    runs = [
        rf.sweep(*response, scale=[0.5, 2.0], accuracy="screen", progress=False)
        for response in sizes
    ]
    assert not differences(*runs, length, 1.0)
