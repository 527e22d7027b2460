"""Choosing the set of motions whose spectra fit a target best."""

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Final

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from rockframe.arguments import checked_integer
from rockframe.errors import ComponentError
from rockframe.motion.quantities import ArrayLike
from rockframe.results.schema import with_variables
from rockframe.signals.arrays import Array
from rockframe.suggestions import with_hints
from rockframe.suites.candidates import Combination, candidates_of
from rockframe.suites.labelled_motions import LabelledMotions
from rockframe.suites.scaling import DEFAULT_BOUNDS, scaled_set
from rockframe.suites.target import TargetSpectrum
from rockframe.units import NOT_NEGATIVE, QuantityLike, RatioLike, to_ratio

_MAX_STARTS: Final = 20
_MAX_PASSES: Final = 50
_MIN_GAIN: Final = 1e-12
_REFERENCES: Final = (
    "Jayaram, Lin and Baker (2011), Earthquake Spectra 27, 797-815; Baker and Lee (2018), J. "
    "Earthquake Eng. 22, 708-723"
)


@with_hints()
def selection_for(
    suite: LabelledMotions,
    target: TargetSpectrum,
    count: int,
    *,
    periods: ArrayLike | Iterable[QuantityLike] | None = None,
    conditioned_on: ArrayLike | Iterable[QuantityLike] | None = None,
    bounds: tuple[RatioLike, RatioLike] | None = DEFAULT_BOUNDS,
    combination: str = Combination.EACH,
    spread_weight: RatioLike | None = None,
    per_event: int | None = None,
) -> xr.Dataset:
    """Select and scale motions so that the median and spread of their spectra fit a target.

    Parameters
    ----------
    target : TargetSpectrum
        Target for the median, and for the spread if it has one.
    count : int
        Number of motions, or of records if components are combined.
    periods, conditioned_on, combination : optional
        As for :meth:`scaling_to` [s].
    bounds : tuple of two float, or None
        Least and greatest factor; motions whose factor lies beyond are not chosen [1].
    spread_weight : float, optional
        Weight of the spread relative to the median; by default 1 if the target has a spread,
        else 0, so that only the median counts [1].
    per_event : int, optional
        Maximum number of motions of one earthquake, as far as earthquakes are known.

    Returns
    -------
    xarray.Dataset
        As for :meth:`scaling_to`, for the selected motions in the order of their misfits; and
        ``set_misfit`` [1], :eq:`eq-set-misfit`.

    Raises
    ------
    UnitsError
        Periods without a unit, or with one of another kind.
    ComponentError
        As for :meth:`scaling_to`; or fewer than `count` motions are within the bounds.

    Notes
    -----
    The search is greedy, after Jayaram, Lin and Baker (2011) and Baker and Lee (2018): the motion
    that gives the best fit is added to the set repeatedly, then each motion in turn is replaced by
    one that fits better, until there is none. The search starts from several first motions, and the
    best set is kept. As with any method of this kind, a better set may exist.

    Examples
    --------
    >>> import rockframe as rf
    >>> suite = rf.MotionSuite([rf.GroundMotion.stochastic(6, "20 km", seed=k) for k in range(9)])
    >>> target = rf.TargetSpectrum.eurocode_8("0.1 g_0")
    >>> found = suite.selection_for(target, 3)
    >>> found.sizes["motion"]
    3
    """
    owner = f"{type(suite).__name__}.selection_for"
    candidates = candidates_of(
        suite,
        target,
        periods=periods,
        conditioned_on=conditioned_on,
        bounds=bounds,
        combination=combination,
        owner=owner,
    )
    size = checked_integer(count, owner=owner, name="count", lowest=1)
    max_per_event = size
    if per_event is not None:
        max_per_event = checked_integer(per_event, owner=owner, name="per_event", lowest=1)
    deviates = bool(candidates.deviations.any())
    weight = float(deviates)
    if spread_weight is not None:
        weight = to_ratio(
            spread_weight, owner=owner, name="spread_weight", condition=NOT_NEGATIVE, example="1"
        )
    low, high = candidates.bounds
    allowed = np.flatnonzero((candidates.factors >= low) & (candidates.factors <= high))
    if allowed.size < size:
        total = len(candidates.labels)
        reason = f"{allowed.size} of {total} motions have factors from {low:g} to {high:g}"
        advice = "widen bounds, or lower count"
        if allowed.size == total:
            reason, advice = f"found {total} motion{'' if total == 1 else 's'}", "lower count"
        msg = f"{owner}: {reason}, too few for a set of {size}; {advice}"
        raise ComponentError(msg)
    search = _Search(
        candidates.residuals(candidates.factors)[allowed],
        candidates.deviations,
        weight,
        _event_numbers([candidates.events[place] for place in allowed.tolist()]),
        max_per_event,
    )
    chosen = search.best(size)
    if chosen is None:
        msg = (
            f"{owner}: at most {max_per_event} motions of an earthquake make no set of {size}; "
            "raise per_event, or lower count"
        )
        raise ComponentError(msg)
    misfits = np.sqrt((search.residuals[chosen] ** 2).mean(axis=1))
    places = allowed[np.array(chosen)[np.argsort(misfits, kind="stable")]]
    dataset = scaled_set(
        candidates,
        places,
        candidates.factors,
        title="Motions chosen for a target spectrum",
        chosen_from=len(candidates.labels),
        spread_weight=weight,
        references=_REFERENCES,
    )
    return with_variables(dataset, {"set_misfit": search.misfit(chosen)})


