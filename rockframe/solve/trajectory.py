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
    """Table of events; `n` coordinates.

    Parameters
    ----------
    time : ndarray, shape (events,)
        [s].
    kind : ndarray of int64, shape (events,)
        :class:`rockframe.dynamics.events.EventKind`, or ``SILENT`` where
        users are shown none.
    mode_before, mode_after : ndarray of int64, shape (events,)
        Modes of the model.
    state_before, state_after : ndarray, shape (events, 2 n)
        Coordinates, then their rates.
    memory : ndarray, shape (events, memory)
        The model's memory after each event.
    """

    time: Vector
    kind: Integers
    mode_before: Integers
    mode_after: Integers
    state_before: Matrix
    state_after: Matrix
    memory: Matrix


@dataclass(frozen=True, kw_only=True)
class Summary:
    """What became of a run.

    Parameters
    ----------
    status : Status
        How the run ended.
    end_time, peak_left, peak_right, overturning_time, first_uplift_time, flight_time : float
        Of the dense solution; times are NaN where nothing of the kind happened.
    overturning_direction : int
        Sign of the rotation at overturning, 0 if none.
    impact_count, flight_count, step_count, rejected_count : int
        Counts.
    substeps : int
        Fixed steps in each interval of the motion, 0 for steps by tolerance.
    energy_residual : float
        Largest imbalance of the energies over their largest term.
    ending : Ending
        Where the run ended.
    """

    status: Status
    end_time: float
    peak_left: float
    peak_right: float
    overturning_time: float
    overturning_direction: int
    first_uplift_time: float
    flight_time: float
    impact_count: int
    flight_count: int
    step_count: int
    rejected_count: int
    substeps: int
    energy_residual: float
    ending: Ending

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
    """A run.

    Parameters
    ----------
    time : ndarray, shape (samples,)
        Output times [s].
    state : ndarray, shape (samples, 2 n)
        Coordinates, then their rates.
    mode : ndarray of int64, shape (samples,)
        Modes of the model.
    work : ndarray, shape (samples, 2) or (0, 2)
        Energies dissipated by dashpots and put in by the ground, if asked for.
    start_mode : int
        The model's mode at the start.
    start_memory : ndarray, shape (memory,)
        The model's memory at the start.
    events : Events
        What happened when.
    start_energy : float
        Kinetic, gravity and elastic energy at the start, from that at rest.
    as_python : bool
        Whether it was made in plain Python, not by machine code.
    steps : Steps or None
        Both ends of all steps, if they are kept.
    """

    time: Vector
    state: Matrix
    mode: Integers
    work: Matrix
    start_mode: int
    start_memory: Vector
    events: Events
    start_energy: float
    as_python: bool
    steps: Steps | None


def run_counts(clock: Vector, counters: Integers) -> dict[str, Any]:
    """Give what an integrator's progress tells of a finished run, by the names of a summary.

    Parameters
    ----------
    clock, counters : ndarray
        Laid out in :mod:`rockframe.solve.layout`.

    Returns
    -------
    dict of str to float or int
        Without the status, the number of sub-steps and the ending.
    """
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
