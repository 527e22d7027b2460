"""Different scenes that have the same motion exactly: gravity and acceleration, joined halves."""

import numpy as np
import pytest

import rockframe as rf

pytestmark = pytest.mark.analytical

GRAVITY, LIFT, STEP, COUNT = 9.80665, 2.0, 0.02, 200
BLOCK = rf.Block(width="1.2 m", height="4 m", mass="8 t", centre_of_mass=("2 m", "0.04 m"))
UPPER = rf.Block(width="1 m", height="2.5 m", mass="2 t")
LOWER = rf.Block(width="1.2 m", height="2 m", mass="4 t")
TIE = rf.Restrainer(
    on=("-0.6 m", "3 m"), to=("-2 m", "0 m"), stiffness="1 MN/m", slack="5 mm", damping="3 kN s/m"
)
ROUGH = rf.RigidGround(friction=0.32, kinetic_friction=0.27)
COLUMN = rf.Block(width="1.2 m", height="4 m", mass="8 t")
ON_RIGID_GROUND = {
    "block": (BLOCK,),
    "block that slides": (BLOCK, ROUGH),
    "block that slides, with a tie": (BLOCK, ROUGH, TIE),
    "block before a wall": (COLUMN, rf.RearWall()),
    "frame with a tendon": (
        rf.RockingFrame(COLUMN, columns=3, beam_mass="10 t"),
        rf.Tendon(stiffness="1 MN/m", preload="20 kN"),
    ),
    "stack that slides": (
        rf.Stack(UPPER, LOWER, interfaces=[rf.RigidGround(friction=0.25)]), ROUGH,
    ),
}  # fmt: skip
PADS = {"stiffness": "8 MN/m", "damping": "40 kN s/m"}
ON_COMPLIANT_BASES = {
    "pads": (rf.TwoSpringSupport(**PADS), 16e6),
    "pads with friction": (rf.TwoSpringSupport(**PADS, friction=0.3), 16e6),
    "soil": (rf.WinklerSoil(stiffness="20 MPa", damping="60 kPa s"), 24e6),
}


def shaken(peak, vertical=None, seed=3):
    """Return noise, with a vertical component or without one."""
    noise = np.convolve(np.random.default_rng(seed).normal(size=COUNT), np.hanning(21), "same")
    across = (peak * noise / np.abs(noise).max(), "m/s^2")
    up = None if vertical is None else (vertical, "m/s^2")
    return rf.GroundMotion.from_arrays(across, f"{STEP} s", vertical=up)


def run(parts, motion, initial=None, **options):
    return rf.System(*parts, **options).simulate(motion, initial=initial, accuracy="reference")


def check_same(one, other, name, tolerance=1e-9):
    """Compare the histories of two runs that must rock, or slip, noticeably."""
    first, second = one[name].values, other[name].values
    count = min(len(first), len(second))
    assert np.nanmax(np.abs(first)) > 1e-3
    assert bool(one.overturned) == bool(other.overturned)
    np.testing.assert_allclose(
        first[:count], second[:count], rtol=0.0, atol=tolerance * np.nanmax(np.abs(first))
    )


@pytest.mark.parametrize("scene", list(ON_RIGID_GROUND))
def test_ground_that_accelerates_upwards_adds_to_gravity(scene):
    parts = ON_RIGID_GROUND[scene]
    accelerated = run(parts, shaken(8.0, np.full(COUNT, LIFT)))
    heavier = run(parts, shaken(8.0), gravity=f"{GRAVITY + LIFT!r} m/s^2")
    for name in ["rotation"] * ("stack" not in scene) + ["slip"] * ("slides" in scene):
        check_same(accelerated, heavier, name)


@pytest.mark.parametrize("base", list(ON_COMPLIANT_BASES))
def test_ground_that_accelerates_upwards_adds_to_gravity_on_compliant_bases(base):
    """The start is the same too: at rest under the weight without the acceleration."""
    part, stiffness = ON_COMPLIANT_BASES[base]
    rise = 8e3 * LIFT / stiffness
    start = rf.InitialState(vertical_displacement=f"{rise!r} m")
    accelerated = run((COLUMN, part), shaken(5.0, np.full(COUNT, LIFT)))
    heavier = run(
        (COLUMN, part), shaken(5.0), initial=start, gravity=f"{GRAVITY + LIFT!r} m/s^2"
    )  # fmt: skip
    check_same(accelerated, heavier, "rotation")


@pytest.mark.filterwarnings("ignore:.*exceeds eps_max")
@pytest.mark.parametrize("rule", ["contact-state", "leading-corner", "centre"])
@pytest.mark.parametrize("base", ["pads", "soil", "rigid ground"])
def test_halves_that_ties_press_together_move_as_one_block(base, rule):
    """Their forces and constraints are the same; restitutions of pads below 1 act differently."""
    bases = {
        "pads": rf.TwoSpringSupport(**PADS, restitution=1.0),
        "soil": ON_COMPLIANT_BASES["soil"][0], "rigid ground": rf.RigidGround(),
    }  # fmt: skip
    half = rf.Block(width="1.2 m", height="2 m", mass="4 t")
    ties = [
        rf.Restrainer(
            on=(f"{side} m", "0.2 m"), to=(f"{side} m", "1.8 m"), to_body=2,
            stiffness="1 MN/m", preload="3 MN", name=f"tie at {side} m",
        )
        for side in (-0.5, 0.5)
    ]  # fmt: skip
    halves = rf.Stack(half, half, interfaces=[rf.RigidGround()])
    motion = shaken(4.5, 2.0 * np.sin(10.0 * STEP * np.arange(COUNT)), seed=5)
    joined = run((halves, bases[base], *ties), motion, restraint=rule)
    one = run((COLUMN, bases[base]), motion, restraint=rule)
    check_same(joined, one, "rotation", 1e-7)  # an impulse opens the joint for microseconds


@pytest.mark.parametrize("count", [2, 6, 15])
def test_equal_drums_rock_as_one_block_until_their_first_impact(count):
    """The joints above remain closed: their share of the overturning moment is smaller."""
    joint, pulse = rf.RigidGround(), rf.GroundMotion.sine_pulse("1.6 m/s^2", "0.8 Hz")
    drum = rf.Block(width="1.6 m", height="0.9 m", mass="2 t")
    column = rf.Block(width="1.6 m", height=f"{0.9 * count!r} m", mass=f"{2 * count} t")
    runs = [
        rf.System(part, joint).simulate(
            pulse.scaled(15.0 / count), duration="0.7 s", accuracy="reference"
        )
        for part in (rf.Stack(*[drum] * count, interfaces=joint), column)
    ]
    assert runs[0].event_time.values == pytest.approx(runs[1].event_time.values)
    assert float(runs[1].peak_rotation) > 1e-3
    np.testing.assert_allclose(runs[0].rotation, runs[1].rotation, rtol=0.0, atol=1e-12)
