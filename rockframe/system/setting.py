"""The setting of a scene: its numbers in SI units, description, statics and model."""

import math
import re
from abc import ABC, abstractmethod
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from textwrap import wrap
from threading import local
from typing import TYPE_CHECKING, ClassVar, Final, NamedTuple, cast

from rockframe.case_arrays import maximum
from rockframe.constants import PAPER_TITLE
from rockframe.dynamics.protocol import ContactModel, Ending
from rockframe.signals.motion import Incline
from rockframe.system.bodies import BaseLoad, OverturningAngles, SupportedBody
from rockframe.system.options import Options
from rockframe.system.statics import SmallMotion, Statics, required_states, work_against, work_to
from rockframe.system.support import NO_VERTICAL_START, Support
from rockframe.units import angle_words

if TYPE_CHECKING:
    from rockframe.dynamics.chain.slips import SlippingBodies

LARGE_LEAN = 0.1
"""Share of the overturning angle above which a rotation at rest gives a warning."""
MIN_OVERHANG: Final = 0.1
"""Least overhang of a body beyond an edge that gives a warning, over half its base width.

The edge bears in place of the corner, and its lever arm is shorter by this share."""


class SlipRange(NamedTuple):
    """How far a body has slipped on its base [m]."""

    residual: float  # slip to the right at the end of a run
    left: float  # largest slip to the left, positive
    right: float  # largest slip to the right

    @property
    def peak(self) -> float:
        """Largest slip to either side [m]."""
        return maximum(self.left, self.right)


def chain_slips(setting: "Setting", count: int, ending: Ending) -> tuple[SlipRange, ...]:
    """Return the slips of the `count` highest bodies of a chain."""
    chain = cast("SlippingBodies", setting.compile().system)
    return tuple(SlipRange(*chain.slip_range(k, ending)) for k in range(count))


def overhang_cautions(
    slips: SlipRange, offset: float, upper: float, lower: float, names: Sequence[str]
) -> list[str]:
    """Warn of a body that slipped beyond an edge of the one below; half widths of both [m]."""
    overhang = max(slips.right + offset, slips.left - offset) - (lower - upper)
    if overhang <= MIN_OVERHANG * upper:
        return []
    return [
        f"{names[0]} slides {overhang:.3g} m beyond the edge of {names[1]}, whose top goes "
        "on without end in the model: it would tip about that edge sooner"
    ]


SLIP_EQUATION: Final = (
    "slip",
    "H = -s mu_k N at the point that would be held, s = sgn(slip'); held while |H| <= mu_s N",
)
"""Equation of slip on a base with friction, for :class:`Words`."""
HELD_BY_FRICTION: Final = (
    "friction at the corner that bears, or on the whole base (the restraint options make no "
    "difference)"
)
"""Restraint of a block that slides on rigid ground, for :class:`Words`."""
FRICTION_TO_ROCK: Final = "friction to rock, at least"


@dataclass(frozen=True)
class Words:
    """The elements of the description of a scene.

    Parameters
    ----------
    equations : list of (str, str)
        Each contact state with the equation that governs it.
    restraint : str
        Which point of the base is held horizontally.
    numbers : list of (str, str)
        Names of numbers that a reader wants to see, with values and units; uplift comes first.
    left_out : list of str
        Effects that the model does not have.
    """

    equations: list[tuple[str, str]]
    restraint: str
    numbers: list[tuple[str, str]]
    left_out: list[str]


def sliding_words(held: Words, *frictions: tuple[str, str], restraint: str | None = None) -> Words:
    """Return the description of a scene that slips, from that of the held one and its frictions."""
    return Words(
        equations=[*held.equations, SLIP_EQUATION],
        restraint=held.restraint if restraint is None else restraint,
        numbers=[*held.numbers, *frictions],
        left_out=[topic for topic in held.left_out if topic != "sliding"],
    )


