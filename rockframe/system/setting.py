"""What a scene is: its numbers in SI units, its words, and its model."""

from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TYPE_CHECKING, ClassVar, NamedTuple, cast

from rockframe.dynamics.protocol import ContactModel, Ending
from rockframe.many import largest
from rockframe.signals.motion import Slope
from rockframe.system.bodies import BaseLoad, OverturningAngles, SupportedBody
from rockframe.system.options import Options
from rockframe.system.rigid_base import NO_VERTICAL_START
from rockframe.system.statics import SmallMotion, Statics, least_overturning_energy, required_states
from rockframe.system.support import Support
from rockframe.system.words import Words

if TYPE_CHECKING:
    from rockframe.dynamics.chain.slips import SlippingBodies

LARGE_LEAN = 0.1
"""Share of the overturning angle above which a lean at rest is worth a warning."""


class SlipRange(NamedTuple):
    """How far a body has slipped on its base, to the right [m]."""

    residual: float  # at the end of a run
    left: float  # at most to either side, both positive
    right: float

    @property
    def peak(self) -> float:
        """The greatest to either side."""
        return largest(self.left, self.right)


def chain_slips(setting: "Setting", count: int, ending: Ending) -> tuple[SlipRange, ...]:
    """Tell how far the highest bodies of a chain that slips have slipped, so many of them."""
    chain = cast("SlippingBodies", setting.compile().system)
    return tuple(SlipRange(*chain.slips(k, ending)) for k in range(count))


