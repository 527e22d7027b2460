"""From a measured test back to the parameters of a system."""

from rockframe.identification.free_decay import fit_free_decay

__all__ = ["fit_free_decay"]


def __dir__() -> list[str]:
    return __all__
