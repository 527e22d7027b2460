"""Fourier spectra."""

from typing import TYPE_CHECKING, Final

import numpy as np
import xarray as xr

from rockframe.measures.common import build_over, component_attributes, component_of, signal_of
from rockframe.signals.fourier import transform_of
from rockframe.units import FREQUENCY, POSITIVE, to_si

if TYPE_CHECKING:
    from rockframe.motion import GroundMotion
    from rockframe.units import QuantityLike

_OWNER: Final = "fourier_spectrum"


def fourier_spectrum(
    motion: "GroundMotion",
    *,
    resolution: "QuantityLike | None" = None,
    component: str = "horizontal",
) -> xr.Dataset:
    """Compute the Fourier spectrum of a motion's acceleration.

    Parameters
    ----------
    motion : GroundMotion
        The motion.
    resolution : str or Quantity, optional
        Greatest distance between frequencies: zeros are appended until it is reached. One
        over the motion's length unless given [Hz].
    component : {"horizontal", "vertical"}, optional
        Which acceleration.

    Returns
    -------
    xarray.Dataset
        ``fourier_amplitude`` [m s^-1] and ``fourier_phase`` [rad] over ``frequency`` [Hz],
        from 0 to half the sampling rate, :eq:`eq-fourier`.

    Raises
    ------
    UnitsError
        `resolution` has no unit, or one of another kind.
    ComponentError
        The motion lacks the component, or `resolution` is not positive.

    Notes
    -----
    One-sided: the other half is the conjugate complex one, and amplitudes are not
    doubled. Of a record it is the discrete Fourier transform times the time step, of an
    analytic pulse the transform of its polynomials.

    Examples
    --------
    >>> import rockframe as rf
    >>> pulse = rf.GroundMotion.sine_pulse("1 m/s^2", "0.5 Hz", cycles=0.5)
    >>> spectrum = fourier_spectrum(pulse)
    >>> round(float(spectrum.fourier_amplitude.sel(frequency=0.0)), 6)
    0.63662
    """
    signal = signal_of(motion, component, owner=_OWNER)
    finest = 0.0
    if resolution is not None:
        finest = to_si(resolution, FREQUENCY, owner=_OWNER, name="resolution", condition=POSITIVE)
    frequency, transform = transform_of(signal, finest)
    return build_over(
        {"frequency": (frequency, "cyclic frequency")},
        {"fourier_amplitude": np.abs(transform), "fourier_phase": np.angle(transform)},
        component_attributes(motion, component_of(component, owner=_OWNER)),
        title="Fourier spectrum",
        source="fast Fourier transform",
    )
