"""Variables of analyses: dynamic analysis, fragility, maps, spectra and probabilities."""

from enum import IntEnum
from typing import Final

from rockframe.results.variables.studies import PARAMETER
from rockframe.results.variables.variable import (
    FLIP,
    Variable,
    bounds,
    count,
    counting,
    flag,
    number,
    whether,
)
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
    number(
        "rotation_limit",
        "peak rotation over the overturning angle that exceeds the limit state, 0 for uplift",
        LIMIT_STATE,
    ),
    whether(
        "exceeds_above",
        "whether the limit state is exceeded after the flip, and not before it",
        FLIP,
    ),
    count("flip_count", "number of changes of the verdict that were found"),
    number(
        "capacity_scale",
        "least scale of the motion that was found to exceed the limit state, infinite if none",
    ),
    number(
        "capacity_resolution",
        "widest range of scales, over its upper end, that may exceed unseen below the capacity",
    ),
    count("censored_count", "number of motions under which no scale exceeded the limit state"),
)
"""Of motions that are scaled until limit states are exceeded."""

FRACTILES: Final = (
    number(
        "motion_response",
        "response under a motion, infinite where the block overturns, in its own unit",
    ),
    number(
        "response_fractile",
        "response that this share of the motions does not exceed at the intensity",
    ),
    count("overturned_count", "number of motions that overturn the block at the intensity"),
    number("response_level", "level of the response", ("response_level",)),
    number(
        "intensity_fractile",
        "intensity by which this share of the motions has first reached the level",
    ),
    count("unreached_count", "number of motions that never reach the level"),
)
"""Of motions that are scaled, in summary."""

FRAGILITY: Final = (
    flag("fragility_status", (), "whether a lognormal capacity fits the trials", FragilityStatus),
    number("median_intensity", "median of the capacity, in the unit of the intensity"),
    *bounds("median_intensity", "{} bound of the median, of nominal confidence"),
    number(
        "separation_lower_intensity",
        "greatest intensity of a trial that does not exceed, where trials are separated",
    ),
    number(
        "separation_upper_intensity",
        "least intensity of a trial that exceeds, where trials are separated",
    ),
    number("log_median_error", "standard error of the logarithm of the median"),
    number("dispersion", "standard deviation of the logarithm of the capacity"),
    *bounds("dispersion", "{} bound of the dispersion, of nominal confidence"),
    number("dispersion_error", "standard error of the dispersion"),
    count("trial_count", "number of runs, or of capacities, that count"),
    count("left_out_count", "number of those left out, without a result that counts"),
    count("independent_count", "number of motions, or of trials, that are independent"),
    count("below_scan_count", "number of capacities at or below the least scale of the scan"),
    number("exceedance_probability", "probability that the limit state is exceeded"),
    *bounds("exceedance_probability", "{} bound of the probability, confidence nominal"),
    Variable(
        "coefficient", COEFFICIENT, None, "what a coefficient of the fit stands before", dtype="str"
    ),
    number(
        "fitted_coefficient",
        "coefficient before the logarithm of an intensity in SI units, or the intercept",
        COEFFICIENT,
    ),
    number("fitted_coefficient_error", "standard error of the coefficient", COEFFICIENT),
    # what was counted
    number("stripe_intensity", "intensity of a group of trials, in its own unit", STRIPE),
    Variable("stripe_trials", STRIPE, Unit.ONE, "number of trials in the group", dtype="int64"),
    Variable(
        "stripe_exceedances",
        STRIPE,
        Unit.ONE,
        "number of trials in the group that exceeded the limit state",
        dtype="int64",
    ),
    number("stripe_fraction", "share of the group that exceeded", STRIPE),
    *bounds("stripe_fraction", "{} confidence bound of the share", STRIPE),
    Variable(
        "velocity_to_acceleration_ratio",
        (),
        Unit.SECOND,
        "peak ground velocity over peak ground acceleration",
    ),
)
"""Of lognormal capacities."""

CLOUD: Final = (
    number(
        "regression_intercept", "logarithm of the response at an intensity of one, both in SI units"
    ),
    number("regression_slope", "power of the intensity with which the response grows"),
    number("regression_slope_error", "standard error of that power"),
    number(
        "residual_dispersion", "standard deviation of the logarithm of the response at an intensity"
    ),
    number("determination", "share of the variance of the logarithms that the line tells"),
    number("logistic_intercept", "intercept of the logistic curve of overturning"),
    number(
        "logistic_slope",
        "slope of the logistic curve of overturning over the logarithm of the intensity",
    ),
    number("logistic_slope_error", "standard error of that slope"),
    count("cloud_overturned_count", "number of runs that overturned"),
    count("resting_count", "number of runs without a response"),
    number("response_limit", "level of the response, infinite for overturning"),
    number("cloud_intensity", "intensity of a run, in the unit of the measure", RUN),
    number("cloud_response", "response of a run, infinite where the block overturned", RUN),
)
"""Of many motions, each at one scale."""

