"""Tied bodies that are brought slowly to a rotation, and ties whose points coincide."""

import math

import pytest

import rockframe as rf

pytestmark = pytest.mark.analytical

PAD, TIE = 4e6, 20e6
HALF, STRENGTH = 0.5, 15e3
BLOCK = rf.Block(width="1 m", height="4 m", mass="4 t")
PADS = rf.TwoSpringSupport(stiffness=f"{PAD} N/m", damping="0 N*s/m")
HOLD_DOWN = rf.Restrainer(
    on=("-0.5 m", "0 m"), to=("-0.5 m", "-3 m"), stiffness=f"{TIE} N/m", strength=f"{STRENGTH} N"
)


def tie_force(rotation):
    """Return the tie force before fracture, including the compression of the pads."""
    return TIE * HALF * math.sin(rotation) * 2.0 * PAD / (2.0 * PAD + TIE)


@pytest.mark.parametrize("share", [0.1, 0.5, 0.9, 0.99, 1.01, 1.2, 3.0])
def test_tie_holds_up_to_its_strength(share):
    """At the height of an untied body, the tie would be broken from a share of 0.29."""
    rotation = share * STRENGTH / tie_force(1e-6) * 1e-6
    held = rf.System(BLOCK, PADS, HOLD_DOWN, restraint="centre")
    free = rf.System(BLOCK, PADS, restraint="centre")
    more = held.setting.statics(rotation).restoring_moment
    more -= free.setting.statics(rotation).restoring_moment
    expected = HALF * tie_force(rotation) if share < 1.0 else 0.0
    assert more == pytest.approx(expected, rel=1e-4, abs=1e-6 * HALF * STRENGTH)


def test_tie_fracture_does_not_depend_on_number_of_rotations():
    lower = rf.Block(width="1 m", height="1 m", mass="1 t")
    tie = HOLD_DOWN.replace(to=("-0.5 m", "0.5 m"), to_body=2)
    stack = rf.Stack(BLOCK, lower, interfaces=[PADS])
    system = rf.System(stack, PADS, tie, restraint="centre")
    stronger = rf.System(stack, PADS, tie.replace(strength="1 MN"), restraint="centre")
    limit = STRENGTH / tie_force(1e-6) * 1e-6  # approximately, since the lower pads yield, too
    rotations = [share * limit for share in (0.3, 0.6, 0.9, 1.2, 3.0)]
    joint = [one.restoring_moment for one in system.setting.held_at(rotations)]
    alone = [system.setting.statics(one).restoring_moment for one in rotations]
    assert alone == pytest.approx(joint, rel=1e-9)
    assert alone[0] == pytest.approx(stronger.setting.statics(rotations[0]).restoring_moment)


def test_coincident_tie_points_tolerate_rounding():
    """A tie of zero length between points given by summed heights of bodies."""
    statue = rf.Block(width="1.294 m", height="3.574 m", mass="146 kg")
    drum = rf.Block(width="1.636 m", height="1.1 m", mass="24 t")
    foot = rf.Block(width="1.746 m", height="3.3 m", mass="104 kg")
    height = 3.3 + 0.7
    soft, stiff = (
        rf.TwoSpringSupport(stiffness=one, damping_ratio=0.1) for one in ("2 MN/m", "40 MN/m")
    )
    stack = rf.Stack(statue, drum, foot, interfaces=[soft, stiff], offsets=["0.01 m", "0.02 m"])
    where = ("0.818 m", "0.7 m")
    found = []
    for apart in (0.0, 4.0 * math.ulp(height), -4.0 * math.ulp(height)):
        to = (f"{0.818 + 0.02} m", f"{height + apart!r} m")
        tie = rf.Restrainer(on=where, on_body=2, to=to, stiffness="2.8 GN/m")
        found.append(rf.System(stack, stiff, tie).equilibrium())
    for one in found[1:]:
        assert float(one.rest_rotation) == pytest.approx(float(found[0].rest_rotation), rel=1e-9)
