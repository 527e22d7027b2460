"""How long a ground motion is strong."""

import numpy as np

from rockframe.signals.arrays import Array
from rockframe.signals.polynomials import roots_of
from rockframe.signals.signal import Signal


def time_between_shares(history: Array, time_step: float, start: float, end: float) -> float:
    """Give the time in which a growing quantity goes from one share of its total to another.

    Parameters
    ----------
    history : ndarray, shape (n,)
        The quantity at every sample; starts at zero and never falls.
    time_step : float
        Between samples [s].
    start, end : float
        Shares of the last value, between 0 and 1 [1].

    Returns
    -------
    float
        Zero if nothing grows [s].
    """
    if history[-1] <= 0.0:
        return 0.0
    shares = history / history[-1]
    places = []
    for share in (start, end):
        after = int(np.searchsorted(shares, share))
        before = after - 1
        inside = (share - shares[before]) / (shares[after] - shares[before])
        places.append(before + inside)
    return float(places[1] - places[0]) * time_step


def exceedance(signal: Signal, level: float) -> tuple[float, float]:
    """Measure how long the absolute acceleration exceeds a level.

    Parameters
    ----------
    signal : Signal
        Acceleration of the ground.
    level : float
        [m s^-2]

    Returns
    -------
    bracketed : float
        From the first to the last exceedance; zero if there is none [s].
    total : float
        Sum of the times of exceedance [s].
    """
    first, last, total = np.inf, -np.inf, 0.0
    for side in (1.0, -1.0):
        above = side * signal.pieces
        above[:, 0] -= level
        starts_above, ends_above = above[:, 0] > 0.0, above.sum(axis=1) > 0.0
        enter, leave = np.zeros(len(above)), np.ones(len(above))
        crossed = starts_above != ends_above
        at = roots_of(above[crossed])
        enter[crossed] = np.where(starts_above[crossed], 0.0, at)
        leave[crossed] = np.where(starts_above[crossed], at, 1.0)
        rows = np.flatnonzero(starts_above | ends_above)
        if rows.size:
            total += float(np.sum(leave[rows] - enter[rows]))
            first = min(first, float(rows[0] + enter[rows[0]]))
            last = max(last, float(rows[-1] + leave[rows[-1]]))
    bracketed = max(0.0, last - first)
    return bracketed * signal.time_step, total * signal.time_step
