"""The scenes of a block on pads on a cap on soil, by cascade and coupled."""

import math
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from rockframe.components.soil import Separation
from rockframe.errors import SolverError
from rockframe.system.angles import uplift_words
from rockframe.system.bodies import Cap, cap_under, one_body
from rockframe.system.options import Options
from rockframe.system.parts import Parts
from rockframe.system.restraints import restraint_code, restraint_words
from rockframe.system.small_motion import SmallMotion
from rockframe.system.statics import Statics, contact_of, sine_cosine_rise
from rockframe.system.two_spring import TwoSpringSetting, two_spring_setting
from rockframe.system.winkler import WinklerSetting, bed_setting, bed_statics

if TYPE_CHECKING:
    from rockframe.dynamics.protocol import ContactModel

LEAST_CAP_SHARE = 1e-3
"""Least mass of a cap, as a share of the block's, with which the coupled equations are
solved: a plate without mass has no acceleration. Halving it changes histories of the
paper's example by up to 3e-3 of their peak, page "Coupled" of the manual."""


STATIC_STEPS = 200
"""Steps in which the cap's tilt under a held block is searched."""


@dataclass(frozen=True)
class StackedSetting:
    """Numbers of a block on pads on a cap on soil, in SI units.

    Parameters
    ----------
    upper : TwoSpringSetting
        The block on its pads.
    lower : WinklerSetting
        Block and cap as one body on the soil.
    cap : Cap
        The cap.
    options : Options
        Of the system.
    """

    upper: TwoSpringSetting
    lower: WinklerSetting
    cap: Cap
    options: Options

    @property
    def gravity(self) -> float:
        """Acceleration of gravity [m s^-2]."""
        return self.options.gravity

    @property
    def overturning_angle(self) -> float:
        """Theta of the block [rad]."""
        return self.upper.overturning_angle

    @property
    def settlement(self) -> float | None:
        """Delta = mg/2k, of the block on the pads [m]."""
        return self.upper.settlement

    @property
    def uplift_angle(self) -> float:
        """Rotation on the cap at which a corner lifts, Eq. (16) [rad]."""
        return self.upper.uplift_angle

    @property
    def cap_offset(self) -> float | None:
        """Height of the cap's centre above that of cap and block as one body [m]."""
        return self.lower.cap_offset

    def cautions(self) -> list[str]:
        """Give the warnings of block and soil."""
        return [*self.upper.cautions(), *self.lower.cautions()]

    def start_faults(self, rotation: float, has_vertical_start: bool) -> list[str]:
        """Give no faults: every state can start a run."""
        return []

    def uplift_rows(self) -> list[tuple[str, str]]:
        """Give the uplift angles of block and cap, with the moments at which they are reached."""
        rows = (
            ("on the pads, Eq. (16)", self.upper, "of block against cap"),
            ("on the soil, arcsin(delta/b)", self.lower, "of cap against ground"),
        )
        return [
            (f"uplift angle {name}", _uplift_of(setting, whose)) for name, setting, whose in rows
        ]

    def numbers(self) -> list[tuple[str, str]]:
        """Give the numbers of the block on its pads and of both on the soil."""
        cap = self.cap
        return [
            *((f"pads: {name}", words) for name, words in self.upper.numbers()),
            ("cap", f"{2.0 * cap.half_width:.6g} m by {2.0 * cap.half_height:.6g} m, "
             f"{cap.mass:.6g} kg"),
            *((f"soil: {name}", words) for name, words in self.lower.numbers()),
        ]  # fmt: skip

    def restraint_rule(self) -> str:
        """Say which points are held horizontally."""
        rule = restraint_words(self.options.restraint, self.options.rotation)
        return f"of the block on the cap and of the cap on the soil alike; {rule}"

    def left_out(self) -> list[str]:
        """Say what the model does not have."""
        return [
            "sliding",
            "elasticity of block and cap",
            "tension in the pads",
            "yielding of the soil",
            "impact on the soil",
        ]

    def small_motion(self) -> SmallMotion:
        """Give the equations of small motion of block and cap, :eq:`eq-coupled-small`."""
        from rockframe.dynamics.coupled_model import small_motion_matrices

        model = _coupled_model(self)
        mass, damping, stiffness = small_motion_matrices(model.parameters)
        # from coordinates on the cap to displacements of the block
        names = ("cap_vertical_displacement", "cap_rotation", "vertical_displacement", "rotation")
        to_own = np.eye(4)
        to_own[2, 0] = to_own[3, 1] = -1.0  # r = y - Y, psi = alpha - phi
        turned = [to_own.T @ matrix @ to_own for matrix in (mass, damping, stiffness)]
        return SmallMotion(names, *(model.mass * matrix for matrix in turned))

    def statics(self, rotation: float) -> Statics:
        """Give the equilibrium with the block held at a rotation, :eq:`eq-static-stack`."""
        tilt = self._tilt_under(rotation)
        _, moment, couple, rise, pads, length = self._held(tilt, rotation)
        return Statics(
            vertical_displacement=rise,
            base_moment=moment,
            restoring_moment=couple,
            contact_state=contact_of(pads[0] > 0.0, pads[1] > 0.0),
            reactions={
                "left_reaction": pads[0],
                "right_reaction": pads[1],
                "soil_reaction": self.lower.body.mass * self.gravity,
                "contact_length": length,
                "cap_rotation": tilt,
            },
        )

    def _tilt_under(self, rotation: float) -> float:
        """Give the least rotation of the cap at which it is in balance under the held block."""
        from scipy.optimize import root_scalar

        def lack(tilt: float) -> float:
            return math.copysign(1.0, rotation) * self._held(tilt, rotation)[0]

        if rotation == 0.0:
            return 0.0
        # a far held block leaves the cap a second, larger tilt, which is not stable
        steps = np.linspace(0.0, rotation, STATIC_STEPS + 1).tolist()
        for low, high in pairwise(steps):
            if lack(low) <= 0.0 < lack(high):
                return root_scalar(lack, bracket=(low, high), xtol=1e-15, rtol=1e-14).root
        msg = (
            f"no equilibrium of cap and soil was found with the block held at {rotation:.6g} rad: "
            "the soil cannot carry the moment"
        )
        raise SolverError(msg)

    def _held(
        self, tilt: float, rotation: float
    ) -> tuple[float, float, float, float, tuple[float, float], float]:
        """Give the cap's lack of balance at its rotation, and the static state there."""
        block, cap, g = self.upper.block, self.cap, self.gravity
        rule = self.options.rotation
        h, b, k, weight = block.half_height, block.half_width, self.upper.stiffness, block.mass * g
        frame_sine, frame_cosine = math.sin(tilt), math.cos(tilt)
        # the block on the cap, under the weight along the cap's normal
        sine, cosine, rise = sine_cosine_rise(h, rule, rotation - tilt)
        press = weight * frame_cosine
        left = 0.5 * press - k * b * sine
        right = press - left
        if left < 0.0 or right < 0.0:
            left, right = (0.0, press) if sine > 0.0 else (press, 0.0)
        held_left, held_right = left > 0.0, right > 0.0
        middle = 0.5 * (weight - left - right) / k
        if not (held_left and held_right):
            middle = b * abs(sine) - (press / k - 0.5 * weight / k)
        normal = middle - rise
        pad_moment = left * (h * sine + b * cosine) + right * (h * sine - b * cosine)
        pin = self._pin(held_left, held_right, rotation - tilt)
        across = pin + h * sine - pin * cosine
        slide = h if self.options.small else h * cosine + pin * sine
        # the cap: thrust along it, its own weight on the soil
        thrust = -weight * frame_sine
        sine, cosine, cap_rise = sine_cosine_rise(cap.half_height, rule, tilt)
        all_weight = self.lower.body.mass * g
        moment, cap_middle, length = bed_statics(
            sine, cosine, cap.half_width, self.lower.stiffness, all_weight
        )
        soil = all_weight * cap.half_height * sine - moment
        arm = cap.half_height + h + normal
        lack = (arm - slide) * thrust - across * press + pad_moment - soil
        couple = slide * thrust - pad_moment
        drop = (cap.half_height + h) * 2.0 * math.sin(0.5 * tilt) ** 2
        height = cap_middle - cap_rise + normal * frame_cosine - across * frame_sine - drop
        return lack, moment, couple, height, (left, right), length

    def _pin(self, left: bool, right: bool, rotation: float) -> float:
        """Give the held point of the block's base in a static state."""
        from rockframe.system.options import Restraint

        if self.options.small or self.options.restraint is Restraint.CENTRE:
            return 0.0
        half = self.upper.block.half_width
        if self.options.restraint is Restraint.CONTACT_STATE:
            return 0.0 if left and right else (half if right else -half)
        return math.copysign(half, rotation) if rotation != 0.0 else 0.0

    def equilibrium(self) -> dict[str, float]:
        """Give settlements and reactions at rest, by their names in the schema."""
        soil = self.lower.equilibrium()
        soil["soil_uplift_moment"] = soil.pop("uplift_moment")
        return {**self.upper.equilibrium(), **soil}


