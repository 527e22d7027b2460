"""Identification of the parameters of a system from a free-decay test."""

from collections.abc import Sequence
from typing import Final

import pandas as pd
import xarray as xr

from rockframe.arguments import checked_choice, checked_list
from rockframe.errors import ComponentError, short_repr
from rockframe.identification.fitting import fit_history, fit_peaks
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
from rockframe.identification.prediction import Prediction, start_values
from rockframe.identification.report import fit_dataset
from rockframe.identification.unknowns import Circumstance, TrialSystems
from rockframe.simulation.system import System, check_system
from rockframe.solve.accuracy import AccuracyLevel, accuracy_of
from rockframe.suggestions import with_hints
from rockframe.system.options import AccuracyLike
from rockframe.units import Condition, QuantityLike, RatioLike, angle_words, to_ratio

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
    names = [
        checked_choice(Circumstance, circumstance, owner=OWNER, name="circumstances")
        for circumstance in listed
    ]
    for name in names:
        if name not in circumstances:
            needed = "times" if name is Circumstance.RELEASE_TIME else "their signs"
            msg = f"{OWNER}: {str(name)!r} cannot be found from peaks without {needed}"
            raise ComponentError(msg)
    return tuple(name for name in Circumstance if name in names)
