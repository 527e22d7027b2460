"""How steps evaluate the equations of a system: compiled into their loop, or called from it.

Both ways give the same numbers to the last bit. The loop into which equations are compiled is the
faster one, by a fifth, but is compiled for each structure of systems and takes seconds to compile.
"""

from typing import Annotated, Any, NamedTuple

from rockframe.compiled import BoundFunction, Vector, inlined, kernel, put, view_from
from rockframe.dynamics.protocol import Equations, EquationsWithPowers, Ground, Guards, Slope
from rockframe.solve.workspace import LEFT_LIMIT, RIGHT_LIMIT, WEIGHTS


@kernel
def evaluate_slope(
    system: Equations, mode: int, state: Vector, ground_x: float, ground_y: float, out: Vector
) -> None:
    """Write accelerations, rates of variables of first order, and powers."""
    put(system.accelerate(mode, state, Ground(ground_x, ground_y)), 0, out)


@kernel
def evaluate_powers(
    system: EquationsWithPowers, mode: int, state: Vector, ground_x: float, ground_y: float,
    out: Vector,
) -> None:  # fmt: skip
    """Write the powers of a state into a slope at the same coordinates but other rates."""
    powers = system.coordinates() + system.variables()
    values = system.powers(mode, state, out, Ground(ground_x, ground_y))
    out[powers], out[powers + 1] = values


@inlined
def evaluate_guards(
    system: Equations, mode: int, state: Vector, slope: Vector, ground_x: float, ground_y: float,
    limits: Vector, out: Vector,
) -> None:  # fmt: skip
    """Write the guards of a state as :func:`put_guards`, with the nearest limit of all bodies."""
    guards = system.guards_in(mode, state, slope, Ground(ground_x, ground_y))
    put_guards(system, guards, state, limits, out)
    size, last = system.coordinates(), system.guards()
    row = WEIGHTS + size
    while row < len(limits):
        rotation = rate = 0.0
        for i in range(size):
            rotation += limits[row + WEIGHTS + i] * state[i]
            rate += limits[row + WEIGHTS + i] * state[size + i]
        left = rotation <= 0.0
        distance = (
            limits[row + LEFT_LIMIT] + rotation if left else limits[row + RIGHT_LIMIT] - rotation
        )
        if distance < out[last]:
            out[last], out[2 * last + 1] = distance, rate if left else -rate
        row += WEIGHTS + size


@inlined
def put_guards(
    system: Equations, guards: Guards, state: Vector, limits: Vector, out: Vector
) -> None:
    """Write guards, then their rates; the last guard is how far the rotation is from its limit."""
    size, last = system.coordinates(), system.guards()
    rotation = rate = 0.0
    for i in range(size):
        rotation += limits[WEIGHTS + i] * state[i]
        rate += limits[WEIGHTS + i] * state[size + i]
    left = rotation <= 0.0
    put(guards.values, 0, out)
    put(guards.changes, last + 1, out)
    out[last] = limits[LEFT_LIMIT] + rotation if left else limits[RIGHT_LIMIT] - rotation
    out[2 * last + 1] = rate if left else -rate


class InlinedEquations(NamedTuple):
    """Equations that are compiled into the loop of steps."""

    system: Any

    @inlined
    def resolved(self, called: "CalledEquations") -> "InlinedEquations":
        """Return these equations, not those called by their addresses."""
        return self

    @inlined
    def coordinates(self) -> int:
        """Return the number of coordinates."""
        return self.system.coordinates()

    @inlined
    def variables(self) -> int:
        """Return the number of variables of first order."""
        return self.system.variables()

    @inlined
    def guards(self) -> int:
        """Return the number of guards."""
        return self.system.guards()

    @inlined
    def write_slope(
        self, mode: int, state: Vector, ground: Ground, first: int, out: Vector
    ) -> None:
        """Write accelerations, rates of variables and powers, from an index on."""
        put(self.system.accelerate(mode, state, ground), first, out)

    @inlined
    def write_guards(
        self, mode: int, state: Vector, slope: Vector, ground: Ground, limits: Vector, out: Vector
    ) -> None:
        """Write guards, then their rates, see :func:`evaluate_guards`."""
        evaluate_guards(self.system, mode, state, slope, ground.x, ground.y, limits, out)

    @inlined
    def powers(self, mode: int, state: Vector, slope: Slope, ground: Ground) -> tuple[float, float]:
        """Return the powers of a state whose slope at other rates is known."""
        return self.system.powers(mode, state, slope, ground)


class CalledEquations(NamedTuple):
    """The equations of a system, which the loop of steps calls by their addresses."""

    slope: Annotated[BoundFunction, evaluate_slope]
    bound_powers: Annotated[BoundFunction, evaluate_powers]
    bound_guards: Annotated[BoundFunction, evaluate_guards]
    coordinate_count: int
    variable_count: int
    guard_count: int
    numbers: Vector

    @inlined
    def coordinates(self) -> int:
        """Return the number of coordinates."""
        return self.coordinate_count

    @inlined
    def variables(self) -> int:
        """Return the number of variables of first order."""
        return self.variable_count

    @inlined
    def guards(self) -> int:
        """Return the number of guards."""
        return self.guard_count

    @inlined
    def write_slope(
        self, mode: int, state: Vector, ground: Ground, first: int, out: Vector
    ) -> None:
        """Write accelerations, rates of variables and powers, from an index on."""
        self.slope.call(mode, state, ground.x, ground.y, view_from(out, first), self.numbers)

    @inlined
    def write_guards(
        self, mode: int, state: Vector, slope: Vector, ground: Ground, limits: Vector, out: Vector
    ) -> None:
        """Write guards, then their rates, see :func:`evaluate_guards`."""
        self.bound_guards.call(mode, state, slope, ground.x, ground.y, limits, out, self.numbers)

    @inlined
    def powers(self, mode: int, state: Vector, slope: Slope, ground: Ground) -> tuple[float, float]:
        """Write the powers at the rates of a state into a slope, and return them."""
        powers = self.coordinate_count + self.variable_count
        self.bound_powers.call(mode, state, ground.x, ground.y, slope, self.numbers)
        return slope[powers], slope[powers + 1]


class EquationsByAddress(NamedTuple):
    """Stand for equations that the loop of steps calls by their addresses."""

    unused: float = 0.0  # numba cannot call methods of empty tuples

    @inlined
    def resolved(self, called: CalledEquations) -> CalledEquations:
        """Return the equations that are called by their addresses."""
        return called
