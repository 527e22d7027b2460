"""Contact state of a stack, and work arrays."""

from typing import NamedTuple

import numpy as np

# holds of a body
FREE, HELD, SLIDING = 0, 1, 2
# states of an end of a base; one that is CLEAR of a bed is raised
CLEAR, RELAXING, TOUCHING, LEAVING, ENGAGING, SLIDES = 0, 1, 2, 3, 4, 5

# guards of a base: three of either end, that of the leading corner; then those of ties, and one of
# all limits
END_GUARDS, LEAD_GUARD, BASE_GUARDS = 3, 6, 7

# how a run ended
COMPLETED, OVERTURNED, CHATTER, TOO_SMALL, FIRED, SUSPECT = range(6)

LEAST_LEVER = 1e-7
"""Lever of the constraint force, over the size of the body, below which it cannot lift an end."""


class ContactState(NamedTuple):
    """Contact of each body with its base, changed by events."""

    ends: np.ndarray  # states of the left and the right end
    hold: np.ndarray
    point: np.ndarray  # held point, along the base from the foot of the centre of mass
    place: np.ndarray  # its position on the support
    sense: np.ndarray  # sign of the slip of a sliding end
    lead: np.ndarray  # sign of the leading corner
    taut: np.ndarray  # of each tie: 1 if it is taut, -1 if it is slack


class Room(NamedTuple):
    """Computed quantities of each body, and arrays to solve equations."""

    rel: np.ndarray
    rows: np.ndarray
    across: np.ndarray  # rows of the constraint forces
    keep: np.ndarray  # rows of the constrained motions
    load: np.ndarray
    matrix: np.ndarray
    right: np.ndarray
    force: np.ndarray  # constraint forces
    gain: np.ndarray  # effect of a unit constraint force on the constrained motion
    out: np.ndarray  # accelerations


def contacts_in_flight(n: int, ties: int) -> ContactState:
    """Return the contact state of bodies in flight."""
    numbers = [np.zeros(n) for _ in range(3)]
    ends, hold = np.zeros((n, 2), dtype=np.int64), np.zeros(n, dtype=np.int64)
    return ContactState(ends, hold, *numbers, np.ones(n), np.ones(ties))


def room_of(n: int) -> Room:
    """Return work arrays for n bodies."""
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
