"""Studies: many runs that answer one question about a system."""

from rockframe.studies.critical_scale import critical_scale

__all__ = ["critical_scale"]


def __dir__() -> list[str]:
    return __all__
