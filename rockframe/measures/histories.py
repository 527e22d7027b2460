"""Velocity and displacement of the ground."""

from typing import TYPE_CHECKING

import xarray as xr

from rockframe.measures.common import GroundComponent, component_attributes, component_of, signal_of
from rockframe.results.dataset import build_dataset
from rockframe.signals.path import ground_path
from rockframe.signals.polynomials import knots_of

if TYPE_CHECKING:
    from rockframe.motion import GroundMotion

_PREFIX = {GroundComponent.HORIZONTAL: "", GroundComponent.VERTICAL: "vertical_"}


def velocity_and_displacement(
    motion: "GroundMotion", *, component: str = "horizontal"
) -> xr.Dataset:
    """Integrate a motion to velocity and displacement of the ground.

    Parameters
    ----------
    motion : GroundMotion
        The motion. The ground starts from rest.
    component : {"horizontal", "vertical"}, optional
        Which acceleration.

    Returns
    -------
    xarray.Dataset
        ``ground_acceleration`` [m s^-2], ``ground_velocity`` [m s^-1] and
        ``ground_displacement`` [m] over ``time`` [s], at the samples; of the vertical
        component ``vertical_ground_acceleration`` and so on.

    Raises
    ------
    ComponentError
        The motion lacks the component.

    Notes
    -----
    Exact for the motion that a simulation sees, :eq:`eq-ground-velocity` and
    :eq:`eq-ground-displacement`: straight lines between the samples of a record, the
    polynomials of an analytic pulse. Nothing is corrected: a record whose acceleration
    has an offset drifts. See :meth:`GroundMotion.baseline_corrected` and
    :meth:`GroundMotion.filtered`.

    Examples
    --------
    >>> import rockframe as rf
    >>> pulse = rf.GroundMotion.sine_pulse("1 m/s^2", "0.5 Hz", cycles=0.5)
    >>> path = velocity_and_displacement(pulse)
    >>> round(float(path.ground_velocity[-1]), 6)
    0.63662
    """
    owner = "velocity_and_displacement"
    signal = signal_of(motion, component, owner=owner)
    velocity, displacement = ground_path(signal)
    which = component_of(component, owner=owner)
    prefix = _PREFIX[which]
    values = {
        "time": signal.times,
        f"{prefix}ground_acceleration": signal.samples,
        f"{prefix}ground_velocity": knots_of(velocity),
        f"{prefix}ground_displacement": knots_of(displacement),
    }
    return build_dataset(
        {name: array.copy() for name, array in values.items()},
        component_attributes(motion, which),
        title="Ground motion",
        source="integration from sample to sample",
    )
