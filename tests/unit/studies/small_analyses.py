"""Motions, and small analyses of them."""

from functools import cache

import numpy as np
import xarray as xr

import rockframe as rf
from rockframe.results.schema import SCHEMA

BLOCK = rf.Block(width="0.5 m", height="2 m", mass="400 kg")
SYSTEM = rf.System(BLOCK)
QUIET = {"progress": False}
FAST = {"accuracy": "fast", "free_vibration": "4 s", **QUIET}


def motions(sign=1.0):
    return {name: motion.scaled(sign) for name, motion in records().items()}


@cache
def records():
    return {
        f"seed {k}": rf.GroundMotion.stochastic(
            6.6, "5 km", seed=k, stress_drop="20 MPa", source="one corner"
        )
        for k in range(4)
    }


@cache
def complete_analysis():
    """Return an analysis of all motions, computed once per process; tests do not change it."""
    return rf.incremental_dynamic_analysis(
        SYSTEM, motions(), scale=np.arange(0.5, 6.1, 0.5), limits=["uplift", 0.4],
        intensity="PGA", free_vibration="4 s", **QUIET,
    )  # fmt: skip


def assert_valid_file(dataset, tmp_path):
    """Check names and units of variables, and the round trip of a dataset through a file."""
    for name, variable in dataset.variables.items():
        assert variable.attrs.get("long_name"), name
        if name in SCHEMA and SCHEMA[name].unit is not None:
            assert "units" in variable.attrs, name
    dataset.to_netcdf(tmp_path / "found.nc")
    with xr.open_dataset(tmp_path / "found.nc") as again:
        xr.testing.assert_identical(again.load().drop_attrs(), dataset.drop_attrs())
    return True
