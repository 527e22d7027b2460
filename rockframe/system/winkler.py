"""The scene of a body on a Winkler bed: its numbers and its words."""

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from rockframe.components.soil import Separation
from rockframe.components.values import SIValues
from rockframe.system.angles import uplift_words
from rockframe.system.bodies import Body, body_of, cap_under, one_body
from rockframe.system.options import Options
from rockframe.system.parts import Parts
from rockframe.system.restraints import restraint_code, restraint_words
from rockframe.system.small_motion import SmallMotion
from rockframe.system.statics import Statics, contact_of, sine_cosine_rise

if TYPE_CHECKING:
    from rockframe.dynamics.protocol import ContactModel

_SEPARATION = {
    Separation.DISPLACEMENT: "above the level of the unloaded bed",
    Separation.PRESSURE: "above the level of the unloaded bed, and where the dashpots would pull",
}


@dataclass(frozen=True)
class WinklerSetting:
    """Numbers of a body on a bed, in SI units.

    `cap_offset` is the height of the cap's centre above that of the body, where a cap
    is part of the body; None where there is no cap.
    """

    body: Body
    stiffness: float
    damping: float
    separation: Separation
    options: Options
    cap_offset: float | None = None

    @property
    def gravity(self) -> float:
        """Acceleration of gravity [m s^-2]."""
        return self.options.gravity

    @property
    def overturning_angle(self) -> float:
        """Theta, of the body about the end of its base [rad]."""
        return self.body.overturning_angle

    @property
    def settlement(self) -> float | None:
        """Delta = mg/(2 b k0) [m]."""
        return self.sinking

    @property
    def sinking(self) -> float:
        """Delta = mg/(2 b k0) [m]."""
        return 0.5 * self.body.mass * self.gravity / (self.body.half_width * self.stiffness)

    @property
    def uplift_angle(self) -> float:
        """Rotation at which an end lifts; NaN if the soil is too soft [rad]."""
        ratio = self.sinking / self.body.half_width
        if self.options.small:
            return ratio
        return math.asin(ratio) if ratio <= 1.0 else math.nan

    @property
    def rocking_stiffness(self) -> float:
        """(2/3) k0 b^3 - m g h, of small rotations in full contact [N m rad^-1]."""
        body = self.body
        lifting = body.mass * self.gravity * body.centre_height
        return self.stiffness * body.half_width**3 / 1.5 - lifting

    def cautions(self) -> list[str]:
        """Give warnings about stability."""
        if self.rocking_stiffness > 0.0:
            return []
        return [
            "the soil is too soft to hold the body upright: (2/3) k0 b^3 is below m g h, so "
            "that the smallest disturbance overturns it"
        ]

    def start_faults(self, rotation: float, has_vertical_start: bool) -> list[str]:
        """Give no faults: every state can start a run."""
        return []

    def equations(self) -> list[tuple[str, str]]:
        """Give each contact state with the equation that governs it."""
        one_sided = (
            "Eq. (19), corrected: inertia I_O + m (h + b a)^2 and its a'^2 term in (19b), (19e), "
            "(19f), (19h); resultants over the part in contact"
        )
        if self.options.small:
            one_sided = (
                "Eq. (19), corrected: (19e), (19f), (19h); inertia I_M and heights to second "
                "order, so that energies balance"
            )
        return [
            ("full", "Eq. (18) at small rotation; at finite rotation the same bed with "
             "x' = h cos(a), and its resultants over the whole base"),
            ("left, right", one_sided),
            ("flight", "free fall and constant rotation rate"),
            ("contact", f"without impact law; the base parts from the bed "
             f"{_SEPARATION[self.separation]}"),
        ]  # fmt: skip

    def uplift_rows(self) -> list[tuple[str, str]]:
        """Give the uplift angle, from the settlement."""
        return [("uplift angle, arcsin(delta/b)", uplift_words(self.uplift_angle))]

    def numbers(self) -> list[tuple[str, str]]:
        """Give stiffness, damping, frequencies and damping ratios."""
        body = self.body
        vertical = math.sqrt(2.0 * body.half_width * self.stiffness / body.mass)
        ratio = body.half_width * self.damping / (body.mass * vertical)
        rows = [
            ("mass on the soil", f"{body.mass:.6g} kg, centre {body.centre_height:.6g} m above it"),
            ("soil stiffness k0, damping c0", f"{self.stiffness:.6g} Pa, {self.damping:.6g} Pa s"),
            ("settlement delta", f"{self.sinking:.6g} m"),
            ("vertical vibration, Eq. (18a)", vibration_words("omega_v", vertical, ratio)),
        ]
        if self.rocking_stiffness > 0.0:
            rate = math.sqrt(self.rocking_stiffness / body.base_inertia)
            ratio = self.damping * body.half_width**3 / (3.0 * body.base_inertia * rate)
            rows.append(
                ("rocking in full contact, Eq. (18b)", vibration_words("omega_r", rate, ratio))
            )
        return rows

    def restraint_rule(self) -> str:
        """Say which point of the base is held horizontally."""
        return restraint_words(self.options.restraint, self.options.rotation, "end")

    def left_out(self) -> list[str]:
        """Say what the model does not have."""
        return ["sliding", "elasticity of the body", "yielding of the soil", "impact on the soil"]

    def compile(self) -> "ContactModel":
        """Give the equations, ready for the integrator."""
        from rockframe.dynamics.winkler_model import winkler

        return winkler(
            half_width=self.body.half_width,
            centre_height=self.body.centre_height,
            inertia=self.body.inertia,
            mass=self.body.mass,
            stiffness=self.stiffness,
            damping=self.damping,
            by_pressure=self.separation is Separation.PRESSURE,
            restraint=restraint_code(self.options.restraint),
            small_rotation=self.options.small,
            gravity=self.gravity,
        )

    def small_motion(self) -> SmallMotion:
        """Give the equations of small motion in full contact, Eq. (18)."""
        width = self.body.half_width
        return SmallMotion(
            ("vertical_displacement", "rotation"),
            np.diag([self.body.mass, self.body.base_inertia]),
            2.0 * width * self.damping * np.diag([1.0, width**2 / 3.0]),
            np.diag([2.0 * width * self.stiffness, self.rocking_stiffness]),
        )

    def statics(self, rotation: float) -> Statics:
        """Give the vertical equilibrium at a rotation, :eq:`eq-static-bed`."""
        body = self.body
        sine, cosine, rise = sine_cosine_rise(body.centre_height, self.options.rotation, rotation)
        weight = body.mass * self.gravity
        moment, middle, length = bed_statics(sine, cosine, body.half_width, self.stiffness, weight)
        whole = length >= 2.0 * body.half_width
        return Statics(
            vertical_displacement=middle - rise,
            base_moment=moment,
            restoring_moment=moment - weight * body.centre_height * sine,
            contact_state=contact_of(whole or sine < 0.0, whole or sine > 0.0),
            reactions={"soil_reaction": weight, "contact_length": length},
        )

    def equilibrium(self) -> dict[str, float]:
        """Give settlement, reaction and moment at uplift, by their names in the schema."""
        uplift = self.uplift_angle
        return {
            "soil_settlement": self.sinking,
            "static_soil_reaction": self.body.mass * self.gravity,
            "uplift_moment": math.nan if math.isnan(uplift) else self.statics(uplift).base_moment,
        }


