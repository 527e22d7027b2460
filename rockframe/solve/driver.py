"""The event-driven integration of any contact model, page "Numerics" of the manual.

Written once: compiled where numba is installed, plain Python where not. The
driver knows a model only by the callbacks of :mod:`rockframe.dynamics.protocol`.
It can be left for want of room in the event table and entered again.
"""

import math
from collections.abc import Callable
from typing import Final, NamedTuple

from rockframe.compiled import Vector, entry, inlined, kernel
from rockframe.dynamics.protocol import (
    ACCELERATE,
    ENERGY,
    GUARD,
    LAST_EVENT,
    SWITCH,
)
from rockframe.solve import layout as at
from rockframe.solve.books import (
    FLIGHT,
    accept,
    audit,
    book_event,
    follow_peak,
    reach_limit,
    store_outputs,
)
from rockframe.solve.crossings import earliest_crossing
from rockframe.solve.dormand_prince import runge_kutta_step
from rockframe.solve.fixed_step import finite, fixed_step
from rockframe.solve.ground import TERMS, ground_acceleration, load_interval
from rockframe.solve.step_control import EASY, excess_error, next_step
from rockframe.solve.workspace import (
    EventTable,
    MotionTables,
    Output,
    Progress,
    Span,
    Tables,
    Workspace,
)

SHORTEST: Final = 1e-14
"""Shortest step, as a share of the run's duration."""
POLISHING: Final = 4
"""Corrections of an event's time on the Runge-Kutta solution itself."""
ROUNDING: Final = 1e-15
"""Share of the time so far below which such a correction is rounding."""
FIXED_STEPS: Final = 0.0
"""Stands for the tolerance of a run with fixed sub-steps."""
JUMP: Final = 1e-12
"""Share of the ground acceleration by which it must differ to have jumped at a sample."""


class Interval(NamedTuple):
    """Where an interval of the motion begins, and the degrees of its polynomials."""

    begin: float
    degree_x: int
    degree_y: int


@inlined
def jumps(now: float, before: float) -> bool:
    """Whether the ground acceleration jumped between two intervals."""
    return abs(now - before) > JUMP * abs(now)


@inlined
def fit_step(h: float, remaining: float) -> float:
    """Give a step that ends on the interval's end, or leaves a fair rest of it."""
    if h >= 0.999999 * remaining:
        return remaining
    return min(h, 0.5 * remaining)


@inlined
def suspicious(guards: int, w: Workspace) -> bool:
    """Whether some guard is negative at the step's end, or fell first and rose last."""
    for i in range(guards):
        if w.after[i] < 0.0:
            return True
        if w.before[guards + i] < 0.0 and w.after[guards + i] > 0.0:
            return True
    return False


@kernel
def broken_guard(tables: Tables, w: Workspace) -> int:
    """Give a guard that a mode breaks from its start, or -1."""
    guards = len(tables.tolerance)
    for i in range(guards):
        tolerance = tables.tolerance[i]
        falls = w.before[i] < -tolerance or w.before[guards + i] < 0.0
        if w.before[i] <= tolerance and falls:
            return i
    return -1


@inlined
def look_ahead(
    accelerate: Callable[..., None],
    guard: Callable[..., None],
    mode: int,
    u: float,
    interval: Interval,
    p: Vector,
    clock: Vector,
    w: Workspace,
) -> None:
    """Evaluate accelerations and guards anew, after a switch or a jump of the ground."""
    x = ground_acceleration(u, interval.degree_x, 0, w.ground)
    y = ground_acceleration(u, interval.degree_y, TERMS, w.ground)
    clock[at.GROUND_X] = x
    clock[at.GROUND_Y] = y
    accelerate(mode, w.state, x, y, p, w.slope)
    for i in range(len(w.slope)):
        w.slopes[0, i] = w.slope[i]
    guard(mode, w.state, w.slope, x, y, p, w.before)


@inlined
def stand_still(w: Workspace) -> None:
    """Make a step in a mode in which nothing moves."""
    for i in range(len(w.state)):
        w.new[i] = w.state[i]
    for i in range(len(w.slope)):
        w.slope[i] = w.slopes[0, i]
        w.slopes[6, i] = w.slopes[0, i]


class Step(NamedTuple):
    """A step made: where, its works, its error over that allowed, the guard that crossed."""

    span: Span
    burnt: float
    supplied: float
    excess: float
    crossed: int  # or -1
    ground_x: float  # at its end
    ground_y: float


