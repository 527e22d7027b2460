"""All that a run begins with: state, memory, settings and progress."""

import math
from dataclasses import dataclass
from typing import Final

import numpy as np

from rockframe.compiled import Integers, Vector
from rockframe.dynamics.events import FLIGHT, FULL
from rockframe.dynamics.protocol import (
    IMPACT_LOSS,
    IMPULSIVE_INPUT,
    LINK_LOSS,
    REPINNING_LOSS,
    ContactModel,
    Ending,
    Start,
)
from rockframe.solve import layout as at
from rockframe.solve.accuracy import Accuracy, substeps_of
from rockframe.solve.bookkeeping import ROUNDING
from rockframe.solve.driver import FIXED_STEPS

FIRST_SCALE: Final = 1e-6
"""Share of its typical size that counts as a variable's size before it has moved."""
FIRST_STEP: Final = 1e-3
"""First step, as a share of the model's shortest period."""
CHATTER_SHARE: Final = 1e-6
"""Events closer than this share of the model's shortest period count as chatter."""
ENERGY_NOISE: Final = 1e-12
"""Share of the model's typical energy below which energies are rounding noise."""
NEVER: Final = 2**62
"""An interval that no run comes to."""


@dataclass(frozen=True)
class Begun:
    """A run before its first step."""

    mode: int  # of the model
    state: Vector  # coordinates, their rates, and variables of first order
    memory: Vector  # the model's memory, twice
    start_memory: Vector
    controls: Vector  # laid out in :mod:`rockframe.solve.layout`
    clock: Vector
    counters: Integers
    reference: Vector  # largest size so far of each variable
    limits: Vector  # of the rotation, :mod:`rockframe.solve.guards`
    tolerance: Vector  # rounding noise of the guards
    substeps: int  # fixed steps in each interval, 0 for steps by tolerance


def begun(
    model: ContactModel,
    start: Start | Ending,
    accuracy: Accuracy,
    *,
    interval: float,
    duration: float,
    output_step: float | None,
    stop_at_overturning: bool,
) -> Begun:
    """Begin a run.

    Parameters
    ----------
    model : ContactModel
        The equations.
    start : Start or Ending
        Where the run starts, or another run of the same model ended.
    accuracy : Accuracy
        Settings.
    interval : float
        Of the motion [s].
    duration : float
        Length of the run [s].
    output_step : float or None
        Spacing of the output samples [s].
    stop_at_overturning : bool
        Whether the run ends when the rotation reaches its limit.

    Returns
    -------
    Begun

    Raises
    ------
    SolverError
        Steps of the length asked for would not be stable.
    """
    mode, state, memory = _state_of(model, start)
    contact = model.system.contact_state_of(mode, 0)
    shortest_period = 2.0 * math.pi / model.fastest_frequency
    substeps = substeps_of(accuracy, model, interval)
    controls = np.zeros(at.CONTROLS)
    controls[at.RTOL] = accuracy.rtol or FIXED_STEPS
    controls[at.FLOOR] = accuracy.floor
    controls[at.MAX_STEP] = (
        interval / substeps if substeps else shortest_period / accuracy.steps_per_period
    )
    controls[at.DURATION] = duration
    controls[at.TIME_STEP] = interval
    controls[at.OUTPUT_STEP] = output_step or 1.0
    controls[at.CHATTER_TIME] = CHATTER_SHARE * shortest_period
    clock = np.zeros(at.CLOCK)
    clock[at.NEXT_STEP] = controls[at.MAX_STEP] if substeps else FIRST_STEP * shortest_period
    rotation = model.rotation_in(state)
    clock[at.PEAK_LEFT], clock[at.PEAK_RIGHT] = max(-rotation, 0.0), max(rotation, 0.0)
    clock[at.FIRST_UPLIFT] = -1.0 if contact == FULL else 0.0
    clock[at.OVERTURNING_TIME] = clock[at.EVENT_TIME] = -1.0
    clock[at.START_ENERGY] = clock[at.GROUND_X] = clock[at.GROUND_Y] = math.nan
    clock[at.LARGEST_TERM] = clock[at.LARGEST_MOVED] = ENERGY_NOISE * model.energy_scale
    counters = np.zeros(at.COUNTERS, dtype=np.int64)
    counters[at.MODE] = mode
    counters[at.PENDING] = -1
    counters[at.STALE] = 1
    counters[at.LAST_INTERVAL] = NEVER
    counters[at.MAX_STEPS] = counters[at.PAUSE_AT] = accuracy.max_steps
    counters[at.STOP_AT_OVERTURNING] = int(stop_at_overturning)
    counters[at.FLIGHTS] = int(contact == FLIGHT)
    return Begun(
        mode, state, memory, memory.copy(), controls, clock, counters,
        reference=_sizes(model, accuracy, state, rotation),
        limits=np.array([*model.rotation_limits, *model.rotation_weights, *model.other_limits]),
        tolerance=np.append(model.guard_tolerance, ROUNDING),
        substeps=substeps,
    )  # fmt: skip


def _state_of(model: ContactModel, start: Start | Ending) -> tuple[int, Vector, Vector]:
    if isinstance(start, Start):
        return model.initial(start)
    memory = start.memory.copy()
    # losses are counted anew in each run
    memory[[IMPACT_LOSS, REPINNING_LOSS, IMPULSIVE_INPUT, LINK_LOSS]] = 0.0
    return start.mode, start.state.copy(), memory


def _sizes(model: ContactModel, accuracy: Accuracy, state: Vector, rotation: float) -> Vector:
    sizes: Vector = np.maximum(np.abs(state), FIRST_SCALE * model.scales)
    if model.rounding is not None and accuracy.rtol is not None and accuracy.floor > 0.0:
        # no step is short enough for an error below the rounding of the forces
        noise = model.rounding(abs(rotation))
        sizes = np.maximum(sizes, noise / (accuracy.rtol * accuracy.floor))
    return sizes
