"""The loop over events of a run of any contact model, page "Numerics" of the manual.

`integrate` calls it; between events it calls the march, which makes steps. The driver knows a
scene only by its :class:`rockframe.solve.equations.BoundEquations`. It returns where a table is
full, and continues when it is called again with a larger one.
"""

import math
from typing import Final

from rockframe.compiled import Vector, background_entry, inlined, kernel, put
from rockframe.dynamics.events import FLIGHT
from rockframe.dynamics.protocol import LAST_EVENT, POWERS, Ground
from rockframe.solve import workspace as at
from rockframe.solve.bookkeeping import (
    SAMPLE_TOLERANCE,
    check_energy_balance,
    count_step,
    record_event,
    record_overturning,
    store_outputs,
    update_peaks,
)
from rockframe.solve.crossings import Crossing, earliest_crossing
from rockframe.solve.equations import BoundEquations, unpack_mode
from rockframe.solve.march import (
    AT_END,
    EXHAUSTED,
    GROUND_JUMPED,
    GUARD_MAY_FALL,
    PAUSED,
    SHORTEST_STEP,
    TOO_SMALL,
)
from rockframe.solve.schemes import adapted_step, remaining_step
from rockframe.solve.workspace import (
    MAX_TERMS,
    ROW_HEADER,
    EventTable,
    Output,
    Pieces,
    Progress,
    Span,
    StepTable,
    UnpackedMode,
    Work,
    Workspace,
    append_row,
    ground_in_step,
    is_full,
    load_interval,
    steps_made,
    with_ends_swapped,
)

NEWTON_CORRECTIONS: Final = 4
"""Corrections of an event's time, by repeated steps, after which one that is small is the last."""
MAX_CORRECTIONS: Final = 60
"""Most corrections of an event's time; bisection alone takes 50."""
SMALL_CORRECTION: Final = 1e-6
"""Share of the step below which a correction is small."""
TIME_ROUNDING: Final = 1e-15
"""Share of the time of the run below which such a correction is rounding."""
TIME_NOISE: Final = 8.0 * TIME_ROUNDING
"""Share of the time of the run that is the rounding error of an event's time."""


@inlined
def current_time(progress: Progress) -> float:
    """Return the present time of a run [s]."""
    start = progress.counters[at.INTERVAL] * progress.controls[at.TIME_STEP]
    return start + progress.clock[at.INTO_INTERVAL]


@kernel
def reevaluate(
    equations: BoundEquations, mode: int, tolerance: Vector, progress: Progress, w: Workspace
) -> int:
    """Evaluate accelerations and guards again, after an event or a jump of the ground.

    Returns a guard that is negative, or zero and falling, already at the start of the mode, or -1.
    A rising guard may be negative by its change within the rounding error of time.
    """
    clock, guards = progress.clock, len(tolerance)
    ground = ground_in_step(0.0, span_of(0.0, progress), w.ground)
    clock[at.GROUND_X], clock[at.GROUND_Y] = ground.x, ground.y
    equations.slope.call(mode, w.state, ground.x, ground.y, w.slope, equations.numbers)
    equations.guards.call(
        mode, w.state, w.slope, ground.x, ground.y, w.limits, w.guards, equations.numbers
    )
    for i in range(guards):
        rounding, rate = tolerance[i], w.guards[guards + i]
        noise = rounding + TIME_NOISE * current_time(progress) * abs(rate)
        if w.guards[i] < -noise or (w.guards[i] <= rounding and rate < 0.0):
            return i
    return -1


@inlined
def span_of(h: float, progress: Progress) -> Span:
    """Return a step of length h [s] from the present time of a run."""
    clock, counters, time_step = progress.clock, progress.counters, progress.controls[at.TIME_STEP]
    return Span(
        h, clock[at.INTO_INTERVAL] / time_step, h / time_step, counters[at.DEGREE_X],
        counters[at.DEGREE_Y],
    )  # fmt: skip


