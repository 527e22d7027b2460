"""The scenes of a block on rigid ground, held or sliding: their numbers, words and models."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar, Final

from rockframe.case_arrays import atan, cos, hypot, maximum, python_number, sin, sqrt, tan
from rockframe.components.bases import Impact
from rockframe.dynamics.protocol import ContactModel, Ending
from rockframe.dynamics.rigid_ground import rigid_ground, rocking_corner
from rockframe.errors import AssemblyError
from rockframe.system.bodies import (
    ROUNDING,
    BaseFriction,
    Restitutions,
    SupportedBody,
    base_restitution,
    load_of,
    restitution_cautions,
)
from rockframe.system.options import SLIDING_AT_SMALL_ROTATION, Options
from rockframe.system.parts import Parts, base_friction
from rockframe.system.setting import HELD_BY_FRICTION, Setting, SlipRange, Words
from rockframe.system.statics import Statics, static_values
from rockframe.system.support import corner_reactions
from rockframe.units import angle_words

if TYPE_CHECKING:
    from rockframe.dynamics.slide_rock import SlideRock

_ON_SLOPE: Final = ", with gravity g cos(i) in the place of g, and xg'' with g sin(i)"
"""Remark on an equation along and normal to an inclined base."""


@dataclass(frozen=True)
class RigidGroundSetting(Setting):
    """A block on rigid ground."""

    restitution: Restitutions  # eps of its corners [1]
    name: ClassVar[str] = "rigid ground"
    """Name of the model."""
    flies = False
    flight_advice: ClassVar[str] = "; put it on a TwoSpringSupport to follow its flight"
    steps_cost_most = False
    source: ClassVar[str] = "Housner; Eq. (6) for omega"
    """Source of the equation of motion, for words."""
    greatest: ClassVar[str] = "Eq. (4) is the greatest value"
    """Remark on the restitution, for words."""

    @property
    def model(self) -> str:
        """Name of the model."""
        return self.name

    @property
    def uplift_acceleration(self) -> float:
        """Least ground acceleration at which rocking starts, :eq:`eq-incline-uplift` [m s^-2]."""
        return min(self.uplift_accelerations)

    @property
    def uplift_accelerations(self) -> tuple[float, float]:
        """Ground accelerations at which rocking about the left, the right corner starts [m s^-2].

        Ground that is accelerated to the right tips the block to the left.
        """
        return self._accelerations_at_slopes(*self.corner_tangents)

    @property
    def onset_accelerations(self) -> tuple[float, float]:
        """Ground accelerations at which a block at rest starts to move, as for uplift [m s^-2]."""
        return self.uplift_accelerations

    def _accelerations_at_slopes(self, left: float, right: float) -> tuple[float, float]:
        """Return the ground accelerations at which the resultant force has some slopes [m s^-2].

        `left` and `right` are tangents of its angle to the normal of the base.
        """
        if self.slope.level:
            return self.gravity * left, self.gravity * right
        i = self.slope.inclination
        left, right = (
            self.gravity * tan(slant) if slant < 0.5 * math.pi else math.inf
            for slant in (atan(left) - i, atan(right) + i)
        )
        return left, right

    @property
    def corner_tangents(self) -> tuple[float, float]:
        """Tan theta of the left and of the right corner; theta for small rotation."""
        left, right = self.body.overturning_angles
        if self.options.small:
            return left, right
        return tan(left), tan(right)

    def cautions(self) -> list[str]:
        """Return warnings about the restitution."""
        cautions = restitution_cautions(self.restitution, self.body.maximum_restitution)
        left, right = (
            self.body.gyration_square_about(d) for d in (self.body.left, self.body.right)
        )
        # a block that lands on a corner has rocked about the other one
        for side, restitution, ratio in zip(
            ("left", "right"), self.restitution, (right / left, left / right), strict=True
        ):
            if restitution > sqrt(ratio) + ROUNDING:
                cautions.append(
                    f"impacts on the {side} corner, about which the block has more inertia than "
                    f"about the other one, give energy with a restitution above {sqrt(ratio):.6g}"
                )
        return cautions

    def contact_model(self) -> ContactModel:
        """Return Housner's equations."""
        body, small = self.body, self.options.small
        left, right = (
            rocking_corner(
                distance=distance,
                height=body.centre_height,
                inertia=body.gyration_square_about(distance),
                restitution=restitution,
                small_rotation=small,
            )
            for distance, restitution in zip((body.left, body.right), self.restitution, strict=True)
        )
        return rigid_ground(
            left, right, mass=body.mass, small_rotation=small, gravity=self.slope.normal_gravity
        )

    def curve(self, rotations: Sequence[float]) -> list[Statics | None]:
        """Return the quasi-static states at rotations [rad]."""
        return [self._statics_at(rotation) for rotation in rotations]

    def _statics_at(self, rotation: float) -> Statics:
        """Return the equilibrium at a rotation: the corner in contact carries the weight."""
        body, weight, thrust = self.body, self.load.weight, self.load.thrust
        if rotation == 0.0:
            # the moments of weight and reactions about the middle of the base
            moment = weight * body.eccentricity - thrust * body.centre_height
            return Statics(0.0, body.base_ratio * moment, 0.0, "full", self.rest_reactions)
        side = math.copysign(1.0, rotation)
        theta, lean = body.overturning_angles.on_side_of(rotation), abs(rotation)
        beside = side * body.eccentricity
        radius = hypot(body.half_width - beside, body.centre_height)
        if self.options.small:
            rise, restoring = radius * lean * (theta - 0.5 * lean), theta - lean
            weight_arm, thrust_arm = radius * lean + beside, radius
        else:
            rise = 2.0 * radius * sin(theta - 0.5 * lean) * sin(0.5 * lean)
            restoring = sin(theta - lean)
            weight_arm = body.centre_height * sin(lean) + beside * cos(lean)
            thrust_arm = radius * cos(theta - lean)
        moment = side * weight * radius * restoring
        left, right = (0.0, weight) if side > 0.0 else (weight, 0.0)
        return Statics(
            vertical_displacement=rise,
            base_moment=body.base_ratio * (moment + side * weight * weight_arm),
            restoring_moment=moment + thrust * thrust_arm,
            contact_state="right" if side > 0.0 else "left",
            reactions=corner_reactions(left, right),
        )

    def equilibrium(self) -> dict[str, float]:
        """Return the reactions at rest and the moment at uplift, by their names in the schema."""
        uplift = self.load.weight * self.body.half_width * self.body.base_ratio
        return {"uplift_moment": uplift, **static_values(self.rest_reactions)}

    @property
    def rest_reactions(self) -> dict[str, float]:
        """Reactions of both corners at rest, by their names in the schema [N]."""
        (left, right), half = self.corner_tangents, 0.5 * self.load.weight
        tilt = half * (left - right) / (left + right)
        shift = tilt - self.load.thrust / (left + right)
        return corner_reactions(half - shift, half + shift)

    def words(self) -> Words:
        """Describe the block on rigid ground."""
        lean = "theta s - a" if self.slope.level else "theta s + i - a"
        rocking = f"a'' = -omega^2 [(1 + yg''/g) sin({lean}) + (xg''/g) cos({lean})]"
        if self.options.small:
            rocking = "small rotation: a'' = -omega^2 [(1 + yg''/g) (theta s - a) + xg''/g]"
            if not self.slope.level:
                rocking += _ON_SLOPE
        return Words(
            equations=[
                ("full", self._start_words()),
                ("left, right", f"{rocking}, s = sgn(a) ({self.source})"),
                ("impact", f"a' after = {self.restitution.words()} a' before, at a = 0 "
                 f"({self.greatest})"),
            ],
            restraint="the bearing corner does not slide (the restraint options make no "
            "difference)",
            numbers=[
                ("uplift angle", "0 rad: any rotation lifts a corner"),
                ("rocking frequency omega, Eq. (6)", self._frequency_words()),
                ("restitution eps", self.restitution.words()),
            ],
            left_out=[
                "sliding",
                "elasticity of block and ground",
                "flight (a vertical ground acceleration beyond gravity would need it)",
            ],
        )  # fmt: skip

    def _start_words(self) -> str:
        """Say when rocking starts."""
        to_right, to_left = self.uplift_accelerations
        if self.slope.level and to_right == to_left:
            return (
                "at rest until |xg''| exceeds (g + yg'') tan(theta), "
                f"{to_right:.4g} m s^-2 without vertical motion"
            )
        if self.slope.level:
            return (
                "at rest until |xg''| exceeds (g + yg'') tan(theta), with theta of the side that "
                f"it tips to: without vertical motion {to_right:.4g} m s^-2 to the right, which "
                f"tips to the left, or {to_left:.4g} m s^-2 to the left"
            )
        return (
            "at rest until the resultant of gravity and ground acceleration passes beside a "
            f"corner: without vertical motion at xg'' above {to_right:.4g} m s^-2 to the right, "
            f"or above {to_left:.4g} m s^-2 to the left"
        )

    def _frequency_words(self) -> str:
        """Write the frequency of rocking about each corner; one number where they are equal."""
        body = self.body
        left, right = (
            sqrt(
                self.gravity
                * hypot(distance, body.centre_height)
                / body.gyration_square_about(distance)
            )
            for distance in (body.left, body.right)
        )
        if left == right:
            return f"{left:.6g} rad/s"
        return f"about the left corner {left:.6g} rad/s, about the right one {right:.6g} rad/s"


