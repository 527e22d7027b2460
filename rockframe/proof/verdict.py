"""What has been proved of a run, in numbers and words."""

import math
from dataclasses import dataclass

from flint import arb, ctx

from rockframe.dynamics.rigid_ground import BlockOnRigidGround, RockingCorner
from rockframe.proof.flow import point
from rockframe.proof.march import March, Watch
from rockframe.proof.problem import BearingCorner, Problem, Undecided, ground_at_samples
from rockframe.signals import Motion
from rockframe.signals.slope import Slope
from rockframe.system.bodies import OverturningAngles

SAFE = "safe for ever"
OVERTURNS = "overturns"
UNDECIDED = "undecided"
PRECISIONS = (106, 212, 424)
"""Bits of the balls, one after the other while nothing is decided."""


@dataclass(frozen=True)
class Proof:
    """A proved verdict, or why none was reached; :func:`rockframe.prove` gives it.

    Parameters
    ----------
    verdict : {"safe for ever", "overturns", "undecided"}
        What is proved.
    reason : str
        Why nothing is; empty of a proof.
    earliest, latest : float
        Between which the rotation reaches the overturning angle; where the way ended of what is
        undecided; NaN of a block that is safe [s].
    width : float
        Greatest radius of the rotations enclosed at the samples [rad].
    impacts : int
        Number of impacts enclosed one by one.
    bits : int
        Precision of the balls.
    scale, restitution_tolerance : float
        What it was proved of [1].
    """

    verdict: str
    reason: str
    earliest: float
    latest: float
    width: float
    impacts: int
    bits: int
    scale: float
    restitution_tolerance: float

    @property
    def decided(self) -> bool:
        """Whether anything is proved."""
        return self.verdict != UNDECIDED

    @property
    def overturns(self) -> bool | None:
        """Whether the block overturns; None where that is undecided."""
        return self.verdict == OVERTURNS if self.decided else None

    def __str__(self) -> str:
        """Say what has been proved, and of what."""
        tolerance = self.restitution_tolerance
        of = "for the numbers of this block and this record, joined by straight lines, and for "
        of += "Housner's law"
        if tolerance:
            of += f", with every restitution within {tolerance:g} of the given one"
        if not self.decided:
            return (
                f"Undecided: {self.reason}, at {self.latest:.6g} s; rotations were enclosed "
                f"within {self.width:.2g} rad. Nothing is proved."
            )
        found = "does not overturn, however long it stands on the still ground afterwards"
        if self.verdict == OVERTURNS:
            found = f"overturns between {self.earliest:.12g} s and {self.latest:.12g} s"
        return (
            f"Proved: the block {found}; {of}, in interval arithmetic. It is a theorem on the "
            "model, and says nothing of how well that describes the block."
        )


def prove_block(
    system: BlockOnRigidGround,
    motion: Motion,
    slope: Slope,
    limits: OverturningAngles,
    start: tuple[float, float],
    *,
    scale: float = 1.0,
    tolerance: float = 0.0,
    watch: Watch | None = None,
) -> Proof:
    """Prove the verdict of a block on rigid ground.

    Parameters
    ----------
    system : BlockOnRigidGround
        With finite rotation.
    motion : Motion
        A record.
    slope : Slope
        Of the ground.
    limits : OverturningAngles
        Rotations that are called overturning.
    start : tuple of float
        Rotation [rad] and angular velocity [rad s^-1].
    scale, tolerance : float
        Factor of the motion; what the restitutions may differ by.
    watch : callable, optional
        Is told every enclosure at a knot.

    Returns
    -------
    Proof
    """
    found = None
    for bits in PRECISIONS[:1] if tolerance else PRECISIONS:
        with ctx.workprec(bits):
            found = _tried(system, motion, slope, limits, start, scale, tolerance, watch, bits)
        if found.decided:
            break
    assert found is not None  # noqa: S101
    return found


def _tried(
    system: BlockOnRigidGround,
    motion: Motion,
    slope: Slope,
    limits: OverturningAngles,
    start: tuple[float, float],
    scale: float,
    tolerance: float,
    watch: Watch | None,
    bits: int,
) -> Proof:
    """Try it with balls of one precision."""

    def side(sign: int, corner: RockingCorner, limit: float) -> BearingCorner:
        rate = arb(corner.radius) / arb(corner.inertia)
        restitution = arb(corner.restitution) + arb(0, tolerance)
        return BearingCorner(sign, arb(corner.angle), rate, restitution, arb(limit))

    knots, still = ground_at_samples(motion, slope, scale)
    problem = Problem(
        side(1, system.right, limits.right),
        side(-1, system.left, limits.left),
        arb(motion.time_step),
        knots,
        still,
    )
    march = March(problem, watch)
    rotation, rate = start
    march.sign = int(math.copysign(1.0, rotation or rate)) if rotation or rate else 0
    march.states = point(arb(rotation), arb(rate))
    verdict, reason = UNDECIDED, ""
    earliest = latest = math.nan
    try:
        verdict = OVERTURNS if march.decide() else SAFE
    except Undecided as why:
        reason, latest = str(why), float(march.time)
        earliest = latest
    if march.overturning is not None:
        low, high = march.overturning
        earliest, latest = _outwards(low, -math.inf), _outwards(high, math.inf)
    return Proof(
        verdict, reason, earliest, latest, march.widest, march.impacts, bits, scale, tolerance
    )


def _outwards(value: object, direction: float) -> float:
    """Round to a double on the far side."""
    return math.nextafter(float(value), direction)  # type: ignore[arg-type]
