"""
What can be proved of chaotic flips
===================================

A block rocks under a harmonic motion, at scales among which its verdict flips many times. With
exact numbers nearly every verdict is proved. For all restitutions within a tolerance fewer are
proved, since long rocking amplifies every difference (:doc:`/guide/proved_verdicts`).
"""

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.colors import ListedColormap
from matplotlib.patches import Rectangle

import rockframe as rf

system = rf.System(rf.Block(width="0.5 m", height="2 m", mass="1 t"), gravity="9.81 m/s^2")
time = np.arange(0.0, 6.001, 0.02)
harmonic = np.round(2.4525 * np.sin(2.4 * np.pi * time), 9)
motion = rf.GroundMotion.from_arrays((harmonic, "m/s^2"), "0.02 s")

scales = np.round(np.linspace(1.0, 3.0, 41), 6)
tolerances = (0.0, 1e-9, 1e-7, 1e-5, 1e-3)
words = ["safe for ever", "overturns", "undecided"]
verdicts = np.full((len(tolerances), len(scales)), words.index("undecided"))
for column, scale in enumerate(scales):
    # the widest first: what is proved within a tolerance is proved within every smaller one
    for row in reversed(range(len(tolerances))):
        proof = rf.prove(
            system, motion, scale=scale, restitution_tolerance=tolerances[row], parts=1
        )
        if proof.verdict != "undecided":
            verdicts[: row + 1, column] = words.index(str(proof.verdict))
            break
for given, row in zip(tolerances, verdicts, strict=True):
    decided = sum(verdict < 2 for verdict in row)
    print(f"restitution within {given:g}: {decided} of {len(row)} proved")

figure, axes = plt.subplots(figsize=(8.0, 2.8), layout="constrained")
colours = ["#0072b2", "#d55e00", "#dddddd"]
edges = np.append(scales, 2.0 * scales[-1] - scales[-2]) - 0.5 * (scales[1] - scales[0])
rows = np.arange(len(tolerances) + 1)
axes.pcolormesh(edges, rows, verdicts, cmap=ListedColormap(colours), vmin=0, vmax=2, lw=0.0)
axes.hlines(rows[1:-1], edges[0], edges[-1], color="white", lw=2.0)
axes.set(
    xlabel="scale of the motion",
    ylabel="tolerance of\nthe restitution",
    yticks=rows[:-1] + 0.5,
    yticklabels=["exact", *(f"{given:g}" for given in tolerances[1:])],
)
axes.invert_yaxis()
handles = [Rectangle((0.0, 0.0), 1.0, 1.0, color=colour) for colour in colours]
figure.legend(handles, ["proved safe", "proved to overturn", "undecided"], ncols=3, frameon=False,
              loc="outside upper center")  # fmt: skip
plt.show()