@dataclass(frozen=True)
class Setting(ABC):
    """A scene: numbers in SI units, words, and the model that they lead to."""

    load: BaseLoad  # the body whose response results give, with the options of its system
    # height of a cap's centre above that of the body, where a cap is part of the body [m]
    cap_offset: float | None = field(default=None, kw_only=True)
    # body and options of the load; gravity [m s^-2], and the inclined base with its gravity
    body: SupportedBody = field(init=False, repr=False, compare=False)
    options: Options = field(init=False, repr=False, compare=False)
    gravity: float = field(init=False, repr=False, compare=False)
    slope: Incline = field(init=False, repr=False, compare=False)
    # whether the body is not symmetric, or stands on a slope; rotations of unstable equilibrium to
    # either side, relative to the base line [rad]
    leans: bool = field(init=False, repr=False, compare=False)
    overturning_angles: OverturningAngles = field(init=False, repr=False, compare=False)
    stacked: ClassVar[bool] = False
    """Whether the body stands on pads on a cap on soil."""
    flies: ClassVar[bool] = True
    """Whether the equations follow a body that leaves its base."""
    flight_advice: ClassVar[str] = ""
    """How to have flight computed where they do not, as the end of a message; or empty."""
    slides: ClassVar[bool] = False
    """Whether the equations have friction, with which a body slides on its base."""
    sliding_bodies: ClassVar[tuple[str, ...]] = ()
    """Names of the bodies that slide, for verdicts; their numbers unless given."""

    steps_cost_most: ClassVar[bool] = True
    """Whether steps take most of the time of a run, so that fixed steps make it faster."""

    struck_by_base: ClassVar[bool] = True
    """Whether impacts are on the base alone, so that friction must bear their impulses."""

    def __post_init__(self) -> None:
        body, options = self.load.body, self.load.options
        vars(self).update(
            body=body, options=options, gravity=options.gravity, slope=options.slope,
            leans=body.eccentricity != 0.0 or not options.slope.level,
            overturning_angles=self.load.overturning_angles,
        )  # fmt: skip

    @property
    def overturning_angle(self) -> float:
        """Theta, the lesser of both overturning angles [rad]."""
        return min(self.overturning_angles)

    @property
    def overturning_rotations(self) -> tuple[float, ...]:
        """Rotations of unstable equilibrium, with signs; one for both sides if symmetric [rad]."""
        left, right = self.overturning_angles
        return (right, -left) if self.leans else (right,)

    @property
    @abstractmethod
    def model(self) -> str:
        """Name of the model."""

    @cached_property
    def rest_rotation(self) -> float:
        """Rotation at rest, of a body that leans on a deformable base; else 0 [rad]."""
        return 0.0

    @cached_property
    def overturning_energy(self) -> float:
        """Least work against restoring moments that overturns the body, to either side [J]."""
        return min(work_against(self.restoring_moments, end) for end in self.overturning_rotations)

    @cached_property
    def joined_bodies(self) -> tuple[SupportedBody, ...]:
        """Bodies under the highest, each joined with all above it to one upright body."""
        return ()

    @property
    def supports(self) -> tuple[Support, ...]:
        """The bases, from that of the highest body down; none for a block on rigid ground."""
        return ()

    @property
    def link_names(self) -> tuple[str, ...]:
        """Names of the links between points in results; empty for most scenes."""
        return ()

    @cached_property
    def uplift_angle(self) -> float:
        """Rotation at which a body loses full contact; 0 on rigid ground, NaN if never [rad]."""
        return self.supports[0].uplift_angle if self.supports else 0.0

    @cached_property
    def settlement(self) -> float | None:
        """Settlement of the body's base under the weight; None on rigid ground [m]."""
        return self.supports[0].settlement if self.supports else None

    def small_motion(self) -> SmallMotion | None:
        """Return the linear equations of small motion about rest; None on a rigid base."""
        return None

    def without_small_motion(self) -> str:
        """Say why there are no equations of small motion."""
        return (
            "rigid ground has no small motion: a body stands still on it or rocks, with a "
            "period that grows with the amplitude; a block on pads or soil has one"
        )

    @abstractmethod
    def curve(self, rotations: Sequence[float]) -> list[Statics | None]:
        """Return the quasi-static states at rotations [rad]; None where nothing holds the body."""

    def restoring_moments(self, rotations: list[float]) -> list[float]:
        """Return restoring moments at rotations [N m]; zero where there is no equilibrium."""
        states = self.curve(rotations)
        return [0.0 if state is None else state.restoring_moment for state in states]

    def stored_energy(self, rotation: float) -> float:
        """Return the work that slowly brings the body from upright to a rotation [rad] [J]."""
        return work_to(self.restoring_moments, rotation)

    def held_at(self, rotations: Sequence[float]) -> list[Statics]:
        """Return the quasi-static states at rotations [rad]; see :func:`required_states`."""
        return required_states(rotations, self.curve(rotations))

    def statics(self, rotation: float) -> Statics:
        """Return the quasi-static state at a rotation [rad]."""
        return self.held_at([rotation])[0]

    @abstractmethod
    def equilibrium(self) -> dict[str, float]:
        """Return settlements and reactions at rest, by their names in the schema."""

    @abstractmethod
    def words(self) -> Words:
        """Describe equations, restraint, uplift angles, numbers, and what is left out."""

    def friction_to_rock(self) -> dict[str, float]:
        """Return the coefficient of friction below which a base slides before it rocks, by name."""
        body = self.body
        return {f"{FRICTION_TO_ROCK} b/h": min(body.left, body.right) / body.centre_height}

    def start_faults(self, rotation: float, has_vertical_start: bool) -> list[str]:
        """Return the faults of an initial state; a vertical start on rigid ground is one."""
        if not self.supports:
            return [NO_VERTICAL_START] if has_vertical_start else []
        return self.supports[0].start_faults(rotation, has_vertical_start)

    def faults_of_velocity(self, rotation: float, angular_velocity: float) -> list[str]:
        """Return the faults of an initial angular velocity; none unless overridden."""
        return []

    def cautions(self) -> list[str]:
        """Return warnings about values near or beyond the model's validity."""
        return [
            *(text for support in self.supports for text in support.cautions()),
            *self._lean_cautions(),
        ]

    def _lean_cautions(self) -> list[str]:
        """Return a warning about a body that leans far at rest."""
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
        """Return how far each body slipped, from the end of a run; empty if all are held."""
        return ()

    def beyond_edges(self, ending: Ending) -> list[str]:
        """Warn of bodies that slipped beyond an edge, which the equations do not model."""
        return []

    @abstractmethod
    def contact_model(self) -> ContactModel:
        """Return the equations; :meth:`compile` sets the limits of the rotation for a slope."""

    @cached_property
    def _models(self) -> local:
        return local()

    def compile(self) -> ContactModel:
        """Return the equations, ready for the integrator.

        Each thread has its own, as an array of the equations may hold a workspace.
        """
        model: ContactModel | None = getattr(self._models, "of_thread", None)
        if model is None:
            model = replace(self.contact_model(), rotation_limits=self.overturning_angles)
            self._models.of_thread = model
        return model


