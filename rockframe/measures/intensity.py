"""Intensity measures of a motion, also relative to a given block."""

import math
from collections.abc import Callable, Mapping
from typing import Final

import numpy as np
import xarray as xr

from rockframe.components import Block
from rockframe.constants import STANDARD_GRAVITY
from rockframe.errors import ComponentError, short_repr
from rockframe.measures.common import read_inputs
from rockframe.motion import GroundMotion
from rockframe.motion.value import GroundComponent
from rockframe.results.schema import build_dataset
from rockframe.signals import Signal
from rockframe.signals.integrals import (
    HOUSNER_PERIODS,
    PREDOMINANT_PERIODS,
    absolute_velocity_history,
    arias_path,
    exceedance,
    ground_path,
    housner_intensity,
    mean_period,
    predominant_period,
    standardized_absolute_velocity,
    time_between_shares,
)
from rockframe.signals.motion import absolute_peak, knots_of
from rockframe.signals.spectra import DAMPING_RATIO, check_cost
from rockframe.suggestions import with_hints
from rockframe.units import ACCELERATION, POSITIVE, QuantityLike, RatioLike, to_ratio, to_si

_OWNER: Final = "intensity_measures"
_STANDARDIZED_THRESHOLD: Final = 0.025  # g, EPRI (1991)
_THRESHOLD: Final = "0.05 g_0"
_DAMPING: Final = 0.05
_PERIODS: Final = np.concatenate([HOUSNER_PERIODS, PREDOMINANT_PERIODS])


@with_hints()
def intensity_measures(
    motion: GroundMotion | Mapping[str, GroundMotion],
    *,
    block: Block | None = None,
    component: str = "horizontal",
    threshold: QuantityLike = _THRESHOLD,
    damping_ratio: RatioLike = _DAMPING,
    gravity: QuantityLike | None = None,
) -> xr.Dataset:
    """Compute the intensity measures of a motion.

    Parameters
    ----------
    motion : GroundMotion, or mapping of str to GroundMotion
        The motion, or several by their labels, such as a suite.
    block : Block, optional
        The block, or FrameEquivalent; adds the measures that depend on it.
    component : {"horizontal", "vertical"}, optional
        Component of the motion.
    threshold : str or Quantity, optional
        Threshold of the bracketed duration [m s^-2].
    damping_ratio : float, optional
        Damping ratio of the velocity spectrum of the Housner intensity and its predominant period
        [1].
    gravity : str or Quantity, optional
        Acceleration of gravity; standard gravity by default [m s^-2].

    Returns
    -------
    xarray.Dataset
        Scalars, over ``motion`` if there are several: ``peak_ground_acceleration`` [m s^-2],
        ``peak_ground_velocity`` [m s^-1], ``peak_ground_displacement`` [m]; ``arias_intensity``,
        ``cumulative_absolute_velocity`` and ``standardized_cumulative_absolute_velocity`` [m s^-1];
        ``significant_duration_5_75``, ``significant_duration_5_95``, ``bracketed_duration`` [s];
        ``housner_spectrum_intensity`` [m]; ``mean_period``, ``predominant_velocity_period`` [s].
        With a block ``overturning_angle`` [rad], ``uplift_acceleration`` [m s^-2],
        ``uplift_duration`` [s], ``relative_peak_ground_acceleration``,
        ``relative_peak_ground_velocity`` and ``relative_predominant_frequency`` [1].

    Raises
    ------
    UnitsError
        An argument has no unit, or one of another kind.
    ComponentError
        The motion lacks the component, an argument is out of range, or a block is given
        with the vertical component.

    Notes
    -----
    Peaks and durations are those of the motion that a simulation uses, also between the samples.
    Squares and absolute values of a record are summed over its samples by the trapezoidal rule. The
    ground starts from rest and nothing is corrected: an offset of the acceleration distorts
    ``peak_ground_velocity``, and ``peak_ground_displacement`` even more. The measures of the block
    are valid on rigid ground, :eq:`eq-rocking-measures`.

    Examples
    --------
    >>> import rockframe as rf
    >>> block = rf.Block(width="1 m", height="5 m", mass="10 t")
    >>> measures = intensity_measures(rf.GroundMotion.sine_pulse("4 m/s^2", "1 Hz"), block=block)
    >>> round(float(measures.peak_ground_velocity), 4)
    1.2732
    >>> round(float(measures.relative_peak_ground_acceleration), 4)
    2.0394
    """
    inputs = read_inputs(motion, component, owner=_OWNER)
    accelerations = {
        "threshold": threshold,
        "gravity": f"{STANDARD_GRAVITY!r} m/s^2" if gravity is None else gravity,
    }
    level, g = (
        to_si(value, ACCELERATION, owner=_OWNER, name=name, condition=POSITIVE)
        for name, value in accelerations.items()
    )
    damping = to_ratio(damping_ratio, owner=_OWNER, name="damping_ratio", condition=DAMPING_RATIO)
    if block is not None:
        _check_block(block, component)

    def compute(signal: Signal) -> dict[str, float]:
        check_cost(signal, _PERIODS, owner=_OWNER)
        measures = _ground_measures(signal, threshold=level, damping_ratio=damping, gravity=g)
        values = {name: measure() for name, measure in measures.items()}
        if block is not None:
            values |= _block_measures(signal, block, values, gravity=g)
        return values

    dataset = build_dataset(
        inputs.joined(inputs.each(compute)),
        {
            **inputs.attributes,
            "threshold": f"{level!r} {ACCELERATION.unit}",
            "gravity": f"{g!r} {ACCELERATION.unit}",
            "damping_ratio": damping,
            **({} if block is None else {"block": repr(block)}),
        },
        over=inputs.over,
        title="Intensity measures",
        source="integration from sample to sample",
    )
    return inputs.labelled(dataset)


