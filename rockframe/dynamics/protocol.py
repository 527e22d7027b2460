"""The interface between a contact model and the integrator: a system's equations and its sizes.

The integrator knows nothing of blocks, pads or soil. A system is a named tuple of numbers
whose methods are second-order equations ``q'' = f(mode, q, q', z, ground)`` with variables of
first order ``z' = g(...)``, *guards* (functions of the state that are positive as long as the
mode lasts), and a *switch* (what happens when a guard falls through zero).

State vector: n coordinates, their n rates, then the variables of first order. All energies
and powers are per unit mass. Modes are whole numbers, which the system packs and unpacks. There
may be far more modes than occur in a run: a mode is unpacked when it begins.
"""

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Final, NamedTuple, Protocol, TypeAlias

import numpy as np

from rockframe.case_arrays import python_number
from rockframe.compiled import Integers, Vector, inlined, kernel
from rockframe.errors import AssemblyError

Numbers: TypeAlias = tuple[float, ...] | Vector
"""Numbers of a system; in an array where their count is not known when it is compiled."""
Slope: TypeAlias = Numbers
"""Accelerations, rates of the variables of first order, and powers, in this order."""


class Ground(NamedTuple):
    """Acceleration of the ground [m s^-2]."""

    x: float  # to the right
    y: float  # upwards


# Memory: what a system must remember besides its state.
IMPACT_LOSS: Final = 0
"""Index into the memory: energy lost in impacts so far, per unit mass [m^2 s^-2]."""
REPINNING_LOSS: Final = 1
"""Index into the memory: energy lost in changes of the restraint so far [m^2 s^-2]."""
IMPULSIVE_INPUT: Final = 2
"""Index into the memory: work done by jumps of the velocity of what a body stands on so far, per
unit mass [m^2 s^-2]."""
LAST_EVENT: Final = 3
"""Index into the memory: kind of the last switch, see :mod:`rockframe.dynamics.events`."""
LINK_LOSS: Final = 4
"""Index into the memory: energy lost with links that broke so far, per unit mass [m^2 s^-2]."""
HELD_PLACE: Final = 5
"""Index into the memory: horizontal place of the point that holds the first body [m]; the places
for further bodies follow, then whatever else a system remembers."""
MEMORY: Final = (
    "impact_loss", "repinning_loss", "impulsive_input", "last_event", "link_loss", "held_place",
)  # fmt: skip
"""Names of the numbers that every system remembers, in their order."""

MAX_MODES: Final = 2**63 - 1
"""Modes that a system may have: each is a whole number of 64 bits, one of which is its sign."""

POWERS: Final = 2
"""Number of powers at the end of a slope: dissipated by dashpots, and put in by the ground."""


class Energies(NamedTuple):
    """Energies of a state, per unit mass [m^2 s^-2]."""

    kinetic: float
    gravity: float
    elastic: float
    from_rest: float  # elastic energy less the elastic energy at rest


class Guards(NamedTuple):
    """Functions of the state that are positive as long as a mode lasts, and their rates."""

    values: Numbers
    changes: Numbers


class Equations(Protocol):
    """The equations of a scene."""

    def bodies(self) -> int:
        """Return the number of bodies that move on their bases."""
        ...

    def coordinates(self) -> int:
        """Return n, the number of coordinates."""
        ...

    def variables(self) -> int:
        """Return the number of variables of first order."""
        ...

    def guards(self) -> int:
        """Return the number of guards."""
        ...

    def modes(self) -> int:
        """Return the number of modes; not every smaller number need represent a mode."""
        ...

    def moving_in(self, mode: int) -> int:
        """Return the number of leading coordinates that move in a mode.

        If it is 0 and there are no variables of first order, the powers of the mode must be 0.
        """
        ...

    def contact_state_of(self, mode: int, k: int) -> int:
        """Return the :class:`rockframe.dynamics.events.ContactState` of body `k` in a mode.

        Body 0 is the one to which the results refer.
        """
        ...

    def relaxation_in(self, mode: int) -> float:
        """Return the rate at which a constraint of a mode decays, 0 where there is none [s^-1].

        Fixed steps must be short compared with the inverse of this rate.
        """
        ...

    def accelerate(self, mode: int, state: Vector, ground: Ground) -> Numbers:
        """Return accelerations, rates of the variables of first order, and two powers.

        The powers are the one dissipated and the one put in by the ground. Values in the state of
        coordinates that do not move in the mode must not be used.
        """
        ...

    def guards_in(self, mode: int, state: Vector, slope: Slope, ground: Ground) -> Guards:
        """Return the guards, each positive as long as it calls for no switch, and their rates.

        `slope` is what :meth:`accelerate` gave for the state.
        """
        ...

    def some_end_slides(self, mode: int) -> bool:
        """Whether an end slides in a mode."""
        ...

    def without_sliding(self, mode: int) -> int:
        """Return a mode without its sliding: code that only sliding needs is not compiled then."""
        ...

    def switch(self, mode: int, guard: int, state: Vector, ground: Ground, memory: Vector) -> int:
        """Carry out the event of a guard that has fallen through zero; return the new mode.

        Changes the state where it jumps, and writes losses and the kind of event to the memory.
        """
        ...

    def energies(self, mode: int, state: Vector) -> Energies:
        """Return the energies of a state."""
        ...

    def observe(
        self, mode: int, state: Vector, slope: Slope, ground: Ground, memory: Vector
    ) -> Numbers:
        """Return the columns that the model names; `slope` is what :meth:`accelerate` gave."""
        ...


