"""Equilibrium of bodies on one another: Newton's steps, followed while loads or a rotation grow.

Unknown are coordinates, forces of links and couples that hold rotations, :eq:`eq-static-steps`:
the force of a link that is as good as rigid comes from the balance of the bodies, and not from an
elongation that is lost in rounding.
"""

import math
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Final, NamedTuple

import numpy as np

from rockframe.compiled import Matrix, Vector
from rockframe.dynamics.standing import PLACES, ROUNDING, STENCIL, STEP, of_base
from rockframe.dynamics.tied import force_at, is_broken

if TYPE_CHECKING:
    from rockframe.dynamics.chain.link_rows import ChainLink
    from rockframe.dynamics.standing import Stand
    from rockframe.dynamics.statics import StandingChain
    from rockframe.dynamics.tied import Tied

TRIES: Final = 40
"""Newton's steps after which an equilibrium is not found."""
CLOSE: Final = 1e-12
"""Last change of a coordinate, over itself and its size."""
NEAR: Final = 0.05
"""Change of a rotation from what is foreseen, and by Newton's steps, that is too large [rad]."""
LEAST_STEP: Final = 1e-3
"""Least share of the path, or of the size of what changes, by which equilibrium is followed."""
LEAST_SHARE: Final = 2.0**-30
"""Of the stretch within a step of a link that has not answered."""
ANSWERED: Final = 1e3
"""Last change of a link's force over the weight, over that of coordinates over their sizes."""
FAR: Final = 1e9
"""Of its size, a coordinate's change that leads nowhere."""
RETURNS: Final = 0.25
"""Share of the step before that a step takes back, from which on steps are halved."""
LEAST_DAMPED: Final = 2.0**-6
"""Share of a step to which they are halved."""
SUDDEN: Final = 0.25
"""Change of a force within a step that is too large where a link has not answered, over weight."""
SECANT: Final = ((1.0, 0.5),)
"""Likewise to the second order, which is as good for a step of Newton's."""


class HeldBodies(NamedTuple):
    """Bodies under their loads, and rotations that couples hold."""

    chain: "StandingChain"
    sums: Matrix  # which rotations on bases each of those is the sum of
    rotations: Vector


class Balance(NamedTuple):
    """Rotations of bodies, from the top down, what their bases carry and how links answer."""

    rotations: Vector
    heights: Vector  # where a base carries nothing
    presses: Vector
    stretches: Vector  # of links, at which their laws give their forces
    pulls: Matrix  # to the right and up

    @classmethod
    def of(cls, chain: "StandingChain", stands: "Sequence[Stand]") -> "Balance":
        """Give that of bodies where they stand."""
        tied = chain.tied(stands)
        return cls(
            np.array([one.state.rotation for one in stands]),
            np.array([one.state.vertical for one in stands]),
            np.array([one.press for one in stands]),
            np.array([one.elongation for one in tied]),
            np.array([one.force * one.direction for one in tied]).reshape(-1, 2),
        )


class Path(NamedTuple):
    """An equilibrium on a path, and the one before it."""

    at: float
    place: Balance
    before: "tuple[float, Balance] | None" = None

    def foreseen(self, at: float) -> Balance:
        """Give the equilibrium further on as if the path were straight."""
        if self.before is None:
            return self.place
        share = (at - self.at) / (self.at - self.before[0])
        pairs = zip(self.place, self.before[1], strict=True)
        return Balance(*(now + share * (now - before) for now, before in pairs))


def followed(
    held: Callable[[float], HeldBodies], path: Path, to: float = 1.0, size: float = math.inf
) -> Path | None:
    """Follow a stable equilibrium along a path; None where it ends.

    Ends of bases part within about a `size` of the path.
    """
    step = way = to - path.at
    least_to_break = LEAST_STEP * abs(way)
    least = min(least_to_break, LEAST_STEP * size)
    while path.at != to:
        ahead = to if abs(to - path.at) <= abs(step) else path.at + step
        bodies, guess = held(ahead), path.foreseen(ahead)
        found = balanced(bodies, guess)
        if found is not None and _greatest(found.rotations - guess.rotations) > NEAR:
            found = None
        # without a link that would have held the bodies may be in balance, too
        breaks = found is not None and _breaks(bodies.chain, path.place, found)
        if found is None or (breaks and abs(step) >= least_to_break):
            if abs(step) < least:
                return None
            step *= 0.5
        elif breaks:
            path, step = Path(ahead, found), to - ahead
        else:
            path, step = Path(ahead, found, (path.at, path.place)), 2.0 * step
    return path


