"""Variables of analyses: dynamic analysis, fragility, maps, spectra and probabilities."""

from enum import IntEnum
from typing import Final

from rockframe.results.variables.studies import PARAMETER
from rockframe.results.variables.variable import FLIP, bounds, rows_over

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
    *rows_over(
        LIMIT_STATE,
        limit_state=("limit state", str),
        rotation_limit="peak rotation over the overturning angle that exceeds the limit state, 0 "
        "for uplift",
    ),
    *rows_over(
        FLIP,
        exceeds_above=(
            "whether the limit state is exceeded after the flip, and not before it",
            bool,
        ),
    ),
    *rows_over(
        (),
        flip_count=("number of changes of the verdict that were found", int),
        capacity_scale="least scale of the motion that was found to exceed the limit state, "
        "infinite if none",
        capacity_resolution="widest gap between runs below the capacity, over its upper end, in "
        "which the limit state may be exceeded undetected",
        censored_count=("number of motions under which no scale exceeded the limit state", int),
    ),
)
"""Of motions that are scaled until limit states are exceeded."""

FRACTILES: Final = (
    *rows_over(
        (),
        motion_response="response under a motion, infinite where the block overturns, in its own "
        "unit",
        response_fractile="response that this share of the motions does not exceed at the "
        "intensity",
        overturned_count=("number of motions that overturn the block at the intensity", int),
    ),
    *rows_over(("response_level",), response_level="level of the response"),
    *rows_over(
        (),
        intensity_fractile="intensity up to which this share of the motions has reached the level",
        unreached_count=("number of motions that never reach the level", int),
    ),
)
"""Of motions that are scaled, in summary."""

FRAGILITY: Final = (
    *rows_over(
        (),
        fragility_status=("whether a lognormal capacity fits the trials", FragilityStatus),
        median_intensity="median of the capacity, in the unit of the intensity",
        **bounds("median_intensity", "{} bound of the median, of nominal confidence"),
        separation_lower_intensity="greatest intensity of a trial that does not exceed, where "
        "trials are separated",
        separation_upper_intensity="least intensity of a trial that exceeds, where trials are "
        "separated",
        log_median_error="standard error of the logarithm of the median",
        dispersion="standard deviation of the logarithm of the capacity",
        **bounds("dispersion", "{} bound of the dispersion, of nominal confidence"),
        dispersion_error="standard error of the dispersion",
        trial_count=("number of runs, or of capacities, that count", int),
        left_out_count=("number of runs, or of capacities, without a usable result", int),
        independent_count=("number of motions, or of trials, that are independent", int),
        below_scan_count=("number of capacities at or below the least scale of the scan", int),
        exceedance_probability="probability that the limit state is exceeded",
        **bounds("exceedance_probability", "{} bound of the probability, confidence nominal"),
    ),
    *rows_over(
        COEFFICIENT,
        coefficient=("term of the fit that a coefficient multiplies", str),
        fitted_coefficient="coefficient before the logarithm of an intensity in SI units, or the "
        "intercept",
        fitted_coefficient_error="standard error of the coefficient",
    ),
    # what was counted
    *rows_over(
        STRIPE,
        stripe_intensity="intensity of a group of trials, in its own unit",
        stripe_trials=("number of trials in the group", int),
        stripe_exceedances=("number of trials in the group that exceeded the limit state", int),
        stripe_fraction="share of the group that exceeded",
        **bounds("stripe_fraction", "{} confidence bound of the share"),
    ),
    *rows_over(
        (),
        velocity_to_acceleration_ratio="peak ground velocity over peak ground acceleration [s]",
    ),
)
"""Of lognormal capacities."""

CLOUD: Final = (
    *rows_over(
        (),
        regression_intercept="logarithm of the response at an intensity of one, both in SI units",
        regression_slope="power of the intensity with which the response grows",
        regression_slope_error="standard error of the power of the intensity",
        residual_dispersion="standard deviation of the logarithm of the response at an intensity",
        determination="share of the variance of the logarithm of the response that the line "
        "explains",
        logistic_intercept="intercept of the logistic curve of overturning",
        logistic_slope="slope of the logistic curve of overturning over the logarithm of the "
        "intensity",
        logistic_slope_error="standard error of the slope of the logistic curve",
        cloud_overturned_count=("number of runs that overturned", int),
        resting_count=("number of runs without a response", int),
        response_limit="level of the response, infinite for overturning",
    ),
    *rows_over(
        RUN,
        cloud_intensity="intensity of a run, in the unit of the measure",
        cloud_response="response of a run, infinite where the block overturned",
    ),
)
"""Of many motions, each at one scale."""

MEASURE_COMPARISON: Final = (
    *rows_over(("measure",), measure=("intensity measure", str)),
    *rows_over(COVARIATE, covariate=("further property on which the response may depend", str)),
    *rows_over((), efficiency_ratio="dispersion of the response over the power it grows with"),
    *rows_over(
        COVARIATE,
        sufficiency_slope="slope of the residuals, per unit of the covariate",
        sufficiency_p_value="probability of a slope as great if the response did not depend on the "
        "covariate",
    ),
    *rows_over(
        (),
        relative_sufficiency="information on the runs that the measure gives in addition to the "
        "first measure, in bits per run",
        relative_sufficiency_error="standard error of the information in addition to the first "
        "measure",
        line_count=("number of runs that moved and did not overturn", int),
    ),
)
"""Of measures side by side."""

