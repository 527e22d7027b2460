"""Supports: bases under a given body, such as pads, a bed of soil, or a rigid base.

The numbers of a support follow from its component and from the body on it; its words describe them,
and its law is the base in the equations.
"""

import math
from abc import ABC, abstractmethod
from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar, Final

from rockframe.case_arrays import sqrt
from rockframe.components import TwoSpringSupport, WinklerSoil
from rockframe.components.bases import Separation
from rockframe.dynamics.base_numbers import BaseNumbers, bed_numbers, pads_numbers, rigid_numbers
from rockframe.dynamics.body import Body
from rockframe.dynamics.body_statics import (
    Pose,
    StandingBody,
    base_derivatives,
    equilibrium_pose,
    standing_body,
    uplift_rotation,
)
from rockframe.dynamics.on_base import BodyOnBase
from rockframe.dynamics.protocol import CORNER_REACTIONS
from rockframe.dynamics.single_body import eccentricity_of
from rockframe.dynamics.statics import StandingChain
from rockframe.system.bodies import BaseLoad, Restitutions, base_restitution, restitution_cautions
from rockframe.system.statics import StandingBodies, Statics, required_states, static_values
from rockframe.units import angle_words

NO_VERTICAL_START: Final = (
    "InitialState: vertical_displacement and vertical_velocity need a base that gives way; on "
    "rigid ground they follow from the rotation"
)


def corner_reactions(left: float, right: float) -> dict[str, float]:
    """Return the reactions of both corners by their names in the schema."""
    return {
        column.name: force for column, force in zip(CORNER_REACTIONS, (left, right), strict=True)
    }


def uplift_words(radians: float) -> str:
    """Write the angle at which contact is first lost; NaN if it never is."""
    if math.isnan(radians):
        return "never: the base stays in contact up to overturning"
    return angle_words(radians)


@dataclass(frozen=True)
class BaseWords:
    """A base in words.

    Parameters
    ----------
    law : str
        Law of its forces, for the description of a stack.
    equations : list of (str, str)
        Each contact state with the equation that governs it.
    uplift : (str, str)
        Name and value of the uplift angle.
    numbers : list of (str, str)
        Names of numbers that a reader wants to see, with values and units.
    left_out : list of str
        Effects that the base does not have.
    body, end : str
        Words for the body on it, and for an end of its base line.
    """

    law: str
    equations: list[tuple[str, str]]
    uplift: tuple[str, str]
    numbers: list[tuple[str, str]]
    left_out: list[str]
    body: str = "block"
    end: str = "corner"


