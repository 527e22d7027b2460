"""Two ways to step, with a fixed length and by a tolerance: what differs between them.

A step of fixed length takes two evaluations, :eq:`eq-fixed-stages` and :eq:`eq-fixed-step`.
"""

import math
from typing import NamedTuple

from rockframe.compiled import Vector, inlined, put
from rockframe.dynamics.protocol import Equations, Ground
from rockframe.solve import layout as at
from rockframe.solve.dormand_prince import EASY, excess_error, next_step, runge_kutta_step
from rockframe.solve.workspace import Span, ground_in


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


@inlined
def rest_of(asked: float, h: float, shortest: float, controls: Vector) -> float:
    """Give the next fixed step: after a shorter one, on to the end of the sub-step."""
    rest = asked - h
    return rest if rest > shortest else controls[at.MAX_STEP]


@inlined
def adapted(h: float, h_next: float, excess: float, controls: Vector) -> float:
    """Give the step that the error of an accepted one suggests."""
    if excess > EASY or h < controls[at.TIME_STEP] or h >= h_next:
        return next_step(h, h_next, excess)
    return h_next


class FixedSteps(NamedTuple):
    """Steps of a fixed length."""

    longest: float  # that is stable in the mode

    @inlined
    def step_length(self, asked: float) -> float:
        """Give the length of the next step."""
        return min(asked, self.longest)

    @inlined
    def make_step(
        self, system: Equations, mode: int, count: int, span: Span, ground: Vector, state: Vector,
        first: Vector, new: Vector, last: Vector, stages: Vector, works: Vector,
    ) -> bool:  # fmt: skip
        """Make a step; give whether it has ended in numbers."""
        in_middle, at_end = ground_in(0.5, span, ground), ground_in(1.0, span, ground)
        return fixed_step(
            system, mode, count, span.h, in_middle, at_end, state, first, new, last, stages, works
        )

    @inlined
    def excess_of(
        self, system: Equations, count: int, done: bool, scale: float, new: Vector, works: Vector,
        reference: Vector, controls: Vector,
    ) -> float:  # fmt: skip
        """Give 0, or infinity where the step has not ended in numbers."""
        return 0.0 if done else math.inf

    @inlined
    def step_after(
        self, h: float, asked: float, h_next: float, excess: float, shortest: float,
        controls: Vector,
    ) -> float:  # fmt: skip
        """Give the next step."""
        return rest_of(asked, h, shortest, controls)

    @inlined
    def keep_sizes(self, system: Equations, new: Vector, reference: Vector) -> None:
        """Do nothing: no error is measured."""


class StepsByTolerance(NamedTuple):
    """Steps of the Dormand-Prince pair."""

    longest: float

    @inlined
    def step_length(self, asked: float) -> float:
        """Give the length of the next step."""
        return asked

    @inlined
    def make_step(
        self, system: Equations, mode: int, count: int, span: Span, ground: Vector, state: Vector,
        first: Vector, new: Vector, last: Vector, stages: Vector, works: Vector,
    ) -> bool:  # fmt: skip
        """Make a step; its errors tell whether it has ended in numbers."""
        runge_kutta_step(system, mode, count, span, ground, state, first, new, last, stages, works)
        return True

    @inlined
    def excess_of(
        self, system: Equations, count: int, done: bool, scale: float, new: Vector, works: Vector,
        reference: Vector, controls: Vector,
    ) -> float:  # fmt: skip
        """Give the largest error over the error allowed."""
        return excess_error(system, count, works[2] / scale, new, works, reference, controls)

    @inlined
    def step_after(
        self, h: float, asked: float, h_next: float, excess: float, shortest: float,
        controls: Vector,
    ) -> float:  # fmt: skip
        """Give the next step."""
        return adapted(h, h_next, excess, controls)

    @inlined
    def keep_sizes(self, system: Equations, new: Vector, reference: Vector) -> None:
        """Raise the largest size so far of each variable."""
        for i in range(2 * system.coordinates() + system.variables()):
            reference[i] = max(reference[i], abs(new[i]))
