"""The scene of a block on rigid ground: its numbers and its model."""

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from rockframe.components.block import BlockSI
from rockframe.system.bodies import Body, body_of
from rockframe.system.impact import resolve_restitution, restitution_cautions
from rockframe.system.options import Options, Rotation
from rockframe.system.parts import Parts
from rockframe.system.rigid_ground_words import rigid_ground_words
from rockframe.system.small_motion import SmallMotion
from rockframe.system.statics import Statics
from rockframe.system.words import Words

if TYPE_CHECKING:
    from rockframe.dynamics.protocol import ContactModel


_REACTIONS = ("left_reaction", "right_reaction")


@dataclass(frozen=True)
class RigidGroundSetting:
    """Numbers of a block on rigid ground, in SI units."""

    block: BlockSI
    restitution: float
    rotation: Rotation
    gravity: float

    @property
    def model(self) -> str:
        """Name of the model."""
        return "rigid ground"

    @property
    def body(self) -> Body:
        """The block."""
        return body_of(self.block)

    @property
    def overturning_angle(self) -> float:
        """Theta [rad]."""
        return self.block.overturning_angle

    @property
    def uplift_angle(self) -> float:
        """Zero: any rotation lifts a corner [rad]."""
        return 0.0

    @property
    def cap_offset(self) -> float | None:
        """None: there is no cap [m]."""
        return None

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

    def words(self) -> Words:
        """Tell the block on rigid ground."""
        return rigid_ground_words(self)

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

    def small_motion(self) -> SmallMotion | None:
        """Give None: a rigid base leaves no small motion; the period depends on the amplitude."""
        return None

    def statics(self, rotation: float) -> Statics:
        """Give the equilibrium at a rotation: the bearing corner carries the weight."""
        if rotation == 0.0:
            return Statics(0.0, 0.0, 0.0, "full", dict.fromkeys(_REACTIONS, 0.5 * self.weight))
        side = math.copysign(1.0, rotation)
        theta, lean = self.overturning_angle, abs(rotation)
        radius = self.block.radius
        if self.rotation is Rotation.SMALL:
            rise, restoring = radius * lean * (theta - 0.5 * lean), theta - lean
            weight_arm = radius * lean
        else:
            rise = 2.0 * radius * math.sin(theta - 0.5 * lean) * math.sin(0.5 * lean)
            restoring = math.sin(theta - lean)
            weight_arm = self.block.half_height * math.sin(lean)
        moment = side * self.weight * radius * restoring
        reactions = (0.0, self.weight) if side > 0.0 else (self.weight, 0.0)
        return Statics(
            vertical_displacement=rise,
            base_moment=moment + side * self.weight * weight_arm,
            restoring_moment=moment,
            contact_state="right" if side > 0.0 else "left",
            reactions=dict(zip(_REACTIONS, reactions, strict=True)),
        )

    @property
    def weight(self) -> float:
        """Weight of the block [N]."""
        return self.block.mass * self.gravity

    def equilibrium(self) -> dict[str, float]:
        """Give the reactions at rest and the moment at uplift, by their names in the schema."""
        uplift = self.weight * self.block.half_width
        return {"uplift_moment": uplift} | {
            f"static_{name}": 0.5 * self.weight for name in _REACTIONS
        }


def rigid_ground_setting(parts: Parts, options: Options) -> RigidGroundSetting:
    """Resolve the parts of a scene on rigid ground."""
    block = parts.the_block
    given = parts.ground.si.restitution if parts.ground is not None else None
    restitution = resolve_restitution(given, block.maximum_restitution)
    return RigidGroundSetting(block, restitution, options.rotation, options.gravity)