@kernel
def step_to_event(
    equations: BoundEquations, unpacked: UnpackedMode, whole: float, tolerance: Vector,
    pieces: Pieces, progress: Progress, steps: StepTable, w: Workspace,
) -> tuple[float, int]:  # fmt: skip
    """Repeat a step up to the first crossing of a guard; return its length and the guard, or -1.

    The crossing is found on the dense solution, then corrected by repeated steps. If another guard
    is negative at the end of the shortened step, its crossing is searched in that step.
    """
    crossing = earliest_crossing(equations, unpacked, span_of(whole, progress), tolerance, w)
    if crossing.guard < 0:
        return whole, -1
    h = correct_crossing(
        equations, unpacked, whole, crossing, tolerance, pieces, progress, steps, w
    )
    for _ in range(len(tolerance)):
        if h == 0.0 or not another_is_negative(crossing.guard, tolerance, w):
            break
        earlier = earliest_crossing(equations, unpacked, span_of(h, progress), tolerance, w)
        if earlier.guard in (-1, crossing.guard) or earlier.fraction > 1.0 - SMALL_CORRECTION:
            break
        crossing = earlier
        h = correct_crossing(
            equations, unpacked, h, crossing, tolerance, pieces, progress, steps, w
        )
    return h, crossing.guard


@kernel
def another_is_negative(crossed: int, tolerance: Vector, w: Workspace) -> bool:
    """Whether a guard other than `crossed` is negative at the end of a step."""
    for i in range(len(tolerance)):
        if i != crossed and w.guards[i] > tolerance[i] and w.new_guards[i] < -tolerance[i]:
            return True
    return False


@kernel
def correct_crossing(
    equations: BoundEquations, unpacked: UnpackedMode, whole: float, crossing: Crossing,
    tolerance: Vector, pieces: Pieces, progress: Progress, steps: StepTable, w: Workspace,
) -> float:  # fmt: skip
    """Repeat a step up to where a guard falls through zero; return its length [s].

    Newton's method on the end of the repeated step, kept by bisection between lengths at which the
    guard is positive and negative: in a step that is long compared with a damped vibration the
    dense solution is far from it. The bracket also keeps a guard that rises from zero and falls
    again from its first root, the start. Where the dense solution has a dip below zero that
    repeated steps do not have, the event is where the guard is smallest. The value of a guard that
    falls to zero and stays there, as friction does where nothing presses, does not show how far its
    root is: then the step is halved.
    """
    crossed, fraction, negative_fraction = crossing
    time = current_time(progress)
    h, rates = fraction * whole, equations.guard_count + 1
    noise, low, high = tolerance[crossed], 0.0, negative_fraction * whole
    above, below, last = w.guards[crossed], w.new_guards[crossed], 0.0  # values at low and high
    begins_positive = above > noise or w.guards[rates + crossed] > 0.0
    has_root = h > 0.0 and begins_positive
    if has_root and negative_fraction < 1.0:
        equations.make_steps(unpacked, high, pieces, progress, steps, w)
        below = w.new_guards[crossed]
        has_root = below < 0.0
    flat = has_root and below >= -noise
    for correction in range(1 + MAX_CORRECTIONS):
        if h > 0.0:
            equations.make_steps(unpacked, h, pieces, progress, steps, w)
        else:
            make_zero_step(w)
        guard, fall = w.new_guards[crossed], w.new_guards[rates + crossed]
        ends = fall >= 0.0 and not has_root
        if ends or (abs(guard) <= noise and not flat) or correction == MAX_CORRECTIONS:
            break
        if guard > (noise if flat else 0.0):
            low, above, below = h, guard, 0.5 * below if last > 0.0 else below
        else:
            high, above, below = h, 0.5 * above if last < 0.0 else above, guard
        last = guard
        trial = h - guard / fall if fall < 0.0 else low
        if fall == 0.0 and above > 0.0 > below:  # guards that are forces come without a rate
            trial = low + (high - low) * (above / (above - below))
        if has_root and (flat or not low < trial < high):
            trial = 0.5 * (low + high)
        trial = min(max(trial, 0.0), whole)
        change = abs(trial - h)
        close = (
            fall < 0.0 and correction >= NEWTON_CORRECTIONS and change <= SMALL_CORRECTION * whole
        )
        if change <= TIME_ROUNDING * (time + h) or close:
            break
        h = trial
    return h


