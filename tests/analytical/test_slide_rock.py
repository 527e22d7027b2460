"""Sliding and rocking of the example of a user-defined scene against closed forms."""

import math

import numpy as np
import pytest
from plain_python import plain_python
from user_examples import SCENE_FILE, example

import rockframe as rf
from rockframe.dynamics.protocol import Ground

GRAVITY = 9.80665
LOW = rf.Block(width="1 m", height="1.2 m", mass="2 t")
SLENDER = rf.Block(width="1 m", height="4 m", mass="10 t")
HISTORIES = (
    "rotation", "angular_velocity", "horizontal_displacement", "vertical_displacement",
    "horizontal_acceleration", "left_reaction", "right_reaction", "base_shear", "impact_energy",
)  # fmt: skip


@pytest.fixture(scope="module", autouse=True)
def own():
    """Return the module of the example with its scene registered, in plain Python."""
    with example(SCENE_FILE) as module, plain_python():
        yield module


def standing(own, block, friction, kinetic=None):
    return rf.System(block, own.SlidingGround(friction=friction, kinetic_friction=kinetic))


def noise(sign=1.0):
    """Return a motion with content at all frequencies, or its mirror image."""
    rng = np.random.default_rng(12)
    across, upwards = (np.convolve(rng.normal(size=150), np.ones(5) / 5, "same") for _ in "xy")
    return rf.GroundMotion.from_arrays(
        (sign * 5.0 * across, "m/s^2"), "0.02 s", vertical=(2.0 * upwards, "m/s^2")
    )


def slid(own, yields, motion):
    """Return the run of a low block that slides beyond an acceleration."""
    return standing(own, LOW, yields / GRAVITY).simulate(
        motion, duration="2 s", accuracy="reference", outputs="energy"
    )


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_newmarks_block_under_a_rectangular_pulse(own, sign):
    """D = a t0^2/2 (a/ay - 1); it stops at a t0/ay."""
    motion = rf.GroundMotion.from_arrays((sign * np.full(51, 2.0), "m/s^2"), "0.01 s")
    response = slid(own, 1.0, motion)
    assert float(response.residual_slip) == pytest.approx(-sign * 0.25, rel=1e-12)
    assert response.event_time.values == pytest.approx([1.0], rel=1e-12)
    assert response.event_slip.values == pytest.approx([-sign * 0.25], rel=1e-12)
    # the weight times the friction, over the slip
    assert float(response.dissipated_energy[-1]) == pytest.approx(2000.0 * 1.0 * 0.25, rel=1e-12)
    assert float(response.energy_residual) <= 1e-12


@pytest.mark.parametrize(
    ("yields", "amplitude", "length", "distance", "stops"),
    [
        (1.0, 2.0, 0.5, 0.06910393133, 0.67730766723),
        (2.0, 3.0, 1.0, 0.16398904236, 1.06562562818),
    ],
)
def test_newmarks_block_under_half_a_sine(own, yields, amplitude, length, distance, stops):
    motion = rf.GroundMotion.half_sine_pulse(f"{amplitude} m/s^2", f"{length} s")
    response = slid(own, yields, motion)
    assert float(response.residual_slip) == pytest.approx(-distance, rel=1e-10)
    assert float(response.event_time[-1]) == pytest.approx(stops, rel=1e-10)
    assert float(response.peak_rotation) == 0.0


@pytest.mark.parametrize("friction", [1.0, 20.0])
def test_high_friction_gives_housner_block(own, friction):
    options = {
        "accuracy": "reference", "free_vibration": "2 s",
        "outputs": ["energy", "acceleration", "reaction"],
    }  # fmt: skip
    ours = standing(own, SLENDER, friction).simulate(noise(), **options)
    housner = rf.System(SLENDER).simulate(noise(), **options)
    assert int(ours.impact_count) == int(housner.impact_count) > 3
    for name in HISTORIES:
        size = float(np.abs(housner[name]).max())
        np.testing.assert_allclose(ours[name], housner[name], rtol=0.0, atol=1e-9 * size)
    assert (ours.slip == 0.0).all()