@dataclass(frozen=True)
class Support(ABC):
    """A base under a body.

    Parameters
    ----------
    load : BaseLoad
        All that stands on it, as one body.
    """

    load: BaseLoad
    settlement_name: ClassVar[str] = "pad_settlement"
    """Name of the settlement in the schema."""

    @property
    @abstractmethod
    def model(self) -> str:
        """Name of the model of a body on this base."""

    @property
    def settlement(self) -> float:
        """Delta, settlement under the weight [m]."""
        return self.carried.settlement

    @cached_property
    def uplift_angle(self) -> float:
        """Rotation at which contact is first lost; NaN if it never is [rad]."""
        return uplift_rotation(self.carried, self.load.options.slope.normal_gravity)

    @abstractmethod
    def law(self, body: Body, mass: float, load_mass: float) -> BaseNumbers:
        """Return the base in the form that the equations need.

        Parameters
        ----------
        body : rockframe.dynamics.body.Body
            The body on it.
        mass : float
            Reference mass of the model [kg].
        load_mass : float
            Mass on the base: the body and all that stands on it [kg].
        """

    def at_rest(self) -> dict[str, float]:
        """Return settlement and reactions of the upright body at rest, by their schema names."""
        reactions = self.standing.reactions([self.upright])
        return {self.settlement_name: self.settlement, **static_values(reactions)}

    @abstractmethod
    def words(self) -> BaseWords:
        """Describe the base."""

    def cautions(self) -> list[str]:
        """Return warnings about values near or beyond the model's validity."""
        return []

    def start_faults(self, rotation: float, has_vertical_start: bool) -> list[str]:
        """Return faults of an initial state; every state can start a run unless overridden.

        Parameters
        ----------
        rotation : float
            Rotation of the body [rad].
        has_vertical_start : bool
            Whether a vertical displacement or velocity is given.
        """
        return []

    def held_at(self, rotation: float) -> Statics:
        """Return the equilibrium under the weight at a rotation [rad]."""
        return required_states([rotation], self.standing.held([rotation]))[0]

    @cached_property
    def carried(self) -> StandingBody:
        """The body on it, per unit of its mass."""
        body = self.load.rigid_body
        return standing_body(BodyOnBase(body, self.base_numbers.law), offset=eccentricity_of(body))

    @cached_property
    def upright(self) -> Pose:
        """Equilibrium of the body held upright."""
        return equilibrium_pose(self.carried, 0.0, self.load.options.slope.normal_gravity)

    @cached_property
    def standing(self) -> StandingBodies:
        """Statics of the body alone on it, by the law."""
        chain = StandingChain((self.carried,), self.load.options.slope.along_gravity)
        return StandingBodies(chain, self.load.body.mass, (self.base_numbers,))

    @cached_property
    def base_numbers(self) -> BaseNumbers:
        """The base as the equations take it under its load alone, per unit mass of that load."""
        mass = self.load.body.mass
        return self.law(self.load.rigid_body, mass, mass)

    @cached_property
    def rocking_stiffness(self) -> float:
        """Rotational stiffness in full contact, less the effect of the weight [N m rad^-1]."""
        return self.load.body.mass * self._slopes("rotation")[0]

    @cached_property
    def vertical_frequency(self) -> float:
        """omega_v of vertical vibration in full contact, Eqs. (7a) and (18a) [rad s^-1]."""
        return sqrt(self._slopes("vertical")[1])

    def _slopes(self, name: str) -> tuple[float, float]:
        """Return moment and force against a unit of a coordinate or rate, of the upright body."""
        return base_derivatives(self.carried, self.upright, name)

    def vibrations(self, vertical: str, rocking: str) -> list[tuple[str, str]]:
        """Describe vertical vibration and, on a base stiff enough, rocking, by these titles.

        The first is that of the centre of mass without rotation, which defines frequency and
        damping ratios of the base. The second is a mode, in which an eccentric body also rises.
        """
        rate = self.vertical_frequency
        vibrations = [
            (vertical, "omega_v", rate, 0.5 * self._slopes("vertical_velocity")[1] / rate)
        ]
        square, rise = self._rocking_mode()
        if square > 0.0:
            rate = sqrt(square)
            turning, rising = (
                self._slopes(name) for name in ("angular_velocity", "vertical_velocity")
            )
            damping = turning[0] + rise * (turning[1] + rising[0] + rise * rising[1])
            inertia = self.load.body.base_inertia / self.load.body.mass + rise * rise
            vibrations.append((rocking, "omega_r", rate, 0.5 * damping / (inertia * rate)))
        return [
            (title, f"{symbol} = {rate:.6g} rad/s (period {2.0 * math.pi / rate:.6g} s), damping "
             f"ratio {ratio:.6g}")
            for title, symbol, rate, ratio in vibrations
        ]  # fmt: skip

    def _rocking_mode(self) -> tuple[float, float]:
        """Return the square of its frequency without damping [rad^2 s^-2] and its rise [m].

        The rise of the centre of mass is that with a unit of rotation.
        """
        turning, rising = (self._slopes(name) for name in ("rotation", "vertical"))
        inertia = self.load.body.base_inertia / self.load.body.mass
        alone = turning[0] / inertia, rising[1]
        coupling = rising[0] * turning[1] / inertia
        if coupling == 0.0:
            return alone[0], 0.0
        apart = alone[0] - alone[1]
        square = alone[0] + 2.0 * coupling / (
            apart + math.copysign(math.sqrt(apart * apart + 4.0 * coupling), apart)
        )
        return square, turning[1] / (square - alone[1])


