"""Conversion of a ground motion to a labelled dataset and back, without loss."""

from __future__ import annotations

import json
from dataclasses import replace
from typing import Any, Final

import numpy as np
import xarray as xr

from rockframe.arguments import checked_dataset
from rockframe.constants import CONVENTIONS
from rockframe.motion.value import UNNAMED, MotionType, MotionValue
from rockframe.records import LONG_NAMES, stored_motion
from rockframe.units import Unit

_PIECES_DIMS: Final = ("interval", "power")


def to_dataset(motion: MotionValue) -> xr.Dataset:
    """Convert the motion to a dataset that xarray can store.

    Returns
    -------
    xarray.Dataset
        ``acceleration`` (and ``vertical_acceleration``) over ``time``, with
        units, name, metadata and history.

    Examples
    --------
    >>> import rockframe as rf
    >>> rf.GroundMotion.half_sine_pulse("3 m/s^2", "0.5 s").to_dataset().sizes["time"]
    65
    """
    si = motion.si
    components = {"acceleration": si.horizontal, "vertical_acceleration": si.vertical}
    present = {name: signal for name, signal in components.items() if signal is not None}
    arrays = {name: signal.samples for name, signal in present.items()} | {
        f"{name}_pieces": signal.polynomials for name, signal in present.items()
    }
    variables: dict[str, Any] = {
        name: (
            "time" if values.ndim == 1 else _PIECES_DIMS,
            values.copy(),
            {"units": str(Unit.METRE_PER_SECOND_SQUARED), "long_name": LONG_NAMES[name]},
        )
        for name, values in arrays.items()
        if values is not None
    }
    time = np.arange(len(motion)) * si.time_step
    # no axis and no standard name: CF 4.4 reserves them for times since a date
    axis = {"units": str(Unit.SECOND), "long_name": "time from the first sample"}
    attributes: dict[str, str | float] = {
        "Conventions": CONVENTIONS,
        "title": f"Ground motion {motion.name}",
        "motion_name": motion.name,
        "motion_sha256": motion.sha256,
        "time_step": si.time_step,
        "metadata": json.dumps(dict(motion.metadata)),
    }
    if motion.history:
        attributes["history"] = "\n".join(motion.history)
    if motion.recipe is not None:
        attributes["recipe"] = json.dumps(dict(motion.recipe))
    dataset = xr.Dataset(variables, coords={"time": ("time", time, axis)}, attrs=attributes)
    for name in (*variables, "time"):
        dataset[name].encoding["_FillValue"] = None
    return dataset


def from_dataset(kind: type[MotionType], dataset: xr.Dataset) -> MotionType:
    """Build the motion from the result of :meth:`to_dataset`, identical bit for bit.

    Parameters
    ----------
    dataset : xarray.Dataset
        Dataset with ``acceleration`` over ``time``.

    Returns
    -------
    GroundMotion

    Raises
    ------
    SchemaError
        The dataset is not of this form, or its samples have been changed.

    Examples
    --------
    >>> import rockframe as rf
    >>> pulse = rf.GroundMotion.half_sine_pulse("3 m/s^2", "0.5 s")
    >>> rf.GroundMotion.from_dataset(pulse.to_dataset()) == pulse
    True
    """
    stored = stored_motion(checked_dataset(dataset, owner=f"{kind.__name__}.from_dataset"))
    return kind(**vars(replace(stored, name=stored.name or UNNAMED)))
