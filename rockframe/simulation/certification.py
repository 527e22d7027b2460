"""What a certificate tries."""

from dataclasses import dataclass
from typing import Final

from rockframe.arguments import whole_number
from rockframe.errors import ComponentError, shown
from rockframe.units import Condition, to_ratio

_SMALL: Final = Condition("above 0 and at most 0.1", lambda value: 0.0 < value <= 0.1)
_REACH: Final = Condition("from 0.01 to 0.9", lambda value: 0.01 <= value <= 0.9)
FEWEST_RUNS: Final = 60
MOST_RUNS: Final = 100_000


@dataclass(frozen=True, init=False)
class Certification:
    """What a certificate tries.

    Parameters
    ----------
    nudge : float, optional
        Largest relative change of each parameter in turn, up and down [1].
    reach : float, optional
        Largest relative change of the motion's scale [1].
    runs : int, optional
        Most runs beside the run; more follow the verdict farther where it changes fast.

    Raises
    ------
    UnitsError
        Not a ratio.
    ComponentError
        A nudge outside 0 to 0.1, a reach outside 0.01 to 0.9, or a number of runs outside
        60 to 100 000.
    """

    nudge: float
    reach: float
    runs: int

    def __init__(self, *, nudge: float = 1e-3, reach: float = 0.5, runs: int = 200) -> None:
        owner = type(self).__name__
        given = {"nudge": (nudge, _SMALL), "reach": (reach, _REACH)}
        for name, (value, condition) in given.items():
            ratio = to_ratio(value, owner=owner, name=name, condition=condition)
            object.__setattr__(self, name, ratio)
        most = whole_number(runs, owner=owner, name="runs", lowest=FEWEST_RUNS, highest=MOST_RUNS)
        object.__setattr__(self, "runs", most)


def certification_of(given: object) -> Certification | None:
    """Read the argument ``certify`` of a run.

    Parameters
    ----------
    given : bool or Certification
        What the user gave.

    Returns
    -------
    Certification or None

    Raises
    ------
    ComponentError
        Neither.
    """
    if given is False:
        return None
    if given is True:
        return Certification()
    if isinstance(given, Certification):
        return given
    msg = f"simulate: certify must be True, False or a Certification(...), got {shown(given)}"
    raise ComponentError(msg)
