"""A block held at a rotation on pads on a cap on soil, in equilibrium, :eq:`eq-static-stack`."""

import math
from itertools import pairwise
from typing import TYPE_CHECKING, Final

import numpy as np

from rockframe.errors import SolverError
from rockframe.system.bodies import Body, Cap
from rockframe.system.options import Restraint
from rockframe.system.statics import Statics, sine_cosine_rise
from rockframe.system.support import Held

if TYPE_CHECKING:
    from rockframe.system.stacked import StackedSetting

STEPS: Final = 200
"""Steps in which the cap's tilt is searched up to the rotation of a held block."""
BEYOND: Final = 2
"""How far it is searched, by that rotation: a cap on soft soil leans further than a block that
has to be pulled back."""
LEAN: Final = 4.0
"""How far it is searched where the cap leans at rest, by that tilt."""


def stack_statics(stack: "StackedSetting", rotation: float) -> Statics:
    """Give the equilibrium of a stack with the block held at a rotation.

    Parameters
    ----------
    stack : StackedSetting
        The stack.
    rotation : float
        Of the block [rad].

    Returns
    -------
    Statics

    Raises
    ------
    SolverError
        The soil cannot carry the moment.
    """
    _, found = _balance(stack, _tilt_under(stack, rotation), rotation)
    return found


def _tilt_under(stack: "StackedSetting", rotation: float) -> float:
    """Give the least rotation of the cap at which it is in balance under the held block."""
    from scipy.optimize import root_scalar

    def lack(tilt: float) -> float:
        return math.copysign(1.0, rotation) * _balance(stack, tilt, rotation)[0]

    if rotation == 0.0 and not stack.leans:
        return 0.0
    # a far held block leaves the cap a second, larger tilt, which is not stable
    reach, count = BEYOND * rotation, BEYOND * STEPS
    tilts = np.linspace(0.0, reach, count + 1)
    if stack.leans:  # even under an upright block
        reach = math.copysign(max(abs(reach), LEAN * abs(stack.cap_lean)), rotation)
        tilts = np.linspace(-reach, reach, 2 * count + 1)
    lacks = ((float(tilt), lack(float(tilt))) for tilt in tilts)
    for (low, before), (high, after) in pairwise(lacks):
        if before <= 0.0 < after:
            return root_scalar(lack, bracket=(low, high), xtol=1e-15, rtol=1e-14).root
    msg = (
        f"no equilibrium of cap and soil was found with the block held at {rotation:.6g} rad: "
        "the soil cannot carry the moment"
    )
    raise SolverError(msg)


def _balance(stack: "StackedSetting", tilt: float, rotation: float) -> tuple[float, Statics]:
    """Give what the moments on the cap lack to balance at a tilt, and the state of the stack."""
    upper, cap, options = stack.upper.support, stack.cap, stack.options
    block, weight, along = stack.body, stack.load.weight, stack.load.thrust
    h, beside = block.centre_height, block.eccentricity
    frame_sine, frame_cosine = math.sin(tilt), math.cos(tilt)
    # the block on the cap, under the weight along the cap's normal
    sine, cosine, rise = sine_cosine_rise(h, options.rotation, rotation - tilt)
    press = weight * frame_cosine + along * frame_sine
    held = upper.held(sine, cosine, press)
    normal = held.rise - rise - beside * sine
    pad_moment = press * (h * sine + beside * cosine) - held.moment
    # the held point, from the middle of the base and from beneath the centre of mass
    pin = _pin(stack, block, held, rotation - tilt)
    foot = pin - beside
    across = pin + h * sine - foot * cosine
    slide = h if options.small else h * cosine + foot * sine
    # the cap: thrust along it, its own weight on the soil
    thrust = along * frame_cosine - weight * frame_sine
    sine, cosine, cap_rise = sine_cosine_rise(cap.half_height, options.rotation, tilt)
    all_weight, all_along = stack.lower.load.weight, stack.lower.load.thrust
    under = stack.lower.support.held(sine, cosine, all_weight)
    soil = all_weight * cap.half_height * sine - under.moment
    if all_along != 0.0:
        foot = _pin(stack, cap, under, tilt)
        soil -= all_along * (cap.half_height * cosine + (0.0 if options.small else foot * sine))
    arm = cap.half_height + h + normal
    drop = (cap.half_height + h) * 2.0 * math.sin(0.5 * tilt) ** 2
    lack = (arm - slide) * thrust - across * press + pad_moment - soil
    return lack, Statics(
        vertical_displacement=under.rise
        - cap_rise
        + normal * frame_cosine
        - across * frame_sine
        - drop,
        base_moment=under.moment,
        restoring_moment=slide * thrust - pad_moment,
        contact_state=held.contact,
        reactions={**held.reactions, **under.reactions, "cap_rotation": tilt},
    )


def _pin(stack: "StackedSetting", body: Body | Cap, held: Held, rotation: float) -> float:
    """Give the held point of the base of block or cap in a static state, from its middle."""
    options = stack.options
    if options.small or options.restraint is Restraint.CENTRE:
        return 0.0
    half = body.half_width
    if options.restraint is Restraint.CONTACT_STATE:
        return 0.0 if held.left and held.right else (half if held.right else -half)
    return math.copysign(half, rotation) if rotation != 0.0 else 0.0