@dataclass(frozen=True)
class Setting(ABC):
    """A scene: numbers in SI units, words, and the model that they lead to.

    Parameters
    ----------
    load : BaseLoad
        The body that the response is of, with the options of its system.
    cap_offset : float, optional
        Height of a cap's centre above that of the body, where a cap is part of the body [m].
    """

    load: BaseLoad
    cap_offset: float | None = field(default=None, kw_only=True)
    # the body that the response is of, and its system's options; gravity [m s^-2], and the base
    # line in it
    body: SupportedBody = field(init=False, repr=False, compare=False)
    options: Options = field(init=False, repr=False, compare=False)
    gravity: float = field(init=False, repr=False, compare=False)
    slope: Slope = field(init=False, repr=False, compare=False)
    # whether the body is not symmetric, or stands on a slope; rotations of unstable equilibrium to
    # either side, relative to the base line [rad]
    leans: bool = field(init=False, repr=False, compare=False)
    overturning_angles: OverturningAngles = field(init=False, repr=False, compare=False)
    stacked: ClassVar[bool] = False
    """Whether the body stands on pads on a cap on soil."""
    flies: ClassVar[bool] = True
    """Whether the equations follow a body that leaves its base."""
    to_fly: ClassVar[str] = ""
    """What to do where they do not, if anything can be done, at the end of a sentence."""
    slides: ClassVar[bool] = False
    """Whether in the equations a body slides on its base, so that its friction is that of these."""
    sliding_bodies: ClassVar[tuple[str, ...]] = ()
    """What verdicts call the bodies that slide; unless told, by their numbers."""

    steps_cost_most: ClassVar[bool] = True
    """Whether a run spends more on steps than on events and labels, so that fixed steps save."""

    struck_by_base: ClassVar[bool] = True
    """Whether the impulses of impacts are those of the base alone, so that friction bears them."""

    def __post_init__(self) -> None:
        body, options = self.load.body, self.load.options
        vars(self).update(
            body=body, options=options, gravity=options.gravity, slope=options.slope,
            leans=body.eccentricity != 0.0 or not options.slope.level,
            overturning_angles=self.load.overturning_angles,
        )  # fmt: skip

    @property
    def overturning_angle(self) -> float:
        """Theta, the lesser of both [rad]."""
        return min(self.overturning_angles)

    @property
    def overturning_rotations(self) -> tuple[float, ...]:
        """Rotations of unstable equilibrium that differ [rad]."""
        left, right = self.overturning_angles
        return (right, -left) if self.leans else (right,)

    @property
    @abstractmethod
    def model(self) -> str:
        """Name of the model."""

    @cached_property
    def rest_rotation(self) -> float:
        """Rotation at rest, of a body that leans on a base that gives way [rad]."""
        return 0.0

    @cached_property
    def overturning_energy(self) -> float:
        """Energy that it takes to overturn the body, by itself, on the weaker side [J]."""
        return least_overturning_energy(self)

    @cached_property
    def wholes(self) -> tuple[SupportedBody, ...]:
        """Bodies under the highest, each with all above it as one upright body."""
        return ()

    @property
    def supports(self) -> tuple[Support, ...]:
        """The bases that give way, from that of the body down; none on rigid ground."""
        return ()

    @property
    def link_names(self) -> tuple[str, ...]:
        """What results call links between points, of which most scenes have none."""
        return ()

    @cached_property
    def uplift_angle(self) -> float:
        """Rotation at which a body loses full contact; any on rigid ground, NaN if never [rad]."""
        return self.supports[0].uplift_angle if self.supports else 0.0

    @cached_property
    def settlement(self) -> float | None:
        """Settlement under the weight, where the base of the body gives way [m]."""
        return self.supports[0].settlement if self.supports else None

    def small_motion(self) -> SmallMotion | None:
        """Give the linear equations of small motion about rest; a rigid base leaves none."""
        return None

    def without_small_motion(self) -> str:
        """Say why there are no such equations."""
        return (
            "rigid ground has no small motion: a body stands still on it or rocks, with a "
            "period that grows with the amplitude; a block on pads or soil has one"
        )

    @abstractmethod
    def curve(self, rotations: Sequence[float]) -> list[Statics | None]:
        """Give the quasi-static states at rotations [rad]; None where nothing holds the body."""

    def held_at(self, rotations: Sequence[float]) -> list[Statics]:
        """Give the quasi-static states at rotations [rad]; see :func:`required_states`."""
        return required_states(rotations, self.curve(rotations))

    def statics(self, rotation: float) -> Statics:
        """Give the quasi-static state at a rotation [rad]."""
        return self.held_at([rotation])[0]

    @abstractmethod
    def equilibrium(self) -> dict[str, float]:
        """Give settlements and reactions at rest, by their names in the schema."""

    @abstractmethod
    def words(self) -> Words:
        """Tell equations, restraint, uplift angles, numbers, and what is left out."""

    def start_faults(self, rotation: float, has_vertical_start: bool) -> list[str]:
        """Give the faults that the base of the body finds in an initial state.

        Rigid ground, which is no support, leaves no vertical freedom.
        """
        if not self.supports:
            return [NO_VERTICAL_START] if has_vertical_start else []
        return self.supports[0].start_faults(rotation, has_vertical_start)

    def faults_of_velocity(self, rotation: float, angular_velocity: float) -> list[str]:
        """Give the faults of an angular velocity at which a run starts; none unless overridden."""
        return []

    def cautions(self) -> list[str]:
        """Give warnings about values near or beyond the model's validity."""
        return [*(text for each in self.supports for text in each.cautions()), *self._leaning()]

    def _leaning(self) -> list[str]:
        """Warn of a body that leans far at rest."""
        lean = abs(self.rest_rotation)
        share = lean / self.overturning_angles.on_side_of(self.rest_rotation)
        if share <= LARGE_LEAN:
            return []
        reasons: list[str] = []
        if self.body.eccentricity != 0.0:
            reasons.append("its centre of mass is beside the middle of its base")
        if not self.slope.level:
            reasons.append("its base is inclined")
        if not reasons:
            reasons.append("restrainers pull it")
        return [
            f"at rest the body leans by {lean:.4g} rad, {100.0 * share:.3g} % of its "
            f"overturning angle to that side, since {' and '.join(reasons)}"
        ]

    def slips_of(self, ending: Ending) -> tuple[SlipRange, ...]:
        """Tell how far each body slipped, by the end of a run; nothing of bodies that are held."""
        return ()

    def beyond_edges(self, ending: Ending) -> list[str]:
        """Warn of bodies that slipped beyond the edge of what they stand on, which has no end."""
        return []

    @abstractmethod
    def contact_model(self) -> ContactModel:
        """Give the equations, with limits of the rotation as of a level base."""

    @cached_property
    def _model(self) -> ContactModel:
        return replace(self.contact_model(), rotation_limits=self.overturning_angles)

    def compile(self) -> ContactModel:
        """Give the equations, ready for the integrator, which leaves them as they are."""
        return self._model
