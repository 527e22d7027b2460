"""Intensity measures and spectra of ground motions."""

from typing import TYPE_CHECKING

from rockframe.measures.average import average_spectral_acceleration
from rockframe.measures.directions import principal_axes, rotated_spectrum
from rockframe.measures.histories import fourier_spectrum, velocity_and_displacement
from rockframe.measures.intensity import intensity_measures
from rockframe.measures.response import response_spectrum
from rockframe.suggestions import public_names

__all__ = [
    "average_spectral_acceleration",
    "fourier_spectrum",
    "intensity_measures",
    "principal_axes",
    "response_spectrum",
    "rotated_spectrum",
    "velocity_and_displacement",
]

if not TYPE_CHECKING:  # otherwise type checkers would accept any name
    __getattr__, __dir__ = public_names(__name__, __all__)
