"""Small motion of bodies on one another about rest: M q'' + C q' + K q = 0.

K and C are derivatives of the forces of bases, links and weights in the equations of motion, for
the contacts at rest.
"""

from typing import NamedTuple

import numpy as np

from rockframe.compiled import Matrix
from rockframe.dynamics.body_statics import RATES, Pose, base_derivatives
from rockframe.dynamics.equilibrium import base_stiffness, load_stiffness
from rockframe.dynamics.statics import StandingChain
from rockframe.dynamics.trigonometry import sine_cosine


class LinearMatrices(NamedTuple):
    """Matrices for rotation and height of each body on its base, top down, per unit mass."""

    mass: Matrix
    damping: Matrix
    stiffness: Matrix


def linearized_chain(chain: StandingChain, poses: list[Pose]) -> LinearMatrices:
    """Return the matrices of small motion about rest."""
    size = 2 * len(poses)
    damping = np.zeros((size, size))
    links = chain.link_forces(poses)
    states = [link.state for link in links]
    for link in links:
        damping += link.damping_matrix
    for k, (standing, pose) in enumerate(zip(chain.bodies, poses, strict=True)):
        own = slice(2 * k, 2 * k + 2)
        damping[own, own] += np.array([base_derivatives(standing, pose, name) for name in RATES]).T
    stiffness = base_stiffness(chain, poses)
    stiffness += load_stiffness(chain, poses, lambda others: chain.link_loads(others, states))
    return LinearMatrices(_mass(chain, poses), damping, stiffness)


def _mass(chain: StandingChain, poses: list[Pose]) -> Matrix:
    """Return the mass matrix: all bodies above a body move with it."""
    size = 2 * len(poses)
    jacobians = np.zeros((len(poses), 3, size))  # of each body: to the right, up, rotation
    places, place = np.zeros((len(poses), 2)), np.zeros(2)
    rotation_below = top = 0.0
    for k in range(len(poses) - 1, -1, -1):
        pose, arm = poses[k], top + chain.bodies[k].part.body.height + poses[k].state.vertical
        sine, cosine = sine_cosine(rotation_below)
        axes = np.array([[cosine, -sine], [sine, cosine]])
        place = places[k] = place + np.array([pose.across, arm]) @ axes
        jacobians[: k + 1, :2, 2 * k] = pose.reach.derivative * axes[0]
        jacobians[: k + 1, 2, 2 * k] = 1.0
        jacobians[: k + 1, :2, 2 * k + 1] = axes[1]
        rotation_below, top = rotation_below + pose.state.rotation, chain.bodies[k].top
    for k in range(1, len(poses)):  # about the centre of the body that rotates
        x, y = (places[:k] - places[k]).T
        jacobians[:k, :2, 2 * k] += np.column_stack((y, -x))
    mass_matrix = np.zeros((size, size))
    for standing, jacobian in zip(chain.bodies, jacobians, strict=True):
        mass_matrix += (
            jacobian.T
            @ np.diag([standing.mass, standing.mass, standing.part.body.inertia])
            @ jacobian
        )
    return mass_matrix
