"""The state a run starts from."""

import math
import re
from dataclasses import dataclass
from typing import ClassVar, Final

from rockframe.components.base import Component, with_unit
from rockframe.errors import ComponentError, shown
from rockframe.units import (
    ANGLE,
    ANGULAR_VELOCITY,
    LENGTH,
    VELOCITY,
    QuantityLike,
    to_si,
)

_RISE: Final = LENGTH.like("0.01 m")


@dataclass(frozen=True)
class InitialStateSI:
    """Initial state in SI units; ``None`` asks for vertical equilibrium."""

    rotation: float
    angular_velocity: float
    vertical_displacement: float | None
    vertical_velocity: float


class InitialState(Component[InitialStateSI]):
    """Rotation and velocities at the start of a run; all zero unless given.

    Parameters
    ----------
    rotation : str or Quantity, optional
        alpha, clockwise positive [rad].
    angular_velocity : str or Quantity, optional
        Rate of `rotation` [rad s^-1].
    vertical_displacement : str or Quantity, optional
        Of the centre of mass from static equilibrium, upwards; unless given,
        the block starts in vertical equilibrium at its rotation [m].
    vertical_velocity : str or Quantity, optional
        Rate of `vertical_displacement` [m s^-1].

    Raises
    ------
    UnitsError
        A value has the wrong unit, or none.
    ComponentError
        Not finite, or a rotation of a right angle and more.
    """

    noun: ClassVar[str] = "initial state"

    def __init__(
        self,
        *,
        rotation: QuantityLike | None = None,
        angular_velocity: QuantityLike | None = None,
        vertical_displacement: QuantityLike | None = None,
        vertical_velocity: QuantityLike | None = None,
    ) -> None:
        given = {
            name: None if value is None else to_si(value, measure, owner="InitialState", name=name)
            for name, value, measure in (
                ("rotation", rotation, ANGLE),
                ("angular_velocity", angular_velocity, ANGULAR_VELOCITY),
                ("vertical_displacement", vertical_displacement, _RISE),
                ("vertical_velocity", vertical_velocity, VELOCITY),
            )
        }
        if abs(given["rotation"] or 0.0) >= 0.5 * math.pi:
            msg = (
                "InitialState: rotation must be below a right angle, "
                f"got {shown(str(rotation))}{_meant(str(rotation))}"
            )
            raise ComponentError(msg)
        self._freeze(
            InitialStateSI(
                given["rotation"] or 0.0,
                given["angular_velocity"] or 0.0,
                given["vertical_displacement"],
                given["vertical_velocity"] or 0.0,
            ),
            {
                "rotation": with_unit(given["rotation"], ANGLE),
                "angular_velocity": with_unit(given["angular_velocity"], ANGULAR_VELOCITY),
                "vertical_displacement": with_unit(given["vertical_displacement"], LENGTH),
                "vertical_velocity": with_unit(given["vertical_velocity"], VELOCITY),
            },
        )


def _meant(rotation: str) -> str:
    """Ask whether degrees were meant, if the rotation was given in radians."""
    degrees = re.sub(r"\brad(ians?)?\b", "deg", rotation)
    return "" if degrees == rotation else f"; was {shown(degrees)} meant?"
