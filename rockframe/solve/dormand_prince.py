"""One step of the Dormand-Prince pair, page "Numerics" of the manual."""

from rockframe.compiled import Vector, inlined, put
from rockframe.dynamics.protocol import POWERS, System
from rockframe.solve.dormand_prince_tableau import (
    ERROR_WEIGHTS,
    NODES,
    STAGE_WEIGHTS,
    STAGES,
    WEIGHTS,
)
from rockframe.solve.ground import ground_in
from rockframe.solve.workspace import ERRORS, Span


@inlined
def runge_kutta_step(
    system: System, mode: int, count: int, span: Span, ground: Vector, state: Vector,
    first: Vector, new: Vector, last: Vector, stages: Vector, works: Vector,
) -> None:  # fmt: skip
    """Step the first `count` coordinates and all variables of first order.

    Arguments as in :func:`rockframe.solve.march.march`. Gives the energies
    dissipated and put in by the ground, integrated with the weights of the fifth order, the
    error of their difference, and the local errors of what moves.
    """
    h, size = span.h, system.coordinates()
    powers = size + system.variables()
    slope, rates = powers + POWERS, STAGES * size
    for i in range(slope):
        stages[rates + i] = first[i]
    for i in range(size):
        stages[i] = state[size + i]
    dissipated, supplied = WEIGHTS[0] * first[powers], WEIGHTS[0] * first[powers + 1]
    imbalance = ERROR_WEIGHTS[0] * (first[powers] - first[powers + 1])
    for s in range(1, STAGES):
        for i in range(size):
            way = change = 0.0
            for j in range(s):
                way += STAGE_WEIGHTS[s, j] * stages[j * size + i]
                change += STAGE_WEIGHTS[s, j] * stages[rates + j * slope + i]
            own = h if i < count else 0.0  # what does not move makes steps of no length
            new[i] = state[i] + own * way
            new[size + i] = state[size + i] + own * change
            stages[s * size + i] = new[size + i]
        for i in range(size, powers):
            change = 0.0
            for j in range(s):
                change += STAGE_WEIGHTS[s, j] * stages[rates + j * slope + i]
            new[size + i] = state[size + i] + h * change
        found = system.accelerate(mode, new, ground_in(NODES[s], span, ground))
        put(found, rates + s * slope, stages)
        dissipated += WEIGHTS[s] * found[powers]
        supplied += WEIGHTS[s] * found[powers + 1]
        imbalance += ERROR_WEIGHTS[s] * (found[powers] - found[powers + 1])
    works[0], works[1], works[2] = h * dissipated, h * supplied, h * imbalance
    for i in range(size):
        way = change = 0.0
        for j in range(STAGES):
            way += ERROR_WEIGHTS[j] * stages[j * size + i]
            change += ERROR_WEIGHTS[j] * stages[rates + j * slope + i]
        works[ERRORS + i], works[ERRORS + size + i] = h * way, h * change
    for i in range(size, powers):
        change = 0.0
        for j in range(STAGES):
            change += ERROR_WEIGHTS[j] * stages[rates + j * slope + i]
        works[ERRORS + size + i] = h * change
    for i in range(slope):
        last[i] = stages[rates + (STAGES - 1) * slope + i]