@dataclass(frozen=True)
class _Search:
    """Data and methods of the search for a set."""

    residuals: Array  # logarithms of scaled spectra over the target
    deviations: Array  # target of the spread
    weight: float  # of the spread
    events: NDArray[np.intp]  # earthquakes by numbers; -1 where it is not known
    max_per_event: int  # most motions of one earthquake

    def misfit(self, chosen: list[int]) -> float:
        """Compute :eq:`eq-set-misfit` of a set."""
        *others, last = chosen
        return float(self._misfits(others)[last])

    def best(self, count: int) -> list[int] | None:
        """Find a set of `count` candidates; None where there are too few earthquakes."""
        alone = np.argsort((self.residuals**2).mean(axis=1), kind="stable")
        sets: list[tuple[float, list[int]]] = []
        for first in alone[:_MAX_STARTS].tolist():
            chosen = self._grow(first, count)
            if chosen is not None:
                chosen = self._improve(chosen)
                sets.append((self.misfit(chosen), chosen))
        return min(sets)[1] if sets else None

    def _misfits(self, others: list[int]) -> Array:
        """Compute :eq:`eq-set-misfit` of a set with each candidate added in turn, shape (n,)."""
        chosen = self.residuals[others]
        count = len(others) + 1
        mean = (chosen.sum(axis=0) + self.residuals) / count
        squares = mean**2
        if self.weight > 0.0:
            spread = np.zeros_like(mean)
            if count > 1:
                total = (chosen**2).sum(axis=0) + self.residuals**2 - count * mean**2
                spread = np.sqrt(np.maximum(total, 0.0) / (count - 1))
            squares = squares + self.weight * (spread - self.deviations) ** 2
        return np.sqrt(squares.mean(axis=1))

    def _allowed(self, others: list[int]) -> NDArray[np.bool_]:
        """Return which candidates may be added to a set, shape (n,)."""
        free = np.ones(len(self.residuals), dtype=bool)
        free[others] = False
        numbers, counts = np.unique(self.events[others], return_counts=True)
        full = numbers[(counts >= self.max_per_event) & (numbers >= 0)]
        return free & ~np.isin(self.events, full)

    def _grow(self, first: int, count: int) -> list[int] | None:
        chosen = [first]
        while len(chosen) < count:
            misfits = np.where(self._allowed(chosen), self._misfits(chosen), np.inf)
            place = int(np.argmin(misfits))
            if not np.isfinite(misfits[place]):
                return None
            chosen.append(place)
        return chosen

    def _improve(self, chosen: list[int]) -> list[int]:
        misfit = self.misfit(chosen)
        for _ in range(_MAX_PASSES):
            before = misfit
            for slot in range(len(chosen)):
                others = chosen[:slot] + chosen[slot + 1 :]
                misfits = np.where(self._allowed(others), self._misfits(others), np.inf)
                place = int(np.argmin(misfits))
                if misfits[place] < misfit * (1.0 - _MIN_GAIN):
                    misfit = float(misfits[place])
                    chosen = [*others[:slot], place, *others[slot:]]
            if misfit >= before:
                break
        return chosen


def _event_numbers(events: list[str]) -> NDArray[np.intp]:
    numbers = {event: k for k, event in enumerate(dict.fromkeys(filter(None, events)))}
    return np.array([numbers.get(event, -1) for event in events], dtype=np.intp)
