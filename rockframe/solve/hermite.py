"""Dense solution of a step: the quintic through position, rate and acceleration at its ends.

Equation :eq:`eq-hermite` of the numerics page; its error is of sixth order in the step. The
variables of first order follow the cubic through value and rate.
"""

from rockframe.compiled import kernel
from rockframe.solve.equations import BoundEquations
from rockframe.solve.workspace import Workspace


@kernel
def quintic(
    x0: float, v0: float, a0: float, x1: float, v1: float, a1: float
) -> tuple[float, float, float, float, float, float]:
    """Give the coefficients in u = t/h; rates are per u, accelerations per u squared."""
    rise = x1 - x0 - v0 - 0.5 * a0
    change = v1 - v0 - a0
    bend = a1 - a0
    return (
        x0,
        v0,
        0.5 * a0,
        10.0 * rise - 4.0 * change + 0.5 * bend,
        -15.0 * rise + 7.0 * change - bend,
        6.0 * rise - 3.0 * change + 0.5 * bend,
    )


@kernel
def cubic(x0: float, v0: float, x1: float, v1: float, u: float) -> tuple[float, float]:
    """Give value and rate per u of the cubic through values and rates at u = 0 and 1."""
    rise, bend = x1 - x0 - v0, v1 - v0
    c2, c3 = 3.0 * rise - bend, bend - 2.0 * rise
    return x0 + u * (v0 + u * (c2 + u * c3)), v0 + u * (2.0 * c2 + u * 3.0 * c3)


@kernel
def interpolate(
    equations: BoundEquations, count: int, fraction: float, h: float, w: Workspace
) -> None:
    """Fill the scratch state and accelerations at a fraction of a step of length h.

    Coordinates beyond the first `count` do not move and are copied.
    """
    size, u = equations.coordinate_count, fraction
    for i in range(size):
        j = size + i
        if i >= count:
            w.scratch[i] = w.state[i]
            w.scratch[j] = w.state[j]
            w.scratch_rates[i] = 0.0
            continue
        c0, c1, c2, c3, c4, c5 = quintic(
            w.state[i],
            h * w.state[j],
            h * h * w.first[i],
            w.new[i],
            h * w.new[j],
            h * h * w.last[i],
        )
        w.scratch[i] = c0 + u * (c1 + u * (c2 + u * (c3 + u * (c4 + u * c5))))
        slope = c1 + u * (2.0 * c2 + u * (3.0 * c3 + u * (4.0 * c4 + u * 5.0 * c5)))
        curve = 2.0 * c2 + u * (6.0 * c3 + u * (12.0 * c4 + u * 20.0 * c5))
        w.scratch[j] = slope / h
        w.scratch_rates[i] = curve / (h * h)
    for i in range(size, size + equations.variable_count):
        j = size + i
        value, rate = cubic(w.state[j], h * w.first[i], w.new[j], h * w.last[i], u)
        w.scratch[j], w.scratch_rates[i] = value, rate / h


@kernel
def extremum(x0: float, v0: float, a0: float, x1: float, v1: float, a1: float) -> float:
    """Give the value of the quintic where its slope changes sign (arguments as `quintic`)."""
    c0, c1, c2, c3, c4, c5 = quintic(x0, v0, a0, x1, v1, a1)
    low = 0.0
    high = 1.0
    u = v0 / (v0 - v1)
    for _ in range(60):
        slope = c1 + u * (2.0 * c2 + u * (3.0 * c3 + u * (4.0 * c4 + u * 5.0 * c5)))
        if (slope > 0.0) == (v0 > 0.0):
            low = u
        else:
            high = u
        curve = 2.0 * c2 + u * (6.0 * c3 + u * (12.0 * c4 + u * 20.0 * c5))
        trial = u - slope / curve if curve != 0.0 else 0.5 * (low + high)
        if not low < trial < high:
            trial = 0.5 * (low + high)
        if abs(trial - u) <= 1e-12:
            u = trial
            break
        u = trial
    return c0 + u * (c1 + u * (c2 + u * (c3 + u * (c4 + u * c5))))
