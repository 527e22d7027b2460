"""Attributes of datasets that users have changed: errors name the attribute, whatever reads it."""

import json

import pytest

import rockframe as rf
from rockframe.errors import AssemblyError, SchemaError

pytestmark = pytest.mark.unit

SYSTEM = rf.System(rf.Block(width="0.6 m", height="2.4 m", mass="400 kg"))
PULSE = rf.GroundMotion.sine_pulse("4 m/s^2", "1 Hz")
MOTIONS = {f"pulse {k}": PULSE.scaled(0.5 + 0.1 * k) for k in range(3)}
SCALES = {"scale": [0.5, 1.0, 2.0], "accuracy": "fast"}
DAMAGED = ("x", "[1]", '[{"a": 1}]', "5", 5)
"""No JSON, or JSON that describes something else."""

READERS = {
    # what reads attributes of a dataset, and which ones
    "run": {
        lambda run: SYSTEM.simulate(PULSE, initial=run): (
            "end_state", "system_json", "run_json", "overturning_time", "solver_end_time",
        ),
        rf.System.from_dataset: ("system_json",),
        rf.plot.state: ("system_json",),
    },
    "sweep": {
        lambda runs: rf.case(runs, scale=1.0, motion="pulse 1"): (
            "axes_json", "run_json", "motion_names", "motions_json", "system_json",
        ),
        lambda runs: rf.case(runs.isel(scale=0, motion=0)).simulate(outputs=()): ("axes_json",),
        lambda runs: rf.System.from_dataset(runs.isel(scale=0)): ("axes_json",),
        lambda runs: rf.fragility(runs, "PGA"): ("axes_json", "motion_names", "motions_json"),
        lambda runs: runs.isel(scale=[0]).rockframe.verdict: ("case_count",),
        lambda runs: rf.concat([runs.isel(motion=[0]), runs.isel(motion=[1])], "motion"): (
            "axes_json", "motion_names", "motions_json",
        ),
    },
    "analysis": {
        lambda found: rf.fragility(found, trials="capacities"): ("limits_json",),
        lambda found: rf.fractile_curves(found, "peak_rotation"): ("axes_json",),
    },
}  # fmt: skip
CASES = [
    (name, read, attribute)
    for name, readers in READERS.items()
    for read, attributes in readers.items()
    for attribute in attributes
]


@pytest.fixture(scope="module")
def datasets():
    return {
        "run": SYSTEM.simulate(PULSE),
        "sweep": rf.sweep(SYSTEM, MOTIONS, **SCALES),
        "analysis": rf.incremental_dynamic_analysis(SYSTEM, MOTIONS, **SCALES),
    }


@pytest.mark.parametrize(("name", "read", "attribute"), CASES)
@pytest.mark.parametrize("value", DAMAGED)
def test_damaged_attribute_is_named(name, read, attribute, value, datasets):
    read(datasets[name])
    if attribute in ("overturning_time", "solver_end_time", "case_count"):
        value = "x"
    damaged = datasets[name].assign_attrs({attribute: value})
    names = "motion_names|motions_json" if attribute == "motion_names" else attribute
    with pytest.raises(SchemaError, match=names):  # both say how many motions there are
        read(damaged)


def test_end_of_a_run_that_lacks_numbers_is_refused(datasets):
    end = json.loads(datasets["run"].attrs["end_state"])
    for name in ("state", "memory"):
        shorter = json.dumps({**end, name: end[name][1:]})
        with pytest.raises(AssemblyError, match="'end_state' that lacks numbers"):
            SYSTEM.simulate(PULSE, initial=datasets["run"].assign_attrs(end_state=shorter))


def test_renamed_motion_of_a_sweep_is_named(datasets):
    renamed = datasets["sweep"].assign_coords(motion=["a", "b", "c"])
    with pytest.raises(SchemaError, match="no motion 'b'; there are pulse 0"):
        rf.case(renamed, scale=1.0, motion="b")
