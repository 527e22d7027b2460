"""Stacks on rigid and other bases, held at a rotation that lifts a corner off a rigid base."""

import numpy as np
import pytest

import rockframe as rf

pytestmark = pytest.mark.analytical

GRAVITY = 9.80665
BLOCK = rf.Block(width="1 m", height="4 m", mass="4 t")
STATUE = rf.Block(width="0.8 m", height="1.2 m", mass="1 t")
PADS = rf.TwoSpringSupport(stiffness="2 MN/m", damping_ratio=0.1)
SOIL = rf.WinklerSoil(stiffness="20 MPa", damping_ratio=0.1)
JOINT = rf.RigidGround()
ABOVE_LIFT = np.array([0.03, 0.06, 0.12, 0.2])


def held(*parts, angles=ABOVE_LIFT):
    return rf.System(*parts).moment_rotation((angles, "rad"))


def statue_alone(angles):
    return 1e3 * GRAVITY * (0.4 * np.cos(angles) - 0.6 * np.sin(angles))


SCENES = {
    "statue on a block on pads": (rf.Stack(STATUE, BLOCK, interfaces=[JOINT]), PADS),
    "on soil": (rf.Stack(STATUE, BLOCK, interfaces=[JOINT]), SOIL),
}  # fmt: skip


@pytest.mark.parametrize("name", SCENES)
def test_highest_body_rocks_after_lift_off_on_any_base(name):
    state = held(*SCENES[name])
    np.testing.assert_allclose(state.restoring_moment, statue_alone(ABOVE_LIFT), rtol=1e-12)
    assert (state.held_contact_state == 2).all()  # on its right corner


@pytest.mark.parametrize("name", SCENES)
def test_restoring_moment_is_continuous_at_lift_off(name):
    angles = np.linspace(0.0005, 0.03, 60)
    state = held(*SCENES[name], angles=angles)
    couple, lifts = state.restoring_moment.values, statue_alone(angles)
    assert couple == pytest.approx(np.minimum(couple, lifts), rel=1e-9)
    lifted = state.held_contact_state.values == 2
    assert not lifted[0]
    assert np.flatnonzero(np.diff(lifted)).size == 1  # once and for all
    steps = np.abs(np.diff(couple))
    assert steps[lifted[1:] & ~lifted[:-1]].max() <= 1.01 * steps[~lifted[1:]].max()
    opposite = held(*SCENES[name], angles=-angles)
    np.testing.assert_allclose(opposite.restoring_moment, -couple, rtol=1e-9)
    np.testing.assert_allclose(opposite.base_moment, -state.base_moment, rtol=1e-9)


@pytest.mark.parametrize("lean", [0.2, -0.2])
def test_joint_of_leaning_stack_lifts_to_either_side_of_rest(lean):
    """Between upright and rest too, the couple is at most that which lifts a corner."""
    low = BLOCK.replace(centre_of_mass=("2 m", f"{lean} m"))
    soft = SOIL.replace(stiffness="8 MPa")
    parts = rf.Stack(STATUE, low, interfaces=[JOINT]), soft
    rest = rf.System(*parts).equilibrium().rest_rotation.item()
    assert rest * lean > 0.0
    assert abs(rest) > 0.01
    angles = np.sign(lean) * np.array([-0.02, -1e-9, 0.0, 1e-9, 0.004])
    state = held(*parts, angles=angles)
    lifts = -np.sign(lean) * statue_alone(-np.sign(lean) * angles)
    np.testing.assert_allclose(state.restoring_moment, lifts, rtol=1e-12)
    assert (state.held_contact_state == (1 if lean > 0.0 else 2)).all()
    (closed,) = held(*parts, angles=np.array([rest])).restoring_moment
    assert abs(closed) < 1e-9 * 1e3 * GRAVITY


