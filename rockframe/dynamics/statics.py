"""Bodies on one another at rest and held: the forces are those of their equations of motion.

Each body stands on the deck of the one beneath it. Given how each is rotated on its base, what
stands above a base gives the force that it carries, its law the height at which it does, and
what is left are moments, :eq:`eq-static-chain`. All is per unit mass.
"""

import math
import sys
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, Final, NamedTuple

import numpy as np

from rockframe.compiled import Vector
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
from rockframe.dynamics.following import Path, Sizes, followed
from rockframe.dynamics.on_base import Mode, OnBase
from rockframe.dynamics.trigonometry import sine_cosine, versine
from rockframe.many import asin, sqrt

if TYPE_CHECKING:
    from rockframe.dynamics.chain.link_rows import ChainLink
    from rockframe.dynamics.tied import Tied

ROUNDING: Final = 4.0 * sys.float_info.epsilon
"""Share of the sizes of heights that is rounding."""
TRIES: Final = 100
"""Heights that are tried at most."""
BALANCED: Final = 1e-9
"""Moments that are rounding, over that of the weight about the middle of the base."""
SHARP: Final = 1e-9
"""Share of the uplift angle by which contact is full before it and partial beyond."""
LEAST_SHARE: Final = 2.0**-20
"""Of a step of Newton's, below which it leads no further."""
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

    links: tuple[StandingBody, ...]
    along_gravity: float = 0.0
    ties: "tuple[ChainLink, ...]" = ()
    pull: float = 1.0

    @property
    def upright(self) -> bool:
        """Whether nothing turns the bodies from where they stand upright."""
        level = self.along_gravity == 0.0 and not self.ties
        return level and all(link.beside == 0.0 for link in self.links)

    def with_share(self, share: float) -> "StandingChain":
        """Give the chain with a share of its slope and of the eccentricity of its bodies."""
        if share == 1.0:
            return self
        links = tuple(link.with_share(share) for link in self.links)
        return StandingChain(links, share * self.along_gravity, self.ties, share * self.pull)

    def frames(self, rotations: Sequence[float]) -> list[tuple[float, float]]:
        """Give gravity normal to the deck under each body, and along it."""
        normal, along = self.links[0].part.body.gravity, self.along_gravity
        turned, found = 0.0, [(normal, along)]
        for rotation in reversed(rotations[1:]):
            turned += rotation
            sine, cosine = sine_cosine(turned)
            found.append((normal * cosine + along * sine, along * cosine - normal * sine))
        return found[::-1]

    def settled(self, rotations: Sequence[float]) -> list[Stand] | None:
        """Give how the bodies stand at rotations on their bases; None where one would pull."""
        mass, presses = 0.0, list[float]()
        for link, (normal, _) in zip(self.links, self.frames(rotations), strict=True):
            mass += link.mass
            presses.append(mass * normal)
        if not self.ties:
            return self._pressed(rotations, presses)
        return self._balanced(rotations, np.array(presses))

    def _pressed(self, rotations: Sequence[float], presses: Sequence[float]) -> list[Stand] | None:
        """Give how the bodies stand on bases that carry some forces."""
        if not all(press > 0.0 for press in presses):
            return None
        stands = [
            settled(link, rotation, press)
            for link, rotation, press in zip(self.links, rotations, presses, strict=True)
        ]
        if not self.ties:
            return stands
        decks = [*(link.top for link in self.links[1:]), 0.0]
        return [
            one._replace(arm=deck + link.part.body.height + one.state.vertical)
            for link, one, deck in zip(self.links, stands, decks, strict=True)
        ]

    def _balanced(self, rotations: Sequence[float], weights: Vector) -> list[Stand] | None:
        """Give how the bodies stand on bases that carry weights and what links pull down."""

        def lack(presses: Vector) -> tuple[list[Stand] | None, Vector]:
            stands = self._pressed(rotations, presses.tolist())
            if stands is None:
                return None, np.full(len(presses), math.nan)
            return stands, weights - self.tie_loads(stands)[1::2] - presses

        presses = weights
        stands, missing = lack(presses)
        least = 0.1 * BALANCED * weights[-1]
        for _ in range(TRIES):
            if stands is None:
                return None
            if np.abs(missing).max() <= ROUNDING * weights[-1]:
                break
            step = 1e-6 * weights[-1]
            slopes = np.array([
                (lack(presses + move)[1] - lack(presses - move)[1]) / (2.0 * step)
                for move in step * np.eye(len(presses))
            ]).T  # fmt: skip
            if not np.isfinite(slopes).all():
                return None
            move, share = np.linalg.solve(slopes, -missing), 1.0
            further = lack(presses + move)
            while share > LEAST_SHARE and not (np.abs(further[1]).max() < np.abs(missing).max()):
                share *= 0.5
                further = lack(presses + share * move)
            if share <= LEAST_SHARE:
                break
            presses = presses + share * move
            stands, missing = further
        return stands if np.abs(missing).max() <= least else None

    def tied(self, stands: Sequence[Stand], states: Sequence[int] | None = None) -> "list[Tied]":
        """Give how what links the bodies is stretched."""
        from rockframe.dynamics.tied import tied

        return tied(self.links, stands, self.ties, states)

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
        for link, stand, (normal, along) in zip(self.links, stands, frames, strict=True):
            if mass > 0.0:  # from the axes of its deck to those of the one beneath
                sine, cosine = sine_cosine(stand.state.rotation)
                height += mass * link.top
                side, height = side * cosine + height * sine, height * cosine - side * sine
            mass += link.mass
            moment = normal * side - along * (height + mass * stand.reach.rate)
            found.append((moment, -mass * normal))
            side += mass * stand.across
            height += mass * (link.part.body.height + stand.state.vertical)
        return found

    def rise(self, stands: Sequence[Stand]) -> float:
        """Give the rise of the highest centre of mass from where it is upright and at rest."""
        found = turned = top = 0.0
        for link, stand in zip(self.links[::-1], stands[::-1], strict=True):
            sine, cosine = sine_cosine(turned)
            if turned != 0.0:
                found -= stand.across * sine + (top + link.part.body.height) * versine(sine, cosine)
            found += stand.state.vertical * cosine
            turned, top = turned + stand.state.rotation, link.top
        return found

    def rest(self) -> list[Stand] | None:
        """Give how the bodies rest under their weight, :eq:`eq-tilted-rest`; None if they fall.

        Eccentricity and slope grow from zero, and rest is followed from upright: a chain that
        leans has a second equilibrium, farther out, from which it falls.
        """
        if self.upright:
            return self.settled([0.0] * len(self.links))
        found = followed(self._turning, self._sizes(self.links), Path.origin(len(self.links)))
        return None if found is None else self.settled(found.place.tolist())

    def curve(self, rotations: Sequence[float]) -> list[list[Stand] | None]:
        """Give how the bodies stand while a couple holds the highest one at each of rotations.

        Followed from upright to either side; None from where the bases cannot carry it.
        """
        lower = self.links[1:]
        if not lower:
            return [self.settled([rotation]) for rotation in rotations]
        found: list[list[Stand] | None] = [None] * len(rotations)
        sizes, start = self._sizes(lower), Path.origin(len(lower))
        if not self.upright:
            loaded = followed(lambda share, others: self._lack(share, 0.0, others), sizes, start)
            if loaded is None:
                return found
            start = start._replace(place=loaded.place)
        for side in (1.0, -1.0):
            path: Path | None = start
            here = [i for i, each in enumerate(rotations) if math.copysign(1.0, each) == side]
            for i in sorted(here, key=lambda i: abs(rotations[i])):
                path, found[i] = self.held(path, rotations[i])
                if path is None:
                    break
        return found

    def held(self, path: Path, rotation: float) -> tuple[Path | None, list[Stand] | None]:
        """Give how the bodies stand at a rotation of the highest one, followed along a path."""
        sizes = self._sizes(self.links[1:])
        further = followed(lambda at, others: self._lack(1.0, at, others), sizes, path, rotation)
        if further is None:
            return None, None
        others = further.place.tolist()
        return further, self.settled([rotation - sum(others), *others])

    def _turning(self, share: float, rotations: Sequence[float]) -> list[float] | None:
        """Give the moments under a share of what makes the bodies lean."""
        chain = self.with_share(share)
        stands = chain.settled(rotations)
        return None if stands is None else chain.moments(stands)

    def _lack(self, share: float, rotation: float, lower: Sequence[float]) -> list[float] | None:
        """Give the moments on the lower bodies, less that of the couple that holds the highest."""
        found = self._turning(share, [rotation - sum(lower), *lower])
        return None if found is None else [moment - found[0] for moment in found[1:]]

    def _sizes(self, links: Sequence[StandingBody]) -> Sizes:
        body, mass = links[-1].part.body, sum(link.mass for link in self.links)
        rounding = BALANCED * body.gravity * mass * body.size()
        return Sizes(np.array([link.allowed_rotation for link in links]), rounding)


