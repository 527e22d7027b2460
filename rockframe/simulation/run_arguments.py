"""The arguments of runs as users write them: each with its type, default and meaning."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Annotated, Final, TypeAlias, TypedDict

import xarray as xr

from rockframe.arguments import checked_integer
from rockframe.components import InitialState
from rockframe.shared_arguments import Argument
from rockframe.solve.accuracy import AccuracyLevel
from rockframe.suggestions import suggests_names
from rockframe.system.options import AccuracyLike, Overturning, OverturningLike, PointsLike
from rockframe.units import Condition, QuantityLike, to_ratio

INITIAL_ARGUMENT: Final = Argument(
    None, "InitialState, optional", "Where the runs start; at rest unless given."
)
ACCURACY_ARGUMENT: Final = Argument(
    AccuracyLevel.STANDARD,
    '{"fast", "standard", "reference"}, float or Accuracy, optional',
    "How accurate, and so how costly, the runs are.",
)
OVERTURNING_ARGUMENT: Final = Argument(
    Overturning.STOP,
    '{"stop", "continue"}, optional',
    "What is called overturning: that the rotation reaches the overturning angle, where the run "
    "then ends; or that the block lies flat by the end of the run, for it may come back from "
    "beyond the angle while the ground moves.",
)

_STEPS: Final = (
    "the steps of the integration are its own, as fine as accuracy asks for; output_step is the "
    "spacing of the histories"
)
FOREIGN_ARGUMENTS: Final = {
    "damping": "dampers belong to the parts, such as TwoSpringSupport(damping_ratio=0.1) or "
    "WinklerSoil(damping_ratio=0.2); a block on rigid ground loses energy in impacts, by "
    "RigidGround(restitution=...)",
    "damping_ratio": "it belongs to the parts, such as TwoSpringSupport(damping_ratio=0.1)",
    "dt": _STEPS,
    "time_step": _STEPS,
    "gravity": "it is an option of System(..., gravity='9.81 m/s^2')",
    "scale": "write simulate(motion.scaled(1.5))",
}
"""Arguments that users may try and a run does not take, with what to write instead."""

OutputStep: TypeAlias = Annotated[
    QuantityLike | None,
    Argument(
        None,
        "str or Quantity, optional",
        "Spacing of the histories; the time step of the motion unless given [s].",
    ),
]
OverturningArgument: TypeAlias = Annotated[OverturningLike, OVERTURNING_ARGUMENT]


class LengthArguments(TypedDict, total=False):
    """How long runs are."""

    duration: Annotated[
        QuantityLike | None,
        Argument(
            None,
            "str or Quantity, optional",
            "Length of a run; that of its motion unless given. Beyond the motion the ground "
            "stands still [s].",
        ),
    ]
    free_vibration: Annotated[
        QuantityLike | None,
        Argument(
            None,
            "str or Quantity, optional",
            "Time added to the length of the motion, instead of `duration` [s].",
        ),
    ]


class RunArguments(LengthArguments, total=False):
    """The arguments that :meth:`rockframe.System.simulate` passes on to the plan of a run."""

    initial: InitialState | xr.Dataset | None
    accuracy: AccuracyLike
    output_step: QuantityLike | None
    outputs: Sequence[str] | None
    points: PointsLike | None
    overturning: OverturningLike


class ScaleArguments(LengthArguments, total=False):
    """Arguments of runs that differ in the scale of their motion."""

    initial: Annotated[
        InitialState | xr.Dataset | None,
        Argument(
            None,
            "InitialState or xarray.Dataset, optional",
            "Where the runs start; at rest unless given. The result of another run of this "
            "system starts them where that one ended.",
        ),
    ]
    accuracy: Annotated[AccuracyLike, ACCURACY_ARGUMENT]
    overturning: OverturningArgument


class ComparedArguments(LengthArguments, total=False):
    """Arguments of runs by which models and accuracies are compared."""

    initial: Annotated[InitialState | None, INITIAL_ARGUMENT]
    output_step: OutputStep


_SMALL: Final = Condition("above 0 and at most 0.1", lambda value: 0.0 < value <= 0.1)
_REACH: Final = Condition("from 0.01 to 0.9", lambda value: 0.01 <= value <= 0.9)
MIN_RUNS: Final = 60
MAX_RUNS: Final = 100_000


@suggests_names
@dataclass(frozen=True, init=False)
class Certification:
    """The further runs that a certificate makes.

    Parameters
    ----------
    nudge : float, optional
        Largest relative change of each parameter in turn, up and down [1].
    reach : float, optional
        Largest relative change of the motion's scale [1].
    runs : int, optional
        Largest number of further runs. If the verdict changes often, more runs allow larger
        changes of scale to be examined.

    Raises
    ------
    UnitsError
        An argument is no ratio.
    ComponentError
        A nudge outside 0 to 0.1, a reach outside 0.01 to 0.9, or a number of runs outside
        60 to 100 000.

    Examples
    --------
    >>> import rockframe as rf
    >>> wide = rf.Certification(nudge=0.01, runs=400)
    >>> wide.nudge, wide.reach
    (0.01, 0.5)
    """

    nudge: float
    reach: float
    runs: int

    def __init__(self, *, nudge: float = 1e-3, reach: float = 0.5, runs: int = 200) -> None:
        owner = type(self).__name__
        values = {"nudge": (nudge, _SMALL), "reach": (reach, _REACH)}
        for name, (value, condition) in values.items():
            ratio = to_ratio(value, owner=owner, name=name, condition=condition)
            object.__setattr__(self, name, ratio)
        most = checked_integer(runs, owner=owner, name="runs", lowest=MIN_RUNS, highest=MAX_RUNS)
        object.__setattr__(self, "runs", most)


PROVED: Final = "proved"
"""Value of `certify` in place of a `Certification`: the verdict is to be proved."""
