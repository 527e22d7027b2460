"""The certificate of a run that has none, from what its dataset holds."""

import warnings
from typing import Final

import numpy as np
import xarray as xr

from rockframe.errors import RockframeError, RockframeWarning
from rockframe.results.outcome import verdict_of
from rockframe.results.variables.runs import CERTIFICATE
from rockframe.simulation.provenance import arguments_of_run
from rockframe.simulation.system import System

_TOLERANCE: Final = 1e-3
"""Relative difference up to which runs of other versions and machines are the same."""


def with_certificate(dataset: xr.Dataset, system: System | None) -> tuple[xr.Dataset, str]:
    """Add the certificate to a result, by running it again with all runs of a certificate."""
    if "certificate" in dataset.attrs or "proof" in dataset.attrs:
        return dataset, ""
    if system is None:
        return dataset, "the dataset does not describe its system."
    if system.motion is None and dataset.attrs.get("motion") != "none":
        return dataset, (
            "the dataset does not hold the samples of its motion; pass it by motion= or --motion, "
            "or simulate with certify=True or with 'rockframe certify'."
        )
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", RockframeWarning)  # the dataset has them
            again = system.simulate(**arguments_of_run(dataset), outputs=None, certify=True)
    except RockframeError as problem:
        return dataset, f"{problem}."
    if verdict_of(again) != verdict_of(dataset) or not _same_outcome(again, dataset):
        return dataset, "a repeated run differs; another version or machine made the result."
    found = {
        name: value for name, value in again.attrs.items() if str(name).startswith("certificate")
    }
    names = [row.name for row in CERTIFICATE if row.name in again]
    return dataset.assign({name: again[name] for name in names}).assign_attrs(found), ""


def _same_outcome(one: xr.Dataset, other: xr.Dataset) -> bool:
    """Whether peaks and times of overturning are equal but for rounding."""
    return all(
        np.isclose(one[name], other[name], rtol=_TOLERANCE, atol=0.0, equal_nan=True)
        for name in ("peak_rotation", "overturning_time")
    )
