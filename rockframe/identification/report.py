"""A fit as a labelled dataset."""

import math
from collections.abc import Mapping
from typing import Any, Final

import numpy as np
import xarray as xr

from rockframe.errors import ModelWarning, warn
from rockframe.identification.least_squares import Solution, uncertainty_of
from rockframe.identification.measured import History, MeasuredPeaks
from rockframe.identification.prediction import Prediction
from rockframe.identification.unknowns import Circumstance
from rockframe.identification.words import cautions_of, fit_sentence
from rockframe.results.dataset import build_dataset
from rockframe.signals.arrays import Array

_TIME: Final = "time of the record"


def fit_dataset(
    prediction: Prediction,
    measured: History | MeasuredPeaks,
    solution: Solution,
    confidence: float,
    accuracy: str,
) -> xr.Dataset:
    """Label what was found, and warn of what speaks against it."""
    names, places = list(prediction.names), prediction.trials.places
    uncertainty = uncertainty_of(solution, confidence)
    found = prediction.values(solution.values)
    error = dict(zip(names, uncertainty.standard_error.tolist(), strict=True))
    value = np.array([found[name] for name in places])
    spread = np.array([error[name] for name in places])
    values: dict[str, Any] = {
        "fitted_value": value,
        "standard_error": spread,
        "lower_confidence_bound": value - uncertainty.reach * spread,
        "upper_confidence_bound": value + uncertainty.reach * spread,
        "start_value": np.array([place.start for place in places.values()]),
        **{str(name): found[name] for name in Circumstance},
        **{f"{name}_error": error.get(name, math.nan) for name in Circumstance},
        "correlation": uncertainty.correlation,
        "fit_status": solution.status,
        "trial_count": solution.evaluations,
        **_compared(prediction, measured, solution.values),
    }
    cautions = list(cautions_of(names, solution, uncertainty, values))
    for caution in cautions:
        warn(f"fit_free_decay: {caution}", ModelWarning)
    fitted = prediction.trials.system({name: found[name] for name in places})
    attributes: dict[str, str | float | int] = {
        "verdict": fit_sentence(values, list(places), confidence, uncertainty.reach),
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
        parameter=("parameter", list(places), {"long_name": "parameter"}),
        unknown=("unknown", names, {"long_name": "unknown of the fit"}),
        other_unknown=("other_unknown", names, {"long_name": "other unknown of the fit"}),
    )
    if "time" in dataset:
        dataset["time"].attrs["long_name"] = _TIME
    return dataset


def _compared(
    prediction: Prediction, measured: History | MeasuredPeaks, found: Array
) -> Mapping[str, Array | float]:
    """Give what was measured beside what was fitted, by names in the schema."""
    if isinstance(measured, History):
        fitted = prediction.history(found, measured)
        residual = measured.rotation - fitted
        return {
            "time": measured.time,
            "measured_rotation": measured.rotation,
            "fitted_rotation": fitted,
            "rotation_residual": residual,
            **_noise(residual),
        }
    times, fitted = prediction.peaks(found, measured)
    residual = measured.rotation - fitted
    values: dict[str, Array | float] = {
        "measured_peak_rotation": measured.rotation,
        "fitted_peak_rotation": fitted,
        "peak_rotation_residual": residual,
        **_noise(residual),
    }
    if measured.time is not None:
        values |= {
            "measured_peak_time": measured.time,
            "fitted_peak_time": times,
            "peak_time_residual": measured.time - times,
            "time_rms_residual": _rms(measured.time - times),
        }
    return values


def _noise(residual: Array) -> dict[str, float]:
    """Give the size of residuals, and how much each tells of the next."""
    total = float(residual @ residual)
    following = float(residual[1:] @ residual[:-1])
    return {
        "rotation_rms_residual": _rms(residual),
        "residual_autocorrelation": following / total if total > 0.0 else 0.0,
    }


def _rms(residual: Array) -> float:
    return math.sqrt(float(np.mean(residual**2)))
