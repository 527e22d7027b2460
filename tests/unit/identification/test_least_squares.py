"""Errors of fitted values: those of linear regression, from its definition."""

import numpy as np
import pytest
from scipy import stats

from rockframe.identification.fitting import Solution, uncertainty_of


@pytest.mark.parametrize(("count", "size"), [(4, 2), (6, 3), (30, 2)])
def test_errors_are_those_of_linear_regression(count, size):
    """With few residuals it shows whether they are counted, or their degrees of freedom."""
    rng = np.random.default_rng(count)
    jacobian = rng.normal(size=(count, size))
    measured = jacobian @ np.arange(1.0, size + 1.0) + 0.1 * rng.normal(size=count)
    values, squares, *_ = np.linalg.lstsq(jacobian, measured, rcond=None)
    every = np.ones(size, dtype=bool)
    solution = Solution(values, jacobian, measured - jacobian @ values, 1, 1, ~every, every)
    found = uncertainty_of(solution, 0.9)
    freedom = count - size
    covariance = squares.item() / freedom * np.linalg.inv(jacobian.T @ jacobian)
    assert found.standard_error == pytest.approx(np.sqrt(np.diag(covariance)), rel=1e-10)
    assert found.reach == pytest.approx(stats.t.ppf(0.95, freedom), rel=1e-10)
    scale = np.sqrt(np.diag(covariance))
    assert found.correlation == pytest.approx(covariance / np.outer(scale, scale), abs=1e-9)
