"""Accelerations, reactions, and the friction that holds a body, beside that which its base has.

All of them follow from a model's columns, page "Forces and accelerations" of the manual.
"""

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from rockframe.results.along_steps import AlongSteps, Values
from rockframe.results.outcome import MIN_REPORTED_SLIP, sines_cosines
from rockframe.signals.arrays import AnyArray, Array
from rockframe.system.assembly import Assembly
from rockframe.system.bodies import BaseLoad

ROTATION_ON_CAP: Final = "rotation_on_cap"
"""A column of scenes in which a block stands on a cap."""
ROTATIONS_ON_BASE: Final = (ROTATION_ON_CAP, "rotation_on_base")
"""Columns of the rotation of a body on another one, of which a scene has one at most."""
SOIL_FRICTION_COLUMNS: Final = (ROTATION_ON_CAP, "base_shear", "soil_reaction")
"""Columns from which the friction between cap and soil follows, where a scene has them all."""
SETTLEMENT_COLUMNS: Final = ("vertical_displacement", "rotation")
"""Columns from which the settlement of the base follows."""
DURATION_SHARE: Final = 0.5
DURATION_COEFFICIENT: Final = 1.0
"""The duration of the friction demand is the time above half its peak, or above this coefficient
if that is less: floors seldom have more."""
FRICTION_DEMAND: Final = "friction_demand"
SOIL_FRICTION_DEMAND: Final = "soil_friction_demand"
DIGITS: Final = 3
MAX_DIGITS: Final = 15
"""Digits of coefficients in messages: DIGITS, or more where both would look equal."""
FORCE_TOLERANCE: Final = 1e-10
"""Share of the weight below which a force is rounding; for an impulse, a share of the weight times
the square root of h/g, h the height of the centre of mass."""


def force_histories(values: Values, ground: Array, load: BaseLoad) -> dict[str, AnyArray]:
    """Return absolute accelerations, :eq:`eq-base-moment`, and the friction demand."""
    small = load.options.small
    on_base = next(
        (values[name] for name in ROTATIONS_ON_BASE if name in values), values["rotation"]
    )
    sine, cosine = sines_cosines(on_base, small=small)
    histories: dict[str, AnyArray] = {
        "absolute_horizontal_acceleration": values["horizontal_acceleration"] + ground[:, 0],
        "absolute_vertical_acceleration": values["vertical_acceleration"] + ground[:, 1],
        "base_overturning_moment": load.body.base_moment(values, sine, cosine, small=small),
    }
    return histories | friction_demands(values, load)


def friction_demands(values: Values, load: BaseLoad) -> dict[str, AnyArray]:
    """Return the friction demand of the bases, by their names in the schema."""
    least = FORCE_TOLERANCE * load.weight
    demands: dict[str, AnyArray] = {
        FRICTION_DEMAND: friction_demand(
            values["horizontal_reaction"], values["vertical_reaction"], least
        )
    }
    if all(name in values for name in SOIL_FRICTION_COLUMNS):
        demands[SOIL_FRICTION_DEMAND] = friction_demand(
            values["base_shear"], values["soil_reaction"], least
        )
    return demands


def friction_demand(tangential: Array, normal: Array, least: float) -> Array:
    """Return the coefficient of friction that holds a body, :eq:`eq-friction-demand`.

    A thrust or a pressing force up to `least` counts as zero.
    """
    held = np.abs(tangential) > least
    with np.errstate(divide="ignore", invalid="ignore"):
        ratio = np.abs(tangential) / normal
    return np.where(held, np.where(normal > least, ratio, math.inf), 0.0)


def signed_demand(name: str) -> Callable[[Values], Array]:
    """Return a function that gives a friction demand the sign of its thrust.

    The magnitude of a thrust that reverses within a step is not linear there.
    """
    tangential = "base_shear" if name == SOIL_FRICTION_DEMAND else "horizontal_reaction"
    return lambda values: np.copysign(values[name], values[tangential])


