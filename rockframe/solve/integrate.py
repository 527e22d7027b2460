"""From a model, a start and a ground motion to a trajectory."""

import math
from time import perf_counter

import numpy as np

from rockframe.compiled import Matrix, Vector, say_slow
from rockframe.dynamics.events import ContactState
from rockframe.dynamics.protocol import (
    IMPACT_LOSS,
    IMPULSIVE_INPUT,
    REPINNING_LOSS,
    ContactModel,
    Ending,
    Start,
)
from rockframe.signals import Motion
from rockframe.solve import layout as at
from rockframe.solve.accuracy import Accuracy
from rockframe.solve.bookkeeping import ON_SAMPLE, ROUNDING
from rockframe.solve.driver import FIXED_STEPS, advance
from rockframe.solve.equations import equations_of
from rockframe.solve.layout import Status
from rockframe.solve.substeps import STABLE, substeps_of
from rockframe.solve.trajectory import Events, Trajectory
from rockframe.solve.workspace import (
    EventTable,
    Output,
    Pieces,
    Progress,
    Tables,
    make_workspace,
)

FIRST_SCALE = 1e-6
"""Share of its typical size that counts as a variable's size before it has moved."""
FIRST_STEP = 1e-3
"""First step, as a share of the model's shortest period."""
CHATTER_SHARE = 1e-6
"""Events closer than this share of the model's shortest period count as chatter."""
ENERGY_NOISE = 1e-12
"""Share of the model's typical energy below which energies are rounding noise."""
EVENT_ROOM = 256
STILL_INTERVAL = 0.01
"""Interval into which time is cut where the ground has no samples [s]."""


def integrate(
    model: ContactModel,
    start: Start | Ending,
    motion: Motion | None,
    accuracy: Accuracy,
    *,
    duration: float,
    output_step: float | None,
    stop_at_overturning: bool = True,
    with_work: bool = False,
) -> Trajectory:
    """Integrate a model under a ground motion.

    Parameters
    ----------
    model : ContactModel
        The equations.
    start : Start or Ending
        Where the run starts, or another run of the same model ended.
    motion : Motion or None
        Of the ground, which stands still beyond its last sample, or all the time.
    accuracy : Accuracy
        Settings.
    duration : float
        Length of the run [s].
    output_step : float or None
        Spacing of the output samples; None stores none [s].
    stop_at_overturning : bool
        Whether the run ends when the rotation reaches its limit.
    with_work : bool
        Whether dashpot and input work are stored at the output times.

    Returns
    -------
    Trajectory
        Also where the run could not be finished; see its status.
    """
    mode, state, memory = _beginning(model, start)
    shortest_period = 2.0 * math.pi / model.fastest_frequency
    controls = np.zeros(at.CONTROLS)
    interval = STILL_INTERVAL if motion is None else motion.time_step
    substeps = substeps_of(accuracy, model, interval)
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
    rotation = float(model.rotation_weights @ state[: len(model.rotation_weights)])
    clock[at.PEAK_LEFT], clock[at.PEAK_RIGHT] = max(-rotation, 0.0), max(rotation, 0.0)
    clock[at.FIRST_UPLIFT] = -1.0 if model.contact[mode] == ContactState.FULL else 0.0
    clock[at.OVERTURNING_TIME] = clock[at.EVENT_TIME] = -1.0
    clock[at.START_ENERGY] = clock[at.GROUND_X] = clock[at.GROUND_Y] = math.nan
    clock[at.LARGEST_TERM] = clock[at.LARGEST_MOVED] = ENERGY_NOISE * model.energy_scale
    counters = np.zeros(at.COUNTERS, dtype=np.int64)
    counters[at.MODE] = mode
    counters[at.PENDING] = -1
    counters[at.MAX_STEPS] = accuracy.max_steps
    counters[at.STOP_AT_OVERTURNING] = int(stop_at_overturning)
    counters[at.FLIGHTS] = int(model.contact[mode] == ContactState.FLIGHT)

    rows = 0 if output_step is None else 1 + math.floor(duration / output_step * (1.0 + 1e-12))
    width = len(state)
    out_state = np.empty((rows, width))
    out_mode = np.empty(rows, dtype=np.int32)
    out_work = np.zeros((rows if with_work else 0, 2))
    if rows:
        out_state[0], out_mode[0] = state, mode
        counters[at.OUTPUTS] = 1

    start_memory = memory.copy()
    reference = np.maximum(np.abs(state), FIRST_SCALE * model.scales)
    if model.rounding is not None and accuracy.rtol is not None and accuracy.floor > 0.0:
        # no step is short enough for an error below the rounding of the forces
        noise = model.rounding(abs(rotation))
        reference = np.maximum(reference, noise / (accuracy.rtol * accuracy.floor))
    progress = Progress(controls, clock, counters)
    output = Output(out_state, out_mode, out_work)
    events = EventTable(
        np.empty((EVENT_ROOM, 1 + 2 * width + len(memory))),
        np.empty((EVENT_ROOM, 3), dtype=np.int64),
    )
    tables = Tables(
        model.active,
        model.contact,
        _longest_steps(model),
        np.append(model.guard_tolerance, ROUNDING),
    )
    pieces = _pieces_of(motion)
    equations = equations_of(model.system, fixed_steps=accuracy.rtol is None)
    limits = np.array([*model.rotation_limits, *model.rotation_weights])
    workspace = make_workspace(equations, state, reference, limits)
    began = perf_counter()
    while True:
        result = advance(
            equations,
            tables,
            memory,
            pieces,
            progress,
            output,
            events,
            workspace,
        )
        if result != at.MORE_ROOM:
            break
        events = EventTable(
            np.concatenate([events.values, np.empty_like(events.values)]),
            np.concatenate([events.codes, np.empty_like(events.codes)]),
        )

    say_slow(perf_counter() - began)

    stored = int(counters[at.OUTPUTS])
    time: Vector = np.arange(stored, dtype=np.float64) * (output_step or 1.0)
    end = float(clock[at.TIME])
    out_state, out_mode, out_work = out_state[:stored], out_mode[:stored], out_work[:stored]
    unfinished = result != at.COMPLETED
    if rows and unfinished and end - time[-1] > ON_SAMPLE * (output_step or 1.0):
        # the instant at which the run ended belongs to its history
        time = np.concatenate([time, np.array([end])])
        out_state = np.vstack([out_state, workspace.state])
        out_mode = np.append(out_mode, np.int32(counters[at.MODE]))
        if with_work:
            out_work = np.vstack([out_work, [clock[at.DISSIPATED], clock[at.SUPPLIED]]])
    return Trajectory(
        time=time,
        state=out_state,
        mode=out_mode,
        work=out_work,
        start_mode=mode,
        start_memory=start_memory,
        events=_events(events, int(counters[at.EVENTS]), width),
        status=Status(result),
        end_time=end,
        peak_left=float(clock[at.PEAK_LEFT]),
        peak_right=float(clock[at.PEAK_RIGHT]),
        overturning_time=_time_or_nan(clock[at.OVERTURNING_TIME]),
        overturning_direction=int(clock[at.OVERTURNING_SIDE]),
        first_uplift_time=_time_or_nan(clock[at.FIRST_UPLIFT]),
        flight_time=float(clock[at.FLIGHT_TIME]),
        impact_count=int(counters[at.IMPACTS]),
        flight_count=int(counters[at.FLIGHTS]),
        step_count=int(counters[at.STEPS]),
        rejected_count=int(counters[at.REJECTED]),
        substeps=substeps,
        energy_residual=_ratio(float(clock[at.RESIDUAL]), float(clock[at.LARGEST_MOVED])),
        ending=Ending(int(counters[at.MODE]), workspace.state.copy(), memory.copy()),
        start_energy=float(clock[at.START_ENERGY]),
    )


