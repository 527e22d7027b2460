"""Bodies on one another at rest and held: the forces are those of their equations of motion.

Each body stands on the deck of the one beneath it. Given how each is rotated on its base, what
stands above a base gives the force that it carries, its law the height at which it does, and
what is left are moments, :eq:`eq-static-chain`. All is per unit mass.
"""

import math
import sys
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, Final, NamedTuple, cast

import numpy as np

from rockframe.compiled import Matrix, Vector
from rockframe.dynamics.base import BaseForce
from rockframe.dynamics.bed import both_contacts
from rockframe.dynamics.body import (
    PIVOT_LEFT,
    PIVOT_RIGHT,
    Attitude,
    BaseLine,
    BodyState,
    Reach,
)
from rockframe.dynamics.equilibrium import PLACES, Balance, HeldBodies, Path, followed
from rockframe.dynamics.on_base import Mode, OnBase
from rockframe.dynamics.trigonometry import sine_cosine, versine
from rockframe.many import asin

if TYPE_CHECKING:
    from rockframe.dynamics.chain.link_rows import ChainLink
    from rockframe.dynamics.tied import Reached, Tied

ROUNDING: Final = 4.0 * sys.float_info.epsilon
"""Share of the sizes of heights that is rounding."""
TRIES: Final = 200
"""Heights that are tried at most."""
SECANTS: Final = 8
"""Of them by secants alone; where contact ends between two, each second one halves what is left."""
FAR: Final = 10.0
"""Of the size of a body, a change of its height that leads to no balance."""
TINY: Final = 1e-30
"""Height that is nothing [m]."""
LEFT: Final = 1e-6
"""Share of the weight that may be left where a link is as stiff as rounding shows."""
SHARP: Final = 1e-9
"""Share of the uplift angle by which contact is full before it and partial beyond."""
HALVINGS: Final = 60
"""Of the rotation at which contact is first lost, where the levels of the ends do not tell it."""


class StandingBody(NamedTuple):
    """A body on its base, in a chain of bodies."""

    part: OnBase
    mass: float  # over the mass that all is measured by
    top: float  # height of its deck above its centre of mass
    beside: float  # of its centre of mass to the right of that beneath, upright
    settlement: float  # of its base, a typical size
    own: Any  # variables of its base's own, as they are before any run
    # by which it has lifted from a rigid base: 1 bears on its right corner, -1 on its left one
    corner: int = 0

    @property
    def allowed_rotation(self) -> float:
        """The rotation that the settlement allows before an end of the base lifts, about."""
        return 2.0 * self.settlement / (self.part.body.left + self.part.body.right)

    def corner_lever(self, stand: "Stand") -> float:
        """Give by how much its corner rises with its rotation."""
        return stand.line.right_lever if self.corner > 0 else stand.line.left_lever

    def way(self, attitude: Attitude, pivot: int) -> tuple[Reach, float]:
        """Give how the centre of mass moves along the deck beneath, and where it is there."""
        body = self.part.body
        pin = body.pin(pivot)
        across = self.beside + pin + (body.height * attitude.sine - pin * attitude.cosine)
        return body.reach(pin, attitude), across

    def with_share(self, share: float) -> "StandingBody":
        """Give the body with a share of its eccentricity."""
        body = self.part.body
        if self.beside == 0.0 and body.left == body.right:
            return self
        half, off = 0.5 * (body.left + body.right), 0.5 * share * (body.left - body.right)
        part = OnBase(body._replace(left=half + off, right=half - off), self.part.base)
        return self._replace(part=part, beside=share * self.beside)


class Stand(NamedTuple):
    """A body at a rotation on its base, which carries what is on it."""

    state: BodyState
    mode: Mode
    reach: Reach
    across: float  # of its centre of mass along the deck beneath, from the one beneath
    line: BaseLine
    force: BaseForce
    press: float  # what stands on its base, along the normal of that
    own: Any  # variables of its base's own, as at a start there
    arm: float = 0.0  # of its centre of mass normal to the deck beneath, from the one beneath


