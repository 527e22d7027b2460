"""The scenes of a block on pads on a cap on soil: coupled, and as a cascade."""

from abc import abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar

import numpy as np

from rockframe.case_arrays import atan2, isnan
from rockframe.dynamics.body_statics import Pose, standing_body
from rockframe.dynamics.on_base import BodyOnBase
from rockframe.dynamics.protocol import ContactModel, Ending
from rockframe.dynamics.single_body import eccentricity_of
from rockframe.dynamics.starting import UPRIGHT, AtRest
from rockframe.dynamics.statics import StandingChain
from rockframe.dynamics.vibrations import ChainBody
from rockframe.errors import AssemblyError
from rockframe.system.bodies import NO_SLIP, BaseFriction, Cap
from rockframe.system.options import restraint_words
from rockframe.system.setting import (
    Setting,
    SlipRange,
    Words,
    chain_slips,
    overhang_cautions,
    sliding_words,
)
from rockframe.system.single_body import SingleBodySetting
from rockframe.system.statics import SmallMotion, StandingBodies, Statics, static_values
from rockframe.system.support import BaseWords, Support

MIN_CAP_MASS_RATIO = 1e-3
"""Least mass of a cap, as a share of the block's, in the coupled equations, which cannot be solved
for a plate without mass. Halving it changes histories of the
paper's example by up to 3e-3 of their peak, page "Coupled" of the manual."""


