"""Small motion about a rest that is not upright: derivatives of the accelerations.

Upright, symmetric bodies have closed forms; one that leans has none that is shorter than its
equations of motion, which are differentiated here.
"""

from collections.abc import Callable
from typing import Final, NamedTuple

import numpy as np

from rockframe.compiled import Matrix, Vector
from rockframe.dynamics.alone_model import starting_state
from rockframe.dynamics.body import BodyState
from rockframe.dynamics.coupled.model import StackRest, state_at
from rockframe.dynamics.coupled.system import Coupled
from rockframe.dynamics.on_base import OnBase
from rockframe.dynamics.protocol import Start
from rockframe.dynamics.rest import still
from rockframe.dynamics.stacked import COORDINATES

STEP: Final = 1e-6
"""Share of a coordinate's size by which it is moved."""


class Linear(NamedTuple):
    """Minus the derivatives of accelerations by velocities and by coordinates."""

    damping: Matrix
    stiffness: Matrix


def linear_alone(part: OnBase, rotation: float, along_gravity: float = 0.0) -> Linear:
    """Give small motion of a body about a rest, by height and rotation.

    Parameters
    ----------
    part : OnBase
        The body and its base.
    rotation : float
        At rest [rad].
    along_gravity : float
        Acceleration that stands for gravity along the base, g sin i [m s^-2].

    Returns
    -------
    Linear
        Shape (2, 2) each.
    """
    own = part.base.read(np.zeros(part.base.variables()), 0)
    rest, mode = starting_state(part, Start(rotation), own)

    def accelerations(moved: Vector, rates: Vector) -> Vector:
        state = BodyState(
            rest.rotation + moved[1], rest.vertical + moved[0], 0.0, rates[1], rates[0], 0.0
        )
        found = part.rates_in(mode, state, own, still(along_gravity))
        return np.array([found.vertical, found.rotation])

    return _derivatives(accelerations, np.array([part.body.size(), 1.0]))


def linear_stack(system: Coupled, rest: StackRest, along_gravity: float = 0.0) -> Linear:
    """Give small motion of a cap and of the block on it about a rest.

    Parameters
    ----------
    system : Coupled
        The equations of both.
    rest : StackRest
        Where they are at rest.
    along_gravity : float
        As for :func:`linear_alone`.

    Returns
    -------
    Linear
        By height and rotation of the cap, then of the block relative to it; shape (4, 4) each.
    """
    mode, _, _ = state_at(system, rest)
    places = [3, 2, 1, 0]  # of these coordinates in the state

    def accelerations(moved: Vector, rates: Vector) -> Vector:
        there = StackRest(*(np.array(rest) + moved[places]))
        _, state, _ = state_at(system, there)
        for place, rate in zip(places, rates, strict=True):
            state[COORDINATES + place] = rate
        slope = np.array(system.accelerate(mode, state, still(along_gravity)))
        return slope[places]

    size = system.upper.body.size()
    return _derivatives(accelerations, np.array([size, 1.0, size, 1.0]))


def _derivatives(accelerations: Callable[[Vector, Vector], Vector], sizes: Vector) -> Linear:
    count = len(sizes)
    still = np.zeros(count)
    damping, stiffness = np.empty((count, count)), np.empty((count, count))
    for i, size in enumerate(sizes):
        step = still.copy()
        step[i] = STEP * size
        twice = 2.0 * STEP * size
        stiffness[:, i] = (accelerations(-step, still) - accelerations(step, still)) / twice
        damping[:, i] = (accelerations(still, -step) - accelerations(still, step)) / twice
    return Linear(damping, stiffness)
