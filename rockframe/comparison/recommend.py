"""Choice of the cheapest model and accuracy for an admissible error."""

from dataclasses import dataclass
from typing import Final, cast

import numpy as np
import xarray as xr

from rockframe.errors import ComponentError, SchemaError, did_you_mean, short_repr
from rockframe.suggestions import suggests_names, with_hints
from rockframe.units import POSITIVE, to_ratio

_OWNER: Final = "recommend"
_MIN_PERCENTAGE: Final = 1e-4
"""Smallest error written as a percentage; a percentage with an exponent is easily misread."""
DIMENSIONS: Final = ("model", "accuracy")
_NEEDED: Final = ("run_time", "verdict_agrees", *DIMENSIONS)
_ERRORS: Final = {"peak_error": "the peak rotation", "history_error": "the rotation along time"}


@suggests_names
@dataclass(frozen=True)
class Recommendation:
    """The cheapest model and accuracy that meet a tolerance; ``str`` gives it as a sentence.

    Parameters
    ----------
    model, accuracy : str
        Labels of model and accuracy. If none meets the tolerance, those of the least error.
    met : bool
        Whether they meet the tolerance.
    sentence : str
        The recommendation in words.

    Examples
    --------
    >>> import rockframe as rf
    >>> best = Recommendation("rigid ground", "fast", met=True, sentence="Take 'rigid ground'.")
    >>> print(best)
    Take 'rigid ground'.
    """

    model: str
    accuracy: str
    met: bool
    sentence: str

    def __str__(self) -> str:
        return self.sentence


@with_hints()
def recommend(
    dataset: xr.Dataset, tolerance: float = 0.01, *, error: str = "peak_error"
) -> Recommendation:
    """Choose the cheapest model and accuracy with the right verdict and an admissible error.

    Parameters
    ----------
    dataset : xarray.Dataset
        Dataset of :func:`rockframe.tradeoff`.
    tolerance : float, optional
        Admissible error of model and integration together, at most 1: 0.05 or ``"5 %"`` for
        five per cent [1].
    error : {"peak_error", "history_error"}, optional
        Error to which the tolerance applies.

    Returns
    -------
    Recommendation
        ``str`` of it is a sentence, and its ``model`` a key of :func:`rockframe.model_ladder`.

    Raises
    ------
    SchemaError
        If the dataset is no comparison of models, or has no such error.
    UnitsError, ComponentError
        If `tolerance` is not dimensionless, or not above 0 and at most 1.

    Examples
    --------
    >>> import rockframe as rf
    >>> system = rf.System(rf.Block(width="0.8 m", height="4 m", mass="2 t"))
    >>> pulse = rf.GroundMotion.sine_pulse("2.5 m/s^2", "1 Hz")
    >>> found = rf.tradeoff(system, pulse, models="rigid ground", accuracies="standard", repeats=1)
    >>> rf.recommend(found, "1 %").accuracy
    'standard'
    """
    limit = to_ratio(tolerance, owner=_OWNER, name="tolerance", condition=POSITIVE)
    if limit > 1.0:
        msg = (
            f"{_OWNER}: tolerance must be at most 1, the whole peak, got {short_repr(tolerance)}; "
            f"for {_plain_number(limit, 3)} % write {_plain_number(0.01 * limit, 3)}"
        )
        raise ComponentError(msg)
    if not isinstance(cast("object", dataset), xr.Dataset):
        msg = (
            f"{_OWNER}: found {short_repr(dataset)}; expected a comparison of models, "
            "as rockframe.tradeoff(system, motion) gives it"
        )
        raise SchemaError(msg)
    if not isinstance(cast("object", error), str) or error not in _ERRORS:
        known, near = " or ".join(map(repr, _ERRORS)), did_you_mean(error, _ERRORS)
        msg = f"{_OWNER}: error must be {known}, got {short_repr(error)}{near}"
        raise SchemaError(msg)
    missing = [name for name in (error, *_NEEDED) if name not in dataset]
    if missing:
        msg = f"{_OWNER}: found a dataset without {missing[0]!r}; expected one of tradeoff()"
        raise SchemaError(msg)
    # a part of a comparison may have lost a dimension, or have them in another order
    lost = [dim for dim in DIMENSIONS if dim not in dataset.dims]
    dataset = dataset.expand_dims(lost).transpose(*DIMENSIONS, ...)
    agrees = dataset["verdict_agrees"].to_numpy()
    errors = np.where(agrees, dataset[error], np.inf)
    times = dataset["run_time"].to_numpy()
    admissible = errors <= limit
    # an error relative to no rotation at all is infinite, though the verdict is right
    nearness = np.where(agrees, np.minimum(errors, np.finfo(float).max), np.inf)
    ranking = np.where(admissible, times, np.inf) if admissible.any() else nearness
    row, column = np.unravel_index(int(np.argmin(ranking)), ranking.shape)
    model = str(dataset["model"].to_numpy()[row])
    accuracy = str(dataset["accuracy"].to_numpy()[column])
    met = bool(admissible.any())
    choice = f"{model!r} at accuracy {accuracy!r}"
    cost = f"{_plain_number(1e3 * times[row, column], 3)} ms a run"
    quantity = _ERRORS[error] + " or slip" * (error == "peak_error" and "peak_slip" in dataset)
    distance = f"off by {_error_words(errors[row, column], 2)} in {quantity}"
    if met:
        slowest = float(np.max(times)) / float(times[row, column])
        gain = f", {_plain_number(slowest, 3)} times faster than the slowest rung"
        sentence = (
            f"For an error of at most {_error_words(limit, 3)}, take {choice}: {distance}, "
            f"{cost}{gain * (slowest > 1.0)}."
        )
        if error == "peak_error" and "overturned" in dataset and dataset["overturned"][row, column]:
            sentence += (
                " It overturns, and its peak is where that ends the run, in any model: "
                "error='history_error' compares them along time."
            )
    elif agrees[row, column]:
        sentence = f"No rung tried comes within {_error_words(limit, 3)}"
        if np.isfinite(errors[row, column]):
            sentence += f"; the nearest is {choice}: {distance}."
        else:
            sentence += ": the scene itself does not rotate, but all rungs with its verdict do."
    elif bool(dataset[error].isnull().all()):
        sentence = "There is no error: the scene itself or all rungs ended before their verdict."
    else:
        sentence = "No rung tried has the verdict of the scene itself."
    return Recommendation(model, accuracy, met, sentence)


def _error_words(value: float, digits: int) -> str:
    """Write an error as a percentage, or a very small one as a share of the peak."""
    if 0.0 < value < _MIN_PERCENTAGE:
        text = np.format_float_scientific(value, digits - 1, trim="-", exp_digits=1)
        return f"{text.replace('.e', 'e')} of the peak"
    return f"{_plain_number(100.0 * value, digits)} %"


def _plain_number(value: float, digits: int) -> str:
    """Write a number without an exponent, to `digits` digits or to the decimal point."""
    if value >= 10.0 ** (digits - 1):
        return f"{value:.0f}"
    return np.format_float_positional(value, digits, unique=False, fractional=False, trim="-")