@dataclass(frozen=True)
class SlidingSetting(RigidGroundSetting):
    """A block on rigid ground with friction."""

    friction: BaseFriction
    impact: Impact  # law of its impacts
    name = "sliding on rigid ground"
    slides = True
    flies = True

    @property
    def lands_flat(self) -> bool:
        """Whether the block is so squat that it lands flat instead of continuing to rock."""
        return min(self.restitution) <= 0.0

    @property
    def onset_accelerations(self) -> tuple[float, float]:
        """Ground accelerations at which it rocks or slides; 0 if its weight moves it [m s^-2]."""
        left, right = (min(self.friction.static, tangent) for tangent in self.corner_tangents)
        left, right = self._accelerations_at_slopes(left, right)
        return max(left, 0.0), max(right, 0.0)

    def contact_model(self) -> ContactModel:
        """Return the equations of slip, rotation and rise."""
        from rockframe.dynamics.slide_rock import slide_rock

        gravity = self.slope.normal_gravity
        system = slide_rock_of(self.body, self.friction, self.restitution, gravity)
        return slide_rock(system, mass=self.body.mass)

    def slips_of(self, ending: Ending) -> tuple[SlipRange, ...]:
        """Return how far the block slipped."""
        return (slips_on_ground(ending),)

    def cautions(self) -> list[str]:
        """Return warnings about the restitution, and about a block that slides by its weight."""
        along = abs(self.slope.along_gravity)
        if along <= self.friction.static * self.slope.normal_gravity:
            return super().cautions()
        slides = (
            f"the block slides by its own weight: it needs a friction of tan(i) = "
            f"{along / self.slope.normal_gravity:.4g}, and has {self.friction.static:.4g}"
        )
        return [*super().cautions(), slides]

    def words(self) -> Words:
        """Describe the block that slides."""
        base, law = super().words(), impact_words(self.impact)
        slope = "" if self.slope.level else _ON_SLOPE
        onto = (
            "the block lands flat"
            if self.lands_flat
            else (f"a' after = {self.restitution.words()} a' before where it does not slip")
        )
        return Words(
            equations=[
                ("full", f"at rest while |xg''| <= mu_s (g + yg''), and until it tips{slope}"),
                ("full", "it slides: slip'' = -xg'' - s mu_k (g + yg''), s = sgn(slip')" + slope),
                *((state, words) for state, words in base.equations if state == "left, right"),
                ("left, right", "the corner slips: I a'' = N (l + s mu_k l'), where friction at "
                 "the held corner would have to be above mu_s N"),
                ("flight", "nothing bears: N = 0"),
                ("impact", f"{self.impact}: {law}; {onto}"),
            ],
            restraint=HELD_BY_FRICTION,
            numbers=[
                *base.numbers[:-1],
                self.friction.row(),
                ("friction to land without slip", f"{friction_to_roll_over(self.body):.6g}"),
                ("restitution eps", "lands flat" if self.lands_flat else self.restitution.words()),
            ],
            left_out=["elasticity of block and ground"],
        )  # fmt: skip


