"""A single time step: by Dormand and Prince with a tolerance, or of fixed length.

A step of fixed length takes two evaluations, :eq:`eq-fixed-stages` and :eq:`eq-fixed-step`; the
page "Numerics" of the manual derives both methods. `march.py` makes one step after the other.
"""

import math
from typing import Final, NamedTuple, Protocol, TypeAlias

from rockframe.compiled import Vector, inlined, kernel, table
from rockframe.dynamics.protocol import POWERS, Ground, Slope
from rockframe.solve import workspace as at
from rockframe.solve.workspace import ERRORS, Span, ground_in

ORDER: Final = 5
STAGES: Final = 7

NODES: Final = table([0.0, 1 / 5, 3 / 10, 4 / 5, 8 / 9, 1.0, 1.0])
"""Nodes: the share of the step at which each stage is evaluated."""

# weights of the stages before each stage; the last ones also make the step
STAGE_1: Final = (1 / 5,)
STAGE_2: Final = (3 / 40, 9 / 40)
STAGE_3: Final = (44 / 45, -56 / 15, 32 / 9)
STAGE_4: Final = (19372 / 6561, -25360 / 2187, 64448 / 6561, -212 / 729)
STAGE_5: Final = (9017 / 3168, -355 / 33, 46732 / 5247, 49 / 176, -5103 / 18656)
STAGE_6: Final = (35 / 384, 0.0, 500 / 1113, 125 / 192, -2187 / 6784, 11 / 84)

STAGE_WEIGHTS: Final = table([*STAGE_1, *STAGE_2, *STAGE_3, *STAGE_4, *STAGE_5, *STAGE_6])
"""All these weights, one after the other: those of stage s begin at s(s-1)/2."""

WEIGHTS: Final = table([*STAGE_6, 0.0])
"""Weights of the solution of fifth order."""

ERROR_WEIGHTS: Final = table(
    [71 / 57600, 0.0, -71 / 16695, 71 / 1920, -17253 / 339200, 22 / 525, -1 / 40]
)
"""Weights of the solution of fifth order less those of fourth order."""


class Counted(Protocol):
    """The sizes of a system of equations."""

    def coordinates(self) -> int:
        """Return the number of coordinates."""
        ...

    def variables(self) -> int:
        """Return the number of variables of first order."""
        ...

    def guards(self) -> int:
        """Return the number of guards."""
        ...


class Evaluated(Counted, Protocol):
    """Equations as steps evaluate them."""

    def write_slope(
        self, mode: int, state: Vector, ground: Ground, first: int, out: Vector
    ) -> None:
        """Write accelerations, rates of variables and powers, from an index on."""
        ...

    def write_guards(
        self, mode: int, state: Vector, slope: Vector, ground: Ground, limits: Vector, out: Vector
    ) -> None:
        """Write guards, then their rates; the last of each is for the limits of rotations."""
        ...

    def powers(self, mode: int, state: Vector, slope: Slope, ground: Ground) -> tuple[float, float]:
        """Return the powers of a state, from a slope at the same coordinates but other rates."""
        ...


Weights: TypeAlias = Vector | tuple[float, ...]
"""Weights of the stages before one; the length of a tuple is known when it is compiled."""


@inlined
def stands_still(system: Counted, count: int) -> bool:
    """Whether nothing moves, so that a step only needs the slope at its end, for the guards."""
    return count == 0 and system.variables() == 0


@inlined
def begin_stages(system: Counted, state: Vector, first: Vector, stages: Vector) -> None:
    """Write the first stage: velocities and slope at the start of a step."""
    size = system.coordinates()
    slope, rates = size + system.variables() + POWERS, STAGES * size
    for i in range(slope):
        stages[rates + i] = first[i]
    for i in range(size):
        stages[i] = state[size + i]


@inlined
def stage_places(
    system: Counted, count: int, h: float, weights: Weights, state: Vector, stages: Vector,
    new: Vector,
) -> None:  # fmt: skip
    """Write the coordinates of a stage from the velocities of the stages before."""
    size = system.coordinates()
    for i in range(size):
        way = 0.0
        for j in range(len(weights)):
            way += weights[j] * stages[j * size + i]
        own = h if i < count else 0.0  # coordinates that do not move make steps of length zero
        new[i] = state[i] + own * way


