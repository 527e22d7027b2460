"""From where a run shall start to a model's mode, state and memory."""

import math
from collections.abc import Callable

import numpy as np

from rockframe.compiled import Vector
from rockframe.dynamics.protocol import MEMORY_SIZE, Start


def starting_by(
    start_mode: Callable[..., int], coordinates: int, parameters: Vector
) -> Callable[[Start], tuple[int, Vector, Vector]]:
    """Make the function ``initial`` of a model on pads or soil.

    Parameters
    ----------
    start_mode : callable
        ``start_mode(rotation, spin, height, speed, state, memory, parameters)``: fills
        state and memory and gives the mode; a height of NaN asks for equilibrium.
    coordinates : int
        Number of the model's coordinates.
    parameters : ndarray
        The model's parameters.

    Returns
    -------
    callable
    """

    def initial(start: Start) -> tuple[int, Vector, Vector]:
        state, memory = np.zeros(2 * coordinates), np.zeros(MEMORY_SIZE)
        height = start.vertical_displacement
        mode = start_mode(
            start.rotation,
            start.angular_velocity,
            math.nan if height is None else height,
            start.vertical_velocity,
            state,
            memory,
            parameters,
        )
        return mode, state, memory

    return initial
