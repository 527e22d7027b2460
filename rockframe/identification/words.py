"""A fit in words: what was found, and what to beware of."""

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, Final

import numpy as np

from rockframe.identification.least_squares import MOST_EVALUATIONS, Solution, Uncertainty
from rockframe.results.variables.studies import FitStatus

_DEPENDENT: Final = 0.3
"""Correlation of residuals with the next from which they do not count as independent."""
_BY_CHANCE: Final = 3.0
"""Standard deviations, each 1 / sqrt(n), up to which n independent residuals seem dependent."""
_ROUNDING: Final = 1e-5
"""Share of the initial rotation below which residuals are rounding, not noise."""
_CLOSE: Final = 0.98
"""Correlation from which two unknowns can hardly be told apart."""


def fit_sentence(
    values: Mapping[str, Any], names: Sequence[str], confidence: float, reach: float
) -> str:
    """Say in one sentence what was found."""
    found = ", ".join(
        f"{name} {_with_error(value, reach * error)}"
        for name, value, error in zip(
            names, values["fitted_value"], values["standard_error"], strict=True
        )
    )
    history = "measured_rotation" in values
    data = values["measured_rotation" if history else "measured_peak_rotation"]
    residual = math.degrees(float(values["rotation_rms_residual"]))
    begin = found[0].upper() + found[1:]
    return (
        f"{begin} ({100.0 * confidence:g} %); residual {residual:.2g} deg (root mean square of "
        f"{len(data)} {'samples' if history else 'peaks'})."
    )


def cautions_of(
    names: Sequence[str], solution: Solution, uncertainty: Uncertainty, values: Mapping[str, Any]
) -> Iterator[str]:
    """Say what speaks against the values or their errors."""
    if solution.status == FitStatus.TRIAL_LIMIT:
        yield f"the fit was given up after {MOST_EVALUATIONS} trials"
    for name, value, bound in zip(names, solution.values, solution.at_bound, strict=True):
        if bound:
            yield f"{name} stands at its bound, {value:.6g}; its standard error means little there"
    lost = [
        name
        for name, error in zip(names, uncertainty.standard_error, strict=True)
        if math.isnan(error)
    ]
    if lost:
        yield (
            f"the test does not tell {' and '.join(lost)}: another value, or other values "
            "together, would give the same rotation"
        )
    close = np.argwhere(np.triu(np.abs(uncertainty.correlation) > _CLOSE, 1))
    for first, second in close:
        yield (
            f"{names[first]} and {names[second]} can hardly be told apart, with a correlation of "
            f"{uncertainty.correlation[first, second]:.3f}"
        )
    dependence = float(values["residual_autocorrelation"])
    noise = float(values["rotation_rms_residual"])
    chance = _BY_CHANCE / math.sqrt(solution.residuals.size)
    if dependence > max(_DEPENDENT, chance) and noise > _ROUNDING * abs(
        float(values["initial_rotation"])
    ):
        yield (
            f"each residual follows the one before, with a correlation of {dependence:.2f}: the "
            "system lacks something that the test shows, or the signal was smoothed, and the true "
            "errors are greater than the standard errors"
        )


def _with_error(value: float, error: float) -> str:
    """Write a value and its error to two digits of the error."""
    if not math.isfinite(error):
        return f"{value:.4g} +- unknown"
    digits = 6 if error <= 0.0 else min(max(1 - math.floor(math.log10(error)), 0), 12)
    return f"{value:.{digits}f} +- {error:.{digits}f}"
