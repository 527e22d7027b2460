"""Velocity and displacement of the ground along time, and its Fourier spectrum."""

from typing import Final

import numpy as np
import xarray as xr

from rockframe.measures.common import build_over, component_attributes, signal_of
from rockframe.motion import GroundMotion
from rockframe.motion.value import GroundComponent
from rockframe.results.schema import build_dataset
from rockframe.signals.integrals import ground_path, transform_of
from rockframe.signals.motion import knots_of
from rockframe.suggestions import with_hints
from rockframe.units import FREQUENCY, POSITIVE, QuantityLike, to_si


@with_hints()
def velocity_and_displacement(motion: GroundMotion, *, component: str = "horizontal") -> xr.Dataset:
    """Integrate a motion to velocity and displacement of the ground.

    Parameters
    ----------
    motion : GroundMotion
        The motion. The ground starts from rest.
    component : {"horizontal", "vertical"}, optional
        Component of the motion.

    Returns
    -------
    xarray.Dataset
        ``ground_acceleration`` [m s^-2], ``ground_velocity`` [m s^-1] and ``ground_displacement``
        [m] over ``time`` [s], at the samples; for the vertical component
        ``vertical_ground_acceleration`` and so on.

    Raises
    ------
    ComponentError
        The motion lacks the component.

    Notes
    -----
    Exact for the motion that a simulation uses, :eq:`eq-ground-velocity` and
    :eq:`eq-ground-displacement`: straight lines between the samples of a record, the polynomials of
    an analytic pulse. Nothing is corrected: a record whose acceleration has an offset drifts. See
    :meth:`GroundMotion.baseline_corrected` and :meth:`GroundMotion.filtered`.

    Examples
    --------
    >>> import rockframe as rf
    >>> pulse = rf.GroundMotion.sine_pulse("1 m/s^2", "0.5 Hz", cycles=0.5)
    >>> path = velocity_and_displacement(pulse)
    >>> round(float(path.ground_velocity[-1]), 6)
    0.63662
    """
    signal = signal_of(motion, component, owner="velocity_and_displacement")
    velocity, displacement = ground_path(signal)
    prefix = "vertical_" if component == GroundComponent.VERTICAL else ""
    values = {
        "time": signal.times,
        f"{prefix}ground_acceleration": signal.samples,
        f"{prefix}ground_velocity": knots_of(velocity),
        f"{prefix}ground_displacement": knots_of(displacement),
    }
    return build_dataset(
        {name: array.copy() for name, array in values.items()},
        component_attributes(motion, component),
        title="Ground motion",
        source="integration from sample to sample",
    )


_OWNER: Final = "fourier_spectrum"


@with_hints()
def fourier_spectrum(
    motion: GroundMotion,
    *,
    resolution: QuantityLike | None = None,
    component: str = "horizontal",
) -> xr.Dataset:
    """Compute the Fourier spectrum of a motion's acceleration.

    Parameters
    ----------
    motion : GroundMotion
        The motion.
    resolution : str or Quantity, optional
        Maximum frequency spacing, achieved by appending zeros; by default one over the motion's
        duration [Hz].
    component : {"horizontal", "vertical"}, optional
        Component of the motion.

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
    The spectrum is one-sided: the other half is its complex conjugate, and amplitudes are not
    doubled. For a record it is the discrete Fourier transform times the time step, for an analytic
    pulse the transform of its polynomials.

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
        component_attributes(motion, component),
        title="Fourier spectrum",
        source="fast Fourier transform",
    )
