"""A single time step: by Dormand and Prince with a tolerance, or of fixed length.

A step of fixed length takes two evaluations, :eq:`eq-fixed-stages` and :eq:`eq-fixed-step`; the
page "Numerics" of the manual derives both methods. `march.py` makes one step after the other.
"""

import math
from typing import Final, NamedTuple, Protocol, TypeAlias

from rockframe.compiled import Vector, inlined, kernel, table
from rockframe.dynamics.protocol import POWERS, Ground, Slope
from rockframe.solve import workspace as at
from rockframe.solve.workspace import STATE_ERRORS, Span, ground_in_step

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


class HasSizes(Protocol):
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


class StepEquations(HasSizes, Protocol):
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
def is_at_rest(system: HasSizes, count: int) -> bool:
    """Whether nothing moves, so that a step only needs the slope at its end, for the guards."""
    return count == 0 and system.variables() == 0


@inlined
def write_first_stage(system: HasSizes, state: Vector, slope: Vector, stages: Vector) -> None:
    """Write the first stage: velocities and slope at the start of a step."""
    size = system.coordinates()
    slope_size, rates = size + system.variables() + POWERS, STAGES * size
    for i in range(slope_size):
        stages[rates + i] = slope[i]
    for i in range(size):
        stages[i] = state[size + i]


@inlined
def write_stage_coordinates(
    system: HasSizes, count: int, h: float, weights: Weights, state: Vector, stages: Vector,
    stage_state: Vector,
) -> None:  # fmt: skip
    """Write the coordinates of a stage from the velocities of the stages before."""
    size = system.coordinates()
    for i in range(size):
        change = 0.0
        for j in range(len(weights)):
            change += weights[j] * stages[j * size + i]
        h_i = h if i < count else 0.0  # coordinates that do not move make steps of length zero
        stage_state[i] = state[i] + h_i * change


@inlined
def write_stage_rates(
    system: HasSizes, count: int, h: float, weights: Weights, state: Vector, stages: Vector,
    stage_state: Vector,
) -> None:  # fmt: skip
    """Write the velocities and variables of a stage from the slopes of the stages before."""
    size, s = system.coordinates(), len(weights)
    powers = size + system.variables()
    slope_size, rates = powers + POWERS, STAGES * size
    for i in range(powers):
        change = 0.0
        for j in range(s):
            change += weights[j] * stages[rates + j * slope_size + i]
        h_i = h if (i < count) | (i >= size) else 0.0
        stage_state[size + i] = state[size + i] + h_i * change
    for i in range(size):
        stages[s * size + i] = stage_state[size + i]


@inlined
def write_works(
    system: HasSizes, h: float, stages: Vector, new_slope: Vector, works: Vector
) -> None:
    """Write the slope at the end of a step, and the works in it with their error."""
    size = system.coordinates()
    powers = size + system.variables()
    slope_size, rates = powers + POWERS, STAGES * size
    dissipated = supplied = imbalance = 0.0
    for s in range(STAGES):
        power_out = stages[rates + s * slope_size + powers]
        power_in = stages[rates + s * slope_size + powers + 1]
        dissipated += WEIGHTS[s] * power_out
        supplied += WEIGHTS[s] * power_in
        imbalance += ERROR_WEIGHTS[s] * (power_out - power_in)
    works[0], works[1], works[2] = h * dissipated, h * supplied, h * imbalance
    for i in range(slope_size):
        new_slope[i] = stages[rates + (STAGES - 1) * slope_size + i]


@inlined
def write_coordinate_errors(system: HasSizes, h: float, stages: Vector, works: Vector) -> None:
    """Write the errors of the coordinates."""
    size = system.coordinates()
    for i in range(size):
        change = 0.0
        for j in range(STAGES):
            change += ERROR_WEIGHTS[j] * stages[j * size + i]
        works[STATE_ERRORS + i] = h * change


@inlined
def write_rate_errors(system: HasSizes, h: float, stages: Vector, works: Vector) -> None:
    """Write the errors of velocities and variables."""
    size = system.coordinates()
    powers = size + system.variables()
    slope_size, rates = powers + POWERS, STAGES * size
    for i in range(powers):
        change = 0.0
        for j in range(STAGES):
            change += ERROR_WEIGHTS[j] * stages[rates + j * slope_size + i]
        works[STATE_ERRORS + size + i] = h * change