@kernel
def make_zero_step(w: Workspace) -> None:
    """Make a step of length zero: copy its start to its end."""
    put(w.state, 0, w.new_state)
    put(w.slope, 0, w.new_slope)
    put(w.guards, 0, w.new_guards)
    w.works[0] = w.works[1] = 0.0


@kernel
def carry_out_event(
    equations: BoundEquations, crossed: int, time: float, unpacked: UnpackedMode, memory: Vector,
    progress: Progress, events: EventTable, w: Workspace,
) -> tuple[UnpackedMode, int]:  # fmt: skip
    """Carry out the event of a crossed guard; return the new mode and a status."""
    clock = progress.clock
    row = progress.counters[at.EVENTS]
    for i in range(len(w.state)):
        events.values[row, 1 + i] = w.state[i]
    after = unpacked
    status = at.COMPLETED
    if crossed == equations.guard_count:
        kind, status = record_overturning(time, equations.coordinate_count, progress, w)
    else:
        ground = Ground(clock[at.GROUND_X], clock[at.GROUND_Y])
        new_mode = equations.switch.call(
            unpacked.mode, crossed, w.state, ground.x, ground.y, memory, equations.numbers
        )
        after = unpack_mode(equations, new_mode, w.scratch)
        kind = int(memory[LAST_EVENT])
    chatter = record_event(time, kind, unpacked, after, memory, progress, events, w)
    return after, max(status, chatter)


@kernel
def append_start_row(mode: int, progress: Progress, steps: StepTable, w: Workspace) -> None:
    """Store a start in the table of steps, in place of the last row if that is an unused start."""
    clock, counters = progress.clock, progress.counters
    row, width, slopes = counters[at.STEPS_KEPT], len(w.state), len(w.slope) - POWERS
    if row > 0 and steps.values[(row - 1) * (ROW_HEADER + width + slopes) + 1] == 0.0:
        counters[at.STEPS_KEPT] = row - 1
    append_row(
        current_time(progress), 0.0, mode, Ground(clock[at.GROUND_X], clock[at.GROUND_Y]),
        width, slopes, w.state, w.slope, counters, steps.values, steps.codes,
    )  # fmt: skip


@kernel
def accept_step(
    equations: BoundEquations, unpacked: UnpackedMode, h: float, ends_at_event: bool,
    progress: Progress, output: Output, w: Workspace,
) -> None:  # fmt: skip
    """Take over a step of length h, or its part up to an event; plan the next one."""
    controls, clock, counters = progress.controls, progress.clock, progress.counters
    steps, fixed = output.steps, controls[at.RTOL] == at.FIXED_STEPS
    if fixed:
        shortest = SHORTEST_STEP * controls[at.DURATION]
        clock[at.NEXT_STEP] = remaining_step(clock[at.REQUESTED], h, shortest, controls)
    elif not ends_at_event:
        whole, planned = clock[at.STEP], clock[at.NEXT_STEP]
        clock[at.NEXT_STEP] = adapted_step(whole, planned, clock[at.ERROR_NORM], controls)
    span = span_of(h, progress)
    work, ground = Work(w.works[0], w.works[1]), ground_in_step(1.0, span, w.ground)
    clock[at.INTO_INTERVAL] += h
    store_outputs(equations, current_time(progress), span, unpacked, work, progress, output, w)
    if h > 0.0:
        update_peaks(equations, unpacked.moving, h, clock, w)
        if len(steps.codes) > 0:
            append_row(
                current_time(progress), h, unpacked.mode, ground, len(w.new_state),
                len(w.new_slope) - POWERS, w.new_state, w.new_slope, counters, steps.values,
                steps.codes,
            )  # fmt: skip
    if unpacked.contact == FLIGHT:
        clock[at.FLIGHT_TIME] += h
    count_step(fixed, work, ground, clock, counters, w)


