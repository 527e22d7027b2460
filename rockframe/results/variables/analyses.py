"""Variables of analyses: dynamic analysis, fragility, maps, spectra and probabilities."""

from enum import IntEnum
from typing import Final

from rockframe.results.variables.studies import PARAMETER
from rockframe.results.variables.variable import FLIP, Variable, bounds, count, counting, flag
from rockframe.units import Unit

LIMIT_STATE: Final = ("limit_state",)
STRIPE: Final = ("stripe",)
BOUNDARY: Final = ("boundary",)
COEFFICIENT: Final = ("coefficient",)
RANK: Final = ("rank",)
QUANTILE: Final = ("quantile",)
RUN: Final = ("run",)
COVARIATE: Final = ("covariate",)
LEVEL: Final = ("sampling_level",)


class FragilityStatus(IntEnum):
    """Whether a lognormal capacity fits the trials best, or why none does."""

    FITTED = 0
    NONE_EXCEEDED = 1
    ALL_EXCEEDED = 2
    SEPARATED = 3
    NOT_RISING = 4
    ONE_INTENSITY = 5
    NO_TRIALS = 6


DYNAMIC_ANALYSIS: Final = (
    Variable("limit_state", LIMIT_STATE, None, "limit state", dtype="str"),
    Variable(
        "rotation_limit",
        LIMIT_STATE,
        Unit.ONE,
        "peak rotation over the overturning angle that exceeds the limit state, 0 for uplift",
    ),
    Variable(
        "exceeds_above",
        FLIP,
        None,
        "whether the limit state is exceeded after the flip, and not before it",
        dtype="bool",
    ),
    count("flip_count", "number of changes of the verdict that were found"),
    Variable(
        "capacity_scale",
        (),
        Unit.ONE,
        "least scale of the motion that was found to exceed the limit state, infinite if none",
    ),
    Variable(
        "capacity_resolution",
        (),
        Unit.ONE,
        "widest range of scales, over its upper end, that may exceed unseen below the capacity",
    ),
    count("censored_count", "number of motions under which no scale exceeded the limit state"),
)
"""Of motions that are scaled until limit states are exceeded."""

FRACTILES: Final = (
    Variable(
        "motion_response",
        (),
        Unit.ONE,
        "response under a motion, infinite where the block overturns, in its own unit",
    ),
    Variable(
        "response_fractile",
        (),
        Unit.ONE,
        "response that this share of the motions does not exceed at the intensity",
    ),
    count("overturned_count", "number of motions that overturn the block at the intensity"),
    Variable("response_level", ("response_level",), Unit.ONE, "level of the response"),
    Variable(
        "intensity_fractile",
        (),
        Unit.ONE,
        "intensity by which this share of the motions has first reached the level",
    ),
    count("unreached_count", "number of motions that never reach the level"),
)
"""Of motions that are scaled, in summary."""

FRAGILITY: Final = (
    flag("fragility_status", (), "whether a lognormal capacity fits the trials", FragilityStatus),
    Variable(
        "median_intensity",
        (),
        Unit.ONE,
        "median of the capacity, in the unit of the intensity",
    ),
    *bounds("median_intensity", (), "{} bound of the median, of nominal confidence"),
    Variable(
        "separation_lower_intensity",
        (),
        Unit.ONE,
        "greatest intensity of a trial that does not exceed, where trials are separated",
    ),
    Variable(
        "separation_upper_intensity",
        (),
        Unit.ONE,
        "least intensity of a trial that exceeds, where trials are separated",
    ),
    Variable("log_median_error", (), Unit.ONE, "standard error of the logarithm of the median"),
    Variable("dispersion", (), Unit.ONE, "standard deviation of the logarithm of the capacity"),
    *bounds("dispersion", (), "{} bound of the dispersion, of nominal confidence"),
    Variable("dispersion_error", (), Unit.ONE, "standard error of the dispersion"),
    count("trial_count", "number of runs, or of capacities, that count"),
    count("left_out_count", "number of those left out, without a result that counts"),
    count("independent_count", "number of motions, or of trials, that are independent"),
    count("below_scan_count", "number of capacities at or below the least scale of the scan"),
    Variable(
        "exceedance_probability", (), Unit.ONE, "probability that the limit state is exceeded"
    ),
    *bounds("exceedance_probability", (), "{} bound of the probability, confidence nominal"),
    Variable(
        "coefficient", COEFFICIENT, None, "what a coefficient of the fit stands before", dtype="str"
    ),
    Variable(
        "fitted_coefficient",
        COEFFICIENT,
        Unit.ONE,
        "coefficient before the logarithm of an intensity in SI units, or the intercept",
    ),
    Variable(
        "fitted_coefficient_error", COEFFICIENT, Unit.ONE, "standard error of the coefficient"
    ),
    # what was counted
    Variable(
        "stripe_intensity", STRIPE, Unit.ONE, "intensity of a group of trials, in its own unit"
    ),
    Variable("stripe_trials", STRIPE, Unit.ONE, "number of trials in the group", dtype="int64"),
    Variable(
        "stripe_exceedances",
        STRIPE,
        Unit.ONE,
        "number of trials in the group that exceeded the limit state",
        dtype="int64",
    ),
    Variable("stripe_fraction", STRIPE, Unit.ONE, "share of the group that exceeded"),
    *bounds("stripe_fraction", STRIPE, "{} confidence bound of the share"),
    Variable(
        "velocity_to_acceleration_ratio",
        (),
        Unit.SECOND,
        "peak ground velocity over peak ground acceleration",
    ),
)
"""Of lognormal capacities."""

