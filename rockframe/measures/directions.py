"""Measures of two horizontal components: spectra in all directions, ratios, principal axes."""

from collections.abc import Iterable, Mapping
from typing import Any, Final, cast

import numpy as np
import xarray as xr

from rockframe.arguments import checked_integer
from rockframe.errors import ComponentError, short_repr
from rockframe.measures.common import Inputs, build_over, by_label
from rockframe.measures.response import (
    checked_periods,
    checked_ratios,
    oscillator_axes,
    shortest_positive_period,
    signal_spectra,
)
from rockframe.motion.pair import HorizontalPair, principal_axis_and_intensities
from rockframe.motion.processing.samples import warn_of_coarse_samples
from rockframe.motion.quantities import ArrayLike
from rockframe.results.schema import build_dataset
from rockframe.signals import Signal
from rockframe.signals.arrays import Array
from rockframe.signals.spectra import check_cost, rotated_displacements, rotated_peaks, unit_vectors
from rockframe.suggestions import with_hints
from rockframe.units import QuantityLike, RatioLike

_SPECTRUM: Final = "rotated_spectrum"
_AXES: Final = "principal_axes"
_REFERENCES: Final = (
    "Boore (2010), Bull. Seism. Soc. Am. 100, 1830-1835; Penzien and Watabe (1975), Earthquake "
    "Engng. Struct. Dyn. 3, 365-373"
)
_MAX_DIRECTIONS: Final = 3600


@with_hints()
def rotated_spectrum(
    pair: HorizontalPair | Mapping[str, HorizontalPair],
    periods: ArrayLike | Iterable[QuantityLike] | None = None,
    damping_ratios: Iterable[RatioLike] | RatioLike = (0.05,),
    *,
    directions: int = 180,
) -> xr.Dataset:
    """Compute the response spectra of two horizontal components in all directions.

    Parameters
    ----------
    pair : HorizontalPair, or mapping of str to HorizontalPair
        The components, or those of several records by their labels, such as the ``pairs`` of a
        suite.
    periods, damping_ratios : optional
        As for :func:`rockframe.response_spectrum` [s], [1].
    directions : int, optional
        Even number of directions, evenly spaced over half a circle.

    Returns
    -------
    xarray.Dataset
        Pseudo-spectral accelerations over ``damping_ratio`` and ``period``, and first over
        ``motion`` if there are several records [m s^-2]: ``median_rotated_acceleration``, the
        median over all directions (RotD50), and ``greatest_rotated_acceleration`` (RotD100),
        :eq:`eq-rotated-percentiles`; ``geometric_mean_acceleration`` of the components as recorded,
        :eq:`eq-geometric-mean`. ``direction_of_greatest`` is the direction of the greatest, from
        the first component towards the second [rad]. If there is a vertical component:
        ``vertical_spectral_acceleration`` and ``vertical_to_horizontal_ratio`` [1],
        :eq:`eq-vertical-to-horizontal`.

    Raises
    ------
    UnitsError
        Periods without a unit, or with one of another kind.
    ComponentError
        No pair, an odd number of directions, or periods and damping ratios as for
        :func:`rockframe.response_spectrum`.

    Warns
    -----
    RecordWarning
        Some periods are shorter than ten time steps of a record.

    Notes
    -----
    The spectra are as exact as those of :func:`rockframe.response_spectrum`: in the direction of a
    component the spectrum is that of the component. For several records, vertical spectra are
    returned only if all have vertical components.

    Examples
    --------
    >>> import rockframe as rf
    >>> north = rf.GroundMotion.sine_pulse("3 m/s^2", "1 Hz")
    >>> east = rf.GroundMotion.sine_pulse("4 m/s^2", "1 Hz")
    >>> spectrum = rotated_spectrum(rf.HorizontalPair(north, east), ["0 s", "1 s"])
    >>> spectrum.greatest_rotated_acceleration.values.round(2).tolist()
    [[5.0, 13.5]]
    """
    inputs = _pairs(pair, owner=_SPECTRUM)
    seconds = checked_periods(periods, owner=_SPECTRUM)
    ratios = checked_ratios(damping_ratios, owner=_SPECTRUM)
    count = checked_integer(
        directions, owner=_SPECTRUM, name="directions", lowest=2, highest=_MAX_DIRECTIONS
    )
    if count % 2:
        msg = (
            f"{_SPECTRUM}: directions must be even, to have both components among them, got {count}"
        )
        raise ComponentError(msg)
    for item in inputs.items:
        check_cost(item.signals[0], seconds, owner=_SPECTRUM)
    if periods is not None:
        firsts = [item.signals[0] for item in inputs.items]
        warn_of_coarse_samples(firsts, shortest_positive_period(seconds), owner=_SPECTRUM)
    vectors = unit_vectors(count)
    has_vertical = all(item.vertical is not None for item in inputs.items)

    def spectra(components: HorizontalPair) -> dict[str, Array]:
        values = _spectra(components.signals, seconds, ratios, vectors)
        if has_vertical and components.vertical is not None:
            vertical = signal_spectra(components.vertical.si.horizontal, seconds, ratios)[
                "pseudo_spectral_acceleration"
            ]
            horizontal = values["median_rotated_acceleration"]
            with np.errstate(divide="ignore", invalid="ignore"):
                ratio = vertical / horizontal
            values["vertical_spectral_acceleration"] = vertical
            values["vertical_to_horizontal_ratio"] = ratio
        return values

    dataset = build_over(
        oscillator_axes(ratios, seconds),
        inputs.joined(inputs.each(spectra)),
        {**inputs.attributes, "directions": count},
        over=inputs.over,
        title="Response spectra of two horizontal components",
        source="recurrence of Nigam and Jennings",
    )
    return inputs.labelled(dataset)


