"""What a certificate tries, and what it found."""

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


@dataclass(frozen=True)
class Certificate:
    """What the runs beside a run showed.

    Parameters
    ----------
    converged : bool
        Whether the verdict is that of every run by finer means, by more than they differ.
    robust : bool
        Whether no run with a parameter or the motion's scale changed by up to the nudge
        has another verdict, and none is to be feared between them.
    margin : float
        Largest change of scale up to which no other verdict was found; NaN if there is
        nothing to scale [1].
    flip : float
        Scale nearest to one that was found to change the verdict; NaN if none [1].
    peak_error : float
        Largest difference of the peak rotation from that of a run by finer means, times a
        safety factor [rad].
    peak_sensitivity : float
        Largest difference from that of a run with a nudged parameter [rad].
    runs : int
        Number of runs beside.
    resolution : float
        Length of an interval of scales that is not looked into, over its distance from
        one [1].
    sentence : str
        All this in words.
    """

    converged: bool
    robust: bool
    margin: float
    flip: float
    peak_error: float
    peak_sensitivity: float
    runs: int
    resolution: float
    sentence: str

    def values(self) -> dict[str, float | bool]:
        """Give the scalars by their names in the schema."""
        return {
            "verdict_converged": self.converged,
            "verdict_robust": self.robust,
            "verdict_margin": self.margin,
            "verdict_flip_scale": self.flip,
            "peak_error_estimate": self.peak_error,
            "peak_sensitivity": self.peak_sensitivity,
        }

    def attributes(self, wanted: Certification) -> dict[str, str | float | int]:
        """Give what a dataset says of the certificate."""
        return {
            "certificate": self.sentence,
            "certificate_nudge": wanted.nudge,
            "certificate_reach": wanted.reach,
            "certificate_resolution": self.resolution,
            "certificate_runs": self.runs,
        }
