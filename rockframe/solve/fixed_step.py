"""One step of fixed length with two evaluations, page "Numerics" of the manual.

Equations :eq:`eq-fixed-stages` and :eq:`eq-fixed-step`.
"""

import math
from collections.abc import Callable

from rockframe.compiled import Vector, inlined
from rockframe.solve.ground import TERMS, ground_acceleration
from rockframe.solve.workspace import Span, Workspace


@inlined
def fixed_step(
    accelerate: Callable[..., None],
    mode: int,
    count: int,
    span: Span,
    p: Vector,
    w: Workspace,
) -> tuple[float, float]:
    """Step the first `count` coordinates; ``slopes[0]`` holds the start's accelerations.

    Fills ``new`` and, with the last stage's accelerations, ``slopes[6]``; they serve
    as the start's of the next step. Gives the energies burnt by dashpots and put in
    by the ground, integrated with the weights of the velocities.
    """
    h = span.h
    half = 0.5 * h
    sixth = h / 6.0
    state, new, stage, slope, slopes, ground = (
        w.state, w.new, w.stage, w.slope, w.slopes, w.ground,
    )  # fmt: skip
    size = len(state) // 2
    for i in range(count, size):
        new[i] = state[i]
        new[size + i] = state[size + i]
    for i in range(count):
        j = size + i
        stage[i] = state[i] + half * (state[j] + 0.5 * half * slopes[0, i])
        stage[j] = state[j] + half * slopes[0, i]
    u = span.u + 0.5 * span.du
    x = ground_acceleration(u, span.degree_x, 0, ground)
    y = ground_acceleration(u, span.degree_y, TERMS, ground)
    accelerate(mode, stage, x, y, p, slope)
    burnt = slopes[0, size] + 4.0 * slope[size]
    supplied = slopes[0, size + 1] + 4.0 * slope[size + 1]
    for i in range(count):
        j = size + i
        v, a1, a2 = state[j], slopes[0, i], slope[i]
        new[i] = state[i] + h * (v + sixth * (a1 + 2.0 * a2))
        new[j] = v + sixth * (a1 + 4.0 * a2)
        # off the solution by as much as makes up for the stage before, and for this one
        # when it serves as the first of the next step
        stage[i] = state[i] + h * (v + 0.5 * sixth * (a1 + 5.0 * a2))
        stage[j] = v + half * (3.0 * a2 - a1)
    u = span.u + span.du
    x = ground_acceleration(u, span.degree_x, 0, ground)
    y = ground_acceleration(u, span.degree_y, TERMS, ground)
    accelerate(mode, stage, x, y, p, slope)
    for i in range(count):
        new[size + i] += sixth * slope[i]
        slopes[6, i] = slope[i]
    return sixth * (burnt + slope[size]), sixth * (supplied + slope[size + 1])


@inlined
def finite(count: int, w: Workspace) -> bool:
    """Whether a step has ended in numbers."""
    total = 0.0
    for i in range(count):
        total += w.new[len(w.state) // 2 + i]
    return math.isfinite(total)
