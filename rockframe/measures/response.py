"""Response spectra of linear oscillators."""

import math
from collections.abc import Iterable, Mapping
from dataclasses import replace
from typing import Any, Final

import numpy as np
import xarray as xr

from rockframe.arguments import checked_choice
from rockframe.errors import ComponentError, short_repr
from rockframe.measures.common import Inputs, build_over, read_inputs
from rockframe.motion import GroundMotion
from rockframe.motion.operations.timing import Interpolation
from rockframe.motion.processing.samples import band_limited, warn_of_coarse_samples
from rockframe.motion.quantities import ArrayLike
from rockframe.signals import Signal
from rockframe.signals.arrays import Array
from rockframe.signals.spectra import DAMPING_RATIO, check_cost, pseudo_spectra, spectral_peaks
from rockframe.suggestions import with_hints
from rockframe.units import PERIOD, QuantityLike, RatioLike, to_ratio, to_si_values

SAMPLES_PER_PERIOD: Final = 25
"""Samples in the shortest period of a band-limited motion: straight lines lower it by 0.5 %."""

_PERIODS_PER_DECADE: Final = 100
_OWNER: Final = "response_spectrum"
_REMEDY: Final = "interpolation='band-limited' refines records"


@with_hints()
def response_spectrum(
    motion: GroundMotion | Mapping[str, GroundMotion],
    periods: ArrayLike | Iterable[QuantityLike] | None = None,
    damping_ratios: Iterable[RatioLike] | RatioLike = (0.05,),
    *,
    component: str = "horizontal",
    interpolation: str = "linear",
) -> xr.Dataset:
    """Compute the response spectra of a motion.

    Parameters
    ----------
    motion : GroundMotion, or mapping of str to GroundMotion
        The motion, or several by their labels, such as a suite. The ground stands still before
        and after it.
    periods : (sequence, unit), Quantity or sequence of str, optional
        Undamped natural periods, increasing; 0 stands for a rigid oscillator. The default is 100
        per decade from 0.01 s to 10 s [s].
    damping_ratios : sequence of float, or float, optional
        Damping over critical damping, from 0 to 1 [1].
    component : {"horizontal", "vertical"}, optional
        Component of the motion.
    interpolation : {"linear", "band-limited"}, optional
        Interpolation of a record between its samples: straight lines, as in simulations, or the
        band-limited motion with these samples and no content above their Nyquist frequency.
        Straight lines lower the ordinates at periods shorter than about ten time steps.

    Returns
    -------
    xarray.Dataset
        Over ``damping_ratio`` and ``period``: the greatest absolute relative displacement
        ``spectral_displacement`` [m], relative velocity ``spectral_velocity`` [m s^-1] and absolute
        acceleration ``absolute_spectral_acceleration`` [m s^-2]; and, from the first,
        ``pseudo_spectral_velocity`` [m s^-1] and ``pseudo_spectral_acceleration`` [m s^-2],
        :eq:`eq-pseudo-spectra`. If there are several motions, ``motion`` is the first dimension.

    Raises
    ------
    UnitsError
        Periods without a unit, or with one of another kind.
    ComponentError
        The motion lacks the component, periods do not increase or are so short that they need too
        many steps, a damping ratio is out of range or given twice, or `interpolation` is unknown.

    Warns
    -----
    RecordWarning
        Some periods are shorter than ten time steps of a record, whose samples are joined by
        straight lines.

    Notes
    -----
    The method is the recurrence of Nigam and Jennings (1969), which is exact for a piecewise linear
    motion, and here also for the polynomials of an analytic pulse; an interval is split until a
    period has twelve steps. Peaks include those of the solution between the steps and of the free
    vibration after the motion.

    Examples
    --------
    >>> import rockframe as rf
    >>> pulse = rf.GroundMotion.sine_pulse("1 m/s^2", "1 Hz", cycles=0.5)
    >>> spectrum = response_spectrum(pulse, ["0 s", "0.5 s", "5 s"], 0)
    >>> spectrum.pseudo_spectral_acceleration.values.round(4).tolist()
    [[1.0, 1.7321, 0.3963]]
    """
    inputs = read_inputs(motion, component, owner=_OWNER)
    seconds = checked_periods(periods, owner=_OWNER)
    ratios = checked_ratios(damping_ratios, owner=_OWNER)
    method = checked_choice(Interpolation, interpolation, owner=_OWNER, name="interpolation")
    if method is Interpolation.LINEAR and periods is not None:
        warn_of_coarse_samples(
            inputs.items, shortest_positive_period(seconds), owner=_OWNER, remedy=_REMEDY
        )
    return spectra_of(inputs, seconds, ratios, method)


