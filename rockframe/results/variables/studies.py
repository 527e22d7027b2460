"""Rows of the schema of studies: sweeps, critical scales, comparisons of models, fitted tests."""

from enum import IntEnum
from typing import Final

from rockframe.results.variables.variable import FLIP, SCALE, TIME, rows_over

CASE: Final = "case"
MOTION: Final = "motion"
"""Dimensions of sweeps, beside their axes."""
MESSAGE: Final = "message"
"""Variable with messages about each case."""
CAUTIONS: Final = "cautions"
"""Attribute of a single run, in the place of the messages of many."""
REPEATED: Final = "repeated"
VERDICT_CHANGED: Final = "verdict_changed"
"""Variables of each case of a screened sweep."""


class Outcome(IntEnum):
    """Verdict of a run among others."""

    STANDS = 0
    OVERTURNS = 1
    UNDECIDED = 2


CRITICAL_SCALE: Final = (
    *rows_over(
        (),
        critical_scale="least scale of the motion that was found to overturn the block, NaN if "
        "none",
        followed_scale="scale of the motion up to which no gap between runs is wider than the "
        "resolution",
        largest_gap="largest distance between neighbouring scales with a verdict: pairs of flips "
        "that are closer together may be missed",
        uplift_scale="scale of the motion up to which the block stays at rest, NaN if that needs "
        "runs",
    ),
    *rows_over(
        FLIP,
        scale_below="greatest scale of the motion tried before the flip",
        scale_above="least scale of the motion tried after the flip",
        overturns_above=(
            "whether the block overturns after the flip, and stands before it, or the other way "
            "round",
            bool,
        ),
    ),
    *rows_over(
        SCALE,
        scale="factor of the ground motion",
        outcome=("verdict of the run", Outcome),
    ),
)
"""Variables of a motion that is scaled until a block overturns."""

SWEEP: Final = (
    *rows_over((CASE,), **{CASE: ("number of the row in the table of cases", int)}),
    *rows_over((MOTION,), **{MOTION: ("ground motion", str)}),
    *rows_over(
        (),
        message=("message about the case, none if there is none", str),
        repeated=(
            "whether the case was run again with adaptive steps, since its verdict at fixed steps "
            "was not certain",
            bool,
        ),
        verdict_changed=("whether the repeated run of the case had another verdict", bool),
    ),
)
"""Variables of a sweep, beside the scalars of its runs."""


COMPARISON: Final = rows_over(
    (),
    run_time="wall time of a run, median of the repetitions [s]",
    run_time_least="least wall time of a run [s]",
    run_time_greatest="greatest wall time of a run [s]",
    numerical_peak_error="relative error of peak rotation or slip, against the same model at a "
    "tight tolerance",
    numerical_history_error="largest error of the rotation over its peak, against the same model "
    "at a tight tolerance",
    event_time_error="largest error of an event's time, NaN if the events are others [s]",
    peak_error="relative error of peak rotation or slip, against the scene itself",
    history_error="largest error of the rotation over its peak, against the scene itself",
    verdict_agrees=("whether the verdict is that of the scene itself", bool),
)
"""Variables of a comparison of models, with a value for each model."""


PARAMETER: Final = ("parameter",)
PEAK: Final = ("peak",)


class FitStatus(IntEnum):
    """Why a fit ended, by the status codes of SciPy."""

    TRIAL_LIMIT = 0
    GRADIENT_VANISHED = 1
    COST_STEADY = 2
    VALUES_STEADY = 3
    COST_AND_VALUES_STEADY = 4


FREE_DECAY: Final = (
    *rows_over(
        PARAMETER,
        fitted_value="value for which the squared residuals are least",
        standard_error="standard error of the value",
        lower_confidence_bound="lower end of the confidence interval",
        upper_confidence_bound="upper end of the confidence interval",
        start_value="value in the system that was given",
    ),
    *rows_over(
        (),
        initial_rotation="rotation from which the block was released [rad]",
        initial_rotation_error="standard error of the initial rotation [rad]",
        release_time="time at which the block was released [s]",
        release_time_error="standard error of the release time [s]",
        gauge_offset="reading of the gauge while the block is upright [rad]",
        gauge_offset_error="standard error of the gauge's offset [rad]",
    ),
    *rows_over(
        ("unknown", "other_unknown"), correlation="correlation of the errors of two unknowns"
    ),
    *rows_over(
        TIME,
        measured_rotation="rotation as measured [rad]",
        fitted_rotation="rotation of the fitted system, as a gauge shows [rad]",
        rotation_residual="measured less fitted rotation [rad]",
    ),
    *rows_over(
        PEAK,
        measured_peak_rotation="peak rotation as measured [rad]",
        fitted_peak_rotation="peak rotation of the fitted system [rad]",
        peak_rotation_residual="measured less fitted peak rotation [rad]",
        measured_peak_time="time of a peak as measured [s]",
        fitted_peak_time="time of a peak of the fitted system [s]",
        peak_time_residual="measured less fitted time of a peak [s]",
    ),
    *rows_over(
        (),
        rotation_rms_residual="root mean square of the rotations' residuals [rad]",
        time_rms_residual="root mean square of the times' residuals [s]",
        residual_autocorrelation="correlation of each residual of the rotation with the next",
        fit_status=("why the fit ended", FitStatus),
        trial_count=("number of trials of the last fit, without those for derivatives", int),
    ),
)
"""Variables of a fit to a free-decay test: over peaks or over time, whichever was measured."""
