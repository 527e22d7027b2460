"""What bounds of fragilities are: how often they hold what they are said to hold, as measured."""

from typing import Final, NamedTuple

from rockframe.signals.arrays import Array
from rockframe.studies.fragility.likelihood import Bands


class Held(NamedTuple):
    """Shares of simulated samples in which bounds of nominal 95 % held the true value [1]."""

    median: float
    dispersion: float


COVERAGE: Final = {
    Bands.PROFILE: {5: Held(0.90, 0.89), 10: Held(0.93, 0.93)},
    Bands.SANDWICH: {
        10: Held(0.89, 0.80),
        20: Held(0.92, 0.87),
        40: Held(0.94, 0.91),
        80: Held(0.95, 0.92),
    },
}
"""By numbers of independent trials or motions; with fewer than the least there are no bounds, with
the greatest they are what they are called. Measured, :ref:`coverage of bounds <coverage>`."""


def bounded(bands: Bands, independent: int) -> bool:
    """Tell whether there are enough independent trials for bounds."""
    return independent >= min(COVERAGE[bands])


def words_of_bounds(
    bands: Bands,
    confidence: float,
    independent: Array,
    trials: Array,
    *,
    kind: str,
    measures: int = 1,
) -> list[str]:
    """Tell what is wrong with bounds.

    Parameters
    ----------
    bands : Bands
        Where they come from.
    confidence : float
        That was asked for [1].
    independent, trials : ndarray of int
        How many trials each fit has, and how many of them are independent.
    kind : str
        What is independent.
    measures : int
        Intensity measures; shares were measured with one.

    Returns
    -------
    list of str
        A sentence; none where bounds are what they are called.
    """
    known = COVERAGE[bands]
    least, fewest = int(independent.min()), min(known)
    if least < fewest:
        which = "no bounds" if (independent < fewest).all() else "no bounds of some"
        return [f"There are {which}: {least} {kind} are too few, {fewest} are needed."]
    nominal = f"bounds of nominal {100.0 * confidence:g} % are too narrow"
    if bands is Bands.PROFILE and (independent < trials).any():
        return [f"The {nominal}: they take runs under one motion for independent."]
    if least >= max(known):
        return []
    if measures > 1:
        return [f"With {least} {kind} {nominal}."]
    size = max(one for one in known if one <= least)
    median, dispersion = (100.0 * share for share in known[size])
    return [
        f"With {least} {kind} {nominal}: of {size}, those of 95 % held the median in "
        f"{median:.0f} %, the dispersion in {dispersion:.0f} % of simulated samples."
    ]
