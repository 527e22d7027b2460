"""The results of a fit as a labelled dataset, with a verdict and warnings in words."""

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, Final

import numpy as np
import xarray as xr

from rockframe.errors import ModelWarning, warn
from rockframe.identification.fitting import MAX_EVALUATIONS, Solution, Uncertainty, uncertainty_of
from rockframe.identification.measured import OWNER, History, MeasuredPeaks
from rockframe.identification.prediction import Prediction
from rockframe.identification.unknowns import Circumstance
from rockframe.results.schema import build_dataset
from rockframe.results.variables.studies import FitStatus
from rockframe.signals.arrays import Array
from rockframe.units import degrees_text

_HIGH_AUTOCORRELATION: Final = 0.3
"""Autocorrelation of residuals above which they do not count as independent."""
_CHANCE_DEVIATIONS: Final = 3.0
"""Largest autocorrelation of n independent residuals, in standard deviations of 1 / sqrt(n)."""
_ROUNDING_SHARE: Final = 1e-5
"""Share of the initial rotation below which residuals are rounding and no noise."""
_HIGH_CORRELATION: Final = 0.98
"""Correlation above which the data hardly separate two unknowns."""


def fit_verdict(
    values: Mapping[str, Any], names: Sequence[str], confidence: float, half_width: float
) -> str:
    """Return the result of a fit as a sentence."""
    results = ", ".join(
        f"{name.replace('_', ' ')} {_with_error(value, half_width * error)}"
        for name, value, error in zip(
            names, values["fitted_value"], values["standard_error"], strict=True
        )
    )
    history = "measured_rotation" in values
    data = values["measured_rotation" if history else "measured_peak_rotation"]
    residual = degrees_text(float(values["rotation_rms_residual"]), 2)
    begin = results[0].upper() + results[1:]
    return (
        f"{begin} ({100.0 * confidence:g} %); residual {residual} (root mean square of "
        f"{len(data)} {'samples' if history else 'peaks'})."
    )


def cautions_of(
    names: Sequence[str], solution: Solution, uncertainty: Uncertainty, values: Mapping[str, Any]
) -> Iterator[str]:
    """Return the reasons for which values or their errors may be wrong, as clauses."""
    if solution.status == FitStatus.TRIAL_LIMIT:
        yield f"the fit was given up after {MAX_EVALUATIONS} trials"
    for name, value, bound in zip(names, solution.values, solution.at_bound, strict=True):
        if bound:
            yield f"{name} stands at its bound, {value:.6g}; its standard error means little there"
    undetermined = [
        name
        for name, error in zip(names, uncertainty.standard_error, strict=True)
        if math.isnan(error)
    ]
    if undetermined:
        yield (
            f"the test does not tell {' and '.join(undetermined)}: another value, or other values "
            "together, would give the same rotation"
        )
    close = np.argwhere(np.triu(np.abs(uncertainty.correlation) > _HIGH_CORRELATION, 1))
    for first, second in close:
        yield (
            f"{names[first]} and {names[second]} can hardly be told apart, with a correlation of "
            f"{uncertainty.correlation[first, second]:.3f}"
        )
    dependence = float(values["residual_autocorrelation"])
    noise = float(values["rotation_rms_residual"])
    chance = _CHANCE_DEVIATIONS / math.sqrt(solution.residuals.size)
    if dependence > max(_HIGH_AUTOCORRELATION, chance) and noise > _ROUNDING_SHARE * abs(
        float(values["initial_rotation"])
    ):
        yield (
            f"each residual follows the one before, with a correlation of {dependence:.2f}: the "
            "system lacks something that the test shows, or the signal was smoothed, and the true "
            "errors are greater than the standard errors"
        )


def _with_error(value: float, error: float) -> str:
    """Write a value and its error, both to two digits of the error."""
    if not math.isfinite(error):
        return f"{value:.4g} +- unknown"
    digits = 6 if error <= 0.0 else min(max(1 - math.floor(math.log10(error)), 0), 12)
    return f"{value:.{digits}f} +- {error:.{digits}f}"


def fit_dataset(
    prediction: Prediction,
    measured: History | MeasuredPeaks,
    solution: Solution,
    confidence: float,
    accuracy: str,
) -> xr.Dataset:
    """Return the results of a fit as a labelled dataset, and warn of reasons for doubt."""
    names, parameters = list(prediction.names), prediction.trials.parameters
    uncertainty = uncertainty_of(solution, confidence)
    estimated = prediction.values(solution.values)
    error = dict(zip(names, uncertainty.standard_error.tolist(), strict=True))
    value = np.array([estimated[name] for name in parameters])
    spread = np.array([error[name] for name in parameters])
    values: dict[str, Any] = {
        "fitted_value": value,
        "standard_error": spread,
        "lower_confidence_bound": value - uncertainty.half_width * spread,
        "upper_confidence_bound": value + uncertainty.half_width * spread,
        "start_value": np.array([place.start for place in parameters.values()]),
        **{str(name): estimated[name] for name in Circumstance},
        **{f"{name}_error": error.get(name, math.nan) for name in Circumstance},
        "correlation": uncertainty.correlation,
        "fit_status": solution.status,
        "trial_count": solution.evaluations,
        **_measured_and_fitted(prediction, measured, solution.values),
    }
    cautions = list(cautions_of(names, solution, uncertainty, values))
    for caution in cautions:
        warn(f"{OWNER}: {caution}", ModelWarning)
    fitted = prediction.trials.system({name: estimated[name] for name in parameters})
    attributes: dict[str, str | float | int] = {
        "verdict": fit_verdict(values, list(parameters), confidence, uncertainty.half_width),
        "confidence": confidence,
        "model": fitted.setting.model,
        "model_description": fitted.describe(),
        "accuracy": accuracy,
        "motion": "none",
        "system_json": fitted.assembly.json,
        **({"cautions": "; ".join(cautions)} if cautions else {}),
    }
    dataset = build_dataset(
        values, attributes, title="Free-decay test", source="least squares on repeated runs"
    ).assign_coords(
        parameter=("parameter", list(parameters), {"long_name": "parameter"}),
        unknown=("unknown", names, {"long_name": "unknown of the fit"}),
        other_unknown=("other_unknown", names, {"long_name": "other unknown of the fit"}),
    )
    if "time" in dataset:
        dataset["time"].attrs["long_name"] = "time of the record"
    return dataset


def _measured_and_fitted(
    prediction: Prediction, measured: History | MeasuredPeaks, estimates: Array
) -> Mapping[str, Array | float]:
    """Return measured and fitted values with their residuals, by their names in the schema."""
    of_times: dict[str, Array | float] = {}
    if isinstance(measured, History):
        kind, fitted = "rotation", prediction.history(estimates, measured)
        of_times["time"] = measured.time
    else:
        kind, (times, fitted) = "peak_rotation", prediction.peaks(estimates, measured)
        if measured.time is not None:
            of_times = {
                "measured_peak_time": measured.time,
                "fitted_peak_time": times,
                "peak_time_residual": measured.time - times,
                "time_rms_residual": _rms(measured.time - times),
            }
    residual = measured.rotation - fitted
    total, following = float(residual @ residual), float(residual[1:] @ residual[:-1])
    return {
        f"measured_{kind}": measured.rotation,
        f"fitted_{kind}": fitted,
        f"{kind}_residual": residual,
        "rotation_rms_residual": _rms(residual),
        "residual_autocorrelation": following / total if total > 0.0 else 0.0,
        **of_times,
    }


def _rms(residual: Array) -> float:
    return math.sqrt(float(np.mean(residual**2)))