@pytest.mark.parametrize("slenderness", [2.0, 4.0, 8.0])
@pytest.mark.parametrize("share", [0.0, 0.3, 0.9])
@pytest.mark.parametrize("side", [1.0, -1.0])
def test_impacts_with_little_friction(own, slenderness, share, side):
    """A landing corner slips if friction is below 3 t/(4 + t^2)."""
    t = 1.0 / slenderness
    friction = share * 3.0 * t / (4.0 + t * t) or 1e-12
    block = rf.Block(width="1 m", height=f"{slenderness} m", mass="1 t")
    system = standing(own, block, friction).assembly.model.system
    state, memory = np.array([0.0, 0.0, 0.0, -0.3 * side]), np.zeros(5)
    mode = system.impact(3 if side > 0.0 else 6, state, Ground(0.0, 0.0), memory)
    under = 1.0 + 4.0 * t * t - 3.0 * friction * t
    after = (1.0 - 2.0 * t * t + 3.0 * friction * t) / under
    slip = 2.0 * t * (3.0 * t - 4.0 * friction - friction * t * t) / under
    assert state[3] == pytest.approx(-0.3 * side * after, rel=1e-12)
    assert state[2] == pytest.approx(-0.3 * side * slip * 0.5 * slenderness, rel=1e-9)
    assert mode == (8 if side > 0.0 else 4)
    assert memory[0] > 0.0


def test_impacts_with_sufficient_friction_match_housner(own):
    system = standing(own, SLENDER, 0.185).assembly.model.system
    state = np.array([0.0, 0.0, 0.0, -0.3])
    assert system.impact(3, state, Ground(0.0, 0.0), np.zeros(5)) == 6
    assert state[3] == pytest.approx(-0.3 * SLENDER.maximum_restitution, rel=1e-12)
    assert state[2] == 0.0


@pytest.mark.parametrize(
    "frictions",
    [
        (0.27, 0.27),
        (0.26, 0.2),
        *(pytest.param(one, marks=pytest.mark.long) for one in ((0.3, 0.3), (0.2, 0.15))),
    ],
)
def test_energy_balances_and_friction_bounds_the_shear(own, frictions):
    response, mirrored = (
        standing(own, SLENDER, *frictions).simulate(
            noise(sign), free_vibration="2 s", accuracy="reference", outputs=["energy", "reaction"]
        )
        for sign in (1.0, -1.0)
    )
    assert float(response.energy_residual) <= 1e-8
    assert float(response.dissipated_energy[-1]) > 0.0
    ratio = np.abs(response.horizontal_reaction / response.vertical_reaction)
    assert float(ratio.max()) <= frictions[0] * (1.0 + 1e-9)
    np.testing.assert_array_equal(response.rotation, -mirrored.rotation)
    np.testing.assert_array_equal(response.slip, -mirrored.slip)


@pytest.mark.parametrize("friction", [0.02, 0.15])
def test_released_block_slips_while_rocking(own, friction):
    """The centre of mass moves only as far as friction allows."""
    response = standing(own, SLENDER, friction).simulate(
        initial=rf.InitialState(rotation="0.1 rad"), duration="6 s", accuracy="reference",
        outputs=["energy", "acceleration", "reaction"],
    )  # fmt: skip
    assert int(response.impact_count) > 5
    assert float(response.residual_slip) > 0.01
    assert float(response.energy_residual) <= 1e-9
    mass = 1e4
    shear = mass * (response.horizontal_acceleration + response.ground_acceleration)
    np.testing.assert_allclose(response.horizontal_reaction, shear, atol=1e-9 * mass)


def test_thresholds_of_sliding_and_rocking(own):
    """At rest while |xg''|/g <= min(b/h, mu)."""
    for friction in 0.2, 0.4:
        least = min(friction, 0.25) * GRAVITY
        for share, moves in ((0.999, False), (1.001, True)):
            motion = rf.GroundMotion.from_arrays((np.full(51, share * least), "m/s^2"), "0.01 s")
            response = standing(own, SLENDER, friction).simulate(motion, duration="0.5 s")
            slides = bool((response.slip != 0.0).any())
            rocks = not math.isnan(float(response.first_uplift_time))
            assert (slides, rocks) == (moves and friction < 0.25, moves and friction > 0.25)
