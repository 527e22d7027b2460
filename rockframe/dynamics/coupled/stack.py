"""A block on a base on a cap on a base: the parts, and their small motion together."""

import math
from typing import NamedTuple

import numpy as np

from rockframe.compiled import Matrix
from rockframe.dynamics.base_numbers import BaseNumbers
from rockframe.dynamics.body import Body


class BlockOnCap(NamedTuple):
    """Block, pads, cap and soil, per unit mass of the block.

    The cap's top is as high above its centre as the centre above its base.
    """

    block: Body
    pads: BaseNumbers
    cap: Body
    soil: BaseNumbers
    cap_mass: float  # over that of the block


def small_motion_matrices(stack: BlockOnCap) -> tuple[Matrix, Matrix, Matrix]:
    """Give mass, damping and stiffness of small motion about rest, in full contact.

    In the order Y, phi, r, psi, per unit mass of the block, :eq:`eq-coupled-small`.
    """
    block, pads, cap, soil, cap_mass = stack
    h, h_c, g = block.height, cap.height, block.gravity
    high = h + 2.0 * h_c
    mass = np.array(
        [
            [1.0 + cap_mass, 0.0, 1.0, 0.0],
            [
                0.0,
                cap.inertia + cap_mass * h_c**2 + block.inertia + high**2,
                0.0,
                block.inertia + h * high,
            ],
            [1.0, 0.0, 1.0, 0.0],
            [0.0, block.inertia + h * high, 0.0, block.inertia + h**2],
        ]
    )
    springs = [
        soil.vertical_stiffness, soil.rotational_stiffness, pads.vertical_stiffness,
        pads.rotational_stiffness,
    ]  # fmt: skip
    times = [soil.damping_time, soil.damping_time, pads.damping_time, pads.damping_time]
    stiffness = np.diag(springs)
    stiffness[1, 1] -= g * (cap_mass * h_c + high)
    stiffness[3, 3] -= g * h
    stiffness[1, 3] = stiffness[3, 1] = -g * h
    return mass, np.diag(np.array(springs) * times), stiffness


def fastest_vibration(stack: BlockOnCap) -> tuple[float, float]:
    """Give bounds of angular frequency and damping rate, of both together or the cap alone."""
    mass, damping, stiffness = small_motion_matrices(stack)
    _, _, cap, soil, cap_mass = stack
    rotating = cap.inertia + cap_mass * cap.height**2
    alone = max(soil.vertical_stiffness / cap_mass, soil.rotational_stiffness / rotating)

    def largest(matrix: Matrix) -> float:
        return float(np.linalg.eigvals(np.linalg.solve(mass, matrix)).real.max())

    return (
        math.sqrt(max(largest(stiffness), alone)),
        max(largest(damping), soil.damping_time * alone),
    )
