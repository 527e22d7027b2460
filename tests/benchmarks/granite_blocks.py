"""Effective planar blocks under the motions of a shake table, and their verdicts."""

from __future__ import annotations

import math
import warnings
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from scipy.stats import qmc

import rockframe as rf
from rockframe.errors import ModelWarning
from rockframe.signals.motion import absolute_peak
from rockframe.simulation.plan import Plan, plan_run
from rockframe.simulation.run import compute_response

RADII = (0.08, 0.8)
RESTITUTIONS = (0.7, 0.995)
PAIRS = 128
ANGLES = np.geomspace(0.04, 0.36, 20)
"""Overturning angles combined with every pair of size and restitution [rad]."""


class Shape(NamedTuple):
    """Fitted parameters: size [m], overturning angle [rad] and restitution of a block."""

    radius: float
    angle: float
    restitution: float

    @classmethod
    def of(cls, pair: Iterable[float], angle: float) -> Shape:
        """Return the shape of a pair of size and restitution and of an angle."""
        radius, restitution = pair
        return cls(radius, angle, restitution)


def block_of(shape: Shape) -> rf.System:
    """Build the effective block on rigid ground, a solid rectangle of arbitrary mass."""
    slenderness = 1.0 / math.tan(shape.angle)
    block = rf.Block.from_size(radius=f"{shape.radius!r} m", slenderness=slenderness, mass="1 t")
    with warnings.catch_warnings():
        # the angle and the restitution of a real block need not be those of one rectangle
        warnings.filterwarnings("ignore", "restitution", ModelWarning)
        return rf.System(block, rf.RigidGround(restitution=shape.restitution))


@dataclass(frozen=True)
class Shaking:
    """A motion of the table that blocks are subjected to."""

    plan: Plan
    peak: float  # of the acceleration [m s^-2]

    @classmethod
    def by(cls, motion: rf.GroundMotion, accuracy: str = "fast") -> Shaking:
        """Prepare a motion, and ten seconds of rest after it."""
        plan = plan_run(
            block_of(Shape(0.5, 0.1, 0.9)).assembly, motion, duration=None,
            free_vibration="10 s", initial=None, accuracy=accuracy, output_step=None,
            outputs=None, overturning="stop",
        )  # fmt: skip
        return cls(plan, absolute_peak(motion.si.horizontal.pieces))

    def overturns(self, system: rf.System) -> bool:
        """Whether a block overturns; motions that cannot lift it are not run."""
        if self.peak <= system.setting.uplift_acceleration:
            return False
        overturned = compute_response(system.assembly, self.plan).trajectory.overturned
        if overturned is None:
            msg = f"a run was not finished: {system.describe()}"
            raise RuntimeError(msg)
        return overturned


def overturns(shape: Shape, shakings: Sequence[Shaking]) -> np.ndarray:
    """Return whether a block overturns, for every motion."""
    system = block_of(shape)
    return np.array([one.overturns(system) for one in shakings])


def pairs() -> np.ndarray:
    """Return radii and restitutions that cover their ranges evenly, shape (pairs, 2)."""
    unit = qmc.Sobol(2, scramble=False).random(PAIRS)
    radii = RADII[0] * (RADII[1] / RADII[0]) ** unit[:, 0]
    return np.stack([radii, RESTITUTIONS[0] + np.ptp(RESTITUTIONS) * unit[:, 1]], axis=1)


def verdicts(pair: Iterable[float], shakings: Sequence[Shaking]) -> np.ndarray:
    """Return whether blocks of all angles overturn, shape (angles, motions)."""
    shapes = [Shape.of(pair, angle) for angle in ANGLES.tolist()]
    return np.array([overturns(shape, shakings) for shape in shapes])
