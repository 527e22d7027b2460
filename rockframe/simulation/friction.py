"""Whether the friction of a scene's bases holds what stands on them, and how that is said."""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from rockframe.results.along_steps import AlongSteps, Values
from rockframe.results.outcome import LEAST_SLIP, Generic
from rockframe.signals.arrays import Array
from rockframe.system.assembly import Assembly

_BLOCK: Final = "friction_demand"
_CAP: Final = "soil_friction_demand"
DIGITS: Final = 3
MOST_DIGITS: Final = 15
"""Digits in which coefficients are told, more where both would look alike."""


@dataclass(frozen=True)
class SlidingCheck:
    """Whether a body would slide on a base to which friction was given."""

    body: str  # what stands on it
    friction: float  # the coefficient that the base has, and the largest demand [1]
    needed: float
    # from when on and how long in all the demand is beyond it; NaN and 0 where it never is [s]
    first: float
    lasted: float

    @property
    def slides(self) -> bool:
        """Whether the demand is ever beyond the coefficient."""
        return self.needed > self.friction

    @property
    def words(self) -> str:
        """Say it, without the body."""
        digits = DIGITS
        needed = ""
        if math.isfinite(self.needed):
            while f"{self.needed:.{digits}g}" == f"{self.friction:.{digits}g}":
                digits += 1
                if digits > MOST_DIGITS:
                    break
            needed = f"{self.needed:.{digits}g}"
        if not needed:
            return (
                f"would slide from {self.first:.4g} s on: needs more than any floor has, and more "
                f"than {self.friction:.{digits}g} for {self.lasted:.3g} s in all"
            )
        if not self.slides:
            return f"would not slide: needs {needed} of {self.friction:.{digits}g}"
        return (
            f"would slide from {self.first:.4g} s on: needs {needed} of "
            f"{self.friction:.{digits}g}, and more than that for {self.lasted:.3g} s in all"
        )


def has_limit(system: Assembly) -> bool:
    """Whether a base of the scene has a coefficient of friction, to which its runs are held."""
    return any(True for _ in _frictions(system))


def slidings(system: Assembly, along: AlongSteps) -> list[SlidingCheck]:
    """Tell of each base with a coefficient of friction whether it holds what stands on it."""
    return [
        _sliding(along, name, friction, body)
        for name, friction, body in _frictions(system)
        if name in along.shown  # a soil of one's own may not show its reaction
    ]


def _sliding(along: AlongSteps, name: str, friction: float, body: str) -> SlidingCheck:
    def demand(values: Values) -> Array:
        return values[name][None]

    (needed,), (when,) = along.largest(demand)
    first, lasted = along.above(lambda values: values[name], friction)
    if needed > friction and math.isnan(first):  # within a step
        first = when
    return SlidingCheck(body, friction, float(needed), float(first), lasted)


def sliding_scalars(found: Sequence[SlidingCheck]) -> dict[str, float | bool]:
    """Give the same as numbers, by their names in the schema; of no base nothing."""
    if not found:
        return {}
    slides = [each for each in found if each.slides]
    return {
        "would_slide": bool(slides),
        "sliding_time": min((each.first for each in slides), default=math.nan),
        "sliding_duration": max(each.lasted for each in found),
    }


def friction_words(scalars: Mapping[str, Generic | float], found: Sequence[SlidingCheck]) -> str:
    """Say in a sentence whether a run would slide, or what friction it needed; nothing without."""
    if len(found) == 1:
        words = found[0].words
        return f" {words[0].upper()}{words[1:]}."
    if found:
        words = "; ".join(f"{each.body} {each.words}" for each in found)
        return f" {words[0].upper()}{words[1:]}."
    if "peak_friction_demand" not in scalars:
        return ""
    most, when, lasted = (
        float(scalars[f"peak_friction_demand{what}"]) for what in ("", "_time", "_duration")
    )
    if not math.isfinite(most):
        return (
            " Friction needed: more than any, where the base holds without pressing "
            f"({when:.4g} s); more than 1 for {lasted:.3g} s in all."
        )
    level = "more than 1" if most > 2.0 else "more than half of it"
    return f" Friction needed: {most:.3g}, {level} for {lasted:.3g} s in all."


def slips(found: Sequence[SlidingCheck]) -> Iterator[str]:
    """Tell where a run needs more friction than a base has."""
    for each in found:
        if each.slides:
            yield f"{each.body} {each.words}; the model holds it"


def share_words(would_slide: Generic, *, runs: str = "runs") -> str:
    """Say in how many of the runs that an analysis made its verdict supposes too much friction."""
    slide, hold = counts_of_slides(would_slide)
    some = f"in {slide or 'none'} of {slide + hold} {runs}"
    return f"{some} the block would slide first" if slide + hold else ""


def slip_words(slips: Generic, *, runs: str = "runs") -> str:
    """Say in how many of the runs that an analysis made a body slid, and how far at most."""
    slid = slips[slips > LEAST_SLIP]
    some = f"in {slid.size} of {np.isfinite(slips).sum()} {runs}"
    return f"{some} the block slid, by {slid.max():.3g} m at most" if slid.size else ""


def counts_of_slides(would_slide: Generic) -> tuple[int, int]:
    """Give how many slide and how many do not; NaN is neither."""
    return int((would_slide == 1.0).sum()), int((would_slide == 0.0).sum())


def _frictions(system: Assembly) -> Iterator[tuple[str, float, str]]:
    """Give the coefficients of friction that were given, and which demand each must bear."""
    parts = system.parts
    if system.setting.slides:
        return
    under = (
        (parts.ground, _BLOCK),
        (parts.pads, _BLOCK),
        (parts.soil, _CAP if system.setting.stacked else _BLOCK),
    )
    for part, name in under:
        friction = None if part is None else getattr(part.si, "friction", None)
        if friction is not None:
            yield name, friction, "the cap" if name == _CAP else "the block"
