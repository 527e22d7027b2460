"""Figures of results and motions; matplotlib is imported when the first is drawn."""

from rockframe.plot._motion import motion
from rockframe.plot._response import response
from rockframe.plot._spectra import spectra
from rockframe.plot._tradeoff import tradeoff

__all__ = ["motion", "response", "spectra", "tradeoff"]


def __dir__() -> list[str]:
    return __all__
