"""Whether screening a sweep costs less than running all of it by tolerance."""

import math
from collections.abc import Iterable
from typing import Final

from rockframe.errors import RockframeError
from rockframe.motion import GroundMotion
from rockframe.simulation.certify.second_look import more_steps
from rockframe.simulation.plan import RunRequest, run_length
from rockframe.solve.accuracy import LEVELS, fastest_rate, substeps_of
from rockframe.solve.integrate import STILL_INTERVAL
from rockframe.studies.sweeps.runs import FIRST
from rockframe.system.alone import AloneSetting
from rockframe.system.assembly import Assembly

SHAKEN: Final = 45.0
"""Steps by tolerance in the shortest period while the ground moves: 35 to 50 on pads, 25 to 30 on
soil, as counted under records."""
STILL: Final = 20.0
"""The same behind the motion, where vibrations die away: 10 to 20 on soil, 25 to 45 on pads."""
STEPS_OF_A_CASE: Final = 650.0
"""Steps of fixed length that take as long as what else the second run of a case does."""
COST: Final = 4.0 / 3.0
"""Cost of a step by tolerance over that of a fixed one; both as measured one case at a time."""


def pays_to_screen(
    system: Assembly, motions: Iterable[GroundMotion | None], arguments: RunRequest
) -> bool:
    """Tell whether two runs by fixed steps cost less than one by tolerance, by their numbers.

    Of scenes of one body on a base that gives way; of more bodies steps are dear, and on rigid
    ground there are no more by tolerance.
    """
    if not system.setting.steps_cost_most:
        return False
    if not isinstance(system.setting, AloneSetting):
        return True
    try:
        counts = [_counts(system, motion, arguments) for motion in motions]
    except RockframeError:  # of a scene that cases have otherwise
        return True
    fixed, by_tolerance = map(sum, zip(*counts, strict=True))
    return fixed + STEPS_OF_A_CASE * len(counts) < COST * by_tolerance


def _counts(
    system: Assembly, motion: GroundMotion | None, arguments: RunRequest
) -> tuple[float, float]:
    """Give the numbers of fixed steps of both runs, and of those by tolerance, about."""
    duration = run_length(arguments, motion)
    interval = STILL_INTERVAL if motion is None else motion.si.time_step
    shaken = 0.0 if motion is None else min(motion.si.duration, duration)
    substeps = max(substeps_of(LEVELS[FIRST], system.model, interval), 1)
    fixed = duration / interval * (substeps + more_steps(substeps))
    rate = fastest_rate(system.model) / (2.0 * math.pi)
    return fixed, shaken * max(1.0 / interval, SHAKEN * rate) + (duration - shaken) * STILL * rate
