"""The scene of a block on rigid ground: its numbers and its words."""

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from rockframe.components.block import BlockSI
from rockframe.system.impact import resolve_restitution, restitution_cautions
from rockframe.system.options import Restraint, Rotation
from rockframe.system.parts import Parts

if TYPE_CHECKING:
    from rockframe.dynamics.protocol import ContactModel


@dataclass(frozen=True)
class RigidGroundSetting:
    """Numbers of a block on rigid ground, in SI units."""

    block: BlockSI
    restitution: float
    rotation: Rotation
    gravity: float

    @property
    def overturning_angle(self) -> float:
        """Theta [rad]."""
        return self.block.overturning_angle

    @property
    def uplift_angle(self) -> float:
        """Zero: any rotation lifts a corner [rad]."""
        return 0.0

    @property
    def settlement(self) -> float | None:
        """None: the ground does not give way."""
        return None

    @property
    def uplift_acceleration(self) -> float:
        """Horizontal ground acceleration at which rocking starts, g tan(theta) [m s^-2]."""
        angle = self.overturning_angle
        return self.gravity * (angle if self.rotation is Rotation.SMALL else math.tan(angle))

    def cautions(self) -> list[str]:
        """Give warnings about the restitution."""
        return restitution_cautions(self.restitution, self.block.maximum_restitution)

    def start_faults(self, rotation: float, has_vertical_start: bool) -> list[str]:
        """Refuse a vertical start: the ground leaves no vertical freedom."""
        if has_vertical_start:
            return [
                "InitialState: vertical_displacement and vertical_velocity need a base that "
                "gives way; on rigid ground they follow from the rotation"
            ]
        return []

    def equations(self) -> list[tuple[str, str]]:
        """Give each contact state with the equation that governs it."""
        form = "small rotation: " if self.rotation is Rotation.SMALL else ""
        rocking = (
            form + "a'' = -omega^2 [(1 + yg''/g) sin(theta s - a) + (xg''/g) cos(theta s - a)]"
            if not form
            else form + "a'' = -omega^2 [(1 + yg''/g) (theta s - a) + xg''/g]"
        )
        return [
            ("full", f"at rest until |xg''| exceeds (g + yg'') tan(theta), "
             f"{self.uplift_acceleration:.4g} m s^-2 without vertical motion"),
            ("left, right", f"{rocking}, s = sgn(a) (Housner; Eq. (6) for omega)"),
            ("impact", f"a' after = {self.restitution:.6g} a' before, at a = 0 (Eq. (4) is the "
             "greatest value)"),
        ]  # fmt: skip

    def numbers(self) -> list[tuple[str, str]]:
        """Give the rocking frequency and the restitution."""
        omega = self.block.frequency_at(self.gravity)
        return [
            ("rocking frequency omega, Eq. (6)", f"{omega:.6g} rad/s"),
            ("restitution eps", f"{self.restitution:.6g}"),
        ]

    def restraint_rule(self) -> str:
        """Say which point is held."""
        return "the bearing corner does not slide (the restraint options make no difference)"

    def left_out(self) -> list[str]:
        """Say what the model does not have."""
        return [
            "sliding",
            "elasticity of block and ground",
            "flight (a vertical ground acceleration beyond gravity would need it)",
        ]

    def compile(self) -> "ContactModel":
        """Give the equations, ready for the integrator."""
        from rockframe.dynamics.rigid_ground import rigid_ground

        return rigid_ground(
            overturning_angle=self.overturning_angle,
            radius=self.block.radius,
            shape_factor=self.block.shape_factor,
            mass=self.block.mass,
            restitution=self.restitution,
            small_rotation=self.rotation is Rotation.SMALL,
            gravity=self.gravity,
        )


def rigid_ground_setting(
    parts: Parts, restraint: Restraint, rotation: Rotation, gravity: float
) -> RigidGroundSetting:
    """Resolve the parts of a scene on rigid ground."""
    block = parts.block.si if parts.block is not None else None
    if block is None:  # the scene's signature has a block
        raise TypeError
    given = parts.ground.si.restitution if parts.ground is not None else None
    return RigidGroundSetting(block, resolve_restitution(given, block), rotation, gravity)
