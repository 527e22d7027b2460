"""The scene of a rocking frame, columns under a beam: the equivalent body, tendons, words."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any, ClassVar, cast

import numpy as np

from rockframe.components import RockingFrame, Tendon
from rockframe.components.rocking_frame import RockingFrameSI
from rockframe.dynamics.links import LinkNumbers, Stretch
from rockframe.dynamics.protocol import ContactModel
from rockframe.errors import AssemblyError
from rockframe.signals.arrays import Array
from rockframe.system.bodies import BaseLoad, CornerSupportedBody, Restitutions, base_restitution
from rockframe.system.links import duplicate_name_faults, tie_law, tie_law_words
from rockframe.system.options import Options
from rockframe.system.parts import Parts, link_labels
from rockframe.system.rigid_ground import RigidGroundSetting, refuse_fall
from rockframe.system.setting import FRICTION_TO_ROCK, Words
from rockframe.system.stack import refuse_options
from rockframe.system.statics import Statics


@dataclass(frozen=True)
class FrameBody(CornerSupportedBody):
    """The single body equivalent to columns under a beam, :eq:`eq-rocking-frame-body`.

    Its mass and its centre of mass are those of columns and beam together.
    """

    frame: RockingFrameSI = field(kw_only=True)

    @cached_property
    def maximum_restitution(self) -> Restitutions:
        """eps_max of columns and beam, not of a single body, :eq:`eq-rocking-frame-impact`."""
        column, beam = self.frame.column, self.frame.beam_mass
        mass = self.frame.columns * column.mass + 4.0 * beam
        corner = self.mass * self.gyration_square_about(self.half_width)
        ratio = 1.0 - 2.0 * mass * column.half_width * (column.half_width / corner)
        return Restitutions(ratio, ratio)

    @property
    def base_ratio(self) -> float:
        """Half the width of a column over that of the body [1]."""
        return self.contact_half_width / self.half_width

    @property
    def contact_half_width(self) -> float:
        """Half the width of a column [m]."""
        return self.frame.column.half_width

    def relative_to_centre(
        self, x: Array, y: Array, values: Mapping[str, Any]
    ) -> tuple[Array, Array]:
        """Return x and y of points of a column, or of the beam, from the centre of mass [m].

        Points above the top of the columns belong to the beam, which moves with the upper corner
        in contact. The side follows from the corners in contact, since the rotation is zero where
        rocking begins and at impacts.
        """
        half, height = self.frame.column.half_width, self.frame.column.height
        side = 1.0 * (values["right_reaction"] != 0.0) - (values["left_reaction"] != 0.0)
        of_beam = y > height
        right = np.where(of_beam, -half * side, x)
        up = np.where(of_beam, height, y)
        return right + side * (self.half_width - half), up - self.centre_height


def frame_body(si: RockingFrameSI) -> FrameBody:
    """Return columns and beam as a body, :eq:`eq-rocking-frame-body`."""
    column, beam = si.column, si.beam_mass
    columns = si.columns * column.mass
    mass = columns + beam
    half = column.half_width * (columns + 2.0 * beam) / mass
    height = (columns * column.centre_height + beam * column.height) / mass
    about_corner = (
        si.columns * column.inertia
        + columns * column.radius**2
        + beam * (column.width**2 + column.height**2)
    )
    inertia = about_corner - mass * (half * half + height * height)
    factor = mass * (half * half + height * height) / inertia
    return FrameBody(half, height, mass, inertia, factor, frame=si)


@dataclass(frozen=True)
class RockingFrameSetting(RigidGroundSetting):
    """Columns under a beam on rigid ground."""

    frame: RockingFrameSI
    name = "rocking frame"
    source: ClassVar[str] = "Makris and Vassiliou 2013; omega of columns and beam together"
    greatest: ClassVar[str] = "the greatest value, of columns and beam together"
    flight_advice = ""

    def words(self) -> Words:
        """Describe the frame."""
        body, si, inherited = self.body, self.frame, super().words()
        share = si.beam_mass / (si.columns * si.column.mass)
        radius = body.gyration_square_about(body.half_width) / (
            body.radius * (1.0 + 1.0 / si.column.shape_factor)
        )
        return replace(
            inherited,
            numbers=[
                ("columns", f"{si.columns}, each {si.column.width:.6g} m wide, "
                 f"{si.column.height:.6g} m high, {si.column.mass:.6g} kg"),
                ("beam over columns, gamma = m_b/(N m)", f"{share:.6g}"),
                ("R0 of a lone column that rocks alike", f"{radius:.6g} m"),
                *inherited.numbers,
            ],
            restraint="the corners that bear, under and above the columns, do not slide (the "
            "restraint options make no difference)",
            left_out=[
                "sliding on the ground and under the beam",
                "elasticity of columns, beam and ground",
                "flight, of the columns off the ground or of the beam off the columns",
            ],
        )  # fmt: skip


@dataclass(frozen=True)
class TendonFrameSetting(RockingFrameSetting):
    """Columns under a beam on rigid ground, with tendons along the axes of the columns."""

    tendons: tuple[Tendon, ...]
    name = "rocking frame with tendons"

    @property
    def link_names(self) -> tuple[str, ...]:
        """Names of the tendons in results."""
        return tuple(link_labels(self.tendons))

    @cached_property
    def tendon_laws(self) -> tuple[LinkNumbers, ...]:
        """The tendons as the equations take them."""
        return tuple(tie_law(tendon, self.body.mass) for tendon in self.tendons)

    def contact_model(self) -> ContactModel:
        """Return the equations of the columns and their tendons."""
        from rockframe.dynamics.tendons import frame_with_tendons

        half, columns = self.frame.column.half_width, self.frame.columns
        laws = self.tendon_laws
        return frame_with_tendons(super().contact_model(), laws, half_width=half, columns=columns)

    def tendon_forces(self, rotation: float) -> list[float]:
        """Return the force of each tendon, :eq:`eq-rocking-frame-tendon` [N]."""
        elongation = 4.0 * self.frame.column.half_width * math.sin(0.5 * abs(rotation))
        stretch, forces = Stretch(elongation, 0.0, 0.0, 0.0, 0.0), list[float]()
        for tendon_law in self.tendon_laws:
            law, own = tendon_law.law, np.zeros(tendon_law.law.variables())
            force = law.force(law.starting(stretch, own), stretch, own)
            forces.append(self.body.mass * force)
        return forces

    def total_tendon_force(self, rotation: float) -> float:
        """Return the force of all tendons of all columns [N]."""
        return self.frame.columns * math.fsum(self.tendon_forces(rotation))

    @property
    def uplift_accelerations(self) -> tuple[float, float]:
        """Ground accelerations at which it begins to rock, against the preload [m s^-2]."""
        moment = 2.0 * self.frame.column.half_width * self.total_tendon_force(0.0)
        more = moment / (self.body.mass * self.body.centre_height)
        left, right = super().uplift_accelerations
        return left + more, right + more

    def friction_to_rock(self) -> dict[str, float]:
        """Return the friction below which columns slide before they rock against the preload."""
        normal_force = self.body.mass * self.gravity + self.total_tendon_force(0.0)
        return {FRICTION_TO_ROCK: self.body.mass * self.uplift_acceleration / normal_force}

    def _statics_at(self, rotation: float) -> Statics:
        """Return the equilibrium at a rotation, with the tendons."""
        statics, half = super()._statics_at(rotation), self.frame.column.half_width
        pull, cosine = self.total_tendon_force(rotation), math.cos(0.5 * rotation)
        side = math.copysign(1.0, rotation) if rotation else 0.0
        shares = (0.5 * (1.0 - side), 0.5 * (1.0 + side))
        return replace(
            statics,
            # moment of the forces at the feet about the middle of each foot
            base_moment=statics.base_moment + side * pull * half * cosine,
            restoring_moment=statics.restoring_moment + side * 2.0 * half * pull * cosine,
            reactions={
                name: force + share * pull * cosine
                for (name, force), share in zip(statics.reactions.items(), shares, strict=True)
            },
        )

    def equilibrium(self) -> dict[str, Any]:
        """Return reactions, moment at uplift, and the tendons at rest."""
        pull, values = self.total_tendon_force(0.0), super().equilibrium()
        values["uplift_moment"] += pull * self.frame.column.half_width
        for name in ("static_left_reaction", "static_right_reaction"):
            values[name] += 0.5 * pull
        return values | {
            "restrainer": list(self.link_names),
            "static_restrainer_force": self.tendon_forces(0.0),
            "static_restrainer_elongation": [0.0] * len(self.tendons),
        }

    def _start_words(self) -> str:
        """Say when rocking starts."""
        return (
            "at rest until |xg''| exceeds (g + yg'') tan(theta) by what the preload holds, "
            f"{self.uplift_acceleration:.4g} m s^-2 in all without vertical motion"
        )

    def words(self) -> Words:
        """Describe the frame and its tendons."""
        inherited = super().words()
        return replace(
            inherited,
            equations=[
                *inherited.equations,
                ("tendons", "a'' less s 2 b cos(a/2) N T/I, of the forces T of all tendons of a "
                 "column, each longer by 4 b sin(|a|/2)"),
            ],
            numbers=[
                *inherited.numbers,
                *((name, f"along the axis of each column, {', '.join(tie_law_words(tendon))}")
                  for name, tendon in zip(self.link_names, self.tendons, strict=True)),
            ],
        )  # fmt: skip


def rocking_frame_setting(parts: Parts, options: Options) -> RockingFrameSetting:
    """Resolve the parts of a frame on rigid ground."""
    frame = cast("RockingFrame", parts.frame).si
    load = BaseLoad(frame_body(frame), options)
    greatest = load.body.maximum_restitution
    if greatest.left <= 0.0:
        raise AssemblyError([
            f"RockingFrame: the columns are so squat that the frame cannot rock: its greatest "
            f"restitution is {greatest.left:.4g}"
        ])  # fmt: skip
    restitution = base_restitution(parts.ground, greatest)
    setting = RockingFrameSetting(load, restitution, frame)
    refuse_fall(setting)
    if not parts.links:
        return setting
    refuse_options("a RockingFrame with tendons", options, small=False)
    if faults := duplicate_name_faults(parts.links):
        raise AssemblyError(faults)
    tendons = tuple(link for link in parts.links if isinstance(link, Tendon))
    return TendonFrameSetting(load, restitution, frame, tendons)
