"""The verdict on the result of a study, or on a part of it, in words."""

import xarray as xr

from rockframe.studies.dynamic_analysis import verdict_of_analysis
from rockframe.studies.fragility.words import verdict_of_fragility
from rockframe.studies.hazard import verdict_of_rates
from rockframe.studies.sweeps.labelling import cases_verdict


def verdict_of_study(dataset: xr.Dataset) -> str:
    """Describe the outcome of a run, or of all cases or structures that a dataset still has."""
    if "rate_share" in dataset:
        return verdict_of_rates(dataset)
    if "fragility_status" in dataset:
        return verdict_of_fragility(dataset)
    if {"capacity_scale", "censored_count"} <= set(dataset):
        return verdict_of_analysis(dataset)
    return cases_verdict(dataset)