@inlined
def make_step(
    accelerate: Callable[..., None],
    guard: Callable[..., None],
    tables: Tables,
    mode: int,
    interval: Interval,
    tau: float,
    whole: float,
    controls: Vector,
    energy_scale: float,
    p: Vector,
    w: Workspace,
) -> Step:
    """Make a step of length `whole`, and repeat it up to the first crossing of a guard."""
    guards = len(tables.tolerance)
    count = int(tables.active[mode])
    scale = controls[at.TIME_STEP]
    fixed = controls[at.RTOL] == FIXED_STEPS
    degree_x, degree_y = interval.degree_x, interval.degree_y
    h, crossed, attempt = whole, -1, 0
    burnt = supplied = excess = x = y = 0.0
    while True:
        span = Span(h, tau / scale, h / scale, degree_x, degree_y)
        if count == 0:
            stand_still(w)
        elif fixed:
            burnt, supplied = fixed_step(accelerate, mode, count, span, p, w)
            if not finite(count, w):
                excess = math.inf
                break
        else:
            burnt, supplied, imbalance = runge_kutta_step(accelerate, mode, count, span, p, w)
            if attempt == 0:
                excess = excess_error(count, imbalance, energy_scale, controls, w)
                if not excess <= 1.0:
                    break
        x = ground_acceleration(span.u + span.du, degree_x, 0, w.ground)
        y = ground_acceleration(span.u + span.du, degree_y, TERMS, w.ground)
        guard(mode, w.new, w.slope, x, y, p, w.after)
        if attempt == 0:
            if not suspicious(guards, w):
                break
            crossed, place = earliest_crossing(guard, tables, mode, count, span, p, w)
            if crossed < 0:
                break
            h = place * whole
        else:  # Newton's correction on the Runge-Kutta solution itself
            fall = w.after[guards + crossed]
            settled = abs(w.after[crossed]) <= tables.tolerance[crossed]
            if fall >= 0.0 or settled or attempt > POLISHING:
                break
            moved = min(max(h - w.after[crossed] / fall, 0.0), whole)
            if abs(moved - h) <= ROUNDING * (interval.begin + tau + h):
                break
            h = moved
        attempt += 1
    return Step(span, burnt, supplied, excess, crossed, x, y)


@kernel
def carry_out(
    crossed: int,
    time: float,
    mode: int,
    switch: Callable[..., int],
    tables: Tables,
    p: Vector,
    memory: Vector,
    progress: Progress,
    events: EventTable,
    w: Workspace,
) -> tuple[int, int]:
    """Carry out the switch that a crossed guard calls for; give the new mode and a status."""
    clock = progress.clock
    row = progress.counters[at.EVENTS]
    for i in range(len(w.state)):
        events.values[row, 1 + i] = w.state[i]
    new_mode = mode
    status = at.COMPLETED
    if crossed == len(tables.tolerance) - 1:
        kind, status = reach_limit(time, mode, tables, p, progress, w)
    else:
        x, y = clock[at.GROUND_X], clock[at.GROUND_Y]
        new_mode = switch(mode, crossed, w.state, x, y, p, memory)
        kind = int(memory[LAST_EVENT])
    chatter = book_event(time, kind, mode, new_mode, tables, memory, progress, events, w)
    return new_mode, max(status, chatter)


