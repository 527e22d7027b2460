"""Probabilities of overturning by effective blocks and by regression: fits and scores."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple, TypeAlias

import numpy as np
from benchmarks.granite_blocks import ANGLES, Shape
from scipy.optimize import minimize
from scipy.special import expit
from scipy.stats import binomtest

MEDIANS = np.geomspace(0.045, 0.27, 73)
SPREADS = np.geomspace(0.04, 0.5, 16)
"""Candidate medians [rad] and spreads of the overturning angle."""
SURELY = 1e-9
"""Substitute for probability zero, whose logarithm is infinite."""
BLOCKS = 50
"""Number of blocks of an ensemble."""
RESAMPLES = 4000
Score: TypeAlias = Callable[[np.ndarray, np.ndarray], float]
"""A score of predictions and outcomes."""


def shares(median: np.ndarray, spread: np.ndarray) -> np.ndarray:
    """Return share of blocks about each of `ANGLES`, over a last axis, :eq:`eq-scattering-block`.

    The logarithm of the angle follows the logistic distribution. Beyond the ends of `ANGLES`
    blocks have the verdicts of those at the ends.
    """
    inner = np.log(ANGLES[1:] * ANGLES[:-1]) / 2.0
    edges = np.concatenate([[-np.inf], inner, [np.inf]])
    median, spread = np.asarray(median)[..., None], np.asarray(spread)[..., None]
    return np.diff(expit((edges - np.log(median)) / spread), axis=-1)


def log_likelihoods(chances: np.ndarray, fell: np.ndarray) -> np.ndarray:
    """Return the logarithm of the probability of each outcome."""
    chances = np.clip(chances, SURELY, 1.0 - SURELY)
    return np.log(np.where(fell, chances, 1.0 - chances))


class Fit(NamedTuple):
    """A block of a median angle, and the scatter of angles about it from test to test."""

    shape: Shape
    spread: float
    pair: int


@dataclass(frozen=True)
class Search:
    """The likelihood of all candidates, by motion.

    Parameters
    ----------
    pairs : ndarray, shape (pairs, 2)
        Radii and restitutions.
    overturned : ndarray of bool, shape (pairs, angles, tests)
        Verdicts of the blocks.
    groups : ndarray of int, shape (tests,)
        Number of each test's motion.
    likelihood : ndarray, shape (pairs, medians, spreads, groups)
        Logarithm of the likelihood.
    """

    pairs: np.ndarray
    overturned: np.ndarray
    groups: np.ndarray
    likelihood: np.ndarray

    @classmethod
    def of(
        cls, pairs: np.ndarray, overturned: np.ndarray, groups: np.ndarray, fell: np.ndarray
    ) -> Search:
        """Evaluate all medians and spreads with all pairs."""
        weights = shares(MEDIANS[:, None], SPREADS)
        belongs = groups[:, None] == np.arange(groups.max() + 1)
        likelihood = [log_likelihoods(weights @ one, fell) @ belongs for one in overturned]
        return cls(pairs, overturned, groups, np.array(likelihood))

    def without(self, group: int | None) -> np.ndarray:
        """Return the likelihood of all motions but one."""
        total = self.likelihood.sum(axis=-1)
        return total if group is None else total - self.likelihood[..., group]

    def best(self, group: int | None = None) -> Fit:
        """Return the likeliest fit to all motions but one."""
        likelihood = self.without(group)
        return self._fit(np.unravel_index(likelihood.argmax(), likelihood.shape))

    def _fit(self, place: tuple[int, ...]) -> Fit:
        pair, median, spread = (int(one) for one in place)
        shape = Shape.of(self.pairs[pair].tolist(), float(MEDIANS[median]))
        return Fit(shape, float(SPREADS[spread]), pair)

    def chances(self, fit: Fit) -> np.ndarray:
        """Return every test's probability of overturning."""
        return shares(fit.shape.angle, fit.spread) @ self.overturned[fit.pair]

    def ensemble(self, group: int | None = None, blocks: int = BLOCKS) -> list[Shape]:
        """Draw blocks by the likelihood of all motions but one; always the same ones.

        Pairs, medians and spreads are drawn by their likelihood, and each block's angle by the
        spread drawn with it.
        """
        likelihood = self.without(group)
        weight = np.exp(likelihood - likelihood.max()).ravel()
        middles = (np.arange(blocks) + 0.5) / blocks
        drawn = np.searchsorted(np.cumsum(weight) / weight.sum(), middles)
        ranks = np.random.default_rng(1).permutation(middles)
        shapes = []
        for place, rank in zip(drawn, ranks.tolist(), strict=True):
            shape, spread, _ = self._fit(np.unravel_index(place, likelihood.shape))
            factor = (rank / (1.0 - rank)) ** spread
            shapes.append(shape._replace(angle=shape.angle * factor))
        return shapes