def balanced(held: HeldBodies, guess: Balance) -> Balance | None:
    """Give a stable equilibrium near a guess, by Newton's steps.

    Heights follow from what bases carry: contact that ends within a step leads no step astray.
    """
    place, stands = guess, held.chain.stands_at(guess)
    damped, before = 1.0, np.zeros(2 * len(guess.rotations))
    for count in range(TRIES):
        now = _Step(held, stands, place)
        if not now.leads:
            return None
        if now.is_last and count == 0:
            return guess if now.is_stable() else None
        # contacts or links that take turns would lead to and fro
        returns = now.move @ before < -RETURNS * (before @ before)
        damped = max(0.5 * damped, LEAST_DAMPED) if returns else min(1.0, 2.0 * damped)
        before = now.move
        share = min(damped, NEAR / max(_greatest(now.move[::2]), NEAR))
        place = now.ahead(share)
        if share == 1.0 and now.is_last:
            return place if now.is_stable() else None
        stands = held.chain.stands_at(place)
    return None


def of_loads(
    chain: "StandingChain", stands: "Sequence[Stand]",
    of_links: "Callable[[Sequence[Stand]], Vector]",
    stencil: Sequence[tuple[float, float]] = STENCIL,
) -> Matrix:  # fmt: skip
    """Give minus the changes of what weights and links do, with coordinates."""
    found = np.zeros((2 * len(stands), 2 * len(stands)))
    for at, size in enumerate(chain.sizes):
        step = STEP * size
        for place, weight in stencil:
            before, behind = (
                chain.loads(others, of_links(others))
                for others in (chain.moved(stands, at, by) for by in (-place * step, place * step))
            )
            found[:, at] += weight / step * (before - behind)
    return found


def of_bases(
    chain: "StandingChain", stands: "Sequence[Stand]", *, from_rest: bool = False
) -> Matrix:
    """Give minus the changes of what bases do with coordinates; of rigid ones there are none.

    With loads that grow `from_rest`, variables of a base's own follow them.
    """
    found = np.zeros((2 * len(stands), 2 * len(stands)))
    for k, (standing, stand) in enumerate(zip(chain.bodies, stands, strict=True)):
        if not standing.corner:
            own = slice(2 * k, 2 * k + 2)
            ways = [of_base(standing, stand, name, from_rest=from_rest) for name in PLACES]
            found[own, own] = np.array(ways).T
    return found


def _breaks(chain: "StandingChain", before: Balance, after: Balance) -> bool:
    """Whether a link breaks between two equilibria."""
    stretches = zip(chain.ties, before.stretches.tolist(), after.stretches.tolist(), strict=True)
    return any(is_broken(one, now) and not is_broken(one, was) for one, was, now in stretches)


def _greatest(values: Vector) -> float:
    """Give the greatest size."""
    return float(np.abs(values).max())


class _Answer(NamedTuple):
    """A direction in which a link answers to how its point moves; its force is unknown."""

    link: int
    direction: Vector
    compliance: float
    lack: float  # of its force to that of its law, as an elongation


