"""Results of a run, and names of its events."""

import math
from dataclasses import dataclass, field

import numpy as np

from .contacts import INTERFACES, Pattern

STATE = 17
"""Six places, six velocities, slips of ground and joint, work of the ground, of both frictions."""


class OffTheTopError(RuntimeError):
    """An end of the upper base leaves the lower top. ``run`` holds the results before."""

    def __init__(self, time: float, run: "Run"):
        super().__init__(f"the upper base leaves the top of the lower body at {time} s")
        self.time, self.run = time, run


@dataclass(frozen=True)
class Event:
    """A change of the pattern.

    ``kind`` is "uplift", "flight", "impact", "rest", "slip", "stick", "reversal" or "overturning";
    "held" where contacts stay without pressing, as no pattern is admissible, and "same" where
    they press again, or where a pattern that is not the only one continues; "chatter" where
    the run ends because events are endless. ``where`` is the interface concerned, or the body
    that overturns; ``end`` the end that opens or closes.
    """

    time: float
    kind: str
    where: str
    end: str
    before: Pattern
    after: Pattern
    admissible: int = 1
    lost: float = 0.0
    others: tuple[Pattern, ...] = ()


@dataclass
class Run:
    """Results of a run; of the lower body or the ground first, then of the upper one or the joint.

    ``displacement`` is that of the centres of mass across; ``slip`` that of the end that bears
    along the surface, in flight of the middle of the base.
    """

    time: np.ndarray
    place: np.ndarray
    slip: np.ndarray
    events: list[Event] = field(default_factory=list)
    peaks: np.ndarray = field(default_factory=lambda: np.zeros(2))
    peak_slips: np.ndarray = field(default_factory=lambda: np.zeros(2))
    overturned: bool = False
    end: float = 0.0
    energies: dict[str, float] = field(default_factory=dict)
    imbalance: float = 0.0
    final: np.ndarray = field(default_factory=lambda: np.zeros(STATE))

    @property
    def rotation(self) -> np.ndarray:
        """Absolute rotations, clockwise [rad]."""
        return self.place[:, [2, 5]]

    @property
    def displacement(self) -> np.ndarray:
        """Displacements of the centres of mass across [m]."""
        return self.place[:, [0, 3]] - self.place[0, [0, 3]]

    @property
    def unique_until(self) -> float:
        """Time of the first event after which motion is not unique [s]."""
        return next((one.time for one in self.events if one.admissible != 1), math.inf)


def named(before: Pattern, after: Pattern) -> tuple[str, str, str]:
    """Name a change without an impact: kind, interface and end."""
    both = list(zip(INTERFACES, before, after, strict=True))
    for key, earlier, later in both:
        gone = [end for end in earlier.ends if end not in later.ends]
        if gone:
            kind = "uplift" if later.ends else "flight"
            return kind, key, gone[0] if len(gone) == 1 else ""
    for key, earlier, later in both:
        if earlier.slip and earlier.slip != later.slip:
            return ("reversal" if later.slip else "stick"), key, ""
    for key, earlier, later in both:
        if earlier != later:
            return "slip", key, ""
    return "same", "", ""