def rigid_ground_setting(parts: Parts, options: Options) -> RigidGroundSetting:
    """Resolve the parts of a scene on rigid ground."""
    load = load_of(parts.block_si, options)
    ground = parts.ground
    restitution = base_restitution(ground, load.body.maximum_restitution)
    setting = RigidGroundSetting(load, restitution)
    friction = None if ground is None else base_friction(ground, options)
    if ground is not None and friction is not None:
        faults = jamming_faults(load.body, friction.kinetic)
        if options.small:
            faults.append(SLIDING_AT_SMALL_ROTATION)
        if faults:
            raise AssemblyError(faults)
        setting = SlidingSetting(load, restitution, friction, ground.si.impact)
    refuse_fall(setting)
    return setting


def refuse_fall(setting: RigidGroundSetting) -> None:
    """Refuse a block whose weight acts outside of its base, :eq:`eq-incline-standing`."""
    slope, (left, right) = setting.slope, setting.corner_tangents
    if slope.level:
        return
    side, downhill = ("left", left) if slope.inclination > 0.0 else ("right", right)
    if abs(slope.along_gravity) >= slope.normal_gravity * downhill:
        raise AssemblyError([
            f"the block falls to the {side} by its own weight: the ground is inclined by "
            f"{angle_words(abs(slope.inclination))}, and the block stands up to "
            f"{angle_words(atan(downhill))}"
        ])  # fmt: skip


