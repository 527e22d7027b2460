"""Accuracy settings of a run: an error tolerance, or a number of fixed steps.

Also the number of fixed steps in each interval of the motion, :eq:`eq-substeps`.
"""

import math
from dataclasses import dataclass, fields
from enum import StrEnum
from numbers import Integral, Real
from typing import Any, Final, Literal

from rockframe.case_arrays import ceil, hypot
from rockframe.dynamics.protocol import ContactModel
from rockframe.errors import SolverError, did_you_mean, short_repr
from rockframe.suggestions import suggests_names

FEWEST: Final = "fewest"
"""Stands for the least number of sub-steps that `steps_per_period` allows."""


class AccuracyLevel(StrEnum):
    """Named settings of :class:`Accuracy`."""

    FAST = "fast"
    STANDARD = "standard"
    REFERENCE = "reference"


@suggests_names
@dataclass(frozen=True, kw_only=True)
class Accuracy:
    """Settings of the integration: an error tolerance, or fixed sub-steps.

    Parameters
    ----------
    rtol : float or None
        Error allowed in one step, relative to the size of each state variable [1].
        None if `substeps` is given.
    floor : float
        Errors are relative to the present size of a variable, or to this share of
        its largest size so far if that is greater; not used with `substeps` [1].
    steps_per_period : float
        Least number of steps per period of the model's highest frequency; not used
        if `substeps` is a number [1].
    max_steps : int
        Number of steps after which a run ends with the status ``step_limit``.
    substeps : int, "fewest" or None
        Equal steps into which each sample interval of the motion is cut; ``"fewest"``
        is the least number that satisfies `steps_per_period`. None if `rtol` is
        given.

    Raises
    ------
    SolverError
        A setting is out of range, or not exactly one of `rtol` and `substeps` is given.

    Examples
    --------
    >>> import rockframe as rf
    >>> fine = rf.Accuracy(rtol=1e-10)
    >>> fine.rtol, fine.substeps
    (1e-10, None)
    """

    rtol: float | None = None
    floor: float = 0.05
    steps_per_period: float = 8.0
    max_steps: int = 200_000_000
    substeps: int | Literal["fewest"] | None = None

    def __post_init__(self) -> None:
        if (self.rtol is None) == (self.substeps is None):
            both = "neither" if self.rtol is None else "both"
            msg = f"Accuracy: give rtol (steps by tolerance) or substeps (fixed steps), got {both}"
            raise SolverError(msg)
        bounds = {
            "rtol": (1e-13, 1e-2),
            "floor": (0.0, 1.0),
            # fixed steps are not stable with fewer
            "steps_per_period": (6.0 if self.substeps is None else 8.0, 1e4),
            "max_steps": (1, 10**12),
            "substeps": (1, 10**6),
        }
        for field in fields(self):
            value = getattr(self, field.name)
            is_word = field.name == "substeps" and isinstance(value, str)
            if value is None or (is_word and value == FEWEST):
                continue
            low, high = bounds[field.name]
            whole = field.name in ("max_steps", "substeps")
            if isinstance(value, bool) or not isinstance(value, Real):
                expected = (
                    f"a whole number or {FEWEST!r}" if field.name == "substeps" else "a number"
                )
                msg = f"Accuracy: {field.name} must be {expected}, got {short_repr(value)}"
                raise SolverError(msg)
            if whole and not isinstance(value, Integral):
                msg = f"Accuracy: {field.name} must be a whole number, got {short_repr(value)}"
                raise SolverError(msg)
            number: Any = value  # integers have any size, unlike floats
            if not low <= number <= high:
                msg = (
                    f"Accuracy: {field.name} must lie from {low:g} to {high:g}, got "
                    f"{short_repr(value)}"
                )
                raise SolverError(msg)


LEVELS = {
    AccuracyLevel.FAST: Accuracy(substeps=FEWEST, steps_per_period=10.0),
    AccuracyLevel.STANDARD: Accuracy(rtol=2e-8),
    AccuracyLevel.REFERENCE: Accuracy(rtol=1e-11),
}


def accuracy_of(choice: "str | float | Accuracy", *, owner: str = "simulate") -> Accuracy:
    """Return the settings that a user means by a named level, a tolerance or an `Accuracy`."""
    if isinstance(choice, Accuracy):
        return choice
    if isinstance(choice, Real) and not isinstance(choice, bool | Integral):
        return Accuracy(rtol=float(choice))  # of NumPy, too
    try:
        return LEVELS[AccuracyLevel(choice)]
    except ValueError:
        names = ", ".join(repr(str(level)) for level in AccuracyLevel)
        known = f"one of {names}, a tolerance such as 1e-6 or an Accuracy(...)"
        near = did_you_mean(choice, map(str, AccuracyLevel))
        msg = f"{owner}: accuracy must be {known}, got {short_repr(choice)}{near}"
        if isinstance(choice, str) and choice == "screen":
            msg += (
                "; sweeps, and analyses made of them, screen, such as "
                "incremental_dynamic_analysis, which finds critical scales: here give "
                f"'{AccuracyLevel.STANDARD}'"
            )
        raise SolverError(msg) from None


STABILITY_LIMIT: Final = 0.85
"""Largest product of fixed step and fastest rate for which the method damps any damped vibration;
the bound is 0.857 for infinite, 1.0 for critical and 2.45 for no damping."""
LENGTH_TOLERANCE: Final = 1e-9
"""Share of a sub-step by which it may be longer than its limit."""


def fastest_rate(model: ContactModel) -> float:
    """Return the rate of the fastest vibration with its damping, which limits the step [s^-1]."""
    half = 0.5 * model.damping_rate
    return half + hypot(model.fastest_frequency, half)


def substeps_of(accuracy: Accuracy, model: ContactModel, interval: float) -> int:
    """Return the number of fixed steps in each interval [s] of a motion; 0 for steps by tolerance.

    Raises SolverError if steps of that length would not be stable.
    """
    if accuracy.substeps is None:
        return 0
    rate = fastest_rate(model)
    if accuracy.substeps == FEWEST:
        longest = 2.0 * math.pi / rate / accuracy.steps_per_period
        return ceil(interval / longest * (1.0 - LENGTH_TOLERANCE))
    least = ceil(interval * rate / STABILITY_LIMIT * (1.0 - LENGTH_TOLERANCE))
    if accuracy.substeps < least:
        msg = (
            f"Accuracy: substeps={accuracy.substeps} in each interval of {interval:.6g} s "
            f"are too few for the model's fastest vibration "
            f"({model.fastest_frequency / (2.0 * math.pi):.4g} Hz); give at least {least}, or "
            f"substeps={FEWEST!r}, or an rtol"
        )
        raise SolverError(msg)
    return accuracy.substeps
