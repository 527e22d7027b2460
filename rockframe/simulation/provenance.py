"""What a result says of its run, and the way back."""

import json

import numpy as np
import xarray as xr

from rockframe.motion import GroundMotion
from rockframe.units import TIME, Unit


def motion_attributes(motion: GroundMotion | None) -> dict[str, str | float | int]:
    """Describe a motion so that it can be recognised, and rebuilt where possible."""
    if motion is None:
        return {"motion": "none"}
    return {
        "motion": motion.name,
        "motion_sha256": motion.sha256,
        "motion_time_step": motion.si.time_step,
        "motion_samples": len(motion),
        "motion_json": json.dumps(motion.to_dict()),
        "motion_history": "; ".join(motion.history),
    }


def motion_from_dataset(dataset: xr.Dataset) -> GroundMotion | None:
    """Give the motion of a result: built anew, or read from its histories.

    Parameters
    ----------
    dataset : xarray.Dataset
        A result.

    Returns
    -------
    GroundMotion or None
        None where the dataset does not hold the motion, sample by sample.
    """
    text = dataset.attrs.get("motion_json")
    if text is None:
        return None
    description = json.loads(text)
    if description.get("constructor"):
        return GroundMotion.from_dict(description)
    step = float(dataset.attrs["motion_time_step"])
    count = int(dataset.attrs["motion_samples"])
    time = dataset["time"].to_numpy() if "time" in dataset else np.zeros(0)
    if len(time) < count or not np.array_equal(time[:count], np.arange(count) * step):
        return None
    unit = str(Unit.METRE_PER_SECOND_SQUARED)
    components = {
        name: (dataset[variable].to_numpy()[:count], unit)
        for name, variable in (
            ("acceleration", "ground_acceleration"),
            ("vertical", "vertical_ground_acceleration"),
        )
        if variable in dataset
    }
    motion = GroundMotion.from_arrays(
        time_step=f"{step!r} {TIME.unit}", name=str(dataset.attrs["motion"]), **components
    )
    return motion if motion.sha256 == dataset.attrs["motion_sha256"] else None
