"""Whether the friction of a scene's bases holds what stands on them."""

from collections.abc import Iterator, Mapping
from typing import Final

import numpy as np

from rockframe.results.forces import EventStates
from rockframe.results.outcome import Generic
from rockframe.system.assembly import Assembly

_BLOCK: Final = "friction_demand"
_CAP: Final = "soil_friction_demand"


def slips(
    system: Assembly, values: Mapping[str, Generic], events: EventStates
) -> Iterator[str]:  # fmt: skip
    """Tell where a run needs more friction than a base has.

    Parameters
    ----------
    system : Assembly
        The checked scene.
    values : mapping of str to ndarray
        Histories, by their names in the schema.
    events : EventStates
        The events among them.

    Yields
    ------
    str
        For each base with a coefficient of friction that is exceeded.
    """
    time = values["time"]
    for name, friction, words in _frictions(system):
        above = values[name] > friction
        at_events = np.concatenate([side[name] > friction for side in _sides(events)])
        if not (above.any() or at_events.any()):
            continue
        demand = np.concatenate([values[name], *(side[name] for side in _sides(events))])
        when = np.concatenate([time, events.time, events.time])
        first = when[demand > friction].min()
        # the time between two samples counts by halves
        lasted = float(np.diff(time) @ (0.5 * (above[1:].astype(float) + above[:-1])))
        most = f"up to {demand.max():.3g}" if np.isfinite(demand.max()) else "without bound"
        yield (
            f"{words} would slide: the friction demand exceeds the coefficient {friction:.6g} "
            f"from {first:.4g} s on, for {lasted:.3g} s in all, {most}; the model holds it"
        )


def _sides(events: EventStates) -> tuple[Mapping[str, Generic], Mapping[str, Generic]]:
    return events.before, events.after


def _frictions(system: Assembly) -> Iterator[tuple[str, float, str]]:
    """Give the coefficients of friction that were given, and which demand each must bear."""
    parts = system.parts
    stacked = system.scene.coupling is not None
    under = (
        (parts.ground, _BLOCK),
        (parts.pads, _BLOCK),
        (parts.soil, _CAP if stacked else _BLOCK),
    )
    for part, name in under:
        friction = None if part is None else getattr(part.si, "friction", None)
        if friction is not None:
            yield name, friction, "the cap" if name == _CAP else "the block"