@pytest.mark.parametrize("base", [PADS, SOIL])
def test_held_contact_is_that_of_highest_body_on_its_joint(base):
    """A flat body on a tall block, which leaves its base first: the joint stays closed."""
    low = rf.Block(width="0.8 m", height="4 m", mass="1 t")
    flat = rf.Block(width="0.8 m", height="0.4 m", mass="8 t")
    angles = np.array([-0.07, -0.02, 0.0, 0.02, 0.07])
    state = held(rf.Stack(flat, low, interfaces=[JOINT]), base, angles=angles)
    assert (state.held_contact_state == 0).all()
    bare = held(flat.replace(height="4.4 m", mass="9 t"), base, angles=angles)
    assert set(bare.held_contact_state.values) == {0, 1, 2}


def test_body_below_carries_weight_at_bearing_corner():
    (moment,) = np.unique(held(*SCENES["statue on a block on pads"]).base_moment.values.round(6))
    # the block with a mass of 1 t at its upper right corner of the joint
    middle, level = (1.0 * 0.4) / 5.0, (4.0 * 2.0 + 1.0 * 4.0) / 5.0
    loaded = rf.Block(
        width="1 m", height="4 m", mass="5 t",
        centre_of_mass=(f"{level} m", f"{middle} m"),
    )  # fmt: skip
    rotation = rf.System(loaded, PADS).equilibrium().rest_rotation.item()
    across = middle * np.cos(rotation) + level * np.sin(rotation)
    assert moment == pytest.approx(5e3 * GRAVITY * across, rel=1e-9)


def test_stiff_tied_stack_rocks_as_one_body_on_rigid_base():
    # a statue on stiff pads on a block on rigid ground, tied down to the block
    stiff = rf.TwoSpringSupport(stiffness="400 MN/m", damping_ratio=0.1)
    ties = [
        rf.Restrainer(
            on=(f"{x} m", "0.3 m"), to=(f"{x} m", "3.8 m"), on_body=1, to_body=2,
            stiffness="200 MN/m",
        )
        for x in (-0.4, 0.4)
    ]  # fmt: skip
    angles = np.array([0.02, 0.05])
    state = held(rf.Stack(STATUE, BLOCK, interfaces=[stiff]), JOINT, *ties, angles=angles)
    level = (1.0 * 4.6 + 4.0 * 2.0) / 5.0
    about = 5e3 * GRAVITY * (0.5 * np.cos(angles) - level * np.sin(angles))
    np.testing.assert_allclose(state.restoring_moment, about, rtol=0.01)


@pytest.mark.filterwarnings("ignore:restrainer 1. its point:rockframe.errors.ModelWarning")
def test_restrainer_pulls_on_lifted_body():
    tie = rf.Restrainer(on=("-0.4 m", "4.5 m"), to=("-2 m", "0 m"), stiffness="20 kN/m")
    scene = SCENES["statue on a block on pads"]
    tied, free = held(*scene, tie), held(*scene)
    assert (tied.restoring_moment > free.restoring_moment + 1e3).all()
    other = held(*scene, tie, angles=-ABOVE_LIFT)  # slack on that side
    np.testing.assert_allclose(other.restoring_moment, -free.restoring_moment, rtol=1e-9)


@pytest.mark.parametrize("ratio", [8, 40, 1000])
def test_highest_body_rocks_about_its_corner_on_stiff_joints(ratio):
    """From a rotation of some microns over a metre, far below the requested ones."""
    block = rf.Block(width="1 m", height="2 m", mass="10 t")
    stiff = rf.TwoSpringSupport(frequency_ratio=1000, damping_ratio=0.1)
    stack = rf.Stack(block, block, block, interfaces=[stiff, stiff])
    base = rf.TwoSpringSupport(frequency_ratio=ratio, damping_ratio=0.1)
    rotations = np.array([0.01, 0.05, 0.15])
    found = rf.System(stack, stiff).moment_rotation((rotations, "rad")).restoring_moment
    rocks = 1e4 * GRAVITY * (0.5 * np.cos(rotations) - np.sin(rotations))
    assert found.values == pytest.approx(rocks, rel=1e-4)
    softer = rf.System(stack, base).moment_rotation((rotations, "rad")).restoring_moment
    assert (softer.values <= (1.0 + 1e-9) * found.values).all()
