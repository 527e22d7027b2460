"""Statics of bodies on one another, with the forces of their equations of motion.

Each body stands on the deck of the one beneath it. For given rotations on the bases, a base carries
the load above it, at a height that follows from its law; unbalanced moments remain,
:eq:`eq-static-chain`. All numbers are per unit mass.
"""

import math
from collections.abc import Sequence
from functools import partial
from typing import Final, NamedTuple, cast

import numpy as np

from rockframe.compiled import Matrix, Vector
from rockframe.dynamics.chain.link_rows import ChainLink
from rockframe.dynamics.equilibrium import Balance, HeldBodies, Path, followed
from rockframe.dynamics.standing import (
    PLACES,
    ROUNDING,
    Stand,
    StandingBody,
    lifted,
    on_corner,
    settled,
)
from rockframe.dynamics.tied import Reached, Tied, is_broken, reached, tied
from rockframe.dynamics.trigonometry import sine_cosine, versine

FAR: Final = 10.0
"""Change of a body's height over its size beyond which no equilibrium is searched [1]."""
TINY: Final = 1e-30
"""Absolute tolerance of a height, practically zero [m]."""
LEFT: Final = 1e-6
"""Unbalanced force over the weight that is allowed, for links as stiff as rounding permits [1]."""


class StandingChain(NamedTuple):
    """Bodies that stand on one another, from the top down, and gravity along the lowest base.

    The forces of links are multiplied by `pull`.
    """

    bodies: tuple[StandingBody, ...]
    along_gravity: float = 0.0
    ties: tuple[ChainLink, ...] = ()
    pull: float = 1.0

    @property
    def upright(self) -> bool:
        """Whether no load turns the bodies away from upright."""
        level = self.along_gravity == 0.0 and not self.ties
        return level and all(one.beside == 0.0 for one in self.bodies)

    def scaled(self, share: float) -> "StandingChain":
        """Return the chain with a share of its slope and of the eccentricity of its bodies."""
        if share == 1.0:
            return self
        bodies = tuple(one.scaled(share) for one in self.bodies)
        return StandingChain(bodies, share * self.along_gravity, self.ties, share * self.pull)

    def frames(self, rotations: Sequence[float]) -> list[tuple[float, float]]:
        """Return gravity normal to the deck under each body, and along it."""
        normal, along = self.bodies[0].part.body.gravity, self.along_gravity
        turned, found = 0.0, [(normal, along)]
        for rotation in reversed(rotations[1:]):
            turned += rotation
            sine, cosine = sine_cosine(turned)
            found.append((normal * cosine + along * sine, along * cosine - normal * sine))
        return found[::-1]

    @property
    def weight(self) -> float:
        """The weight of all bodies on a level base."""
        return self.bodies[0].part.body.gravity * sum(one.mass for one in self.bodies)

    @property
    def sizes(self) -> Vector:
        """Typical sizes of rotation and height of each body on its base."""
        return np.ravel([(one.allowed_rotation, one.settlement) for one in self.bodies])

    def settled(self, rotations: Sequence[float]) -> list[Stand] | None:
        """Return the bodies at rotations on their bases; None where a base would be in tension."""
        if len(rotations) == 1:
            return self.curve(rotations)[0]
        stands = self._under_weight(rotations)
        if stands is None or not self.ties:
            return stands
        return self._at(self._loaded(stands, np.eye(len(rotations)).tolist()))

    def _has_broken(self, stands: Sequence[Stand]) -> bool:
        """Whether a link is broken with the bodies where they are."""
        found = self.tied(stands) if stands and self.ties else []
        return any(is_broken(one, of.elongation) for one, of in zip(self.ties, found, strict=False))

    def _alone_at(self, rotation: float) -> list[Stand] | None:
        """Return a single body at a rotation, with links as after slow loading up to there."""
        stands = self._under_weight([rotation])
        if stands is None or not self.ties:
            return stands
        if self.bodies[0].corner:
            return self._at(self._loaded(stands, [[1.0]]))
        return self._at_height(stands[0])

    def _at_height(self, stand: Stand) -> list[Stand] | None:
        """Return a single body at its rotation, its height found by bracketing.

        Newton's method fails where links yield or break, as these have no stiffness then.
        """
        from scipy.optimize import brentq

        standing, at = self.bodies[0], partial(self._lifted, stand.state.rotation)
        here, far = stand.state.vertical, FAR * standing.part.body.size()
        found, lack = at(here)
        if abs(lack) <= 4.0 * ROUNDING * self.weight:
            return found
        step = math.copysign(standing.settlement, lack)
        there = here + step
        while at(there)[1] * step > 0.0:
            step *= 2.0
            here, there = there, there + step
            if abs(step) > far:
                return None
        height = brentq(lambda height: at(height)[1], here, there, xtol=TINY)
        found, lack = at(cast("float", height))
        return found if abs(lack) <= LEFT * self.weight else None

    def _lifted(self, rotation: float, height: float) -> tuple[list[Stand], float]:
        """Return a single body at a rotation and a height, and the upward force on it."""
        stands = self._with_arms([lifted(self.bodies[0], rotation, height)])
        load = self.weights(stands)[0][1] + self.tie_loads(stands)[1]
        return stands, float(stands[0].force.upward + load)

    def uplift_rotation(self, side: float) -> float:
        """Return rotation to a side at which an end of a single body with links lifts off [rad].

        NaN if there is none up to a right angle.
        """
        from scipy.optimize import brentq

        (standing,) = self.bodies

        def lack(rotation: float) -> float:
            lying = lifted(standing, rotation, 0.0)
            height = standing.part.base.level(side > 0.0, lying.line, lying.own)
            return self._lifted(rotation, height)[1]

        far = side * standing.allowed_rotation
        while lack(far) < 0.0:
            far *= 2.0
            if abs(far) > 0.5 * math.pi:
                return math.nan
        return cast("float", brentq(lack, 0.0, far))

    def _under_weight(self, rotations: Sequence[float]) -> list[Stand] | None:
        """Return the bodies at rotations on their bases, without their links."""
        mass, found = 0.0, list[Stand]()
        frames = self.frames(rotations)
        for standing, rotation, (normal, _) in zip(self.bodies, rotations, frames, strict=True):
            mass += standing.mass
            if not mass * normal > 0.0:
                return None
            found.append(settled(standing, rotation, mass * normal))
        return self._with_arms(found)

    def _with_arms(self, stands: Sequence[Stand]) -> list[Stand]:
        """Return the bodies with their heights over the bodies beneath them."""
        decks = [*(one.top for one in self.bodies[1:]), 0.0]
        return [
            one._replace(arm=deck + standing.part.body.height + one.state.vertical)
            for standing, one, deck in zip(self.bodies, stands, decks, strict=True)
        ]

    def stands_at(self, balance: Balance) -> list[Stand]:
        """Return the bodies on bases that carry the forces of a balance, or lifted off them."""
        places = zip(self.bodies, *(each.tolist() for each in balance[:3]), strict=True)
        return self._with_arms([
            settled(one, rotation, press) if press > 0.0 else lifted(one, rotation, height)
            for one, rotation, height, press in places
        ])  # fmt: skip

    def moved(self, stands: Sequence[Stand], at: int, by: float) -> list[Stand]:
        """Return the bodies with one coordinate moved, the forces of their bases unchanged."""
        k, found = at // 2, [*stands]
        standing, now = self.bodies[k], stands[k]
        state = now.state._replace(**{PLACES[at % 2]: now.state[at % 2] + by})
        if standing.corner:
            found[k] = on_corner(standing, state.rotation, now.press)
        else:
            attitude = standing.part.body.attitude(state.rotation)
            reach, across = standing.way(attitude, now.mode.pivot)
            found[k] = now._replace(state=state, reach=reach, across=across)
        return self._with_arms(found)

    def following(self, stands: Sequence[Stand]) -> Matrix:
        """Return derivatives of coordinates by the free ones: on a corner no height is free."""
        found = np.eye(2 * len(stands))
        for k, (standing, stand) in enumerate(zip(self.bodies, stands, strict=True)):
            if standing.corner:
                found[2 * k + 1, 2 * k] = -standing.corner_lever(stand)
                found[2 * k + 1, 2 * k + 1] = 0.0
        return found

    def loads(self, stands: Sequence[Stand], of_links: Vector) -> Vector:
        """Return the generalised forces of weights and links on rotation and height of each body.

        A body that rests on a corner has none on its height: it follows from the rotation.
        """
        found = np.ravel(self.weights(stands)) + of_links
        for k, (standing, stand) in enumerate(zip(self.bodies, stands, strict=True)):
            if standing.corner:
                found[2 * k] -= standing.corner_lever(stand) * found[2 * k + 1]
                found[2 * k + 1] = 0.0
        return found

    def _at(self, path: Path | None) -> list[Stand] | None:
        """Return the bodies at the end of a path; corners of rigid bases carry the rest."""
        if path is None:
            return None
        stands = self.stands_at(path.place)
        loads = np.ravel(self.weights(stands))
        for pull, one in zip(path.place.pulls, self.reached(stands), strict=True):
            loads -= pull @ one.way
        for k, (standing, one) in enumerate(zip(self.bodies, stands, strict=True)):
            if standing.corner:
                stands[k] = on_corner(standing, one.state.rotation, -float(loads[2 * k + 1]))
        bears = all(one.press >= 0.0 for one in stands)
        return self._with_arms(stands) if bears else None

    def reached(self, stands: Sequence[Stand]) -> list[Reached]:
        """Return displacements of the points of the links."""
        return reached(self.bodies, stands, self.ties)

    def tied(
        self, stands: Sequence[Stand], states: Sequence[int] | None = None,
        stretches: Sequence[float] | None = None,
    ) -> list[Tied]:  # fmt: skip
        """Return elongations and forces of the links."""
        return tied(self.bodies, stands, self.ties, states, stretches)

    def tie_loads(self, stands: Sequence[Stand], states: Sequence[int] | None = None) -> Vector:
        """Return the generalised forces of links on rotation and height of each body."""
        found = np.zeros(2 * len(stands))
        for one in self.tied(stands, states):
            found += self.pull * one.loads
        return found

    def moments(self, stands: Sequence[Stand]) -> list[float]:
        """Return the generalised force on each body's rotation on its base."""
        weights = self.weights(stands)
        found = [stand.force.moment + of[0] for stand, of in zip(stands, weights, strict=True)]
        if self.ties:
            pulled = self.tie_loads(stands)[::2].tolist()
            found = [moment + more for moment, more in zip(found, pulled, strict=True)]
        return found

    def weights(self, stands: Sequence[Stand]) -> list[tuple[float, float]]:
        """Return the generalised forces of all weights on rotation and height of each body."""
        found = list[tuple[float, float]]()
        mass = side = height = 0.0  # of what stands on a body, and its moments about the centre
        frames = self.frames([stand.state.rotation for stand in stands])
        for standing, stand, (normal, along) in zip(self.bodies, stands, frames, strict=True):
            if mass > 0.0:  # from the axes of its deck to those of the one beneath
                sine, cosine = sine_cosine(stand.state.rotation)
                height += mass * standing.top
                side, height = side * cosine + height * sine, height * cosine - side * sine
            mass += standing.mass
            moment = normal * side - along * (height + mass * stand.reach.derivative)
            found.append((moment, -mass * normal))
            side += mass * stand.across
            height += mass * (standing.part.body.height + stand.state.vertical)
        return found

    def rise(self, stands: Sequence[Stand]) -> float:
        """Return the rise of the highest centre of mass from upright rest [m]."""
        found = turned = top = 0.0
        for standing, stand in zip(self.bodies[::-1], stands[::-1], strict=True):
            sine, cosine = sine_cosine(turned)
            if turned != 0.0:
                lowers = (top + standing.part.body.height) * versine(sine, cosine)
                found -= stand.across * sine + lowers
            found += stand.state.vertical * cosine
            turned, top = turned + stand.state.rotation, standing.top
        return found

    def rest(self) -> list[Stand] | None:
        """Return the bodies at rest under their weight, :eq:`eq-tilted-rest`; None if they fall.

        Eccentricity and slope grow from zero, and the equilibrium is followed from upright: a chain
        that leans has a second equilibrium, farther out, which is unstable.
        """
        upright = self._under_weight([0.0] * len(self.bodies))
        if upright is None or self.upright:
            return upright
        return self._at(self._loaded(upright, []))

    def curve(self, rotations: Sequence[float]) -> list[list[Stand] | None]:
        """Return the bodies while a couple holds the highest one at each of some rotations.

        Equilibrium is followed from upright to either side; None from where it ends.
        """
        one, every = len(self.bodies) == 1, range(len(rotations))
        found = [self._alone_at(rotation) if one else None for rotation in rotations]
        # a link that is broken at one height of a body may be whole at another
        sought = [i for i in every if not one or self._has_broken(found[i] or [])]
        for side in (1.0, -1.0):
            here = [i for i in sought if math.copysign(1.0, rotations[i]) == side]
            path = self._upright_path() if here else None
            for i in sorted(here, key=lambda i: abs(rotations[i])):
                if path is None:
                    break
                path, stands = self.held(path, rotations[i])
                found[i] = stands or found[i]
        return found

    def _upright_path(self) -> Path | None:
        """Return the start of the curve: equilibrium under all loads, the highest body upright."""
        upright = self._under_weight([0.0] * len(self.bodies))
        loaded = None if upright is None else self._loaded(upright, [len(self.bodies) * [1.0]])
        return None if loaded is None else Path(0.0, loaded.place)

    def held(self, path: Path, rotation: float) -> tuple[Path | None, list[Stand] | None]:
        """Return path and bodies at a rotation of the highest one, followed from a path so far."""
        highest, size = np.ones((1, len(self.bodies))), float(self.sizes[::2].min())
        further = followed(
            lambda at: HeldBodies(self, highest, np.array([at])), path, rotation, size
        )
        return further, self._at(further)

    def _loaded(self, stands: Sequence[Stand], sums: Sequence[Sequence[float]]) -> Path | None:
        """Follow bodies as eccentricity, slope and links grow, with sums of rotations held."""
        rows = np.array(sums).reshape(-1, len(stands))
        start = Balance.of(self, stands, len(rows))
        held = rows @ start.rotations
        return followed(lambda share: HeldBodies(self.scaled(share), rows, held), Path(0.0, start))
