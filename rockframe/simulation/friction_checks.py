"""Checks whether friction holds the bodies that a model holds, and words on slips."""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from rockframe.results.along_steps import AlongSteps, Values
from rockframe.results.forces import signed_demand
from rockframe.results.outcome import MIN_REPORTED_SLIP
from rockframe.signals.arrays import AnyArray, Array
from rockframe.system.assembly import Assembly

_BLOCK_DEMAND: Final = "friction_demand"
_CAP_DEMAND: Final = "soil_friction_demand"
DIGITS: Final = 3
MAX_DIGITS: Final = 15
"""Digits of coefficients in messages: DIGITS, or more where both would look equal."""


@dataclass(frozen=True)
class SlidingCheck:
    """Whether a body that the model holds would slide on a base with a given friction."""

    body: str  # name of what stands on the base
    friction: float  # coefficient of friction that the base has [1]
    needed: float  # largest friction demand [1]
    first: float  # time at which the demand first exceeds the coefficient, NaN if never [s]
    duration: float  # total time for which it does [s]

    @property
    def slides(self) -> bool:
        """Whether the demand ever exceeds the coefficient."""
        return self.needed > self.friction

    @property
    def words(self) -> str:
        """The check in words, without the name of the body."""
        digits, both = DIGITS, (self.needed, self.friction)
        needed, friction = (f"{one:.{digits}g}" for one in both)
        while needed == friction and digits <= MAX_DIGITS:
            digits += 1
            needed, friction = (f"{one:.{digits}g}" for one in both)
        slides = f"would slide from {self.first:.4g} s on: needs"
        if not math.isfinite(self.needed):
            return (
                f"{slides} more than any floor has, and more than {friction} for "
                f"{self.duration:.3g} s in all"
            )
        if not self.slides:
            return f"would not slide: needs {needed} of {friction}"
        return (
            f"{slides} {needed} of {friction}, and more than that for {self.duration:.3g} s in all"
        )


def has_friction_limit(system: Assembly) -> bool:
    """Whether a base has a coefficient of friction that its runs are checked against."""
    return any(_frictions(system))


def sliding_checks(system: Assembly, along: AlongSteps) -> list[SlidingCheck]:
    """Check for each base with a coefficient of friction whether it holds what stands on it."""
    return [
        _sliding(along, name, friction, body)
        for name, friction, body in _frictions(system)
        if name in along.shown  # a soil of one's own may not show its reaction
    ]


def _sliding(along: AlongSteps, name: str, friction: float, body: str) -> SlidingCheck:
    def demand(values: Values) -> Array:
        return values[name][None]

    (needed,), (when,) = along.largest(demand)
    first, duration = along.above(signed_demand(name), friction)
    if needed > friction and math.isnan(first):  # within a step
        first = when
    return SlidingCheck(body, friction, float(needed), float(first), duration)


def sliding_scalars(checks: Sequence[SlidingCheck]) -> dict[str, float | bool]:
    """Return the scalars of sliding checks, by their names in the schema; none without a check."""
    if not checks:
        return {}
    slides = [check for check in checks if check.slides]
    return {
        "would_slide": bool(slides),
        "sliding_time": min((check.first for check in slides), default=math.nan),
        "sliding_duration": max(check.duration for check in checks),
    }


def friction_words(scalars: Mapping[str, AnyArray | float], checks: Sequence[SlidingCheck]) -> str:
    """Say in a sentence whether bodies would slide or, without a check, what friction they needed.

    Empty for a run without peaks of forces.
    """
    if checks:
        several = len(checks) > 1
        words = "; ".join(
            f"{check.body} {check.words}" if several else check.words for check in checks
        )
        return f" {words[0].upper()}{words[1:]}."
    if "peak_friction_demand" not in scalars:
        return ""
    peak, when, duration = (
        float(scalars[f"peak_friction_demand{what}"]) for what in ("", "_time", "_duration")
    )
    if not math.isfinite(peak):
        return (
            " Friction needed: more than any, where the base is held without pressure "
            f"(at {when:.4g} s); more than 1 for {duration:.3g} s in all."
        )
    if peak == 0.0:
        return ""
    level = "more than 1" if peak > 2.0 else "more than half of it"
    return f" Friction needed: {peak:.3g}, {level} for {duration:.3g} s in all."


def sliding_cautions(checks: Sequence[SlidingCheck]) -> Iterator[str]:
    """Return a caution for each base that has less friction than a run needs."""
    for check in checks:
        if check.slides:
            yield f"{check.body} {check.words}; the model holds it"


def share_words(would_slide: AnyArray, *, runs: str = "runs") -> str:
    """Say in how many runs of an analysis the block would slide, though its model holds it."""
    slide, hold = count_slides(would_slide)
    some = f"in {slide or 'none'} of {slide + hold} {runs}"
    return f"{some} the block would slide first" if slide + hold else ""


def slip_words(slips: AnyArray, *, runs: str = "runs") -> str:
    """Say in how many runs of an analysis a body slid, and how far at most."""
    slid = slips[slips > MIN_REPORTED_SLIP]
    some = f"in {slid.size} of {np.isfinite(slips).sum()} {runs}"
    return f"{some} a body slid, by {slid.max():.3g} m at most" if slid.size else ""


def count_slides(would_slide: AnyArray) -> tuple[int, int]:
    """Return how many runs slide and how many do not; NaN counts as neither."""
    return int((would_slide == 1.0).sum()), int((would_slide == 0.0).sum())


def _frictions(system: Assembly) -> Iterator[tuple[str, float, str]]:
    """Return friction demand, coefficient and body, by name, for each base that holds a body."""
    parts = system.parts
    if system.setting.slides:
        return
    under = (
        (parts.ground, _BLOCK_DEMAND),
        (parts.pads, _BLOCK_DEMAND),
        (parts.soil, _CAP_DEMAND if system.setting.stacked else _BLOCK_DEMAND),
    )
    for part, name in under:
        friction = None if part is None else getattr(part.si, "friction", None)
        if friction is not None:
            body = "the frame" if parts.frame is not None else "the block"
            yield name, friction, "the cap" if name == _CAP_DEMAND else body
