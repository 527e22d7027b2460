"""Identification of the parameters of a system from a free-decay test, and its dataset."""

import math
from collections.abc import Iterator, Mapping, Sequence
from functools import partial
from typing import Any, Final

import numpy as np
import pandas as pd
import xarray as xr

from rockframe.arguments import checked_choice, checked_list
from rockframe.errors import ComponentError, ModelWarning, short_repr, warn
from rockframe.identification.fitting import (
    MAX_EVALUATIONS,
    Solution,
    Uncertainty,
    fit_history,
    fit_peaks,
    uncertainty_of,
)
from rockframe.identification.measured import (
    OWNER,
    History,
    MeasuredPeaks,
    Swings,
    check_below_overturning,
    read_history,
    read_peaks,
    swings_of,
)
from rockframe.identification.prediction import Circumstance, Prediction, TrialSystems, start_values
from rockframe.results.schema import build_dataset
from rockframe.results.variables.studies import FitStatus
from rockframe.signals.arrays import Array
from rockframe.simulation.system import System, check_system
from rockframe.solve.accuracy import AccuracyLevel, accuracy_of
from rockframe.suggestions import with_hints
from rockframe.system.options import AccuracyLike
from rockframe.units import Condition, QuantityLike, RatioLike, angle_words, degrees_text, to_ratio

_CONFIDENCE: Final = Condition("above 0 and below 1", lambda value: 0.0 < value < 1.0)


@with_hints()
def fit_free_decay(
    system: System,
    measured: xr.DataArray | pd.DataFrame | tuple[object, object] | None = None,
    parameters: Sequence[str] | str = ("restitution",),
    *,
    peaks: tuple[object, object] | QuantityLike | None = None,
    circumstances: Sequence[str] | str | None = None,
    confidence: RatioLike = 0.95,
    accuracy: AccuracyLike = AccuracyLevel.STANDARD,
) -> xr.Dataset:
    """Find parameters of a system from a free-decay test, in which it was tilted and released.

    Parameters
    ----------
    system : System
        The system that was tested, with start values of the parameters that are to be found. A
        ground motion among its parts is left out, since the ground is at rest.
    measured : xarray.DataArray, ((times, unit), (rotations, unit)) or DataFrame, optional
        History of the block's rotation, from the release or from before it. A DataArray has
        the times as its coordinate, and both have the attribute ``units``. A DataFrame has two
        columns with their units in brackets, such as ``time [s]`` and ``rotation [deg]``.
    parameters : str or sequence of str, optional
        Dimensionless parameters of the system's parts, such as ``"restitution"``,
        ``"frequency_ratio"``, ``"damping_ratio"``. If several parts have a parameter of this
        name, it is written with the class, as in ``"TwoSpringSupport.damping_ratio"``.
        Those of the interfaces of a stack are not fitted.
    peaks : (rotations, unit), Quantity or ((times, unit), (rotations, unit)), optional
        Successive peaks of the rotation to both sides, in place of `measured`, with or without
        their times. They may be without signs, except for an eccentric block. The first peak
        is the release.
    circumstances : str or sequence of str, optional
        Unknown quantities of the test that are to be found as well: ``"initial_rotation"``,
        ``"release_time"`` and ``"gauge_offset"``. By default all three are found from a
        history; from peaks the initial rotation is found, and with times the release time. The
        others are taken from the first sample or peak, and the offset is zero.
    confidence : float, optional
        Probability of the confidence intervals [1].
    accuracy : {"fast", "standard", "reference"}, float or Accuracy, optional
        Accuracy of the integration.

    Returns
    -------
    xarray.Dataset
        - Over ``parameter``: ``fitted_value``, ``standard_error``, ``lower_confidence_bound``,
          ``upper_confidence_bound`` and ``start_value`` [1].
        - ``initial_rotation`` [rad], ``release_time`` [s] and ``gauge_offset`` [rad] with their
          standard errors, which are NaN for those that were not fitted.
        - ``correlation`` of all unknowns [1].
        - Over ``time``: ``measured_rotation``, ``fitted_rotation`` and ``rotation_residual``
          [rad]; for peaks the same over ``peak``.
        - Root mean squares of the residuals, and their ``residual_autocorrelation`` [1].
        - ``fit_status`` and ``trial_count``.

        The attribute ``verdict`` is a sentence. :meth:`rockframe.System.from_dataset` gives
        the fitted system.

    Raises
    ------
    UnitsError
        If an array has no unit, or a wrong one.
    ComponentError
        If data are not finite, times do not increase, a rotation is beyond overturning, the
        block does not rock, there are no more data than unknowns, a parameter is unknown, the
        base is inclined, or the block stands before a rigid wall.

    Warns
    -----
    ModelWarning
        If a value is at its bound, the data do not determine it, or the residuals are not the
        independent noise that the standard errors assume.

    Notes
    -----
    The fit is by least squares (:func:`scipy.optimize.least_squares`). A history is fitted twice:
    from the given start values, and from those of a fit to its peaks, the n-th of the run to the
    n-th that was measured. The better fit is kept. On pads the sum of squares has several minima,
    some 15 % of the frequency ratio apart, so that a start value should be within 10 %.

    Standard errors follow from the derivatives at the solution and from the residuals,
    :eq:`eq-fit-covariance`. They assume that the model is right except for the unknowns, and
    that the residuals are independent and of equal variance.

    Examples
    --------
    >>> import rockframe as rf
    >>> block = rf.Block(width="0.3 m", height="1.2 m", mass="200 kg")
    >>> peaks = ([6.0, 4.56, 3.54, 2.78, 2.21], "deg")
    >>> found = rf.fit_free_decay(rf.System(block), peaks=peaks)
    >>> round(float(found.fitted_value.sel(parameter="restitution")), 2)
    0.9
    """
    check_system(system, OWNER)
    _check_swings(system)
    if (measured is None) == (peaks is None):
        value = "neither" if peaks is None else "both"
        msg = f"{OWNER}: give measured (a history) or peaks, got {value}"
        raise ComponentError(msg)
    names = tuple(checked_list(parameters, owner=OWNER, name="parameters", of="names"))
    if not names or len(set(names)) < len(names):
        msg = f"{OWNER}: parameters must name one or more, each once, got {short_repr(parameters)}"
        raise ComponentError(msg)
    probability = to_ratio(
        confidence, owner=OWNER, name="confidence", condition=_CONFIDENCE, example="0.95"
    )
    settings = accuracy_of(accuracy, owner=OWNER)
    trials = TrialSystems(system, names)
    data = read_history(measured) if peaks is None else read_peaks(peaks)
    check_below_overturning(data, system.setting.overturning_angles)
    fitted = _read_circumstances(circumstances, data)
    unknowns = (*names, *fitted)
    if data.count <= len(unknowns):
        msg = (
            f"{OWNER}: {data.count} data do not tell {len(unknowns)} unknowns "
            f"({', '.join(unknowns)}) and their uncertainty; expected at least {len(unknowns) + 1}"
        )
        raise ComponentError(msg)
    swings = swings_of(data) if isinstance(data, History) else Swings(data)
    starts = start_values(system, trials, data, swings, fitted, settings)
    known = {str(name): starts[name].start for name in Circumstance if name not in fitted}
    prediction = Prediction(trials, unknowns, known, settings)
    chosen = [starts[name] for name in unknowns]
    if isinstance(data, MeasuredPeaks):
        fit = fit_peaks(prediction, data, chosen)
    else:
        fit = fit_history(prediction, data, swings, chosen)
    return fit_dataset(
        prediction, data, fit, probability, accuracy if isinstance(accuracy, str) else "own"
    )


