"""Changes of a run's inputs: one parameter of its scene, or the scale of what drives it."""

from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import Final

from rockframe.dynamics.protocol import Ending
from rockframe.errors import RockframeError
from rockframe.simulation.plan import Plan
from rockframe.system.assembly import Assembly, assemble
from rockframe.system.bodies import OverturningAngles

QUARTERS: Final = (0.25, 0.5)
"""Shares of the nudge at which scales are tried inside it."""
RATIO: Final = 1.25
"""Of the changes of scale in a geometric row."""
LONGEST: Final = 0.04
"""Longest step between two changes of scale, over the reach."""

SceneAt = Callable[[float], Assembly | None]


def parameters(system: Assembly) -> Iterator[tuple[str, SceneAt]]:
    """Give every parameter of every part of a scene, and the scene with it changed.

    Parameters
    ----------
    system : Assembly
        The scene.

    Yields
    ------
    str, callable
        The parameter in words, and what gives the scene for a relative change of it: None
        where the parts then misfit.
    """
    options = system.options.to_dict()
    parts = system.parts.structural()

    def changed(place: int, name: str) -> SceneAt:
        def at(change: float) -> Assembly | None:
            try:
                part = parts[place].with_scaled(name, 1.0 + change)
                return assemble([*parts[:place], part, *parts[place + 1 :]], **options)
            except RockframeError:
                return None

        return at

    for place, part in enumerate(parts):
        for name in part.parameters():
            if name == "friction" and not system.setting.slides:  # it changes no motion
                continue
            yield f"{name.replace('_', ' ')} of the {part.noun}", changed(place, name)


def scales(nudge: float, reach: float) -> list[float]:
    """Give the changes of scale to be tried first, from near to far.

    Parameters
    ----------
    nudge, reach : float
        Between a share of the nudge and the reach [1].

    Returns
    -------
    list of float
    """
    row = [share * nudge for share in QUARTERS if share * nudge < reach]
    place = min(nudge, reach)
    while place < reach:
        row.append(place)
        place += min((RATIO - 1.0) * place, LONGEST * reach)
    if len(row) > 1 and reach - row[-1] < 0.5 * (row[-1] - row[-2]):
        row.pop()
    return [*row, reach]


def scaled(plan: Plan, scale: float, limits: OverturningAngles) -> Plan | None:
    """Scale what drives a run: its motion, or without one its start; None if it cannot be."""
    if plan.motion is not None:
        return replace(plan, motion=plan.motion.scaled(scale))
    start = plan.initial
    if isinstance(start, Ending):
        return None
    if not start.si.rotation and start.si.angular_velocity == 0.0:
        return None
    try:
        for name in ("rotation", "angular_velocity"):
            if name in start.parameters():
                start = start.with_scaled(name, scale)
    except RockframeError:
        return None
    rotation = start.si.rotation or 0.0
    if abs(rotation) >= limits.on_side_of(rotation):
        return None
    return replace(plan, initial=start)
