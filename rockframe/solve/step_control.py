"""Whether a step is accurate enough, and how long the next may be, :eq:`eq-error-norm`."""

import math
from typing import Final

from rockframe.compiled import Vector, inlined, kernel
from rockframe.dynamics.protocol import Equations
from rockframe.solve import layout as at
from rockframe.solve.dormand_prince_tableau import ORDER
from rockframe.solve.workspace import ERRORS

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
