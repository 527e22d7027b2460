"""What a run records as it proceeds: output samples, peaks, events, the energy balance."""

import math
import sys
from typing import Final

import numpy as np

from rockframe.compiled import Integers, Vector, inlined, kernel, table
from rockframe.dynamics.events import FLIGHT, FULL, IMPACT, OVERTURNING, REST, TOPPLED
from rockframe.dynamics.protocol import (
    IMPACT_LOSS,
    IMPULSIVE_INPUT,
    LINK_LOSS,
    REPINNING_LOSS,
    Energies,
    Ground,
)
from rockframe.solve import workspace as at
from rockframe.solve.crossings import interpolate, quintic_extremum
from rockframe.solve.equations import BoundEquations
from rockframe.solve.march import rotation_in_step
from rockframe.solve.workspace import (
    LEFT_LIMIT,
    RIGHT_LIMIT,
    WEIGHTS,
    EventTable,
    Output,
    Progress,
    Span,
    UnpackedMode,
    Work,
    Workspace,
    ground_in_step,
)

ROUNDING: Final = 4.0 * sys.float_info.epsilon
"""Relative rounding error of a term of the energy balance, and of times."""
RIGHT_ANGLE: Final = 0.5 * math.pi
SAMPLE_TOLERANCE: Final = 1e-9
"""Share of the output step within which the end of a step counts as an output time."""


# Gauss-Legendre rule on (0, 1), exact for polynomials of the ninth degree
_POINTS, _WEIGHTS = np.polynomial.legendre.leggauss(5)
GAUSS_POINTS: Final = table(0.5 + 0.5 * _POINTS)
GAUSS_WEIGHTS: Final = table(0.5 * _WEIGHTS)


@kernel
def check_energy_balance(
    equations: BoundEquations, mode: int, memory: Vector, clock: Vector, w: Workspace
) -> None:
    """Check the balance of the energies since the start of the run, :eq:`eq-audit`.

    The imbalance is related to the largest energy of the motion: gravity and elastic energy enter
    as differences from their values at rest, which would hide the errors of a quiet run.
    """
    equations.energies.call(mode, w.state, w.scratch, equations.numbers)
    energies = Energies(w.scratch[0], w.scratch[1], w.scratch[2], w.scratch[3])
    stored = energies.gravity + energies.from_rest
    if math.isnan(clock[at.START_ENERGY]):
        clock[at.START_ENERGY] = energies.kinetic + energies.gravity + energies.from_rest
    lost = clock[at.DISSIPATED] + memory[IMPACT_LOSS] + memory[REPINNING_LOSS] + memory[LINK_LOSS]
    supplied = clock[at.SUPPLIED] + memory[IMPULSIVE_INPUT]
    balance = energies.kinetic + stored + lost - supplied - clock[at.START_ENERGY]
    energy = max(energies.kinetic, abs(stored), lost, abs(supplied))
    clock[at.LARGEST_ENERGY] = max(clock[at.LARGEST_ENERGY], energy)
    terms = max(energy, abs(energies.gravity), energies.elastic)
    clock[at.LARGEST_TERM] = max(clock[at.LARGEST_TERM], terms)
    # all terms are rounded, the energies at rest too
    imbalance = abs(balance) - ROUNDING * clock[at.LARGEST_TERM]
    if math.isnan(imbalance):  # the energies of a law of a user's own
        imbalance = math.inf
    clock[at.RESIDUAL] = max(clock[at.RESIDUAL], imbalance)


@kernel
def work_between(
    equations: BoundEquations,
    start: float,
    end: float,
    unpacked: UnpackedMode,
    span: Span,
    w: Workspace,
) -> Work:
    """Integrate the powers of dashpots and ground over a part of a step, by Gauss's rule."""
    powers = equations.coordinate_count + equations.variable_count
    dissipated = supplied = 0.0
    for i in range(len(GAUSS_POINTS)):
        fraction = start + GAUSS_POINTS[i] * (end - start)
        interpolate(equations, unpacked.moving, fraction, span.h, w)
        ground = ground_in_step(fraction, span, w.ground)
        equations.slope.call(
            unpacked.mode, w.inner_state, ground.x, ground.y, w.inner_powers, equations.numbers
        )
        weight = GAUSS_WEIGHTS[i] * (end - start) * span.h
        dissipated += weight * w.inner_powers[powers]
        supplied += weight * w.inner_powers[powers + 1]
    return Work(dissipated, supplied)