def _pieces_of(motion: Motion | None) -> Pieces:
    """Give the polynomials of both directions."""
    if motion is None:
        return Pieces(_STILL, _STILL)
    vertical = _STILL if motion.vertical is None else _read_only(motion.vertical.pieces)
    return Pieces(_read_only(motion.horizontal.pieces), vertical)


def _read_only(array: Matrix) -> Matrix:
    view = array.view()
    view.flags.writeable = False
    return view


def _beginning(model: ContactModel, start: Start | Ending) -> tuple[int, Vector, Vector]:
    if isinstance(start, Start):
        return model.initial(start)
    memory = start.memory.copy()
    # losses are counted anew in each run
    memory[IMPACT_LOSS] = memory[REPINNING_LOSS] = memory[IMPULSIVE_INPUT] = 0.0
    return start.mode, start.state.copy(), memory


def _longest_steps(model: ContactModel) -> Vector:
    """Give the longest stable fixed step in each mode, where that is not for its vibrations."""
    longest = np.full(len(model.relaxation), math.inf)
    decays = model.relaxation > 0.0
    longest[decays] = STABLE / model.relaxation[decays]
    return longest


def _events(table: EventTable, count: int, width: int) -> Events:
    values, codes = table.values[:count], table.codes[:count]
    return Events(
        time=values[:, 0].copy(),
        kind=codes[:, 0].copy(),
        mode_before=codes[:, 1].copy(),
        mode_after=codes[:, 2].copy(),
        state_before=values[:, 1 : 1 + width].copy(),
        state_after=values[:, 1 + width : 1 + 2 * width].copy(),
        memory=values[:, 1 + 2 * width :].copy(),
    )


def _time_or_nan(value: float) -> float:
    return float(value) if value >= 0.0 else math.nan


def _ratio(part: float, whole: float) -> float:
    return part / whole if whole > 0.0 else 0.0


_STILL = _read_only(np.zeros((0, 2)))
