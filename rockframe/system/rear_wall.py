"""The scene of a block on rigid ground in front of a stiff wall: one-sided rocking."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Final, NamedTuple, cast

from rockframe.components import RearWall
from rockframe.components.block_numbers import BlockSI
from rockframe.components.link import WallImpact, WallSide
from rockframe.dynamics.protocol import ContactModel
from rockframe.errors import AssemblyError
from rockframe.system.bodies import (
    BaseLoad,
    CornerSupportedBody,
    OverturningAngles,
    Restitutions,
    SupportedBody,
    base_restitution,
    block_body,
)
from rockframe.system.options import Options
from rockframe.system.parts import Parts
from rockframe.system.rigid_ground import RigidGroundSetting
from rockframe.system.setting import FRICTION_TO_ROCK, Words
from rockframe.system.statics import Statics

_INTO_WALL: Final = "is into the RearWall"
IMPACT_TIME: Final = 1e-3
"""Duration of an impact on the elastic wall that messages propose for a stiff one [s]."""


@dataclass(frozen=True)
class RearWallSetting(RigidGroundSetting):
    """A block on rigid ground in front of a wall."""

    wall: RearWall
    rebound: float  # angular velocity after an impact over that before it [1]
    height: float  # height of the block [m]
    name = "rigid ground with a wall"
    struck_by_base = False
    flight_advice = "; give the wall a stiffness to follow its flight"

    @property
    def direction(self) -> float:
        """Sign of the rotations that the wall allows."""
        return -self.wall.direction

    def __post_init__(self) -> None:
        super().__post_init__()
        # the angle of the open side for both sides: the block never rotates into the wall
        outwards = self.overturning_angles.on_side_of(self.direction)
        vars(self).update(overturning_angles=OverturningAngles(outwards, outwards))

    @property
    def overturning_rotations(self) -> tuple[float, ...]:
        """The rotation at which it stands on edge, away from the wall [rad]."""
        return (self.direction * self.overturning_angle,)

    @property
    def uplift_accelerations(self) -> tuple[float, float]:
        """Ground accelerations at which it begins to rock; infinite towards the wall [m s^-2]."""
        left, right = super().uplift_accelerations
        return (math.inf, right) if self.direction > 0.0 else (left, math.inf)

    def friction_to_rock(self) -> dict[str, float]:
        """Return the friction below which it slides before it rocks away from the wall."""
        half = self.body.right if self.direction > 0.0 else self.body.left
        return {f"{FRICTION_TO_ROCK} b/h": half / self.body.centre_height}

    def start_faults(self, rotation: float, has_vertical_start: bool) -> list[str]:
        """Return the faults of an initial state; a rotation into the wall is one."""
        faults = super().start_faults(rotation, has_vertical_start)
        if rotation * self.direction < 0.0:
            faults.append(f"InitialState: a rotation to the {self.wall.given.side} {_INTO_WALL}")
        return faults

    def faults_of_velocity(self, rotation: float, angular_velocity: float) -> list[str]:
        """Return the fault of an upright body that would start with a velocity into the wall."""
        if rotation == 0.0 and angular_velocity * self.direction < 0.0:
            side = self.wall.given.side
            return [f"InitialState: an angular velocity to the {side} at no rotation {_INTO_WALL}"]
        return []

    def contact_model(self) -> ContactModel:
        """Return Housner's equations, with the wall on its side."""
        model = super().contact_model()
        share = self.body.centre_height / self.height
        system = model.system._replace(  # type: ignore[attr-defined]
            wall=-self.direction, wall_restitution=self.rebound, wall_share=share
        )
        return replace(model, system=system)

    def curve(self, rotations: Sequence[float]) -> list[Statics | None]:
        """Return the quasi-static states at rotations; none in the wall."""
        return [
            None if rotation * self.direction < 0.0 else state
            for rotation, state in zip(rotations, super().curve(rotations), strict=True)
        ]

    def held_at(self, rotations: Sequence[float]) -> list[Statics]:
        """Return the quasi-static states at rotations [rad]; refuse those in the wall."""
        for rotation in rotations:
            if rotation * self.direction < 0.0:
                msg = (
                    f"a rotation of {rotation:.6g} rad is into the RearWall, on the "
                    f"{self.wall.given.side}: give rotations to the other side"
                )
                raise AssemblyError([msg])
        return super().held_at(rotations)

    def words(self) -> Words:
        """Describe the block in front of its wall."""
        inherited, law = super().words(), self.wall.given.restitution
        named = f'law "{law}"' if isinstance(law, WallImpact) else "as given"
        away = "right" if self.direction > 0.0 else "left"
        rest, rocking, _ = inherited.equations
        return replace(
            inherited,
            equations=[
                rest,
                (away, rocking[1]),
                ("impact", f"a' after = {self.rebound:.6g} a' before, at a = 0, on base and wall "
                 f"({named})"),
            ],
            numbers=[
                *inherited.numbers[:-1],
                ("wall", f"on the {self.wall.given.side}, rebound {self.rebound:.6g} ({named})"),
            ],
            left_out=[*inherited.left_out, "elasticity of the wall"],
        )  # fmt: skip

    def _start_words(self) -> str:
        """Say when rocking starts."""
        away, needed = ("right", "left") if self.direction > 0.0 else ("left", "right")
        return (
            f"at rest until the ground is accelerated to the {needed} by more than (g + yg'') "
            f"tan(theta), {self.uplift_acceleration:.4g} m s^-2 without vertical motion, which "
            f"tips the block to the {away}; to the other side the wall holds it"
        )