@dataclass(frozen=True)
class BlockOnCapSetting(Setting):
    """A block on pads on a cap on soil."""

    upper: SingleBodySetting  # the block on its pads
    lower: SingleBodySetting  # block and cap as one body on the soil
    cap: Cap  # the cap
    name: ClassVar[str]  # of the model
    stacked: ClassVar[bool] = True

    @property
    def model(self) -> str:
        """Name of the model."""
        return self.name

    @property
    def supports(self) -> tuple[Support, ...]:
        """Pads and soil."""
        return self.upper.support, self.lower.support

    def words(self) -> Words:
        """Describe the block on its pads, and both bodies on the soil."""
        cap, (pads, soil) = self.cap, (support.words() for support in self.supports)
        size = f"{2.0 * cap.half_width:.6g} m by {2.0 * cap.half_height:.6g} m"
        rule = restraint_words(self.options)
        return Words(
            equations=self.equations(pads, soil),
            restraint=f"of the block on the cap and of the cap on the soil alike; {rule}",
            numbers=[
                _uplift_row(self.upper, "on the pads", pads, "block against cap"),
                _uplift_row(self.lower, "on the soil", soil, "cap against ground"),
                *((f"pads: {name}", words) for name, words in pads.numbers),
                ("cap", f"{size}, {cap.mass:.6g} kg"),
                *((f"soil: {name}", words) for name, words in soil.numbers),
            ],
            left_out=self.left_out(pads, soil),
        )

    @abstractmethod
    def equations(self, pads: BaseWords, soil: BaseWords) -> list[tuple[str, str]]:
        """Return each contact state with the equation that governs it."""

    def left_out(self, pads: BaseWords, soil: BaseWords) -> list[str]:
        """Say what the model does not have."""
        return ["sliding", "elasticity of block and cap", *pads.left_out, *soil.left_out]

    def small_motion(self) -> SmallMotion:
        """Return the equations of small motion of block and cap about rest."""
        names = ("cap_vertical_displacement", "cap_rotation", "vertical_displacement", "rotation")
        # from coordinates on the cap, psi = alpha - phi and r = y - Y, to those of the block
        transform = np.array(
            [[0, -1, 0, 1], [-1, 0, 1, 0], [0, 1, 0, 0], [1, 0, 0, 0]], dtype=float
        )
        matrices = self._effective_statics.small_motion(self._rest)
        return SmallMotion(names, *(transform.T @ matrix @ transform for matrix in matrices))

    @property
    def _rest(self) -> list[Pose]:
        """Equilibrium of block and cap at rest; AssemblyError if there is none."""
        poses = self._effective_statics.rest
        if poses is None:
            raise AssemblyError(["the block and the cap under it find no rest under their weight"])
        return poses

    @property
    def rest(self) -> list[AtRest]:
        """Placements of block and cap at rest, for the coupled equations."""
        if not self.leans:
            return [UPRIGHT, UPRIGHT]
        return [AtRest(pose.state.rotation, pose.state.vertical) for pose in self._rest]

    def curve(self, rotations: Sequence[float]) -> list[Statics | None]:
        """Return the equilibria with the block held at rotations, :eq:`eq-static-stack`."""
        return self._statics(self.cap.mass, self.cap.inertia).held(rotations)

    def equilibrium(self) -> dict[str, float]:
        """Return settlements and reactions at rest, by their names in the schema."""
        soil = self.lower.equilibrium()
        soil["soil_uplift_moment"] = soil.pop("uplift_moment")
        return {**self.upper.equilibrium(), **soil}

    @cached_property
    def _effective_statics(self) -> StandingBodies:
        """Statics of block and cap, the cap with at least the least mass."""
        return self._statics(*self._effective_cap)

    def _statics(self, cap_mass: float, cap_inertia: float) -> StandingBodies:
        bodies = self._chain_bodies(cap_mass, cap_inertia)
        links = tuple(
            standing_body(BodyOnBase(body.body, body.base.law), body.mass, body.top, body.offset)
            for body in bodies
        )
        chain = StandingChain(links, self.slope.along_gravity)
        return StandingBodies(chain, self.body.mass, tuple(body.base for body in bodies))

    @property
    def _effective_cap(self) -> tuple[float, float]:
        """Mass and inertia of the cap; if it is too light, of a plate with the least mass."""
        cap, least = self.cap, MIN_CAP_MASS_RATIO * self.body.mass
        if cap.mass >= least:
            return cap.mass, cap.inertia
        return least, least * cap.half_width**2 / 3.0

    def bodies(self) -> tuple[ChainBody, ChainBody]:
        """Return block and cap on their bases, as the coupled equations take them."""
        return self._chain_bodies(*self._effective_cap)

    def _chain_bodies(self, cap_mass: float, cap_inertia: float) -> tuple[ChainBody, ChainBody]:
        (upper, lower), cap, mass = self.supports, self.cap, self.body.mass
        block = self.load.law(mass)
        plate = block._replace(
            height=cap.half_height,
            left=cap.half_width,
            right=cap.half_width,
            inertia=cap_inertia / mass,
            angle=atan2(cap.half_width, cap.half_height),
        )
        pads, soil = upper.law(block, mass, mass), lower.law(plate, mass, mass + cap_mass)
        return (
            ChainBody(block, pads, 1.0, 0.0, eccentricity_of(block)),
            ChainBody(plate, soil, cap_mass / mass, plate.height, 0.0),
        )


class CoupledSetting(BlockOnCapSetting):
    """Block and cap coupled in one set of equations."""

    name = "coupled"

    def cautions(self) -> list[str]:
        """Return the warnings of pads and soil, and about a cap that is too light."""
        cautions = super().cautions()
        if self.cap.mass < MIN_CAP_MASS_RATIO * self.body.mass:
            cautions.append(
                f"the cap's mass, {self.cap.mass:.4g} kg, is less than {MIN_CAP_MASS_RATIO:g} of "
                "the building's; the coupled equations are solved with that share of it"
            )
        return cautions

    def equations(self, pads: BaseWords, soil: BaseWords) -> list[tuple[str, str]]:
        """Return each contact state with the equation that governs it."""
        impact = dict(pads.equations).get("impact", "as on its base alone")
        return [
            ("block: full, left, right", f"four degrees of freedom, one Lagrangian; {pads.law}, "
             "along the cap's normal"),
            ("block: flight", "free fall of the block, the cap alone on the soil"),
            ("block: impact", f"{impact}; an impulse between block and cap"),
            ("cap: full, left, right", f"{soil.law}, for the cap"),
            ("cap: flight", "no soil force; block and cap fall together or apart"),
        ]  # fmt: skip

    def contact_model(self) -> ContactModel:
        """Return the coupled equations."""
        from rockframe.dynamics.coupled.model import coupled

        return coupled(*self.bodies(), self.body.mass, self.rest)

    def equilibrium(self) -> dict[str, float]:
        """Return settlements and reactions at rest, by their names in the schema."""
        values = super().equilibrium()
        if not self.leans:
            return values
        return values | static_values(self._effective_statics.reactions(self._rest))

    @cached_property
    def rest_rotation(self) -> float:
        """Rotation of the block at rest, with the cap [rad]."""
        return sum(placement.rotation for placement in self.rest)


