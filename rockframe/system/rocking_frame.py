"""The scene of columns under a beam: the body that moves as they do, and its words."""

from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import ClassVar

import numpy as np

from rockframe.components.rocking_frame import RockingFrameSI
from rockframe.errors import AssemblyError
from rockframe.signals.arrays import Array
from rockframe.system.bodies import SupportedBody
from rockframe.system.impact import Restitutions, resolve_restitution
from rockframe.system.load import BaseLoad
from rockframe.system.options import Options
from rockframe.system.parts import Parts
from rockframe.system.rigid_ground import RigidGroundSetting, refuse_fall
from rockframe.system.words import Words


@dataclass(frozen=True)
class FrameBody(SupportedBody):
    """The body that rocks on rigid ground as columns under a beam do, :eq:`eq-rocking-frame-body`.

    Its mass and its centre of mass are those of columns and beam together.
    """

    frame: RockingFrameSI = field(kw_only=True)

    @cached_property
    def maximum_restitution(self) -> Restitutions:
        """That of columns and beam, not that of one body, :eq:`eq-rocking-frame-impact`."""
        column, beam = self.frame.column, self.frame.beam_mass
        swung = self.frame.columns * column.mass + 4.0 * beam
        corner = self.mass * self.gyration_square_about(self.half_width)
        ratio = 1.0 - 2.0 * swung * column.half_width * (column.half_width / corner)
        return Restitutions(ratio, ratio)

    @property
    def base_ratio(self) -> float:
        """Half the width of a column over that of the body [1]."""
        return self.frame.column.half_width / self.half_width

    def arms(self, x: Array, y: Array, rotation: Array) -> tuple[Array, Array]:
        """Give where points of a column, or of the beam, are from the centre of mass [m].

        Points above the top of the columns are of the beam, which moves as the upper corner
        that bears it.
        """
        half, height = self.frame.column.half_width, self.frame.column.height
        side = np.sign(rotation)
        of_beam = y > height
        right = np.where(of_beam, -half * side, x)
        up = np.where(of_beam, height, y)
        return right + side * (self.half_width - half), up - self.centre_height


def body_of_frame(si: RockingFrameSI) -> FrameBody:
    """Give columns and beam as a body, :eq:`eq-rocking-frame-body`."""
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
    source: ClassVar[str] = "Makris and Vassiliou 2013; omega of columns and beam together"
    greatest: ClassVar[str] = "the greatest value, of columns and beam together"

    @property
    def model(self) -> str:
        """Name of the model."""
        return "rocking frame"

    def words(self) -> Words:
        """Tell the frame."""
        body, si, told = self.body, self.frame, super().words()
        share = si.beam_mass / (si.columns * si.column.mass)
        radius = body.gyration_square_about(body.half_width) / (
            body.radius * (1.0 + 1.0 / si.column.shape_factor)
        )
        return replace(
            told,
            numbers=[
                ("columns", f"{si.columns}, each {si.column.width:.6g} m wide, "
                 f"{si.column.height:.6g} m high, {si.column.mass:.6g} kg"),
                ("beam over columns, gamma = m_b/(N m)", f"{share:.6g}"),
                ("R0 of a lone column that rocks alike", f"{radius:.6g} m"),
                *told.numbers,
            ],
            restraint="the corners that bear, under and above the columns, do not slide (the "
            "restraint options make no difference)",
            left_out=[
                "sliding on the ground and under the beam",
                "elasticity of columns, beam and ground",
                "flight, of the columns off the ground or of the beam off the columns",
            ],
        )  # fmt: skip


def rocking_frame_setting(parts: Parts, options: Options) -> RockingFrameSetting:
    """Resolve the parts of a frame on rigid ground."""
    load = BaseLoad(body_of_frame(parts.the_frame.si), options)
    greatest = load.body.maximum_restitution
    if greatest.left <= 0.0:
        raise AssemblyError([
            f"RockingFrame: the columns are so squat that the frame cannot rock: its greatest "
            f"restitution is {greatest.left:.4g}"
        ])  # fmt: skip
    given = parts.ground.si.restitution if parts.ground is not None else None
    setting = RockingFrameSetting(load, resolve_restitution(given, greatest), parts.the_frame.si)
    refuse_fall(setting)
    return setting