def slide_rock_of(
    body: SupportedBody, friction: BaseFriction, restitutions: Sequence[float], gravity: float
) -> "SlideRock":
    """Return the equations of a block that slides and rocks, by the restitutions of its corners."""
    from rockframe.dynamics.slide_rock import SlideRock, impulse_lever

    left, right = (
        impulse_lever(
            restitution=restitution,
            own=own,
            width=2.0 * body.half_width,
            about_foot=body.base_inertia / body.mass,
        )
        for own, restitution in zip((body.left, body.right), restitutions, strict=True)
    )
    return SlideRock(
        left=body.left,
        right=body.right,
        height=body.centre_height,
        inertia=body.inertia / body.mass,
        static=friction.static,
        kinetic=friction.kinetic,
        impulsive=friction.impulsive,
        left_lever=left,
        right_lever=right,
        gravity=gravity,
    )


def slips_on_ground(ending: Ending) -> SlipRange:
    """Return how far a block slipped on rigid ground."""
    from rockframe.dynamics.slide_motion import (
        BEARINGS,
        FLIGHT_RIGHT,
        PEAK_LEFT,
        PEAK_RIGHT,
        SLIP,
        SLIP_STATES,
    )

    residual = python_number(ending.state[SLIP])
    left, right = python_number(ending.memory[PEAK_LEFT]), python_number(ending.memory[PEAK_RIGHT])
    if ending.mode // SLIP_STATES % BEARINGS < FLIGHT_RIGHT:
        left, right = maximum(left, -residual), maximum(right, residual)
    return SlipRange(residual, left, right)


def friction_to_roll_over(body: SupportedBody) -> float:
    """Return the least friction at which no corner slips in an impact, :eq:`eq-slide-housner`."""
    square = body.base_inertia / body.mass
    return max(body.centre_height * own / square for own in (body.left, body.right))


def impact_words(impact: Impact) -> str:
    """Describe the law of impacts."""
    if impact is Impact.STICK:
        return "the corner that strikes is held"
    return "the corner that strikes slips as far as the kinetic friction lets it"


def jamming_faults(body: SupportedBody, kinetic: float) -> list[str]:
    """Return a fault for friction with which a slipping corner may jam, :eq:`eq-slide-painleve`."""
    from rockframe.dynamics.slide_rock import ill_posed_friction

    limit = ill_posed_friction(
        body.inertia / body.mass, max(body.left, body.right) ** 2 + body.centre_height**2
    )
    if kinetic < limit:
        return []
    return [
        f"with a kinetic friction of {kinetic:.6g} a corner that slips may jam, and rigid friction "
        f"has no answer or several: for this block it must be below {limit:.6g}; give "
        "kinetic_friction beside a greater friction at rest"
    ]
