"""Candidates of a selection: motions or pairs, their spectra, and their scale factors."""

from collections.abc import Iterable
from dataclasses import dataclass
from enum import StrEnum
from typing import Final

import numpy as np

from rockframe.arguments import checked_choice, checked_list
from rockframe.errors import ComponentError, short_repr
from rockframe.measures import rotated_spectrum
from rockframe.measures.common import read_inputs
from rockframe.measures.response import checked_periods, shortest_positive_period, spectra_of
from rockframe.motion.processing.samples import warn_of_coarse_samples
from rockframe.motion.quantities import ArrayLike
from rockframe.signals.arrays import Array
from rockframe.suites.labelled_motions import LabelledMotions
from rockframe.suites.target import TargetSpectrum, check_target
from rockframe.units import PERIOD, POSITIVE, QuantityLike, RatioLike, to_ratio

_DEFAULT_BAND: Final = (0.1, 4.0)
_DEFAULT_COUNT: Final = 40


class Combination(StrEnum):
    """The spectrum that is fitted: that of each motion, or a combined one of both components."""

    EACH = "each"
    GEOMETRIC_MEAN = "geometric mean"
    MEDIAN = "RotD50"
    GREATEST = "RotD100"


_PAIR_VARIABLES: Final = {
    Combination.GEOMETRIC_MEAN: "geometric_mean_acceleration",
    Combination.MEDIAN: "median_rotated_acceleration",
    Combination.GREATEST: "greatest_rotated_acceleration",
}


@dataclass(frozen=True)
class Candidates:
    """Spectra and scale factors of motions or records, with the target spectrum."""

    # of n motions, or of n records where both components are combined
    labels: tuple[str, ...]
    periods: Array  # periods at which spectra are compared [s]
    log_spectra: Array  # of the spectra, not scaled
    log_target: Array  # logarithm of the target
    deviations: Array  # its standard deviations
    factors: Array  # by which each is scaled, whatever the bounds [1]
    bounds: tuple[float, float]  # least and greatest factor
    events: tuple[str, ...]  # earthquake of each, empty if unknown
    attributes: dict[str, str | float | int]  # attributes of results

    def residuals(self, factors: Array) -> Array:
        """Return the logarithms of scaled spectra over the target, shape (n, k)."""
        return self.log_spectra + np.log(factors)[:, None] - self.log_target


def candidates_of(
    suite: LabelledMotions,
    target: object,
    *,
    periods: ArrayLike | Iterable[QuantityLike] | None,
    conditioned_on: ArrayLike | Iterable[QuantityLike] | None,
    bounds: tuple[RatioLike, RatioLike] | None,
    combination: str,
    owner: str,
) -> Candidates:
    """Check the arguments of a selection, and compute the spectra that it needs."""
    target = check_target(target, owner=owner)
    kind = checked_choice(Combination, combination, owner=owner, name="combination")
    seconds = default_periods(target) if periods is None else checked_periods(periods, owner=owner)
    fixed = seconds if conditioned_on is None else checked_periods(conditioned_on, owner=owner)
    every = np.unique(np.concatenate([seconds, fixed]))
    if periods is not None or conditioned_on is not None:
        every_period = fixed if periods is None else every
        signals = [motion.si.horizontal for motion in suite.values()]
        warn_of_coarse_samples(signals, shortest_positive_period(every_period), owner=owner)
    log_target = np.log(target.at_seconds(every, owner=owner))
    labels, spectra, events = _spectra(suite, kind, every, target.damping_ratio, owner)
    motionless = [
        label for label, row in zip(labels, spectra, strict=True) if not (row > 0.0).all()
    ]
    if motionless:
        msg = f"{owner}: {motionless[0]!r} has no acceleration, and no factor brings it to a target"
        raise ComponentError(msg)
    logarithms = np.log(spectra)
    conditioned, compared = (np.searchsorted(every, group) for group in (fixed, seconds))
    factors = np.exp((log_target[conditioned] - logarithms[:, conditioned]).mean(axis=1))
    return Candidates(
        tuple(labels),
        seconds,
        logarithms[:, compared],
        log_target[compared],
        target.deviations_at(seconds),
        factors,
        _read_bounds(bounds, owner),
        tuple(events),
        {
            "target": target.name,
            "damping_ratio": target.damping_ratio,
            "combination": str(kind),
            "conditioned_on": _conditioning_words(conditioned_on is not None, fixed),
        },
    )


def default_periods(target: TargetSpectrum) -> Array:
    """Return the periods at which spectra are compared with a target by default [s]."""
    low, high = (float(np.clip(limit, *target.limits)) for limit in _DEFAULT_BAND)
    return np.geomspace(low, high, _DEFAULT_COUNT) if high > low else np.array([low])


def _read_bounds(items: tuple[RatioLike, RatioLike] | None, owner: str) -> tuple[float, float]:
    if items is None:
        return 0.0, np.inf
    values = checked_list(items, owner=owner, name="bounds", of="factors")
    if len(values) == 2:
        low, high = (
            to_ratio(bound, owner=owner, name="bounds", condition=POSITIVE, example="(0.25, 4)")
            for bound in values
        )
        if low <= high:
            return low, high
    msg = f"{owner}: bounds must be the least and the greatest factor, got {short_repr(items)}"
    raise ComponentError(msg)


def _spectra(
    suite: LabelledMotions, kind: Combination, seconds: Array, damping_ratio: float, owner: str
) -> tuple[list[str], Array, list[str]]:
    with_unit = (seconds, str(PERIOD.unit))
    if kind is Combination.EACH:
        inputs = read_inputs(suite, "horizontal", owner=owner)
        spectra = spectra_of(inputs, seconds, np.array([damping_ratio]))[
            "pseudo_spectral_acceleration"
        ]
        motions = dict(suite)
    else:
        pairs = suite.pairs
        if not pairs:
            msg = (
                f"{owner}: combination={str(kind)!r} needs both horizontal components of records, "
                "and the suite has no pair"
            )
            raise ComponentError(msg)
        spectra = rotated_spectrum(pairs, with_unit, damping_ratio)[_PAIR_VARIABLES[kind]]
        motions = {record: pair.first for record, pair in pairs.items()}
    events = [str(motion.metadata.get("event", "")) for motion in motions.values()]
    return list(motions), spectra.isel(damping_ratio=0).to_numpy(), events


def _conditioning_words(value: bool, fixed: Array) -> str:
    if not value:
        return "the mean logarithm over all periods"
    if fixed.size == 1:
        return f"the pseudo-spectral acceleration at {fixed[0]:.6g} s"
    return (
        f"the average spectral acceleration of {fixed.size} periods from {fixed[0]:.6g} s to "
        f"{fixed[-1]:.6g} s"
    )
