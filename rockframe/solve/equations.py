"""A system's equations as the integrator calls them: functions of arrays, of fixed types.

One integrator, compiled once, thus serves every system: it knows these functions by their
addresses, and the system's numbers as a vector. The loop of steps, too, can call the equations by
their addresses, or is compiled for a structure of systems, with the equations in it.
"""

import math
from typing import NamedTuple

from rockframe.compiled import (
    COMPILED,
    Bound,
    Vector,
    bound,
    inlined,
    is_worth_calling,
    kernel,
    numbers_in,
    put,
)
from rockframe.dynamics.protocol import CalledBySteps, Equations, Ground
from rockframe.solve.accuracy import STABLE
from rockframe.solve.evaluation import ByAddress, Called, CompiledIn, guards_at, powered, slope
from rockframe.solve.march import march_by_tolerance, march_fixed, march_fixed_by_rates
from rockframe.solve.workspace import KnownMode, Pieces, Progress, StepTable, Workspace


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


class BoundEquations(NamedTuple):
    """The bound functions of a system, its numbers, and its sizes.

    Two processes compile the functions, from the first and from the last on. Functions that are
    called at events only are compiled when that pays.
    """

    stepping: Bound  # the loop of steps
    slope: Bound
    powering: Bound  # powers of a slope at other rates; the slope where the loop needs none
    observing: Bound
    guarding: Bound
    switching: Bound
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
        called = Called(
            self.slope, self.powering, self.guarding, self.coordinate_count, self.variable_count,
            self.guard_count, self.numbers,
        )  # fmt: skip
        return self.stepping.call(
            called, known, trial, pieces, progress, steps, w.of_steps(), self.numbers
        )


def gives_powers(system: Equations) -> bool:
    """Whether equations are :class:`rockframe.dynamics.protocol.EquationsWithPowers`."""
    return hasattr(system, "powers")


def is_called(system: Equations) -> bool:
    """Whether equations are always called by steps, as they are too long to compile into them."""
    return isinstance(system, CalledBySteps)


def equations_of(
    system: Equations,
    *,
    fixed_steps: bool,
    with_work: bool = False,
    compiled_in: bool | None = None,
) -> BoundEquations:
    """Bind a system's equations for the integrator.

    `compiled_in` tells whether the equations are compiled into the loop of steps; with None they
    are as soon as runs have taken so long that this pays. For work at the output times
    (`with_work`) slopes are evaluated so often that they are compiled.
    """
    march = march_by_tolerance
    if fixed_steps:
        march = march_fixed_by_rates if gives_powers(system) else march_fixed
    own = None if is_called(system) else bound((march,), CompiledIn(system))[0]
    if own is not None and (is_worth_calling(own) if compiled_in is None else compiled_in):
        stepping, powering = own, []
        (observing,) = bound((observed,), system)
        (sloping,) = bound((slope,), system, seldom=not (fixed_steps or with_work))
        (guarding,) = bound((guards_at,), system, seldom=True)
    else:
        (stepping,) = bound((march,), ByAddress(), stands_for=own)
        apart = [powered] if march is march_fixed_by_rates else []
        sloping, guarding, observing, *powering = bound(
            (slope, guards_at, observed, *apart), system
        )
    switching, stored, meant = bound((switched, energies, meaning), system, seldom=True)
    return BoundEquations(
        stepping=stepping,
        slope=sloping,
        powering=powering[0] if powering else sloping,
        observing=observing,
        guarding=guarding,
        switching=switching,
        stored=stored,
        meaning=meant,
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
    """Let the next run compile all functions: for measuring times."""
    for one in equations:
        if isinstance(one, Bound):
            one.source.seconds_without = math.inf


def steps_as_machine_code(equations: BoundEquations) -> bool:
    """Whether the functions that steps call are compiled."""
    bounds = (one for one in equations if isinstance(one, Bound))
    return all(one.source.address or one.source.is_seldom_called for one in bounds)


@inlined
def known_mode(equations: BoundEquations, mode: int, room: Vector) -> KnownMode:
    """Unpack a mode; `room` is scratch for three numbers."""
    equations.meaning.call(mode, room, equations.numbers)
    longest = STABLE / room[2] if room[2] > 0.0 else math.inf
    return KnownMode(mode, int(room[0]), int(room[1]), longest)