@dataclass(frozen=True)
class PadSupport(Support):
    """Two pads, in SI units.

    Parameters
    ----------
    load : BaseLoad
        The block on them.
    stiffness, damping : float
        Stiffness and damping of one pad [N m^-1], [N s m^-1].
    restitution : Restitutions
        eps of a landing corner [1].
    """

    stiffness: float
    damping: float
    restitution: Restitutions

    @property
    def model(self) -> str:
        """Name of the model."""
        return "two-spring"

    def cautions(self) -> list[str]:
        """Return warnings about restitution and stability."""
        cautions = restitution_cautions(self.restitution, self.load.body.maximum_restitution)
        if self.rocking_stiffness <= 0.0:
            cautions.append(
                "the pads are too soft to hold the block upright: 2 k b^2 is below m g h, so "
                "that the smallest disturbance overturns it"
            )
        return cautions

    def law(self, body: Body, mass: float, load_mass: float) -> BaseNumbers:
        """Return the pads as the equations take them."""
        return pads_numbers(
            body,
            stiffness=self.stiffness / mass,
            damping=self.damping / mass,
            restitution=self.restitution,
            load=load_mass / mass,
        )

    def words(self) -> BaseWords:
        """Describe the pads."""
        omega = self.load.body.frequency_at(self.load.options.gravity)
        return BaseWords(
            law="pad forces as in Eqs. (12) and (15)",
            equations=[
                ("full", "Eq. (12), corrected: 2 xi sin(a)/(beta omega) in (12a); sin(2a)/2, "
                 "beta^2 omega^4/g and 2 xi/(beta omega) in (12b)"),
                ("left", "Eq. (15), upper signs, corrected: [cos(theta) - cos(theta + a) + ...] in "
                 "(15a); the sign of the bearing corner and omega^4 in (15b)"),
                ("right", "Eq. (15), lower signs, with the same corrections"),
                ("flight", "free fall and constant rotation rate"),
                ("impact", f"a landing corner keeps {self.restitution.words()} of its speed, "
                 "Eqs. (2)-(4) with the corner inertia for the printed I_O"),
            ],
            uplift=("uplift angle, Eq. (16)", uplift_words(self.uplift_angle)),
            numbers=[
                ("rocking frequency omega, Eq. (6)", f"{omega:.6g} rad/s"),
                ("frequency ratio beta, Eq. (8)", f"{self.vertical_frequency / omega:.6g}"),
                ("pad stiffness k, damping c",
                 f"{self.stiffness:.6g} N/m, {self.damping:.6g} N s/m"),
                ("settlement delta", f"{self.settlement:.6g} m"),
                *self.vibrations("vertical vibration", "rocking vibration in full contact"),
                ("restitution eps", self.restitution.words()),
            ],
            left_out=["tension in the pads"],
        )  # fmt: skip


def pads_under(pads: TwoSpringSupport, load: BaseLoad) -> PadSupport:
    """Return pads under a block: stiffness and damping of one pad by Eqs. (7) and (8)."""
    numbers, body = pads.si, load.body
    if numbers.stiffness is not None:
        stiffness = numbers.stiffness
        vertical = sqrt(2.0 * stiffness / body.mass)
    else:
        vertical = numbers.frequency_ratio * body.frequency_at(load.options.gravity)
        stiffness = 0.5 * body.mass * vertical**2
    damping = numbers.damping
    if damping is None:
        damping = numbers.damping_ratio * body.mass * vertical
    # the restitution of a body too squat to rock from corner to corner is zero
    greatest = Restitutions(*(max(restitution, 0.0) for restitution in body.maximum_restitution))
    return PadSupport(load, stiffness, damping, base_restitution(pads, greatest))


_SEPARATION = {
    Separation.DISPLACEMENT: "above the level of the unloaded bed",
    Separation.PRESSURE: "above the level of the unloaded bed, and where the dashpots would pull",
}


