"""The state at the start of a run."""

import math
import re
from dataclasses import dataclass
from typing import ClassVar, Final

from rockframe.components.base import Component
from rockframe.components.parameters import Parameter, SIValues
from rockframe.errors import short_repr
from rockframe.units import ANGLE, ANGULAR_VELOCITY, LENGTH, VELOCITY, Condition


def _in_degrees(rotation: str) -> str:
    """Return the question whether degrees were meant by a rotation in radians."""
    degrees = re.sub(r"\brad(ians?)?\b", "deg", rotation)
    return "" if degrees == rotation else f"; was {short_repr(degrees)} meant?"


_RISE: Final = LENGTH.like("0.01 m")
_TILTED: Final = Condition(
    "below a right angle", lambda rotation: abs(rotation) < 0.5 * math.pi, _in_degrees
)


@dataclass(frozen=True)
class InitialStateSI:
    """Initial state in SI units; ``None`` means at rest, or in vertical equilibrium."""

    rotation: float | None
    angular_velocity: float
    vertical_displacement: float | None
    vertical_velocity: float


class InitialState(Component[InitialStateSI]):
    """Rotation, displacement and velocities at the start of a run; at rest unless given.

    Raises
    ------
    UnitsError
        A value has the wrong unit, or none.
    ComponentError
        A value is not finite, or the rotation is a right angle or more.

    Examples
    --------
    >>> import rockframe as rf
    >>> leaning = rf.InitialState(rotation="2 deg")
    >>> system = rf.System(rf.Block(width="1 m", height="4 m", mass="5 t"))
    >>> run = system.simulate(initial=leaning, duration="1 s")
    >>> bool(run.overturned)
    False
    """

    noun: ClassVar[str] = "initial state"

    rotation: Parameter[None] = Parameter(
        ANGLE, _TILTED, doc="alpha, clockwise positive; that at rest unless given.", default=None
    )
    angular_velocity: Parameter[None] = Parameter(
        ANGULAR_VELOCITY, doc="Angular velocity, the rate of `rotation`.", default=None
    )
    vertical_displacement: Parameter[None] = Parameter(
        _RISE,
        doc="Upward displacement of the centre of mass from static equilibrium; unless given, "
        "the block starts in vertical equilibrium at its rotation.",
        default=None,
    )
    vertical_velocity: Parameter[None] = Parameter(
        VELOCITY, doc="Velocity, the rate of `vertical_displacement`.", default=None
    )

    def _numbers(self, numbers: SIValues) -> InitialStateSI:
        return InitialStateSI(
            numbers.rotation,
            numbers.angular_velocity or 0.0,
            numbers.vertical_displacement,
            numbers.vertical_velocity or 0.0,
        )
