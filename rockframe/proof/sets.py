"""Proofs for sets of inputs, divided into parts, and for exact inputs, with enough bits."""

import math
from collections.abc import Callable
from dataclasses import replace
from heapq import heappop, heappush
from typing import Final, NamedTuple, Protocol, TypeAlias

from rockframe.proof.balls import Ball, bits, working_precision
from rockframe.proof.problem import Deviations, Undecided
from rockframe.proof.verdict import OVERTURNS, SAFE, UNDECIDED, Proof, Tolerances, outwards

PRECISIONS: Final = (106, 212, 424)
"""Bits of the balls: the next number is tried where nothing is decided and more bits may help."""
_SAME_TIME: Final = 1e-9
"""Relative difference up to which two attempts end at the same time."""

Attempt: TypeAlias = Callable[[Deviations], tuple[Proof, list[float]]]
"""A function that tries a proof for a set of inputs; also gives the influence of each input."""


def prove_for_set(attempt: Attempt, within: Tolerances) -> Proof:
    """Prove a verdict: for exact inputs with more and more bits, for a set in more and more parts.

    A part without a proof is halved along the input that changes its states most; the largest part
    comes first.
    """
    inputs = Deviations.within(within.restitution, within.scale, within.angle)
    decided, waiting = list[_Part](), list[_Part]()
    whole: _Part | None = None
    for precision in PRECISIONS if inputs.exact else PRECISIONS[:1]:
        before = whole
        with working_precision(precision):
            whole = _Part(-1.0, 0, inputs, *attempt(inputs))
        if whole.proof.decided or (before and _ends_alike(before.proof, whole.proof)):
            break
    assert whole is not None  # noqa: S101
    (decided if whole.proof.decided else waiting).append(whole)
    with working_precision(PRECISIONS[0]):
        while waiting and len(decided) + len(waiting) < within.parts and not inputs.exact:
            large = heappop(waiting)
            for order, half in enumerate(large.inputs.halves(large.influences)):
                part = _Part(large.share / 2, 2 * large.order + order, half, *attempt(half))
                if part.proof.decided:
                    decided.append(part)
                else:
                    heappush(waiting, part)
    return replace(
        _joined_proof(decided, sorted(waiting)),
        restitution_tolerance=within.restitution,
        scale_tolerance=within.scale,
        angle_tolerance=within.angle,
    )


class Prover(Protocol):
    """What follows a set of states through a record."""

    overturning_time: tuple[Ball, Ball] | None  # bounds of the time of overturning [s]
    impacts: int  # number of impacts enclosed one by one
    largest_radius: float  # largest radius of a rotation so far [rad]

    @property
    def time(self) -> Ball:
        """Time up to which the set has been followed [s]."""
        ...

    def overturns(self) -> bool:
        """Whether all states overturn; raise Undecided if that cannot be said."""
        ...


def prove_verdict(prover: Prover, scale: float, law: str) -> Proof:
    """Follow a set of states until it is decided whether it overturns, and give what is proved."""
    verdict, reason, earliest, latest = UNDECIDED, "", math.nan, math.nan
    try:
        verdict = OVERTURNS if prover.overturns() else SAFE
    except Undecided as why:
        reason, earliest = str(why), float(prover.time)
        latest = earliest
    if verdict == OVERTURNS and prover.overturning_time is not None:
        low, high = prover.overturning_time
        earliest, latest = outwards(low.lower(), -math.inf), outwards(high.upper(), math.inf)
    return Proof(
        verdict, reason, earliest, latest, prover.largest_radius, prover.impacts, bits(), scale, law
    )


def _ends_alike(before: Proof, elapsed: Proof) -> bool:
    """Whether an undecided proof ends where it did with half the bits, for the same reason.

    Then the reason lies in the motion, such as a contact that no enclosure can follow, and not in
    the width of the balls.
    """
    same_time = math.isclose(before.latest, elapsed.latest, rel_tol=_SAME_TIME)
    return before.reason == elapsed.reason and same_time


class _Part(NamedTuple):
    """A part of a set of inputs; the smallest in the order of tuples is halved next."""

    share: float  # share of the set, negative so that the largest part comes first
    order: int  # orders parts of the same share
    inputs: Deviations
    proof: Proof
    influences: list[float]


def _joined_proof(decided: list[_Part], undecided: list[_Part]) -> Proof:
    """Return the proof for a set from the proofs of its parts."""
    every = [part.proof for part in (*decided, *undecided)]
    shares = {
        verdict: float(abs(sum(part.share for part in decided if part.proof.verdict == verdict)))
        for verdict in (SAFE, OVERTURNS)
    }
    verdict, reason, proofs = UNDECIDED, "", [part.proof for part in undecided[:1] or decided]
    if not undecided and len({proof.verdict for proof in every}) == 1:  # shares may be rounded
        verdict = every[0].verdict
    elif len(every) == 1:
        reason = every[0].reason
    elif undecided:
        reason = f"{undecided[0].proof.reason}, in the largest undecided part of the set"
    else:
        reason = "the verdict is not the same of all of them"
    falls = [proof for proof in proofs if proof.verdict != SAFE]
    return replace(
        every[0],
        verdict=verdict,
        reason=reason,
        earliest=min((fall.earliest for fall in falls), default=math.nan),
        latest=max((fall.latest for fall in falls), default=math.nan),
        width=max(proof.width for proof in every),
        impacts=max(proof.impacts for proof in every),
        parts=len(every),
        safe_share=shares[SAFE],
        overturning_share=shares[OVERTURNS],
    )
