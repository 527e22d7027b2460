"""Ends of block and cap in sliding contact, without a reaction, :eq:`eq-sliding-contact`."""

from typing import NamedTuple

from rockframe.compiled import kernel
from rockframe.dynamics.body import Attitude, BaseLine
from rockframe.dynamics.coupled.motion import (
    Configuration,
    CoupledMotion,
    Forces,
    KnownTerms,
    Pair,
    normal_change,
    solve_motion,
)
from rockframe.dynamics.on_base import Mode, OnBase
from rockframe.dynamics.stacked import Modes, States

NOTHING = Forces(0.0, 0.0, 0.0, 0.0)


class SlidingEnd(NamedTuple):
    """The end of a base that slides: its lever, the lever's rate by the rotation, its speed."""

    lever: float
    bend: float
    speed: float


class Rises(NamedTuple):
    """Accelerations, along their normals, of the block's end and of the cap's."""

    block: float
    cap: float


class Slips(NamedTuple):
    """Accelerations of slip that keep sliding ends at their levels, and the power of the holds."""

    swing: float
    drift: float
    power: float


@kernel
def sliding_end(part: OnBase, mode: Mode, attitude: Attitude, line: BaseLine) -> SlidingEnd:
    """Return the sliding end of a body; the result has no meaning where none slides."""
    left = part.base.is_held(mode.contact, True)
    on_left, on_right = part.body.end_accelerations(attitude, 1.0, 0.0, 0.0)
    if left:
        return SlidingEnd(line.left_lever, on_left, line.left_speed)
    return SlidingEnd(line.right_lever, on_right, line.right_speed)


@kernel
def rises(
    place: Configuration, motion: CoupledMotion, press: float, block: SlidingEnd, cap: SlidingEnd
) -> Rises:
    """Return the contributions of a motion to the accelerations of both sliding ends."""
    normal = press + normal_change(place, motion)
    return Rises(
        normal + block.lever * motion.angular, motion.cap_vertical + cap.lever * motion.cap_angular
    )


@kernel
def slide_both(
    pair: Pair, modes: Modes, states: States, place: Configuration, block: SlidingEnd,
    cap: SlidingEnd, forces: Forces, known: KnownTerms, normal: float,
) -> Slips:  # fmt: skip
    """Return the slips that keep sliding ends at their levels, :eq:`eq-sliding-contact`.

    They are given as additions to `swing` and `drift`, with the power of the holds on the slips,
    which is negative. `place` has both bodies held; `normal` is the known part of the block's
    acceleration along the cap's normal.
    """
    cap_rate, block_rate = states.lower.angular_velocity, states.upper.angular_velocity
    motion = solve_motion(pair, place, forces, known)
    found = rises(place, motion, forces.press, block, cap)
    # an end below its base's level rises with the base, which returns without a force
    of_block = found.block + normal + block.bend * block_rate * block_rate
    of_block += pair.upper.base.following_rate() * block.speed
    of_cap = found.cap + cap.bend * cap_rate * cap_rate
    of_cap += pair.lower.base.following_rate() * cap.speed
    by_block = rises(
        place, solve_motion(pair, place, NOTHING, KnownTerms(0.0, 1.0, 0.0, 0.0)), 0.0, block, cap
    )
    by_cap = rises(
        place, solve_motion(pair, place, NOTHING, KnownTerms(1.0, 0.0, 0.0, 0.0)), 0.0, block, cap
    )
    if not modes.upper.slides:
        drift, swing = 0.0, -of_cap / by_cap.cap
    elif not modes.lower.slides:
        drift, swing = -of_block / by_block.block, 0.0
    else:
        determinant = by_block.block * by_cap.cap - by_cap.block * by_block.cap
        drift = (by_cap.block * of_cap - by_cap.cap * of_block) / determinant
        swing = (by_block.cap * of_block - by_block.block * of_cap) / determinant
    with_slips = KnownTerms(known.swing + swing, known.drift + drift, known.load_x, known.load_y)
    motion = solve_motion(pair, place, forces, with_slips)
    power = 0.0
    if modes.upper.slides:
        slip = states.upper.horizontal_velocity - place.block_reach.rate * block_rate
        power += motion.thrust * slip
    if modes.lower.slides:
        slip = states.lower.horizontal_velocity - place.cap_reach.rate * cap_rate
        hold = place.cosine * motion.thrust + place.sine * forces.press
        power += (pair.cap_mass * (motion.cap_horizontal + known.load_x) + hold) * slip
    return Slips(swing, drift, power)
