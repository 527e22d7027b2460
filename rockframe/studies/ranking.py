"""Which of several parameters a verdict depends on, read from a sample of cases."""

from collections.abc import Mapping
from typing import Any, Final, NamedTuple

import numpy as np

from rockframe.results.outcome import Generic
from rockframe.signals.arrays import Array

_BINS: Final = 20
_FEWEST: Final = 20
"""Cases in a bin."""


class Matters(NamedTuple):
    """How much a parameter matters.

    Parameters
    ----------
    first_order : float
        First-order index: the variance of the share that overturns given the parameter, over
        that of the verdict, without what chance alone would give [1].
    distance : float
        Greatest difference of the distributions of the parameter in cases of either verdict;
        NaN of words [1].
    chance : float
        Probability of shares as uneven if the parameter did not matter [1].
    """

    first_order: float
    distance: float
    chance: float


def ranked(columns: Mapping[str, Generic], verdict: Array) -> dict[str, Matters]:
    """Tell what matters most, first.

    Parameters
    ----------
    columns : mapping of str to ndarray, shape (cases,)
        Parameters; numbers are sorted into groups, words are groups.
    verdict : ndarray, shape (cases,)
        1 or 0.

    Returns
    -------
    dict of str to Matters

    Notes
    -----
    The index is the correlation ratio of groups of equal size, less its expectation if there
    were no dependence (the adjusted ratio, Kelley 1935): a first-order Sobol index from given
    data, within the width of the groups. The distance is that of Hornberger and Spear (1981).
    """
    found = {name: _matters(values, verdict) for name, values in columns.items()}
    return dict(sorted(found.items(), key=lambda one: -one[1].first_order))


def _matters(values: Generic, verdict: Array) -> Matters:
    from scipy.stats import chi2_contingency, ks_2samp

    count = len(verdict)
    falls = float(verdict.sum())
    if falls in (0.0, float(count)):
        return Matters(np.nan, np.nan, np.nan)
    numbers = values.dtype.kind != "U"
    if numbers:
        order = np.argsort(np.argsort(values, kind="stable"), kind="stable")
        groups = max(1, min(_BINS, count // _FEWEST))
        place = order * groups // count
    else:
        place = np.unique(values, return_inverse=True)[1]
    size = np.bincount(place).astype(np.float64)
    over = np.bincount(place, weights=verdict)
    groups = len(size)
    if groups < 2 or groups >= count:
        return Matters(np.nan, np.nan, np.nan)
    share = falls / count
    between = float((size * (over / size - share) ** 2).sum()) / (count * share * (1.0 - share))
    index = 1.0 - (1.0 - between) * (count - 1.0) / (count - groups)
    test: Any = chi2_contingency(np.stack([over, size - over]), correction=False)
    chance = float(test.pvalue)
    distance = np.nan
    if numbers:
        both: Any = ks_2samp(values[verdict == 1.0], values[verdict == 0.0])
        distance = float(both.statistic)
    return Matters(max(index, 0.0), distance, chance)