def regression(features: np.ndarray, fell: np.ndarray) -> np.ndarray:
    """Return the coefficients of the likeliest logistic regression; the first is the constant."""
    matrix = np.column_stack([np.ones(len(fell)), features])

    def loss(coefficients: np.ndarray) -> tuple[float, np.ndarray]:
        chances = expit(matrix @ coefficients)
        return -log_likelihoods(chances, fell).sum(), matrix.T @ (chances - fell)

    return minimize(loss, np.zeros(matrix.shape[1]), jac=True, method="BFGS").x


def regressed(coefficients: np.ndarray, features: np.ndarray) -> np.ndarray:
    """Return probabilities by regression, :eq:`eq-overturning-regression`."""
    return expit(coefficients[0] + features @ coefficients[1:])


class Confusion(NamedTuple):
    """Numbers of tests by prediction and outcome."""

    fell_as_said: int
    fell_unsaid: int
    stood_unsaid: int
    stood_as_said: int

    @classmethod
    def of(cls, verdict: np.ndarray, fell: np.ndarray) -> Confusion:
        """Count tests."""
        counts = (verdict & fell, ~verdict & fell, verdict & ~fell, ~verdict & ~fell)
        return cls(*(int(one.sum()) for one in counts))


def accuracy(verdict: np.ndarray, fell: np.ndarray) -> float:
    """Return the share of right verdicts."""
    return float((verdict == fell).mean())


def balanced_accuracy(verdict: np.ndarray, fell: np.ndarray) -> float:
    """Return the mean of the shares of right verdicts among tests that fell and that stood."""
    return float(0.5 * (verdict[fell].mean() + (~verdict[~fell]).mean()))


def log_loss(chances: np.ndarray, fell: np.ndarray) -> float:
    """Return the mean of minus the logarithm of the outcomes' probabilities."""
    return float(-log_likelihoods(chances, fell).mean())


def brier(chances: np.ndarray, fell: np.ndarray) -> float:
    """Return the mean squared difference of probability and outcome."""
    return float(((chances - fell) ** 2).mean())


def resamples(groups: np.ndarray) -> list[np.ndarray]:
    """Draw motions with replacement, many times, and give the numbers of their tests."""
    members = [np.flatnonzero(groups == one) for one in range(groups.max() + 1)]
    draws = np.random.default_rng(0).integers(len(members), size=(RESAMPLES, len(members)))
    return [np.concatenate([members[one] for one in drawn]) for drawn in draws]


def interval(
    score: Score,
    predicted: np.ndarray,
    fell: np.ndarray,
    drawn: list[np.ndarray],
    reference: np.ndarray | None = None,
) -> tuple[float, float]:
    """Return the 95 % interval of a score, or of its difference from that of a reference."""
    scores = [score(predicted[tests], fell[tests]) for tests in drawn]
    if reference is not None:
        others = [score(reference[tests], fell[tests]) for tests in drawn]
        scores = np.subtract(scores, others)
    low, high = np.quantile(scores, [0.025, 0.975])
    return float(low), float(high)


class Bin(NamedTuple):
    """Tests with similar predictions: their number, and how many fell."""

    tests: int
    fell: int
    predicted: float
    observed: float
    low: float
    high: float


def calibration(chances: np.ndarray, fell: np.ndarray, edges: np.ndarray) -> list[Bin]:
    """Compare predicted and observed shares, the latter with 95 % Clopper-Pearson intervals."""
    place = np.clip(np.searchsorted(edges, chances, side="right") - 1, 0, len(edges) - 2)
    bins = []
    for one in range(len(edges) - 1):
        chosen = place == one
        tests, down = int(chosen.sum()), int(fell[chosen].sum())
        if tests:
            bounds = binomtest(down, tests).proportion_ci(method="exact")
            mean = float(chances[chosen].mean())
            bins.append(Bin(tests, down, mean, down / tests, bounds.low, bounds.high))
    return bins


def fewest_errors(strength: np.ndarray, groups: np.ndarray, fell: np.ndarray) -> int:
    """Return errors of the best bound on the strength, chosen for each motion with hindsight."""
    errors = 0
    for one in range(groups.max() + 1):
        order = np.argsort(strength[groups == one])
        down = fell[groups == one][order]
        stood_above = np.concatenate([np.cumsum((~down)[::-1])[::-1], [0]])
        errors += int((np.concatenate([[0], np.cumsum(down)]) + stood_above).min())
    return errors