class EquationsWithPowers(Equations, Protocol):
    """Equations with separate powers, for works as accurate as the motion in fixed steps.

    The rates of a stage are not those of the solution, :eq:`eq-fixed-powers`, and the work of the
    ground is linear in them. A system should have `powers` where they cost little.
    """

    def powers(self, mode: int, state: Vector, slope: Slope, ground: Ground) -> tuple[float, float]:
        """Return the power dissipated and the power put in by the ground [m^2 s^-3].

        `slope` is what :meth:`accelerate` has just returned for the same coordinates, other rates.
        """
        ...


class CalledBySteps:
    """Equations so long that it never pays to compile them into the steps, which call them.

    They have the method `powers` of :class:`EquationsWithPowers`. A mixin of named tuples.
    """

    __slots__ = ()


class OnRigidGround:
    """Methods that all systems of one body on rigid ground share. A mixin of named tuples."""

    __slots__ = ()

    @inlined
    def bodies(self) -> int:
        """Return 1, the number of bodies."""
        return 1

    @kernel
    def variables(self) -> int:
        """Return 0: rigid ground has no variables of first order."""
        return 0

    @inlined
    def relaxation_in(self, mode: int) -> float:
        """Return 0: no constraint decays."""
        return 0.0

    @kernel
    def some_end_slides(self, mode: int) -> bool:
        """Return False: only ends on springs slide in this sense, and there are none."""
        return False

    @inlined
    def without_sliding(self, mode: int) -> int:
        """Return the mode itself."""
        return mode


@dataclass(frozen=True)
class Column:
    """A history that a system gives, a column of the results.

    Parameters
    ----------
    name : str
        Name in the results' schema.
    per_mass : bool
        Whether the system gives it per unit mass, so that results multiply it by a mass.
    mass_ratio : float
        That mass over the mass of the model [1].
    """

    name: str
    per_mass: bool = False
    mass_ratio: float = 1.0


BODY_COLUMNS: Final = (
    Column("rotation"),
    Column("angular_velocity"),
    Column("vertical_displacement"),
    Column("vertical_velocity"),
    Column("horizontal_displacement"),
    Column("base_shear", per_mass=True),
    Column("horizontal_velocity"),
    Column("angular_acceleration"),
    Column("horizontal_acceleration"),
    Column("vertical_acceleration"),
    Column("horizontal_reaction", per_mass=True),
    Column("vertical_reaction", per_mass=True),
)
"""Columns that every system returns of body 0, to which the results refer, in this order.

Velocities and accelerations are those of the centre of mass, relative to the ground; the
reactions are those of the body's own base, along and normal to the surface that it stands on.
"""
CORNER_REACTIONS: Final = (
    Column("left_reaction", per_mass=True),
    Column("right_reaction", per_mass=True),
)
"""Columns of bases that bear at two corners."""
BODY_FORCES: Final = ("base_shear", "horizontal_reaction", "vertical_reaction")
"""The columns from which the friction that a body needs follows."""


def column_of(name: str, body: int) -> str:
    """Return the name that a column has for a body of some number; body 0 has the plain name."""
    return name if body == 0 else f"{name}_of_{body}"


@dataclass(frozen=True)
class Start:
    """Where a run starts, in SI units.

    Parameters
    ----------
    rotation : float or None
        Rotation of the block; None for its rotation at rest [rad].
    angular_velocity : float
        Rate of the rotation [rad s^-1].
    vertical_displacement : float or None
        Displacement of the centre of mass; None for vertical equilibrium [m].
    vertical_velocity : float
        Velocity of the centre of mass [m s^-1].
    """

    rotation: float | None = None
    angular_velocity: float = 0.0
    vertical_displacement: float | None = None
    vertical_velocity: float = 0.0


