"""Where a body comes to rest whose weight does not pass through the middle of its base.

Its centre of mass stands beside that, or the base is inclined. It leans on its springs,
:eq:`eq-tilted-rest`, and what carries it leans with it. On an inclined base gravity along it stands
for a lasting acceleration of the ground, :eq:`eq-incline-ground`.
"""

import math
from typing import Final

import numpy as np

from rockframe.compiled import Vector
from rockframe.dynamics.alone_model import eccentricity_of, starting_state
from rockframe.dynamics.body import BodyState
from rockframe.dynamics.coupled.model import StackRest, state_at
from rockframe.dynamics.coupled.system import Coupled
from rockframe.dynamics.on_base import Mode, OnBase
from rockframe.dynamics.protocol import Ground, Start
from rockframe.dynamics.stacked import COORDINATES

STEPS: Final = 200
"""Steps in which the rotation at rest is searched, up to that at which the body falls."""
CLOSE: Final = 1e-10
"""Share of the rotation of falling to which it is found where another point comes to be held."""
SMALL: Final = 1e-6
"""Share of the angular acceleration of an upright body below which it is at rest."""
ROUNDING: Final = 1e-10
"""Share of gravity below which accelerations of a stack at rest are rounding noise."""
NEAR: Final = 0.02
"""Change of a placement, in radians and sizes of the block, from which rest is not followed."""
LEAST_STEP: Final = 1e-3
"""Least share of the eccentricity and of the slope by which rest is followed."""
DIFFERENCE: Final = 1e-7
"""Of scaled placements, to find how accelerations change."""


def still(along_gravity: float) -> Ground:
    """Give the ground while nothing shakes it, with gravity along the base [m s^-2]."""
    return Ground(along_gravity, 0.0)


def rest_rotation(part: OnBase, along_gravity: float = 0.0) -> float:
    """Give the rotation of a body at rest on its base.

    Parameters
    ----------
    part : OnBase
        The body and its base.
    along_gravity : float
        Acceleration that stands for gravity along the base, g sin i [m s^-2].

    Returns
    -------
    float
        The stable one that is nearest to upright, 0 if nothing turns the body there; NaN if there
        is none, so that the body falls by its own weight [rad].
    """
    from scipy.optimize import root_scalar

    shape = part.body
    moment = shape.gravity * eccentricity_of(shape) - shape.height * along_gravity
    if moment == 0.0:
        return 0.0
    tilt = along_gravity / shape.gravity
    distance = shape.right if moment > 0.0 else shape.left
    edge = math.copysign(math.atan2(distance, shape.height), moment)
    edge += tilt if shape.small else math.atan(tilt)
    if edge * moment <= 0.0:
        return math.nan
    ground, variables = still(along_gravity), part.base.variables()

    def placed(rotation: float) -> tuple[BodyState, Mode]:
        return starting_state(part, Start(rotation), part.base.read(np.zeros(variables), 0))

    def falling(rotation: float) -> float:
        """Give the angular acceleration to the side to which the weight turns the body."""
        body, mode = placed(rotation)
        own = part.base.read(np.zeros(variables), 0)
        return math.copysign(1.0, moment) * part.rates_in(mode, body, own, ground).rotation

    def last_held_alike(low: float, high: float) -> float:
        """Give the last rotation at which the same point is held as at the lower one."""
        held = placed(low)[1].pivot
        while abs(high - low) > CLOSE * abs(edge):
            middle = 0.5 * (low + high)
            low, high = (middle, high) if placed(middle)[1].pivot == held else (low, middle)
        return low

    def beyond_rest() -> tuple[float, float] | None:
        """Give the first rotations between which the body stops falling."""
        low, held = 0.0, placed(0.0)[1].pivot
        for share in np.linspace(0.0, edge, STEPS + 1)[1:-1].tolist():
            before, held = held, placed(share)[1].pivot
            if held != before:
                last = last_held_alike(low, share)
                if last != low and falling(last) < 0.0:
                    return low, last
            if falling(share) < 0.0:
                return low, share
            low = share
        return None

    bracket = beyond_rest()
    if bracket is None:
        return math.nan
    root = root_scalar(falling, bracket=bracket, xtol=1e-300, rtol=1e-15).root
    # where an end leaves an inclined base another point is held, and the moment of the thrust jumps
    jumps = along_gravity != 0.0 and abs(falling(root)) > SMALL * abs(falling(0.0))
    return math.nan if jumps else root


def stack_rest(system: Coupled, along_gravity: float = 0.0) -> StackRest | None:
    """Give where a block and the cap under it come to rest.

    Eccentricity and slope grow from zero, and rest is followed from upright: a leaning stack has
    a second equilibrium, farther out, from which it falls.

    Parameters
    ----------
    system : Coupled
        The equations of both.
    along_gravity : float
        Acceleration that stands for gravity along the base, g sin i [m s^-2].

    Returns
    -------
    StackRest or None
        None if there is no rest, so that the block falls by its own weight.
    """
    block = system.upper.body
    beside = eccentricity_of(block)
    if beside == 0.0 and along_gravity == 0.0:
        return StackRest(0.0, 0.0, 0.0, 0.0)
    # mirror images are solved alike
    side = math.copysign(1.0, block.gravity * beside - block.height * along_gravity)
    lengths = np.array([side, block.size(), side, block.size()])
    share, step, place = 0.0, 1.0, np.zeros(4)
    while share < 1.0:
        ahead = min(1.0, share + step)
        guess = place * (ahead / share) if share > 0.0 else place
        found = _rest_near(_with_share(system, ahead), ahead * along_gravity, guess, lengths)
        if found is not None and np.abs(found - guess).max() <= NEAR:
            share, place = ahead, found
        elif step < LEAST_STEP:
            return None
        else:
            step *= 0.5
    return StackRest(*(float(each) for each in place * lengths))


def _with_share(system: Coupled, share: float) -> Coupled:
    """Give a stack with a share of its block's eccentricity."""
    if share == 1.0:
        return system
    body, beside = system.upper.body, share * eccentricity_of(system.upper.body)
    half = 0.5 * (body.left + body.right)
    shifted = body._replace(left=half + beside, right=half - beside)
    return system._replace(upper=system.upper._replace(body=shifted), beside=beside)


def _rest_near(
    system: Coupled, along_gravity: float, guess: Vector, lengths: Vector
) -> Vector | None:
    """Give a stable equilibrium, scaled by lengths; None if that near the guess is none."""
    from scipy.optimize import root

    def accelerations(scaled: Vector) -> Vector:
        mode, state, _ = state_at(system, StackRest(*(scaled * lengths)))
        slope = system.accelerate(mode, state, still(along_gravity))
        return np.array(slope[: COORDINATES - 2]) / lengths

    found = root(accelerations, guess, tol=1e-15).x
    noise = ROUNDING * system.upper.body.gravity / system.upper.body.size()
    if not np.abs(accelerations(found)).max() <= noise:
        return None
    moves = DIFFERENCE * np.eye(4)
    slopes = np.array([accelerations(found + each) - accelerations(found - each) for each in moves])
    return found if np.linalg.eigvals(slopes).real.max() < 0.0 else None