HAZARD: Final = (
    *rows_over(
        (),
        annual_rate="number of times a year that the limit state is exceeded on average",
        **bounds("annual_rate", "annual rate by the {} bound of the fragility"),
        unreached_rate_below="annual rate from intensities below the hazard curve, if its first "
        "power law continues",
        unreached_rate_above="annual rate from intensities above the hazard curve, if its last "
        "power law continues",
        outside_trials_share="share of the annual rate from intensities beyond those of all trials",
    ),
    *rows_over(
        ("contributing_intensity",),
        contributing_intensity="middle of a range of intensities, in the unit of the measure",
        rate_share="share of the rate from the range of intensities",
    ),
    *rows_over(
        QUANTILE, quantile_intensity="intensity below which a given share of the annual rate arises"
    ),
)
"""Of limit states at a site."""

OVERTURNING_MAP: Final = (
    *rows_over(("amplitude",), amplitude="amplitude of the ground acceleration [m s^-2]"),
    *rows_over(
        (),
        impacts_before_overturning="number of impacts before the block overturns, NaN if it does "
        "not",
    ),
    *rows_over(
        BOUNDARY,
        amplitude_below="greatest amplitude tried below the boundary [m s^-2]",
        amplitude_above="least amplitude tried above the boundary [m s^-2]",
        impacts_below="number of impacts before overturning below the boundary, NaN if the block "
        "stands",
        impacts_above="number of impacts before overturning above the boundary, NaN if the block "
        "stands",
    ),
    *rows_over((), boundary_count=("number of boundaries", int)),
)
"""Of pulses of any amplitude and frequency."""

SPECTRA: Final = (
    *rows_over(
        ("rocking_period",), rocking_period="2 pi over the frequency parameter of the block [s]"
    ),
    *rows_over(("slenderness",), slenderness="height over width of the block"),
    *rows_over(
        (),
        capacity_intensity="least intensity of the motion that was found to overturn the block, in "
        "its own unit",
    ),
)
"""Of blocks of all sizes."""

PROBABILITY: Final = (
    *rows_over(
        (),
        overturning_probability="share of the cases that overturned",
        **bounds(
            "overturning_probability", "{} confidence bound of the probability of overturning"
        ),
        verdict_count=("number of cases with a verdict", int),
    ),
    *rows_over(
        PARAMETER,
        parameter=("uncertain parameter", str),
        first_order_index="share of the variance of the verdict that would vanish if the parameter "
        "were known",
        verdict_distance="greatest difference between the distributions of the parameter in cases "
        "that overturn and in cases that stand",
        chance_probability="probability of such a dependence by chance, if the parameter did not "
        "matter",
    ),
)
"""Of overturning, where parameters are spread."""

SUBSETS: Final = (
    *rows_over(
        LEVEL,
        sampling_level=("number of the level", int),
        demand_threshold="demand that samples of the level must reach; at the last level that of "
        "the limit state",
        conditional_probability="share of the samples that reach the threshold",
        acceptance_rate="share of the candidates of the chains that were accepted, NaN where there "
        "are no chains",
        chain_count=("number of chains, or of samples", int),
    ),
    *rows_over(
        (),
        demand="response over its limit, infinite where the block overturns",
        sample_level=("level to which the sample belongs", int),
        sample_weight="probability that the sample represents",
        coefficient_of_variation="standard deviation of the estimated probability over this "
        "probability, infinite where it is 0",
        run_count=("number of runs", int),
        family_count=(
            "number of samples of the first level from which the samples that reach the limit "
            "descend",
            int,
        ),
    ),
)
"""Of subset simulation."""

ENSEMBLE: Final = (
    *rows_over(
        RANK,
        ordered_value="value of the ensemble, in order and its own unit",
        cumulative_probability="share of the ensemble up to the value",
        **bounds("cumulative_probability", "{} confidence bound of the distribution at the value"),
        **bounds("simultaneous", "{} bound of a band that holds the whole distribution"),
    ),
    *rows_over(
        QUANTILE,
        quantile="share of the distribution below the quantile",
        quantile_value="value below which a given share of the distribution lies",
        **bounds("quantile_value", "{} confidence bound of the quantile"),
    ),
    *rows_over((), member_count=("number of members of the ensemble", int)),
)
"""Of ensembles."""

SEQUENCES: Final = (
    *rows_over(("sequence",), sequence=("sequence of earthquakes", str)),
    *rows_over(("earthquake",), earthquake=("number of the earthquake in its sequence", int)),
    *rows_over(
        ("sequence",),
        pause="still ground between two earthquakes [s]",
        overturning_earthquake=(
            "number of the earthquake that overturned the block, 0 if none did",
            int,
        ),
    ),
)
"""Of earthquakes in sequence."""
