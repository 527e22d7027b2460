"""A system's equations as the integrator calls them: functions of arrays, of fixed types.

One integrator, compiled once, thus serves every system: it knows these functions by their
addresses, and the system's numbers as a vector. Most equations are compiled into the loop of
steps. Equations that take long to compile and to evaluate are called from that loop instead, which
hardly delays them.
"""

import math
from typing import NamedTuple

from rockframe.compiled import (
    COMPILED,
    Bound,
    Vector,
    bound,
    inlined,
    kernel,
    numbers_in,
    part_of,
    put,
)
from rockframe.dynamics.protocol import (
    CalledBySteps,
    Equations,
    EquationsWithPowers,
    Ground,
    Slope,
)
from rockframe.solve.accuracy import STABLE
from rockframe.solve.march import (
    guards_at,
    march,
    march_by_tolerance,
    march_fixed,
    march_fixed_by_rates,
)
from rockframe.solve.schemes import FixedStepsByRates, StepsByTolerance
from rockframe.solve.workspace import KnownMode, Pieces, Progress, StepTable, Workspace


@kernel
def slope(
    system: Equations, mode: int, state: Vector, ground_x: float, ground_y: float, out: Vector
) -> None:
    """Write accelerations, rates of variables of first order, and powers."""
    put(system.accelerate(mode, state, Ground(ground_x, ground_y)), 0, out)


@kernel
def switched(
    system: Equations, mode: int, guard: int, state: Vector, ground_x: float, ground_y: float,
    memory: Vector,
) -> int:  # fmt: skip
    """Carry out the event of a guard that has fallen through zero; return the new mode."""
    return system.switch(mode, guard, state, Ground(ground_x, ground_y), memory)


@kernel
def meaning(system: Equations, mode: int, out: Vector) -> None:
    """Write how many coordinates move in a mode, the contact state, and the rate of relaxation."""
    out[0] = system.moving_in(mode)
    out[1] = system.contact_state_of(mode, 0)
    out[2] = system.relaxation_in(mode)


@kernel
def energies(system: Equations, mode: int, state: Vector, out: Vector) -> None:
    """Write the energies of a state."""
    put(system.energies(mode, state), 0, out)


@kernel
def observed(
    system: Equations, mode: int, state: Vector, slope: Vector, ground_x: float, ground_y: float,
    memory: Vector, out: Vector,
) -> None:  # fmt: skip
    """Write the columns of a state."""
    put(system.observe(mode, state, slope, Ground(ground_x, ground_y), memory), 0, out)


@kernel
def powered(
    system: EquationsWithPowers, mode: int, state: Vector, ground_x: float, ground_y: float,
    out: Vector,
) -> None:  # fmt: skip
    """Write the powers of a state into a slope at the same coordinates but other rates."""
    powers = system.coordinates() + system.variables()
    found = system.powers(mode, state, out, Ground(ground_x, ground_y))
    out[powers], out[powers + 1] = found


class BoundEquations(NamedTuple):
    """The bound functions of a system, its numbers, and its sizes.

    Two processes compile the functions, one from the first, one from the last; the march takes
    half of the time. Functions that are called at events only are compiled when that pays.
    """

    stepping: Bound  # the march, with the equations compiled into it
    slope: Bound
    observing: Bound
    switching: Bound
    guarding: Bound
    stored: Bound
    meaning: Bound
    numbers: Vector
    coordinate_count: int
    variable_count: int
    guard_count: int

    @inlined
    def make_steps(
        self, known: KnownMode, trial: float, pieces: Pieces, progress: Progress, steps: StepTable,
        w: Workspace,
    ) -> int:  # fmt: skip
        """Make steps until something happens, or try one; see :mod:`rockframe.solve.march`."""
        return self.stepping.call(known, trial, pieces, progress, steps, w.of_steps(), self.numbers)


class CalledByTolerance(BoundEquations):
    """Equations called from steps by a tolerance; `stepping` is the slope here."""

    __slots__ = ()

    @kernel
    def make_steps(
        self, known: KnownMode, trial: float, pieces: Pieces, progress: Progress, steps: StepTable,
        w: Workspace,
    ) -> int:  # fmt: skip
        """Make steps until something happens, or try one."""
        scheme = StepsByTolerance(math.inf)
        return march(scheme, Called(self), known, trial, pieces, progress, steps, w.of_steps())


