"""The table of scenes: which parts make which model.

A new scene is a row here, a setting (its numbers) and a model (its equations).
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Protocol

from rockframe.system.options import Restraint, Rotation
from rockframe.system.parts import Parts
from rockframe.system.rigid_ground import rigid_ground_setting
from rockframe.system.two_spring import two_spring_setting

if TYPE_CHECKING:
    from rockframe.dynamics.protocol import ContactModel


class Setting(Protocol):
    """A scene's numbers in SI units, and what follows from them."""

    @property
    def gravity(self) -> float:
        """Acceleration of gravity [m s^-2]."""
        ...

    @property
    def overturning_angle(self) -> float:
        """Theta [rad]."""
        ...

    @property
    def uplift_angle(self) -> float:
        """Rotation at which contact is first lost; NaN if never [rad]."""
        ...

    @property
    def settlement(self) -> float | None:
        """Settlement under the weight, where the base gives way [m]."""
        ...

    def cautions(self) -> list[str]:
        """Give warnings about values near or beyond the model's validity."""
        ...

    def start_faults(self, rotation: float, has_vertical_start: bool) -> list[str]:
        """Give faults of an initial state."""
        ...

    def equations(self) -> list[tuple[str, str]]:
        """Give each contact state with the equation that governs it."""
        ...

    def numbers(self) -> list[tuple[str, str]]:
        """Give the numbers a reader wants to see, with their names."""
        ...

    def restraint_rule(self) -> str:
        """Say which point of the base is held horizontally."""
        ...

    def left_out(self) -> list[str]:
        """Say what the model does not have."""
        ...

    def compile(self) -> "ContactModel":
        """Give the equations, ready for the integrator."""
        ...


@dataclass(frozen=True)
class Scene:
    """A combination of parts that has a model.

    Parameters
    ----------
    title : str
        The parts, as users write them.
    model : str
        Name of the model.
    signature : frozenset of str
        Slots of :class:`rockframe.system.parts.Parts` that must be filled.
    make_setting : callable
        From parts and options to the scene's numbers.
    """

    title: str
    model: str
    signature: frozenset[str]
    make_setting: Callable[[Parts, Restraint, Rotation, float], Setting]


SCENES: tuple[Scene, ...] = (
    Scene(
        "Block (on rigid ground; RigidGround(restitution=...) to choose its restitution)",
        "rigid ground",
        frozenset({"block"}),
        rigid_ground_setting,
    ),
    Scene(
        "Block + TwoSpringSupport",
        "two-spring",
        frozenset({"block", "pads"}),
        two_spring_setting,
    ),
)
