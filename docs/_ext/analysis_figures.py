"""Figures of analyses of many runs, drawn when the manual is built."""

import runpy
import warnings
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

import rockframe as rf
from rockframe.plot import Panels

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"
CABINET = rf.System(rf.Block(width="0.5 m", height="2 m", mass="400 kg"))


def _suite(count: int) -> dict[str, rf.GroundMotion]:
    return {
        f"seed {k}": rf.GroundMotion.stochastic(6.6, "5 km", seed=k, stress_drop="20 MPa")
        for k in range(count)
    }


def cabinet_fragility() -> Axes:
    """Draw the fragility of the guide."""
    scales = [0.5, 1, 1.5, 2, 3, 4, 6]
    runs = rf.sweep(CABINET, _suite(12), scale=scales, free_vibration="4 s")
    return rf.plot.fragility(rf.fragility(runs, "PGA", limits=["uplift", 0.3]))


def cabinet_analysis() -> Panels:
    """Draw a dynamic analysis."""
    return rf.plot.dynamic_analysis(
        rf.incremental_dynamic_analysis(
            CABINET,
            _suite(8),
            scale=np.arange(0.2, 6.1, 0.2),
            limits=["uplift", 0.4],
            intensity="PGA",
            free_vibration="4 s",
        )
    )


def sine_map() -> Axes:
    """Draw a map of overturning by one sine, small rotations."""
    block = rf.Block.from_size(radius="5 m", slenderness=10, mass="50 t")
    system = rf.System(block, rf.RigidGround(restitution=0.9), rotation="small")
    return rf.plot.overturning_map(
        rf.overturning_map(
            system,
            rf.GroundMotion.sine_pulse,
            amplitude=(np.linspace(1.05, 11.0, 60), "m/s^2"),
            frequency=(np.linspace(0.2, 1.3, 60), "Hz"),
            impacts=2,
            free_vibration="40 s",
            accuracy="fast",
        )
    )


def overturning_spectrum() -> Panels:
    """Draw the least intensity that overturns over the size of the block."""
    with warnings.catch_warnings():
        # two of 4000 runs are less exact than the others, by less than a line is wide
        warnings.simplefilter("ignore", rf.ModelWarning)
        found = rf.overturning_spectrum(
            CABINET,
            _suite(4),
            periods=(np.geomspace(1.0, 8.0, 25), "s"),
            slenderness=[4, 6],
            scale=np.geomspace(0.2, 16.0, 20),
            width=0.01,
            free_vibration="4 s",
            accuracy="fast",
        )
    return rf.plot.overturning_spectrum(found)


def office_contents() -> Figure:
    """Draw the medians of the example."""
    example = runpy.run_path(str(EXAMPLES / "office_contents.py"))
    return example["draw"](
        example["table_of"](example["fragilities"](example["earthquakes"](6), None))
    )
