"""One step of the Dormand-Prince pair, its error, and the length of the next one.

Page "Numerics" of the manual.
"""

import math
from typing import Final, TypeAlias

from rockframe.compiled import Vector, inlined, kernel, put, table
from rockframe.dynamics.protocol import POWERS, Equations
from rockframe.solve import layout as at
from rockframe.solve.workspace import ERRORS, Span, ground_in

ORDER: Final = 5
STAGES: Final = 7

NODES: Final = table([0.0, 1 / 5, 3 / 10, 4 / 5, 8 / 9, 1.0, 1.0])
"""Share of the step at which each stage stands."""

# weights of the stages before, by which each is made; the last makes the step
STAGE_1: Final = (1 / 5,)
STAGE_2: Final = (3 / 40, 9 / 40)
STAGE_3: Final = (44 / 45, -56 / 15, 32 / 9)
STAGE_4: Final = (19372 / 6561, -25360 / 2187, 64448 / 6561, -212 / 729)
STAGE_5: Final = (9017 / 3168, -355 / 33, 46732 / 5247, 49 / 176, -5103 / 18656)
STAGE_6: Final = (35 / 384, 0.0, 500 / 1113, 125 / 192, -2187 / 6784, 11 / 84)

STAGE_WEIGHTS: Final = table([*STAGE_1, *STAGE_2, *STAGE_3, *STAGE_4, *STAGE_5, *STAGE_6])
"""The same, one after the other: those of stage s, which has s stages before, from s(s-1)/2 on."""

WEIGHTS: Final = table([*STAGE_6, 0.0])
"""Weights of the fifth order."""

ERROR_WEIGHTS: Final = table(
    [71 / 57600, 0.0, -71 / 16695, 71 / 1920, -17253 / 339200, 22 / 525, -1 / 40]
)
"""Weights of the fifth order less those of the fourth."""


Weights: TypeAlias = Vector | tuple[float, ...]
"""Of the stages before one; of a tuple the number is known when it is compiled."""


@inlined
def begin_stages(system: Equations, state: Vector, first: Vector, stages: Vector) -> None:
    """Write the first stage: velocities and slope at the start of a step."""
    size = system.coordinates()
    slope, rates = size + system.variables() + POWERS, STAGES * size
    for i in range(slope):
        stages[rates + i] = first[i]
    for i in range(size):
        stages[i] = state[size + i]


@inlined
def stage_places(
    system: Equations, count: int, h: float, weights: Weights, state: Vector, stages: Vector,
    new: Vector,
) -> None:  # fmt: skip
    """Write the coordinates of a stage from the velocities of the stages before."""
    size = system.coordinates()
    for i in range(size):
        way = 0.0
        for j in range(len(weights)):
            way += weights[j] * stages[j * size + i]
        own = h if i < count else 0.0  # what does not move makes steps of no length
        new[i] = state[i] + own * way


@inlined
def stage_rates(
    system: Equations, count: int, h: float, weights: Weights, state: Vector, stages: Vector,
    new: Vector,
) -> None:  # fmt: skip
    """Write the velocities and variables of a stage from the slopes of the stages before."""
    size, s = system.coordinates(), len(weights)
    powers = size + system.variables()
    slope, rates = powers + POWERS, STAGES * size
    for i in range(powers):
        change = 0.0
        for j in range(s):
            change += weights[j] * stages[rates + j * slope + i]
        own = h if (i < count) | (i >= size) else 0.0
        new[size + i] = state[size + i] + own * change
    for i in range(size):
        stages[s * size + i] = new[size + i]


@inlined
def end_works(system: Equations, h: float, stages: Vector, last: Vector, works: Vector) -> None:
    """Write the slope at the end of a step, and the works in it with their error."""
    size = system.coordinates()
    powers = size + system.variables()
    slope, rates = powers + POWERS, STAGES * size
    dissipated = supplied = imbalance = 0.0
    for s in range(STAGES):
        lost, put_in = stages[rates + s * slope + powers], stages[rates + s * slope + powers + 1]
        dissipated += WEIGHTS[s] * lost
        supplied += WEIGHTS[s] * put_in
        imbalance += ERROR_WEIGHTS[s] * (lost - put_in)
    works[0], works[1], works[2] = h * dissipated, h * supplied, h * imbalance
    for i in range(slope):
        last[i] = stages[rates + (STAGES - 1) * slope + i]


