"""From the response of a body on a bed to the ground of what stands on it."""

import math
from collections.abc import Callable
from typing import Final

import numpy as np

from rockframe.compiled import Integers, Matrix, Vector, entry
from rockframe.dynamics.protocol import ACCELERATE, ContactModel
from rockframe.dynamics.winkler_carried import carried_point
from rockframe.solve.ground import TERMS
from rockframe.solve.ground_table import Ground, ground_at
from rockframe.solve.trajectory import Trajectory

INTERVALS_PER_PERIOD: Final = 20.0
"""Least number of polynomials over the body's shortest period."""
HALVES: Final = 2
"""Samples of the body's response per polynomial."""

# A quartic in u in (0, 1) by its values at 0, 1/2, 1 and its means over both halves.
_POWERS: Final = np.arange(5)
_CONDITIONS: Final = np.array(
    [
        0.0**_POWERS,
        0.5**_POWERS,
        1.0**_POWERS,
        2.0 * 0.5 ** (_POWERS + 1.0) / (_POWERS + 1.0),
        2.0 * (1.0 - 0.5 ** (_POWERS + 1.0)) / (_POWERS + 1.0),
    ]
)
_QUARTIC: Final = np.linalg.inv(_CONDITIONS)
# Gauss' rule of three points, for the quintic pieces of analytic motions
_GAUSS: Final = np.polynomial.legendre.leggauss(3)


@entry("none", ACCELERATE, "integers", "matrix", "matrix", "vector", "real", "matrix")
def _carried_rows(
    accelerate: Callable[..., None],
    mode: Integers,
    state: Matrix,
    ground: Matrix,
    p: Vector,
    top: float,
    out: Matrix,
) -> None:
    for i in range(len(mode)):
        accelerate(mode[i], state[i], ground[i, 0], ground[i, 1], p, out[i])
        carried_point(mode[i], state[i], p, top, out[i])


def carrying_step(model: ContactModel, ground: Ground) -> float:
    """Give the length of the polynomials by which a body's response is carried over [s].

    A whole part of the motion's time step, so that the motion is smooth inside.
    """
    longest = 2.0 * math.pi / model.fastest_frequency / INTERVALS_PER_PERIOD
    return ground.interval / math.ceil(ground.interval / longest)


def carry(model: ContactModel, run: Trajectory, ground: Ground, top: float, step: float) -> Ground:
    """Give the absolute acceleration of a point of the body as a ground motion.

    Parameters
    ----------
    model : ContactModel
        A single body on a bed.
    run : Trajectory
        Its run, stored twice in every step.
    ground : Ground
        The ground under it.
    top : float
        Height of the point above the centre of mass [m].
    step : float
        Length of the polynomials [s].

    Returns
    -------
    Ground
        In each half of a step its mean is the change of the point's velocity, so that
        no impulse is lost where the velocity jumps.
    """
    count = (len(run.time) - 1) // HALVES
    rows = slice(0, HALVES * count + 1)
    time: Vector = np.arange(HALVES * count + 1, dtype=np.float64) * (step / HALVES)
    shaking = ground_at(ground, time)
    out = np.empty((len(time), run.state.shape[1] // 2 + 2))
    _carried_rows(
        model.accelerate,
        run.mode[rows].astype(np.int64),
        np.ascontiguousarray(run.state[rows]),
        shaking,
        model.parameters,
        top,
        out,
    )
    change = np.diff(out[:, :2], axis=0) / (step / HALVES) + _mean(ground, shaking, time)
    acceleration = out[:, 2:4] + shaking
    pieces: list[Matrix] = []
    for column in (0, 1):
        values, means = acceleration[:, column], change[:, column]
        given = np.stack([values[:-1:2], values[1::2], values[2::2], means[::2], means[1::2]])
        coefficients = np.zeros((count, TERMS))
        coefficients[:, :5] = (_QUARTIC @ given).T
        pieces.append(coefficients)
    samples = acceleration[::HALVES]
    return Ground(step, samples[:, 0], samples[:, 1], pieces[0], pieces[1])


def _mean(ground: Ground, shaking: Matrix, time: Vector) -> Matrix:
    """Give the ground's mean acceleration between times; its samples are among them."""
    if not len(ground.horizontal_pieces) and not len(ground.vertical_pieces):
        return 0.5 * (shaking[:-1] + shaking[1:])
    spans = np.diff(time)
    parts = [
        0.5 * weight * ground_at(ground, time[:-1] + 0.5 * (1.0 + point) * spans)
        for point, weight in zip(*_GAUSS, strict=True)
    ]
    return np.sum(parts, axis=0)
