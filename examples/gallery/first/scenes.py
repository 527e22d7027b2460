"""
Every scene, drawn to scale
===========================

The parts that a system may have, and how ``rf.plot.scene`` draws them.
"""

import matplotlib.pyplot as plt

import rockframe as rf

block = rf.Block(width="4 m", height="12 m", mass="200 t")
pads = rf.TwoSpringSupport(frequency_ratio=20, damping_ratio=0.10)
cap = rf.CushionCap(height="1 m", mass="60 t", width="5 m")
soil = rf.WinklerSoil(stiffness="20 MPa", damping_ratio=0.20)
scenes = {
    "rigid ground": (),
    "two pads": (pads,),
    "soil": (soil,),
    "cap, soil": (cap, soil),
    "pads, cap, soil": (pads, cap, soil),
}
figure, grid = plt.subplots(1, len(scenes), figsize=(11.0, 4.0), layout="constrained")
for axes, (name, base) in zip(grid, scenes.items(), strict=True):
    system = rf.System(block, *base)
    rf.plot.scene(system, legend=False, ax=axes)
    axes.set_title(name, fontsize="medium")
    print(f"{name:<16} {system.describe().splitlines()[0]}")
plt.show()