class _Step:
    """A step of Newton's from where bodies stand, :eq:`eq-static-steps`."""

    def __init__(self, held: HeldBodies, stands: "Sequence[Stand]", place: Balance) -> None:
        self.held, self.chain, self.stands, self.place = held, held.chain, stands, place
        self.coordinates = np.array([value for one in stands for value in one.state[:2]])
        self.sizes = held.chain.sizes
        self.tied = held.chain.tied(stands, stretches=place.stretches.tolist())
        self.pulls = place.pulls.copy()
        each = enumerate(self.tied)
        self.answers = [one for i, tied in each for one in self._answers_of(i, tied)]
        # how coordinates go with those that are free, over the sizes of these
        self.following = held.chain.following(stands) * self.sizes
        self.free = self.following.any(axis=0)
        self.following = self.following[:, self.free]
        self.of_bases = of_bases(held.chain, stands, from_rest=True)
        self.matrix, lacks = self._equations()
        try:
            found = np.linalg.solve(self.matrix, lacks)
        except np.linalg.LinAlgError:
            found = np.full(len(lacks), math.nan)
        self.leads = bool((np.abs(found) < FAR).all())
        if self.leads:
            self.move = self.following @ found[: self.free.sum()]
            self._link_moves((held.chain.weight * found[self.free.sum() :]).tolist())

    def _link_moves(self, forces: Sequence[float]) -> None:
        """Tell how links go on, and whether nothing is left to be found."""
        allowed = CLOSE * (np.abs(self.coordinates) + self.sizes)
        # no rotation is known closer than the greatest one with which it has a sum
        known = ROUNDING * _greatest(self.coordinates[::2])
        allowed += known * self.sizes / np.repeat(self.sizes[::2], 2)
        self.is_last = bool((np.abs(self.move) <= allowed).all())
        self.more_pull = np.zeros_like(self.pulls)
        self.more_stretch = [
            float(one.direction @ one.way @ self.move) + one.elongation - stretch
            for one, stretch in zip(self.tied, self.place.stretches.tolist(), strict=True)
        ]
        for one, force in zip(self.answers, forces, strict=False):
            self.more_pull[one.link] += force * one.direction
        for i, (link, one) in enumerate(zip(self.chain.ties, self.tied, strict=True)):
            rounding = ANSWERED * CLOSE * self.chain.weight
            answers = _greatest(self.more_pull[i]) <= rounding
            if not one.meets:
                self.more_stretch[i], answers = self._stretched(link, one, i, rounding)
            self.is_last = self.is_last and answers

    def _stretched(
        self, link: "ChainLink", tied: "Tied", i: int, rounding: float
    ) -> tuple[float, bool]:
        """Give how a link's stretch goes on, and whether its force is then the one foreseen.

        Where it begins to answer it goes on by a little at first.
        """
        share, stretch, more = 1.0, float(self.place.stretches[i]), self.more_stretch[i]

        def surprise(more: float) -> float:
            foreseen = tied.force + tied.stiffness * more
            return self.chain.pull * abs(force_at(link, stretch + more) - foreseen)

        rounding += CLOSE * self.chain.pull * tied.stiffness * abs(stretch)
        as_foreseen = surprise(more) <= rounding
        while tied.stiffness <= 0.0 and share > LEAST_SHARE:
            if surprise(share * more) <= SUDDEN * self.chain.weight:
                break
            share *= 0.5
        return share * more, as_foreseen

    def ahead(self, share: float) -> Balance:
        """Give where a share of the step leads."""
        there = self.coordinates + share * self.move
        presses = np.array([one.press for one in self.stands])
        presses -= share * (self.of_bases @ self.move)[1::2]
        stretches = self.place.stretches + share * np.array(self.more_stretch)
        pulls = self.pulls + share * self.more_pull
        return Balance(there[::2], there[1::2], presses, stretches, pulls)

    def _answers_of(self, i: int, tied: "Tied") -> list[_Answer]:
        """Give the directions in which a link answers; else its force is that of its law."""
        force, hardness = self.chain.pull * tied.force, self.chain.pull * tied.stiffness
        along, pull = tied.direction, self.pulls[i].copy()
        self.pulls[i] = force * along
        if not tied.meets:
            lack = tied.elongation - float(self.place.stretches[i])
            return [_Answer(i, along, 1.0 / hardness, lack)] if hardness > 0.0 else []
        if not along.any():  # points that meet without force may part in any direction
            directions = np.eye(2) if hardness > 0.0 else ()
            return [_Answer(i, one, 1.0 / hardness, 0.0) for one in directions]
        found = list[_Answer]()
        if hardness > 0.0:
            tension = float(pull @ along)
            self.pulls[i] = tension * along
            found.append(_Answer(i, along, 1.0 / hardness, (force - tension) / hardness))
        if force > 0.0:  # the direction answers, too
            across = np.array([-along[1], along[0]])
            beside, compliance = float(pull @ across), math.hypot(*tied.moved) / force
            self.pulls[i] += beside * across
            found.append(_Answer(i, across, compliance, -beside * compliance))
        return found

    def _loads(self, stands: "Sequence[Stand]") -> Vector:
        """Give the generalised forces of links that keep their force, as bodies move."""
        found = np.zeros(2 * len(stands))
        points = self.chain.reached(stands)
        for pull, here, there in zip(self.pulls, self.tied, points, strict=True):
            kept = pull
            if here.direction.any() and not here.meets:
                kept = (pull @ here.direction) * there.direction
            found -= kept @ there.way
        return found

    def _equations(self) -> tuple[Matrix, Vector]:
        """Give the equations, symmetrical and over the sizes of what is in them."""
        chain, weight, free, sizes = self.chain, self.chain.weight, self.free, self.sizes
        energy = weight * sizes[1]
        forces = chain.loads(self.stands, self._loads(self.stands))
        for k, (standing, one) in enumerate(zip(chain.bodies, self.stands, strict=True)):
            if not standing.corner:
                forces[2 * k : 2 * k + 2] += one.force.moment, one.force.upward
        inner = self.of_bases + of_loads(chain, self.stands, self._loads, SECANT)
        inner *= sizes * sizes[:, None] / energy
        ways = [weight / energy * one.direction @ self.tied[one.link].way for one in self.answers]
        sums = np.zeros((len(self.held.sums), len(sizes)))
        sums[:, ::2] = self.held.sums / sizes[0]
        tight = np.array([*ways, *sums]).reshape(-1, len(sizes)) @ self.following
        soft = [-one.compliance * weight**2 / energy for one in self.answers]
        matrix = np.block(
            [
                [inner[np.ix_(free, free)], tight.T],
                [tight, np.diag([*soft, *np.zeros(len(sums))])],
            ]
        )
        off = self.held.rotations / sizes[0] - sums @ self.coordinates
        lacks = [-one.lack * weight / energy for one in self.answers]
        return matrix, np.array([*(sizes * forces / energy)[free], *lacks, *off])

    def is_stable(self) -> bool:
        """Whether bodies come back: as many positive eigenvalues as free coordinates."""
        return bool((np.linalg.eigvalsh(self.matrix) > 0.0).sum() == self.free.sum())
