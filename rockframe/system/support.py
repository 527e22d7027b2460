"""A base as it is under a body: what both scenes and stacks ask of it.

The numbers of a base follow from its component and from the body on it; its words tell them,
and its law is what the equations take.
"""

import math
from abc import ABC, abstractmethod
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, ClassVar

from rockframe.system.load import Load
from rockframe.system.statics import sine_cosine_rise
from rockframe.system.words import vibration_words

if TYPE_CHECKING:
    from rockframe.dynamics.base_numbers import BaseNumbers
    from rockframe.dynamics.body import Body as BodyLaw


@dataclass(frozen=True)
class BaseWords:
    """A base in words.

    Parameters
    ----------
    law : str
        How its forces follow, in a stack.
    equations : list of (str, str)
        Each contact state with the equation that governs it.
    uplift : (str, str)
        Name and value of the uplift angle.
    numbers : list of (str, str)
        The numbers that a reader wants to see, with their names.
    left_out : list of str
        What the base does not have.
    body, end : str
        What the body on it, and an end of its base line, are called.
    """

    law: str
    equations: list[tuple[str, str]]
    uplift: tuple[str, str]
    numbers: list[tuple[str, str]]
    left_out: list[str]
    body: str = "block"
    end: str = "corner"


@dataclass(frozen=True)
class Held:
    """A base under a body that is held at a rotation, in vertical equilibrium; SI units.

    Parameters
    ----------
    rise : float
        Of the middle of the base from rest [m].
    moment : float
        Of the base's reactions about its middle, against the rotation [N m].
    left, right : bool
        Whether the ends bear.
    reactions : dict of str to float
        Forces and lengths by their names in the schema of results.
    """

    rise: float
    moment: float
    left: bool
    right: bool
    reactions: dict[str, float] = field(default_factory=dict[str, float])

    @property
    def contact(self) -> str:
        """Name of the contact state."""
        if self.left and self.right:
            return "full"
        return "left" if self.left else "right"


@dataclass(frozen=True)
class Support(ABC):
    """A base under a body.

    Parameters
    ----------
    load : Load
        What stands on it.
    """

    load: Load
    settlement_name: ClassVar[str] = "pad_settlement"
    """Of the settlement, in the schema."""

    @property
    @abstractmethod
    def model(self) -> str:
        """Name of the model of a body on this base."""

    @property
    @abstractmethod
    def settlement(self) -> float:
        """Delta, settlement under the weight [m]."""

    @property
    def uplift_angle(self) -> float:
        """Rotation at which contact is first lost; NaN if it never is [rad].

        Unless overridden, that at which an end has risen by the settlement.
        """
        ratio = self.settlement / self.load.body.half_width
        if self.load.options.small:
            return ratio
        return math.asin(ratio) if ratio <= 1.0 else math.nan

    @abstractmethod
    def law(self, body: "BodyLaw", mass: float, load_mass: float) -> "BaseNumbers":
        """Give the base as the equations take it.

        Parameters
        ----------
        body : rockframe.dynamics.body.Body
            The body on it.
        mass : float
            That all is measured by [kg].
        load_mass : float
            That rests on the base, with what stands on the body [kg].
        """

    @abstractmethod
    def held(self, sine: float, cosine: float, press: float) -> Held:
        """Give the equilibrium of the base at a rotation under a vertical force [N]."""

    def at_rest(self) -> dict[str, float]:
        """Give settlement and what the base shows at rest, by their names in the schema."""
        shown = self.held(0.0, 1.0, self.load.weight).reactions
        return {
            self.settlement_name: self.settlement,
            **{f"static_{name}": value for name, value in shown.items()},
        }

    @abstractmethod
    def words(self) -> BaseWords:
        """Tell the base in words."""

    def cautions(self) -> list[str]:
        """Give warnings about values near or beyond the model's validity."""
        return []

    def start_faults(self, rotation: float, has_vertical_start: bool) -> list[str]:
        """Give faults of an initial state; every state can start a run unless overridden.

        Parameters
        ----------
        rotation : float
            Of the body [rad].
        has_vertical_start : bool
            Whether a vertical displacement or velocity is given.
        """
        return []

    def held_at(self, rotation: float) -> Held:
        """Give the equilibrium under the weight at a rotation [rad]."""
        height, rule = self.load.body.centre_height, self.load.options.rotation
        sine, cosine, _ = sine_cosine_rise(height, rule, rotation)
        return self.held(sine, cosine, self.load.weight)

    @cached_property
    def own_law(self) -> "BaseNumbers":
        """The base as the equations of its body alone take it, per unit mass of that."""
        mass = self.load.body.mass
        return self.law(self.load.own_law, mass, mass)

    @property
    def rocking_stiffness(self) -> float:
        """Of small rotations in full contact, less what the raised weight takes [N m rad^-1]."""
        body = self.load.body
        raising = self.load.weight * body.centre_height
        return body.mass * self.own_law.rotational_stiffness - raising

    @property
    def vertical_frequency(self) -> float:
        """omega_v, of vertical vibration in full contact, Eqs. (7a) and (18a) [rad s^-1]."""
        return math.sqrt(self.own_law.vertical_stiffness)

    def vibrations(self, vertical: str, rocking: str) -> list[tuple[str, str]]:
        """Tell vertical vibration, and rocking where the base holds the body, by these titles."""
        law, body, rate = self.own_law, self.load.body, self.vertical_frequency
        rows = [(vertical, vibration_words("omega_v", rate, 0.5 * law.damping_time * rate))]
        if self.rocking_stiffness > 0.0:
            rate = math.sqrt(self.rocking_stiffness / body.base_inertia)
            damping = law.damping_time * law.rotational_stiffness * body.mass
            ratio = 0.5 * damping / (body.base_inertia * rate)
            rows.append((rocking, vibration_words("omega_r", rate, ratio)))
        return rows
