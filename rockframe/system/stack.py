"""The scene of bodies upon one another: its numbers, its words and its model."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Final

from rockframe.components import Component, Stack
from rockframe.dynamics.statics import Stand, StandingChain, link_of
from rockframe.errors import AssemblyError
from rockframe.system.bodies import SupportedBody, body_of_block
from rockframe.system.load import Load
from rockframe.system.options import Options
from rockframe.system.restraints import restraint_words
from rockframe.system.setting import Setting
from rockframe.system.slots import support_of
from rockframe.system.small_motion import SmallMotion
from rockframe.system.statics import StandingBodies, Statics
from rockframe.system.support import Support
from rockframe.system.words import Words

if TYPE_CHECKING:
    from rockframe.dynamics.chain.model import ChainBody
    from rockframe.dynamics.protocol import ContactModel

NO_REST: Final = "the bodies find no rest under their weight: their bases are too soft for them"


@dataclass(frozen=True)
class StackSetting(Setting):
    """Bodies upon one another.

    Parameters
    ----------
    load : Load
        The highest body, with the options of its system.
    bodies : tuple of SupportedBody
        All of them, from the top down.
    tops : tuple of float
        Height of the top of each above its centre of mass [m].
    offsets : tuple of float
        How far the middle of each base is to the right of that of the body below [m].
    bases : tuple of Support
        What each stands on, under all that it carries.
    """

    bodies: tuple[SupportedBody, ...]
    tops: tuple[float, ...]
    offsets: tuple[float, ...]
    bases: tuple[Support, ...]

    @property
    def model(self) -> str:
        """Name of the model."""
        return "stack"

    @property
    def supports(self) -> tuple[Support, ...]:
        """All bases."""
        return self.bases

    @property
    def leans(self) -> bool:
        """Whether some body is not symmetric, or not above the middle of what it stands on."""
        eccentric = any(body.eccentricity != 0.0 for body in self.bodies)
        return eccentric or any(self.offsets) or not self.slope.level

    def cautions(self) -> list[str]:
        """Give the warnings of all bases, each with the body that it is under."""
        found = [
            f"under body {k}: {text}"
            for k, base in enumerate(self.bases, 1)
            for text in base.cautions()
        ]
        return [*found, *self._leaning()]

    def words(self) -> Words:
        """Tell bodies and bases, from the top down."""
        numbers = list[tuple[str, str]]()
        left_out = ["sliding", "elasticity of the bodies"]
        for k, (body, base) in enumerate(zip(self.bodies, self.bases, strict=True), 1):
            told = base.words()
            size = f"{2.0 * body.half_width:.6g} m wide, centre of mass {body.centre_height:.6g} m"
            numbers.append((f"body {k}", f"{size} above its base, {body.mass:.6g} kg"))
            numbers += [(f"base {k}: {name}", words) for name, words in told.numbers]
            left_out += [one for one in told.left_out if one not in left_out]
        laws = list(dict.fromkeys(base.words().law for base in self.bases))
        return Words(
            equations=[
                ("full, left, right", f"{3 * len(self.bodies)} coordinates less one for each point "
                 f"that is held; {' and '.join(laws)}, along the normal of what a body stands on"),
                ("flight", "free fall of a body and all above it, apart or together"),
                ("impact", "an impulse between two bodies; the velocities of all of them answer"),
            ],
            restraint=f"of every body on what it stands on; {restraint_words(self.options)}",
            numbers=numbers,
            left_out=left_out,
        )  # fmt: skip

    @cached_property
    def links(self) -> "tuple[ChainBody, ...]":
        """The bodies as the equations take them, per unit mass of the highest one."""
        from rockframe.dynamics.chain.model import ChainBody

        found, carried, mass = list["ChainBody"](), 0.0, self.body.mass
        below = (*(body.eccentricity for body in self.bodies[1:]), 0.0)
        for body, top, offset, base, lower in zip(
            self.bodies, self.tops, self.offsets, self.bases, below, strict=True
        ):
            carried += body.mass
            beside = offset + body.eccentricity - lower
            law = Load(body, self.options).law(mass)
            numbers = base.law(law, mass, carried)
            found.append(ChainBody(law, numbers, body.mass / mass, top, beside))
        return tuple(found)

    @cached_property
    def _standing(self) -> StandingBodies:
        from rockframe.dynamics.on_base import OnBase

        links = tuple(
            link_of(OnBase(one.body, one.base.law), one.mass, one.top, one.beside)
            for one in self.links
        )
        chain = StandingChain(links, self.slope.along_gravity)
        return StandingBodies(chain, self.body.mass, tuple(one.base for one in self.links))

    @cached_property
    def _rest(self) -> list[Stand]:
        found = self._standing.rest
        if found is None:
            raise AssemblyError([NO_REST])
        return found

    @cached_property
    def rest_rotation(self) -> float:
        """Rotation of the highest body at rest [rad].

        Raises
        ------
        AssemblyError
            The bases are too soft to carry the bodies.
        """
        return math.fsum(one.state.rotation for one in self._rest) if self.leans else 0.0

    def small_motion(self) -> SmallMotion:
        """Give the equations of small motion about rest, of each body on what it stands on."""
        count = len(self.bodies)
        names = ("body_rotation", "body_vertical_displacement") * count
        return SmallMotion(names, *self._standing.small_motion(self._rest), bodies=count)

    def curve(self, rotations: Sequence[float]) -> list[Statics | None]:
        """Give the equilibria with the highest body held at rotations."""
        found = self._standing.held(rotations)
        return [None if one is None else replace(one, reactions={}) for one in found]

    def equilibrium(self) -> dict[str, float]:
        """Give nothing beside the rotation at rest: each base has a settlement of its own."""
        return {}

    def contact_model(self) -> "ContactModel":
        """Give the equations of bodies upon one another."""
        from rockframe.dynamics.chain.model import AtRest, chain

        rest = [AtRest(one.state.rotation, one.state.vertical) for one in self._rest]
        limits = [
            combined_body(self.bodies[: k + 1], self.tops, self.offsets).overturning_angles
            for k in range(1, len(self.bodies))
        ]
        return chain(self.links, self.body.mass, rest if self.leans else None, limits)


def combined_body(
    bodies: Sequence[SupportedBody], tops: Sequence[float], offsets: Sequence[float]
) -> SupportedBody:
    """Give bodies upon one another, from the top down, as one upright body.

    `offsets` are those of all but the lowest, whose base is that of the whole.
    """
    lowest = bodies[-1]
    places, base, beside = [(lowest, lowest.centre_height, 0.0)], 0.0, 0.0
    for k in range(len(bodies) - 2, -1, -1):
        base += bodies[k + 1].centre_height + tops[k + 1]
        beside += offsets[k]
        places.append((bodies[k], base + bodies[k].centre_height, beside))
    mass = math.fsum(body.mass for body, _, _ in places)
    height = math.fsum(body.mass * level for body, level, _ in places) / mass
    across = math.fsum(body.mass * (x + body.eccentricity) for body, _, x in places) / mass
    inertia = math.fsum(
        body.inertia + body.mass * ((level - height) ** 2 + (x + body.eccentricity - across) ** 2)
        for body, level, x in places
    )
    shape_factor = mass * (lowest.half_width**2 + height**2) / inertia
    return SupportedBody(lowest.half_width, height, mass, inertia, shape_factor, across)


def stack_setting(stack: Stack, base: Component, options: Options) -> StackSetting:
    """Give the scene of a stack on a base.

    Raises
    ------
    AssemblyError
        It stands on a slope.
    """
    if options.inclination != 0.0:
        raise AssemblyError(["a Stack stands on level ground: inclination must be zero"])
    bodies = tuple(body_of_block(one) for one in stack.si.bodies)
    tops = tuple(one.height - one.centre_height for one in stack.si.bodies)
    offsets = stack.si.offsets
    bases = tuple(
        support_of(part, Load(combined_body(bodies[: k + 1], tops, offsets), options))
        for k, part in enumerate((*stack.interfaces, base))
    )
    return StackSetting(Load(bodies[0], options), bodies, tops, offsets, bases)