def measure_of_ground(motion: GroundMotion, name: str) -> float:
    """Return one measure of the ground, of the horizontal component with default arguments."""
    if name in ("housner_spectrum_intensity", "predominant_velocity_period"):
        check_cost(motion.si.horizontal, _PERIODS, owner=_OWNER)
    level = to_si(_THRESHOLD, ACCELERATION, owner=_OWNER, name="threshold", condition=POSITIVE)
    measures = _ground_measures(
        motion.si.horizontal, threshold=level, damping_ratio=_DAMPING, gravity=STANDARD_GRAVITY
    )
    return measures[name]()


def _ground_measures(
    signal: Signal, *, threshold: float, damping_ratio: float, gravity: float
) -> dict[str, Callable[[], float]]:
    """Return a function for each measure: some take a hundred times as long as others."""
    velocity, displacement = ground_path(signal)
    arias = arias_path(signal, gravity)
    step = signal.time_step
    return {
        "peak_ground_acceleration": lambda: absolute_peak(signal.pieces),
        "peak_ground_velocity": lambda: absolute_peak(velocity),
        "peak_ground_displacement": lambda: absolute_peak(displacement),
        "arias_intensity": lambda: float(knots_of(arias)[-1]),
        "cumulative_absolute_velocity": lambda: float(absolute_velocity_history(signal)[-1]),
        "standardized_cumulative_absolute_velocity": lambda: standardized_absolute_velocity(
            signal, _STANDARDIZED_THRESHOLD * gravity
        ),
        "significant_duration_5_75": lambda: time_between_shares(arias, step, 0.05, 0.75),
        "significant_duration_5_95": lambda: time_between_shares(arias, step, 0.05, 0.95),
        "bracketed_duration": lambda: exceedance(signal, threshold)[0],
        "housner_spectrum_intensity": lambda: housner_intensity(signal, damping_ratio),
        "mean_period": lambda: mean_period(signal),
        "predominant_velocity_period": lambda: predominant_period(signal, damping_ratio),
    }


def _block_measures(
    signal: Signal, block: Block, of_ground: dict[str, float], *, gravity: float
) -> dict[str, float]:
    """Compute :eq:`eq-rocking-measures`."""
    uplift = gravity * math.tan(block.si.overturning_angle)
    frequency = block.si.frequency_at(gravity)
    predominant = 2.0 * math.pi / of_ground["predominant_velocity_period"]
    return {
        "overturning_angle": block.si.overturning_angle,
        "uplift_acceleration": uplift,
        "uplift_duration": exceedance(signal, uplift)[1],
        "relative_peak_ground_acceleration": of_ground["peak_ground_acceleration"] / uplift,
        "relative_peak_ground_velocity": frequency * of_ground["peak_ground_velocity"] / uplift,
        "relative_predominant_frequency": predominant / frequency,
    }


def _check_block(block: object, component: str) -> None:
    if not isinstance(block, Block):
        msg = f"{_OWNER}: block needs a Block or a FrameEquivalent, got {short_repr(block)}"
        raise ComponentError(msg)
    if component == GroundComponent.VERTICAL:
        msg = (
            f"{_OWNER}: a block is rocked by the horizontal component; leave out block or component"
        )
        raise ComponentError(msg)
