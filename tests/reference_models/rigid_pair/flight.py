"""The upper body in flight over the lower one: gaps between ends, and positions of landing."""

from .pair import SIGN, Pair, turned

LANDINGS = tuple((kind, end) for end in SIGN for kind in ("corner", "edge"))
"""An end of the upper base on the lower top, or an end of the lower top on the upper base."""


def meeting(pair: Pair, place, kind: str, end: str) -> tuple[float, float]:
    """Return the position of an end relative to the other body.

    Returns
    -------
    tuple of float
        Distances from the middle of the face below it, along the face and away from it [m].
    """
    lower, upper = pair.lower, pair.upper
    own, other, mine, its = (upper, lower, 5, 2) if kind == "corner" else (lower, upper, 2, 5)
    level = -own.below if kind == "corner" else own.above
    x, y = turned(place[mine], *own.from_centre(SIGN[end] * own.half_width, level))
    x += place[mine - 2] - place[its - 2]
    y += place[mine - 1] - place[its - 1]
    x, y = turned(-place[its], x, y)
    away = y - other.above if kind == "corner" else -other.below - y
    return x + other.beside, away


def gaps(pair: Pair, place) -> dict:
    """Return the gaps between ends and the opposite faces, over the upper half width."""
    guards = {}
    for kind, end in LANDINGS:
        along, away = meeting(pair, place, kind, end)
        half = (pair.lower if kind == "corner" else pair.upper).half_width
        beyond = abs(along) > half * (1.0 + 1e-9)
        guards["gap", "joint", f"{kind} {end}"] = 1.0 if beyond else away / pair.upper.half_width
    return guards


def shift_after(pair: Pair, place, kind: str, end: str) -> float:
    """Return the offset of the upper body from the middle of the lower one when an end lands."""
    along, _ = meeting(pair, place, kind, end)
    if kind == "corner":
        return along - SIGN[end] * pair.upper.half_width
    return SIGN[end] * pair.lower.half_width - along
