"""Where a body whose centre of mass is not above the middle of its base comes to rest.

It leans on its springs, :eq:`eq-tilted-rest`, and what carries it leans with it.
"""

import math
from typing import Final

import numpy as np

from rockframe.compiled import Vector
from rockframe.dynamics.alone_model import starting_state
from rockframe.dynamics.body import Body
from rockframe.dynamics.coupled.model import StackRest, state_at
from rockframe.dynamics.coupled.system import Coupled
from rockframe.dynamics.on_base import OnBase
from rockframe.dynamics.protocol import Ground, Start
from rockframe.dynamics.stacked import COORDINATES

STEPS: Final = 200
"""Steps in which the rotation at rest is searched, up to that at which the body falls."""
ROUNDING: Final = 1e-10
"""Share of gravity below which accelerations of a stack at rest are rounding noise."""
NEAR: Final = 0.02
"""Change of a placement, in radians and sizes of the block, from which rest is not followed."""
LEAST_STEP: Final = 1e-3
"""Least share of the eccentricity by which rest is followed."""
DIFFERENCE: Final = 1e-7
"""Of scaled placements, to find how accelerations change."""
STILL: Final = Ground(0.0, 0.0)
"""The ground while nothing shakes it."""


def eccentricity_of(body: Body) -> float:
    """Give how far the centre of mass is to the right of the middle of the base [m]."""
    return 0.5 * (body.left - body.right)


def rest_rotation(part: OnBase) -> float:
    """Give the rotation of a body at rest on its base.

    Parameters
    ----------
    part : OnBase
        The body and its base.

    Returns
    -------
    float
        The stable one that is nearest to upright, 0 if the body is symmetric; NaN if there is
        none, so that the body falls by its own weight [rad].
    """
    from scipy.optimize import root_scalar

    beside = eccentricity_of(part.body)
    if beside == 0.0:
        return 0.0
    distance = part.body.right if beside > 0.0 else part.body.left
    edge = math.copysign(math.atan2(distance, part.body.height), beside)

    def falling(rotation: float) -> float:
        """Give the angular acceleration to the side of the centre of mass."""
        own = part.base.read(np.zeros(part.base.variables()), 0)
        body, mode = starting_state(part, Start(rotation), own)
        return math.copysign(1.0, beside) * part.rates_in(mode, body, own, STILL).rotation

    held = (share for share in np.linspace(0.0, edge, STEPS + 1)[1:-1] if falling(share) < 0.0)
    first = next(held, None)
    if first is None:
        return math.nan
    found = root_scalar(falling, bracket=(0.0, float(first)), xtol=1e-300, rtol=1e-15)
    return found.root


def stack_rest(system: Coupled) -> StackRest | None:
    """Give where a block and the cap under it come to rest.

    The eccentricity grows from zero, and rest is followed from upright: a leaning stack has a
    second equilibrium, farther out, from which it falls.

    Parameters
    ----------
    system : Coupled
        The equations of both.

    Returns
    -------
    StackRest or None
        None if there is no rest, so that the block falls by its own weight.
    """
    if eccentricity_of(system.upper.body) == 0.0:
        return StackRest(0.0, 0.0, 0.0, 0.0)
    share, step, place = 0.0, 1.0, np.zeros(4)
    while share < 1.0:
        ahead = min(1.0, share + step)
        guess = place * (ahead / share) if share > 0.0 else place
        found = _rest_near(_with_share(system, ahead), guess)
        if found is not None and np.abs(found - guess).max() <= NEAR:
            share, place = ahead, found
        elif step < LEAST_STEP:
            return None
        else:
            step *= 0.5
    return StackRest(*(float(each) for each in place * _lengths(system)))


def _with_share(system: Coupled, share: float) -> Coupled:
    """Give a stack with a share of its block's eccentricity."""
    if share == 1.0:
        return system
    body, beside = system.upper.body, share * eccentricity_of(system.upper.body)
    half = 0.5 * (body.left + body.right)
    shifted = body._replace(left=half + beside, right=half - beside)
    return system._replace(upper=system.upper._replace(body=shifted), beside=beside)


def _lengths(system: Coupled) -> Vector:
    """Give what the placement is measured by; mirror images are solved alike."""
    body = system.upper.body
    side = math.copysign(1.0, eccentricity_of(body))
    return np.array([side, body.size(), side, body.size()])


def _rest_near(system: Coupled, guess: Vector) -> Vector | None:
    """Give a stable equilibrium, scaled; None if that near the guess is none."""
    from scipy.optimize import root

    lengths = _lengths(system)

    def accelerations(scaled: Vector) -> Vector:
        mode, state, _ = state_at(system, StackRest(*(scaled * lengths)))
        slope = system.accelerate(mode, state, STILL)
        return np.array(slope[: COORDINATES - 2]) / lengths

    found = root(accelerations, guess, tol=1e-15).x
    noise = ROUNDING * system.upper.body.gravity / system.upper.body.size()
    if not np.abs(accelerations(found)).max() <= noise:
        return None
    moves = DIFFERENCE * np.eye(4)
    slopes = np.array([accelerations(found + each) - accelerations(found - each) for each in moves])
    return found if np.linalg.eigvals(slopes).real.max() < 0.0 else None