def bed_statics(
    sine: float, cosine: float, half_width: float, stiffness: float, weight: float
) -> tuple[float, float, float]:
    """Give moment, rise of the base's middle and contact length under a weight.

    Equation :eq:`eq-static-bed`; the moment is that of the pressure about the middle
    of the base, against the rotation.
    """
    settlement = 0.5 * weight / (half_width * stiffness)
    tilt = half_width * abs(sine)
    if tilt <= settlement:
        return stiffness * half_width**3 / 1.5 * sine * cosine, 0.0, 2.0 * half_width
    length = 2.0 * math.sqrt(half_width * settlement / abs(sine))
    middle = settlement + tilt - 2.0 * math.sqrt(tilt * settlement)
    return math.copysign(weight * (half_width - length / 3.0), sine) * cosine, middle, length


def vibration_words(symbol: str, frequency: float, damping_ratio: float) -> str:
    """Write a frequency, its period and its damping ratio."""
    return (
        f"{symbol} = {frequency:.6g} rad/s (period {2.0 * math.pi / frequency:.6g} s), "
        f"damping ratio {damping_ratio:.6g}"
    )


def bed_setting(
    body: Body, soil: SIValues, options: Options, cap_offset: float | None = None
) -> WinklerSetting:
    """Put a body on a bed; a damping ratio is that of the vertical motion of all its mass."""
    damping = soil.damping
    if damping is None:
        critical = math.sqrt(2.0 * body.half_width * soil.stiffness * body.mass)
        damping = (soil.damping_ratio or 0.0) * critical / body.half_width
    return WinklerSetting(body, soil.stiffness, damping, soil.separation, options, cap_offset)


def winkler_setting(parts: Parts, options: Options) -> WinklerSetting:
    """Resolve the parts of a block on soil, or of a block and a cap as one body on soil."""
    if parts.block is None or parts.soil is None:  # the scene's signature has both
        raise TypeError
    block, soil = parts.block.si, parts.soil.si
    if parts.cap is None:
        return bed_setting(body_of(block), soil, options)
    cap = cap_under(block, parts.cap.si)
    body = one_body(block, cap)
    return bed_setting(body, soil, options, cap.half_height - body.centre_height)