@dataclass(frozen=True)
class SlidingCoupledSetting(CoupledSetting):
    """Block and cap, with friction on pads, on soil or on both."""

    frictions: tuple[BaseFriction, BaseFriction]  # between block and cap, between cap and soil
    name = "coupled-sliding"
    slides = True
    sliding_bodies = ("the block", "the cap")

    def words(self) -> Words:
        """Describe block, cap and soil, and their friction."""
        return sliding_words(super().words(), *(
            friction.row(f"{name}: ")
            for name, friction in zip(("pads", "soil"), self.frictions, strict=True)
            if friction != NO_SLIP
        ))  # fmt: skip

    def contact_model(self) -> ContactModel:
        """Return the equations of two stacked bodies that slip."""
        from rockframe.dynamics.chain.on_cap import block_on_cap

        return block_on_cap(*self.bodies(), self.body.mass, self.rest, self.frictions)

    def slips_of(self, ending: Ending) -> tuple[SlipRange, ...]:
        """Return how far the block slipped on the cap and, if it can slip, the cap on the soil."""
        return chain_slips(self, 1 if self.frictions[-1] == NO_SLIP else 2, ending)

    def beyond_edges(self, ending: Ending) -> list[str]:
        """Warn of a block that slipped beyond the edge of its cap."""
        slips, widths = self.slips_of(ending)[0], (self.body.half_width, self.cap.half_width)
        return overhang_cautions(slips, 0.0, *widths, self.sliding_bodies)


class CascadeSetting(BlockOnCapSetting):
    """Two stages, Eq. (20): both as one body on the soil, then the block on the moving cap."""

    name = "cascade"

    def equations(self, pads: BaseWords, soil: BaseWords) -> list[tuple[str, str]]:
        """Return each stage's contact states with the equations that govern them."""
        return [
            ("total", "Eq. (20): rotation and displacement of stage 1 plus those of stage 2"),
            *((f"stage 1, {name}", words) for name, words in soil.equations),
            *((f"stage 2, {name}", words) for name, words in pads.equations),
        ]

    def left_out(self, pads: BaseWords, soil: BaseWords) -> list[str]:
        """Say what the model does not have."""
        return [
            *super().left_out(pads, soil),
            "what the block's motion on the pads does to cap and soil",
            "the cap's inclination, for the block",
        ]

    def contact_model(self) -> ContactModel:
        """Return the equations of both stages."""
        from rockframe.dynamics.cascade.model import cascade

        body = self.lower.body
        centre = self.cap.half_height - body.centre_height
        return cascade(
            self.lower.compile(),
            self.upper.compile(),
            top=centre + self.cap.half_height,
            cap_centre=centre,
            offset=body.eccentricity,
            rest_rotation=self.lower.rest_rotation,
        )

    @cached_property
    def rest_rotation(self) -> float:
        """Rotation of the block at rest, of both stages together [rad]."""
        return self.lower.rest_rotation + self.upper.rest_rotation


def _uplift_row(
    setting: SingleBodySetting, on: str, base: BaseWords, whose: str
) -> tuple[str, str]:
    name, words = base.uplift
    title = name.replace("uplift angle", f"uplift angle {on}", 1)
    if isnan(setting.uplift_angle):
        return title, words
    moment = setting.upright()["uplift_moment"]
    return title, f"{words} of {whose}, at a moment of {moment:.6g} N m"
