"""Correlated spreads: marginal distributions, and rank correlations in closed form."""

import math

import numpy as np
import pytest
from scipy import stats

import rockframe as rf
from rockframe.errors import ComponentError
from rockframe.studies.probability import (
    Sampling,
    draw_sample,
    impose_correlation,
    read_correlation,
)

SYSTEM = rf.System(rf.Block(width="0.5 m", height="2 m", mass="400 kg"))
PULSE = rf.GroundMotion.sine_pulse("3 m/s^2", "1 Hz")
SPREAD = {
    "width": ("normal", "0.5 m", "0.02 m"),
    "height": ("lognormal", "2 m", 0.1),
    "scale": ("uniform", 0.5, 1.5),
}
PAIRS = {("width", "height"): 0.8, ("scale", "width"): -0.5}
MATRIX = np.array([[1.0, 0.8, -0.5], [0.8, 1.0, 0.0], [-0.5, 0.0, 1.0]])


def test_methods_of_sampling_fill_the_unit_square_as_defined():
    """64 cases: strata of each number, and the boxes of a net, 8 by 8, that only Sobol's fill."""
    filled = {}
    for sampling in Sampling:
        sample = draw_sample((None,), 64, sampling, 3)
        assert sample.shape == (64, 2)
        strata = [len(set(np.floor(64 * column).tolist())) == 64 for column in sample.T]
        boxes = len({tuple(row) for row in np.floor(8 * sample).tolist()})
        filled[sampling] = all(strata), any(strata), boxes == 64
    assert filled[Sampling.RANDOM] == (False, False, False)
    assert filled[Sampling.LATIN] == (True, True, False)
    assert filled[Sampling.SOBOL] == (True, True, True)


def test_correlation_takes_abbreviations_of_parameters():
    names = ["width", "peak_ground_acceleration"]
    matrix = read_correlation({("PGA", "width"): 0.3}, names, owner="test")
    assert matrix.tolist() == [[1.0, 0.3], [0.3, 1.0]]


@pytest.mark.parametrize("sampling", Sampling)
def test_imposed_correlation_preserves_marginal_distributions(sampling):
    count = 4096
    cube = impose_correlation(
        draw_sample((None,) * 2, count, sampling, 3), MATRIX, stratified=sampling is Sampling.LATIN
    )
    for column in cube.T:
        assert stats.kstest(column, "uniform").pvalue > 1e-3
    found = stats.spearmanr(cube).statistic
    expected = 6.0 / math.pi * np.arcsin(0.5 * MATRIX)
    np.testing.assert_allclose(found, expected, atol=3.0 / math.sqrt(count))
    if sampling is Sampling.LATIN:  # one value in each stratum
        strata = np.sort(np.floor(cube * count).astype(int), axis=0)
        assert np.array_equal(strata, np.tile(np.arange(count)[:, None], 3))


def test_cases_have_requested_distributions_and_correlations():
    found = rf.probability_of_overturning(
        SYSTEM, PULSE, spread=SPREAD, correlation=PAIRS, cases=600, free_vibration="1 s",
        accuracy="fast", progress=False,
    )  # fmt: skip
    values = [found[name].values for name in SPREAD]
    laws = [stats.norm(0.5, 0.02), stats.lognorm(0.1, scale=2.0), stats.uniform(0.5, 1.0)]
    for sample, law in zip(values, laws, strict=True):
        assert stats.kstest(sample, law.cdf).pvalue > 0.5  # less deviation than at random
    scores = np.stack([stats.norm.ppf(law.cdf(v)) for law, v in zip(laws, values, strict=True)])
    np.testing.assert_allclose(np.corrcoef(scores), MATRIX, atol=0.08)
    # normal and lognormal: the correlation with the logarithm of the lognormal
    assert np.corrcoef(values[0], np.log(values[1]))[0, 1] == pytest.approx(0.8, abs=0.05)
    again = rf.probability_of_overturning(
        SYSTEM, PULSE, spread=SPREAD, correlation=MATRIX, cases=600, free_vibration="1 s",
        accuracy="fast", progress=False,
    )  # fmt: skip
    assert np.array_equal(found.width, again.width)


def test_correlated_probability_matches_monte_carlo():
    """Under a pulse much longer than the block's time scale, slender blocks overturn."""
    slow = rf.GroundMotion.half_sine_pulse("2.6 m/s^2", "40 s")
    spread = {"width": ("normal", "0.5 m", "0.04 m"), "height": ("normal", "2 m", "0.16 m")}
    shares = {}
    for rho in (-0.9, 0.9):
        found = rf.probability_of_overturning(
            SYSTEM, slow, spread=spread, correlation={("width", "height"): rho}, cases=400,
            accuracy="fast", progress=False,
        )  # fmt: skip
        rng = np.random.default_rng(5)
        z = rng.multivariate_normal([0, 0], [[1, rho], [rho, 1]], 200_000)
        ratio = (0.5 + 0.04 * z[:, 0]) / (2.0 + 0.16 * z[:, 1])
        expected = (9.80665 * ratio < 2.6).mean()  # it lasts long enough to overturn
        shares[rho] = found.overturning_probability.item()
        assert shares[rho] == pytest.approx(expected, abs=3 * math.sqrt(0.25 / 400))
    assert shares[-0.9] < shares[0.9] - 0.1


@pytest.mark.parametrize(
    ("correlation", "words"),
    [
        ({("width", "depth"): 0.5}, "pairs of two of width, height, scale"),
        ({("width", "height"): 1.0}, "between -1 and 1"),
        (np.eye(2), "a symmetric matrix of 3 rows"),
        ([[1, 0.9, -0.9], [0.9, 1, 0.9], [-0.9, 0.9, 1]], "not positive definite"),
    ],
)
def test_invalid_correlations_are_refused(correlation, words):
    with pytest.raises(ComponentError, match=words):
        rf.probability_of_overturning(
            SYSTEM, PULSE, spread=SPREAD, correlation=correlation, cases=10
        )
