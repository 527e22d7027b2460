"""Which rung to take for an error that one can live with."""

from dataclasses import dataclass
from typing import Final

import numpy as np
import xarray as xr

from rockframe.errors import SchemaError
from rockframe.units import POSITIVE, to_ratio

_OWNER: Final = "recommend"
_ERRORS: Final = {"peak_error": "the peak rotation", "history_error": "the rotation along time"}


@dataclass(frozen=True)
class Recommendation:
    """The cheapest rung that meets a tolerance; its text is a sentence.

    Parameters
    ----------
    model, accuracy : str
        Labels of the rung; of the best one tried if none meets the tolerance.
    met : bool
        Whether it meets the tolerance.
    sentence : str
        The same in words.
    """

    model: str
    accuracy: str
    met: bool
    sentence: str

    def __str__(self) -> str:
        return self.sentence


def recommend(
    dataset: xr.Dataset, tolerance: float = 0.01, *, error: str = "peak_error"
) -> Recommendation:
    """Pick the cheapest rung whose verdict is right and whose error is small enough.

    Parameters
    ----------
    dataset : xarray.Dataset
        Of :func:`rockframe.tradeoff`.
    tolerance : float, optional
        Error that one can live with, models and numerics together [1].
    error : {"peak_error", "history_error"}, optional
        Which error.

    Returns
    -------
    Recommendation
        ``str(...)`` is a sentence; ``model`` is a key of :func:`rockframe.model_ladder`.

    Raises
    ------
    SchemaError
        The dataset is no comparison of rungs, or has no such error.
    UnitsError, ComponentError
        `tolerance` is no positive ratio.
    """
    limit = to_ratio(tolerance, owner=_OWNER, name="tolerance", condition=POSITIVE)
    needed = ("run_time", "verdict_agrees", "model", "accuracy")
    if error not in _ERRORS or any(name not in dataset for name in (error, *needed)):
        known = " or ".join(repr(name) for name in _ERRORS)
        msg = f"{_OWNER}: expected a dataset of tradeoff() and error {known}, got error {error!r}"
        raise SchemaError(msg)
    errors = np.where(dataset["verdict_agrees"], dataset[error], np.inf)
    times = dataset["run_time"].to_numpy()
    good = errors <= limit
    place = np.where(good, times, np.inf) if good.any() else errors
    row, column = np.unravel_index(int(np.argmin(place)), place.shape)
    model = str(dataset["model"].to_numpy()[row])
    accuracy = str(dataset["accuracy"].to_numpy()[column])
    met = bool(good.any())
    rung = f"{model!r} at accuracy {accuracy!r}"
    cost = f"{_milliseconds(times[row, column])} a run"
    found = f"{_percent(errors[row, column])} off in {_ERRORS[error]}"
    if met:
        slowest = float(np.max(times)) / float(times[row, column])
        sentence = (
            f"For an error of at most {_percent(limit)}, take {rung}: {found}, {cost}, "
            f"{slowest:.3g} times faster than the slowest rung."
        )
    elif np.isfinite(errors[row, column]):
        sentence = f"No rung tried comes within {_percent(limit)}; the nearest is {rung}: {found}."
    else:
        sentence = "No rung tried has the verdict of the scene itself."
    return Recommendation(model, accuracy, met, sentence)


def _percent(value: float) -> str:
    return f"{100.0 * value:.2g} %"


def _milliseconds(value: float) -> str:
    return f"{1e3 * value:.3g} ms"
