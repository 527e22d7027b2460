"""Average spectral acceleration."""

from collections.abc import Iterable, Mapping
from typing import Any, Final, cast

import numpy as np
import xarray as xr

from rockframe.arguments import checked_choice
from rockframe.errors import ComponentError
from rockframe.measures.directions import rotated_spectrum
from rockframe.measures.response import checked_periods, response_spectrum
from rockframe.motion import GroundMotion
from rockframe.motion.pair import HorizontalPair
from rockframe.motion.quantities import ArrayLike
from rockframe.motion.value import GroundComponent
from rockframe.results.schema import build_dataset
from rockframe.signals.spectra import DAMPING_RATIO
from rockframe.suggestions import with_hints
from rockframe.units import PERIOD, QuantityLike, RatioLike, to_ratio

_OWNER: Final = "average_spectral_acceleration"
_REFERENCES: Final = "Eads et al. (2015), Earthquake Engng. Struct. Dyn. 44, 2057-2073"
_PAIR_AVERAGES: Final = {
    "geometric_mean_acceleration": "average_geometric_mean_acceleration",
    "median_rotated_acceleration": "average_median_rotated_acceleration",
}


@with_hints()
def average_spectral_acceleration(
    motion: GroundMotion | HorizontalPair | Mapping[str, GroundMotion | HorizontalPair],
    periods: ArrayLike | Iterable[QuantityLike],
    damping_ratio: RatioLike = 0.05,
    *,
    component: str = "horizontal",
) -> xr.Dataset:
    """Compute the geometric mean of a spectrum over periods, Sa_avg.

    Parameters
    ----------
    motion : GroundMotion or HorizontalPair, or mapping of str to one of these
        The motion or the pair, or several by their labels.
    periods : (sequence, unit), Quantity or sequence of str
        Periods, all of equal weight, such as 57 from 0.2 to 3 times the first period of a building;
        increasing, and above zero [s].
    damping_ratio : float, optional
        Damping ratio of the oscillators [1].
    component : {"horizontal", "vertical"}, optional
        Component of a motion; pairs have their horizontal ones.

    Returns
    -------
    xarray.Dataset
        Scalars, over ``motion`` if there are several [m s^-2]. For motions:
        ``average_spectral_acceleration``, :eq:`eq-average-acceleration`. For pairs:
        ``average_geometric_mean_acceleration`` and ``average_median_rotated_acceleration``, the
        averages of these spectra of :func:`rockframe.rotated_spectrum`.

    Raises
    ------
    UnitsError
        Periods without a unit, or with one of another kind.
    ComponentError
        The input is neither motions nor pairs, or an argument is out of range.

    Examples
    --------
    >>> import rockframe as rf
    >>> pulse = rf.GroundMotion.sine_pulse("1 m/s^2", "1 Hz", cycles=0.5)
    >>> found = average_spectral_acceleration(pulse, ["0.5 s", "1 s", "2 s"])
    >>> round(float(found.average_spectral_acceleration), 3)
    1.273
    """
    if periods is None:  # pyright: ignore[reportUnnecessaryComparison]
        msg = f"{_OWNER}: periods must be given, for example (np.linspace(0.2, 3, 57), 's')"
        raise ComponentError(msg)
    seconds = checked_periods(periods, owner=_OWNER)
    if not (seconds > 0.0).all():
        msg = f"{_OWNER}: periods must be above zero, whose logarithm is averaged"
        raise ComponentError(msg)
    damping = to_ratio(damping_ratio, owner=_OWNER, name="damping_ratio", condition=DAMPING_RATIO)
    with_unit = (seconds, str(PERIOD.unit))
    things = list(motion.values()) if isinstance(motion, Mapping) else [motion]
    if things and all(isinstance(thing, HorizontalPair) for thing in things):
        which = checked_choice(GroundComponent, component, owner=_OWNER, name="component")
        if which is not GroundComponent.HORIZONTAL:
            msg = f"{_OWNER}: a pair has both horizontal components; give its motion pair.vertical"
            raise ComponentError(msg)
        spectrum = rotated_spectrum(cast("Any", motion), with_unit, damping)
        names = _PAIR_AVERAGES
    else:
        spectrum = response_spectrum(cast("Any", motion), with_unit, damping, component=component)
        names = {"pseudo_spectral_acceleration": _OWNER}
    averages: dict[str, Any] = {}
    for name, average in names.items():
        with np.errstate(divide="ignore"):
            logarithms: Any = np.log(spectrum[name].isel(damping_ratio=0))
        averages[average] = np.exp(logarithms.mean("period")).to_numpy()
    several = "motion" in spectrum.dims
    copied = ("motion", "motion_sha256", "component")
    dataset = build_dataset(
        averages,
        {
            **{name: spectrum.attrs[name] for name in copied if name in spectrum.attrs},
            "references": _REFERENCES,
            "damping_ratio": damping,
            "lowest_period": float(seconds[0]),
            "highest_period": float(seconds[-1]),
            "periods": int(seconds.size),
        },
        over=("motion",) if several else (),
        title="Average spectral acceleration",
        source="recurrence of Nigam and Jennings",
    )
    return dataset.assign_coords(motion=spectrum["motion"]) if several else dataset
