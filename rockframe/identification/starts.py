"""Where the search for the unknowns starts."""

import math
from collections.abc import Collection
from typing import Final

from rockframe.identification.free_motion import let_go
from rockframe.identification.measured import History, MeasuredPeaks
from rockframe.identification.prediction import EARLIER
from rockframe.identification.swings import Swings, restitution_of
from rockframe.identification.unknowns import Circumstance, TrialSystems, Unknown
from rockframe.simulation.system import System
from rockframe.solve.accuracy import Accuracy
from rockframe.system.options import Rotation

_LARGEST: Final = 1.0 - 1e-6
"""Share of the overturning angle below which a block is let go."""


def starts_of(
    system: System,
    trials: TrialSystems,
    measured: History | MeasuredPeaks,
    swings: Swings | None,
    sought: Collection[Circumstance],
    accuracy: Accuracy,
) -> dict[str, Unknown]:
    """Give start values and bounds of the parameters, and of all circumstances."""
    peaks = (
        measured
        if isinstance(measured, MeasuredPeaks)
        else None
        if swings is None
        else swings.peaks
    )
    offset = 0.0
    if swings is not None and Circumstance.GAUGE_OFFSET in sought:
        offset = swings.offset
    first = float(measured.rotation[0] if peaks is None else peaks.rotation[0]) - offset
    starts = {name: place.unknown(name) for name, place in trials.places.items()}
    if system.setting.settlement is None and peaks is not None and peaks.rotation.size > 1:
        found = restitution_of(
            peaks.rotation - offset,
            system.setting.overturning_angle,
            small_rotation=system.rotation is Rotation.SMALL,
        )
        for name, place in trials.places.items():
            if place.argument == "restitution":
                starts[name] = place.unknown(name).started_at(found)
    limit = math.copysign(_LARGEST * system.setting.overturning_angle, first)
    rotation = Unknown(
        Circumstance.INITIAL_ROTATION, first, abs(first), min(limit, 0.0), max(limit, 0.0)
    ).started_at(first)
    period = math.sqrt(trials.radius / trials.gravity)
    release = Unknown(Circumstance.RELEASE_TIME, 0.0, period)
    if isinstance(measured, History):
        begin, end, span = float(measured.time[0]), float(measured.time[-1]), measured.span
        values = {name: one.start for name, one in starts.items()}
        swing = let_go(trials.assembly(values), rotation.start, span, accuracy).crossing()
        release = Unknown(Circumstance.RELEASE_TIME, begin, period, begin - EARLIER * span, end)
        if swings is not None and Circumstance.RELEASE_TIME in sought:
            release = release.started_at(swings.crossing - swing)
    elif measured.time is not None:
        release = release.started_at(float(measured.time[0]))
    gauge = Unknown(Circumstance.GAUGE_OFFSET, offset, abs(first))
    return {**starts, **{one.name: one for one in (rotation, release, gauge)}}
