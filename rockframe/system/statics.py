"""Bodies on bases that give way: at rest, held at rotations, and in small motion."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TYPE_CHECKING, Final

import numpy as np

from rockframe.dynamics.statics import Stand, StandingChain
from rockframe.errors import SolverError

if TYPE_CHECKING:
    from rockframe.dynamics.base_numbers import BaseNumbers
    from rockframe.signals.arrays import Array
    from rockframe.system.setting import Setting


LEAST: Final = 2.0**-20
"""Rotation, over that which the settlement allows, below which moments are linear in it: of the
difference of the ends' forces, rounding leaves too little."""
SMALL: Final = 2.0**-6
"""Rotation, likewise, at which their slope is found."""


@dataclass(frozen=True)
class Statics:
    """A body held at a rotation, in SI units.

    Parameters
    ----------
    vertical_displacement : float
        Of the centre of mass from rest.
    base_moment : float
        Of the lowest base's vertical reactions about the middle of the base, against the
        rotation.
    restoring_moment : float
        Couple that holds the body at the rotation: the base moment less the weight's
        moment about the middle of the base.
    contact_state : str
        Name of the contact state.
    reactions : dict of str to float
        Forces and lengths of the bases by their names in the results' schema.
    """

    vertical_displacement: float
    base_moment: float
    restoring_moment: float
    contact_state: str
    reactions: dict[str, float] = field(default_factory=dict[str, float])


def required_states(rotations: Sequence[float], states: Sequence[Statics | None]) -> list[Statics]:
    """Give states at rotations, of which there must be one at each."""
    found = list[Statics]()
    for rotation, state in zip(rotations, states, strict=True):
        if state is None:
            msg = (
                "no equilibrium was found with the highest body held at "
                f"{rotation:.6g} rad: what it stands on cannot carry the moment"
            )
            raise SolverError(msg)
        found.append(state)
    return found


@dataclass(frozen=True)
class StandingBodies:
    """Bodies that stand on one another, in SI units."""

    chain: StandingChain  # the bodies on their bases, as the equations take them
    mass: float  # that the chain is measured by, that of its highest body [kg]
    bases: "tuple[BaseNumbers, ...]"  # under each body, from the top down

    @cached_property
    def rest(self) -> list[Stand] | None:
        """How the bodies rest under their weight; None if they fall by it."""
        return self.chain.rest()

    @cached_property
    def upright(self) -> list[Stand]:
        """How they stand while all are held upright."""
        return self.chain.settled([0.0] * len(self.bases)) or []

    def held(self, rotations: Sequence[float]) -> list[Statics | None]:
        """Give the states with the highest body held at rotations; None where there is none."""
        curve = self.chain.curve(rotations)
        found = [None if stands is None else self.statics_of(stands) for stands in curve]
        least = LEAST * self.chain.links[0].allowed_rotation if self.chain.upright else 0.0
        for i, (rotation, state) in enumerate(zip(rotations, found, strict=True)):
            if state is not None and abs(rotation) < least:
                found[i] = self._near_upright(rotation, state)
        return found

    def _near_upright(self, rotation: float, state: Statics) -> Statics:
        """Give a state with moments to all digits, by their slope, exact to the fourth order."""
        step = SMALL * self.chain.links[0].allowed_rotation
        near, far = required_states((step, 2.0 * step), self.held((step, 2.0 * step)))
        share = rotation / (6.0 * step)
        return replace(
            state,
            base_moment=share * (8.0 * near.base_moment - far.base_moment),
            restoring_moment=share * (8.0 * near.restoring_moment - far.restoring_moment),
        )

    def statics_of(self, stands: list[Stand]) -> Statics:
        """Give the moments by which bodies stand so, and what their bases show."""
        (part, *_), lowest = self.chain.links[0], stands[-1]
        body = self.chain.links[-1].part.body
        attitude = body.attitude(lowest.state.rotation)
        arm = body.height * attitude.sine + 0.5 * (body.left - body.right) * attitude.cosine
        held = [part.base.is_held(stands[0].mode.contact, left) for left in (True, False)]
        return Statics(
            vertical_displacement=self.chain.rise(stands),
            base_moment=self.mass * (lowest.press * arm - lowest.force.moment),
            restoring_moment=-self.mass * self.chain.moments(stands)[0],
            contact_state="full" if all(held) else "left" if held[0] else "right",
            reactions=self.reactions(stands),
        )

    def reactions(self, stands: list[Stand]) -> dict[str, float]:
        """Give what the bases show, by the names of the schema."""
        found = dict[str, float]()
        for link, stand, numbers in zip(self.chain.links, stands, self.bases, strict=True):
            if link.corner:
                continue
            base = link.part.base
            shown = base.observed(stand.mode.contact, stand.line, stand.own)
            for column, value in zip(numbers.columns, shown, strict=True):
                found[column.name] = (self.mass if column.per_mass else 1.0) * value
        if len(stands) > 1:
            found["cap_rotation"] = stands[-1].state.rotation
        return found

    def small_motion(self, stands: list[Stand]) -> "tuple[Array, Array, Array]":
        """Give mass, damping and stiffness about rest, by rotation and height of each body."""
        from rockframe.dynamics.linear import linear

        mass, damping, stiffness = linear(self.chain, stands)
        return self.mass * mass, self.mass * damping, self.mass * stiffness


_POINTS, _WEIGHTS = np.polynomial.legendre.leggauss(12)
_PLACES: Final[list[tuple[float, float]]] = [
    (0.5 + 0.5 * float(point), 0.5 * float(weight))
    for point, weight in zip(_POINTS, _WEIGHTS, strict=True)
]
"""Gauss-Legendre rule on (0, 1)."""


def stored_energy(setting: "Setting", rotation: float) -> float:
    """Give the work that slowly brings a body from upright to a rotation [rad] [J]."""
    found = _restoring(setting, [at * rotation for at, _ in _PLACES])
    return rotation * sum(of * one for (_, of), one in zip(_PLACES, found, strict=True))


def least_overturning_energy(setting: "Setting") -> float:
    """Give the work against the restoring moment up to where that ends, on the weaker side [J]."""
    ends = setting.overturning_rotations
    return min(work_against(lambda some: _restoring(setting, some), end) for end in ends)


def work_against(moments: Callable[[list[float]], list[float]], end: float) -> float:
    """Give the work against moments, of rotations, that hold a body back up to a rotation [J]."""
    found = moments([at * end for at, _ in _PLACES])
    return sum(of * max(end * moment, 0.0) for (_, of), moment in zip(_PLACES, found, strict=True))


def _restoring(setting: "Setting", rotations: list[float]) -> list[float]:
    """Give what holds a body back: nothing where its base gives way altogether."""
    states = setting.curve(rotations)
    return [0.0 if state is None else state.restoring_moment for state in states]