def link_of(
    part: OnBase, mass: float = 1.0, top: float = 0.0, beside: float = 0.0, own: Any = None
) -> StandingBody:
    """Give a body on its base; the arguments are those of a link.

    Without variables of its own the base is as before any run.
    """
    body, base = part
    if own is None:
        own = base.read(np.zeros(base.variables()), 0)
    rest = body.base_line_at(BodyState(0.0, 0.0, 0.0, 0.0, 0.0, 0.0))
    return StandingBody(part, mass, top, beside, base.level(True, rest, own), own)


def settled(link: StandingBody, rotation: float, press: float) -> Stand:
    """Give how a body stands at a rotation on its base, which carries a force.

    The force of a base falls with the height of the body on it. The height at which the base
    carries the weight is a first guess, which a secant between bounds refines.
    """
    if link.corner:
        return _on_corner(link, rotation, press)
    body, base = link.part
    own = link.own if isinstance(link.own, tuple) else np.array(link.own)
    attitude = body.attitude(rotation)
    lift = body.left * attitude.sine, -body.right * attitude.sine
    height = base.resting_height(*lift, own) - attitude.rise
    noise = ROUNDING * (link.settlement + abs(lift[0]) + abs(lift[1]) + abs(attitude.rise))
    hardness = press / link.settlement
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
        if not low < height < high:
            height = 0.5 * (low + high)
    mode = link.part.standing(contact, state)
    return Stand(state, mode, *link.way(attitude, mode.pivot), line, force, press, own)