# step-size control, after Hairer, Norsett, Wanner, "Solving Ordinary Differential
# Equations I", 2nd ed., section II.4
SAFETY: Final = 0.9
SMALLEST_FACTOR: Final = 0.2
LARGEST_FACTOR: Final = 5.0
SMALL_ERROR: Final = 0.5
"""Error below which a step that spans its whole interval needs no new step size."""


@kernel
def next_step(h: float, h_next: float, error_norm: float) -> float:
    """Return the next step after a step h, planned was h_next, by its error over that allowed."""
    growth = LARGEST_FACTOR
    if error_norm > 0.0:
        growth = min(growth, max(SMALLEST_FACTOR, SAFETY * error_norm ** (-1.0 / ORDER)))
    if h < h_next and growth >= 1.0:  # cut short by its interval: the planned step stays possible
        return max(h_next, h * growth)
    return h * growth


@inlined
def make_fixed_step(
    scheme: "FixedSteps", system: StepEquations, mode: int, count: int, h: float, in_middle: Ground,
    at_end: Ground, state: Vector, slope: Vector, new_state: Vector, new_slope: Vector,
    stage: Vector, works: Vector,
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
        half_i = half if i < count else 0.0
        j = size + i
        stage[i] = state[i] + half_i * (state[j] + 0.5 * half * slope[i])
        stage[j] = state[j] + half_i * slope[i]
    for i in range(size, powers):
        stage[size + i] = state[size + i] + half * slope[i]
    power_out = power_in = 0.0
    if not is_at_rest(system, count):
        system.write_slope(mode, stage, in_middle, 0, new_slope)
        power_out, power_in = scheme.powers_in_middle(
            system, mode, count, half, state, slope, stage, new_slope, in_middle
        )
    for i in range(size):
        h_i, sixth_i = (h, sixth) if i < count else (0.0, 0.0)
        j = size + i
        v, a1, a2 = state[j], slope[i], new_slope[i]
        new_state[i] = state[i] + h_i * (v + sixth * (a1 + 2.0 * a2))
        new_state[j] = v + sixth_i * (a1 + 4.0 * a2)
        # a state beside the solution: its error cancels that of the stage before, and its own
        # where its slope serves as the first stage of the next step
        stage[i] = state[i] + h_i * (v + 0.5 * sixth * (a1 + 5.0 * a2))
        stage[j] = v + 3.0 * sixth_i * (3.0 * a2 - a1)
    for i in range(size, powers):
        z, r1, r2 = state[size + i], slope[i], new_slope[i]
        new_state[size + i] = z + sixth * (r1 + 4.0 * r2)
        stage[size + i] = z + half * (3.0 * r2 - r1)
    system.write_slope(mode, stage, at_end, 0, new_slope)
    total = 0.0
    for i in range(size):
        new_state[size + i] += (sixth if i < count else 0.0) * new_slope[i]
        total += new_state[size + i]
    for i in range(size, powers):
        new_state[size + i] += sixth * new_slope[i]
        total += new_state[size + i]
    new_slope[powers], new_slope[powers + 1] = scheme.powers_at_end(
        system, mode, new_state, stage, new_slope, at_end
    )
    works[0] = sixth * (slope[powers] + 4.0 * power_out + new_slope[powers])
    works[1] = sixth * (slope[powers + 1] + 4.0 * power_in + new_slope[powers + 1])
    return math.isfinite(total)


@inlined
def remaining_step(requested: float, h: float, shortest: float, controls: Vector) -> float:
    """Return the next fixed step: the rest of the sub-step if only a part of it has been made."""
    rest = requested - h
    return rest if rest > shortest else controls[at.MAX_STEP]


@inlined
def adapted_step(h: float, h_next: float, error_norm: float, controls: Vector) -> float:
    """Return the next step after an accepted step h, planned was h_next, by the error of h."""
    if error_norm > SMALL_ERROR or h < controls[at.TIME_STEP] or h >= h_next:
        return next_step(h, h_next, error_norm)
    return h_next


class FixedSteps(NamedTuple):
    """Steps of fixed length, of equations that give powers only with their slope."""

    longest_step: float  # longest step that is stable in the mode [s]

    @inlined
    def powers_in_middle(
        self, system: StepEquations, mode: int, count: int, half: float, state: Vector,
        slope: Vector, stage: Vector, new_slope: Vector, ground: Ground,
    ) -> tuple[float, float]:  # fmt: skip
        """Return the powers dissipated and put in at the middle stage, which its slope contains."""
        powers = system.coordinates() + system.variables()
        return new_slope[powers], new_slope[powers + 1]

    @inlined
    def powers_at_end(
        self, system: StepEquations, mode: int, new_state: Vector, stage: Vector, new_slope: Vector,
        ground: Ground,
    ) -> tuple[float, float]:  # fmt: skip
        """Return the powers dissipated and put in at the last stage, which its slope contains."""
        powers = system.coordinates() + system.variables()
        return new_slope[powers], new_slope[powers + 1]

    @inlined
    def make_step(
        self, system: StepEquations, mode: int, count: int, span: Span, ground: Vector,
        state: Vector, slope: Vector, new_state: Vector, new_slope: Vector, stages: Vector,
        works: Vector,
    ) -> bool:  # fmt: skip
        """Make a step; return whether its end is finite."""
        in_middle, at_end = ground_in_step(0.5, span, ground), ground_in_step(1.0, span, ground)
        return make_fixed_step(
            self, system, mode, count, span.h, in_middle, at_end, state, slope, new_state,
            new_slope, stages, works,
        )  # fmt: skip

    @inlined
    def error_norm_of(
        self, system: HasSizes, count: int, finite: bool, scale: float, new_state: Vector,
        works: Vector, reference: Vector, controls: Vector,
    ) -> float:  # fmt: skip
        """Return 0, or infinity where the end of the step is not finite."""
        return 0.0 if finite else math.inf


class FixedStepsByRates(FixedSteps):
    """Steps of fixed length of :class:`rockframe.dynamics.protocol.EquationsWithPowers`."""

    __slots__ = ()

    @inlined
    def powers_in_middle(
        self, system: StepEquations, mode: int, count: int, half: float, state: Vector,
        slope: Vector, stage: Vector, new_slope: Vector, ground: Ground,
    ) -> tuple[float, float]:  # fmt: skip
        """Return the powers at the middle stage, with the rates of :eq:`eq-fixed-powers`."""
        size = system.coordinates()
        for i in range(size):
            half_i = half if i < count else 0.0
            stage[size + i] = state[size + i] + 0.5 * half_i * (slope[i] + new_slope[i])
        return system.powers(mode, stage, new_slope, ground)

    @inlined
    def powers_at_end(
        self, system: StepEquations, mode: int, new_state: Vector, stage: Vector, new_slope: Vector,
        ground: Ground,
    ) -> tuple[float, float]:  # fmt: skip
        """Return the powers at the last stage, with the rates at the end of the step."""
        size = system.coordinates()
        for i in range(size):
            stage[size + i] = new_state[size + i]
        return system.powers(mode, stage, new_slope, ground)


class StepsByTolerance(NamedTuple):
    """Steps of the Dormand-Prince pair, whose length is limited by their errors alone."""

    longest_step: float = math.inf

    @inlined
    def make_step(
        self, system: StepEquations, mode: int, count: int, span: Span, ground: Vector,
        state: Vector, slope: Vector, new_state: Vector, new_slope: Vector, stages: Vector,
        works: Vector,
    ) -> bool:  # fmt: skip
        """Step the first `count` coordinates and all variables of first order.

        Arguments as of :func:`rockframe.solve.march.march`. Writes to `works` the energies
        dissipated and put in by the ground, integrated with the weights of the fifth order, the
        error of their difference, and the local errors of the state. Returns True: these
        errors show whether the end of the step is finite.
        """
        size = system.coordinates()
        slope_size = size + system.variables() + POWERS
        at_rest = is_at_rest(system, count)
        write_first_stage(system, state, slope, stages)
        for s in range(STAGES - 1 if at_rest else 1, STAGES):
            before = s * (s - 1) // 2
            weights = STAGE_WEIGHTS[before : before + s]
            write_stage_coordinates(system, count, span.h, weights, state, stages, new_state)
            write_stage_rates(system, count, span.h, weights, state, stages, new_state)
            ground_now = ground_in_step(NODES[s], span, ground)
            system.write_slope(mode, new_state, ground_now, STAGES * size + s * slope_size, stages)
        # at rest the stages between are those of an earlier step: none of them counts
        write_works(system, 0.0 if at_rest else span.h, stages, new_slope, works)
        write_coordinate_errors(system, span.h, stages, works)
        write_rate_errors(system, span.h, stages, works)
        return True

    @inlined
    def error_norm_of(
        self, system: HasSizes, count: int, finite: bool, scale: float, new_state: Vector,
        works: Vector, reference: Vector, controls: Vector,
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
            error = abs(works[STATE_ERRORS + i]) if moves else 0.0
            largest = max(largest, error / max(abs(new_state[i]), floor * reference[i]))
            total += error
        return largest / controls[at.RTOL] if math.isfinite(total) else math.inf
