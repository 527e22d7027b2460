"""One step of fixed length with two evaluations, page "Numerics" of the manual.

Equations :eq:`eq-fixed-stages` and :eq:`eq-fixed-step`.
"""

import math

from rockframe.compiled import Vector, inlined, put
from rockframe.dynamics.protocol import Equations, Ground


@inlined
def fixed_step(
    system: Equations, mode: int, count: int, h: float, in_middle: Ground, at_end: Ground,
    state: Vector, first: Vector, new: Vector, last: Vector, stage: Vector, works: Vector,
) -> bool:  # fmt: skip
    """Step the first `count` coordinates and all variables of first order.

    Arguments as in :func:`rockframe.solve.march.march`, with the ground in the middle and at
    the end of the step. Gives the energies dissipated and put in by the ground, integrated with
    the weights of the velocities, and whether the step has ended in numbers.
    """
    size = system.coordinates()
    half, sixth = 0.5 * h, h / 6.0
    powers = size + system.variables()
    for i in range(size):  # what does not move makes steps of no length
        own_half = half if i < count else 0.0
        j = size + i
        stage[i] = state[i] + own_half * (state[j] + 0.5 * half * first[i])
        stage[j] = state[j] + own_half * first[i]
    for i in range(size, powers):
        stage[size + i] = state[size + i] + half * first[i]
    middle = system.accelerate(mode, stage, in_middle)
    put(middle, 0, last)
    for i in range(size):
        own, own_sixth = (h, sixth) if i < count else (0.0, 0.0)
        j = size + i
        v, a1, a2 = state[j], first[i], last[i]
        new[i] = state[i] + own * (v + sixth * (a1 + 2.0 * a2))
        new[j] = v + own_sixth * (a1 + 4.0 * a2)
        # off the solution by as much as makes up for the stage before, and for this one
        # when it serves as the first of the next step
        stage[i] = state[i] + own * (v + 0.5 * sixth * (a1 + 5.0 * a2))
        stage[j] = v + 3.0 * own_sixth * (3.0 * a2 - a1)
    for i in range(size, powers):
        z, r1, r2 = state[size + i], first[i], last[i]
        new[size + i] = z + sixth * (r1 + 4.0 * r2)
        stage[size + i] = z + half * (3.0 * r2 - r1)
    end = system.accelerate(mode, stage, at_end)
    put(end, 0, last)
    total = 0.0
    for i in range(size):
        new[size + i] += (sixth if i < count else 0.0) * last[i]
        total += new[size + i]
    for i in range(size, powers):
        new[size + i] += sixth * last[i]
        total += new[size + i]
    works[0] = sixth * (first[powers] + 4.0 * middle[powers] + end[powers])
    works[1] = sixth * (first[powers + 1] + 4.0 * middle[powers + 1] + end[powers + 1])
    return math.isfinite(total)
