"""Probabilities as arguments, their normal scores, and exact confidence bounds of shares."""

from functools import partial
from typing import Final

import numpy as np

from rockframe.arguments import checked_list
from rockframe.signals.arrays import AnyArray, Array
from rockframe.units import Condition, to_ratio

BOUND_SUFFIXES: Final = ("", "_lower_bound", "_upper_bound")
"""Endings of the names of an estimate and of its bounds."""
SHARE: Final = Condition("above 0 and below 1", lambda value: 0.0 < value < 1.0)
_LEVEL: Final = Condition("from 0.5 to 0.9999", lambda value: 0.5 <= value <= 0.9999)


def read_confidence(value: object, *, owner: str) -> float:
    """Read the argument ``confidence``."""
    return to_ratio(value, owner=owner, name="confidence", condition=_LEVEL, example="0.95")


def read_shares(value: object, name: str, *, owner: str) -> Array:
    """Read an argument that is several shares."""
    listed = checked_list(value, owner=owner, name=name, of="numbers")
    read = partial(to_ratio, owner=owner, name=name, condition=SHARE, example="0.5")
    return np.array([read(share) for share in listed])


def normal_scores(probabilities: Array) -> Array:
    """Return the normal scores of probabilities, finite also where these are 0 or 1."""
    from scipy.special import ndtri

    return np.asarray(ndtri(np.clip(probabilities, 1e-300, 1.0 - 1e-16)))


def clopper_pearson(exceeded: AnyArray, trials: AnyArray, confidence: float) -> tuple[Array, Array]:
    """Return the exact bounds of shares (Clopper and Pearson, 1934)."""
    from scipy.special import betaincinv

    tail = 0.5 * (1.0 - confidence)
    over, under = np.asarray(exceeded, float), np.asarray(trials, float) - exceeded
    lower = betaincinv(np.maximum(over, 0.5), under + 1.0, tail)
    upper = betaincinv(over + 1.0, np.maximum(under, 0.5), 1.0 - tail)
    return np.where(over > 0.0, lower, 0.0), np.where(under > 0.0, upper, 1.0)
