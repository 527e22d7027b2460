"""The summary of a run for certificates: its verdict, and how far it is from the other one."""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Final, TypeAlias

import numpy as np

from rockframe.dynamics.events import EventKind
from rockframe.signals.arrays import AnyArray, Array
from rockframe.simulation.plan import Plan
from rockframe.solve.bookkeeping import RIGHT_ANGLE
from rockframe.solve.trajectory import Summary
from rockframe.solve.workspace import Status
from rockframe.system.assembly import Assembly

TIME_TOLERANCE: Final = 0.05
"""Relative difference of the times of two overturnings from which on their swings differ."""
HISTORY_TOLERANCE: Final = 0.2
"""Difference of two courses, over their largest element, beyond which the courses are different."""
INSTANTS: Final = 6
"""Number of instants, spread evenly over a run, about which its course is summed up."""


@dataclass(frozen=True)
class RunSummary:
    """The outcome of a run, as certificates compare it.

    The clearances are positive numbers that change smoothly with the inputs; at least one of them
    goes to zero where the verdict changes, or where a body that does not overturn first passes the
    overturning angle.
    """

    overturned: bool | None  # its verdict; None where the run was not finished
    peak: float  # largest absolute rotation [rad]
    # for a body that stays within the overturning angle, 1 less its peak over that angle; for one
    # that came back from beyond it, its peak over that angle less 1, and 1 less its peak over a
    # right angle. For one that overturns, the square of its rate at that angle [rad^2 s^-2], and
    # the time from then to the end of the run [s]: the smaller either is, the nearer the run is to
    # one that does not overturn, or not before its end
    clearances: tuple[float, ...] = ()
    time: float = math.nan  # of overturning by the verdict, NaN if none [s]
    direction: int = 0  # sign of the rotation at overturning, 0 if none
    step: float = math.nan  # average length of a step [s]
    # root of the sum of squared angular velocities at events, about some instants of the run. Where
    # the verdict depends on the history, as after many impacts, a change of it shows here long
    # before it shows in a clearance [rad s^-1]
    course: tuple[float, ...] = ()
    status: Status = Status.COMPLETED  # how it ended
    peak_share: float = math.nan  # largest ratio of a rotation to the overturning angle of its side
    in_motion: bool = False  # whether it did not overturn, but has the energy to do so later
    # whether it would slide, 1 or 0; NaN where no base has a coefficient of friction, or the run
    # was made without samples
    slides: float = math.nan
    lifted: bool = True  # whether the base left the ground; True also where that is not known
    slip: float = math.nan  # largest slip of a body; NaN where none slides [m]

    @property
    def within_the_angle(self) -> bool:
        """Whether it never passed the overturning angle: it has one clearance then."""
        return not self.overturned and len(self.clearances) == 1

    def alike(self, other: "RunSummary") -> bool:
        """Whether two runs take the same course.

        Both stay within the overturning angle, or both come back from beyond it, or both overturn
        in the same swing.
        """
        if self.overturned is None or self.overturned != other.overturned:
            return False
        pairs = list(zip(self.course, other.course, strict=True))
        if pairs and max(abs(a - b) for a, b in pairs) > HISTORY_TOLERANCE * max(map(max, pairs)):
            return False
        if len(self.clearances) != len(other.clearances):  # one of them passed the angle
            return False
        if not self.overturned:
            return True
        apart = abs(self.time - other.time) > TIME_TOLERANCE * max(self.time, other.time)
        return self.direction == other.direction and not apart


Run: TypeAlias = Callable[[Assembly, Plan], RunSummary]
"""A function that makes a run and gives its summary."""


def run_summary(
    summary: Summary,
    events: Mapping[str, AnyArray],
    peak_share: float,
    duration: float,
    *,
    in_motion: bool,
    slides: float,
    slip: float,
) -> RunSummary:
    """Return the summary of a run, from its events by names of the schema and its length [s]."""
    rates = np.abs(events["angular_velocity_before"])
    if summary.overturned:
        rate = float(rates[events["event_kind"] == EventKind.OVERTURNING][0])
        clearances = (rate * rate, duration - summary.verdict_time)
    elif summary.reached_limit:
        clearances = (peak_share - 1.0, 1.0 - summary.peak_rotation / RIGHT_ANGLE)
    else:
        clearances = (1.0 - peak_share,)
    return RunSummary(
        summary.overturned,
        summary.peak_rotation,
        clearances,
        summary.verdict_time,
        summary.verdict_direction,
        summary.end_time / max(summary.step_count, 1),
        _course(events["event_time"] / duration, rates),
        summary.status,
        peak_share,
        in_motion,
        slides,
        lifted=not math.isnan(summary.first_uplift_time),
        slip=slip,
    )


def _course(place: Array, rates: Array) -> tuple[float, ...]:
    """Sum up squared rates about some instants, with weights that fall with distance in time."""
    instants = np.arange(INSTANTS)[:, None] / (INSTANTS - 1)
    weights = np.clip(1.0 - (INSTANTS - 1) * np.abs(place - instants), 0.0, None)
    return tuple(np.sqrt(weights @ rates**2).tolist())
