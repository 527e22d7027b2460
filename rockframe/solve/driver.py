"""The loop over events of a run of any contact model, page "Numerics" of the manual.

`integrate` calls it; between events it calls the march, which makes steps. The driver knows a
scene only by its :class:`rockframe.solve.equations.BoundEquations`. It returns where a table is
full, and continues when it is called again with a larger one.
"""

import math
from typing import Final

from rockframe.compiled import Vector, entry_at_once, inlined, kernel, put
from rockframe.dynamics.events import FLIGHT
from rockframe.dynamics.protocol import LAST_EVENT, POWERS, Ground
from rockframe.solve import workspace as at
from rockframe.solve.bookkeeping import (
    ON_SAMPLE,
    accept,
    audit,
    follow_peak,
    reach_limit,
    record_event,
    store_outputs,
)
from rockframe.solve.crossings import Crossing, earliest_crossing
from rockframe.solve.equations import BoundEquations, known_mode
from rockframe.solve.march import (
    AT_END,
    EXHAUSTED,
    GUARDED,
    JUMPED,
    PAUSED,
    SHORTEST,
    TOO_SMALL,
)
from rockframe.solve.schemes import adapted, rest_of
from rockframe.solve.workspace import (
    BESIDE,
    TERMS,
    EventTable,
    KnownMode,
    Output,
    Pieces,
    Progress,
    Span,
    StepTable,
    Work,
    Workspace,
    ground_in,
    has_no_room,
    keep_row,
    load_interval,
    swapped,
)

POLISHING: Final = 4
"""Corrections of an event's time, by repeated steps, after which one that is small is the last."""
MOST_POLISHING: Final = 60
"""Most corrections of an event's time; bisection alone takes 50."""
SMALL: Final = 1e-6
"""Share of the step below which a correction is small."""
ROUNDING: Final = 1e-15
"""Share of the time of the run below which such a correction is rounding."""
TIME_NOISE: Final = 8.0 * ROUNDING
"""Share of the time of the run that is the rounding error of an event's time."""


@inlined
def time_of(progress: Progress) -> float:
    """Return the present time of a run [s]."""
    began = progress.counters[at.INTERVAL] * progress.controls[at.TIME_STEP]
    return began + progress.clock[at.INTO_INTERVAL]


@kernel
def evaluate_anew(
    equations: BoundEquations, mode: int, tolerance: Vector, progress: Progress, w: Workspace
) -> int:
    """Evaluate accelerations and guards again, after an event or a jump of the ground.

    Returns a guard that is negative, or zero and falling, already at the start of the mode, or -1.
    A rising guard may be negative by its change within the rounding error of time.
    """
    clock, guards = progress.clock, len(tolerance)
    ground = ground_in(0.0, span_of(0.0, progress), w.ground)
    clock[at.GROUND_X], clock[at.GROUND_Y] = ground.x, ground.y
    equations.slope.call(mode, w.state, ground.x, ground.y, w.first, equations.numbers)
    equations.guarding.call(
        mode, w.state, w.first, ground.x, ground.y, w.limits, w.before, equations.numbers
    )
    for i in range(guards):
        rounding, rate = tolerance[i], w.before[guards + i]
        noise = rounding + TIME_NOISE * time_of(progress) * abs(rate)
        if w.before[i] < -noise or (w.before[i] <= rounding and rate < 0.0):
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
    equations: BoundEquations, known: KnownMode, whole: float, tolerance: Vector, pieces: Pieces,
    progress: Progress, steps: StepTable, w: Workspace,
) -> tuple[float, int]:  # fmt: skip
    """Repeat a step up to the first crossing of a guard; return its length and the guard, or -1.

    The crossing is found on the dense solution, then corrected by repeated steps. If another guard
    is negative at the end of the shortened step, its crossing is searched in that step.
    """
    found = earliest_crossing(equations, known, span_of(whole, progress), tolerance, w)
    if found.guard < 0:
        return whole, -1
    h = correct_crossing(equations, known, whole, found, tolerance, pieces, progress, steps, w)
    for _ in range(len(tolerance)):
        if h == 0.0 or not another_has_fallen(found.guard, tolerance, w):
            break
        earlier = earliest_crossing(equations, known, span_of(h, progress), tolerance, w)
        if earlier.guard in (-1, found.guard) or earlier.place > 1.0 - SMALL:
            break
        found = earlier
        h = correct_crossing(equations, known, h, found, tolerance, pieces, progress, steps, w)
    return h, found.guard


