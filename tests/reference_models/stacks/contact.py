"""How the bodies of a stack stand, and room for what is computed from that."""

from typing import NamedTuple

import numpy as np

# how a body is held
FREE, HELD, SLIDING = 0, 1, 2
# states of an end of a base; one that is CLEAR of a bed is raised
CLEAR, RELAXING, TOUCHING, LEAVING, ENGAGING, SLIDES = 0, 1, 2, 3, 4, 5

# guards of a base: three of either end, that of the leading corner; then those of ties, and one of
# all limits
END_GUARDS, LEAD_GUARD, BASE_GUARDS = 3, 6, 7

# how a run ended
COMPLETED, OVERTURNED, CHATTER, TOO_SMALL, FIRED, SUSPECT = range(6)

LEAST_LEVER = 1e-7
"""Lever of the hold, over the size of the body, below which it cannot lift an end."""


class Standing(NamedTuple):
    """How each body stands on its base: what changes at events."""

    ends: np.ndarray  # states of the left and the right end
    hold: np.ndarray
    point: np.ndarray  # that is held, along the base from the foot of the centre of mass
    place: np.ndarray  # where it is held, on what carries the body
    sense: np.ndarray  # sign of the slip of a sliding end
    lead: np.ndarray  # sign of the leading corner
    taut: np.ndarray  # of each tie: 1 if it is taut, -1 if it is slack


class Room(NamedTuple):
    """What is computed for each body, and room to solve equations in."""

    rel: np.ndarray
    rows: np.ndarray
    across: np.ndarray  # rows of what holds a body
    keep: np.ndarray  # rows of what is kept by it
    load: np.ndarray
    matrix: np.ndarray
    right: np.ndarray
    force: np.ndarray  # of what holds a body
    gain: np.ndarray  # what unit force of a hold does to what it keeps
    out: np.ndarray  # accelerations


def standing_of(n: int, ties: int) -> Standing:
    """Return a standing in flight."""
    numbers = [np.zeros(n) for _ in range(3)]
    ends, hold = np.zeros((n, 2), dtype=np.int64), np.zeros(n, dtype=np.int64)
    return Standing(ends, hold, *numbers, np.ones(n), np.ones(ties))


def room_of(n: int) -> Room:
    """Return room for n bodies."""
    m = n + 2
    return Room(
        np.zeros((n, 8)),
        np.zeros((n, 3, 6)),
        np.zeros((n, 6)),
        np.zeros((n, 6)),
        np.zeros(3 * (n + 1)),
        np.zeros((m, m)),
        np.zeros(m),
        np.zeros(n),
        np.zeros(n),
        np.zeros(3 * (n + 1)),
    )
