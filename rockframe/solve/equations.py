"""A system's equations as the integrator calls them: functions of arrays, of fixed types.

One integrator, compiled once, thus serves every system: it knows these functions by their
addresses, and the system's numbers as a vector. The loop of steps, too, can call the equations by
their addresses, or is compiled for a structure of systems, with the equations in it.
"""

import math
from typing import NamedTuple

from rockframe.compiled import (
    COMPILED,
    BoundFunction,
    Vector,
    bind,
    inlined,
    is_worth_calling,
    kernel,
    numbers_in,
    put,
)
from rockframe.dynamics.protocol import CalledBySteps, Equations, Ground
from rockframe.solve.accuracy import STABILITY_LIMIT
from rockframe.solve.evaluation import (
    CalledEquations,
    EquationsByAddress,
    InlinedEquations,
    evaluate_guards,
    evaluate_powers,
    evaluate_slope,
)
from rockframe.solve.march import march_by_tolerance, march_fixed, march_fixed_by_rates
from rockframe.solve.workspace import (
    Pieces,
    Progress,
    StepArrays,
    StepTable,
    UnpackedMode,
    Workspace,
)


@kernel
def switch_at_event(
    system: Equations, mode: int, guard: int, state: Vector, ground_x: float, ground_y: float,
    memory: Vector,
) -> int:  # fmt: skip
    """Carry out the event of a guard that has fallen through zero; return the new mode."""
    return system.switch(mode, guard, state, Ground(ground_x, ground_y), memory)


@kernel
def mode_properties(system: Equations, mode: int, out: Vector) -> None:
    """Write how many coordinates move in a mode, the contact state, and the rate of relaxation."""
    out[0] = system.moving_in(mode)
    out[1] = system.contact_state_of(mode, 0)
    out[2] = system.relaxation_in(mode)


@kernel
def evaluate_energies(system: Equations, mode: int, state: Vector, out: Vector) -> None:
    """Write the energies of a state."""
    put(system.energies(mode, state), 0, out)


@kernel
def evaluate_columns(
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

    march: BoundFunction  # the loop of steps
    slope: BoundFunction
    powers: BoundFunction  # powers of a slope at other rates; the slope where the loop needs none
    columns: BoundFunction
    guards: BoundFunction
    switch: BoundFunction
    energies: BoundFunction
    mode_properties: BoundFunction
    numbers: Vector
    coordinate_count: int
    variable_count: int
    guard_count: int

    @inlined
    def make_steps(
        self, unpacked: UnpackedMode, trial: float, pieces: Pieces, progress: Progress,
        steps: StepTable, w: Workspace,
    ) -> int:  # fmt: skip
        """Make steps until something happens, or try one; see :mod:`rockframe.solve.march`."""
        called = CalledEquations(
            self.slope, self.powers, self.guards, self.coordinate_count, self.variable_count,
            self.guard_count, self.numbers,
        )  # fmt: skip
        arrays = StepArrays(w.ends, w.stages, w.works, w.reference, w.limits, w.ground)
        return self.march.call(
            called, unpacked, trial, pieces, progress, steps, arrays, self.numbers
        )


def has_powers(system: Equations) -> bool:
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
    march_kernel = march_by_tolerance
    if fixed_steps:
        march_kernel = march_fixed_by_rates if has_powers(system) else march_fixed
    inlined_march = None
    if not is_called(system):
        (inlined_march,) = bind((march_kernel,), InlinedEquations(system))
    if inlined_march is not None and (
        is_worth_calling(inlined_march) if compiled_in is None else compiled_in
    ):
        march, powers = inlined_march, []
        (columns,) = bind((evaluate_columns,), system)
        (slope,) = bind((evaluate_slope,), system, rarely_called=not (fixed_steps or with_work))
        (guards,) = bind((evaluate_guards,), system, rarely_called=True)
    else:
        (march,) = bind((march_kernel,), EquationsByAddress(), fallback_for=inlined_march)
        powers_kernel = [evaluate_powers] if march_kernel is march_fixed_by_rates else []
        slope, guards, columns, *powers = bind(
            (evaluate_slope, evaluate_guards, evaluate_columns, *powers_kernel), system
        )
    switch, energies, properties = bind(
        (switch_at_event, evaluate_energies, mode_properties), system, rarely_called=True
    )
    return BoundEquations(
        march=march,
        slope=slope,
        powers=powers[0] if powers else slope,
        columns=columns,
        guards=guards,
        switch=switch,
        energies=energies,
        mode_properties=properties,
        numbers=numbers_in(system),
        coordinate_count=system.coordinates(),
        variable_count=system.variables(),
        guard_count=system.guards(),
    )


def _functions(equations: BoundEquations) -> list[BoundFunction]:
    return [function for function in equations if isinstance(function, BoundFunction)]


def runs_as_python(equations: BoundEquations) -> bool:
    """Whether a system runs as plain Python, as nothing is compiled or its equations cannot be."""
    return not COMPILED or any(function.source.failed for function in _functions(equations))


def is_fully_compiled(equations: BoundEquations) -> bool:
    """Whether all functions of a system are compiled, those called at events too."""
    return all(function.source.address for function in _functions(equations))


def compile_in_next_run(equations: BoundEquations) -> None:
    """Let the next run compile all functions: for measuring times."""
    for function in _functions(equations):
        function.source.fallback_seconds = math.inf


def steps_are_compiled(equations: BoundEquations) -> bool:
    """Whether the functions that steps call are compiled."""
    sources = (function.source for function in _functions(equations))
    return all(source.address or source.is_rarely_called for source in sources)


@inlined
def unpack_mode(equations: BoundEquations, mode: int, scratch: Vector) -> UnpackedMode:
    """Unpack a mode; `scratch` holds three numbers."""
    equations.mode_properties.call(mode, scratch, equations.numbers)
    longest = STABILITY_LIMIT / scratch[2] if scratch[2] > 0.0 else math.inf
    return UnpackedMode(mode, int(scratch[0]), int(scratch[1]), longest)
