"""Errors of fitted values agree with linear regression."""

import numpy as np
import pytest
from scipy import stats

from rockframe.identification.fitting import Solution, fit_peaks, uncertainty_of
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
