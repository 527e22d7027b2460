"""What a certificate tries, and what it found."""

from dataclasses import dataclass
from typing import Final

from rockframe.errors import ComponentError, shown
from rockframe.units import Condition, to_ratio

_SMALL: Final = Condition("above 0 and at most 0.1", lambda value: 0.0 < value <= 0.1)
_REACH: Final = Condition("from 0.01 to 0.9", lambda value: 0.01 <= value <= 0.9)


@dataclass(frozen=True, init=False)
class Certification:
    """What a certificate tries.

    Parameters
    ----------
    nudge : float, optional
        Relative change of each parameter in turn, up and down [1].
    reach : float, optional
        Largest relative change of the motion's scale [1].

    Raises
    ------
    UnitsError
        Not a ratio.
    ComponentError
        A nudge outside 0 to 0.1, or a reach outside 0.01 to 0.9.
    """

    nudge: float
    reach: float

    def __init__(self, *, nudge: float = 1e-3, reach: float = 0.5) -> None:
        given = {"nudge": (nudge, _SMALL), "reach": (reach, _REACH)}
        for name, (value, condition) in given.items():
            ratio = to_ratio(value, owner="Certification", name=name, condition=condition)
            object.__setattr__(self, name, ratio)


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
        Whether the verdict is that of a run of tighter tolerance.
    robust : bool
        Whether it is that of every run with a nudged parameter.
    margin : float
        Smallest change of scale found that changes it; the reach if none did, NaN if
        there is nothing to scale [1].
    peak_error : float
        Difference of the peak rotation from that of the run of tighter tolerance [rad].
    peak_sensitivity : float
        Largest difference from that of a run with a nudged parameter [rad].
    runs : int
        Number of runs beside.
    sentence : str
        All this in words.
    """

    converged: bool
    robust: bool
    margin: float
    peak_error: float
    peak_sensitivity: float
    runs: int
    sentence: str

    def values(self) -> dict[str, float | bool]:
        """Give the scalars by their names in the schema."""
        return {
            "verdict_converged": self.converged,
            "verdict_robust": self.robust,
            "verdict_margin": self.margin,
            "peak_error_estimate": self.peak_error,
            "peak_sensitivity": self.peak_sensitivity,
        }

    def attributes(self, wanted: Certification) -> dict[str, str | float | int]:
        """Give what a dataset says of the certificate."""
        return {
            "certificate": self.sentence,
            "certificate_nudge": wanted.nudge,
            "certificate_reach": wanted.reach,
            "certificate_runs": self.runs,
        }