def _on_corner(link: StandingBody, rotation: float, press: float) -> Stand:
    """Give how a body stands on a corner of a rigid base."""
    body, right = link.part.body, link.corner > 0
    attitude = body.attitude(rotation)
    level = attitude.rise + (-body.right if right else body.left) * attitude.sine
    state = BodyState(rotation, -level, 0.0, 0.0, 0.0, 0.0)
    line = body.base_line(state, attitude)
    force = BaseForce(press, press * (line.right_lever if right else line.left_lever), 0.0)
    contact = both_contacts(int(right), int(not right))
    mode = Mode(contact, PIVOT_RIGHT if right else PIVOT_LEFT, False)
    return Stand(state, mode, *link.way(attitude, mode.pivot), line, force, press, link.own)


def uplift_rotation(link: StandingBody, press: float) -> float:
    """Give the least rotation to the right at which a base is no longer in full contact.

    NaN where it is up to a right angle.
    """
    body, base = link.part

    def is_full(rotation: float) -> bool:
        contact = settled(link, rotation, press).mode.contact
        return base.is_held(contact, True) and base.is_held(contact, False)

    most = math.inf if body.small else 0.5 * math.pi
    if not body.small and is_full(most):
        return math.nan
    # where the end has risen by the settlement, and on from there by secants
    guess = link.allowed_rotation
    guess = guess if body.small else asin(min(guess, 1.0))
    last, left, slope = math.nan, math.nan, 1.0 / guess
    for _ in range(HALVINGS):
        stand = settled(link, guess, press)
        # how much lower the higher end is than where it parts, over the settlement
        now = base.level(True, stand.line, stand.own) / link.settlement
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


STEP: Final = 1e-3
"""By which coordinates are moved, over the settlement and over the rotation that it allows;
rates, over these times the rate of a vibration that settles as much."""
STENCIL: Final = ((1.0, 2.0 / 3.0), (2.0, -1.0 / 12.0))
"""Steps to both sides, and weights of a first derivative that is exact to the fourth order."""
PLACES: Final = ("rotation", "vertical")
RATES: Final = ("angular_velocity", "vertical_velocity")


def of_base(link: StandingBody, stand: Stand, name: str) -> tuple[float, float]:
    """Give minus the change of a base's moment and force with a coordinate or rate of its body."""
    body, base = link.part
    step = step_of(link, name)
    moment = upward = 0.0
    for place, weight in STENCIL:
        before, behind = (
            base.force(stand.mode.contact, body.base_line_at(moved_by(stand, name, by)), stand.own)
            for by in (place * step, -place * step)
        )
        moment -= weight / step * (before.moment - behind.moment)
        upward -= weight / step * (before.upward - behind.upward)
    return moment, upward


def step_of(link: StandingBody, name: str) -> float:
    """Give by how much a coordinate or rate is moved to see what the base answers."""
    size = link.allowed_rotation if name in (PLACES[0], RATES[0]) else link.settlement
    rate = sqrt(link.part.body.gravity / link.settlement) if name in RATES else 1.0
    return STEP * size * rate


def moved_by(stand: Stand, name: str, by: float) -> BodyState:
    """Give a state with another coordinate or rate."""
    return stand.state._replace(**{name: getattr(stand.state, name) + by})
