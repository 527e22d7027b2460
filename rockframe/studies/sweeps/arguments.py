"""The arguments shared by sweeps and the analyses based on them."""

from concurrent.futures import Executor
from os import PathLike
from typing import Annotated, Final, TypedDict

from rockframe.components import InitialState
from rockframe.shared_arguments import Argument
from rockframe.simulation.run_arguments import HOW_ACCURATE, START, CourseLike, LengthArguments
from rockframe.solve.accuracy import AccuracyLevel
from rockframe.system.options import SweepAccuracyLike


class CourseArguments(TypedDict, total=False):
    """How each run goes."""

    initial: Annotated[InitialState | None, START]
    accuracy: Annotated[
        SweepAccuracyLike,
        Argument(
            AccuracyLevel.STANDARD,
            HOW_ACCURATE.kind.replace('"reference"', '"reference", "screen"'),
            f'{HOW_ACCURATE.words} ``"screen"`` runs all cases at ``"fast"``, and those near a '
            'flip of their verdict again at ``"standard"``, :eq:`eq-screened`; all at '
            '``"standard"`` where that costs less, as on rigid ground and under pulses.',
        ),
    ]
    overturning: CourseLike


class ExecutionArguments(TypedDict, total=False):
    """How the runs are executed, and where they are kept."""

    store: Annotated[
        str | PathLike[str] | None,
        Argument(
            None,
            "str or path, optional",
            "A folder in which what has been run is kept. The same call goes on with what it "
            "finds there.",
        ),
    ]
    executor: Annotated[
        Executor | None,
        Argument(
            None,
            "concurrent.futures.Executor, optional",
            "Makes the runs; threads, one for each processor, unless given.",
        ),
    ]
    chunk: Annotated[
        int | None,
        Argument(
            None,
            "int, optional",
            "Cases that are handed out, and kept, together; what takes about a second unless "
            "given. A `store` keeps to what it was begun with.",
        ),
    ]
    progress: Annotated[
        bool | None,
        Argument(
            None,
            "bool, optional",
            "Whether a bar shows how far it is (needs tqdm); where it can be seen unless given. "
            "Where runs come in rounds, one bar counts them all, and its total grows.",
        ),
    ]


class SequenceArguments(CourseArguments, ExecutionArguments, total=False):
    """Options of sweeps whose motions have individual lengths."""


class SweepArguments(LengthArguments, SequenceArguments, total=False):
    """Options of sweeps, and of all analyses that pass them on."""


OF_A_SWEEP: Final = (
    *SweepArguments.__annotations__, "cases", "period", "output_step", "outputs", "points",
)  # fmt: skip
"""Names of arguments that a misspelt axis may stand for."""
