"""What happens in a run: contact states and kinds of events.

Compiled functions use the plain integers below the enumerations.
"""

from enum import IntEnum
from typing import Final


class ContactState(IntEnum):
    """The corner, or the part of the base, that bears."""

    FULL = 0
    LEFT = 1
    RIGHT = 2
    FLIGHT = 3


class EventKind(IntEnum):
    """What happened at an event."""

    SEPARATION = 1
    IMPACT = 2
    REENGAGEMENT = 3
    PIVOT_CHANGE = 4
    UPLIFT = 5
    REST = 6
    OVERTURNING = 7
    TOPPLED = 8
    SOIL_SEPARATION = 9
    SOIL_CONTACT = 10
    SOIL_PIVOT_CHANGE = 11
    RESTRAINER_SLACK = 12
    RESTRAINER_TAUT = 13
    RESTRAINER_YIELD = 14
    RESTRAINER_UNLOADING = 15
    RESTRAINER_FRACTURE = 16
    SLIP = 17
    STICK = 18
    SLIP_REVERSAL = 19


class LinkState(IntEnum):
    """State of a restrainer; `PRESSED` is one that yields in compression."""

    SLACK = 0
    TAUT = 1
    YIELDING = 2
    BROKEN = 3
    PRESSED = 4


FULL: Final = int(ContactState.FULL)
LEFT: Final = int(ContactState.LEFT)
RIGHT: Final = int(ContactState.RIGHT)
FLIGHT: Final = int(ContactState.FLIGHT)

SILENT: Final = 0  # a change that is not reported to users
SEPARATION: Final = int(EventKind.SEPARATION)
IMPACT: Final = int(EventKind.IMPACT)
REENGAGEMENT: Final = int(EventKind.REENGAGEMENT)
PIVOT_CHANGE: Final = int(EventKind.PIVOT_CHANGE)
UPLIFT: Final = int(EventKind.UPLIFT)
REST: Final = int(EventKind.REST)
OVERTURNING: Final = int(EventKind.OVERTURNING)
TOPPLED: Final = int(EventKind.TOPPLED)
SOIL_SEPARATION: Final = int(EventKind.SOIL_SEPARATION)
SOIL_CONTACT: Final = int(EventKind.SOIL_CONTACT)
SOIL_PIVOT_CHANGE: Final = int(EventKind.SOIL_PIVOT_CHANGE)
LINK_SLACK: Final = int(EventKind.RESTRAINER_SLACK)
LINK_TAUT: Final = int(EventKind.RESTRAINER_TAUT)
LINK_YIELDS: Final = int(EventKind.RESTRAINER_YIELD)
LINK_UNLOADS: Final = int(EventKind.RESTRAINER_UNLOADING)
LINK_BREAKS: Final = int(EventKind.RESTRAINER_FRACTURE)
SLIP: Final = int(EventKind.SLIP)
STICK: Final = int(EventKind.STICK)
REVERSAL: Final = int(EventKind.SLIP_REVERSAL)
