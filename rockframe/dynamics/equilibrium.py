"""Equilibrium of bodies on one another by Newton's method, continued as loads or a rotation grow.

Unknowns are coordinates, forces of links and couples that hold rotations, :eq:`eq-static-steps`:
the force of a practically rigid link follows from the equilibrium of the bodies, not from its
elongation, which is lost in rounding.
"""

import math
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Final, NamedTuple

import numpy as np

from rockframe.compiled import Matrix, Vector
from rockframe.dynamics.chain.link_rows import ChainLink
from rockframe.dynamics.standing import PLACES, ROUNDING, STENCIL, STEP, Stand, of_base
from rockframe.dynamics.tied import Tied, force_at, is_broken

if TYPE_CHECKING:
    from rockframe.dynamics.statics import StandingChain

TRIES: Final = 40
"""Most steps of Newton's method."""
CLOSE: Final = 1e-12
"""Change of a coordinate in the last step, over the sum of its value and its size [1]."""
NEAR: Final = 0.05
"""Largest difference of a rotation from its prediction, and largest step of Newton's [rad]."""
LEAST_STEP: Final = 1e-3
"""Least step along the path, over its length, or over the size of what changes [1]."""
LEAST_SHARE: Final = 2.0**-30
"""Least share of a step's elongation that a link without stiffness so far takes [1]."""
ANSWERED: Final = 1e3
"""Last change of a link's force over the weight, allowed as a multiple of CLOSE [1]."""
FAR: Final = 1e9
"""Change of a coordinate over its size at which a step has failed [1]."""
RETURNS: Final = 0.25
"""Share of the last step that a step must undo for steps to be halved [1]."""
LEAST_DAMPED: Final = 2.0**-6
"""Least share of a step after halving [1]."""
SUDDEN: Final = 0.25
"""Largest change of force in a step of a link without stiffness so far, over the weight [1]."""
SECANT: Final = ((1.0, 0.5),)
"""Stencil of a first derivative of second order, which is enough for a step of Newton's."""


class HeldBodies(NamedTuple):
    """Bodies under their loads, and rotations that couples hold."""

    chain: "StandingChain"
    sums: Matrix  # weights of the rotations on bases in each rotation that is held
    rotations: Vector


class Balance(NamedTuple):
    """An equilibrium: rotations of bodies, from the top down, forces of bases and of links."""

    rotations: Vector
    heights: Vector  # used where a base carries nothing
    presses: Vector  # normal forces of bases
    stretches: Vector  # elongations of links at which their laws give their forces
    pulls: Matrix  # forces of links, to the right and up
    couples: Vector  # couples that hold rotations, against them

    @classmethod
    def of(cls, chain: "StandingChain", stands: Sequence[Stand], held: int = 1) -> "Balance":
        """Return forces and places of bodies as they stand, no couple yet on `held` rotations."""
        tied = chain.tied(stands)
        return cls(
            np.array([one.state.rotation for one in stands]),
            np.array([one.state.vertical for one in stands]),
            np.array([one.press for one in stands]),
            np.array([one.elongation for one in tied]),
            np.array([one.force * one.direction for one in tied]).reshape(-1, 2),
            np.zeros(held),
        )


class Path(NamedTuple):
    """An equilibrium on a path, and the one before it."""

    at: float
    place: Balance
    before: "tuple[float, Balance] | None" = None

    def foreseen(self, at: float) -> Balance:
        """Return the equilibrium further on by linear extrapolation."""
        if self.before is None:
            return self.place
        share = (at - self.at) / (self.at - self.before[0])
        pairs = zip(self.place, self.before[1], strict=True)
        return Balance(*(now + share * (now - before) for now, before in pairs))


def followed(
    held: Callable[[float], HeldBodies], path: Path, to: float = 1.0, size: float = math.inf
) -> Path | None:
    """Follow a stable equilibrium along a path; None where it ends.

    `size` is the length of the path within which, about, an end of a base lifts off.
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
        # with a link broken that in truth holds the bodies may be in equilibrium, too
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
    """Return a stable equilibrium near a guess, by Newton's steps.

    Heights follow from the forces of bases, so that a loss of contact within a step does no harm.
    """
    place, stands = guess, held.chain.stands_at(guess)
    damped, before = 1.0, np.zeros(2 * len(guess.rotations))
    for count in range(TRIES):
        now = _Step(held, stands, place)
        if not now.leads:
            return None
        if now.is_last and count == 0:
            return guess if now.is_stable() else None
        # alternating contacts or links would make the steps oscillate
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
    chain: "StandingChain", stands: Sequence[Stand],
    of_links: Callable[[Sequence[Stand]], Vector],
    stencil: Sequence[tuple[float, float]] = STENCIL,
) -> Matrix:  # fmt: skip
    """Return minus the derivatives of the generalised forces of weights and links."""
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


def of_bases(chain: "StandingChain", stands: Sequence[Stand], *, from_rest: bool = False) -> Matrix:
    """Return minus the derivatives of the generalised forces of bases, zero for rigid ones.

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
    """Return the greatest absolute value."""
    return float(np.abs(values).max())