@kernel
def work_until(
    equations: BoundEquations, fraction: float, work: Work, unpacked: UnpackedMode, span: Span,
    w: Workspace,
) -> Work:  # fmt: skip
    """Return the work up to a fraction of a step, so that all of the step has the given work.

    Within the step it grows by the powers of the dense solution.
    """
    if fraction >= 1.0:
        return work
    first = work_between(equations, 0.0, fraction, unpacked, span, w)
    second = work_between(equations, fraction, 1.0, unpacked, span, w)
    # dissipated energy only grows: it is scaled, not shifted, to the work of the step
    both = first.dissipated + second.dissipated
    share = first.dissipated / both if both > 0.0 else fraction
    deficit = work.supplied - first.supplied - second.supplied
    return Work(share * work.dissipated, first.supplied + fraction * deficit)


@inlined
def store_outputs(
    equations: BoundEquations, end: float, span: Span, unpacked: UnpackedMode, work: Work,
    progress: Progress, output: Output, w: Workspace,
) -> None:  # fmt: skip
    """Store the output samples that lie in the step that ends at `end`."""
    clock = progress.clock
    step = progress.controls[at.OUTPUT_STEP]
    row = progress.counters[at.OUTPUTS]
    while row < len(output.mode) and row * step - end <= SAMPLE_TOLERANCE * step:
        offset = row * step - end
        fraction = 1.0
        if offset < -SAMPLE_TOLERANCE * step and span.h + offset > 0.0:
            fraction = 1.0 + offset / span.h
        if len(output.work) > 0:
            so_far = work_until(equations, fraction, work, unpacked, span, w)
            output.work[row, 0] = clock[at.DISSIPATED] + so_far.dissipated
            output.work[row, 1] = clock[at.SUPPLIED] + so_far.supplied
        if fraction < 1.0:
            interpolate(equations, unpacked.moving, fraction, span.h, w)
            for i in range(len(w.inner_state)):
                output.state[row, i] = w.inner_state[i]
        else:
            for i in range(len(w.new_state)):
                output.state[row, i] = w.new_state[i]
        output.mode[row] = unpacked.mode
        row += 1
    progress.counters[at.OUTPUTS] = row


@inlined
def update_peaks(
    equations: BoundEquations, count: int, h: float, clock: Vector, w: Workspace
) -> None:
    """Update peaks of the rotation, with extrema inside the step, and ratios of other bodies."""
    size = equations.coordinate_count
    clock[at.PEAK_LEFT], clock[at.PEAK_RIGHT] = peaks_in_step(
        0, size, count, h, clock[at.PEAK_LEFT], clock[at.PEAK_RIGHT], w
    )
    for row in range(WEIGHTS + size, len(w.limits), WEIGHTS + size):
        left, right = w.limits[row + LEFT_LIMIT], w.limits[row + RIGHT_LIMIT]
        ratio = clock[at.OTHER_ROTATION_RATIO]
        known = ratio * left, ratio * right
        peaks = peaks_in_step(row, size, count, h, known[0], known[1], w)
        if peaks != known:  # a product and its quotient may be greater than the ratio was
            ratio = max(ratio, peaks[0] / left, peaks[1] / right)
        clock[at.OTHER_ROTATION_RATIO] = ratio


@inlined
def peaks_in_step(
    row: int, size: int, count: int, h: float, left: float, right: float, w: Workspace
) -> tuple[float, float]:
    """Return peaks to both sides after a step, absolute, of the rotation with limits at `row`."""
    rotation = rotation_in_step(row, size, w.limits, w.state, w.new_state)
    peaks = rotation.may_peak(h, left, right)
    left, right = max(left, rotation.left), max(right, rotation.right)
    if peaks:
        a0 = a1 = 0.0
        for i in range(count):
            a0 += w.limits[row + WEIGHTS + i] * w.slope[i]
            a1 += w.limits[row + WEIGHTS + i] * w.new_slope[i]
        extremum = quintic_extremum(
            rotation.start, h * rotation.start_rate, h * h * a0,
            rotation.end, h * rotation.end_rate, h * h * a1,
        )  # fmt: skip
        left, right = max(left, -extremum), max(right, extremum)
    return left, right


