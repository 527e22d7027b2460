"""The shake-table tests of two granite blocks: table motions and fallen specimens."""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import xarray as xr

import rockframe as rf
from rockframe.signals.integrals import ground_path
from rockframe.signals.motion import absolute_peak

VARIABLE = "ROCKFRAME_GRANITE"
_BESIDE_THE_PROJECT = (
    Path(__file__).resolve().parents[3] / "shared" / "granite" / "shake_table_a.nc"
)
SPECIMENS = (1, 2)
TIME_STEP = 0.005
"""Of the recordings [s]."""
BAND = {"low": "0.1 Hz", "high": "25 Hz"}
"""Below this band the recordings contain sensor drift, above it noise."""


@dataclass(frozen=True)
class Programme:
    """All tests: the table's motion, its name, and which specimens fell.

    Parameters
    ----------
    motions : list of GroundMotion
        As recorded on the table, within `BAND`.
    names : ndarray of str, shape (tests,)
        Name of the earthquake record that the table followed, at any amplitude.
    numbers : ndarray of int, shape (tests,)
        Numbers of the tests.
    fell : dict of int to ndarray of bool, shape (tests,)
        By specimen.
    """

    motions: list[rf.GroundMotion]
    names: np.ndarray
    numbers: np.ndarray
    fell: dict[int, np.ndarray]

    def peaks(self) -> tuple[np.ndarray, np.ndarray]:
        """Return peak accelerations [m s^-2] and peak velocities [m s^-1] of the table."""
        signals = [motion.si.horizontal for motion in self.motions]
        accelerations = [absolute_peak(signal.pieces) for signal in signals]
        velocities = [absolute_peak(ground_path(signal)[0]) for signal in signals]
        return np.array(accelerations), np.array(velocities)


def programme_path() -> Path:
    """Return the path of the file of tests."""
    return Path(os.environ.get(VARIABLE, _BESIDE_THE_PROJECT))


def read_programme(path: Path, band: dict[str, str] | None = BAND) -> Programme:
    """Read all tests; without `band` unfiltered."""
    with xr.open_dataset(path) as file:
        data = file.load()
    if data.acceleration.attrs["units"] != "g":
        found = data.acceleration.attrs["units"]
        msg = f"{path}: acceleration in {found}, expected g"
        raise ValueError(msg)
    motions = []
    for row, count in zip(data.acceleration.to_numpy(), data.samples.to_numpy(), strict=True):
        motion = rf.GroundMotion.from_arrays((row[:count], "g_0"), f"{TIME_STEP} s")
        motions.append(motion if band is None else motion.filtered(**band))
    fell = {one: data[f"overturned_specimen_{one}"].to_numpy().astype(bool) for one in SPECIMENS}
    names = data.motion.to_numpy().astype(str)
    return Programme(motions, names, data.test.to_numpy(), fell)
