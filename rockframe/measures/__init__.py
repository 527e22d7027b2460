"""Intensity measures and spectra of ground motions."""

from rockframe.measures.fourier import fourier_spectrum as fourier_spectrum
from rockframe.measures.histories import velocity_and_displacement as velocity_and_displacement
from rockframe.measures.intensity import intensity_measures as intensity_measures
from rockframe.measures.response import response_spectrum as response_spectrum
