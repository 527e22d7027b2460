"""Studies: many runs that answer one question about a system."""

from rockframe.studies.cloud import cloud_analysis
from rockframe.studies.critical_scale import critical_scale
from rockframe.studies.dynamic_analysis import incremental_dynamic_analysis
from rockframe.studies.ensemble import ensemble_statistics
from rockframe.studies.fractiles import fractile_curves
from rockframe.studies.fragility.fragility import fragility
from rockframe.studies.hazard import annual_rate
from rockframe.studies.measure_comparison import compare_intensities
from rockframe.studies.overturning_map import overturning_map
from rockframe.studies.probability import probability_of_overturning
from rockframe.studies.sequences import earthquake_sequences
from rockframe.studies.spectra import overturning_spectrum, rocking_spectrum
from rockframe.studies.subset_simulation import subset_simulation
from rockframe.studies.sweeps.case import SweepCase, case
from rockframe.studies.sweeps.sweep import open_study, sweep

__all__ = [
    "SweepCase",
    "annual_rate",
    "case",
    "cloud_analysis",
    "compare_intensities",
    "critical_scale",
    "earthquake_sequences",
    "ensemble_statistics",
    "fractile_curves",
    "fragility",
    "incremental_dynamic_analysis",
    "open_study",
    "overturning_map",
    "overturning_spectrum",
    "probability_of_overturning",
    "rocking_spectrum",
    "subset_simulation",
    "sweep",
]


def __dir__() -> list[str]:
    return __all__
