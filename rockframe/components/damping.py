"""The damping ratio of a base."""

from typing import Final

from rockframe.errors import ModelWarning, warn
from rockframe.units import NOT_NEGATIVE, to_ratio

CRITICAL: Final = 1.0
"""Damping ratio beyond which nothing vibrates [1]."""


def damping_ratio(given: object, *, owner: str) -> float:
    """Read the argument ``damping_ratio`` of a base.

    Parameters
    ----------
    given : float, str or pint.Quantity
        What the user gave.
    owner : str
        Class, for the message.

    Returns
    -------
    float
        [1]

    Raises
    ------
    UnitsError
        Not a pure ratio.
    ComponentError
        Not finite, or negative.

    Warns
    -----
    ModelWarning
        Above 1: per cent may have been meant.
    """
    ratio = to_ratio(given, owner=owner, name="damping_ratio", condition=NOT_NEGATIVE)
    if ratio > CRITICAL:
        msg = (
            f"{owner}: damping_ratio = {ratio:.6g} is {100.0 * ratio:.6g} % of critical; "
            f"was '{ratio:.6g} %' meant?"
        )
        warn(msg, ModelWarning)
    return ratio