def spectra_of(
    inputs: Inputs[Signal],
    seconds: Array,
    ratios: Array,
    method: Interpolation = Interpolation.LINEAR,
) -> xr.Dataset:
    """Return spectra of signals at checked periods, as :func:`response_spectrum` does."""
    if method is Interpolation.BAND_LIMITED:
        inputs = replace(
            inputs, items=[_refined_record(motion, seconds) for motion in inputs.items]
        )
    for signal in inputs.items:
        check_cost(signal, seconds, owner=_OWNER)
    values = inputs.joined(inputs.each(lambda signal: signal_spectra(signal, seconds, ratios)))
    dataset = build_over(
        oscillator_axes(ratios, seconds),
        values,
        {**inputs.attributes, "interpolation": str(method)},
        over=inputs.over,
        title="Response spectra",
        source="recurrence of Nigam and Jennings",
    )
    return inputs.labelled(dataset)


def shortest_positive_period(seconds: Array) -> float:
    """Return the shortest period above zero; infinity where there is none [s]."""
    return float(seconds[seconds > 0.0].min(initial=np.inf))


def oscillator_axes(ratios: Array, seconds: Array) -> dict[str, tuple[Array, str]]:
    """Return the axes of spectra, values and schema rows, for :func:`build_over`."""
    return {
        "damping_ratio": (ratios, "damping ratio of the oscillator"),
        "period": (seconds, "undamped period of the oscillator"),
    }


def _refined_record(signal: Signal, seconds: Array) -> Signal:
    """Resample a record so that straight lines represent it well, :eq:`eq-straight-lines`."""
    if signal.analytic:
        return signal
    shortest = float(seconds.min(initial=np.inf))
    needed = SAMPLES_PER_PERIOD * signal.time_step / shortest if shortest > 0.0 else np.inf
    # a record holds no period shorter than two time steps
    parts = math.ceil(min(needed, 0.5 * SAMPLES_PER_PERIOD))
    if parts <= 1:
        return signal
    step = signal.time_step / parts
    samples = band_limited(signal.time_step, signal.samples, step)
    return replace(signal, time_step=step, samples=samples, polynomials=None)


def signal_spectra(signal: Signal, seconds: Array, ratios: Array) -> dict[str, Array]:
    """Compute the spectra of a signal over damping ratios and periods, by their names."""
    peaks = np.array([spectral_peaks(signal, seconds, ratio) for ratio in ratios.tolist()])
    pseudo_velocity, pseudo_acceleration = pseudo_spectra(signal, seconds, peaks[:, :, 0])
    return {
        "spectral_displacement": peaks[:, :, 0],
        "spectral_velocity": peaks[:, :, 1],
        "absolute_spectral_acceleration": peaks[:, :, 2],
        "pseudo_spectral_velocity": pseudo_velocity,
        "pseudo_spectral_acceleration": pseudo_acceleration,
    }


def checked_periods(value: object, *, owner: str) -> Array:
    """Read the argument `periods`; 100 per decade from 0.01 s to 10 s unless given [s]."""
    if value is None:
        decades = np.arange(-2 * _PERIODS_PER_DECADE, _PERIODS_PER_DECADE + 1)
        return 10.0 ** (decades / _PERIODS_PER_DECADE)
    seconds = np.array(to_si_values(value, PERIOD, owner=owner, name="periods"))
    if seconds.size == 0 or seconds[0] < 0.0 or not (np.diff(seconds) > 0.0).all():
        msg = (
            f"{owner}: periods must be one or more, from zero up and increasing, got "
            f"{short_repr(value)}"
        )
        raise ComponentError(msg)
    return seconds


def checked_ratios(argument: Any, *, owner: str) -> Array:
    """Read the argument `damping_ratios`: one or several, of which none is given twice [1]."""
    if isinstance(argument, np.ndarray):
        argument = np.atleast_1d(argument)
    values: list[Any] = (
        list(argument) if isinstance(argument, list | tuple | np.ndarray) else [argument]
    )
    ratios = [
        to_ratio(value, owner=owner, name="damping_ratios", condition=DAMPING_RATIO)
        for value in values
    ]
    if not ratios or len(set(ratios)) < len(ratios):
        msg = f"{owner}: damping_ratios must be one or more, each once, got {short_repr(argument)}"
        raise ComponentError(msg)
    return np.array(ratios)