_WIDTH: Final = 100
_OVERTURNING_ANGLE: Final = "overturning angle theta, Eq. (1)"


def describe(
    setting: Setting, parts: Iterable[object], written: Sequence[tuple[str, str]] | None = None
) -> str:
    """Describe the model, its equations, its numbers and its limits.

    `written` has names and words for the parts, in place of their notation in Python.
    """
    words, theta = setting.words(), angle_words(setting.overturning_angle)
    angles = _asymmetric_rows(setting) if setting.leans else [(_OVERTURNING_ANGLE, theta)]
    whose = "body 1: " if setting.joined_bodies else ""
    sections = {
        "Parts": [("", repr(part)) for part in parts] if written is None else [*written],
        "Contact states and their equations": words.equations,
        "Horizontal restraint": [("", words.restraint)],
        "Numbers": [
            ("gravity", f"{setting.gravity:.6g} m s^-2"),
            *((f"{whose}{name}", value) for name, value in angles),
            *((name, f"{least:.6g}") for name, least in setting.friction_to_rock().items()),
            *words.numbers,
        ],
        "Left out": [("", ", ".join(words.left_out))],
        "Numbers of equations": [("", f'as in "{PAPER_TITLE}"')],
    }
    lines = [line for title, rows in sections.items() for line in _section(title, rows)]
    return "\n".join([f"Model: {setting.model}", *lines])


def _asymmetric_rows(setting: Setting) -> list[tuple[str, str]]:
    """Describe rotation at rest and overturning angles of a body whose sides differ."""
    body, slope, (left, right) = setting.body, setting.slope, setting.overturning_angles
    rows = [
        (_OVERTURNING_ANGLE, f"to the left {angle_words(left)}, to the right {angle_words(right)}")
    ]
    if not slope.level:
        higher = "right" if slope.inclination > 0.0 else "left"
        inclined = (
            f"{angle_words(abs(slope.inclination))}, higher on the {higher}; all else is along "
            "and normal to it"
        )
        least = f"{abs(math.tan(slope.inclination)):.6g}"
        rows += [
            ("inclination of the base", inclined), ("friction to stand, at least tan(i)", least)
        ]  # fmt: skip
    if body.eccentricity != 0.0:
        side = "right" if body.eccentricity > 0.0 else "left"
        beside = f"{abs(body.eccentricity):.6g} m to the {side} of its middle"
        rows.append(("centre of mass", f"{body.centre_height:.6g} m above the base, {beside}"))
    return [*rows, ("rotation at rest", angle_words(setting.rest_rotation))]


def _section(title: str, rows: list[tuple[str, str]]) -> list[str]:
    """Set names and words in two columns, the second as far right as the longest name needs.

    Lines are broken after commas and semicolons, so that numbers keep their names and units.
    """
    longest = max(len(name) for name, _ in rows)
    lines = [f"{title}:"]
    for name, words in rows:
        first = f"  {name:<{longest}}  " if name else "  "
        following = " " * (len(first) if name else 4)
        width, broken = _WIDTH - len(following), list[str]()
        for piece in re.split(r"(?<=[,;]) ", words):
            if broken and len(broken[-1]) + 1 + len(piece) <= width:
                broken[-1] += f" {piece}"
            else:
                broken += wrap(piece, width, break_long_words=False, break_on_hyphens=False) or [""]
        lines += [first + broken[0], *(following + line for line in broken[1:])]
    return lines