class CoupledSetting(StackedSetting):
    """Block and cap with one set of equations."""

    def cautions(self) -> list[str]:
        """Give the warnings of block and soil, and of a cap that is too light."""
        found = super().cautions()
        if self.cap.mass < LEAST_CAP_SHARE * self.upper.block.mass:
            found.append(
                f"the cap's mass, {self.cap.mass:.4g} kg, is less than {LEAST_CAP_SHARE:g} of the "
                "building's; the coupled equations are solved with that share of it"
            )
        return found

    def equations(self) -> list[tuple[str, str]]:
        """Give each contact state with the equation that governs it."""
        pads = dict(self.upper.equations())
        return [
            ("block: full, left, right", "four degrees of freedom, one Lagrangian; pad forces as "
             "in Eqs. (12) and (15), along the cap's normal"),
            ("block: flight", "free fall of the block, the cap alone on the soil"),
            ("block: impact", pads["impact"] + "; an impulse between block and cap"),
            ("cap: full, left, right", "soil's resultants as in Eqs. (18) and (19), for the cap"),
            ("cap: flight", "no soil force; block and cap fall together or apart"),
        ]  # fmt: skip

    def compile(self) -> "ContactModel":
        """Give the equations, ready for the integrator."""
        return _coupled_model(self)


class CascadeSetting(StackedSetting):
    """Two stages, Eq. (20): both as one body on the soil, then the block on the moving cap."""

    def equations(self) -> list[tuple[str, str]]:
        """Give each stage's contact states with the equations that govern them."""
        return [
            ("total", "Eq. (20): rotation and displacement of stage 1 plus those of stage 2"),
            *((f"stage 1, {name}", words) for name, words in self.lower.equations()),
            *((f"stage 2, {name}", words) for name, words in self.upper.equations()),
        ]

    def left_out(self) -> list[str]:
        """Say what the model does not have."""
        return [
            *super().left_out(),
            "what the block's motion on the pads does to cap and soil",
            "the cap's inclination, for the block",
        ]

    def compile(self) -> "ContactModel":
        """Give the equations of both stages, ready for the integrator."""
        from rockframe.dynamics.cascade_model import cascade

        centre = self.cap.half_height - self.lower.body.centre_height
        return cascade(
            self.lower.compile(),
            self.upper.compile(),
            top=centre + self.cap.half_height,
            cap_centre=centre,
        )