@with_hints()
def principal_axes(pair: HorizontalPair | Mapping[str, HorizontalPair]) -> xr.Dataset:
    """Find the axes along which the horizontal components are uncorrelated.

    Parameters
    ----------
    pair : HorizontalPair, or mapping of str to HorizontalPair
        The components, or those of several records by their labels.

    Returns
    -------
    xarray.Dataset
        Scalars, over ``motion`` if there are several records: ``major_axis_angle``, from the first
        component towards the second, above -90 and up to 90 degrees [rad]; the Arias intensities
        along the axes, ``major_arias_intensity`` and ``minor_arias_intensity`` [m s^-1].

    Raises
    ------
    ComponentError
        No pair.

    Notes
    -----
    :eq:`eq-principal-axes`, after Penzien and Watabe (1975), over the whole motion. If both
    components are uncorrelated and of equal intensity, any axes are principal axes.

    Examples
    --------
    >>> import rockframe as rf
    >>> north = rf.GroundMotion.sine_pulse("3 m/s^2", "1 Hz")
    >>> pair = rf.HorizontalPair(north, north.scaled(2))
    >>> round(float(principal_axes(pair).major_axis_angle), 4)
    1.1071
    """
    inputs = _pairs(pair, owner=_AXES)
    dataset = build_dataset(
        inputs.joined(inputs.each(_axes)),
        inputs.attributes,
        over=inputs.over,
        title="Principal axes of two horizontal components",
        source="integration from sample to sample",
    )
    return inputs.labelled(dataset)


def _spectra(
    signals: tuple[Signal, Signal], seconds: Array, ratios: Array, vectors: Array
) -> dict[str, Array]:
    """Compute :eq:`eq-rotated-percentiles` and :eq:`eq-geometric-mean`."""
    moving = np.flatnonzero(seconds > 0.0)
    frequency = 2.0 * np.pi / seconds[moving]
    all_directions = np.empty((ratios.size, seconds.size, len(vectors)))
    all_directions[:] = rotated_peaks(*signals, vectors)
    for place, ratio in enumerate(ratios.tolist()):
        displacement = rotated_displacements(*signals, seconds[moving], ratio, vectors)
        all_directions[place, moving] = frequency[:, None] ** 2 * displacement
    half = len(vectors) // 2
    greatest = all_directions.argmax(axis=2)
    return {
        "median_rotated_acceleration": np.median(all_directions, axis=2),
        "greatest_rotated_acceleration": all_directions.max(axis=2),
        "geometric_mean_acceleration": np.sqrt(
            all_directions[:, :, 0] * all_directions[:, :, half]
        ),
        "direction_of_greatest": np.pi * greatest / len(vectors),
    }


def _axes(pair: HorizontalPair) -> dict[str, float]:
    angle, major, minor = principal_axis_and_intensities(pair)
    return {
        "major_axis_angle": angle, "major_arias_intensity": major, "minor_arias_intensity": minor
    }  # fmt: skip


def _pairs(value: object, *, owner: str) -> Inputs[HorizontalPair]:
    """Read one pair or several."""
    if isinstance(value, HorizontalPair):
        return Inputs([value], None, {"motion": value.name, "references": _REFERENCES})
    if not isinstance(value, Mapping):
        expected = "two horizontal components, rf.HorizontalPair(first, second)"
        msg = f"{owner}: pair needs {expected}, got {short_repr(value)}"
        raise ComponentError(msg)
    pairs = by_label(cast("Mapping[Any, Any]", value), owner=owner)
    for label, pair in pairs.items():
        if not isinstance(pair, HorizontalPair):
            msg = (
                f"{owner}: {label!r} is {short_repr(pair)}, expected a HorizontalPair; those of a "
                "suite are suite.pairs"
            )
            raise ComponentError(msg)
    return Inputs(list(pairs.values()), list(pairs), {"references": _REFERENCES})