MEASURE_COMPARISON: Final = (
    Variable("measure", ("measure",), None, "intensity measure", dtype="str"),
    Variable("covariate", ("covariate",), None, "what a response may depend on too", dtype="str"),
    number("efficiency_ratio", "dispersion of the response over the power it grows with"),
    number("sufficiency_slope", "slope of the residuals, per unit of the covariate", COVARIATE),
    number(
        "sufficiency_p_value",
        "probability of a slope as great if the response did not depend on the covariate",
        COVARIATE,
    ),
    number(
        "relative_sufficiency",
        "information that the measure gives on the runs more than the first, in bits a run",
    ),
    number("relative_sufficiency_error", "standard error of that information"),
    count("line_count", "number of runs that moved and did not overturn"),
)
"""Of measures side by side."""

HAZARD: Final = (
    number("annual_rate", "number of times a year that the limit state is exceeded on average"),
    *bounds("annual_rate", "the same of the {} bound of the fragility"),
    number(
        "unreached_rate_below",
        "annual rate that arises below the hazard curve, if it goes on as it ends",
    ),
    number(
        "unreached_rate_above",
        "annual rate that arises above the hazard curve, if it goes on as it ends",
    ),
    number(
        "outside_trials_share",
        "share of the annual rate that arises at intensities beyond those of all trials",
    ),
    number(
        "contributing_intensity",
        "middle of a range of intensities, in the unit of the measure",
        ("contributing_intensity",),
    ),
    number(
        "rate_share",
        "share of the rate that arises in the range of intensities",
        ("contributing_intensity",),
    ),
    number("quantile_intensity", "intensity below which that share of it arises", QUANTILE),
)
"""Of limit states at a site."""

OVERTURNING_MAP: Final = (
    Variable(
        "amplitude",
        ("amplitude",),
        Unit.METRE_PER_SECOND_SQUARED,
        "amplitude of the ground acceleration",
    ),
    number(
        "impacts_before_overturning",
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
    number(
        "impacts_below",
        "number of impacts before overturning below the boundary, NaN if the block stands",
        BOUNDARY,
    ),
    number(
        "impacts_above",
        "number of impacts before overturning above the boundary, NaN if the block stands",
        BOUNDARY,
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
    number("slenderness", "height over width of the block", ("slenderness",)),
    number(
        "capacity_intensity",
        "least intensity of the motion that was found to overturn the block, in its own unit",
    ),
)
"""Of blocks of all sizes."""

PROBABILITY: Final = (
    number("overturning_probability", "share of the cases that overturned"),
    *bounds("overturning_probability", "{} confidence bound of that share"),
    count("verdict_count", "number of cases with a verdict"),
    Variable("parameter", PARAMETER, None, "what is spread", dtype="str"),
    number(
        "first_order_index",
        "share of the verdict's variance that knowing the parameter takes away",
        PARAMETER,
    ),
    number(
        "verdict_distance",
        "greatest difference of the parameter's distributions in cases that overturn and stand",
        PARAMETER,
    ),
    number(
        "chance_probability",
        "probability of shares as uneven if the parameter did not matter",
        PARAMETER,
    ),
)
"""Of overturning, where parameters are spread."""

SUBSETS: Final = (
    counting("sampling_level", "number of the level"),
    number(
        "demand_threshold",
        "demand from which on samples count; of the last level that of the limit state",
        LEVEL,
    ),
    number("conditional_probability", "share of the samples that reach the threshold", LEVEL),
    number(
        "acceptance_rate",
        "share of the candidates of the chains that were accepted, NaN where there are no chains",
        LEVEL,
    ),
    Variable("chain_count", LEVEL, Unit.ONE, "number of chains, or of samples", dtype="int64"),
    number("demand", "response over its limit, infinite where the block overturns"),
    Variable("sample_level", (), Unit.ONE, "level that the sample is of", dtype="int64"),
    number("sample_weight", "probability that the sample stands for"),
    number(
        "coefficient_of_variation",
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
    number("ordered_value", "value of the ensemble, in order and its own unit", RANK),
    number("cumulative_probability", "share of the ensemble up to the value", RANK),
    *bounds("cumulative_probability", "{} confidence bound of the distribution at the value", RANK),
    *bounds("simultaneous", "{} bound of a band that holds the whole distribution", RANK),
    number("quantile", "share of the distribution below", QUANTILE),
    number("quantile_value", "value below which that share lies", QUANTILE),
    *bounds("quantile_value", "{} confidence bound of the quantile", QUANTILE),
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