class StandingChain(NamedTuple):
    """Bodies that stand on one another, from the top down, and gravity along the lowest base.

    Of what links them a share pulls.
    """

    bodies: tuple[StandingBody, ...]
    along_gravity: float = 0.0
    ties: "tuple[ChainLink, ...]" = ()
    pull: float = 1.0

    @property
    def upright(self) -> bool:
        """Whether nothing turns the bodies from where they stand upright."""
        level = self.along_gravity == 0.0 and not self.ties
        return level and all(one.beside == 0.0 for one in self.bodies)

    def with_share(self, share: float) -> "StandingChain":
        """Give the chain with a share of its slope and of the eccentricity of its bodies."""
        if share == 1.0:
            return self
        bodies = tuple(one.with_share(share) for one in self.bodies)
        return StandingChain(bodies, share * self.along_gravity, self.ties, share * self.pull)

    def frames(self, rotations: Sequence[float]) -> list[tuple[float, float]]:
        """Give gravity normal to the deck under each body, and along it."""
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
        """Give how the bodies stand at rotations on their bases; None where one would pull."""
        if len(rotations) == 1:
            return self.curve(rotations)[0]
        stands = self._under_weight(rotations)
        if stands is None or not self.ties:
            return stands
        return self._at(self._loaded(stands, np.eye(len(rotations)).tolist()))

    def _has_broken(self, stands: Sequence[Stand]) -> bool:
        """Whether a link is broken where bodies stand."""
        from rockframe.dynamics.tied import is_broken

        tied = self.tied(stands) if stands else []
        return any(is_broken(one, of.elongation) for one, of in zip(self.ties, tied, strict=False))

    def _alone_at(self, rotation: float) -> list[Stand] | None:
        """Give how one body stands at a rotation, whatever links it had there."""
        stands = self._under_weight([rotation])
        if stands is None or not self.ties:
            return stands
        if self.bodies[0].corner:
            return self._at(self._loaded(stands, [[1.0]]))
        return self._at_height(stands[0])

    def _at_height(self, stand: Stand) -> list[Stand] | None:
        """Give how one body stands at its rotation, between heights at which it rises and falls.

        Links that yield or break leave steps of Newton's nothing to go by.
        """
        from scipy.optimize import brentq

        standing, rotation = self.bodies[0], stand.state.rotation

        def at(height: float) -> tuple[list[Stand], float]:
            stands = self._with_arms([lifted(standing, rotation, height)])
            load = self.weights(stands)[0][1] + self.tie_loads(stands)[1]
            return stands, float(stands[0].force.upward + load)

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

    def _under_weight(self, rotations: Sequence[float]) -> list[Stand] | None:
        """Give how the bodies stand at rotations on their bases without what links them."""
        mass, found = 0.0, list[Stand]()
        frames = self.frames(rotations)
        for standing, rotation, (normal, _) in zip(self.bodies, rotations, frames, strict=True):
            mass += standing.mass
            if not mass * normal > 0.0:
                return None
            found.append(settled(standing, rotation, mass * normal))
        return self._with_arms(found)

    def _with_arms(self, stands: Sequence[Stand]) -> list[Stand]:
        """Give the bodies with where they are over what they stand on."""
        decks = [*(one.top for one in self.bodies[1:]), 0.0]
        return [
            one._replace(arm=deck + standing.part.body.height + one.state.vertical)
            for standing, one, deck in zip(self.bodies, stands, decks, strict=True)
        ]

    def stands_at(self, balance: Balance) -> list[Stand]:
        """Give how the bodies stand on bases that carry some forces, or above them."""
        places = zip(self.bodies, *(each.tolist() for each in balance[:3]), strict=True)
        return self._with_arms([
            settled(one, rotation, press) if press > 0.0 else lifted(one, rotation, height)
            for one, rotation, height, press in places
        ])  # fmt: skip

    def moved(self, stands: Sequence[Stand], at: int, by: float) -> list[Stand]:
        """Give the bodies with one coordinate moved, without what their bases do then."""
        k, found = at // 2, [*stands]
        standing, now = self.bodies[k], stands[k]
        state = now.state._replace(**{PLACES[at % 2]: now.state[at % 2] + by})
        if standing.corner:
            found[k] = _on_corner(standing, state.rotation, now.press)
        else:
            attitude = standing.part.body.attitude(state.rotation)
            reach, across = standing.way(attitude, now.mode.pivot)
            found[k] = now._replace(state=state, reach=reach, across=across)
        return self._with_arms(found)

    def following(self, stands: Sequence[Stand]) -> Matrix:
        """Give how coordinates go with those that are free: on a corner no height is."""
        found = np.eye(2 * len(stands))
        for k, (standing, stand) in enumerate(zip(self.bodies, stands, strict=True)):
            if standing.corner:
                found[2 * k + 1, 2 * k] = -standing.corner_lever(stand)
                found[2 * k + 1, 2 * k + 1] = 0.0
        return found

    def loads(self, stands: Sequence[Stand], of_links: Vector) -> Vector:
        """Give the generalised forces of weights and links on rotation and height of each body.

        A body that rests on a corner has none on its height: it follows from the rotation.
        """
        found = np.ravel(self.weights(stands)) + of_links
        for k, (standing, stand) in enumerate(zip(self.bodies, stands, strict=True)):
            if standing.corner:
                found[2 * k] -= standing.corner_lever(stand) * found[2 * k + 1]
                found[2 * k + 1] = 0.0
        return found

    def _at(self, path: Path | None) -> list[Stand] | None:
        """Give how the bodies stand where a path has come to; corners bear what is left."""
        if path is None:
            return None
        stands = self.stands_at(path.place)
        loads = np.ravel(self.weights(stands))
        for pull, one in zip(path.place.pulls, self.reached(stands), strict=True):
            loads -= pull @ one.way
        for k, (standing, one) in enumerate(zip(self.bodies, stands, strict=True)):
            if standing.corner:
                stands[k] = _on_corner(standing, one.state.rotation, -float(loads[2 * k + 1]))
        bears = all(one.press >= 0.0 for one in stands)
        return self._with_arms(stands) if bears else None

    def reached(self, stands: Sequence[Stand]) -> "list[Reached]":
        """Give where the points of what links the bodies are."""
        from rockframe.dynamics.tied import reached

        return reached(self.bodies, stands, self.ties)

    def tied(
        self, stands: Sequence[Stand], states: Sequence[int] | None = None,
        stretches: Sequence[float] | None = None,
    ) -> "list[Tied]":  # fmt: skip
        """Give how what links the bodies is stretched."""
        from rockframe.dynamics.tied import tied

        return tied(self.bodies, stands, self.ties, states, stretches)

    def tie_loads(self, stands: Sequence[Stand], states: Sequence[int] | None = None) -> Vector:
        """Give the generalised forces of links on rotation and height of each body."""
        found = np.zeros(2 * len(stands))
        for one in self.tied(stands, states):
            found += self.pull * one.loads
        return found

    def moments(self, stands: Sequence[Stand]) -> list[float]:
        """Give the generalised force on each body's rotation on its base."""
        weights = self.weights(stands)
        found = [stand.force.moment + of[0] for stand, of in zip(stands, weights, strict=True)]
        if self.ties:
            pulled = self.tie_loads(stands)[::2].tolist()
            found = [moment + more for moment, more in zip(found, pulled, strict=True)]
        return found

    def weights(self, stands: Sequence[Stand]) -> list[tuple[float, float]]:
        """Give the generalised forces of all weights on rotation and height of each body."""
        found = list[tuple[float, float]]()
        mass = side = height = 0.0  # of what stands on a body, and its moments about the centre
        frames = self.frames([stand.state.rotation for stand in stands])
        for standing, stand, (normal, along) in zip(self.bodies, stands, frames, strict=True):
            if mass > 0.0:  # from the axes of its deck to those of the one beneath
                sine, cosine = sine_cosine(stand.state.rotation)
                height += mass * standing.top
                side, height = side * cosine + height * sine, height * cosine - side * sine
            mass += standing.mass
            moment = normal * side - along * (height + mass * stand.reach.rate)
            found.append((moment, -mass * normal))
            side += mass * stand.across
            height += mass * (standing.part.body.height + stand.state.vertical)
        return found

    def rise(self, stands: Sequence[Stand]) -> float:
        """Give the rise of the highest centre of mass from where it is upright and at rest."""
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
        """Give how the bodies rest under their weight, :eq:`eq-tilted-rest`; None if they fall.

        Eccentricity and slope grow from zero, and rest is followed from upright: a chain that
        leans has a second equilibrium, farther out, from which it falls.
        """
        upright = self._under_weight([0.0] * len(self.bodies))
        if upright is None or self.upright:
            return upright
        return self._at(self._loaded(upright, []))

    def curve(self, rotations: Sequence[float]) -> list[list[Stand] | None]:
        """Give how the bodies stand while a couple holds the highest one at each of rotations.

        Followed from upright to either side; None from where the bases cannot carry it.
        """
        one, every = len(self.bodies) == 1, range(len(rotations))
        found = [self._alone_at(rotation) if one else None for rotation in rotations]
        # a link that is broken at one height of a body may hold it at another
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
        """Give where the curve begins: under all loads, the highest body upright."""
        upright = self._under_weight([0.0] * len(self.bodies))
        loaded = None if upright is None else self._loaded(upright, [len(self.bodies) * [1.0]])
        return None if loaded is None else Path(0.0, loaded.place)

    def held(self, path: Path, rotation: float) -> tuple[Path | None, list[Stand] | None]:
        """Give how the bodies stand at a rotation of the highest one, followed along a path."""
        highest = np.ones((1, len(self.bodies)))
        further = followed(lambda at: HeldBodies(self, highest, np.array([at])), path, rotation)
        return further, self._at(further)

    def _loaded(self, stands: Sequence[Stand], sums: Sequence[Sequence[float]]) -> Path | None:
        """Follow bodies as eccentricity, slope and links grow, with sums of rotations held."""
        rows = np.array(sums).reshape(-1, len(stands))
        start = Balance.of(self, stands)
        held = rows @ start.rotations
        return followed(
            lambda share: HeldBodies(self.with_share(share), rows, held), Path(0.0, start)
        )