def _uplift_of(setting: TwoSpringSetting | WinklerSetting, whose: str) -> str:
    words = uplift_words(setting.uplift_angle)
    if math.isnan(setting.uplift_angle):
        return words
    return f"{words} {whose}, at a moment of {setting.equilibrium()['uplift_moment']:.6g} N m"


def _coupled_model(setting: StackedSetting) -> "ContactModel":
    from rockframe.dynamics.coupled_model import coupled

    block, cap, upper, lower = setting.upper.block, setting.cap, setting.upper, setting.lower
    least = LEAST_CAP_SHARE * block.mass
    light = cap.mass < least
    return coupled(
        half_width=block.half_width,
        half_height=block.half_height,
        inertia=block.inertia,
        mass=block.mass,
        pad_stiffness=upper.stiffness,
        pad_damping=upper.damping,
        restitution=upper.restitution,
        cap_half_width=cap.half_width,
        cap_half_height=cap.half_height,
        cap_mass=least if light else cap.mass,
        cap_inertia=least * cap.half_width**2 / 3.0 if light else cap.inertia,
        soil_stiffness=lower.stiffness,
        soil_damping=lower.damping,
        by_pressure=lower.separation is Separation.PRESSURE,
        restraint=restraint_code(setting.options.restraint),
        small_rotation=setting.options.small,
        gravity=setting.gravity,
    )


def _stack(parts: Parts, options: Options) -> tuple[TwoSpringSetting, WinklerSetting, Cap]:
    if parts.block is None or parts.cap is None or parts.soil is None:  # all in the signature
        raise TypeError
    block = parts.block.si
    cap = cap_under(block, parts.cap.si)
    body = one_body(block, cap)
    offset = cap.half_height - body.centre_height
    return (
        two_spring_setting(parts, options),
        bed_setting(body, parts.soil.si, options, offset),
        cap,
    )


def coupled_setting(parts: Parts, options: Options) -> CoupledSetting:
    """Resolve the parts of a block on pads on a cap on soil, coupled."""
    return CoupledSetting(*_stack(parts, options), options)


def cascade_setting(parts: Parts, options: Options) -> CascadeSetting:
    """Resolve the parts of a block on pads on a cap on soil, by cascade."""
    return CascadeSetting(*_stack(parts, options), options)