def rear_wall_setting(parts: Parts, options: Options) -> RearWallSetting:
    """Resolve the parts of a block in front of a wall."""
    load = BaseLoad(block_body(parts.block_si, CornerSupportedBody), options)
    wall = cast("RearWall", parts.wall)
    restitution = base_restitution(parts.ground, load.body.maximum_restitution)
    if not load.options.slope.level:
        raise AssemblyError(["RearWall: a wall stands on level ground, without inclination"])
    height = parts.block_si.height
    rebound = _rebound_ratio(wall, load.body, restitution, height)
    return RearWallSetting(load, restitution, wall, rebound, height)


def _rebound_ratio(
    wall: RearWall, body: SupportedBody, restitution: Restitutions, height: float
) -> float:
    """Return the ratio of the angular velocities at an impact, :eq:`eq-wall-impact`."""
    law = wall.given.restitution
    if not isinstance(law, WallImpact):
        return float(law)
    ratio = restitution.left * restitution.right * _wall_ratio(wall, body, height)
    if ratio < 0.0 or law is WallImpact.NEWTON:
        return ratio
    slenderness = 0.5 * height / body.half_width
    raise AssemblyError([
        f'RearWall: by the law "sorrentino" a block of H/B = {slenderness:.4g} does not rebound: '
        f"the ratio would be {ratio:.4g}, and is negative for H/B above sqrt(2) of a solid "
        "rectangle; give a ratio, such as restitution=0"
    ])  # fmt: skip


class EquivalentWall(NamedTuple):
    """An elastic wall from which a block rebounds as from a stiff one."""

    rebound: float  # angular velocity after over before the impact [1]
    stiffness: float  # [N m^-1]
    damping: float  # [N s m^-1]


def equivalent_wall(wall: RearWall, block: BlockSI) -> EquivalentWall:
    """Return the elastic wall of an impact of :data:`IMPACT_TIME`, :eq:`eq-yielding-wall`."""
    law, body = wall.given.restitution, block_body(block)
    ratio = _wall_ratio(wall, body, block.height) if isinstance(law, WallImpact) else float(law)
    rebound = abs(max(-ratio, 0.0))
    mass = (body.inertia + body.mass * body.centre_height**2) / block.height**2
    decrement = -math.log(rebound) if rebound > 0.0 else math.inf
    ratio = decrement / math.hypot(math.pi, decrement) if math.isfinite(decrement) else 1.0
    # half a period of the damped vibration; for critical damping, of the undamped one
    damped = IMPACT_TIME * (math.sqrt(1.0 - ratio * ratio) if ratio < 1.0 else 1.0)
    frequency = math.pi / damped
    return EquivalentWall(rebound, mass * frequency**2, 2.0 * ratio * mass * frequency)


def _wall_ratio(wall: RearWall, body: SupportedBody, height: float) -> float:
    """Return the ratio of the velocities after and before an impact on the wall alone, by its law.

    By Sorrentino it turns rocking about the rear base corner into that about the rear top one.
    """
    if wall.given.restitution is WallImpact.NEWTON:
        return -float(wall.given.wall_restitution)
    beside = body.left if wall.given.side is WallSide.LEFT else body.right
    below, inertia = height - body.centre_height, body.inertia / body.mass
    before = inertia + beside * beside - body.centre_height * below
    return before / (inertia + beside * beside + below * below)
