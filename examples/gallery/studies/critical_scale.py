"""
How much it takes to overturn
=============================

A tower on pads under one earthquake at all scales. Overturning is not monotonic: above the critical
scale there are others at which the tower stands (:doc:`/guide/critical_scale`).
"""

import matplotlib.pyplot as plt
import numpy as np

import rockframe as rf

tower = rf.System(
    rf.Block(width="1.2 m", height="6 m", mass="20 t"),
    rf.TwoSpringSupport(frequency_ratio=20, damping_ratio=0.10),
)
motion = rf.GroundMotion.stochastic(7.2, "5 km", seed=0, stress_drop="20 MPa")
found = rf.critical_scale(tower, motion, free_vibration="10 s")
print(found.attrs["verdict"])

theta = tower.equilibrium().overturning_angle
ends = [*found.scale_above.values, found.scale[-1].item()]
falls = found.overturns_above.values
near = (0.98 * ends[0], 1.02 * ends[4])
figure, grid = plt.subplots(
    1, 2, figsize=(9.0, 3.4), sharey=True, width_ratios=(2, 1), layout="constrained"
)
for axes, limits in zip(grid, ((0.0, 4.0), near), strict=True):
    for number in np.flatnonzero(falls):
        axes.axvspan(ends[number], ends[number + 1], color="#d55e00", alpha=0.15, lw=0.0)
    for outcome, colour, words in ((0, "#0072b2", "stands"), (1, "#d55e00", "overturns")):
        chosen = (found.outcome == outcome).values
        axes.plot(
            found.scale[chosen], (found.peak_rotation / theta)[chosen],
            "o", ms=2.5, color=colour, label=words,
        )  # fmt: skip
    axes.set(xlim=limits, ylim=(0.0, 1.05), xlabel="scale of the motion")
grid[0].set_ylabel(r"peak of $|\alpha|/\theta$")
grid[0].legend(frameon=False, loc="lower right")
plt.show()
