"""Rows of the schema of studies: sweeps, critical scales, comparisons of models, fitted tests."""

from enum import IntEnum
from typing import Final

from rockframe.results.variables.variable import (
    FLIP,
    SCALE,
    TIME,
    Variable,
    count,
    counting,
    flag,
    number,
    whether,
)
from rockframe.units import Unit

CASE: Final = "case"
MOTION: Final = "motion"
"""Dimensions of sweeps, beside their axes."""
MESSAGE: Final = "message"
"""What is said of each case."""
REPEATED: Final = "repeated"
VERDICT_CHANGED: Final = "verdict_changed"
"""What is told of each case of a screened sweep."""


class Outcome(IntEnum):
    """Verdict of a run among others."""

    STANDS = 0
    OVERTURNS = 1
    UNDECIDED = 2


CRITICAL_SCALE: Final = (
    number(
        "critical_scale",
        "least scale of the motion that was found to overturn the block, NaN if none",
    ),
    number(
        "followed_scale",
        "scale of the motion up to which no gap between runs is wider than the resolution",
    ),
    number(
        "largest_gap",
        "largest distance between neighbouring scales with a verdict: pairs of flips that are "
        "closer together may be missed",
    ),
    number(
        "uplift_scale",
        "scale of the motion up to which the block stays at rest, NaN if that needs runs",
    ),
    number("scale_below", "greatest scale of the motion tried before the flip", FLIP),
    number("scale_above", "least scale of the motion tried after the flip", FLIP),
    whether(
        "overturns_above",
        "whether the block overturns after the flip, and stands before it, or the other way round",
        FLIP,
    ),
    number("scale", "factor of the ground motion", SCALE),
    flag("outcome", SCALE, "verdict of the run", Outcome),
)
"""Of a motion that is scaled until a block overturns."""

SWEEP: Final = (
    counting(CASE, "number of the row in the table of cases"),
    Variable(MOTION, (MOTION,), None, "ground motion", dtype="str"),
    Variable(MESSAGE, (), None, "what is said of the case, none if nothing", dtype="str"),
    whether(
        REPEATED,
        "whether the case was run again by tolerance, its verdict at fixed steps being in doubt",
    ),
    whether(VERDICT_CHANGED, "whether the case then had another verdict"),
)
"""Of a sweep, beside the scalars of its runs."""


COMPARISON: Final = (
    Variable("run_time", (), Unit.SECOND, "wall time of a run, median of the repetitions"),
    Variable("run_time_least", (), Unit.SECOND, "least wall time of a run"),
    Variable("run_time_greatest", (), Unit.SECOND, "greatest wall time of a run"),
    number(
        "numerical_peak_error",
        "relative error of peak rotation or slip, against the same model at a tight tolerance",
    ),
    number(
        "numerical_history_error",
        "largest error of the rotation over its peak, against the same model at a tight tolerance",
    ),
    Variable(
        "event_time_error",
        (),
        Unit.SECOND,
        "largest error of an event's time, NaN if the events are others",
    ),
    number("peak_error", "relative error of peak rotation or slip, against the scene itself"),
    number(
        "history_error", "largest error of the rotation over its peak, against the scene itself"
    ),
    whether("verdict_agrees", "whether the verdict is that of the scene itself"),
)
"""One for each rung."""


PARAMETER: Final = ("parameter",)
PEAK: Final = ("peak",)


class FitStatus(IntEnum):
    """Why a fit ended, in SciPy's numbers."""

    TRIAL_LIMIT = 0
    GRADIENT_VANISHED = 1
    COST_STEADY = 2
    VALUES_STEADY = 3
    COST_AND_VALUES_STEADY = 4


FREE_DECAY: Final = (
    # the parameters
    number("fitted_value", "value for which the squared residuals are least", PARAMETER),
    number("standard_error", "standard error of the value", PARAMETER),
    number("lower_confidence_bound", "lower end of the confidence interval", PARAMETER),
    number("upper_confidence_bound", "upper end of the confidence interval", PARAMETER),
    number("start_value", "value in the system that was given", PARAMETER),
    # the test itself
    Variable("initial_rotation", (), Unit.RADIAN, "rotation from which the block was let go"),
    Variable("initial_rotation_error", (), Unit.RADIAN, "standard error of the initial rotation"),
    Variable("release_time", (), Unit.SECOND, "time at which the block was let go"),
    Variable("release_time_error", (), Unit.SECOND, "standard error of the release time"),
    Variable("gauge_offset", (), Unit.RADIAN, "reading of the gauge where the block is upright"),
    Variable("gauge_offset_error", (), Unit.RADIAN, "standard error of the gauge's offset"),
    number(
        "correlation", "correlation of the errors of two unknowns", ("unknown", "other_unknown")
    ),
    # measured and fitted
    Variable("measured_rotation", TIME, Unit.RADIAN, "rotation as measured"),
    Variable(
        "fitted_rotation", TIME, Unit.RADIAN, "rotation of the fitted system, as a gauge shows"
    ),
    Variable("rotation_residual", TIME, Unit.RADIAN, "measured less fitted rotation"),
    Variable("measured_peak_rotation", PEAK, Unit.RADIAN, "peak rotation as measured"),
    Variable("fitted_peak_rotation", PEAK, Unit.RADIAN, "peak rotation of the fitted system"),
    Variable("peak_rotation_residual", PEAK, Unit.RADIAN, "measured less fitted peak rotation"),
    Variable("measured_peak_time", PEAK, Unit.SECOND, "time of a peak as measured"),
    Variable("fitted_peak_time", PEAK, Unit.SECOND, "time of a peak of the fitted system"),
    Variable("peak_time_residual", PEAK, Unit.SECOND, "measured less fitted time of a peak"),
    Variable(
        "rotation_rms_residual", (), Unit.RADIAN, "root mean square of the rotations' residuals"
    ),
    Variable("time_rms_residual", (), Unit.SECOND, "root mean square of the times' residuals"),
    number(
        "residual_autocorrelation", "correlation of each residual of the rotation with the next"
    ),
    flag("fit_status", (), "why the fit ended", FitStatus),
    count("trial_count", "number of trials of the last fit, without those for derivatives"),
)
"""Of a fit to a free-decay test; those over peaks, or over time, as it was measured."""
