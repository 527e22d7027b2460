"""The scenes of stacked bodies, with links, held or sliding: words, statics and models."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, Final

from rockframe.components import Component, Link, Load, RigidGround, Tendon, TwoSpringSupport
from rockframe.components.bases import Impact
from rockframe.components.block_numbers import BlockSI
from rockframe.components.shapes.standing import PlaneMass
from rockframe.dynamics.body_statics import Pose
from rockframe.dynamics.protocol import MAX_MODES, ContactModel, Ending
from rockframe.dynamics.starting import UPRIGHT, AtRest
from rockframe.errors import AssemblyError
from rockframe.system.bodies import (
    NO_SLIP,
    BaseFriction,
    BaseLoad,
    block_body,
    combine_masses,
)
from rockframe.system.links import place_links
from rockframe.system.options import (
    SLIDING_AT_SMALL_ROTATION,
    Options,
    Sliding,
    restraint_words,
)
from rockframe.system.parts import base_friction, support_of
from rockframe.system.rigid_ground import (
    friction_to_roll_over,
    impact_words,
    jamming_faults,
    slide_rock_of,
    slips_on_ground,
)
from rockframe.system.setting import (
    FRICTION_TO_ROCK,
    HELD_BY_FRICTION,
    SLIP_EQUATION,
    SlipRange,
    Words,
    chain_slips,
    overhang_cautions,
    sliding_words,
)
from rockframe.system.stacked_bodies import StackedBodies, combined_body
from rockframe.system.statics import SmallMotion, Statics, static_values
from rockframe.system.support import RigidBase, corner_reactions

NO_EQUILIBRIUM: Final = (
    "the bodies find no rest under their weight: their bases are too soft for them"
)
PULLED_OVER: Final = ", or their restrainers or loads pull them over"


@dataclass(frozen=True)
class StackSetting(StackedBodies):
    """Stacked bodies, with links."""

    @property
    def model(self) -> str:
        """Name of the model."""
        if len(self.bodies) == 1:
            return f"{self.bases[0].model}-restrained"
        return "stack-restrained" if self.links else "stack"

    def _rest_slip_cautions(self) -> list[str]:
        """Warn of bodies on rigid bases that slide at rest under their links."""
        cautions = list[str]()
        for k, friction in enumerate(self.frictions):
            if self.rigid[k] and math.isfinite(friction.static):
                load = self.rigid_base_load(k)
                name = "the block" if len(self.bodies) == 1 else f"body {k + 1}"
                if abs(load.shear) > friction.static * load.normal:
                    cautions.append(
                        f"{name} slides under its restrainers and loads: at rest it needs a "
                        f"friction of {abs(load.shear) / load.normal:.4g}, and has "
                        f"{friction.static:.4g}"
                    )
        return cautions

    @property
    def link_names(self) -> tuple[str, ...]:
        """Names of the links in results, without loads."""
        return tuple(link.name for link in self.links if not isinstance(link.part, Load))

    def cautions(self) -> list[str]:
        """Return the warnings of all bases, each with the number of the body on it, and of slip."""
        cautions = [
            f"under body {k}: {text}" if len(self.bodies) > 1 else text
            for k, base in enumerate(self.bases, 1)
            for text in base.cautions()
        ]
        return [*cautions, *self._lean_cautions(), *self._rest_slip_cautions()]

    def friction_to_rock(self) -> dict[str, float]:
        """Return the friction to rock of all bodies above each base, as one.

        Links stretch before an end lifts from a deformable base; for these bases it is not given.
        """
        frictions = dict[str, float]()
        bodies = self.body, *self.joined_bodies
        for k, (rigid, body) in enumerate(zip(self.rigid, bodies, strict=True)):
            name = (
                FRICTION_TO_ROCK if len(self.bodies) == 1 else f"base {k + 1}: {FRICTION_TO_ROCK}"
            )
            if not self.links:
                frictions[f"{name} b/h"] = min(body.left, body.right) / body.centre_height
            elif rigid:
                frictions[name] = self.uplift_limits(k).friction
        return frictions

    def words(self) -> Words:
        """Describe bodies and bases, from the top down."""
        numbers = list[tuple[str, str]]()
        left_out = ["sliding", "elasticity of the bodies"]
        for k, (body, base) in enumerate(zip(self.bodies, self.bases, strict=True), 1):
            of_base = base.words()
            size = f"{2.0 * body.half_width:.6g} m wide, centre of mass {body.centre_height:.6g} m"
            numbers.append((f"body {k}", f"{size} above its base, {body.mass:.6g} kg"))
            if self.rigid[k - 1]:
                starts = self.uplift_limits(k - 1).words()
                numbers.append((f"base {k}: rigid, all above rocks as one at xg'' of", starts))
            numbers += [(f"base {k}: {name}", words) for name, words in of_base.numbers]
            left_out += [one for one in of_base.left_out if one not in left_out]
        numbers += [(one.name, one.words()) for one in self.links]
        laws = list(dict.fromkeys(base.words().law for base in self.bases))
        rigid_impacts = (
            "on rigid bases plastic, by projection on the contacts that are admissible; of "
            "several the one that loses the least energy"
        )
        restrainers = [
            ("restrainers", "a force along each, between its points; slack, taut, yielding, broken")
        ]
        return Words(
            equations=[
                ("full, left, right", f"{3 * len(self.bodies)} coordinates less one for each point "
                 f"that is held; {' and '.join(laws)}, along the normal of what a body stands on"),
                ("flight", "free fall of a body and all above it, apart or together"),
                ("impact", "an impulse between two bodies, which changes the velocities of all"),
                *([("", rigid_impacts)] if any(self.rigid) else []),
                *(restrainers if self.links else ()),
            ],
            restraint=f"of every body on what it stands on; {restraint_words(self.options)}",
            numbers=numbers,
            left_out=left_out,
        )  # fmt: skip

    @cached_property
    def _rest(self) -> list[Pose]:
        poses = self.standing.rest if self.groups else []
        if poses is None:
            raise AssemblyError([NO_EQUILIBRIUM + (PULLED_OVER if self.links else "")])
        faults = list[str]()
        for k, rigid in enumerate(self.rigid):
            if not rigid:
                continue
            load = self.rigid_base_load(k)
            done = None
            if load.normal <= 0.0:
                done = f"lift body {k + 1}"
            elif load.left_limit < 0.0 or load.right_limit < 0.0:
                done = f"tip body {k + 1} to the {'right' if load.right_limit < 0.0 else 'left'},"
            if done is not None:
                faults.append(f"weights, loads and restrainers {done} off its rigid base")
        if faults:
            raise AssemblyError(faults)
        return poses

    def _rest_positions(self) -> list[AtRest]:
        """Return the position of each body at rest on its base; full contact on rigid bases."""
        positions = [UPRIGHT] * len(self.bodies)
        for group, pose in zip(self.groups, self._rest, strict=True):
            lowest, rotation, vertical = group[-1], pose.state.rotation, pose.state.vertical
            if len(group) > 1:  # from the joined body's centre of mass to that of the lowest one
                body = self.chain_bodies[lowest].body
                attitude = body.attitude(rotation)
                vertical = pose.line.left - attitude.rise - body.left * attitude.sine
            positions[lowest] = AtRest(rotation, vertical)
        return positions

    @cached_property
    def rest_rotation(self) -> float:
        """Rotation of the highest body at rest [rad]."""
        return math.fsum(pose.state.rotation for pose in self._rest) if self.leans else 0.0

    @cached_property
    def uplift_angle(self) -> float:
        """Uplift angle of the highest body; NaN if links act on it and bodies are below [rad]."""
        if self.rigid[0] or all(0 not in (link.on, link.to) for link in self.links):
            return self.bases[0].uplift_angle
        if len(self.bodies) > 1:
            return math.nan
        angles = (abs(self.standing.chain.uplift_rotation(side)) for side in (1.0, -1.0))
        return min((angle for angle in angles if not math.isnan(angle)), default=math.nan)

    def small_motion(self) -> SmallMotion | None:
        """Return the equations of small motion about rest, of each body relative to its base."""
        if not self.groups:
            return None
        if len(self.bodies) == 1:
            return self.standing.motion_of_single_body(self._rest)
        names = ("body_rotation", "body_vertical_displacement") * len(self.groups)
        which = tuple(group[-1] + 1 for group in self.groups)
        return SmallMotion(names, *self.standing.small_motion(self._rest), bodies=which)

    def without_small_motion(self) -> str:
        """Say why there are no equations of small motion."""
        return (
            "bodies on rigid bases have no small motion: they stand still or rock, with a period "
            "that grows with the amplitude; put them on pads or soil"
        )

    @cached_property
    def overturning_energy(self) -> float:
        """Least energy that overturns bodies slowly, to the weaker side [J].

        With rigid and deformable bases, that of the weakest rigid base, as if all were rigid.
        """
        if not any(self.rigid) or not self.groups:
            return super().overturning_energy
        return min(self.rocking_energy(k) for k, rigid in enumerate(self.rigid) if rigid)

    def curve(self, rotations: Sequence[float]) -> list[Statics | None]:
        """Return the equilibria with the highest body held at rotations [rad].

        With rigid and deformable bases, also where a corner has lifted from a rigid base.
        """
        if not self.groups:
            return [self.rocking_statics(rotation) for rotation in rotations]
        states = self.standing.held(rotations)
        if len(self.bodies) == 1:
            return states
        if any(self.rigid):
            states = self.statics_beyond_uplift(rotations, states)
        return [None if state is None else replace(state, reactions={}) for state in states]

    def equilibrium(self) -> dict[str, Any]:
        """Return the values of links and, of a single body, of its base at rest, by names."""
        values = dict[str, Any]()
        if len(self.bodies) == 1 and not self.groups:
            load = self.rigid_base_load(0)
            left, right = self.body.left, self.body.right
            reactions = (load.right_limit / (left + right), load.left_limit / (left + right))
            values = {
                "uplift_moment": load.normal * self.body.half_width,
                **static_values(corner_reactions(*reactions)),
            }
        elif len(self.bodies) == 1:
            base, shown = self.bases[0], self.standing.reactions(self._rest)
            values = {base.settlement_name: base.settlement, **static_values(shown)}
        if not self.link_names:
            return values
        tied = self.links_at_rest[: len(self.link_names)]
        return values | {
            "restrainer": list(self.link_names),
            "static_restrainer_force": [self.body.mass * tie.force for tie in tied],
            "static_restrainer_elongation": [tie.elongation for tie in tied],
        }

    def contact_model(self) -> ContactModel:
        """Return the equations of stacked bodies."""
        from rockframe.dynamics.chain.model import chain_model

        rest = self._rest_positions()
        limits = [joined.overturning_angles for joined in self.joined_bodies]
        one_linked_body = bool(self.links) and len(self.bodies) == 1 and bool(self.groups)
        return chain_model(
            self.chain_bodies, self.body.mass, rest if self.leans else None, limits,
            self.chain_links, self._equilibrium_height if one_linked_body else None,
            self.frictions,
        )  # fmt: skip

    def _equilibrium_height(self, rotation: float) -> float:
        """Return the height at which a single body with links starts at a rotation [m]."""
        poses = self.standing.chain.poses_at([rotation])
        if poses is None:
            raise AssemblyError([NO_EQUILIBRIUM + PULLED_OVER])
        return poses[0].state.vertical


@dataclass(frozen=True)
class SlidingStackSetting(StackSetting):
    """Stacked bodies that are held by friction, or slip, on their bases."""

    slides = True

    @property
    def model(self) -> str:
        """Name of the model."""
        return f"{super().model}-sliding"

    def words(self) -> Words:
        """Describe bodies, bases and friction."""
        return sliding_words(super().words(), *(
            friction.row(f"base {k}: ")
            for k, friction in enumerate(self.frictions, 1)
        ))  # fmt: skip

    def slips_of(self, ending: Ending) -> tuple[SlipRange, ...]:
        """Return how far each body slipped."""
        return chain_slips(self, len(self.bodies), ending)

    def beyond_edges(self, ending: Ending) -> list[str]:
        """Warn of bodies that slipped beyond an edge of the body below, which is not modelled."""
        pairs = zip(self.bodies, self.bodies[1:], self.offsets, self.slips_of(ending), strict=False)
        return [
            text
            for k, (upper, lower, offset, slips) in enumerate(pairs, 1)
            for text in overhang_cautions(
                slips, offset, upper.half_width, lower.half_width, (f"body {k}", f"body {k + 1}")
            )
        ]


@dataclass(frozen=True)
class RestrainedSetting(StackSetting):
    """A block with links on rigid ground, which holds it against sliding."""

    @property
    def friction(self) -> BaseFriction:
        """Friction of the ground."""
        return self.frictions[0] if self.frictions else NO_SLIP

    def contact_model(self) -> ContactModel:
        """Return the equations of slip, rotation and rise, with links."""
        from rockframe.dynamics.slide_rock import slide_rock
        from rockframe.dynamics.tied_slide_rock import tied_slide_rock

        self._rest  # noqa: B018 - refuses a block that its links tip over
        block = slide_rock_of(self.body, self.friction, self.body.maximum_restitution, self.gravity)
        if not self.chain_links:  # all links are loads that are masses
            return slide_rock(block, mass=self.body.mass)
        return tied_slide_rock(block, self.chain_links, mass=self.body.mass)


@dataclass(frozen=True)
class SlidingRestrainedSetting(RestrainedSetting):
    """A block with links on rigid ground, on which it slides."""

    impact: Impact = Impact.COULOMB  # law of its impacts
    slides = True

    @property
    def model(self) -> str:
        """Name of the model."""
        return "rigid-restrained-sliding"

    def words(self) -> Words:
        """Describe the block, its links and its friction."""
        text = super().words()
        slides = sliding_words(
            text,
            self.friction.row(),
            ("friction to land without slip", f"{friction_to_roll_over(self.body):.6g}"),
            restraint=HELD_BY_FRICTION,
        )
        return replace(
            slides,
            equations=[
                ("full", "at rest while friction holds the base, and until it tips; else it slides "
                 "on its whole base"),
                ("left, right", "it rocks about the corner that bears while friction holds that, "
                 "and slips on it otherwise"),
                SLIP_EQUATION,
                ("flight", "nothing bears: N = 0"),
                ("impact", f"{self.impact}: {impact_words(self.impact)}; restrainers, whose forces "
                 "are finite, have no part in it"),
                *(equation for equation in text.equations if equation[0] == "restrainers"),
            ],
        )  # fmt: skip

    def slips_of(self, ending: Ending) -> tuple[SlipRange, ...]:
        """Return how far the block slipped."""
        return (slips_on_ground(ending),)


def refuse_options(what: str, options: Options, *, small: bool) -> None:
    """Refuse an inclination and, unless `small`, small rotation, which the equations lack."""
    faults = list[str]()
    if options.inclination != 0.0:
        faults.append(f"{what} stands on level ground: inclination must be zero")
    if options.small and not small:
        faults.append(f"{what} needs rotation='finite'")
    if faults:
        raise AssemblyError(faults)


def stack_setting(
    blocks: Sequence[BlockSI],
    offsets: tuple[float, ...],
    standing_on: Sequence[Component],
    options: Options,
    links: Sequence[Link],
) -> StackSetting:
    """Return the setting of stacked blocks, listed from the top down, on bases and with links."""
    stacked = [block_body(block) for block in blocks]
    for link in links:  # masses of loads are added to their bodies
        k = link.si.on_body - 1
        if isinstance(link, Load) and link.si.moving_mass and k < len(stacked):
            x, y = link.si.at
            masses = stacked[k].mass_at(), PlaneMass(link.si.moving_mass, x, y, 0.0)
            stacked[k] = combine_masses(stacked[k].half_width, masses)
    bodies = tuple(stacked)
    tops = tuple(
        block.height - body.centre_height for block, body in zip(blocks, stacked, strict=True)
    )
    load = BaseLoad(bodies[0], options)
    loads = [load] if len(bodies) == 1 else [
        BaseLoad(combined_body(bodies[: k + 1], tops, offsets), options)
        for k in range(len(bodies))
    ]  # fmt: skip
    bases = tuple(support_of(part, load) for part, load in zip(standing_on, loads, strict=True))
    faults = [  # on a deformable base both edges of the joint do not meet
        f"a Tendon through body {link.si.on_body} is bent at a base that gives way: give the depth "
        "below the base at which it is held"
        for link in links
        if isinstance(link, Tendon)
        and link.si.depth == 0.0
        and link.si.on_body <= len(bases)
        and not isinstance(bases[link.si.on_body - 1], RigidBase)
    ]
    if faults:
        raise AssemblyError(faults)
    links_in_place = place_links(links, bodies, tops, offsets)
    held = StackSetting(load, bodies, tops, offsets, bases, links_in_place)
    return _with_friction(held, standing_on)


def _with_friction(held: StackSetting, standing_on: Sequence[Component]) -> StackSetting:
    """Return the setting of the same bodies with slip where bases have friction."""
    options, bodies = held.options, held.bodies
    numbers = held.load, bodies, held.tops, held.offsets, held.bases, held.links
    frictions = [base_friction(base, options) for base in standing_on]
    ground = standing_on[0]
    if len(bodies) == 1 and isinstance(ground, RigidGround):
        (friction,) = frictions
        if friction is None:
            return RestrainedSetting(*numbers)
        faults = [*sheared_tendon_faults(held), *jamming_faults(held.body, friction.kinetic)]
        if faults:
            raise AssemblyError(faults)
        return SlidingRestrainedSetting(*numbers, (friction,), ground.si.impact)
    slips = any(getattr(base.si, "friction", None) is not None for base in standing_on)
    _refuse_many_modes(standing_on, slips)
    checked = options.sliding is Sliding.CHECKED
    if not slips or (checked and len(bodies) == 1):
        return held
    faults = sheared_tendon_faults(held) if any(held.rigid) and not checked else []
    if checked:
        faults.append("friction in a Stack is computed: give no sliding='checked', or no friction")
    for k, (body, friction) in enumerate(zip(bodies, frictions, strict=True)):
        if friction is not None and held.rigid[k]:
            faults += [f"body {k + 1}: {one}" for one in jamming_faults(body, friction.kinetic)]
    if options.small:
        faults.append(SLIDING_AT_SMALL_ROTATION)
    if faults:
        raise AssemblyError(faults)
    return SlidingStackSetting(*numbers, tuple(one or NO_SLIP for one in frictions))


def _refuse_many_modes(bases: Sequence[Component], slips: bool) -> None:
    """Refuse bodies whose contacts have more combinations than can be numbered."""
    from rockframe.dynamics.chain.rows import BED_MODES, PAD_MODES, RIGID_MODES

    count = 1
    for base in bases:
        if isinstance(base, RigidGround):
            modes = RIGID_MODES
        else:
            modes = PAD_MODES if isinstance(base, TwoSpringSupport) else BED_MODES
        count *= 2 * modes if slips else modes
    if count > MAX_MODES:
        raise AssemblyError([
            f"the contacts of {len(bases)} bodies on these bases have {count:.2g} combinations, "
            f"more than the {MAX_MODES:.2g} that can be numbered: give fewer bodies, or rigid "
            "joints without friction"
        ])  # fmt: skip


def sheared_tendon_faults(setting: StackSetting) -> list[str]:
    """Return faults for tendons without depth below a joint: a slip would shear them there."""
    return [
        f"{link.name}: a Tendon without a depth is bent over the edge of its duct at the base, and "
        "a block that slides shears it there: give the depth below the base at which it is fixed"
        for link in setting.links
        if isinstance(link.part, Tendon) and link.part.si.depth == 0.0
    ]
