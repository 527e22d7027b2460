"""Keeping a run's books: outputs, peaks, events, energies."""

import math
from collections.abc import Callable
from typing import Final

import numpy as np

from rockframe.compiled import Integers, Vector, inlined, kernel
from rockframe.dynamics.protocol import (
    IMPACT,
    IMPACT_LOSS,
    IMPULSIVE_INPUT,
    OVERTURNING,
    REPINNING_LOSS,
    REST,
    ROTATION_LIMIT,
    ROUNDING,
    TOPPLED,
    ContactState,
)
from rockframe.solve import layout as at
from rockframe.solve.ground import TERMS, ground_acceleration
from rockframe.solve.hermite import extremum, interpolate
from rockframe.solve.workspace import EventTable, Output, Progress, Span, Tables, Workspace

FULL: Final = int(ContactState.FULL)
FLIGHT: Final = int(ContactState.FLIGHT)
RIGHT_ANGLE: Final = 0.5 * math.pi
ON_SAMPLE: Final = 1e-9
"""Share of the output step within which a step's end is an output time."""


# Gauss-Legendre rule on (0, 1), exact for polynomials of the ninth degree
_POINTS, _WEIGHTS = np.polynomial.legendre.leggauss(5)
GAUSS_POINTS: Final = tuple(float(0.5 + 0.5 * x) for x in _POINTS)
GAUSS_WEIGHTS: Final = tuple(float(0.5 * x) for x in _WEIGHTS)


@kernel
def audit(
    energy: Callable[..., None],
    mode: int,
    p: Vector,
    memory: Vector,
    clock: Vector,
    w: Workspace,
) -> None:
    """Compare the energy now with its start and all that came and went, :eq:`eq-audit`.

    The largest term is that of what moves: the elastic energy at rest, and the gravity energy
    that it takes over, say nothing of a quiet run.
    """
    energy(mode, w.state, p, w.energies)
    stored = w.energies[1] + w.energies[3]
    lost = clock[at.BURNT] + memory[IMPACT_LOSS] + memory[REPINNING_LOSS]
    supplied = clock[at.SUPPLIED] + memory[IMPULSIVE_INPUT]
    balance = w.energies[0] + stored + lost - supplied - clock[at.START_ENERGY]
    moved = max(w.energies[0], abs(stored), lost, abs(supplied))
    clock[at.LARGEST_MOVED] = max(clock[at.LARGEST_MOVED], moved)
    terms = max(moved, abs(w.energies[1]), w.energies[2])
    clock[at.LARGEST_TERM] = max(clock[at.LARGEST_TERM], terms)
    # the terms themselves are rounded, those at rest among them
    imbalance = abs(balance) - ROUNDING * clock[at.LARGEST_TERM]
    clock[at.RESIDUAL] = max(clock[at.RESIDUAL], imbalance)


@kernel
def work_between(
    accelerate: Callable[..., None],
    start: float,
    end: float,
    mode: int,
    count: int,
    span: Span,
    p: Vector,
    w: Workspace,
) -> tuple[float, float]:
    """Integrate the dashpots' and the ground's power over a part of a step, by Gauss' rule."""
    size = len(w.state) // 2
    burnt = supplied = 0.0
    for i in range(len(GAUSS_POINTS)):
        fraction = start + GAUSS_POINTS[i] * (end - start)
        interpolate(count, fraction, span.h, w)
        u = span.u + fraction * span.du
        x = ground_acceleration(u, span.degree_x, 0, w.ground)
        y = ground_acceleration(u, span.degree_y, TERMS, w.ground)
        accelerate(mode, w.scratch, x, y, p, w.powers)
        weight = GAUSS_WEIGHTS[i] * (end - start) * span.h
        burnt += weight * w.powers[size]
        supplied += weight * w.powers[size + 1]
    return burnt, supplied


@kernel
def work_until(
    accelerate: Callable[..., None],
    fraction: float,
    burnt: float,
    supplied: float,
    mode: int,
    count: int,
    span: Span,
    p: Vector,
    w: Workspace,
) -> tuple[float, float]:
    """Share the work of a step out to a fraction of it, by the powers of the dense solution."""
    if fraction >= 1.0:
        return burnt, supplied
    b0, s0 = work_between(accelerate, 0.0, fraction, mode, count, span, p, w)
    b1, s1 = work_between(accelerate, fraction, 1.0, mode, count, span, p, w)
    # what is burnt never comes back: scaled, not shifted, to the work of the step
    share = b0 / (b0 + b1) if b0 + b1 > 0.0 else fraction
    return share * burnt, s0 + fraction * (supplied - s0 - s1)