def standing_body(
    part: OnBase, mass: float = 1.0, top: float = 0.0, beside: float = 0.0, own: Any = None
) -> StandingBody:
    """Give a body on its base, which without variables of its own is as before any run."""
    body, base = part
    if own is None:
        own = base.read(np.zeros(base.variables()), 0)
    rest = body.base_line_at(BodyState(0.0, 0.0, 0.0, 0.0, 0.0, 0.0))
    return StandingBody(part, mass, top, beside, base.level(True, rest, own), own)


def settled(standing: StandingBody, rotation: float, press: float) -> Stand:
    """Give how a body stands at a rotation on its base, which carries a force.

    The force of a base falls with the height of the body on it. The height at which the base
    carries the weight is a first guess, which a secant between bounds refines.
    """
    if standing.corner:
        return _on_corner(standing, rotation, press)
    body, base = standing.part
    own = standing.own if isinstance(standing.own, tuple) else np.array(standing.own)
    attitude = body.attitude(rotation)
    lift = body.left * attitude.sine, -body.right * attitude.sine
    height = base.resting_height(*lift, own) - attitude.rise
    noise = ROUNDING * (standing.settlement + abs(lift[0]) + abs(lift[1]) + abs(attitude.rise))
    hardness = press / standing.settlement
    low, high, before = -math.inf, math.inf, (math.nan, math.nan)
    tries = 0
    while True:
        state = BodyState(rotation, height, 0.0, 0.0, 0.0, 0.0)
        line = body.base_line(state, attitude)
        contact = base.starting(line, own)
        force = base.force(contact, line, own)
        excess = force.upward - press
        if (before[1] - excess) * (height - before[0]) > 0.0:
            hardness = (before[1] - excess) / (height - before[0])
        step, before = excess / hardness, (height, excess)
        tries += 1
        if abs(step) <= noise or tries == TRIES:
            break
        low, high = (height, high) if excess > 0.0 else (low, height)
        height += step
        halved = tries > SECANTS and tries % 2 == 0 and low > -math.inf and high < math.inf
        if halved or not low < height < high:
            height = 0.5 * (low + high)
    mode = standing.part.standing(contact, state)
    return Stand(state, mode, *standing.way(attitude, mode.pivot), line, force, press, own)