@inlined
def errors_of_places(system: Equations, h: float, stages: Vector, works: Vector) -> None:
    """Write the errors of the coordinates."""
    size = system.coordinates()
    for i in range(size):
        way = 0.0
        for j in range(STAGES):
            way += ERROR_WEIGHTS[j] * stages[j * size + i]
        works[ERRORS + i] = h * way


@inlined
def errors_of_rates(system: Equations, h: float, stages: Vector, works: Vector) -> None:
    """Write the errors of velocities and variables."""
    size = system.coordinates()
    powers = size + system.variables()
    slope, rates = powers + POWERS, STAGES * size
    for i in range(powers):
        change = 0.0
        for j in range(STAGES):
            change += ERROR_WEIGHTS[j] * stages[rates + j * slope + i]
        works[ERRORS + size + i] = h * change


@inlined
def runge_kutta_step(
    system: Equations, mode: int, count: int, span: Span, ground: Vector, state: Vector,
    first: Vector, new: Vector, last: Vector, stages: Vector, works: Vector,
) -> None:  # fmt: skip
    """Step the first `count` coordinates and all variables of first order.

    Arguments as in :func:`rockframe.solve.march.march`. Gives the energies
    dissipated and put in by the ground, integrated with the weights of the fifth order, the
    error of their difference, and the local errors of what moves.
    """
    size = system.coordinates()
    slope = size + system.variables() + POWERS
    begin_stages(system, state, first, stages)
    for s in range(1, STAGES):
        before = s * (s - 1) // 2
        weights = STAGE_WEIGHTS[before : before + s]
        stage_places(system, count, span.h, weights, state, stages, new)
        stage_rates(system, count, span.h, weights, state, stages, new)
        found = system.accelerate(mode, new, ground_in(NODES[s], span, ground))
        put(found, STAGES * size + s * slope, stages)
    end_works(system, span.h, stages, last, works)
    errors_of_places(system, span.h, stages, works)
    errors_of_rates(system, span.h, stages, works)


# step-size control, after Hairer, Norsett, Wanner, "Solving Ordinary Differential
# Equations I", 2nd ed., section II.4
SAFETY: Final = 0.9
SMALLEST_FACTOR: Final = 0.2
LARGEST_FACTOR: Final = 5.0
EASY: Final = 0.5
"""Error below which a step that spans its whole interval needs no new step size."""


@inlined
def excess_error(
    system: Equations, count: int, imbalance: float, new: Vector, works: Vector, reference: Vector,
    controls: Vector,
) -> float:  # fmt: skip
    """Give the largest error of a step, of the state or of its works, over the error allowed.

    `imbalance` is the error of the works over the largest energy.
    """
    size, floor = system.coordinates(), controls[at.FLOOR]
    largest, total = abs(imbalance), imbalance
    for i in range(2 * size + system.variables()):
        # what does not move has no error
        moves = (i < count) | ((size <= i) & (i < size + count)) | (i >= 2 * size)
        error = abs(works[ERRORS + i]) if moves else 0.0
        largest = max(largest, error / max(abs(new[i]), floor * reference[i]))
        total += error
    return largest / controls[at.RTOL] if math.isfinite(total) else math.inf


@kernel
def next_step(h: float, h_next: float, excess: float) -> float:
    """Give the step size that a step's error suggests."""
    growth = LARGEST_FACTOR
    if excess > 0.0:
        growth = min(growth, max(SMALLEST_FACTOR, SAFETY * excess ** (-1.0 / ORDER)))
    if h < h_next and growth >= 1.0:  # cut short by its interval: it says little of longer ones
        return max(h_next, h * growth)
    return h * growth
