"""Two ways to step: with a fixed length, and by a tolerance; what differs between them."""

import math
from typing import NamedTuple

from rockframe.compiled import Vector, inlined
from rockframe.dynamics.protocol import Equations
from rockframe.solve import layout as at
from rockframe.solve.dormand_prince import runge_kutta_step
from rockframe.solve.fixed_step import fixed_step
from rockframe.solve.ground import ground_in
from rockframe.solve.step_control import EASY, excess_error, next_step
from rockframe.solve.workspace import Span


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
