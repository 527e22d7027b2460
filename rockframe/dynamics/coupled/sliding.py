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
from rockframe.dynamics.on_base import BodyOnBase, Mode
from rockframe.dynamics.stacked import Modes, States

NO_FORCES = Forces(0.0, 0.0, 0.0, 0.0)


class SlidingEnd(NamedTuple):
    """The end of a base that slides: its lever, the lever's rate by the rotation, its speed."""

    lever: float
    lever_derivative: float
    speed: float


class EndAccelerations(NamedTuple):
    """Accelerations, along their normals, of the block's end and of the cap's."""

    block: float
    cap: float


class SlipAccelerations(NamedTuple):
    """Slip accelerations that keep sliding ends at their levels, and the power of the holds."""

    cap_horizontal: float
    block_along: float
    power: float


@kernel
def sliding_end(part: BodyOnBase, mode: Mode, attitude: Attitude, line: BaseLine) -> SlidingEnd:
    """Return the sliding end of a body; the result has no meaning where none slides."""
    left = part.base.is_held(mode.contact, True)
    on_left, on_right = part.body.end_accelerations(attitude, 1.0, 0.0, 0.0)
    if left:
        return SlidingEnd(line.left_lever, on_left, line.left_speed)
    return SlidingEnd(line.right_lever, on_right, line.right_speed)


@kernel
def end_contributions(
    geometry: Configuration, motion: CoupledMotion, force: float, block: SlidingEnd, cap: SlidingEnd
) -> EndAccelerations:
    """Return the contributions of a motion to the accelerations of both sliding ends."""
    normal = force + normal_change(geometry, motion)
    return EndAccelerations(
        normal + block.lever * motion.angular, motion.cap_vertical + cap.lever * motion.cap_angular
    )


@kernel
def slip_accelerations(
    pair: Pair, modes: Modes, states: States, geometry: Configuration, block: SlidingEnd,
    cap: SlidingEnd, forces: Forces, known: KnownTerms, normal: float,
) -> SlipAccelerations:  # fmt: skip
    """Return the slips that keep sliding ends at their levels, :eq:`eq-sliding-contact`.

    They add to `cap_horizontal` and `block_along` of the known terms. The power of the holds on
    the slips is negative. In `geometry` both bodies are held; `normal` is the known part of the
    block's acceleration along the cap's normal.
    """
    cap_rate, block_rate = states.lower.angular_velocity, states.upper.angular_velocity
    motion = solve_motion(pair, geometry, forces, known)
    ends = end_contributions(geometry, motion, forces.normal, block, cap)
    # an end below its base's level rises with the base, which returns without a force
    of_block = ends.block + normal + block.lever_derivative * block_rate * block_rate
    of_block += pair.upper.base.following_rate() * block.speed
    of_cap = ends.cap + cap.lever_derivative * cap_rate * cap_rate
    of_cap += pair.lower.base.following_rate() * cap.speed
    unit = solve_motion(pair, geometry, NO_FORCES, KnownTerms(0.0, 1.0, 0.0, 0.0))
    by_block = end_contributions(geometry, unit, 0.0, block, cap)
    unit = solve_motion(pair, geometry, NO_FORCES, KnownTerms(1.0, 0.0, 0.0, 0.0))
    by_cap = end_contributions(geometry, unit, 0.0, block, cap)
    if not modes.upper.slides:
        block_term, cap_term = 0.0, -of_cap / by_cap.cap
    elif not modes.lower.slides:
        block_term, cap_term = -of_block / by_block.block, 0.0
    else:
        determinant = by_block.block * by_cap.cap - by_cap.block * by_block.cap
        block_term = (by_cap.block * of_cap - by_cap.cap * of_block) / determinant
        cap_term = (by_block.cap * of_block - by_block.block * of_cap) / determinant
    with_slips = KnownTerms(
        known.cap_horizontal + cap_term, known.block_along + block_term, known.load_x, known.load_y
    )
    motion = solve_motion(pair, geometry, forces, with_slips)
    power = 0.0
    if modes.upper.slides:
        slip = states.upper.horizontal_velocity - geometry.block_reach.derivative * block_rate
        power += motion.thrust * slip
    if modes.lower.slides:
        slip = states.lower.horizontal_velocity - geometry.cap_reach.derivative * cap_rate
        hold = geometry.cosine * motion.thrust + geometry.sine * forces.normal
        power += (pair.cap_mass * (motion.cap_horizontal + known.load_x) + hold) * slip
    return SlipAccelerations(cap_term, block_term, power)
