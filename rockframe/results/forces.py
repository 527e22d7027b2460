"""Accelerations, reactions and what they ask of the friction under a body.

The sums and quotients that follow from a model's columns, page "Forces and accelerations" of
the manual.
"""

import math
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from rockframe.results.along_steps import AlongSteps, Values
from rockframe.results.outcome import Generic, sines_cosines
from rockframe.signals.arrays import Array
from rockframe.system.bodies import BaseLoad

STACKED: Final = "rotation_on_cap"
"""A column of scenes in which a block stands on a cap."""
ON_BASE: Final = (STACKED, "rotation_on_base")
"""Columns of the rotation of a body on another one, of which a scene has one at most."""
OF_SOIL_FRICTION: Final = (STACKED, "base_shear", "soil_reaction")
"""Columns that the friction between cap and soil follows from, where a scene has them all."""
OF_SETTLEMENT: Final = ("vertical_displacement", "rotation")
"""Columns that the settlement of the base follows from."""
HALF: Final = 0.5
ENOUGH: Final = 1.0
"""The friction demand is told to last while it is above half its peak, or above what floors seldom
have."""
NO_FORCE: Final = 1e-10
"""Share of the weight below which a force is rounding; of an impulse, in that of a fall by the
height of the centre of mass."""


def force_histories(values: Values, ground: Array, load: BaseLoad) -> dict[str, Generic]:
    """Give absolute accelerations, :eq:`eq-base-moment`, and the friction demand."""
    small = load.options.small
    on_base = next((values[name] for name in ON_BASE if name in values), values["rotation"])
    sine, cosine = sines_cosines(on_base, small=small)
    found: dict[str, Generic] = {
        "absolute_horizontal_acceleration": values["horizontal_acceleration"] + ground[:, 0],
        "absolute_vertical_acceleration": values["vertical_acceleration"] + ground[:, 1],
        "base_overturning_moment": load.body.base_moment(values, sine, cosine, small=small),
    }
    return found | friction_demands(values, load)


def friction_demands(values: Values, load: BaseLoad) -> dict[str, Generic]:
    """Give the friction demand of the bases, by their names in the schema."""
    least = NO_FORCE * load.weight
    found: dict[str, Generic] = {
        "friction_demand": friction_demand(
            values["horizontal_reaction"], values["vertical_reaction"], least
        )
    }
    if all(name in values for name in OF_SOIL_FRICTION):
        found["soil_friction_demand"] = friction_demand(
            values["base_shear"], values["soil_reaction"], least
        )
    return found


def friction_demand(thrust: Array, press: Array, least: float) -> Array:
    """Give the friction that holds a body, :eq:`eq-friction-demand`; forces to `least` are none."""
    held = np.abs(thrust) > least
    with np.errstate(divide="ignore", invalid="ignore"):
        ratio = np.abs(thrust) / press
    return np.where(held, np.where(press > least, ratio, math.inf), 0.0)


@dataclass(frozen=True)
class EventStates:
    """What a model shows just before and just after the events of a run."""

    time: Array  # of the events [s]
    # whether an event is an impact from which the body goes on. One that it comes to rest by ends
    # an endless series: its ratio of impulses is that of no impact
    is_impact: NDArray[np.bool_]
    before: Values  # columns and what follows from them, by their names in the schema
    after: Values

    def those(self, kept: NDArray[np.bool_]) -> "EventStates":
        """Give some of the events."""
        before, after = (
            {name: values[kept] for name, values in side.items()}
            for side in (self.before, self.after)
        )
        return EventStates(self.time[kept], self.is_impact[kept], before, after)

    def impulses(self, mass: float) -> dict[str, Generic]:
        """Give the impulses of the base on the body at the events [N s].

        Their ratio at an impact on rigid ground is :eq:`eq-impact-friction`.
        """
        return {
            f"event_{name}_impulse": mass
            * (self.after[f"{name}_velocity"] - self.before[f"{name}_velocity"])
            for name in ("horizontal", "vertical")
        }


def peaks_along(
    along: AlongSteps, events: EventStates, load: BaseLoad
) -> tuple[dict[str, float], dict[str, float]]:
    """Give peaks of forces, and how far the middle of the base went down from rest at most."""
    ((shear, most), (_, when)), ((deepest,), _) = along.each_largest(
        lambda values: np.stack([np.abs(values["base_shear"]), values["friction_demand"]]),
        lambda values: _settlement(values, load)[None],
    )
    level = min(HALF * most, ENOUGH)
    lasted = along.above(lambda values: values["friction_demand"], level)[1] if level > 0.0 else 0.0
    impulses = events.impulses(load.body.mass)
    fall = math.sqrt(load.body.centre_height / load.options.gravity)
    struck = friction_demand(
        impulses["event_horizontal_impulse"], impulses["event_vertical_impulse"],
        NO_FORCE * load.weight * fall,
    )[events.is_impact]  # fmt: skip
    forces = {
        "peak_friction_demand": float(most),
        "peak_friction_demand_time": float(when),
        "peak_friction_demand_duration": lasted,
        "peak_impulsive_friction_demand": float(struck.max(initial=0.0)),
        "peak_base_shear": float(shear),
    }
    return forces, {"peak_settlement": max(float(deepest), 0.0) + 0.0}


def residuals(last: Values, load: BaseLoad) -> dict[str, float]:
    """Give what is left at the end of a run, by its names in the schema."""
    left = {
        "residual_rotation": float(last["rotation"][0]),
        "residual_settlement": float(_settlement(last, load)[0]),
    }
    if "slip" in last:
        left["residual_displacement"] = float(last["horizontal_displacement"][0])
    return {name: value + 0.0 for name, value in left.items()}  # no negative zero


def _settlement(values: Values, load: BaseLoad) -> Array:
    """Give how much lower than at rest the middle of the base is, :eq:`eq-settlement`."""
    small = load.options.small
    return load.body.sunk(values["rotation"], values["vertical_displacement"], small=small)