@kernel
def record_overturning(time: float, size: int, progress: Progress, w: Workspace) -> tuple[int, int]:
    """Record overturning, or the end of the fall after it; return kind of event and status."""
    clock = progress.clock
    if not math.isnan(clock[at.OVERTURNING_TIME]):
        return TOPPLED, at.TOPPLED
    rotation = 0.0
    for i in range(size):
        rotation += w.limits[WEIGHTS + i] * w.state[i]
    clock[at.OVERTURNING_TIME] = time
    clock[at.OVERTURNING_SIDE] = math.copysign(1.0, rotation)
    for row in range(0, len(w.limits), WEIGHTS + size):
        w.limits[row + LEFT_LIMIT] = w.limits[row + RIGHT_LIMIT] = RIGHT_ANGLE
    if progress.counters[at.STOP_AT_OVERTURNING] == 1:
        return OVERTURNING, at.OVERTURNED
    return OVERTURNING, at.COMPLETED


@kernel
def record_event(
    time: float,
    kind: int,
    before: UnpackedMode,
    after: UnpackedMode,
    memory: Vector,
    progress: Progress,
    events: EventTable,
    w: Workspace,
) -> int:
    """Count an event and fill its row of the table, which has the state before it already.

    Returns `CHATTER` if events repeat themselves or follow one another too closely.
    """
    clock, counters = progress.clock, progress.counters
    row = counters[at.EVENTS]
    width = len(w.state)
    events.values[row, 0] = time
    for i in range(width):
        events.values[row, 1 + width + i] = w.state[i]
    for i in range(len(memory)):
        events.values[row, 1 + 2 * width + i] = memory[i]
    events.codes[row, 0] = kind
    events.codes[row, 1] = before.mode
    events.codes[row, 2] = after.mode
    counters[at.EVENTS] += 1
    if kind in (IMPACT, REST):  # a block comes to rest by an impact
        counters[at.IMPACTS] += 1
    if after.contact == FLIGHT and before.contact != FLIGHT:
        counters[at.FLIGHTS] += 1
    if after.contact != FULL and math.isnan(clock[at.FIRST_UPLIFT]):
        clock[at.FIRST_UPLIFT] = time
    repeats = row > 0 and before.mode == after.mode  # it would repeat endlessly
    for i in range(events.codes.shape[1] if repeats else 0):
        repeats &= events.codes[row, i] == events.codes[row - 1, i]
    for i in range(events.values.shape[1] if repeats else 0):
        repeats &= events.values[row, i] == events.values[row - 1, i]
    close = time - clock[at.EVENT_TIME] <= progress.controls[at.CHATTER_TIME]
    counters[at.CLOSE_EVENTS] = counters[at.CLOSE_EVENTS] + 1 if close else 0
    clock[at.EVENT_TIME] = time
    if repeats or counters[at.CLOSE_EVENTS] > at.CLOSE_EVENTS_LIMIT:
        return at.CHATTER
    return at.COMPLETED


@inlined
def count_step(
    fixed: bool, work: Work, ground: Ground, clock: Vector, counters: Integers, w: Workspace
) -> None:
    """Add an accepted step to the progress of the run."""
    if not fixed:
        for i in range(len(w.state)):
            w.reference[i] = max(w.reference[i], abs(w.new_state[i]))
    clock[at.DISSIPATED] += work.dissipated
    clock[at.SUPPLIED] += work.supplied
    clock[at.LARGEST_ENERGY] = max(clock[at.LARGEST_ENERGY], abs(clock[at.SUPPLIED]))
    clock[at.GROUND_X] = ground.x
    clock[at.GROUND_Y] = ground.y
    counters[at.STEPS] += 1
