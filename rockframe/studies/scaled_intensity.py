"""An intensity measure of a motion, by its name."""

from typing import TYPE_CHECKING, Final

import numpy as np
import xarray as xr

from rockframe.errors import ComponentError, shown
from rockframe.measures import intensity_measures, response_spectrum
from rockframe.results.schema import SCHEMA
from rockframe.results.variables.motions import MEASURES
from rockframe.results.variables.variable import OSCILLATOR
from rockframe.units import ACCELERATION, PERIOD, TIME, to_ratio, to_si

if TYPE_CHECKING:
    from rockframe.motion import GroundMotion
    from rockframe.simulation.system import System
    from rockframe.units import QuantityLike, RatioLike

SPECTRAL: Final = tuple(row.name for row in MEASURES if row.dims == OSCILLATOR)
"""Measures that need the period of an oscillator."""
_OF_THE_BLOCK: Final = ("overturning_angle", "uplift_acceleration")
"""Numbers beside the measures that are not the motion's."""


class ScaledIntensity:
    """An intensity measure of a motion at any scale.

    Parameters
    ----------
    system : System
        Whose block the motion is to rock, and in which gravity.
    motion : GroundMotion
        The motion.
    name : str
        Variable of :func:`rockframe.intensity_measures` or
        :func:`rockframe.response_spectrum`.
    period : str or Quantity, optional
        Of the oscillator, for a spectral value [s].
    damping_ratio : float
        Of the oscillator, or of the spectra behind a measure [1].
    owner : str
        Function, for messages.

    Raises
    ------
    UnitsError
        `period` is no time, `damping_ratio` no ratio.
    ComponentError
        No such measure, or a period where none is needed, or none where one is.
    """

    def __init__(
        self,
        system: "System",
        motion: "GroundMotion",
        name: object,
        *,
        period: "QuantityLike | None",
        damping_ratio: "RatioLike",
        owner: str,
    ) -> None:
        self._motion = motion
        self._block = system.parts.block
        self._gravity = f"{system.gravity_si!r} {ACCELERATION.unit}"
        self._damping = to_ratio(damping_ratio, owner=owner, name="damping_ratio")
        spectral = name in SPECTRAL
        if spectral != (period is not None):
            needed = "needs a period, for example period='0.5 s'" if spectral else "has no period"
            msg = f"{owner}: intensity {shown(name)} {needed}"
            raise ComponentError(msg)
        self.period = None if period is None else to_si(period, PERIOD, owner=owner, name="period")
        of_motion = self._all(motion)
        known = sorted({*map(str, of_motion.data_vars), *SPECTRAL} - {*_OF_THE_BLOCK})
        if name not in known:
            msg = f"{owner}: intensity must be one of {', '.join(known)}, got {shown(name)}"
            raise ComponentError(msg)
        self.name = str(name)

    def at(self, scale: float) -> xr.DataArray:
        """Give the measure of the scaled motion; NaN unless the scale is above zero.

        Parameters
        ----------
        scale : float
            Factor of the motion [1].

        Returns
        -------
        xarray.DataArray
            A scalar, labelled as in the schema; a spectral value with its oscillator.
        """
        if scale > 0.0:
            return self._one(self._all(self._motion.scaled(scale)))
        return xr.full_like(self._one(self._all(self._motion)), np.nan)

    def _all(self, motion: "GroundMotion") -> xr.Dataset:
        if self.period is not None:
            return response_spectrum(motion, [f"{self.period!r} {TIME.unit}"], self._damping)
        return intensity_measures(
            motion, block=self._block, damping_ratio=self._damping, gravity=self._gravity
        )

    def _one(self, measures: xr.Dataset) -> xr.DataArray:
        return measures[self.name].isel(dict.fromkeys(SCHEMA[self.name].dims, 0))
