"""The scene of a block on two pads: its numbers and its words."""

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from rockframe.components.block import BlockSI
from rockframe.components.values import SIValues
from rockframe.system.angles import uplift_words
from rockframe.system.impact import resolve_restitution, restitution_cautions
from rockframe.system.options import Options, Restraint, Rotation
from rockframe.system.parts import Parts
from rockframe.system.restraints import restraint_code, restraint_words
from rockframe.system.small_motion import SmallMotion
from rockframe.system.statics import Statics, contact_of, sine_cosine_rise

if TYPE_CHECKING:
    from rockframe.dynamics.protocol import ContactModel


@dataclass(frozen=True)
class TwoSpringSetting:
    """Numbers of a block on two pads, in SI units."""

    block: BlockSI
    stiffness: float
    damping: float
    restitution: float
    restraint: Restraint
    rotation: Rotation
    gravity: float

    @property
    def overturning_angle(self) -> float:
        """Theta [rad]."""
        return self.block.overturning_angle

    @property
    def settlement(self) -> float | None:
        """Delta = mg/2k [m]."""
        return 0.5 * self.block.mass * self.gravity / self.stiffness

    @property
    def uplift_angle(self) -> float:
        """Rotation at which a corner lifts, Eq. (16); NaN if the pads are too soft [rad]."""
        ratio = 0.5 * self.block.mass * self.gravity / self.stiffness / self.block.half_width
        if self.rotation is Rotation.SMALL:
            return ratio
        return math.asin(ratio) if ratio <= 1.0 else math.nan

    @property
    def cap_offset(self) -> float | None:
        """None: there is no cap [m]."""
        return None

    @property
    def vertical_frequency(self) -> float:
        """omega_v = sqrt(2k/m), Eq. (7a) [rad s^-1]."""
        return math.sqrt(2.0 * self.stiffness / self.block.mass)

    @property
    def vertical_damping_ratio(self) -> float:
        """Xi = c/(m omega_v), Eq. (7b) [1]."""
        return self.damping / (self.block.mass * self.vertical_frequency)

    @property
    def rocking_stiffness(self) -> float:
        """2 k b^2 - m g h, of small rotations in full contact [N m rad^-1]."""
        block = self.block
        lifting = block.mass * self.gravity * block.half_height
        return 2.0 * self.stiffness * block.half_width**2 - lifting

    @property
    def base_inertia(self) -> float:
        """I_M = I_O + m h^2 [kg m^2]."""
        return self.block.inertia + self.block.mass * self.block.half_height**2

    def cautions(self) -> list[str]:
        """Give warnings about restitution and stability."""
        found = restitution_cautions(self.restitution, self.block.maximum_restitution)
        if self.rocking_stiffness <= 0.0:
            found.append(
                "the pads are too soft to hold the block upright: 2 k b^2 is below m g h, so "
                "that the smallest disturbance overturns it"
            )
        return found

    def start_faults(self, rotation: float, has_vertical_start: bool) -> list[str]:
        """Give no faults: every state can start a run."""
        return []

    def equations(self) -> list[tuple[str, str]]:
        """Give each contact state with the equation that governs it."""
        return [
            ("full", "Eq. (12), corrected: 2 zeta sin(a)/(beta omega) in (12a); sin(2a)/2, "
             "beta^2 omega^4/g and 2 zeta/(beta omega) in (12b)"),
            ("left", "Eq. (15), upper signs, corrected: [cos(theta) - cos(theta + a) + ...] in "
             "(15a); the sign of the bearing corner and omega^4 in (15b)"),
            ("right", "Eq. (15), lower signs, with the same corrections"),
            ("flight", "free fall and constant rotation rate (left out by the paper)"),
            ("impact", f"a landing corner keeps {self.restitution:.6g} of its speed, "
             "Eqs. (2)-(4) with the corner inertia for the printed I_O"),
        ]  # fmt: skip

    def uplift_rows(self) -> list[tuple[str, str]]:
        """Give the uplift angle, Eq. (16)."""
        return [("uplift angle, Eq. (16)", uplift_words(self.uplift_angle))]

    def numbers(self) -> list[tuple[str, str]]:
        """Give stiffness, damping, frequencies and damping ratios."""
        omega = self.block.frequency_at(self.gravity)
        rows = [
            ("rocking frequency omega, Eq. (6)", f"{omega:.6g} rad/s"),
            ("frequency ratio beta, Eq. (8)", f"{self.vertical_frequency / omega:.6g}"),
            ("pad stiffness k, damping c", f"{self.stiffness:.6g} N/m, {self.damping:.6g} N s/m"),
            ("settlement delta", f"{self.settlement:.6g} m"),
            (
                "vertical vibration",
                f"omega_v = {self.vertical_frequency:.6g} rad/s "
                f"(period {2.0 * math.pi / self.vertical_frequency:.6g} s), "
                f"damping ratio {self.vertical_damping_ratio:.6g}",
            ),
        ]
        if self.rocking_stiffness > 0.0:
            rate = math.sqrt(self.rocking_stiffness / self.base_inertia)
            ratio = self.damping * self.block.half_width**2 / (self.base_inertia * rate)
            rows.append(
                (
                    "rocking vibration in full contact",
                    f"omega_r = {rate:.6g} rad/s (period {2.0 * math.pi / rate:.6g} s), "
                    f"damping ratio {ratio:.6g}",
                )
            )
        rows.append(("restitution eps", f"{self.restitution:.6g}"))
        return rows

    def restraint_rule(self) -> str:
        """Say which point of the base is held horizontally."""
        return restraint_words(self.restraint, self.rotation)

    def left_out(self) -> list[str]:
        """Say what the model does not have."""
        return ["sliding", "elasticity of the block", "tension in the pads"]

    def compile(self) -> "ContactModel":
        """Give the equations, ready for the integrator."""
        from rockframe.dynamics.two_spring_model import two_spring

        return two_spring(
            half_width=self.block.half_width,
            half_height=self.block.half_height,
            shape_factor=self.block.shape_factor,
            mass=self.block.mass,
            stiffness=self.stiffness,
            damping=self.damping,
            restitution=self.restitution,
            restraint=restraint_code(self.restraint),
            small_rotation=self.rotation is Rotation.SMALL,
            gravity=self.gravity,
        )

    def small_motion(self) -> SmallMotion:
        """Give the equations of small motion in full contact, Eq. (12) to first order."""
        width = self.block.half_width
        return SmallMotion(
            ("vertical_displacement", "rotation"),
            np.diag([self.block.mass, self.base_inertia]),
            2.0 * self.damping * np.diag([1.0, width**2]),
            np.diag([2.0 * self.stiffness, self.rocking_stiffness]),
        )

    def statics(self, rotation: float) -> Statics:
        """Give the vertical equilibrium at a rotation, :eq:`eq-static-pads`."""
        sine, cosine, rise = sine_cosine_rise(self.block.half_height, self.rotation, rotation)
        weight = self.block.mass * self.gravity
        lift = self.block.half_width * sine
        left = 0.5 * weight - self.stiffness * lift
        right = weight - left
        middle = 0.0
        if left < 0.0 or right < 0.0:
            left, right = (0.0, weight) if sine > 0.0 else (weight, 0.0)
            middle = abs(lift) - 0.5 * weight / self.stiffness
        moment = (right - left) * self.block.half_width * cosine
        return Statics(
            vertical_displacement=middle - rise,
            base_moment=moment,
            restoring_moment=moment - weight * self.block.half_height * sine,
            contact_state=contact_of(left > 0.0, right > 0.0),
            reactions={"left_reaction": left, "right_reaction": right},
        )

    def equilibrium(self) -> dict[str, float]:
        """Give settlement, reactions and moment at uplift, by their names in the schema."""
        half = 0.5 * self.block.mass * self.gravity
        uplift = self.uplift_angle
        return {
            "uplift_moment": math.nan if math.isnan(uplift) else self.statics(uplift).base_moment,
            "pad_settlement": half / self.stiffness,
            "static_left_reaction": half,
            "static_right_reaction": half,
        }