@dataclass(frozen=True)
class BedSupport(Support):
    """A Winkler bed, in SI units.

    Parameters
    ----------
    load : BaseLoad
        The body on it.
    stiffness, damping : float
        k0 and c0, per length of the base [Pa], [Pa s].
    separation : Separation
        Condition of separation from the bed.
    """

    stiffness: float
    damping: float
    separation: Separation
    settlement_name: ClassVar[str] = "soil_settlement"

    @property
    def model(self) -> str:
        """Name of the model."""
        return "Winkler"

    def cautions(self) -> list[str]:
        """Return warnings about stability."""
        if self.rocking_stiffness > 0.0:
            return []
        return [
            "the soil is too soft to hold the body upright: (2/3) k0 b^3 is below m g h, so "
            "that the smallest disturbance overturns it"
        ]

    def law(self, body: Body, mass: float, load_mass: float) -> BaseNumbers:
        """Return the bed as the equations take it."""
        return bed_numbers(
            body,
            stiffness=self.stiffness / mass,
            damping=self.damping / mass,
            by_pressure=self.separation is Separation.PRESSURE,
            load=load_mass / mass,
        )

    def words(self) -> BaseWords:
        """Describe the bed."""
        body = self.load.body
        one_sided = (
            "Eq. (19), corrected: inertia I_O + m (h + b a)^2 and its a'^2 term in (19b), (19e), "
            "(19f), (19h); resultants over the part in contact"
        )
        if self.load.options.small:
            one_sided = (
                "Eq. (19), corrected: (19e), (19f), (19h); inertia I_M and heights to second "
                "order, so that energies balance"
            )
        return BaseWords(
            law="soil's resultants as in Eqs. (18) and (19)",
            equations=[
                ("full", "Eq. (18) at small rotation; at finite rotation the same bed with "
                 "x' = h cos(a), and its resultants over the whole base"),
                ("left, right", one_sided),
                ("flight", "free fall and constant rotation rate"),
                ("contact", f"without impact law; the base parts from the bed "
                 f"{_SEPARATION[self.separation]}"),
            ],
            uplift=("uplift angle, arcsin(delta/b)", uplift_words(self.uplift_angle)),
            numbers=[
                ("mass on the soil",
                 f"{body.mass:.6g} kg, centre {body.centre_height:.6g} m above it"),
                ("soil stiffness k0, damping c0",
                 f"{self.stiffness:.6g} Pa, {self.damping:.6g} Pa s"),
                ("settlement delta", f"{self.settlement:.6g} m"),
                *self.vibrations(
                    "vertical vibration, Eq. (18a)", "rocking in full contact, Eq. (18b)"
                ),
            ],
            left_out=["yielding of the soil", "impact on the soil"],
            body="body",
            end="end",
        )  # fmt: skip


def bed_under(soil: WinklerSoil, load: BaseLoad) -> BedSupport:
    """Return a bed under a body; a damping ratio is that of the vertical motion of all its mass."""
    numbers, body = soil.si, load.body
    damping = numbers.damping
    if damping is None:
        critical = sqrt(2.0 * body.half_width * numbers.stiffness * body.mass)
        damping = numbers.damping_ratio * critical / body.half_width
    return BedSupport(load, numbers.stiffness, damping, numbers.separation)


@dataclass(frozen=True)
class RigidBase(Support):
    """A rigid base."""

    @property
    def model(self) -> str:
        """Name of the model."""
        return "rigid"

    @property
    def settlement(self) -> float:
        """Settlement: zero [m]."""
        return 0.0

    @property
    def uplift_angle(self) -> float:  # type: ignore[override]
        """Rotation of uplift: zero, as any rotation lifts a corner [rad]."""
        return 0.0

    def law(self, body: Body, mass: float, load_mass: float) -> BaseNumbers:
        """Return the base as the equations take it."""
        return rigid_numbers(body)

    def start_faults(self, rotation: float, has_vertical_start: bool) -> list[str]:
        """Refuse a vertical start: the base allows no vertical motion."""
        return [NO_VERTICAL_START] if has_vertical_start else []

    def words(self) -> BaseWords:
        """Describe the base."""
        return BaseWords(
            law="corners held by forces on rigid bases",
            equations=[],
            uplift=("uplift angle", uplift_words(self.uplift_angle)),
            numbers=[],
            left_out=["elasticity of the contacts"],
        )