class _Answer(NamedTuple):
    """A direction in which a link has stiffness, so that its force is an unknown."""

    link: int
    direction: Vector
    compliance: float
    lack: float  # difference of its force from that of its law, as an elongation


class _Step:
    """One step of Newton's method from a given place, :eq:`eq-static-steps`."""

    def __init__(self, held: HeldBodies, stands: Sequence[Stand], place: Balance) -> None:
        self.held, self.chain, self.stands, self.place = held, held.chain, stands, place
        self.coordinates = np.array([value for one in stands for value in one.state[:2]])
        self.sizes = held.chain.sizes
        self.tied = held.chain.tied(stands, stretches=place.stretches.tolist())
        self.pulls = place.pulls.copy()
        each = enumerate(self.tied)
        self.answers = [one for i, tied in each for one in self._answers_of(i, tied)]
        # derivatives of coordinates by the free ones, over the sizes of these
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
            forces = held.chain.weight * found[self.free.sum() :]
            self._link_moves(forces[: len(self.answers)].tolist())
            self.more_couple = self.sizes[1] / self.sizes[0] * forces[len(self.answers) :]

    def _link_moves(self, forces: Sequence[float]) -> None:
        """Set the changes of links in this step, and whether it is the last one."""
        allowed = CLOSE * (np.abs(self.coordinates) + self.sizes)
        # rotations are added: none is known better than the rounding of the greatest one
        known = ROUNDING * _greatest(self.coordinates[::2])
        allowed += known * self.sizes / np.repeat(self.sizes[::2], 2)
        self.is_last = bool((np.abs(self.move) <= allowed).all())
        self.more_pull = np.zeros_like(self.pulls)
        self.more_stretch = [
            float(one.direction @ one.way @ self.move) + one.elongation - stretch
            for one, stretch in zip(self.tied, self.place.stretches.tolist(), strict=True)
        ]
        for one, force in zip(self.answers, forces, strict=True):
            self.more_pull[one.link] += force * one.direction
        for i, (link, one) in enumerate(zip(self.chain.ties, self.tied, strict=True)):
            rounding = ANSWERED * CLOSE * self.chain.weight
            answers = _greatest(self.more_pull[i]) <= rounding
            if not one.meets:
                self.more_stretch[i], answers = self._stretched(link, one, i, rounding)
            self.is_last = self.is_last and answers

    def _stretched(
        self, link: ChainLink, tied: Tied, i: int, rounding: float
    ) -> tuple[float, bool]:
        """Return change of a link's elongation, and whether its force is then the predicted one.

        Where the link only begins to have stiffness the change is kept small.
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
        """Return the place after a share of the step."""
        there = self.coordinates + share * self.move
        presses = np.array([one.press for one in self.stands])
        presses -= share * (self.of_bases @ self.move)[1::2]
        stretches = self.place.stretches + share * np.array(self.more_stretch)
        pulls = self.pulls + share * self.more_pull
        couples = self.place.couples + share * self.more_couple
        return Balance(there[::2], there[1::2], presses, stretches, pulls, couples)

    def _answers_of(self, i: int, tied: Tied) -> list[_Answer]:
        """Return directions in which a link has stiffness; in others its law gives its force."""
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
        if force > 0.0:  # a taut link also has stiffness across
            across = np.array([-along[1], along[0]])
            beside, compliance = float(pull @ across), math.hypot(*tied.moved) / force
            self.pulls[i] += beside * across
            found.append(_Answer(i, across, compliance, -beside * compliance))
        return found

    def _loads(self, stands: Sequence[Stand]) -> Vector:
        """Return the generalised forces of links, of fixed sizes, as bodies move."""
        found = np.zeros(2 * len(stands))
        points = self.chain.reached(stands)
        for pull, here, there in zip(self.pulls, self.tied, points, strict=True):
            kept = pull
            if here.direction.any() and not here.meets:
                kept = (pull @ here.direction) * there.direction
            found -= kept @ there.way
        return found

    def _equations(self) -> tuple[Matrix, Vector]:
        """Return matrix and right-hand side of the equations, symmetrical and non-dimensional."""
        chain, weight, free, sizes = self.chain, self.chain.weight, self.free, self.sizes
        energy = weight * sizes[1]
        forces = chain.loads(self.stands, self._loads(self.stands))
        for k, (standing, one) in enumerate(zip(chain.bodies, self.stands, strict=True)):
            if not standing.corner:
                forces[2 * k : 2 * k + 2] += one.force.moment, one.force.upward
        forces[::2] -= self.place.couples @ self.held.sums
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
        """Whether the equilibrium is stable: as many positive eigenvalues as free coordinates."""
        return bool((np.linalg.eigvalsh(self.matrix) > 0.0).sum() == self.free.sum())
