"""Studies: many runs that answer one question about a system."""

from rockframe.studies.critical_scale import critical_scale
from rockframe.studies.sweeps.case import Case, case
from rockframe.studies.sweeps.sweep import open_study, sweep

__all__ = ["Case", "case", "critical_scale", "open_study", "sweep"]


def __dir__() -> list[str]:
    return __all__