CLOUD: Final = (
    Variable(
        "regression_intercept",
        (),
        Unit.ONE,
        "logarithm of the response at an intensity of one, both in SI units",
    ),
    Variable(
        "regression_slope", (), Unit.ONE, "power of the intensity with which the response grows"
    ),
    Variable("regression_slope_error", (), Unit.ONE, "standard error of that power"),
    Variable(
        "residual_dispersion",
        (),
        Unit.ONE,
        "standard deviation of the logarithm of the response at an intensity",
    ),
    Variable(
        "determination", (), Unit.ONE, "share of the variance of the logarithms that the line tells"
    ),
    Variable("logistic_intercept", (), Unit.ONE, "intercept of the logistic curve of overturning"),
    Variable(
        "logistic_slope",
        (),
        Unit.ONE,
        "slope of the logistic curve of overturning over the logarithm of the intensity",
    ),
    Variable("logistic_slope_error", (), Unit.ONE, "standard error of that slope"),
    count("cloud_overturned_count", "number of runs that overturned"),
    count("resting_count", "number of runs in which nothing moved"),
    Variable("response_limit", (), Unit.ONE, "level of the response, infinite for overturning"),
    Variable("cloud_intensity", RUN, Unit.ONE, "intensity of a run, in the unit of the measure"),
    Variable(
        "cloud_response", RUN, Unit.ONE, "response of a run, infinite where the block overturned"
    ),
)
"""Of many motions, each at one scale."""

MEASURE_COMPARISON: Final = (
    Variable("measure", ("measure",), None, "intensity measure", dtype="str"),
    Variable("covariate", ("covariate",), None, "what a response may depend on too", dtype="str"),
    Variable(
        "efficiency_ratio", (), Unit.ONE, "dispersion of the response over the power it grows with"
    ),
    Variable(
        "sufficiency_slope",
        COVARIATE,
        Unit.ONE,
        "slope of the residuals, per unit of the covariate",
    ),
    Variable(
        "sufficiency_p_value",
        COVARIATE,
        Unit.ONE,
        "probability of a slope as great if the response did not depend on the covariate",
    ),
    Variable(
        "relative_sufficiency",
        (),
        Unit.ONE,
        "information that the measure gives on the runs more than the first, in bits a run",
    ),
    Variable("relative_sufficiency_error", (), Unit.ONE, "standard error of that information"),
    count("line_count", "number of runs that moved and did not overturn"),
)
"""Of measures side by side."""

HAZARD: Final = (
    Variable(
        "annual_rate",
        (),
        Unit.ONE,
        "number of times a year that the limit state is exceeded on average",
    ),
    *bounds("annual_rate", (), "the same of the {} bound of the fragility"),
    Variable(
        "unreached_rate_below",
        (),
        Unit.ONE,
        "annual rate that arises below the hazard curve, if it goes on as it ends",
    ),
    Variable(
        "unreached_rate_above",
        (),
        Unit.ONE,
        "annual rate that arises above the hazard curve, if it goes on as it ends",
    ),
    Variable(
        "outside_trials_share",
        (),
        Unit.ONE,
        "share of the annual rate that arises at intensities beyond those of all trials",
    ),
    Variable(
        "contributing_intensity",
        ("contributing_intensity",),
        Unit.ONE,
        "middle of a range of intensities, in the unit of the measure",
    ),
    Variable(
        "rate_share",
        ("contributing_intensity",),
        Unit.ONE,
        "share of the rate that arises in the range of intensities",
    ),
    Variable(
        "quantile_intensity", QUANTILE, Unit.ONE, "intensity below which that share of it arises"
    ),
)
"""Of limit states at a site."""