def lifted(standing: StandingBody, rotation: float, height: float) -> Stand:
    """Give how a body stands that links may have lifted off its base."""
    body, base = standing.part
    own = standing.own if isinstance(standing.own, tuple) else np.array(standing.own)
    state, attitude = BodyState(rotation, height, 0.0, 0.0, 0.0, 0.0), body.attitude(rotation)
    line = body.base_line(state, attitude)
    contact = base.starting(line, own)
    force, mode = base.force(contact, line, own), standing.part.standing(contact, state)
    return Stand(state, mode, *standing.way(attitude, mode.pivot), line, force, force.upward, own)


def _on_corner(standing: StandingBody, rotation: float, press: float) -> Stand:
    """Give how a body stands on a corner of a rigid base."""
    body, right = standing.part.body, standing.corner > 0
    attitude = body.attitude(rotation)
    level = attitude.rise + (-body.right if right else body.left) * attitude.sine
    state = BodyState(rotation, -level, 0.0, 0.0, 0.0, 0.0)
    line = body.base_line(state, attitude)
    force = BaseForce(press, press * (line.right_lever if right else line.left_lever), 0.0)
    contact = both_contacts(int(right), int(not right))
    mode = Mode(contact, PIVOT_RIGHT if right else PIVOT_LEFT, False)
    return Stand(state, mode, *standing.way(attitude, mode.pivot), line, force, press, standing.own)


