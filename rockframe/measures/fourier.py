"""Fourier spectra."""

import math
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from rockframe.errors import ComponentError
from rockframe.measures.about import about
from rockframe.measures.labels import build_over
from rockframe.measures.shaking import Array, Shaking, component_of, shaking_of
from rockframe.motion.samples import MAXIMUM_SAMPLES
from rockframe.units import FREQUENCY, POSITIVE, to_si

if TYPE_CHECKING:
    import xarray as xr

    from rockframe.motion import GroundMotion
    from rockframe.motion.quantities import QuantityLike

_TERMS: Final = 40
_OWNER: Final = "fourier_spectrum"


def fourier_spectrum(
    motion: "GroundMotion",
    *,
    resolution: "QuantityLike | None" = None,
    component: str = "horizontal",
) -> "xr.Dataset":
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
    shaking = shaking_of(motion, component, owner=_OWNER)
    finest = 0.0
    if resolution is not None:
        finest = to_si(resolution, FREQUENCY, owner=_OWNER, name="resolution", condition=POSITIVE)
    frequency, transform = transform_of(shaking, finest)
    return build_over(
        {"frequency": (frequency, "cyclic frequency")},
        {"fourier_amplitude": np.abs(transform), "fourier_phase": np.angle(transform)},
        about(motion, component_of(component, owner=_OWNER)),
        title="Fourier spectrum",
        source="fast Fourier transform",
    )


def transform_of(shaking: Shaking, resolution: float) -> tuple[Array, Any]:
    """Compute the Fourier transform, :eq:`eq-fourier`.

    Parameters
    ----------
    shaking : Shaking
        Acceleration of the ground.
    resolution : float
        Greatest distance between frequencies; 0 for one over the length [Hz].

    Returns
    -------
    frequency : ndarray, shape (k,)
        [Hz]
    transform : ndarray of complex, shape (k,)
        [m s^-1]
    """
    dt, count = shaking.time_step, shaking.samples.size
    if resolution > 0.0:
        count = max(count, math.ceil(min(1.0 / resolution / dt, 2.0 * MAXIMUM_SAMPLES)))
    if count > MAXIMUM_SAMPLES:
        msg = (
            f"{_OWNER}: a resolution of {resolution:.4g} Hz needs too many samples at "
            f"{dt:.4g} s; give a coarser one"
        )
        raise ComponentError(msg)
    frequency = np.arange(float(count // 2 + 1)) / (count * dt)
    if not shaking.analytic:
        return frequency, dt * np.fft.rfft(shaking.samples, count)
    by_power = np.fft.rfft(shaking.pieces, count, axis=0)
    moments = _moments(2.0 * np.pi * frequency * dt, by_power.shape[1])
    return frequency, dt * (by_power * moments).sum(axis=1)


def _moments(angle: Array, powers: int) -> Any:
    """Integrate x^j exp(-i angle x) from 0 to 1, for j = 0, 1, ...; angle up to pi."""
    moments = np.zeros((angle.size, powers), dtype=complex)
    term = np.ones(angle.size, dtype=complex)
    for n in range(_TERMS):
        moments += term[:, None] / (n + 1 + np.arange(powers))
        term *= -1j * angle / (n + 1)
    return moments