def pad_constants(pads: SIValues, block: BlockSI, gravity: float) -> tuple[float, float]:
    """Give stiffness and damping of one pad, Eqs. (7) and (8).

    Parameters
    ----------
    pads : SIValues
        As given by the user.
    block : BlockSI
        The block on them.
    gravity : float
        Acceleration of gravity [m s^-2].

    Returns
    -------
    stiffness, damping : float
        [N m^-1], [N s m^-1].
    """
    if pads.stiffness is not None:
        stiffness = pads.stiffness
        vertical = math.sqrt(2.0 * stiffness / block.mass)
    else:
        vertical = (pads.frequency_ratio or 0.0) * block.frequency_at(gravity)
        stiffness = 0.5 * block.mass * vertical**2
    if pads.damping is not None:
        return stiffness, pads.damping
    return stiffness, (pads.damping_ratio or 0.0) * block.mass * vertical


def two_spring_setting(parts: Parts, options: Options) -> TwoSpringSetting:
    """Resolve the parts of a scene on two pads."""
    if parts.block is None or parts.pads is None:  # the scene's signature has both
        raise TypeError
    block, pads = parts.block.si, parts.pads.si
    stiffness, damping = pad_constants(pads, block, options.gravity)
    return TwoSpringSetting(
        block=block,
        stiffness=stiffness,
        damping=damping,
        restitution=resolve_restitution(pads.restitution, block),
        restraint=options.restraint,
        rotation=options.rotation,
        gravity=options.gravity,
    )
