"""The scene of a block on rigid ground: its numbers and its model."""

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from rockframe.components.block import BlockSI
from rockframe.system.bodies import Body, body_of
from rockframe.system.impact import Restitutions, resolve_restitution, restitution_cautions
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
    restitution: Restitutions
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
        """Theta, of the side that falls first [rad]."""
        return self.body.overturning_angles.least

    @property
    def rest_rotation(self) -> float:
        """Zero: the whole base bears [rad]."""
        return 0.0

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
        """Horizontal ground acceleration at which rocking starts, g tan(theta) [m s^-2].

        Of the side that lifts first.
        """
        return min(self.uplift_accelerations)

    @property
    def uplift_accelerations(self) -> tuple[float, float]:
        """The same for rocking about the left and about the right corner [m s^-2].

        Ground that is accelerated to the right tips the block to the left.
        """
        small = self.rotation is Rotation.SMALL
        left, right = (
            self.gravity * (angle if small else math.tan(angle))
            for angle in self.body.overturning_angles
        )
        return left, right

    def cautions(self) -> list[str]:
        """Give warnings about the restitution."""
        return restitution_cautions(self.restitution, self.body.maximum_restitution)

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
        from rockframe.dynamics.rigid_ground import corner_of, rigid_ground

        body, small = self.body, self.rotation is Rotation.SMALL
        left, right = (
            corner_of(
                distance=distance,
                height=body.centre_height,
                inertia=body.gyration_square_about(distance),
                restitution=restitution,
                small_rotation=small,
            )
            for distance, restitution in zip((body.left, body.right), self.restitution, strict=True)
        )
        return rigid_ground(left, right, mass=body.mass, small_rotation=small, gravity=self.gravity)

    def small_motion(self) -> SmallMotion | None:
        """Give None: a rigid base leaves no small motion; the period depends on the amplitude."""
        return None

    def statics(self, rotation: float) -> Statics:
        """Give the equilibrium at a rotation: the bearing corner carries the weight."""
        body = self.body
        if rotation == 0.0:
            # the moments of weight and reactions about the middle of the base
            moment = self.weight * body.eccentricity
            return Statics(
                0.0, moment, 0.0, "full", dict(zip(_REACTIONS, self.shares, strict=True))
            )
        side = math.copysign(1.0, rotation)
        theta, lean = body.overturning_angles.on_side_of(rotation), abs(rotation)
        beside = side * body.eccentricity
        radius = math.hypot(body.half_width - beside, body.centre_height)
        if self.rotation is Rotation.SMALL:
            rise, restoring = radius * lean * (theta - 0.5 * lean), theta - lean
            weight_arm = radius * lean + beside
        else:
            rise = 2.0 * radius * math.sin(theta - 0.5 * lean) * math.sin(0.5 * lean)
            restoring = math.sin(theta - lean)
            weight_arm = body.centre_height * math.sin(lean) + beside * math.cos(lean)
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
        uplift = self.weight * self.body.half_width
        shares = zip(_REACTIONS, self.shares, strict=True)
        return {"uplift_moment": uplift} | {f"static_{name}": force for name, force in shares}

    @property
    def shares(self) -> tuple[float, float]:
        """Reactions of the left and of the right corner at rest [N]."""
        # in proportion to what it takes to lift the other one
        left, right = self.uplift_accelerations
        half, tilt = 0.5 * self.weight, 0.5 * (left - right) / (left + right)
        return half - self.weight * tilt, half + self.weight * tilt


def rigid_ground_setting(parts: Parts, options: Options) -> RigidGroundSetting:
    """Resolve the parts of a scene on rigid ground."""
    block = parts.the_block
    given = parts.ground.si.restitution if parts.ground is not None else None
    restitution = resolve_restitution(given, body_of(block).maximum_restitution)
    return RigidGroundSetting(block, restitution, options.rotation, options.gravity)
