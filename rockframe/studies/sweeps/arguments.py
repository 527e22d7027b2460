"""The arguments shared by sweeps and the analyses based on them."""

from concurrent.futures import Executor
from os import PathLike
from typing import Annotated, Final, TypedDict

from rockframe.components import InitialState
from rockframe.shared_arguments import Argument
from rockframe.simulation.run_arguments import (
    ACCURACY_ARGUMENT,
    INITIAL_ARGUMENT,
    LengthArguments,
    OverturningArgument,
)
from rockframe.solve.accuracy import AccuracyLevel
from rockframe.system.options import SweepAccuracyLike


class CourseArguments(TypedDict, total=False):
    """Start, accuracy and end of each run."""

    initial: Annotated[InitialState | None, INITIAL_ARGUMENT]
    accuracy: Annotated[
        SweepAccuracyLike,
        Argument(
            AccuracyLevel.STANDARD,
            ACCURACY_ARGUMENT.kind.replace('"reference"', '"reference", "screen"'),
            f'{ACCURACY_ARGUMENT.description} ``"screen"`` runs all cases at ``"fast"``, and those '
            'near a flip of their verdict again at ``"standard"``, :eq:`eq-screened`; all at '
            '``"standard"`` where that costs less, as on rigid ground and under pulses.',
        ),
    ]
    overturning: OverturningArgument


class ExecutionArguments(TypedDict, total=False):
    """How the runs are executed, and where they are kept."""

    store: Annotated[
        str | PathLike[str] | None,
        Argument(
            None,
            "str or path, optional",
            "A folder in which results are kept. The same call continues from them.",
        ),
    ]
    executor: Annotated[
        Executor | None,
        Argument(
            None,
            "concurrent.futures.Executor, optional",
            "Executes the runs. By default threads, one for each processor.",
        ),
    ]
    chunk: Annotated[
        int | None,
        Argument(
            None,
            "int, optional",
            "Number of cases that are submitted and stored together. By default as many as take "
            "about a second. A `store` keeps its original value.",
        ),
    ]
    progress: Annotated[
        bool | None,
        Argument(
            None,
            "bool, optional",
            "Whether to show a progress bar (needs tqdm). By default it is shown where it is "
            "visible. If runs come in rounds, one bar counts all of them, and its total grows.",
        ),
    ]


class SequenceArguments(CourseArguments, ExecutionArguments, total=False):
    """Options of sweeps whose motions have individual lengths."""


class SweepArguments(LengthArguments, SequenceArguments, total=False):
    """Options of sweeps, and of all analyses that pass them on."""


SWEEP_ARGUMENT_NAMES: Final = (
    *SweepArguments.__annotations__, "cases", "period", "output_step", "outputs", "points",
)  # fmt: skip
"""Names of arguments that a misspelt axis may stand for."""