def _check_swings(system: System) -> None:
    """Refuse scenes whose swings to both sides no passage through zero separates."""
    if not system.options.slope.level:
        inclined = angle_words(system.options.inclination)
        msg = (
            f"{OWNER}: the base is inclined by {inclined}; free decay is fitted on a level base "
            "only, about which the swings to both sides are told apart"
        )
        raise ComponentError(msg)
    if system.parts.rigid_wall is not None:
        msg = (
            f"{OWNER}: the block is before a rigid RearWall and rocks to one side only; expected "
            "a block that swings to both sides, without a wall, or before one with a stiffness"
        )
        raise ComponentError(msg)


def _read_circumstances(
    values: Sequence[str] | str | None, data: History | MeasuredPeaks
) -> tuple[Circumstance, ...]:
    """Return circumstances that are to be found; refuse those that the data do not determine."""
    circumstances = [Circumstance.INITIAL_ROTATION]
    if isinstance(data, History) or data.time is not None:
        circumstances.append(Circumstance.RELEASE_TIME)
    if isinstance(data, History):
        circumstances.append(Circumstance.GAUGE_OFFSET)
    if values is None:
        return tuple(circumstances)
    if isinstance(data, MeasuredPeaks) and data.signed:
        circumstances.append(Circumstance.GAUGE_OFFSET)
    listed = checked_list(values, owner=OWNER, name="circumstances", of="names")
    read = partial(checked_choice, Circumstance, owner=OWNER, name="circumstances")
    names = [read(name) for name in listed]
    for name in names:
        if name not in circumstances:
            needed = "times" if name is Circumstance.RELEASE_TIME else "their signs"
            msg = f"{OWNER}: {str(name)!r} cannot be found from peaks without {needed}"
            raise ComponentError(msg)
    return tuple(name for name in Circumstance if name in names)


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
    fitted = zip(names, values["fitted_value"], values["standard_error"], strict=True)
    results = ", ".join(
        f"{name.replace('_', ' ')} {_with_error(value, half_width * error)}"
        for name, value, error in fitted
    )
    history = "measured_rotation" in values
    data = values["measured_rotation" if history else "measured_peak_rotation"]
    residual = degrees_text(float(values["rotation_rms_residual"]), 2)
    return (
        f"{results[0].upper()}{results[1:]} ({100.0 * confidence:g} %); residual "
        f"{residual} (root mean square of {len(data)} {'samples' if history else 'peaks'})."
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
    undetermined = [names[k] for k in np.flatnonzero(np.isnan(uncertainty.standard_error)).tolist()]
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
    rounding = _ROUNDING_SHARE * abs(float(values["initial_rotation"]))
    if dependence > max(_HIGH_AUTOCORRELATION, chance) and noise > rounding:
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
