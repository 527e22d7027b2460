"""What a contact model is to the integrator: five functions, a few tables and numbers.

The integrator knows nothing of blocks, pads or soil. A model describes itself
by second-order equations ``q'' = f(contact mode, q, q', ground)``, by *guards*
(functions of the state that stay positive as long as the mode lasts) and by a
*switch* (what happens when a guard falls through zero).

State vector: ``state[:n]`` holds the coordinates, ``state[n:]`` their rates.
All energies and powers are per unit mass. Modes are small integers private to
the model; ``contact`` maps them to the contact states users see.
"""

import sys
from collections.abc import Callable
from dataclasses import dataclass
from enum import IntEnum
from typing import Final

from rockframe.compiled import Integers, Signature, Vector

ACCELERATE: Final = Signature("none", "integer", "vector", "real", "real", "vector", "vector")
"""accelerate(mode, state, ground_x, ground_y, parameters, out): accelerations of
the coordinates, then the power burnt by dashpots and the power put in by the ground.
Coordinates that do not move in the mode are not to be read."""

GUARD: Final = Signature("none", "integer", "vector", "vector", "real", "real", "vector", "vector")
"""guard(mode, state, accelerations, ground_x, ground_y, parameters, out): values of
the guards (positive: no switch), then their rates. The last guard is the distance
of the rotation from ``parameters[ROTATION_LIMIT]``."""

SWITCH: Final = Signature(
    "integer", "integer", "integer", "vector", "real", "real", "vector", "vector"
)
"""switch(mode, guard, state, ground_x, ground_y, parameters, memory) -> new mode.
Changes the state where it jumps and keeps the books in `memory`."""

ENERGY: Final = Signature("none", "integer", "vector", "vector", "vector")
"""energy(mode, state, parameters, out): kinetic, gravity, elastic, and elastic less
that at rest."""

OBSERVE: Final = Signature(
    "none", "integer", "vector", "vector", "real", "real", "vector", "vector"
)
"""observe(mode, state, memory, ground_x, ground_y, parameters, out): the columns
that the model names in ``columns``."""

ROTATION_LIMIT: Final = 0
"""Index into the parameters: rotation at which the run stops or is marked [rad]."""

# Memory: what a model must remember besides its state.
HORIZONTAL_REFERENCE: Final = 0
"""Index into the memory: constant of the horizontal displacement [m]."""
IMPACT_LOSS: Final = 1
"""Index into the memory: energy lost in impacts so far, per unit mass [m^2 s^-2]."""
REPINNING_LOSS: Final = 2
"""Index into the memory: energy lost in changes of the restraint so far [m^2 s^-2]."""
LAST_EVENT: Final = 3
"""Index into the memory: kind of the last switch, an :class:`EventKind`."""
IMPULSIVE_INPUT: Final = 4
"""Index into the memory: work of jumps of the velocity of a body's ground so far, per unit
mass [m^2 s^-2]."""
MEMORY_SIZE: Final = 5
"""Least length of a memory; a model may keep more behind."""

ROUNDING: Final = 4.0 * sys.float_info.epsilon
"""Rounding noise of a guard that is no difference of large terms."""


class ContactState(IntEnum):
    """The corner, or the part of the base, that bears."""

    FULL = 0
    LEFT = 1
    RIGHT = 2
    FLIGHT = 3


class EventKind(IntEnum):
    """What happened at an event; kernels use the plain integers below."""

    SEPARATION = 1
    IMPACT = 2
    REENGAGEMENT = 3
    PIVOT_CHANGE = 4
    UPLIFT = 5
    REST = 6
    OVERTURNING = 7
    TOPPLED = 8
    SOIL_SEPARATION = 9
    SOIL_CONTACT = 10
    SOIL_PIVOT_CHANGE = 11


