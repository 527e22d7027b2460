"""What a run is asked for, as users write it: each argument with its type, default and meaning."""

from collections.abc import Sequence
from typing import Annotated, Final, TypeAlias, TypedDict

import xarray as xr

from rockframe.components import InitialState
from rockframe.shared_arguments import Argument
from rockframe.solve.accuracy import AccuracyLevel
from rockframe.system.options import AccuracyLike, Overturning, OverturningLike, PointsLike
from rockframe.units import QuantityLike

START: Final = Argument(
    None, "InitialState, optional", "Where the runs start; at rest unless given."
)
HOW_ACCURATE: Final = Argument(
    AccuracyLevel.STANDARD,
    '{"fast", "standard", "reference"}, float or Accuracy, optional',
    "How accurate, and so how costly, the runs are.",
)
VERDICT: Final = Argument(
    Overturning.STOP,
    '{"stop", "continue"}, optional',
    "What is called overturning: that the rotation reaches the overturning angle, where the run "
    "then ends; or that the block lies flat by the end of the run, for it may come back from "
    "beyond the angle while the ground moves.",
)

OutputStep: TypeAlias = Annotated[
    QuantityLike | None,
    Argument(
        None,
        "str or Quantity, optional",
        "Spacing of the histories; the time step of the motion unless given [s].",
    ),
]
CourseLike: TypeAlias = Annotated[OverturningLike, VERDICT]


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
    """All that :meth:`rockframe.System.simulate` asks of a run, and passes on."""

    initial: InitialState | xr.Dataset | None
    accuracy: AccuracyLike
    output_step: QuantityLike | None
    outputs: Sequence[str] | None
    points: PointsLike | None
    overturning: OverturningLike


class ScaleArguments(LengthArguments, total=False):
    """Of runs one after the other that differ in the scale of their motion."""

    initial: Annotated[
        InitialState | xr.Dataset | None,
        Argument(
            None,
            "InitialState or xarray.Dataset, optional",
            "Where the runs start; at rest unless given. The result of another run of this "
            "system starts them where that one ended.",
        ),
    ]
    accuracy: Annotated[AccuracyLike, HOW_ACCURATE]
    overturning: CourseLike


class ComparedArguments(LengthArguments, total=False):
    """Of runs of which models and accuracies are compared."""

    initial: Annotated[InitialState | None, START]
    output_step: OutputStep