@kernel
def run_to_pause(
    equations: BoundEquations,
    tolerance: Vector,
    memory: Vector,
    pieces: Pieces,
    progress: Progress,
    output: Output,
    events: EventTable,
    w: Workspace,
) -> int:
    """Integrate until the run ends or pauses, or a table is full."""
    controls, clock, counters = progress.controls, progress.clock, progress.counters
    unpacked = unpack_mode(equations, counters[at.MODE], w.scratch)
    if math.isnan(clock[at.START_ENERGY]):
        check_energy_balance(equations, unpacked.mode, memory, clock, w)
    caller, half = w, 0
    counters[at.HALF] = 0
    index = counters[at.INTERVAL]
    counters[at.DEGREE_X] = load_interval(index, pieces.x, 0, w.ground)
    counters[at.DEGREE_Y] = load_interval(index, pieces.y, MAX_TERMS, w.ground)
    crossed = counters[at.PENDING]
    stale = counters[at.STALE] == 1  # slope and guards are to be evaluated anew
    steps, restarted = output.steps, False
    status = at.COMPLETED
    while True:
        if is_full(steps.codes, counters):
            status = at.TABLE_FULL
            break
        if stale:
            negative_guard = reevaluate(equations, unpacked.mode, tolerance, progress, w)
            stale, restarted = False, True
            if crossed < 0:
                crossed = negative_guard
        if crossed >= 0:
            if counters[at.EVENTS] >= len(events.codes):
                status = at.TABLE_FULL
                break
            unpacked, status = carry_out_event(
                equations, crossed, current_time(progress), unpacked, memory, progress, events, w
            )
            check_energy_balance(equations, unpacked.mode, memory, clock, w)
            crossed = -1
            stale = True
            if status != at.COMPLETED:
                break
            continue
        if restarted and len(steps.codes) > 0:
            append_start_row(unpacked.mode, progress, steps, w)
        restarted = False
        row = counters[at.OUTPUTS]  # the next output
        more = row < len(output.mode)
        clock[at.NEXT_OUTPUT] = (
            (row - SAMPLE_TOLERANCE) * controls[at.OUTPUT_STEP] if more else math.inf
        )
        reason = equations.make_steps(unpacked, 0.0, pieces, progress, steps, w)
        if counters[at.HALF] != half:
            half = 1 - half
            w = with_ends_swapped(w)
        if reason == GROUND_JUMPED:
            stale = True
            continue
        if reason == PAUSED:
            status = at.PAUSED
            break
        if reason == EXHAUSTED:
            ended = steps_made(counters) >= counters[at.MAX_STEPS]
            status = at.STEP_LIMIT if ended else at.PAUSED
        elif reason == TOO_SMALL:
            status = at.STEP_TOO_SMALL
        if reason in (AT_END, EXHAUSTED, TOO_SMALL):
            break
        h = clock[at.STEP]
        if reason == GUARD_MAY_FALL:
            h, crossed = step_to_event(
                equations, unpacked, h, tolerance, pieces, progress, steps, w
            )
        accept_step(equations, unpacked, h, crossed >= 0, progress, output, w)
        half = 1 - half
        counters[at.HALF] = half
        w = with_ends_swapped(w)
    if status not in (at.PAUSED, at.TABLE_FULL):
        check_energy_balance(equations, unpacked.mode, memory, clock, w)
    if half == 1:  # copy to where the caller reads it
        put(w.state, 0, caller.state)
        put(w.slope, 0, caller.slope)
        put(w.guards, 0, caller.guards)
    counters[at.STALE] = int(stale)
    clock[at.TIME] = current_time(progress)
    counters[at.MODE] = unpacked.mode
    counters[at.PENDING] = crossed
    return status


advance = background_entry(run_to_pause)
"""Integrates one run: `run_to_pause` as machine code as soon as that has been compiled."""
