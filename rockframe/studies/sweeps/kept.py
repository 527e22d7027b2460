"""What a sweep keeps beside scalars: histories on times that all cases have, peaks at points."""

from collections.abc import Mapping
from typing import Final

from rockframe.errors import StudyError
from rockframe.motion import GroundMotion
from rockframe.results.schema import GROUPS, SCHEMA
from rockframe.results.variables.requests import POINT_PEAKS, POINT_TIME, POINTS
from rockframe.results.variables.runs import HISTORIES
from rockframe.results.variables.variable import TIME
from rockframe.simulation.asked import listed
from rockframe.simulation.plan import STILL_GROUND_OUTPUT_STEP, Arguments, length_of
from rockframe.studies.sweeps.scenes import FunctionScene, Scene
from rockframe.studies.sweeps.study import Histories

MOST_VALUES: Final = 1e9
"""Values of histories, or at points, beyond which a sweep is refused: eight gigabytes."""


def too_many_peaks(points: int, cases: int) -> list[str]:
    """Tell whether the peaks at points would not fit into memory."""
    if len(POINT_PEAKS) * points * float(cases) <= MOST_VALUES:
        return []
    return [f"the peaks at {points} points of {cases} cases are more than {MOST_VALUES:.0e} values"]


def kept_histories(
    scene: Scene,
    motions: Mapping[str, GroundMotion | None],
    arguments: Arguments,
    outputs: object,
    count: int,
) -> Histories | None:
    """Find the histories that are kept, and the times that those of all cases have.

    Parameters
    ----------
    scene : Scene
        What is simulated.
    motions : mapping of str to GroundMotion or None
        By their names.
    arguments : Arguments
        Of every run.
    outputs : object
        As the user gave them, and as they have been read.
    count : int
        Number of cases.

    Returns
    -------
    Histories or None
        None where none are kept.

    Raises
    ------
    StudyError
        There are no such histories, no common times, or too many values.
    """
    if not arguments.histories:
        return None
    named = [str(name) for name in listed(outputs)]
    names = tuple(dict.fromkeys(one for name in named for one in GROUPS.get(name, (name,))))
    wrong = [name for name in names if SCHEMA[name].dims not in (TIME, POINT_TIME)]
    if wrong:
        msg = f"outputs: {', '.join(wrong)} are no histories, which a sweep could keep"
        raise StudyError(msg)
    own = isinstance(scene, FunctionScene) and None in motions.values()
    if own and (arguments.duration is None or arguments.output_step is None):
        msg = "histories of motions that the function makes need a duration and an output_step"
        raise StudyError(msg)
    step = arguments.output_step
    if step is None:
        steps = {
            STILL_GROUND_OUTPUT_STEP if motion is None else motion.si.time_step
            for motion in motions.values()
        }
        if len(steps) > 1:
            msg = (
                "the motions have different time steps, so that their histories have no common "
                "times; give an output_step"
            )
            raise StudyError(msg)
        (step,) = steps
    longest = max(length_of(arguments, motion) for motion in motions.values())
    kept = Histories(names or None, step, 1 + int(longest / step * (1.0 + 1e-12)))
    every = names or [row.name for row in (*HISTORIES, *POINTS) if TIME[0] in row.dims]
    several = sum(len(arguments.points) if SCHEMA[name].dims == POINT_TIME else 1 for name in every)
    if several * float(kept.count) * count > MOST_VALUES:
        msg = (
            f"{several} histories of {kept.count} times in {count} cases are more than "
            f"{MOST_VALUES:.0e} values; name fewer outputs, or give a longer output_step"
        )
        raise StudyError(msg)
    return kept
