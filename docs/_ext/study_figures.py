"""Figures of studies, drawn when the manual is built."""

import runpy
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

import rockframe as rf

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"
STANDS, OVERTURNS = "#1f3a5f", "#cc6677"


def critical_scale() -> Figure:
    """Draw the peak rotation of a tower on pads over the scale of the motion."""
    tower = rf.System(
        rf.Block(width="1.2 m", height="6 m", mass="20 t"),
        rf.TwoSpringSupport(frequency_ratio=20, damping_ratio=0.10),
    )
    motion = rf.GroundMotion.stochastic(6.8, "5 km", seed=29, stress_drop="20 MPa")
    found = rf.critical_scale(tower, motion, free_vibration="10 s")
    theta = tower.simulate(duration="1 s", outputs=None).overturning_angle
    figure = Figure(figsize=(9.0, 3.4), layout="constrained")
    axes = figure.subplots(1, 2, sharey=True, width_ratios=(2, 1))
    ends = [*found.scale_above.values, found.scale[-1].item()]
    falls = found.overturns_above.values
    near = (0.98 * ends[0], 1.02 * ends[4])
    for place, limits in zip(axes, ((0.0, 2.5), near), strict=True):
        for number in np.flatnonzero(falls):
            place.axvspan(ends[number], ends[number + 1], color=OVERTURNS, alpha=0.15, lw=0.0)
        for outcome, colour, words in ((0, STANDS, "stands"), (1, OVERTURNS, "overturns")):
            chosen = (found.outcome == outcome).values
            place.plot(
                found.scale[chosen],
                (found.peak_rotation / theta)[chosen],
                "o",
                ms=2.5,
                color=colour,
                label=words,
            )
        place.set(xlim=limits, ylim=(0.0, 1.05), xlabel="scale of the motion")
    axes[0].set_ylabel(r"peak of $|\alpha|/\theta$")
    axes[0].legend(frameon=False, loc="lower right")
    return figure


def size_and_pulse() -> Figure:
    """Draw the map of the example."""
    example = runpy.run_path(str(EXAMPLES / "size_and_pulse.py"))
    return example["draw"](example["study"](50, 60, None))
