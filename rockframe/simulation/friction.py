"""Whether the friction of a scene's bases holds what stands on them."""

from collections.abc import Iterator, Mapping
from typing import Final

import numpy as np

from rockframe.results.forces import EventStates
from rockframe.results.outcome import Generic
from rockframe.system.assembly import Assembly

_BLOCK: Final = "friction_demand"
_CAP: Final = "soil_friction_demand"


def has_limit(system: Assembly) -> bool:
    """Whether a base of the scene has a coefficient of friction, to which its runs are held."""
    return any(True for _ in _frictions(system))


def slips(system: Assembly, values: Mapping[str, Generic], events: EventStates) -> Iterator[str]:
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
        if name not in values:  # a soil of one's own that does not show its reaction
            continue
        demand = events.with_samples(values, name)
        exceeds = demand > friction
        if not exceeds.any():
            continue
        first = events.times_with_samples(values)[exceeds].min()
        above = (values[name] > friction).astype(float)
        lasted = float(np.diff(time) @ (above[1:] + above[:-1])) / 2.0
        most = f"up to {demand.max():.3g}" if np.isfinite(demand.max()) else "without bound"
        yield (
            f"{words} would slide: the friction demand exceeds the coefficient {friction:.6g} "
            f"from {first:.4g} s on, for {lasted:.3g} s in all, {most}; the model holds it"
        )


def _frictions(system: Assembly) -> Iterator[tuple[str, float, str]]:
    """Give the coefficients of friction that were given, and which demand each must bear."""
    parts = system.parts
    under = (
        (parts.ground, _BLOCK),
        (parts.pads, _BLOCK),
        (parts.soil, _CAP if system.setting.stacked else _BLOCK),
    )
    for part, name in under:
        friction = None if part is None else getattr(part.si, "friction", None)
        if friction is not None:
            yield name, friction, "the cap" if name == _CAP else "the block"
