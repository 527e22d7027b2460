"""The scene of a block that slides on rigid ground: its numbers, its words and its model."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from rockframe.case_arrays import maximum, python_number
from rockframe.components.bases import Impact
from rockframe.dynamics.protocol import ContactModel, Ending
from rockframe.errors import AssemblyError
from rockframe.system.bodies import SupportedBody, base_restitution, load_of
from rockframe.system.compatibility import SLIDING_AT_SMALL_ROTATION, BaseFriction, base_friction
from rockframe.system.options import Options
from rockframe.system.parts import Parts
from rockframe.system.rigid_ground import RigidGroundSetting, refuse_fall
from rockframe.system.setting import HELD_BY_FRICTION, SlipRange, Words

if TYPE_CHECKING:
    from rockframe.dynamics.slide_rock import SlideRock


@dataclass(frozen=True)
class SlidingSetting(RigidGroundSetting):
    """A block on rigid ground with friction."""

    friction: BaseFriction
    impact: Impact  # law of its impacts
    slides = True
    flies = True

    @property
    def model(self) -> str:
        """Name of the model."""
        return "sliding on rigid ground"

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
        base = super().words()
        slips = "s = sgn(slip')"
        law = impact_words(self.impact)
        onto = (
            "the block lands flat"
            if self.lands_flat
            else (f"a' after = {self.restitution.words()} a' before where it does not slip")
        )
        return Words(
            equations=[
                ("full", "at rest while |xg''| <= mu_s (g + yg''), and until it tips"),
                ("full", f"it slides: slip'' = -xg'' - s mu_k (g + yg''), {slips}"),
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
