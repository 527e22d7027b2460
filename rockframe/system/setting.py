"""What a scene is: its numbers in SI units, its words, and its model."""

from typing import TYPE_CHECKING, Protocol

from rockframe.signals.slope import Slope
from rockframe.system.bodies import Body, OverturningAngles
from rockframe.system.small_motion import SmallMotion
from rockframe.system.statics import Statics
from rockframe.system.words import Words

if TYPE_CHECKING:
    from rockframe.dynamics.protocol import ContactModel


class Numbers(Protocol):
    """A scene's numbers in SI units, and what follows from them at rest."""

    @property
    def gravity(self) -> float:
        """Acceleration of gravity [m s^-2]."""
        ...

    @property
    def slope(self) -> Slope:
        """The base line in its gravity."""
        ...

    @property
    def overturning_angles(self) -> OverturningAngles:
        """Rotations of unstable equilibrium to either side, relative to the base line [rad]."""
        ...

    @property
    def overturning_angle(self) -> float:
        """Theta, the lesser of both [rad]."""
        ...

    @property
    def rest_rotation(self) -> float:
        """Rotation at rest, of a body that is not symmetric [rad]."""
        ...

    @property
    def uplift_angle(self) -> float:
        """Rotation at which contact is first lost; NaN if never [rad]."""
        ...

    @property
    def settlement(self) -> float | None:
        """Settlement under the weight, where the base gives way [m]."""
        ...

    @property
    def cap_offset(self) -> float | None:
        """Height of a cap's centre above that of a body of which it is a part [m]."""
        ...

    @property
    def body(self) -> Body:
        """The body that the response is of."""
        ...

    def small_motion(self) -> SmallMotion | None:
        """Give the linear equations of small motion about rest, if there are any."""
        ...

    def statics(self, rotation: float) -> Statics:
        """Give the quasi-static state at a rotation."""
        ...

    def equilibrium(self) -> dict[str, float]:
        """Give settlements and reactions at rest, by their names in the schema."""
        ...


class Telling(Protocol):
    """A scene in words."""

    @property
    def model(self) -> str:
        """Name of the model."""
        ...

    def words(self) -> Words:
        """Tell equations, restraint, uplift angles, numbers, and what is left out."""
        ...

    def cautions(self) -> list[str]:
        """Give warnings about values near or beyond the model's validity."""
        ...

    def start_faults(self, rotation: float, has_vertical_start: bool) -> list[str]:
        """Give faults of an initial state."""
        ...


class Setting(Numbers, Telling, Protocol):
    """A scene: numbers, words, and the model that they lead to."""

    def compile(self) -> "ContactModel":
        """Give the equations, ready for the integrator."""
        ...
