"""Identification of the parameters of a system from a measured test."""

from rockframe.identification.free_decay import fit_free_decay

__all__ = ["fit_free_decay"]


def __dir__() -> list[str]:
    return __all__