@kernel
def another_has_fallen(crossed: int, tolerance: Vector, w: Workspace) -> bool:
    """Whether a guard other than `crossed` is negative at the end of a step."""
    for i in range(len(tolerance)):
        if i != crossed and w.before[i] > tolerance[i] and w.after[i] < -tolerance[i]:
            return True
    return False


@kernel
def correct_crossing(
    equations: BoundEquations, known: KnownMode, whole: float, crossing: Crossing,
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
    crossed, place, negative = crossing
    now = time_of(progress)
    h, rates = place * whole, equations.guard_count + 1
    noise, low, high = tolerance[crossed], 0.0, negative * whole
    above, below, last = w.before[crossed], w.after[crossed], 0.0  # values at low and high
    begins_positive = above > noise or w.before[rates + crossed] > 0.0
    has_root = h > 0.0 and begins_positive
    if has_root and negative < 1.0:
        equations.make_steps(known, high, pieces, progress, steps, w)
        below = w.after[crossed]
        has_root = below < 0.0
    stays = has_root and below >= -noise
    for correction in range(1 + MOST_POLISHING):
        if h > 0.0:
            equations.make_steps(known, h, pieces, progress, steps, w)
        else:
            stand_still(w)
        guard, fall = w.after[crossed], w.after[rates + crossed]
        ends = fall >= 0.0 and not has_root
        if ends or (abs(guard) <= noise and not stays) or correction == MOST_POLISHING:
            break
        if guard > (noise if stays else 0.0):
            low, above, below = h, guard, 0.5 * below if last > 0.0 else below
        else:
            high, above, below = h, 0.5 * above if last < 0.0 else above, guard
        last = guard
        moved = h - guard / fall if fall < 0.0 else low
        if fall == 0.0 and above > 0.0 > below:  # guards that are forces come without a rate
            moved = low + (high - low) * (above / (above - below))
        if has_root and (stays or not low < moved < high):
            moved = 0.5 * (low + high)
        moved = min(max(moved, 0.0), whole)
        change = abs(moved - h)
        close = fall < 0.0 and correction >= POLISHING and change <= SMALL * whole
        if change <= ROUNDING * (now + h) or close:
            break
        h = moved
    return h


@kernel
def stand_still(w: Workspace) -> None:
    """Make a step of length zero: copy its start to its end."""
    put(w.state, 0, w.new)
    put(w.first, 0, w.last)
    put(w.before, 0, w.after)
    w.works[0] = w.works[1] = 0.0


@kernel
def carry_out(
    equations: BoundEquations, crossed: int, time: float, known: KnownMode, memory: Vector,
    progress: Progress, events: EventTable, w: Workspace,
) -> tuple[KnownMode, int]:  # fmt: skip
    """Carry out the event of a crossed guard; return the new mode and a status."""
    clock = progress.clock
    row = progress.counters[at.EVENTS]
    for i in range(len(w.state)):
        events.values[row, 1 + i] = w.state[i]
    after = known
    status = at.COMPLETED
    if crossed == equations.guard_count:
        kind, status = reach_limit(time, equations.coordinate_count, progress, w)
    else:
        ground = Ground(clock[at.GROUND_X], clock[at.GROUND_Y])
        new_mode = equations.switching.call(
            known.mode, crossed, w.state, ground.x, ground.y, memory, equations.numbers
        )
        after = known_mode(equations, new_mode, w.answers)
        kind = int(memory[LAST_EVENT])
    chatter = record_event(time, kind, known, after, memory, progress, events, w)
    return after, max(status, chatter)


@kernel
def keep_start(mode: int, progress: Progress, steps: StepTable, w: Workspace) -> None:
    """Store a start in the table of steps, in place of the last row if that is an unused start."""
    clock, counters = progress.clock, progress.counters
    row, width, slopes = counters[at.STEPS_KEPT], len(w.state), len(w.first) - POWERS
    if row > 0 and steps.values[(row - 1) * (BESIDE + width + slopes) + 1] == 0.0:
        counters[at.STEPS_KEPT] = row - 1
    keep_row(
        time_of(progress), 0.0, mode, Ground(clock[at.GROUND_X], clock[at.GROUND_Y]),
        width, slopes, w.state, w.first, counters, steps.values, steps.codes,
    )  # fmt: skip


@kernel
def take_step(
    equations: BoundEquations, known: KnownMode, h: float, ends_at_event: bool,
    progress: Progress, output: Output, w: Workspace,
) -> None:  # fmt: skip
    """Take over a step of length h, or its part up to an event; plan the next one."""
    controls, clock, counters = progress.controls, progress.clock, progress.counters
    steps, fixed = output.steps, controls[at.RTOL] == at.FIXED_STEPS
    if fixed:
        shortest = SHORTEST * controls[at.DURATION]
        clock[at.NEXT_STEP] = rest_of(clock[at.ASKED], h, shortest, controls)
    elif not ends_at_event:
        whole, planned = clock[at.STEP], clock[at.NEXT_STEP]
        clock[at.NEXT_STEP] = adapted(whole, planned, clock[at.EXCESS], controls)
    span = span_of(h, progress)
    work, ground = Work(w.works[0], w.works[1]), ground_in(1.0, span, w.ground)
    clock[at.INTO_INTERVAL] += h
    store_outputs(equations, time_of(progress), span, known, work, progress, output, w)
    if h > 0.0:
        follow_peak(equations, known.moving, h, clock, w)
        if len(steps.codes) > 0:
            keep_row(
                time_of(progress), h, known.mode, ground, len(w.new), len(w.last) - POWERS,
                w.new, w.last, counters, steps.values, steps.codes,
            )  # fmt: skip
    if known.contact == FLIGHT:
        clock[at.FLIGHT_TIME] += h
    accept(fixed, work, ground, clock, counters, w)


@kernel
def run_on(
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
    known = known_mode(equations, counters[at.MODE], w.answers)
    if math.isnan(clock[at.START_ENERGY]):
        audit(equations, known.mode, memory, clock, w)
    home, half = w, 0
    counters[at.HALF] = 0
    index = counters[at.INTERVAL]
    counters[at.DEGREE_X] = load_interval(index, pieces.x, 0, w.ground)
    counters[at.DEGREE_Y] = load_interval(index, pieces.y, TERMS, w.ground)
    crossed = counters[at.PENDING]
    stale = counters[at.STALE] == 1  # slope and guards are to be evaluated anew
    steps, anew = output.steps, False
    status = at.COMPLETED
    while True:
        if has_no_room(steps.codes, counters):
            status = at.MORE_ROOM
            break
        if stale:
            broken = evaluate_anew(equations, known.mode, tolerance, progress, w)
            stale, anew = False, True
            if crossed < 0:
                crossed = broken
        if crossed >= 0:
            if counters[at.EVENTS] >= len(events.codes):
                status = at.MORE_ROOM
                break
            known, status = carry_out(
                equations, crossed, time_of(progress), known, memory, progress, events, w
            )
            audit(equations, known.mode, memory, clock, w)
            crossed = -1
            stale = True
            if status != at.COMPLETED:
                break
            continue
        if anew and len(steps.codes) > 0:
            keep_start(known.mode, progress, steps, w)
        anew = False
        row = counters[at.OUTPUTS]  # the next output
        more = row < len(output.mode)
        clock[at.NEXT_OUTPUT] = (row - ON_SAMPLE) * controls[at.OUTPUT_STEP] if more else math.inf
        happened = equations.make_steps(known, 0.0, pieces, progress, steps, w)
        if counters[at.HALF] != half:
            half = 1 - half
            w = swapped(w)
        if happened == JUMPED:
            stale = True
            continue
        if happened == PAUSED:
            status = at.PAUSED
            break
        if happened == EXHAUSTED:
            tried = counters[at.STEPS] + counters[at.REJECTED]
            status = at.STEP_LIMIT if tried >= counters[at.MAX_STEPS] else at.PAUSED
        elif happened == TOO_SMALL:
            status = at.STEP_TOO_SMALL
        if happened in (AT_END, EXHAUSTED, TOO_SMALL):
            break
        h = clock[at.STEP]
        if happened == GUARDED:
            h, crossed = step_to_event(equations, known, h, tolerance, pieces, progress, steps, w)
        take_step(equations, known, h, crossed >= 0, progress, output, w)
        half = 1 - half
        counters[at.HALF] = half
        w = swapped(w)
    if status not in (at.PAUSED, at.MORE_ROOM):
        audit(equations, known.mode, memory, clock, w)
    if half == 1:  # copy to where the caller reads it
        put(w.state, 0, home.state)
        put(w.first, 0, home.first)
        put(w.before, 0, home.before)
    counters[at.STALE] = int(stale)
    clock[at.TIME] = time_of(progress)
    counters[at.MODE] = known.mode
    counters[at.PENDING] = crossed
    return status


advance = entry_at_once(run_on)
"""Integrates one run: `run_on` as machine code as soon as that has been compiled."""