@inlined
def store_outputs(
    accelerate: Callable[..., None],
    end: float,
    span: Span,
    mode: int,
    count: int,
    burnt: float,
    supplied: float,
    p: Vector,
    progress: Progress,
    output: Output,
    w: Workspace,
) -> None:
    """Store the output samples that lie in the step that ends at `end`."""
    clock = progress.clock
    step = progress.controls[at.OUTPUT_STEP]
    row = progress.counters[at.OUTPUTS]
    while row < len(output.mode) and row * step - end <= ON_SAMPLE * step:
        ahead = row * step - end
        fraction = 1.0
        if ahead < -ON_SAMPLE * step and span.h + ahead > 0.0:
            fraction = 1.0 + ahead / span.h
        if len(output.work) > 0:
            burnt_so_far, supplied_so_far = work_until(
                accelerate, fraction, burnt, supplied, mode, count, span, p, w
            )
            output.work[row, 0] = clock[at.BURNT] + burnt_so_far
            output.work[row, 1] = clock[at.SUPPLIED] + supplied_so_far
        if fraction < 1.0:
            interpolate(count, fraction, span.h, w)
            for i in range(len(w.scratch)):
                output.state[row, i] = w.scratch[i]
        else:
            for i in range(len(w.new)):
                output.state[row, i] = w.new[i]
        output.mode[row] = mode
        row += 1
    progress.counters[at.OUTPUTS] = row


@inlined
def follow_peak(count: int, h: float, weights: Vector, clock: Vector, w: Workspace) -> None:
    """Raise the peak of the rotation by what the step holds, between its ends too."""
    size = len(w.state) // 2
    r0 = v0 = r1 = v1 = 0.0
    for i in range(count):
        r0 += weights[i] * w.state[i]
        v0 += weights[i] * w.state[size + i]
        r1 += weights[i] * w.new[i]
        v1 += weights[i] * w.new[size + i]
    top = max(abs(r0), abs(r1))
    clock[at.PEAK] = max(clock[at.PEAK], top)
    if v0 * v1 < 0.0 and top + 0.5 * h * max(abs(v0), abs(v1)) > clock[at.PEAK]:
        a0 = a1 = 0.0
        for i in range(count):
            a0 += weights[i] * w.slopes[0, i]
            a1 += weights[i] * w.slopes[6, i]
        top = abs(extremum(r0, h * v0, h * h * a0, r1, h * v1, h * h * a1))
        clock[at.PEAK] = max(clock[at.PEAK], top)


@kernel
def reach_limit(
    time: float, mode: int, tables: Tables, p: Vector, progress: Progress, w: Workspace
) -> tuple[int, int]:
    """Mark overturning, or the fall that ends a run; give the event's kind and a status."""
    clock = progress.clock
    if clock[at.OVERTURNING_TIME] >= 0.0:
        return TOPPLED, at.FELL
    turned = 0.0
    for i in range(tables.active[mode]):
        turned += tables.weights[i] * w.state[i]
    clock[at.OVERTURNING_TIME] = time
    clock[at.OVERTURNING_SIDE] = math.copysign(1.0, turned)
    p[ROTATION_LIMIT] = RIGHT_ANGLE
    if progress.counters[at.STOP_AT_OVERTURNING] == 1:
        return OVERTURNING, at.OVERTURNED
    return OVERTURNING, at.COMPLETED


@kernel
def book_event(
    time: float,
    kind: int,
    old_mode: int,
    mode: int,
    tables: Tables,
    memory: Vector,
    progress: Progress,
    events: EventTable,
    w: Workspace,
) -> int:
    """Count an event and fill its row of the table, whose state before stands there already."""
    clock, counters = progress.clock, progress.counters
    row = counters[at.EVENTS]
    width = len(w.state)
    events.values[row, 0] = time
    for i in range(width):
        events.values[row, 1 + width + i] = w.state[i]
    for i in range(len(memory)):
        events.values[row, 1 + 2 * width + i] = memory[i]
    events.codes[row, 0] = kind
    events.codes[row, 1] = old_mode
    events.codes[row, 2] = mode
    counters[at.EVENTS] += 1
    if kind in (IMPACT, REST):  # a block comes to rest by an impact
        counters[at.IMPACTS] += 1
    if tables.contact[mode] == FLIGHT and tables.contact[old_mode] != FLIGHT:
        counters[at.FLIGHTS] += 1
    if tables.contact[mode] != FULL and clock[at.FIRST_UPLIFT] < 0.0:
        clock[at.FIRST_UPLIFT] = time
    close = time - clock[at.EVENT_TIME] <= progress.controls[at.CHATTER_TIME]
    counters[at.CLOSE_EVENTS] = counters[at.CLOSE_EVENTS] + 1 if close else 0
    clock[at.EVENT_TIME] = time
    if counters[at.CLOSE_EVENTS] > at.CLOSE_EVENTS_LIMIT:
        return at.CHATTER
    return at.COMPLETED


@inlined
def accept(
    burnt: float,
    supplied: float,
    x: float,
    y: float,
    clock: Vector,
    counters: Integers,
    w: Workspace,
) -> None:
    """Go on from the step's end."""
    for i in range(len(w.state)):
        w.state[i] = w.new[i]
        w.reference[i] = max(w.reference[i], abs(w.new[i]))
    for i in range(len(w.slope)):
        w.slopes[0, i] = w.slope[i]
    for i in range(len(w.before)):
        w.before[i] = w.after[i]
    clock[at.BURNT] += burnt
    clock[at.SUPPLIED] += supplied
    clock[at.LARGEST_MOVED] = max(clock[at.LARGEST_MOVED], abs(clock[at.SUPPLIED]))
    clock[at.GROUND_X] = x
    clock[at.GROUND_Y] = y
    counters[at.STEPS] += 1