def uplift_rotation(standing: StandingBody, press: float) -> float:
    """Give the least rotation to the right at which a base is no longer in full contact.

    NaN where it is up to a right angle.
    """
    body, base = standing.part

    def is_full(rotation: float) -> bool:
        contact = settled(standing, rotation, press).mode.contact
        return base.is_held(contact, True) and base.is_held(contact, False)

    most = math.inf if body.small else 0.5 * math.pi
    if not body.small and is_full(most):
        return math.nan
    # where the end has risen by the settlement, and on from there by secants
    guess = standing.allowed_rotation
    guess = guess if body.small else asin(min(guess, 1.0))
    last, left, slope = math.nan, math.nan, 1.0 / guess
    for _ in range(HALVINGS):
        stand = settled(standing, guess, press)
        # how much lower the higher end is than where it parts, over the settlement
        now = base.level(True, stand.line, stand.own) / standing.settlement
        if not abs(now) > ROUNDING or guess == last:
            break
        slope = (left - now) / (guess - last) if left > now or left < now else slope
        last, left = guess, now
        guess = min(max(guess + now / slope, 0.5 * guess), 2.0 * guess, most)
    low, high = (1.0 - SHARP) * guess, (1.0 + SHARP) * guess
    if is_full(low) and not is_full(min(high, most)):
        return guess
    low, high = 0.0, guess if body.small else most
    while is_full(high):
        high *= 2.0
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if is_full(middle) else (low, middle)
    return high