@dataclass(frozen=True)
class EventStates:
    """The columns of a model just before and just after the events of a run."""

    time: Array  # of the events [s]
    # whether an event is an impact after which the body moves on. An impact that brings it to rest
    # stands for an endless series of impacts, and its ratio of impulses has no meaning
    is_impact: NDArray[np.bool_]
    before: Values  # columns and what follows from them, by their names in the schema
    after: Values

    def select(self, selected: NDArray[np.bool_]) -> "EventStates":
        """Return some of the events."""
        before, after = (
            {name: values[selected] for name, values in side.items()}
            for side in (self.before, self.after)
        )
        return EventStates(self.time[selected], self.is_impact[selected], before, after)

    def impulses(self, mass: float) -> dict[str, AnyArray]:
        """Return the impulses of the base on the body at events, :eq:`eq-impact-friction` [N s]."""
        impulses: dict[str, AnyArray] = {}
        for way in ("horizontal", "vertical"):
            on_base = f"{way}_velocity_on_base"  # in a cascade that of the second stage
            name = on_base if on_base in self.after else f"{way}_velocity"
            impulses[f"event_{way}_impulse"] = mass * (self.after[name] - self.before[name])
        return impulses

    def impulses_on_base(self, load: BaseLoad) -> tuple[Array, Array]:
        """Return the impulses along and normal to what the base stands on, which may lean [N s]."""
        impulses = self.impulses(load.body.mass)
        across, up = impulses["event_horizontal_impulse"], impulses["event_vertical_impulse"]
        if "vertical_velocity_on_base" in self.after:  # under a second stage nothing leans
            return across, up
        on_base = next((self.after[name] for name in ROTATIONS_ON_BASE if name in self.after), None)
        if on_base is None:
            return across, up
        lean = self.after["rotation"] - on_base
        sine, cosine = sines_cosines(lean, small=load.options.small)
        return cosine * across - sine * up, sine * across + cosine * up


def force_peaks(
    along: AlongSteps, events: EventStates, load: BaseLoad
) -> tuple[dict[str, float], dict[str, float]]:
    """Return peaks of forces with times and durations, and the peak settlement, by their names."""
    ((shear, most), (_, when)), ((deepest,), _) = along.each_largest(
        lambda values: np.stack([np.abs(values["base_shear"]), values[FRICTION_DEMAND]]),
        lambda values: _settlement(values, load)[None],
    )
    level = min(DURATION_SHARE * most, DURATION_COEFFICIENT)
    lasted = along.above(signed_demand(FRICTION_DEMAND), level)[1] if level > 0.0 else 0.0
    fall = math.sqrt(load.body.centre_height / load.options.gravity)
    struck = friction_demand(*events.impulses_on_base(load), FORCE_TOLERANCE * load.weight * fall)
    forces = {
        "peak_friction_demand": float(most),
        "peak_friction_demand_time": float(when),
        "peak_friction_demand_duration": lasted,
        "peak_impulsive_friction_demand": float(struck[events.is_impact].max(initial=0.0)),
        "peak_base_shear": float(shear),
    }
    return forces, {"peak_settlement": max(float(deepest), 0.0) + 0.0}


def residual_values(last: Values, load: BaseLoad) -> dict[str, float]:
    """Return residual rotation, settlement and displacement, by their names in the schema."""
    left = {
        "residual_rotation": float(last["rotation"][0]),
        "residual_settlement": float(_settlement(last, load)[0]),
    }
    if "slip" in last:
        left["residual_displacement"] = float(last["horizontal_displacement"][0])
    return {name: value + 0.0 for name, value in left.items()}  # no negative zero


def _settlement(values: Values, load: BaseLoad) -> Array:
    """Return the settlement of the middle of the base from rest, :eq:`eq-settlement`."""
    rotation, height = values["rotation"], values["vertical_displacement"]
    return load.body.base_settlement(rotation, height, small=load.options.small)


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
        lack = f"too little for {self.duration:.3g} s in all"
        if not math.isfinite(self.needed):
            return f"{slides} more friction than any floor has; its {friction} is {lack}"
        if not self.slides:
            return f"would not slide: needs a friction of {needed}, has {friction}"
        return f"{slides} a friction of {needed}, has {friction}, {lack}"


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


def sliding_cautions(checks: Sequence[SlidingCheck]) -> list[str]:
    """Return a caution for each base that has less friction than a run needs."""
    return [f"{one.body} {one.words}; this model keeps it in place" for one in checks if one.slides]


def share_words(would_slide: AnyArray, *, runs: str = "runs") -> str:
    """Say in how many runs of an analysis the block would slide, if it could."""
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
        (parts.ground, FRICTION_DEMAND),
        (parts.pads, FRICTION_DEMAND),
        (parts.soil, SOIL_FRICTION_DEMAND if system.setting.stacked else FRICTION_DEMAND),
    )
    for part, name in under:
        friction = None if part is None else getattr(part.si, "friction", None)
        if friction is not None:
            body = "the frame" if parts.frame is not None else "the block"
            yield name, friction, "the cap" if name == SOIL_FRICTION_DEMAND else body
