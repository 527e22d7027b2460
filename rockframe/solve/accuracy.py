"""How accurate, and so how costly, a run shall be."""

from dataclasses import dataclass, fields
from enum import StrEnum

from rockframe.errors import SolverError


class AccuracyLevel(StrEnum):
    """Named settings of :class:`Accuracy`."""

    FAST = "fast"
    STANDARD = "standard"
    REFERENCE = "reference"


@dataclass(frozen=True, kw_only=True)
class Accuracy:
    """Settings of the integration.

    Parameters
    ----------
    rtol : float
        Error allowed in one step, relative to the size of each state variable [1].
    floor : float
        Share of a variable's largest size so far below which the error is no
        longer measured relative to its present size [1].
    steps_per_period : float
        Least number of steps per period of the model's highest frequency [1].
    max_steps : int
        Steps after which a run is ended with status ``step_limit``.

    Raises
    ------
    SolverError
        A setting is out of range.
    """

    rtol: float
    floor: float = 0.05
    steps_per_period: float = 20.0
    max_steps: int = 200_000_000

    def __post_init__(self) -> None:
        bounds = {
            "rtol": (1e-13, 1e-2),
            "floor": (0.0, 1.0),
            "steps_per_period": (6.0, 1e4),
            "max_steps": (1, 10**12),
        }
        for field in fields(self):
            value = getattr(self, field.name)
            low, high = bounds[field.name]
            if isinstance(value, bool) or not isinstance(value, int | float):
                msg = f"Accuracy: {field.name} must be a number, got {value!r}"
                raise SolverError(msg)
            if field.name == "max_steps" and not isinstance(value, int):
                msg = f"Accuracy: max_steps must be a whole number, got {value!r}"
                raise SolverError(msg)
            if not low <= value <= high:
                msg = f"Accuracy: {field.name} must lie from {low:g} to {high:g}, got {value!r}"
                raise SolverError(msg)


LEVELS = {
    AccuracyLevel.FAST: Accuracy(rtol=1e-4, steps_per_period=10.0),
    AccuracyLevel.STANDARD: Accuracy(rtol=2e-8),
    AccuracyLevel.REFERENCE: Accuracy(rtol=1e-11),
}


def accuracy_of(choice: "str | AccuracyLevel | Accuracy") -> Accuracy:
    """Give the settings of a named level, or check that they are settings already.

    Parameters
    ----------
    choice : str, AccuracyLevel or Accuracy
        ``"fast"``, ``"standard"``, ``"reference"`` or own settings.

    Returns
    -------
    Accuracy

    Raises
    ------
    SolverError
        Neither a known level nor settings.
    """
    if isinstance(choice, Accuracy):
        return choice
    try:
        return LEVELS[AccuracyLevel(choice)]
    except ValueError:
        names = ", ".join(repr(str(level)) for level in AccuracyLevel)
        msg = f"accuracy must be one of {names} or an Accuracy(...), got {choice!r}"
        raise SolverError(msg) from None