OVERTURNING_MAP: Final = (
    Variable(
        "amplitude",
        ("amplitude",),
        Unit.METRE_PER_SECOND_SQUARED,
        "amplitude of the ground acceleration",
    ),
    Variable(
        "impacts_before_overturning",
        (),
        Unit.ONE,
        "number of impacts before the block overturns, NaN if it does not",
    ),
    Variable(
        "amplitude_below",
        BOUNDARY,
        Unit.METRE_PER_SECOND_SQUARED,
        "greatest amplitude tried below the boundary",
    ),
    Variable(
        "amplitude_above",
        BOUNDARY,
        Unit.METRE_PER_SECOND_SQUARED,
        "least amplitude tried above the boundary",
    ),
    Variable(
        "impacts_below",
        BOUNDARY,
        Unit.ONE,
        "number of impacts before overturning below the boundary, NaN if the block stands",
    ),
    Variable(
        "impacts_above",
        BOUNDARY,
        Unit.ONE,
        "number of impacts before overturning above the boundary, NaN if the block stands",
    ),
    Variable("boundary_count", (), Unit.ONE, "number of boundaries", dtype="int64"),
)
"""Of pulses of any amplitude and frequency."""

SPECTRA: Final = (
    Variable(
        "rocking_period",
        ("rocking_period",),
        Unit.SECOND,
        "2 pi over the frequency parameter of the block",
    ),
    Variable("slenderness", ("slenderness",), Unit.ONE, "height over width of the block"),
    Variable(
        "capacity_intensity",
        (),
        Unit.ONE,
        "least intensity of the motion that was found to overturn the block, in its own unit",
    ),
)
"""Of blocks of all sizes."""

PROBABILITY: Final = (
    Variable("overturning_probability", (), Unit.ONE, "share of the cases that overturned"),
    *bounds("overturning_probability", (), "{} confidence bound of that share"),
    count("verdict_count", "number of cases with a verdict"),
    Variable("parameter", PARAMETER, None, "what is spread", dtype="str"),
    Variable(
        "first_order_index",
        PARAMETER,
        Unit.ONE,
        "share of the verdict's variance that knowing the parameter takes away",
    ),
    Variable(
        "verdict_distance",
        PARAMETER,
        Unit.ONE,
        "greatest difference of the parameter's distributions in cases that overturn and stand",
    ),
    Variable(
        "chance_probability",
        PARAMETER,
        Unit.ONE,
        "probability of shares as uneven if the parameter did not matter",
    ),
)
"""Of overturning, where parameters are spread."""

SUBSETS: Final = (
    counting("sampling_level", "number of the level"),
    Variable(
        "demand_threshold",
        LEVEL,
        Unit.ONE,
        "demand from which on samples count; of the last level that of the limit state",
    ),
    Variable(
        "conditional_probability", LEVEL, Unit.ONE, "share of the samples that reach the threshold"
    ),
    Variable(
        "acceptance_rate",
        LEVEL,
        Unit.ONE,
        "share of the candidates of the chains that were accepted, NaN where there are no chains",
    ),
    Variable("chain_count", LEVEL, Unit.ONE, "number of chains, or of samples", dtype="int64"),
    Variable(
        "demand",
        (),
        Unit.ONE,
        "response over its limit, infinite where the block overturns",
    ),
    Variable("sample_level", (), Unit.ONE, "level that the sample is of", dtype="int64"),
    Variable("sample_weight", (), Unit.ONE, "probability that the sample stands for"),
    Variable(
        "coefficient_of_variation",
        (),
        Unit.ONE,
        "standard deviation of the estimated probability over it, infinite where it is 0",
    ),
    count("run_count", "number of runs"),
    count(
        "family_count",
        "number of samples of the first level from which those that exceed descend",
    ),
)
"""Of subset simulation."""

ENSEMBLE: Final = (
    Variable("ordered_value", RANK, Unit.ONE, "value of the ensemble, in order and its own unit"),
    Variable("cumulative_probability", RANK, Unit.ONE, "share of the ensemble up to the value"),
    *bounds("cumulative_probability", RANK, "{} confidence bound of the distribution at the value"),
    *bounds("simultaneous", RANK, "{} bound of a band that holds the whole distribution"),
    Variable("quantile", QUANTILE, Unit.ONE, "share of the distribution below"),
    Variable("quantile_value", QUANTILE, Unit.ONE, "value below which that share lies"),
    *bounds("quantile_value", QUANTILE, "{} confidence bound of the quantile"),
    count("member_count", "number of members of the ensemble"),
)
"""Of ensembles."""

SEQUENCES: Final = (
    Variable("sequence", ("sequence",), None, "sequence of earthquakes", dtype="str"),
    counting("earthquake", "number of the earthquake in its sequence"),
    Variable(
        "overturning_earthquake",
        ("sequence",),
        Unit.ONE,
        "number of the earthquake that overturned the block, 0 if none did",
        dtype="int64",
    ),
)
"""Of earthquakes in sequence."""
