"""A system's equations as the integrator calls them: functions of arrays, of fixed types.

So one integrator, compiled once, serves every system: it knows these functions by their
addresses, and the system's numbers as a vector.
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
    put,
)
from rockframe.dynamics.protocol import Equations, Ground
from rockframe.solve.accuracy import STABLE
from rockframe.solve.march import (
    guards_at,
    march_by_tolerance,
    march_fixed,
    march_fixed_by_rates,
)


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
    """Carry out what the fall of a guard calls for; give the new mode."""
    return system.switch(mode, guard, state, Ground(ground_x, ground_y), memory)


@kernel
def meaning(system: Equations, mode: int, out: Vector) -> None:
    """Write how many coordinates move in a mode, the contact state, and a rate of decay."""
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
    """A system, bound: its functions, its numbers, and how many there are of everything.

    Two processes compile the functions from both ends; the march is half of it. What is called at
    events only is compiled when it is worth it.
    """

    march: Bound
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


def gives_powers(system: Equations) -> bool:
    """Whether equations are :class:`rockframe.dynamics.protocol.EquationsWithPowers`."""
    return hasattr(system, "powers")


def equations_of(
    system: Equations, *, fixed_steps: bool, with_work: bool = False
) -> BoundEquations:
    """Bind a system's equations for the integrator; work at outputs is found from many slopes."""
    march = march_by_tolerance
    if fixed_steps:
        march = march_fixed_by_rates if gives_powers(system) else march_fixed
    moving, observing = bound((march, observed), system)
    (sloping,) = bound((slope,), system, seldom=not (fixed_steps or with_work))
    at_events = bound((switched, guards_at, energies, meaning), system, seldom=True)
    return BoundEquations(
        moving,
        sloping,
        observing,
        *at_events,  # type: ignore[call-arg]
        numbers=numbers_in(system),
        coordinate_count=system.coordinates(),
        variable_count=system.variables(),
        guard_count=system.guards(),
    )


def runs_as_python(equations: BoundEquations) -> bool:
    """Whether runs of a system are those of plain Python: its equations could not be compiled."""
    return not COMPILED or any(one.source.failed for one in equations if isinstance(one, Bound))


def has_machine_code(equations: BoundEquations) -> bool:
    """Whether the functions of a system are there as machine code, those called at events too."""
    return all(one.source.address for one in equations if isinstance(one, Bound))


def call_nothing_back(equations: BoundEquations) -> None:
    """Have what is called at events compiled as well, with the next run: one that is timed."""
    for one in equations:
        if isinstance(one, Bound):
            one.source.seconds_called_back = math.inf


def steps_as_machine_code(equations: BoundEquations) -> bool:
    """Whether what each step calls is there as machine code."""
    return bool(equations.march.source.address)


class KnownMode(NamedTuple):
    """A mode, and what it means for steps: asked for when it begins, and kept as long as it lasts.

    The contact state is that of the body that the scene is about.
    """

    mode: int
    moving: int  # leading coordinates that move
    contact: int  # rockframe.dynamics.events.ContactState
    longest: float  # stable fixed step, where that is not for vibrations [s]


@inlined
def known_mode(equations: BoundEquations, mode: int, room: Vector) -> KnownMode:
    """Ask what a mode means; `room` is for three numbers."""
    equations.meaning.call(mode, room, equations.numbers)
    longest = STABLE / room[2] if room[2] > 0.0 else math.inf
    return KnownMode(mode, int(room[0]), int(room[1]), longest)
