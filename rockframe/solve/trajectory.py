"""What an integration leaves behind: plain arrays, in SI units and per unit mass."""

import math
from dataclasses import dataclass
from typing import Any

from rockframe.compiled import Integers, Matrix, Vector
from rockframe.dynamics.protocol import Ending
from rockframe.solve import layout as at
from rockframe.solve.layout import Status
from rockframe.solve.steps import Steps


@dataclass(frozen=True)
class Events:
    """Table of events; `n` coordinates."""

    time: Vector  # [s]
    # :class:`rockframe.dynamics.events.EventKind`, or ``SILENT`` where users are shown none
    kind: Integers
    mode_before: Integers  # modes of the model
    mode_after: Integers
    state_before: Matrix  # coordinates, then their rates
    state_after: Matrix
    memory: Matrix  # the model's memory after each event


@dataclass(frozen=True, kw_only=True)
class Summary:
    """What became of a run."""

    status: Status  # how the run ended
    end_time: float  # of the dense solution; times are NaN where nothing of the kind happened
    peak_left: float
    peak_right: float
    overturning_time: float
    overturning_direction: int  # sign of the rotation at overturning, 0 if none
    first_uplift_time: float
    flight_time: float
    impact_count: int  # counts
    flight_count: int
    step_count: int
    rejected_count: int
    substeps: int  # fixed steps in each interval of the motion, 0 for steps by tolerance
    energy_residual: float  # largest imbalance of the energies over their largest term
    ending: Ending  # where the run ended

    @property
    def peak_rotation(self) -> float:
        """Largest rotation to either side [rad]."""
        return max(self.peak_left, self.peak_right)

    @property
    def passed(self) -> bool:
        """Whether the rotation reached the overturning angle."""
        return not math.isnan(self.overturning_time)

    @property
    def overturned(self) -> bool | None:
        """The verdict: whether the block overturned, in the sense in which the run was asked."""
        return self.status.overturned

    @property
    def verdict_time(self) -> float:
        """When it overturned in that sense; NaN if it did not [s]."""
        if self.status is Status.TOPPLED:
            return self.end_time
        return self.overturning_time if self.overturned else math.nan

    @property
    def verdict_direction(self) -> int:
        """Sign of the rotation at that time; 0 if it did not overturn."""
        if self.status is Status.TOPPLED:
            return 1 if self.peak_right > self.peak_left else -1
        return self.overturning_direction if self.overturned else 0


@dataclass(frozen=True, kw_only=True)
class Trajectory(Summary):
    """A run."""

    time: Vector  # output times [s]
    state: Matrix  # coordinates, then their rates
    mode: Integers  # modes of the model
    work: Matrix  # energies dissipated by dashpots and put in by the ground, if asked for
    start_mode: int  # the model's mode at the start
    start_memory: Vector  # the model's memory at the start
    events: Events  # what happened when
    start_energy: float  # kinetic, gravity and elastic energy at the start, from that at rest
    as_python: bool  # whether it was made in plain Python, not by machine code
    steps: Steps | None  # both ends of all steps, if they are kept


def run_counts(clock: Vector, counters: Integers) -> dict[str, Any]:
    """Give what an integrator's progress tells of a finished run, by the names of a summary."""
    reals, wholes = clock.tolist(), counters.tolist()
    moved, residual = reals[at.LARGEST_MOVED], reals[at.RESIDUAL]
    return {
        "end_time": reals[at.TIME],
        "peak_left": reals[at.PEAK_LEFT],
        "peak_right": reals[at.PEAK_RIGHT],
        "overturning_time": _time_or_nan(reals[at.OVERTURNING_TIME]),
        "overturning_direction": int(reals[at.OVERTURNING_SIDE]),
        "first_uplift_time": _time_or_nan(reals[at.FIRST_UPLIFT]),
        "flight_time": reals[at.FLIGHT_TIME],
        "impact_count": wholes[at.IMPACTS],
        "flight_count": wholes[at.FLIGHTS],
        "step_count": wholes[at.STEPS],
        "rejected_count": wholes[at.REJECTED],
        "energy_residual": residual / moved if moved > 0.0 else 0.0,
    }


def _time_or_nan(value: float) -> float:
    return value if value >= 0.0 else math.nan
