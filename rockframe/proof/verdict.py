"""What has been proved of a run, in numbers and words."""

import math
from dataclasses import dataclass

from rockframe.dynamics.rigid_ground import BlockOnRigidGround
from rockframe.proof.balls import ball, working_precision
from rockframe.proof.course import Course, Watch
from rockframe.proof.problem import Problem, Undecided
from rockframe.signals import Motion
from rockframe.signals.motion import Slope
from rockframe.system.bodies import OverturningAngles

SAFE = "safe for ever"
OVERTURNS = "overturns"
UNDECIDED = "undecided"
PRECISIONS = (106, 212, 424)
"""Bits of the balls, one after the other while nothing is decided."""
STILL_STEP = 0.1
"""Length of the intervals after a motion, times p."""


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
    law : str
        That was taken, in words.
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
    law: str = "Housner's law"

    @property
    def decided(self) -> bool:
        """Whether anything is proved."""
        return self.verdict != UNDECIDED

    @property
    def overturns(self) -> bool | None:
        """Whether the block overturns; None where that is undecided."""
        return self.verdict == OVERTURNS if self.decided else None

    def agrees(self, overturned: bool | None, end: float) -> bool:
        """Whether what is proved is what a run up to a time has shown."""
        if overturned is None or not self.decided:
            return False
        if overturned:
            return self.verdict == OVERTURNS
        return self.verdict == SAFE or self.earliest > end

    def objections(self, overturned: bool | None, end: float) -> list[str]:
        """Say where a run up to a time ends otherwise, or too early."""
        if overturned is None or not self.decided:
            return []
        if not self.agrees(overturned, end) and not self.earliest <= end <= self.latest:
            ends = "overturned" if overturned else "did not overturn"
            return [f"the run is wrong, or the proof is: the block {ends} in the run. {self}"]
        if self.verdict == OVERTURNS and not overturned:
            return [f"the block is proved to overturn after the end of the run. {self}"]
        return []

    def values(self, overturned: bool | None, end: float) -> dict[str, float | bool]:
        """Give the scalars by their names in the schema, beside a run up to a time."""
        falls = self.verdict == OVERTURNS
        return {
            "verdict_proved": self.agrees(overturned, end),
            "proved_overturning_earliest": self.earliest if falls else math.nan,
            "proved_overturning_latest": self.latest if falls else math.nan,
            "proof_width": self.width,
        }

    def attributes(self) -> dict[str, str | int]:
        """Give what a dataset says of the proof."""
        return {"proof": str(self), "proof_verdict": self.verdict, "proof_bits": self.bits}

    def __str__(self) -> str:
        """Say what has been proved, and of what."""
        tolerance = self.restitution_tolerance
        of = "for the numbers of this block and this record, joined by straight lines, and for "
        of += self.law
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
    block: BlockOnRigidGround,
    motion: Motion,
    slope: Slope,
    limits: OverturningAngles,
    start: tuple[float, float],
    *,
    scale: float = 1.0,
    tolerance: float = 0.0,
    watch: Watch | None = None,
) -> Proof:
    """Prove the verdict of a block on rigid ground, from its rotation and angular velocity.

    All restitutions within a tolerance are meant; `watch` is told every enclosure.
    """
    found = None
    for bits in PRECISIONS[:1] if tolerance else PRECISIONS:
        with working_precision(bits):
            problem = Problem.of(block, motion, slope, limits, scale, tolerance, STILL_STEP)
            course = Course(problem, watch, [ball(0, tolerance)] * 2 if tolerance else [])
            course.start(*start)
            found = _concluded(course, scale, tolerance, bits)
        if found.decided:
            break
    assert found is not None  # noqa: S101
    return found


def _concluded(course: Course, scale: float, tolerance: float, bits: int) -> Proof:
    """Follow a course to its end, and tell what it proves."""
    verdict, reason, earliest, latest = UNDECIDED, "", math.nan, math.nan
    try:
        verdict = OVERTURNS if course.overturns() else SAFE
    except Undecided as why:
        reason, earliest = str(why), float(course.time)
        latest = earliest
    if verdict == OVERTURNS and course.beyond is not None:
        low, high = course.beyond
        earliest, latest = _outwards(low.lower(), -math.inf), _outwards(high.upper(), math.inf)
    return Proof(
        verdict, reason, earliest, latest, course.widest, course.impacts, bits, scale, tolerance
    )


def _outwards(value: object, direction: float) -> float:
    """Round to a double on the far side."""
    return math.nextafter(float(value), direction)  # type: ignore[arg-type]
