"""The upper body in the air over the lower one: how far ends are apart, and where one lands."""

from .pair import SIGN, Pair, turned

LANDINGS = tuple((kind, end) for end in SIGN for kind in ("corner", "edge"))
"""An end of the upper base on the top of the lower body, or an end of that on the upper base."""


def meeting(pair: Pair, place, kind: str, end: str) -> tuple[float, float]:
    """Return an end as the other body sees it.

    Returns
    -------
    tuple of float
        From the middle of the face that it may land on, along it and away from it [m].
    """
    one, two = pair.lower, pair.upper
    own, other, mine, its = (two, one, 5, 2) if kind == "corner" else (one, two, 2, 5)
    level = -own.below if kind == "corner" else own.above
    x, y = turned(place[mine], *own.from_centre(SIGN[end] * own.half_width, level))
    x += place[mine - 2] - place[its - 2]
    y += place[mine - 1] - place[its - 1]
    x, y = turned(-place[its], x, y)
    away = y - other.above if kind == "corner" else -other.below - y
    return x + other.beside, away


def gaps(pair: Pair, place) -> dict:
    """Return how far ends are from the faces that they may land on, over the upper half width."""
    found = {}
    for kind, end in LANDINGS:
        along, away = meeting(pair, place, kind, end)
        half = (pair.lower if kind == "corner" else pair.upper).half_width
        beyond = abs(along) > half * (1.0 + 1e-9)
        found["gap", "joint", f"{kind} {end}"] = 1.0 if beyond else away / pair.upper.half_width
    return found


def shift_after(pair: Pair, place, kind: str, end: str) -> float:
    """Return how far the upper body stands beside the middle of the lower one when an end lands."""
    along, _ = meeting(pair, place, kind, end)
    if kind == "corner":
        return along - SIGN[end] * pair.upper.half_width
    return SIGN[end] * pair.lower.half_width - along
