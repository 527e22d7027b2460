"""Errors of fitted values agree with linear regression."""

import numpy as np
import pytest
from scipy import stats

from rockframe.identification.fitting import Solution, fit_peaks, minimize, uncertainty_of
from rockframe.identification.measured import MeasuredPeaks
from rockframe.identification.prediction import Unknown


@pytest.mark.parametrize(("count", "size"), [(4, 2), (6, 3), (30, 2)])
def test_errors_are_those_of_linear_regression(count, size):
    """With few residuals, their number and the degrees of freedom differ clearly."""
    rng = np.random.default_rng(count)
    jacobian = rng.normal(size=(count, size))
    measured = jacobian @ np.arange(1.0, size + 1.0) + 0.1 * rng.normal(size=count)
    values, squares, *_ = np.linalg.lstsq(jacobian, measured, rcond=None)
    all_true = np.ones(size, dtype=bool)
    solution = Solution(
        values, jacobian, measured - jacobian @ values, 1, 1, ~all_true, all_true, count - size
    )
    uncertainty = uncertainty_of(solution, 0.9)
    freedom = count - size
    hat = jacobian @ np.linalg.inv(jacobian.T @ jacobian) @ jacobian.T
    assert solution.leverages() == pytest.approx(np.diag(hat), rel=1e-9)
    covariance = squares.item() / freedom * np.linalg.inv(jacobian.T @ jacobian)
    assert uncertainty.standard_error == pytest.approx(np.sqrt(np.diag(covariance)), rel=1e-10)
    assert uncertainty.half_width == pytest.approx(stats.t.ppf(0.95, freedom), rel=1e-10)
    scale = np.sqrt(np.diag(covariance))
    assert uncertainty.correlation == pytest.approx(covariance / np.outer(scale, scale), abs=1e-9)


def test_unknowns_that_are_not_told_apart_have_neither_error_nor_correlation():
    """Two unknowns have one effect, the third one of its own."""
    jacobian = np.array([[1.0, 1.0, 0.0], [2.0, 2.0, 0.0], [3.0, 3.0, 1.0], [1.0, 1.0, 2.0]])
    residuals, all_true = np.array([0.1, 0.0, -0.1, 0.1]), np.ones(3, dtype=bool)
    found = uncertainty_of(
        Solution(np.zeros(3), jacobian, residuals, 1, 1, ~all_true, all_true, 1), 0.95
    )
    # by hand: the common effect (1, 2, 3, 1) takes 25/15 of the third one's square of 5
    expected = np.sqrt(0.03 / (5.0 - 25.0 / 15.0))
    np.testing.assert_allclose(found.standard_error, [np.nan, np.nan, expected], rtol=1e-12)
    known = np.isfinite(found.correlation)
    assert np.argwhere(known).tolist() == [[2, 2]]


def test_bounds_hold_and_are_told():
    """Unknowns beyond a bound, within bounds, and without effect; each with its own scale."""
    unknowns = [
        Unknown("beyond", 1.0, 3.0, 0.0, 2.0),
        Unknown("below", 1.0, 0.2, 0.5, 2.0),
        Unknown("within", 0.5, 0.5, 0.0, 1.0),
        Unknown("ineffective", 0.7, 1.0),
    ]
    target = np.array([2.01, 0.49, 0.3])
    found = minimize(lambda values: (values[:3] - target) * [1.0, 2.0, 3.0], unknowns)
    np.testing.assert_allclose(found.values, [2.0, 0.5, 0.3, 0.7], rtol=1e-6)
    assert found.at_bound.tolist() == [True, True, False, False]
    assert found.has_effect.tolist() == [True, True, True, False]
    derivatives = np.column_stack([np.diag([1.0, 2.0, 3.0]), np.zeros(3)])
    np.testing.assert_allclose(found.jacobian, derivatives, rtol=0.0, atol=1e-8)


class LinearDecay:
    """Peaks whose rotations and times both depend on the second of three unknowns."""

    def peaks(self, values, measured):
        number = np.arange(measured.rotation.size)
        return values[2] + number * values[1], values[0] + number * values[1]


@pytest.mark.parametrize(
    ("of_rotation", "of_time"),
    [
        pytest.param(0.01, 0.01, marks=pytest.mark.long),
        (0.01, 0.001),
        pytest.param(0.001, 0.01, marks=pytest.mark.long),
    ],
)
def test_confidence_intervals_from_few_peaks_have_nominal_coverage(of_rotation, of_time):
    """Both noise levels are estimated from six values each."""
    rng, number = np.random.default_rng(7), np.arange(6.0)
    unknowns = [Unknown(name, 1.0, 1.0) for name in ("first", "change", "release")]
    inside = 0
    for _ in range(200):
        rotation = 1.0 + number + of_rotation * rng.normal(size=6)
        time = 1.0 + number + of_time * rng.normal(size=6)
        fit = fit_peaks(LinearDecay(), MeasuredPeaks(rotation, np.ones(6), time), unknowns)
        errors = uncertainty_of(fit, 0.95)
        inside += abs(fit.values[1] - 1.0) < errors.half_width * errors.standard_error[1]
    assert 0.92 <= inside / 200 <= 0.985