class CalledInFixedSteps(BoundEquations):
    """Equations called from steps of fixed length; `stepping` writes powers into a slope here."""

    __slots__ = ()

    @kernel
    def make_steps(
        self, known: KnownMode, trial: float, pieces: Pieces, progress: Progress, steps: StepTable,
        w: Workspace,
    ) -> int:  # fmt: skip
        """Make steps until something happens, or try one."""
        scheme = FixedStepsByRates(known.longest)
        return march(scheme, Called(self), known, trial, pieces, progress, steps, w.of_steps())


class Called(NamedTuple):
    """Equations as the loop of steps calls them, one by one."""

    equations: BoundEquations

    @inlined
    def coordinates(self) -> int:
        """Return the number of coordinates."""
        return self.equations.coordinate_count

    @inlined
    def variables(self) -> int:
        """Return the number of variables of first order."""
        return self.equations.variable_count

    @inlined
    def guards(self) -> int:
        """Return the number of guards."""
        return self.equations.guard_count

    @inlined
    def write_slope(
        self, mode: int, state: Vector, ground: Ground, first: int, out: Vector
    ) -> None:
        """Write accelerations, rates of variables and powers, from an index on."""
        one = self.equations
        one.slope.call(mode, state, ground.x, ground.y, part_of(out, first), one.numbers)

    @inlined
    def write_guards(
        self, mode: int, state: Vector, slope: Vector, ground: Ground, limits: Vector, out: Vector
    ) -> None:
        """Write guards, then their rates."""
        one = self.equations
        one.guarding.call(mode, state, slope, ground.x, ground.y, limits, out, one.numbers)

    @inlined
    def powers(self, mode: int, state: Vector, slope: Slope, ground: Ground) -> tuple[float, float]:
        """Write the powers at the rates of a state into a slope, and return them."""
        one = self.equations
        powers = one.coordinate_count + one.variable_count
        one.stepping.call(mode, state, ground.x, ground.y, slope, one.numbers)
        return slope[powers], slope[powers + 1]


def gives_powers(system: Equations) -> bool:
    """Whether equations are :class:`rockframe.dynamics.protocol.EquationsWithPowers`."""
    return hasattr(system, "powers")


def is_called(system: Equations) -> bool:
    """Whether equations are called from the loop of steps; such equations give powers, too."""
    return isinstance(system, CalledBySteps)


def equations_of(
    system: Equations, *, fixed_steps: bool, with_work: bool = False
) -> BoundEquations:
    """Bind a system's equations for the integrator.

    For work at the output times (`with_work`) slopes are evaluated so often that they are compiled.
    """
    kind: type[BoundEquations] = BoundEquations
    if is_called(system):
        kind = CalledInFixedSteps if fixed_steps else CalledByTolerance
        sloping, guarding, observing, *powering = bound(
            (slope, guards_at, observed, *([powered] if fixed_steps else [])), system
        )
        (stepping,) = powering or [sloping]
        switching, *rest = bound((switched, energies, meaning), system, seldom=True)
    else:
        steps = march_by_tolerance
        if fixed_steps:
            steps = march_fixed_by_rates if gives_powers(system) else march_fixed
        stepping, observing = bound((steps, observed), system)
        (sloping,) = bound((slope,), system, seldom=not (fixed_steps or with_work))
        switching, guarding, *rest = bound(
            (switched, guards_at, energies, meaning), system, seldom=True
        )
    return kind(
        stepping,
        sloping,
        observing,
        switching,
        guarding,
        *rest,  # type: ignore[call-arg]
        numbers=numbers_in(system),
        coordinate_count=system.coordinates(),
        variable_count=system.variables(),
        guard_count=system.guards(),
    )


def runs_as_python(equations: BoundEquations) -> bool:
    """Whether a system runs as plain Python, as nothing is compiled or its equations cannot be."""
    return not COMPILED or any(one.source.failed for one in equations if isinstance(one, Bound))


def has_machine_code(equations: BoundEquations) -> bool:
    """Whether all functions of a system are compiled, those called at events too."""
    return all(one.source.address for one in equations if isinstance(one, Bound))


def call_nothing_back(equations: BoundEquations) -> None:
    """Let the next run compile the functions called at events, too: for measuring times."""
    for one in equations:
        if isinstance(one, Bound):
            one.source.seconds_called_back = math.inf


def steps_as_machine_code(equations: BoundEquations) -> bool:
    """Whether the functions that steps call are compiled."""
    return bool(equations.stepping.source.address)


@inlined
def known_mode(equations: BoundEquations, mode: int, room: Vector) -> KnownMode:
    """Unpack a mode; `room` is scratch for three numbers."""
    equations.meaning.call(mode, room, equations.numbers)
    longest = STABLE / room[2] if room[2] > 0.0 else math.inf
    return KnownMode(mode, int(room[0]), int(room[1]), longest)
