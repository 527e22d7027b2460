"""
Rest, slide, rock, or both
==========================

The response of a block of t = b/h = 0.25 to a ground that starts to accelerate by A g, for any
coefficient of friction. Colours are runs; lines are the boundaries in closed form: a block slides
where the friction is below A and t, and rocks without slip where it is above (A + 4 A t² + 3 t) /
(4 + t² + 3 A t).
"""

import numpy as np
from matplotlib import pyplot
from matplotlib.colors import ListedColormap

import rockframe as rf

SLENDERNESS = 0.25
NAMES = ("rests", "slides", "rocks", "slides and rocks")

block = rf.Block(width="0.5 m", height="2 m", mass="1 t")
shaken = rf.GroundMotion.from_arrays((np.full(3, 9.80665), "m/s^2"), "0.002 s")
accelerations, frictions = np.linspace(0.01, 1.2, 60), np.linspace(0.01, 0.6, 60)
runs = rf.sweep(
    rf.System(block, rf.RigidGround(friction=0.5)),
    shaken,
    scale=accelerations,
    friction=frictions,
    accuracy="fast",
)
slides = (runs.peak_slip > 0.0).astype(int)
rocks = (runs.peak_rotation > 0.0).astype(int)
found = (slides + 2 * rocks).squeeze().transpose("friction", "scale")

figure, axes = pyplot.subplots(layout="constrained")
colours = ListedColormap(["0.93", "#9ecae1", "#fdd0a2", "#a1d99b"])
axes.pcolormesh(accelerations, frictions, found, cmap=colours, vmin=-0.5, vmax=3.5)
t, a = SLENDERNESS, np.linspace(SLENDERNESS, 1.2, 100)
needed = (a + 4.0 * a * t**2 + 3.0 * t) / (4.0 + t**2 + 3.0 * a * t)
axes.plot(a, needed, "k", label="friction to rock without a slip")
axes.plot([0.0, t, 1.2], [0.0, t, t], "k--", label="friction to slide on the whole base")
axes.plot([t, t], [t, 0.6], "k:", label="acceleration to tip")
for name, place in zip(NAMES, [(0.05, 0.4), (0.6, 0.1), (0.5, 0.5), (0.85, 0.31)], strict=True):
    axes.text(*place, name)
axes.set(xlabel="ground acceleration $A$ [g]", ylabel="coefficient of friction", ylim=(0.0, 0.6))
axes.legend(loc="upper right", fontsize="small")
print(runs.attrs["verdict"])
