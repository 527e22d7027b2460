"""Intensity measures and spectra of ground motions."""

from typing import TYPE_CHECKING

from rockframe.measures.average import average_spectral_acceleration
from rockframe.measures.directions import principal_axes, rotated_spectrum
from rockframe.measures.histories import fourier_spectrum, velocity_and_displacement
from rockframe.measures.intensity import intensity_measures
from rockframe.measures.response import response_spectrum
from rockframe.suggestions import module_getattr

__all__ = [
    "average_spectral_acceleration",
    "fourier_spectrum",
    "intensity_measures",
    "principal_axes",
    "response_spectrum",
    "rotated_spectrum",
    "velocity_and_displacement",
]

if not TYPE_CHECKING:  # or no name would be unknown to type checkers
    __getattr__ = module_getattr(__name__, __all__)


def __dir__() -> list[str]:
    return __all__
