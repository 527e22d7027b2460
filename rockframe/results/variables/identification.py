"""Variables of a free-decay test and of the parameters that were found from it."""

from enum import IntEnum
from typing import Final

from rockframe.results.variables.variable import TIME, Variable, count, flag
from rockframe.units import Unit

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
    Variable(
        "fitted_value", PARAMETER, Unit.ONE, "value for which the squared residuals are least"
    ),
    Variable("standard_error", PARAMETER, Unit.ONE, "standard error of the value"),
    Variable("lower_confidence_bound", PARAMETER, Unit.ONE, "lower end of the confidence interval"),
    Variable("upper_confidence_bound", PARAMETER, Unit.ONE, "upper end of the confidence interval"),
    Variable("start_value", PARAMETER, Unit.ONE, "value in the system that was given"),
    # the test itself
    Variable("initial_rotation", (), Unit.RADIAN, "rotation from which the block was let go"),
    Variable("initial_rotation_error", (), Unit.RADIAN, "standard error of the initial rotation"),
    Variable("release_time", (), Unit.SECOND, "time at which the block was let go"),
    Variable("release_time_error", (), Unit.SECOND, "standard error of the release time"),
    Variable("gauge_offset", (), Unit.RADIAN, "reading of the gauge where the block is upright"),
    Variable("gauge_offset_error", (), Unit.RADIAN, "standard error of the gauge's offset"),
    Variable(
        "correlation",
        ("unknown", "other_unknown"),
        Unit.ONE,
        "correlation of the errors of two unknowns",
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
    Variable(
        "residual_autocorrelation",
        (),
        Unit.ONE,
        "correlation of each residual of the rotation with the next",
    ),
    flag("fit_status", (), "why the fit ended", FitStatus),
    count("trial_count", "number of trials of the last fit, without those for derivatives"),
)
"""Of a fit to a free-decay test; those over peaks, or over time, as it was measured."""
