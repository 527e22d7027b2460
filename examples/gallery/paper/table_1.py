"""
Table 1: shape factors and space ratios of frames
=================================================

Six frames of columns, beams, slabs and infill walls. Their space ratios, Eq. (23), agree with the
printed ones to the last digit (in row 4 with the sections of row 1). The printed shape factors
cannot come from Eq. (22), which is computed from the members here: no building has one below 1.
"""

import matplotlib.pyplot as plt
import numpy as np

import rockframe as rf

ROWS = {  # width, height, storeys, column width, beam height, beam width; printed mu, chi
    "3 storeys, 3 m": (3, 9, 3, 0.25, 0.25, 0.20, 1.685, 0.153),
    "4 storeys, 3 m": (3, 14, 4, 0.30, 0.30, 0.20, 0.922, 0.157),
    "5 storeys, 3 m": (3, 16, 5, 0.35, 0.35, 0.30, 0.672, 0.180),
    "3 storeys, 4 m": (4, 9, 3, 0.25, 0.25, 0.20, 1.137, 0.123),
    "4 storeys, 4 m": (4, 14, 4, 0.35, 0.30, 0.20, 0.643, 0.129),
    "5 storeys, 5 m": (5, 15, 5, 0.40, 0.35, 0.30, 0.382, 0.125),
}

found = []
print("frame            printed: mu   chi      by the members: mu   chi")
for name, (width, height, storeys, column, beam, wide, mu, chi) in ROWS.items():
    frame = rf.FrameEquivalent.from_members(
        storeys=storeys,
        width=f"{width} m",
        height=f"{height} m",
        column_width=f"{column} m",
        beam_height=f"{beam} m",
        beam_width=f"{wide} m",
        density="2500 kg/m^3",
    )
    found.append((mu, frame.shape_factor))
    print(
        f"{name:<16} {mu:>11.3f} {chi:.3f} {frame.shape_factor:>20.3f} {frame.space_proportion:.3f}"
    )

printed, members = np.array(found).T
figure, axes = plt.subplots(figsize=(6.4, 3.4), layout="constrained")
place = np.arange(len(ROWS))
axes.barh(place - 0.2, printed, 0.4, color="#cc6677", label="printed")
axes.barh(place + 0.2, members, 0.4, color="#1f3a5f", label="of the members, Eq. (22)")
axes.axvline(1.0, ls=":", color="0.4")
axes.text(1.02, -0.75, "least possible", va="center", color="0.35", fontsize="small")
axes.set_yticks(place, ROWS)
axes.set(xlabel=r"shape factor $\mu$", ylim=(len(ROWS) - 0.4, -1.1))
figure.legend(loc="outside lower center", ncols=2, frameon=False)
plt.show()
