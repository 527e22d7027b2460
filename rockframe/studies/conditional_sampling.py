"""Subset simulation: a small probability as a product of conditional ones that are not small.

Samples are standard normal numbers; the caller transforms them to parameters.
"""

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from rockframe.signals.arrays import AnyArray, Array
from rockframe.studies.confidence import clopper_pearson

DemandFunction = Callable[[str, Array], Array]
"""Function of the name of a level and its samples, a row each, that runs them; gives the demand of
each, NaN where a run has no verdict."""

_INITIAL_STEP: Final = 0.6
"""Step size of the first chains (Papaioannou et al., 2015)."""
_TARGET_ACCEPTANCE: Final = 0.44
"""Share of accepted candidates at which chains mix best (Papaioannou et al., 2015)."""


@dataclass(frozen=True, eq=False)
class Level:
    """One level: samples drawn given that the threshold of the level before is exceeded."""

    demands: Array  # NaN where a run has none, which occurs at the first level only
    origins: AnyArray  # number of each one's run, counted over all levels
    families: AnyArray  # number of the sample of the first level from which each descends
    threshold: float  # demand from which on a sample counts as exceeding
    chains: int  # number of chains
    acceptance: float  # share of accepted candidates; NaN at the first level [1]
    runs: int
    left_out: int  # runs without a verdict

    @property
    def exceeds(self) -> AnyArray:
        """Which samples exceed the threshold."""
        return self.demands >= self.threshold

    @property
    def known_count(self) -> int:
        """Number of samples that have a demand."""
        return int((~np.isnan(self.demands)).sum())

    @property
    def share(self) -> float:
        """Share of the samples that exceed the threshold [1]."""
        return int(self.exceeds.sum()) / self.known_count if self.known_count else math.nan


def subset_levels(
    demand: DemandFunction,
    size: int,
    limit: float,
    *,
    count: int,
    share: float,
    max_levels: int,
    rng: np.random.Generator,
) -> Iterator[Level]:
    """Sample level by level, until a sufficient share of the samples exceeds the limit.

    Each level has chains, :eq:`eq-conditional-candidate`, that start at the samples beyond the last
    threshold. That of the last level is the limit, exceeded or not.
    """
    scores = rng.standard_normal((count, size))
    demands = demand("level 01", scores)
    origins: AnyArray = np.arange(count)
    families, total_runs = origins, count
    chains, acceptance, runs, step = count, math.nan, count, _INITIAL_STEP
    left_out = int(np.isnan(demands).sum())
    for number in range(1, max_levels + 1):
        threshold = limit if number == max_levels else _threshold(demands, share, limit)
        level = Level(demands, origins, families, threshold, chains, acceptance, runs, left_out)
        yield level
        if threshold >= limit:
            return
        (seeds,) = np.nonzero(level.exceeds)
        chains, length = len(seeds), max(2, round(count / len(seeds)))
        runs, left_out = chains * (length - 1), 0
        # all chains make a step together, so that their runs can be parallel
        states = [(scores[seeds], demands[seeds], origins[seeds])]
        acceptance_rates: list[float] = []
        for number_of_step in range(1, length):
            scores, demands, origins = states[-1]
            noise = rng.standard_normal(scores.shape)
            candidates = math.sqrt(1.0 - step**2) * scores + step * noise
            part = f"level {number + 1:02d} step {number_of_step:02d}"
            found = demand(part, candidates)
            accepted = found >= threshold
            left_out += int(np.isnan(found).sum())
            states.append((
                np.where(accepted[:, None], candidates, scores),
                np.where(accepted, found, demands),
                np.where(accepted, total_runs + np.arange(chains), origins),
            ))  # fmt: skip
            total_runs += chains
            acceptance_rates.append(float(accepted.mean()))
            excess = acceptance_rates[-1] - _TARGET_ACCEPTANCE
            step = min(1.0, step * math.exp(excess / math.sqrt(number_of_step)))
        scores, demands, origins = map(np.concatenate, zip(*states, strict=True))
        families = np.tile(families[seeds], length)
        acceptance = float(np.mean(acceptance_rates))


def _threshold(demands: Array, share: float, limit: float) -> float:
    """Return the demand that a share of the samples reaches, halfway between two of them."""
    values, counts = np.unique(demands[~np.isnan(demands)], return_counts=True)
    if len(values) < 2:
        return limit
    # equal demands are not separated: the possible share with the nearest logarithm is used
    above = counts[::-1].cumsum()[::-1][1:]  # samples from the second value on, the third, ...
    place = int(np.argmin(np.abs(np.log(above / (share * counts.sum())))))
    below, upper = float(values[place]), float(values[place + 1])
    return min(limit, 0.5 * (below + upper) if math.isfinite(upper) else upper)


def subset_probability(levels: Sequence[Level]) -> float:
    """Return the probability that the last threshold is exceeded, :eq:`eq-subset-product` [1]."""
    return math.prod(level.share for level in levels)


def family_shares(levels: Sequence[Level]) -> Array:
    """Return share of each first sample's descendants in those beyond the last threshold [1]."""
    last = levels[-1]
    count = np.bincount(last.families[last.exceeds], minlength=len(levels[0].demands))
    return count[~np.isnan(levels[0].demands)] / max(int(count.sum()), 1)


def _family_variance(levels: Sequence[Level]) -> float:
    """Return the relative variance between families, :eq:`eq-subset-families` [1]."""
    shares = family_shares(levels)
    count = len(shares)
    return max(count * float((shares**2).sum()) - 1.0, 0.0) / (count - 1)


def subset_variation(levels: Sequence[Level]) -> float:
    """Return the coefficient of variation of the probability, :eq:`eq-subset-variation` [1]."""
    if not subset_probability(levels) > 0.0:
        return math.inf
    squared = _family_variance(levels)
    if len(levels) > 1:  # that of a single level is that of a binomial share
        squared = squared / (1.0 - squared) if squared < 1.0 else math.inf
    return math.sqrt(squared)


def subset_bounds(levels: Sequence[Level], confidence: float) -> tuple[float, float]:
    """Return bounds of the probability, :eq:`eq-subset-bounds` [1]."""
    from scipy.stats import t

    if len(levels) == 1:  # of independent cases
        first = levels[0]
        exceeding = np.array(first.exceeds.sum())
        lower, upper = clopper_pearson(exceeding, np.array(first.known_count), confidence)
        return float(lower), float(upper)
    if not subset_probability(levels) > 0.0:
        return 0.0, subset_bounds(levels[:-1], confidence)[1]
    squared = _family_variance(levels)
    dof = max(1.0 / squared - 1.0, 1.0) if squared > 0.0 else math.inf
    half_width = float(t.ppf(0.5 * (1.0 + confidence), dof))
    factor = math.exp(half_width * math.sqrt(math.log1p(squared)))
    probability = subset_probability(levels)
    return probability / factor, min(1.0, probability * factor)


def sample_weights(levels: Sequence[Level]) -> list[Array]:
    """Return the probability that each sample represents, :eq:`eq-subset-weights` [1]."""
    weights: list[Array] = []
    probability = 1.0
    for number, level in enumerate(levels, start=1):
        is_counted = ~np.isnan(level.demands)
        if number < len(levels):  # the next level represents those beyond the threshold
            is_counted &= ~level.exceeds
        weights.append(np.where(is_counted, probability / max(level.known_count, 1), 0.0))
        probability *= level.share
    return weights
