"""Held-out tests: predictions of blocks and of a regression for motions outside their fit."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from benchmarks import granite_fit as fit
from benchmarks.granite_blocks import Shaking, overturns
from benchmarks.granite_programme import Programme


@dataclass(frozen=True)
class Bench:
    """Data of all fits: the tests in the form of blocks and of the regression."""

    programme: Programme
    shakings: list[Shaking]
    groups: np.ndarray  # number of each test's motion
    peak: np.ndarray  # of the acceleration [m s^-2]
    features: np.ndarray  # ln PGA, ln(PGV/PGA), shape (tests, 2)
    drawn: list[np.ndarray]  # tests of resampled motions

    @classmethod
    def of(cls, programme: Programme) -> Bench:
        """Prepare the tests."""
        shakings = [Shaking.by(motion) for motion in programme.motions]
        _, groups = np.unique(programme.names, return_inverse=True)
        peak, velocity = programme.peaks()
        features = np.column_stack([np.log(peak), np.log(velocity / peak)])
        return cls(programme, shakings, groups, peak, features, fit.resamples(groups))

    @property
    def motions(self) -> range:
        """The motions' numbers."""
        return range(self.groups.max() + 1)

    def regressed(self, fell: np.ndarray) -> np.ndarray:
        """Return probabilities by the regression of all other motions' tests."""
        chances = np.zeros(len(fell))
        for motion in self.motions:
            tests, others = self.groups == motion, self.groups != motion
            coefficients = fit.regression(self.features[others], fell[others])
            chances[tests] = fit.regressed(coefficients, self.features[tests])
        return chances

    def share_of_others(self, fell: np.ndarray) -> np.ndarray:
        """Return for each test the share of specimens that fell under all other motions."""
        return np.array([fell[self.groups != motion].mean() for motion in self.groups])


@dataclass(frozen=True)
class Predictions:
    """Predictions of the tests by one block, by its scatter, by an ensemble and by regression."""

    said: np.ndarray
    chances: np.ndarray
    ensemble: np.ndarray  # share that overturns
    regressed: np.ndarray

    @property
    def of_ensemble(self) -> np.ndarray:
        """Probabilities by the ensemble, never exactly 0 or 1."""
        return (self.ensemble * fit.BLOCKS + 0.5) / (fit.BLOCKS + 1.0)


@dataclass(frozen=True)
class Study:
    """One specimen: its verdicts, its fits and their predictions."""

    fell: np.ndarray
    search: fit.Search
    seen: Predictions
    held_out: Predictions

    @classmethod
    def of(cls, bench: Bench, search: fit.Search, fell: np.ndarray) -> Study:
        """Fit to all tests, and to those of all motions but one, for each motion."""
        return cls(fell, search, _with_all(bench, search, fell), _held_out(bench, search, fell))


def _with_all(bench: Bench, search: fit.Search, fell: np.ndarray) -> Predictions:
    best = search.best()
    said = overturns(best.shape, bench.shakings)
    ensemble = np.mean([overturns(one, bench.shakings) for one in search.ensemble()], axis=0)
    coefficients = fit.regression(bench.features, fell)
    regressed = fit.regressed(coefficients, bench.features)
    return Predictions(said, search.chances(best), ensemble, regressed)


def _held_out(bench: Bench, search: fit.Search, fell: np.ndarray) -> Predictions:
    said = np.zeros(len(fell), dtype=bool)
    chances, ensemble = np.zeros(len(fell)), np.zeros(len(fell))
    for motion in bench.motions:
        tests = np.flatnonzero(bench.groups == motion)
        shakings = [bench.shakings[one] for one in tests]
        best = search.best(motion)
        said[tests] = overturns(best.shape, shakings)
        chances[tests] = search.chances(best)[tests]
        drawn = search.ensemble(motion)
        ensemble[tests] = np.mean([overturns(one, shakings) for one in drawn], axis=0)
    return Predictions(said, chances, ensemble, bench.regressed(fell))
