"""One step of the Dormand-Prince pair, page "Numerics" of the manual."""

from collections.abc import Callable

from rockframe.compiled import Vector, inlined
from rockframe.solve.dormand_prince_tableau import (
    A21,
    A31,
    A32,
    A41,
    A42,
    A43,
    A51,
    A52,
    A53,
    A54,
    A61,
    A62,
    A63,
    A64,
    A65,
    B1,
    B3,
    B4,
    B5,
    B6,
    C2,
    C3,
    C4,
    C5,
    E1,
    E3,
    E4,
    E5,
    E6,
    E7,
)
from rockframe.solve.ground import TERMS, ground_acceleration
from rockframe.solve.workspace import Span, Workspace


@inlined
def runge_kutta_step(
    accelerate: Callable[..., None],
    mode: int,
    count: int,
    span: Span,
    p: Vector,
    w: Workspace,
) -> tuple[float, float, float]:
    """Step the first `count` coordinates; ``slopes[0]`` holds the start's accelerations.

    Fills ``new``, the local ``error`` of each moving variable and ``slopes[6]``,
    the accelerations at the step's end. Gives the energies burnt by dashpots and
    put in by the ground, integrated with the weights of the fifth order, and the
    error of their difference. Each loop keeps the slopes of the stage before and
    makes the next stage.
    """
    h = span.h
    state, new, error, stage, slope = w.state, w.new, w.error, w.stage, w.slope
    slopes, speeds, ground = w.slopes, w.speeds, w.ground
    size = len(state) // 2
    burnt = B1 * slopes[0, size]
    supplied = B1 * slopes[0, size + 1]
    imbalance = E1 * (slopes[0, size] - slopes[0, size + 1])
    for i in range(count, size):
        new[i] = state[i]
        new[size + i] = state[size + i]
    for i in range(count):
        j = size + i
        speeds[0, i] = state[j]
        stage[i] = state[i] + h * A21 * state[j]
        stage[j] = state[j] + h * A21 * slopes[0, i]
    u = span.u + C2 * span.du
    x = ground_acceleration(u, span.degree_x, 0, ground)
    y = ground_acceleration(u, span.degree_y, TERMS, ground)
    accelerate(mode, stage, x, y, p, slope)
    for i in range(count):
        j = size + i
        v1, v2 = speeds[0, i], stage[j]
        a1, a2 = slopes[0, i], slope[i]
        speeds[1, i], slopes[1, i] = v2, a2
        stage[i] = state[i] + h * (A31 * v1 + A32 * v2)
        stage[j] = state[j] + h * (A31 * a1 + A32 * a2)
    u = span.u + C3 * span.du
    x = ground_acceleration(u, span.degree_x, 0, ground)
    y = ground_acceleration(u, span.degree_y, TERMS, ground)
    accelerate(mode, stage, x, y, p, slope)
    burnt += B3 * slope[size]
    supplied += B3 * slope[size + 1]
    imbalance += E3 * (slope[size] - slope[size + 1])
    for i in range(count):
        j = size + i
        v1, v2, v3 = speeds[0, i], speeds[1, i], stage[j]
        a1, a2, a3 = slopes[0, i], slopes[1, i], slope[i]
        speeds[2, i], slopes[2, i] = v3, a3
        stage[i] = state[i] + h * (A41 * v1 + A42 * v2 + A43 * v3)
        stage[j] = state[j] + h * (A41 * a1 + A42 * a2 + A43 * a3)
    u = span.u + C4 * span.du
    x = ground_acceleration(u, span.degree_x, 0, ground)
    y = ground_acceleration(u, span.degree_y, TERMS, ground)
    accelerate(mode, stage, x, y, p, slope)
    burnt += B4 * slope[size]
    supplied += B4 * slope[size + 1]
    imbalance += E4 * (slope[size] - slope[size + 1])
    for i in range(count):
        j = size + i
        v1, v2, v3, v4 = speeds[0, i], speeds[1, i], speeds[2, i], stage[j]
        a1, a2, a3, a4 = slopes[0, i], slopes[1, i], slopes[2, i], slope[i]
        speeds[3, i], slopes[3, i] = v4, a4
        stage[i] = state[i] + h * (A51 * v1 + A52 * v2 + A53 * v3 + A54 * v4)
        stage[j] = state[j] + h * (A51 * a1 + A52 * a2 + A53 * a3 + A54 * a4)
    u = span.u + C5 * span.du
    x = ground_acceleration(u, span.degree_x, 0, ground)
    y = ground_acceleration(u, span.degree_y, TERMS, ground)
    accelerate(mode, stage, x, y, p, slope)
    burnt += B5 * slope[size]
    supplied += B5 * slope[size + 1]
    imbalance += E5 * (slope[size] - slope[size + 1])
    for i in range(count):
        j = size + i
        v1, v2, v3, v4 = speeds[0, i], speeds[1, i], speeds[2, i], speeds[3, i]
        a1, a2, a3, a4 = slopes[0, i], slopes[1, i], slopes[2, i], slopes[3, i]
        v5, a5 = stage[j], slope[i]
        speeds[4, i], slopes[4, i] = v5, a5
        stage[i] = state[i] + h * (A61 * v1 + A62 * v2 + A63 * v3 + A64 * v4 + A65 * v5)
        stage[j] = state[j] + h * (A61 * a1 + A62 * a2 + A63 * a3 + A64 * a4 + A65 * a5)
    u = span.u + span.du
    x = ground_acceleration(u, span.degree_x, 0, ground)
    y = ground_acceleration(u, span.degree_y, TERMS, ground)
    accelerate(mode, stage, x, y, p, slope)
    burnt += B6 * slope[size]
    supplied += B6 * slope[size + 1]
    imbalance += E6 * (slope[size] - slope[size + 1])
    for i in range(count):
        j = size + i
        v1, v3, v4, v5, v6 = speeds[0, i], speeds[2, i], speeds[3, i], speeds[4, i], stage[j]
        a1, a3, a4, a5, a6 = slopes[0, i], slopes[2, i], slopes[3, i], slopes[4, i], slope[i]
        new[i] = state[i] + h * (B1 * v1 + B3 * v3 + B4 * v4 + B5 * v5 + B6 * v6)
        new[j] = state[j] + h * (B1 * a1 + B3 * a3 + B4 * a4 + B5 * a5 + B6 * a6)
        error[i] = E1 * v1 + E3 * v3 + E4 * v4 + E5 * v5 + E6 * v6 + E7 * new[j]
        error[j] = E1 * a1 + E3 * a3 + E4 * a4 + E5 * a5 + E6 * a6
    accelerate(mode, new, x, y, p, slope)
    for i in range(count):
        error[i] *= h
        error[size + i] = h * (error[size + i] + E7 * slope[i])
        slopes[6, i] = slope[i]
    imbalance += E7 * (slope[size] - slope[size + 1])
    return h * burnt, h * supplied, h * imbalance
