"""How many fixed steps an interval of the motion is cut into, :eq:`eq-substeps`."""

import math
from typing import Final

from rockframe.dynamics.protocol import ContactModel
from rockframe.errors import SolverError
from rockframe.solve.accuracy import FEWEST, Accuracy

STABLE: Final = 0.85
"""Largest step times fastest rate for which the method damps every damped vibration;
it is 0.857 for dashpots without end, 1.0 for critical damping and 2.45 without damping."""
WHOLE: Final = 1e-9
"""Share of a sub-step by which it may be longer than asked."""


def fastest_rate(model: ContactModel) -> float:
    """Give the rate that fixes the step: of the fastest vibration, with its damping [s^-1]."""
    half = 0.5 * model.damping_rate
    return half + math.hypot(model.fastest_frequency, half)


def substeps_of(accuracy: Accuracy, model: ContactModel, interval: float) -> int:
    """Give the number of fixed steps in each interval of a motion, 0 if by tolerance.

    Parameters
    ----------
    accuracy : Accuracy
        Settings.
    model : ContactModel
        The equations.
    interval : float
        Of the motion [s].

    Returns
    -------
    int

    Raises
    ------
    SolverError
        Steps of that length would not be stable.
    """
    if accuracy.substeps is None:
        return 0
    rate = fastest_rate(model)
    if accuracy.substeps == FEWEST:
        longest = 2.0 * math.pi / rate / accuracy.steps_per_period
        return math.ceil(interval / longest * (1.0 - WHOLE))
    least = math.ceil(interval * rate / STABLE * (1.0 - WHOLE))
    if accuracy.substeps < least:
        msg = (
            f"Accuracy: substeps={accuracy.substeps} in each interval of {interval:.6g} s "
            f"are too few for the model's fastest vibration "
            f"({model.fastest_frequency / (2.0 * math.pi):.4g} Hz); give at least {least}, or "
            f"substeps={FEWEST!r}, or an rtol"
        )
        raise SolverError(msg)
    return accuracy.substeps