@entry(
    "integer",
    ACCELERATE,
    GUARD,
    SWITCH,
    ENERGY,
    Tables,
    "vector",
    "vector",
    MotionTables,
    Progress,
    Output,
    EventTable,
    Workspace,
)
def advance(
    accelerate: Callable[..., None],
    guard: Callable[..., None],
    switch: Callable[..., int],
    energy: Callable[..., None],
    tables: Tables,
    p: Vector,
    memory: Vector,
    motion: MotionTables,
    progress: Progress,
    output: Output,
    events: EventTable,
    w: Workspace,
) -> int:
    """Integrate until the run ends or the event table is full.

    Parameters
    ----------
    accelerate, guard, switch, energy : callback
        The model's functions.
    tables, p : Tables, ndarray
        The model's tables and parameters.
    memory : ndarray
        The model's memory; changed in place.
    motion : MotionTables
        Ground motion.
    progress : Progress
        Settings and progress; changed in place.
    output : Output
        Filled at the output times.
    events : EventTable
        Filled at the events.
    w : Workspace
        Working arrays; ``w.state`` is the state.

    Returns
    -------
    int
        A :class:`rockframe.solve.layout.Status`, or ``MORE_ROOM``.
    """
    controls, clock, counters = progress.controls, progress.clock, progress.counters
    duration, time_step = controls[at.DURATION], controls[at.TIME_STEP]
    intervals = max(len(motion.samples_x), len(motion.samples_y)) - 1
    shortest = SHORTEST * duration
    mode = counters[at.MODE]
    if math.isnan(clock[at.START_ENERGY]):
        energy(mode, w.state, p, w.energies)
        clock[at.START_ENERGY] = w.energies[0] + w.energies[1] + w.energies[3]
        audit(energy, mode, p, memory, clock, w)
    index = counters[at.INTERVAL]
    tau = clock[at.INTO_INTERVAL]
    h_next = clock[at.NEXT_STEP]
    crossed = counters[at.PENDING]
    fixed = controls[at.RTOL] == FIXED_STEPS
    stale = True  # accelerations and guards at the state, after a switch or a jump
    status = at.COMPLETED
    while True:
        begin = index * time_step
        length = duration - begin
        if index < intervals:
            length = min(time_step, length)
        interval = Interval(
            begin,
            load_interval(index, motion.samples_x, motion.pieces_x, 0, w.ground),
            load_interval(index, motion.samples_y, motion.pieces_y, TERMS, w.ground),
        )
        if jumps(w.ground[0], clock[at.GROUND_X]) or jumps(w.ground[TERMS], clock[at.GROUND_Y]):
            stale = True
        while True:
            if stale:
                look_ahead(accelerate, guard, mode, tau / time_step, interval, p, clock, w)
                stale = False
                if crossed < 0:
                    crossed = broken_guard(tables, w)
            if crossed >= 0:
                if counters[at.EVENTS] >= len(events.codes):
                    status = at.MORE_ROOM
                    break
                mode, status = carry_out(
                    crossed, begin + tau, mode, switch, tables, p, memory, progress, events, w
                )
                audit(energy, mode, p, memory, clock, w)
                crossed = -1
                stale = True
                if status != at.COMPLETED:
                    break
                continue
            remaining = length - tau
            if remaining <= shortest:
                break
            if counters[at.STEPS] + counters[at.REJECTED] >= counters[at.MAX_STEPS]:
                status = at.STEP_LIMIT
                break
            asked = fit_step(min(h_next, controls[at.MAX_STEP]), remaining)
            whole = min(asked, tables.longest[mode]) if fixed else asked
            energy_scale = max(clock[at.LARGEST_TERM], clock[at.BURNT], abs(clock[at.SUPPLIED]))
            step = make_step(
                accelerate, guard, tables, mode, interval, tau, whole, controls, energy_scale, p, w
            )
            if not step.excess <= 1.0:
                counters[at.REJECTED] += 1
                h_next = next_step(whole, whole, step.excess)
                if h_next <= shortest:
                    status = at.STEP_TOO_SMALL
                    break
                continue
            crossed = step.crossed
            if fixed:  # after an event or a shorter step, on to the end of the sub-step
                rest = asked - step.span.h
                h_next = rest if rest > shortest else controls[at.MAX_STEP]
            elif crossed < 0 and (step.excess > EASY or whole < time_step or whole >= h_next):
                h_next = next_step(whole, h_next, step.excess)
            h = step.span.h
            tau += h
            count = int(tables.active[mode])
            store_outputs(
                accelerate, begin + tau, step.span, mode, count, step.burnt, step.supplied, p,
                progress, output, w,
            )  # fmt: skip
            if h > 0.0:
                follow_peak(count, h, tables.weights, clock, w)
            if tables.contact[mode] == FLIGHT:
                clock[at.FLIGHT_TIME] += h
            accept(step.burnt, step.supplied, step.ground_x, step.ground_y, clock, counters, w)
        if status != at.COMPLETED or index >= intervals or begin + length >= duration:
            break
        index += 1
        tau = 0.0
    audit(energy, mode, p, memory, clock, w)
    clock[at.TIME] = index * time_step + tau
    clock[at.INTO_INTERVAL] = tau
    clock[at.NEXT_STEP] = h_next
    counters[at.MODE] = mode
    counters[at.INTERVAL] = index
    counters[at.PENDING] = crossed
    return status
