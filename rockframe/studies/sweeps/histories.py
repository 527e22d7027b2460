"""What a sweep keeps beside scalars: histories on times that all cases have, peaks at points."""

from collections.abc import Mapping

from rockframe.errors import StudyError
from rockframe.motion import GroundMotion
from rockframe.results.schema import GROUPS, SCHEMA
from rockframe.results.variables.requests import FORCE_SCALARS, POINT_PEAKS, POINT_TIME, POINTS
from rockframe.results.variables.runs import EVENTS_AND_SCALARS, HISTORIES
from rockframe.results.variables.studies import SWEEP
from rockframe.results.variables.variable import TIME
from rockframe.simulation.outputs import listed
from rockframe.simulation.plan import STILL_GROUND_OUTPUT_STEP, RunRequest, run_length
from rockframe.studies.sweeps.scenes import FunctionScene, SweptScene
from rockframe.studies.sweeps.study import Histories


def numbers_of_case(
    arguments: RunRequest, kept: Histories | None, *, screened: bool
) -> dict[str, float]:
    """Tell how many numbers are kept of a case, by what they are."""
    points = len(arguments.points)
    every = [*EVENTS_AND_SCALARS, *FORCE_SCALARS, *(SWEEP if screened else ())]
    numbers = {"scalars": float(sum(not row.dims for row in every))}
    if points:
        numbers[f"peaks at {points} points"] = float(len(POINT_PEAKS) * points)
    if kept is not None:
        names = kept.names or [row.name for row in (*HISTORIES, *POINTS) if TIME[0] in row.dims]
        several = sum(points if SCHEMA[name].dims == POINT_TIME else 1 for name in names)
        numbers[f"{several} histories of {kept.count} times"] = float(several * kept.count)
    return numbers


def kept_histories(
    scene: SweptScene,
    motions: Mapping[str, GroundMotion | None],
    arguments: RunRequest,
    outputs: object,
) -> Histories | None:
    """Find the histories that are kept, and the times that those of all cases have."""
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
    longest = max(run_length(arguments, motion) for motion in motions.values())
    return Histories(names or None, step, 1 + int(longest / step * (1.0 + 1e-12)))
