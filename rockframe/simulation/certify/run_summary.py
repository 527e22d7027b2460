"""What a run showed, and how far its verdict was from the other one."""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Final, TypeAlias

import numpy as np

from rockframe.dynamics.events import EventKind
from rockframe.results.outcome import Generic
from rockframe.signals.arrays import Array
from rockframe.simulation.plan import Plan
from rockframe.solve.bookkeeping import RIGHT_ANGLE
from rockframe.solve.trajectory import Summary
from rockframe.solve.workspace import Status
from rockframe.system.assembly import Assembly

LATER: Final = 0.05
"""Share of its time by which an overturning comes earlier or later in another swing."""
OTHER: Final = 0.2
"""Share of the largest by which the parts of a course differ if they are another course."""
PARTS: Final = 6
"""Instants, spread evenly over a run, about which its course is summed up."""


@dataclass(frozen=True)
class RunSummary:
    """What a run showed.

    The verdict is that of the run, in the sense in which it was asked. The clearances are
    numbers above zero that change smoothly from scene to scene, and at least one of them goes
    to zero where the verdict changes, or where a body that comes back first passes the
    overturning angle.
    """

    overturned: bool | None  # its verdict; None where the run was not finished
    peak: float  # largest absolute rotation [rad]
    # of a body that stands, the share of the overturning angle that its peak left; of one that came
    # back from beyond it, how far it was beyond, and the share of a right angle that was left. Of
    # one that overturns, the square of its rate at that angle, and the time that was left: it fails
    # to overturn if it gets there without speed, or not within the run
    clearances: tuple[float, ...] = ()
    # of overturning, or of falling flat in a run that goes on; NaN if none [s]
    time: float = math.nan
    direction: int = 0  # sign of the rotation at overturning, 0 if none
    step: float = math.nan  # average length of a step [s]
    # of the whole run: root of the sum of squared rates at its events about some instants. Where
    # the verdict hangs on what came before, as after many impacts, this tells of it long before a
    # clearance does [rad s^-1]
    course: tuple[float, ...] = ()
    status: Status = Status.COMPLETED  # how it ended
    peak_share: float = math.nan  # largest share of a rotation in the overturning angle of its side
    in_motion: bool = False  # whether it stood with the energy to overturn later
    # whether it would slide, 1 or 0; NaN where no base has a coefficient of friction, or the run
    # was made without samples
    slides: float = math.nan
    lifted: bool = True  # whether the base left the ground; True also where nobody looked
    slip: float = math.nan  # largest slip of a body; NaN where none slides [m]

    @property
    def within_the_angle(self) -> bool:
        """Whether it stood and never passed the overturning angle: it has one clearance then."""
        return not self.overturned and len(self.clearances) == 1

    def alike(self, other: "RunSummary") -> bool:
        """Whether both take the same course.

        Both stand, within the overturning angle or back from beyond it, or both overturn in the
        same swing.
        """
        if self.overturned is None or self.overturned != other.overturned:
            return False
        pairs = list(zip(self.course, other.course, strict=True))
        if pairs and max(abs(a - b) for a, b in pairs) > OTHER * max(map(max, pairs)):
            return False
        if len(self.clearances) != len(other.clearances):  # one of them passed the angle
            return False
        if not self.overturned:
            return True
        apart = abs(self.time - other.time) > LATER * max(self.time, other.time)
        return self.direction == other.direction and not apart


Run: TypeAlias = Callable[[Assembly, Plan], RunSummary]
"""Makes a run, and tells what it showed."""


def run_summary(
    summary: Summary,
    events: Mapping[str, Generic],
    peak_share: float,
    duration: float,
    *,
    in_motion: bool,
) -> RunSummary:
    """Tell what a run showed, also by its events, by their names in the schema."""
    rates = np.abs(events["angular_velocity_before"])
    if summary.overturned:
        rate = float(rates[events["event_kind"] == EventKind.OVERTURNING][0])
        clearances = (rate * rate, duration - summary.verdict_time)
    elif summary.passed:
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
        lifted=not math.isnan(summary.first_uplift_time),
    )


def _course(place: Array, rates: Array) -> tuple[float, ...]:
    """Sum up squares of rates by their places in a run, the nearer to an instant the more."""
    instants = np.arange(PARTS)[:, None] / (PARTS - 1)
    weights = np.clip(1.0 - (PARTS - 1) * np.abs(place - instants), 0.0, None)
    return tuple(np.sqrt(weights @ rates**2).tolist())
