"""One step of the Dormand-Prince pair, page "Numerics" of the manual."""

from typing import TypeAlias

from rockframe.compiled import Vector, inlined, put
from rockframe.dynamics.protocol import POWERS, Equations
from rockframe.solve.dormand_prince_tableau import (
    ERROR_WEIGHTS,
    NODES,
    STAGE_WEIGHTS,
    STAGES,
    WEIGHTS,
)
from rockframe.solve.ground import ground_in
from rockframe.solve.workspace import ERRORS, Span

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