@inlined
def stage_rates(
    system: Counted, count: int, h: float, weights: Weights, state: Vector, stages: Vector,
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
def end_works(system: Counted, h: float, stages: Vector, last: Vector, works: Vector) -> None:
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
def errors_of_places(system: Counted, h: float, stages: Vector, works: Vector) -> None:
    """Write the errors of the coordinates."""
    size = system.coordinates()
    for i in range(size):
        way = 0.0
        for j in range(STAGES):
            way += ERROR_WEIGHTS[j] * stages[j * size + i]
        works[ERRORS + i] = h * way


@inlined
def errors_of_rates(system: Counted, h: float, stages: Vector, works: Vector) -> None:
    """Write the errors of velocities and variables."""
    size = system.coordinates()
    powers = size + system.variables()
    slope, rates = powers + POWERS, STAGES * size
    for i in range(powers):
        change = 0.0
        for j in range(STAGES):
            change += ERROR_WEIGHTS[j] * stages[rates + j * slope + i]
        works[ERRORS + size + i] = h * change


# step-size control, after Hairer, Norsett, Wanner, "Solving Ordinary Differential
# Equations I", 2nd ed., section II.4
SAFETY: Final = 0.9
SMALLEST_FACTOR: Final = 0.2
LARGEST_FACTOR: Final = 5.0
EASY: Final = 0.5
"""Error below which a step that spans its whole interval needs no new step size."""


@kernel
def next_step(h: float, h_next: float, excess: float) -> float:
    """Return the next step after a step h, planned was h_next, by its error over that allowed."""
    growth = LARGEST_FACTOR
    if excess > 0.0:
        growth = min(growth, max(SMALLEST_FACTOR, SAFETY * excess ** (-1.0 / ORDER)))
    if h < h_next and growth >= 1.0:  # cut short by its interval: the planned step stays possible
        return max(h_next, h * growth)
    return h * growth


@inlined
def fixed_step(
    scheme: "FixedSteps", system: Evaluated, mode: int, count: int, h: float, in_middle: Ground,
    at_end: Ground, state: Vector, first: Vector, new: Vector, last: Vector, stage: Vector,
    works: Vector,
) -> bool:  # fmt: skip
    """Step the first `count` coordinates and all variables of first order.

    Arguments as of :func:`rockframe.solve.march.march`, with the ground in the middle and at
    the end of the step. Writes the energies dissipated and put in by the ground, integrated with
    the weights of the velocities. Returns whether all rates and variables at its end are finite.
    """
    size = system.coordinates()
    half, sixth = 0.5 * h, h / 6.0
    powers = size + system.variables()
    for i in range(size):  # coordinates that do not move make steps of length zero
        own_half = half if i < count else 0.0
        j = size + i
        stage[i] = state[i] + own_half * (state[j] + 0.5 * half * first[i])
        stage[j] = state[j] + own_half * first[i]
    for i in range(size, powers):
        stage[size + i] = state[size + i] + half * first[i]
    lost = put_in = 0.0
    if not stands_still(system, count):
        system.write_slope(mode, stage, in_middle, 0, last)
        lost, put_in = scheme.powers_in_middle(
            system, mode, count, half, state, first, stage, last, in_middle
        )
    for i in range(size):
        own, own_sixth = (h, sixth) if i < count else (0.0, 0.0)
        j = size + i
        v, a1, a2 = state[j], first[i], last[i]
        new[i] = state[i] + own * (v + sixth * (a1 + 2.0 * a2))
        new[j] = v + own_sixth * (a1 + 4.0 * a2)
        # a state beside the solution: its error cancels that of the stage before, and its own
        # where its slope serves as the first stage of the next step
        stage[i] = state[i] + own * (v + 0.5 * sixth * (a1 + 5.0 * a2))
        stage[j] = v + 3.0 * own_sixth * (3.0 * a2 - a1)
    for i in range(size, powers):
        z, r1, r2 = state[size + i], first[i], last[i]
        new[size + i] = z + sixth * (r1 + 4.0 * r2)
        stage[size + i] = z + half * (3.0 * r2 - r1)
    system.write_slope(mode, stage, at_end, 0, last)
    total = 0.0
    for i in range(size):
        new[size + i] += (sixth if i < count else 0.0) * last[i]
        total += new[size + i]
    for i in range(size, powers):
        new[size + i] += sixth * last[i]
        total += new[size + i]
    last[powers], last[powers + 1] = scheme.powers_at_end(system, mode, new, stage, last, at_end)
    works[0] = sixth * (first[powers] + 4.0 * lost + last[powers])
    works[1] = sixth * (first[powers + 1] + 4.0 * put_in + last[powers + 1])
    return math.isfinite(total)


@inlined
def rest_of(requested: float, h: float, shortest: float, controls: Vector) -> float:
    """Return the next fixed step: the rest of the sub-step if only a part of it has been made."""
    rest = requested - h
    return rest if rest > shortest else controls[at.MAX_STEP]


@inlined
def adapted(h: float, h_next: float, excess: float, controls: Vector) -> float:
    """Return the next step after an accepted step h, planned was h_next, by the error of h."""
    if excess > EASY or h < controls[at.TIME_STEP] or h >= h_next:
        return next_step(h, h_next, excess)
    return h_next


class FixedSteps(NamedTuple):
    """Steps of fixed length, of equations that give powers only with their slope."""

    longest: float  # longest step that is stable in the mode [s]

    @inlined
    def powers_in_middle(
        self, system: Evaluated, mode: int, count: int, half: float, state: Vector, first: Vector,
        stage: Vector, slope: Vector, ground: Ground,
    ) -> tuple[float, float]:  # fmt: skip
        """Return the powers dissipated and put in at the middle stage, which its slope contains."""
        powers = system.coordinates() + system.variables()
        return slope[powers], slope[powers + 1]

    @inlined
    def powers_at_end(
        self, system: Evaluated, mode: int, new: Vector, stage: Vector, slope: Vector,
        ground: Ground,
    ) -> tuple[float, float]:  # fmt: skip
        """Return the powers dissipated and put in at the last stage, which its slope contains."""
        powers = system.coordinates() + system.variables()
        return slope[powers], slope[powers + 1]

    @inlined
    def make_step(
        self, system: Evaluated, mode: int, count: int, span: Span, ground: Vector, state: Vector,
        first: Vector, new: Vector, last: Vector, stages: Vector, works: Vector,
    ) -> bool:  # fmt: skip
        """Make a step; return whether its end is finite."""
        in_middle, at_end = ground_in(0.5, span, ground), ground_in(1.0, span, ground)
        return fixed_step(
            self, system, mode, count, span.h, in_middle, at_end, state, first, new, last, stages,
            works,
        )  # fmt: skip

    @inlined
    def excess_of(
        self, system: Counted, count: int, done: bool, scale: float, new: Vector, works: Vector,
        reference: Vector, controls: Vector,
    ) -> float:  # fmt: skip
        """Return 0, or infinity where the end of the step is not finite."""
        return 0.0 if done else math.inf


class FixedStepsByRates(FixedSteps):
    """Steps of fixed length of :class:`rockframe.dynamics.protocol.EquationsWithPowers`."""

    __slots__ = ()

    @inlined
    def powers_in_middle(
        self, system: Evaluated, mode: int, count: int, half: float, state: Vector,
        first: Vector, stage: Vector, slope: Vector, ground: Ground,
    ) -> tuple[float, float]:  # fmt: skip
        """Return the powers at the middle stage, with the rates of :eq:`eq-fixed-powers`."""
        size = system.coordinates()
        for i in range(size):
            own_half = half if i < count else 0.0
            stage[size + i] = state[size + i] + 0.5 * own_half * (first[i] + slope[i])
        return system.powers(mode, stage, slope, ground)

    @inlined
    def powers_at_end(
        self, system: Evaluated, mode: int, new: Vector, stage: Vector, slope: Vector,
        ground: Ground,
    ) -> tuple[float, float]:  # fmt: skip
        """Return the powers at the last stage, with the rates at the end of the step."""
        size = system.coordinates()
        for i in range(size):
            stage[size + i] = new[size + i]
        return system.powers(mode, stage, slope, ground)


class StepsByTolerance(NamedTuple):
    """Steps of the Dormand-Prince pair, whose length is limited by their errors alone."""

    longest: float = math.inf

    @inlined
    def make_step(
        self, system: Evaluated, mode: int, count: int, span: Span, ground: Vector, state: Vector,
        first: Vector, new: Vector, last: Vector, stages: Vector, works: Vector,
    ) -> bool:  # fmt: skip
        """Step the first `count` coordinates and all variables of first order.

        Arguments as of :func:`rockframe.solve.march.march`. Writes to `works` the energies
        dissipated and put in by the ground, integrated with the weights of the fifth order, the
        error of their difference, and the local errors of the state. Returns True: these
        errors show whether the end of the step is finite.
        """
        size = system.coordinates()
        slope = size + system.variables() + POWERS
        still = stands_still(system, count)
        begin_stages(system, state, first, stages)
        for s in range(STAGES - 1 if still else 1, STAGES):
            before = s * (s - 1) // 2
            weights = STAGE_WEIGHTS[before : before + s]
            stage_places(system, count, span.h, weights, state, stages, new)
            stage_rates(system, count, span.h, weights, state, stages, new)
            now = ground_in(NODES[s], span, ground)
            system.write_slope(mode, new, now, STAGES * size + s * slope, stages)
        # at rest the stages between are those of an earlier step: none of them counts
        end_works(system, 0.0 if still else span.h, stages, last, works)
        errors_of_places(system, span.h, stages, works)
        errors_of_rates(system, span.h, stages, works)
        return True

    @inlined
    def excess_of(
        self, system: Counted, count: int, done: bool, scale: float, new: Vector, works: Vector,
        reference: Vector, controls: Vector,
    ) -> float:  # fmt: skip
        """Return the largest error of a step, of the state or of its works, over the error allowed.

        The error of the works is relative to `scale`, the largest energy of the run so far.
        """
        size, floor = system.coordinates(), controls[at.FLOOR]
        imbalance = works[2] / scale
        largest, total = abs(imbalance), imbalance
        for i in range(2 * size + system.variables()):
            # what does not move has no error
            moves = (i < count) | ((size <= i) & (i < size + count)) | (i >= 2 * size)
            error = abs(works[ERRORS + i]) if moves else 0.0
            largest = max(largest, error / max(abs(new[i]), floor * reference[i]))
            total += error
        return largest / controls[at.RTOL] if math.isfinite(total) else math.inf
