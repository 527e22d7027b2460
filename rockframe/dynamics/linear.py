"""Small motion of bodies on one another about rest: M q'' + C q' + K q = 0.

K and C are derivatives of the forces of bases, links and weights in the equations of motion, for
the contacts at rest.
"""

from typing import NamedTuple

import numpy as np

from rockframe.compiled import Matrix
from rockframe.dynamics.equilibrium import of_bases, of_loads
from rockframe.dynamics.standing import RATES, Stand, of_base
from rockframe.dynamics.statics import StandingChain
from rockframe.dynamics.trigonometry import sine_cosine


class Linear(NamedTuple):
    """Matrices for rotation and height of each body on its base, top down, per unit mass."""

    mass: Matrix
    damping: Matrix
    stiffness: Matrix


def linear(chain: StandingChain, stands: list[Stand]) -> Linear:
    """Return the matrices of small motion about rest."""
    size = 2 * len(stands)
    damping = np.zeros((size, size))
    ties = chain.tied(stands)
    states = [one.state for one in ties]
    for one in ties:
        damping += one.damping_matrix
    for k, (standing, stand) in enumerate(zip(chain.bodies, stands, strict=True)):
        own = slice(2 * k, 2 * k + 2)
        damping[own, own] += np.array([of_base(standing, stand, name) for name in RATES]).T
    stiffness = of_bases(chain, stands)
    stiffness += of_loads(chain, stands, lambda others: chain.tie_loads(others, states))
    return Linear(_mass(chain, stands), damping, stiffness)


def _mass(chain: StandingChain, stands: list[Stand]) -> Matrix:
    """Return the mass matrix: with a body all bodies above it move."""
    size = 2 * len(stands)
    ways = np.zeros((len(stands), 3, size))  # of each body: to the right, up, rotation
    places, place = np.zeros((len(stands), 2)), np.zeros(2)
    turned = top = 0.0
    for k in range(len(stands) - 1, -1, -1):
        stand, arm = stands[k], top + chain.bodies[k].part.body.height + stands[k].state.vertical
        sine, cosine = sine_cosine(turned)
        axes = np.array([[cosine, -sine], [sine, cosine]])
        place = places[k] = place + np.array([stand.across, arm]) @ axes
        ways[: k + 1, :2, 2 * k] = stand.reach.derivative * axes[0]
        ways[: k + 1, 2, 2 * k] = 1.0
        ways[: k + 1, :2, 2 * k + 1] = axes[1]
        turned, top = turned + stand.state.rotation, chain.bodies[k].top
    for k in range(1, len(stands)):  # about the centre of the body that rotates
        x, y = (places[:k] - places[k]).T
        ways[:k, :2, 2 * k] += np.column_stack((y, -x))
    found = np.zeros((size, size))
    for standing, way in zip(chain.bodies, ways, strict=True):
        found += way.T @ np.diag([standing.mass, standing.mass, standing.part.body.inertia]) @ way
    return found
