"""Sliding contact: an end that touches its base without a normal force while the body slips.

An end can land while the horizontal restraint that its contact causes would lift it off again.
Then neither contact nor flight is a solution: a held end lifts off, a free one lands again. The
restraint can act only while the end presses, so its impulse ends when the end's speed equals that
of the base beneath it, :eq:`eq-partial-hold`. With the rest of its slip the end *slides*: it
remains at its level with no reaction, and the held point slips against a force that is just large
enough to keep the end there, :eq:`eq-sliding-contact`.
"""

import sys
from typing import Final

from rockframe.compiled import inlined

SPEED_ROUNDING: Final = 16.0 * sys.float_info.epsilon
"""Rounding noise of an end's speed, over the sum of the sizes of its two parts [1]."""
NEGLIGIBLE_LIFT: Final = 1e-7
"""Speed at which a hold lifts an end, over that of the slip, that is negligible [1]."""
LIFT_OFF_NOISE: Final = 1e3
"""Excess speed of a sliding end over its rounding noise above which it lifts off [1]."""


@inlined
def speed_noise(speed: float, lever: float, angular_velocity: float) -> float:
    """Return the rounding noise of an end's speed, the sum of two velocities."""
    return SPEED_ROUNDING * (abs(speed) + abs(lever * angular_velocity))


@inlined
def is_lifted(before: float, after: float, noise: float) -> bool:
    """Whether a hold would stop or lift an end that comes down, by its speeds before and after.

    An end that rises, though by rounding below its level, is about to lift off anyway.
    """
    return before <= noise and after >= -noise


@inlined
def share_at_lift_off(before: float, after: float) -> float:
    """Return the share of the hold's impulse that stops a landing end, :eq:`eq-partial-hold`.

    `before` and `after` are the end's speeds without the impulse and with all of it.
    """
    if before >= 0.0:
        return 0.0
    return min(before / (before - after), 1.0) if before < after else 1.0


@inlined
def blend(before: float, after: float, share: float) -> float:
    """Return a rate after a share of an impulse, from the rates without and with all of it."""
    return before + share * (after - before)


@inlined
def loss_share(share: float) -> float:
    """Return the energy loss of a share of a plastic impulse, over that of the whole one [1]."""
    return share * (2.0 - share)