# Plain integers for the kernels: compiled code cannot store an enumeration's member.
SILENT: Final = 0  # bookkeeping of a model; stored, but not shown to users
SEPARATION: Final = int(EventKind.SEPARATION)
IMPACT: Final = int(EventKind.IMPACT)
REENGAGEMENT: Final = int(EventKind.REENGAGEMENT)
PIVOT_CHANGE: Final = int(EventKind.PIVOT_CHANGE)
UPLIFT: Final = int(EventKind.UPLIFT)
REST: Final = int(EventKind.REST)
OVERTURNING: Final = int(EventKind.OVERTURNING)
TOPPLED: Final = int(EventKind.TOPPLED)
SOIL_SEPARATION: Final = int(EventKind.SOIL_SEPARATION)
SOIL_CONTACT: Final = int(EventKind.SOIL_CONTACT)
SOIL_PIVOT_CHANGE: Final = int(EventKind.SOIL_PIVOT_CHANGE)


@dataclass(frozen=True)
class Start:
    """Where a run starts, in SI units.

    Parameters
    ----------
    rotation, angular_velocity : float
        Rotation of the block and its rate [rad], [rad s^-1].
    vertical_displacement : float or None
        Of the centre of mass; None asks for vertical equilibrium [m].
    vertical_velocity : float
        [m s^-1].
    """

    rotation: float = 0.0
    angular_velocity: float = 0.0
    vertical_displacement: float | None = None
    vertical_velocity: float = 0.0


@dataclass(frozen=True)
class Ending:
    """Where a run ended, so that another can go on from there.

    Parameters
    ----------
    mode : int
        Of the model.
    state : ndarray, shape (2 n,)
        Coordinates, then their rates.
    memory : ndarray, shape (memory,)
        The model's memory.
    """

    mode: int
    state: Vector
    memory: Vector


@dataclass(frozen=True)
class ContactModel:
    """A scene's equations, ready for the integrator.

    Parameters
    ----------
    name : str
        Name of the model.
    accelerate, guard, switch, energy, observe : callable
        Functions of the signatures above.
    active : ndarray of int64, shape (modes,)
        Number of leading coordinates that move in each mode.
    contact : ndarray of int64, shape (modes,)
        :class:`ContactState` of each mode.
    parameters : ndarray, shape (parameters,)
        SI floats, per unit mass.
    scales : ndarray, shape (2 n,)
        Typical size of each coordinate and rate.
    rotation_weights : ndarray, shape (n,)
        The block's rotation as a sum of coordinates.
    guard_tolerance : ndarray, shape (guards,)
        Rounding noise of each guard.
    relaxation : ndarray, shape (modes,)
        Rate at which a constraint of a mode decays, 0 where there is none; fixed steps must
        be short beside it [s^-1].
    columns : tuple of str
        Names of what `observe` gives.
    fastest_frequency : float
        Highest angular frequency of the model [rad s^-1].
    damping_rate : float
        Bound of twice damping ratio times angular frequency of its vibrations [s^-1].
    energy_scale : float
        Typical energy per unit mass, by which rounding noise is known [m^2 s^-2].
    rounding : callable or None
        ``rounding(rotation)``: noise of each coordinate and rate in one step about a
        rotation, where the model's forces are differences of large terms.
    soil_contact : ndarray of int64, shape (modes,), or None
        :class:`ContactState` of the cap on the soil in each mode, where `contact` is
        that of a block on a cap.
    mass : float
        Mass that turns the energies into joules [kg].
    initial : callable
        ``initial(start) -> (mode, state, memory)``.
    """

    name: str
    accelerate: Callable[..., None]
    guard: Callable[..., None]
    switch: Callable[..., int]
    energy: Callable[..., None]
    observe: Callable[..., None]
    active: Integers
    contact: Integers
    parameters: Vector
    scales: Vector
    rotation_weights: Vector
    guard_tolerance: Vector
    relaxation: Vector
    columns: tuple[str, ...]
    fastest_frequency: float
    damping_rate: float
    energy_scale: float
    mass: float
    initial: Callable[[Start], tuple[int, Vector, Vector]]
    rounding: Callable[[float], Vector] | None = None
    soil_contact: Integers | None = None
