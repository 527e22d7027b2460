"""The result of a proof, in numbers and words."""

import math
from dataclasses import dataclass
from decimal import ROUND_CEILING, ROUND_FLOOR, Context
from typing import Final, NamedTuple

SAFE: Final = "safe for ever"
OVERTURNS: Final = "overturns"
UNDECIDED: Final = "undecided"
_DIGITS: Final = 12
"""Digits of times in sentences, which are rounded outwards."""
_APART: Final = 0.01
"""Difference of the times of overturning of run and proof from which on it is an objection, over
the time in which a rotation near overturning grows e-fold."""


class Tolerances(NamedTuple):
    """Largest deviations of the inputs for which a proof holds."""

    restitution: float = 0.0
    scale: float = 0.0
    angle: float = 0.0  # theta of either corner [rad]
    parts: int = 1  # largest number of parts into which the set is divided


EXACT: Final = Tolerances()


@dataclass(frozen=True)
class Proof:
    """A proved verdict, or why none was reached; returned by :func:`rockframe.prove`.

    Parameters
    ----------
    verdict : {"safe for ever", "overturns", "undecided"}
        The proved verdict.
    reason : str
        Why nothing is proved; empty for a proof.
    earliest, latest : float
        Times between which the rotation reaches the overturning angle; the time at which the
        proof ended if nothing is proved; NaN for a block that is safe [s].
    width : float
        Greatest radius of the rotations enclosed at the samples [rad].
    impacts : int
        Number of impacts enclosed one by one; the greatest number in any part.
    bits : int
        Precision of the balls.
    scale : float
        Scale of the motion [1].
    law : str
        Law of impacts or pads to which the proof applies, in words.
    restitution_tolerance, scale_tolerance : float
        Largest deviations of restitutions and scale in the set that the proof covers [1].
    angle_tolerance : float
        Largest deviation of theta in that set [rad].
    parts : int
        Number of parts into which the set was divided.
    safe_share, overturning_share : float
        Shares of the set for which either verdict is proved [1].
    analytic : bool
        Whether the motion is given by polynomials between its samples, not by straight lines.
    gravity : float
        Acceleration of gravity of the scene [m s^-2].
    start : str
        The state from which the block is followed, in words.
    """

    verdict: str
    reason: str
    earliest: float
    latest: float
    width: float
    impacts: int
    bits: int
    scale: float
    law: str
    restitution_tolerance: float = 0.0
    scale_tolerance: float = 0.0
    angle_tolerance: float = 0.0
    parts: int = 1
    safe_share: float = 0.0
    overturning_share: float = 0.0
    analytic: bool = False
    gravity: float = math.nan
    start: str = ""

    @property
    def decided(self) -> bool:
        """Whether anything is proved."""
        return self.verdict != UNDECIDED

    @property
    def overturns(self) -> bool | None:
        """Whether the block overturns; None if that is undecided."""
        return self.verdict == OVERTURNS if self.decided else None

    def agrees(self, overturned: bool | None, end: float) -> bool:
        """Whether the proved verdict agrees with that of a run up to a time [s]."""
        if overturned is None or not self.decided:
            return False
        if overturned:
            return self.verdict == OVERTURNS
        return self.verdict == SAFE or self.earliest > end

    def objections(self, overturned: bool | None, end: float, frequency: float) -> list[str]:
        """Say where a run has another verdict, ends too early, or overturns at another time.

        `end` is the end of the run [s], `frequency` the rate of growth near overturning [s^-1].
        """
        if overturned is None or not self.decided:
            return []
        if not self.agrees(overturned, end) and not self.earliest <= end <= self.latest:
            ends = "overturned" if overturned else "did not overturn"
            return [f"the run is wrong, or the proof is: the block {ends} in the run. {self}"]
        if self.verdict == OVERTURNS and not overturned:
            return [f"the block is proved to overturn after the end of the run. {self}"]
        apart = max(self.earliest - end, end - self.latest)
        if overturned and self.verdict == OVERTURNS and apart * frequency > _APART:
            words = f"the block overturns in the run at {end:.6g} s, which is off by {apart:.3g} s"
            return [f"{words}: take a greater accuracy. {self}"]
        return []

    def values(self, overturned: bool | None, end: float) -> dict[str, float | bool]:
        """Return the scalars for the dataset of a run up to a time, by names of the schema."""
        falls = self.verdict == OVERTURNS
        return {
            "verdict_proved": self.agrees(overturned, end),
            "proved_overturning_earliest": self.earliest if falls else math.nan,
            "proved_overturning_latest": self.latest if falls else math.nan,
            "proof_width": self.width,
        }

    def attributes(self) -> dict[str, str | int]:
        """Return the attributes of a dataset that describe the proof."""
        return {"proof": str(self), "proof_verdict": self.verdict, "proof_bits": self.bits}

    def __str__(self) -> str:
        """Say what has been proved, and for which inputs."""
        scaled = "" if self.scale == 1.0 else f" times {self.scale!r}"
        between = f"this record{scaled}, joined by straight lines,"
        if self.analytic:
            between = f"this motion{scaled}, the polynomials that runs take,"
        normal = "" if math.isnan(self.gravity) else f"gravity {self.gravity!r} m s^-2"
        scene = [words for words in (normal, self.start) if words]
        listed = ", ".join(["the numbers of this block", *scene])
        of = f"for {listed} and {between} and for {self.law}"
        within = {
            f"restitution within {self.restitution_tolerance:g}": self.restitution_tolerance,
            f"scale within {self.scale_tolerance:g}": self.scale_tolerance,
            f"angle theta within {self.angle_tolerance:g} rad": self.angle_tolerance,
        }
        wide = [words for words, tolerance in within.items() if tolerance]
        if wide:
            of += f", with every {' and every '.join(wide)} of the given one"
        if not self.decided:
            at = "" if math.isnan(self.latest) else f", at {self.latest:.6g} s"
            sentence = (
                f"Undecided: {self.reason}{at}; rotations were enclosed within {self.width:.2g} rad"
            )
            if not (self.safe_share or self.overturning_share):
                return f"{sentence}. Nothing is proved."
            return (
                f"{sentence}. Of the set {self.safe_share:.3%} are proved safe for ever and "
                f"{self.overturning_share:.3%} to overturn, {of}."
            )
        behaviour = "does not overturn, however long it stands on the still ground afterwards"
        if self.verdict == OVERTURNS:
            least = _rounded(self.earliest, ROUND_FLOOR)
            behaviour = f"overturns between {least} s and {_rounded(self.latest, ROUND_CEILING)} s"
        return (
            f"Proved: the block {behaviour}; {of}, in interval arithmetic. It is a theorem on the "
            "model, and says nothing of how well that describes the block."
        )


def _rounded(time: float, rounding: str) -> str:
    """Write a time with `_DIGITS` digits, rounded in a direction."""
    return f"{float(Context(_DIGITS, rounding).create_decimal(time)):.{_DIGITS}g}"


def outwards(value: object, direction: float) -> float:
    """Return the next double in a direction, so that a rounded bound stays one."""
    return math.nextafter(float(value), direction)  # type: ignore[arg-type]