@dataclass(frozen=True)
class Ending:
    """Where a run ended, so that another can continue from there."""

    mode: int  # of the model
    state: Vector  # as the system has it
    memory: Vector  # the system's memory


@dataclass(frozen=True, kw_only=True)
class ContactModel:
    """A scene's equations, ready for the integrator.

    Parameters
    ----------
    name : str
        Name of the model.
    system : Equations
        The equations: a named tuple of SI floats, per unit mass.
    rotation_limits : tuple of float
        Rotations to the left and to the right at which the run stops or is marked [rad].
    rotation_weights : ndarray, shape (n,)
        The block's rotation as a sum of coordinates.
    contacts : tuple of str
        Names, in the results' schema, of the contact states of the first bodies.
    shows_bodies : bool
        Whether results have the motion of each body.
    links : int
        How many links of bodies results show.
    selects : bool
        Whether results show only some of the columns.
    other_limits : ndarray, shape (others * (2 + n),)
        For each further body that may overturn: its limits to the left and to the right [rad], and
        the weights of the coordinates in its rotation.
    scales : ndarray, shape (2 n + variables,)
        Typical size of each element of the state.
    guard_tolerance : ndarray, shape (guards,)
        Rounding noise of each guard.
    columns : tuple of Column
        What `observe` gives.
    memory : tuple of str
        Names of the numbers that the system remembers.
    mass : float
        Reference mass, by which energies per unit mass become joules [kg].
    fastest_frequency : float
        Highest angular frequency of the model [rad s^-1].
    damping_rate : float
        Upper bound of 2 xi omega of its vibrations [s^-1].
    energy_scale : float
        Typical energy per unit mass, from which rounding noise is estimated [m^2 s^-2].
    initial : callable
        ``initial(start) -> (mode, state, memory)``.
    rounding : callable or None
        ``rounding(rotation)``: rounding noise of each element of the state in one step about a
        rotation, where the model's forces are differences of large terms.

    Raises
    ------
    AssemblyError
        There are more modes than whole numbers for them.
    """

    name: str
    system: Equations
    rotation_limits: tuple[float, float]
    rotation_weights: Vector
    scales: Vector
    guard_tolerance: Vector
    columns: tuple[Column, ...]
    memory: tuple[str, ...] = MEMORY
    mass: float
    fastest_frequency: float
    damping_rate: float
    energy_scale: float
    initial: Callable[[Start], tuple[int, Vector, Vector]]
    rounding: Callable[[float], Vector] | None = None
    contacts: tuple[str, ...] = ("contact_state",)
    shows_bodies: bool = False
    links: int = 0
    selects: bool = False
    other_limits: Vector = field(default_factory=lambda: np.zeros(0))

    def __post_init__(self) -> None:
        count = self.system.modes()
        if count > MAX_MODES:
            msg = (
                f"the contacts of its bases give the scene {count:.3g} modes, more than the "
                f"{MAX_MODES:.3g} that can be numbered: give a base of your own fewer contacts"
            )
            raise AssemblyError([msg])

    def moving(self, modes: Integers) -> Integers:
        """Return how many leading coordinates move in each of some modes."""
        return _of_each(self.system.moving_in, modes)

    def contact_states(self, modes: Integers, body: int = 0) -> Integers:
        """Return the contact state of a body in each of some modes."""
        return _of_each(lambda mode: self.system.contact_state_of(mode, body), modes)

    def rotation_in(self, state: Vector) -> float:
        """Return the block's rotation in a state [rad]."""
        return python_number(self.rotation_weights @ state[: len(self.rotation_weights)])

    def other_share_in(self, state: Vector) -> float:
        """Return the largest ratio of another body's rotation to its limit; 0 without one [1]."""
        size = len(self.rotation_weights)
        share = 0.0
        for left, right, *weights in self.other_limits.reshape(-1, 2 + size).tolist():
            rotation = float(np.dot(weights, state[:size]))
            share = max(share, -rotation / left, rotation / right)
        return share


def _of_each(function: Callable[[int], int], modes: Integers) -> Integers:
    """Apply a function to modes, once to each different mode: most last for many samples."""
    differs = np.ones(len(modes) + 1, dtype=np.bool_)  # at both ends, too
    np.not_equal(modes[1:], modes[:-1], out=differs[1:-1])
    changes = np.flatnonzero(differs)
    runs = modes[changes[:-1]].tolist()
    results = {mode: function(mode) for mode in set(runs)}
    numbers = np.array([results[mode] for mode in runs], dtype=np.int64)
    return np.repeat(numbers, changes[1:] - changes[:-1])
