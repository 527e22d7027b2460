"""Stacked bodies with their bases: bounds of natural frequencies and damping rates."""

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from rockframe.compiled import Matrix
from rockframe.dynamics.base_numbers import BaseNumbers
from rockframe.dynamics.bed import Rigid
from rockframe.dynamics.body import Body
from rockframe.dynamics.single_body import rocking_rate

if TYPE_CHECKING:
    from rockframe.dynamics.chain.link_rows import ChainLink


class ChainBody(NamedTuple):
    """A body upon others, and the base under it, per unit of the reference mass."""

    body: Body
    base: BaseNumbers
    mass: float  # over the reference mass [1]
    top: float  # height of the body's top above its centre of mass [m]
    offset: float  # its centre of mass to the right of that of the body below, upright [m]


def is_rigid(base: BaseNumbers) -> bool:
    """Whether a base is rigid."""
    return isinstance(base.law, Rigid)


def per_own_mass(body: ChainBody) -> Body:
    """Return the body per unit of its own mass."""
    return body.body._replace(inertia=body.body.inertia / body.mass)


def fastest_vibration(
    bodies: Sequence[ChainBody], ties: Sequence["ChainLink"] = ()
) -> tuple[float, float]:
    """Return upper bounds of angular frequency and damping rate, whichever bodies fly [s^-1].

    Neither gravity nor a loss of contact makes a vibration faster.
    """
    fastest = damping = 0.0
    for first in range(len(bodies)):
        moving = bodies[first:]
        link_stiffness, link_damping = _link_matrices(moving, ties, first)
        root, stiffness, base_damping = upright_matrices(moving)
        fastest = max(fastest, greatest_eigenvalue(stiffness + link_stiffness, root))
        damping = max(damping, greatest_eigenvalue(base_damping + link_damping, root))
    # a body at rest on a rigid base makes no vibration faster; a rocking one has a rate of its own
    rocking = sum(rocking_rate(per_own_mass(body)) ** 2 for body in bodies if is_rigid(body.base))
    return math.sqrt(max(fastest, rocking)), damping


def _link_matrices(
    bodies: Sequence[ChainBody], ties: Sequence["ChainLink"], first: int
) -> tuple[Matrix, Matrix]:
    """Return bounds of stiffness and damping of links between bodies from `first` on and others."""
    size = 2 * len(bodies)
    stiffness, damping = np.zeros((size, size)), np.zeros((size, size))
    x, y, rotation = upright_jacobians(bodies)
    for tie in ties:
        jacobian = np.zeros((2, size))
        for k, point, sign in ((tie.on, tie.on_point, 1.0), (tie.to, tie.to_point, -1.0)):
            if k >= first:
                jacobian[0] += sign * (x[k - first] + point[1] * rotation[k - first])
                jacobian[1] += sign * (y[k - first] - point[0] * rotation[k - first])
        stiffness += tie.numbers.stiffness * jacobian.T @ jacobian
        damping += tie.numbers.damping * jacobian.T @ jacobian
    return stiffness, damping


def greatest_eigenvalue(matrix: Matrix, root: Matrix) -> float:
    """Return the greatest eigenvalue of a matrix relative to the mass matrix R^T R, R the `root`.

    With very unlike masses the mass matrix may be singular within rounding; its root is not.
    """
    inverse = np.linalg.inv(root)
    return float(np.linalg.eigvalsh(inverse.T @ matrix @ inverse).max())


def upright_matrices(bodies: Sequence[ChainBody]) -> tuple[Matrix, Matrix, Matrix]:
    """Return root of the masses, stiffness of the bases and damping of small motion, upright.

    In the order of rotation and height of each body relative to what it stands on, from the top
    down.
    """
    x, y, rotation = upright_jacobians(bodies)
    root = np.sqrt([body.mass for body in bodies])[:, None]
    gyration = np.sqrt([body.body.inertia for body in bodies])[:, None]
    springs = np.array([
        stiffness for body in bodies
        for stiffness in (body.base.rotational_stiffness, body.base.vertical_stiffness)
    ])  # fmt: skip
    times = np.repeat([body.base.damping_time for body in bodies], 2)
    rows = np.concatenate([root * x, root * y, gyration * rotation])
    return np.linalg.qr(rows).R, np.diag(springs), np.diag(springs * times)


def upright_jacobians(bodies: Sequence[ChainBody]) -> tuple[Matrix, Matrix, Matrix]:
    """Return derivatives of x, y and rotation of each body by all coordinates, upright."""
    count = len(bodies)
    x, y, rotation = (np.zeros((count, 2 * count)) for _ in range(3))
    below_x, below_y, below_rotation = (np.zeros(2 * count) for _ in range(3))
    deck = 0.0
    for k in range(count - 1, -1, -1):
        body = bodies[k]
        arm = 0.0 if k == count - 1 else deck + body.body.height
        offset = 0.0 if k == count - 1 else body.offset
        own, up = np.zeros(2 * count), np.zeros(2 * count)
        own[2 * k], up[2 * k + 1] = 1.0, 1.0
        x[k] = below_x + arm * below_rotation + body.body.height * own
        y[k] = below_y - offset * below_rotation + up
        rotation[k] = below_rotation + own
        below_x, below_y, below_rotation, deck = x[k], y[k], rotation[k], body.top
    return x, y, rotation
