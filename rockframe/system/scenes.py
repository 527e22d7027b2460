"""The table of scenes: which parts make which model.

A new scene is a row here, a setting (its numbers) and a model (its equations).
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Protocol

from rockframe.system.options import Coupling, Options
from rockframe.system.parts import Parts
from rockframe.system.rigid_ground import rigid_ground_setting
from rockframe.system.small_motion import SmallMotion
from rockframe.system.stacked import cascade_setting, coupled_setting
from rockframe.system.statics import Statics
from rockframe.system.two_spring import two_spring_setting
from rockframe.system.winkler import winkler_setting

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

    @property
    def cap_offset(self) -> float | None:
        """Height of a cap's centre above that of a body of which it is a part [m]."""
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

    def uplift_rows(self) -> list[tuple[str, str]]:
        """Give each uplift angle in words, with its name and where it comes from."""
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

    def small_motion(self) -> SmallMotion | None:
        """Give the linear equations of small motion about rest, if there are any."""
        ...

    def statics(self, rotation: float) -> Statics:
        """Give the quasi-static state at a rotation."""
        ...

    def equilibrium(self) -> dict[str, float]:
        """Give settlements and reactions at rest, by their names in the schema."""
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
    coupling : Coupling, optional
        The option that picks this one of two models of the same parts.
    """

    title: str
    model: str
    signature: frozenset[str]
    make_setting: Callable[[Parts, Options], Setting]
    coupling: Coupling | None = None

    def fits(self, parts: Parts, coupling: Coupling) -> bool:
        """Whether the scene is that of the parts."""
        return self.signature == parts.signature and self.coupling in (None, coupling)


_STACK = frozenset({"block", "pads", "cap", "soil"})

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
    Scene("Block + WinklerSoil", "Winkler", frozenset({"block", "soil"}), winkler_setting),
    Scene(
        "Block + CushionCap + WinklerSoil (block and cap as one body)",
        "Winkler",
        frozenset({"block", "cap", "soil"}),
        winkler_setting,
    ),
    Scene(
        "Block + TwoSpringSupport + CushionCap + WinklerSoil, coupling='coupled'",
        "coupled",
        _STACK,
        coupled_setting,
        Coupling.COUPLED,
    ),
    Scene(
        "Block + TwoSpringSupport + CushionCap + WinklerSoil, coupling='cascade'",
        "cascade",
        _STACK,
        cascade_setting,
        Coupling.CASCADE,
    ),
)
