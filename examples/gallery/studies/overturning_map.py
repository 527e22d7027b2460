"""
Which pulses overturn a block
=============================

One sine of every amplitude and frequency, after Zhang and Makris (2001). Between pulses that
overturn the block after an impact and those that do so without one there is a band of pulses under
which it remains standing.
"""

import numpy as np

import rockframe as rf

block = rf.Block.from_size(radius="5 m", slenderness=10, mass="50 t")
system = rf.System(block, rf.RigidGround(restitution=0.9), rotation="small")
found = rf.overturning_map(
    system,
    rf.GroundMotion.sine_pulse,
    amplitude=(np.linspace(1.05, 11.0, 60), "m/s^2"),
    frequency=(np.linspace(0.2, 1.3, 60), "Hz"),
    impacts=2,
    free_vibration="40 s",
    accuracy="fast",
    progress=False,
)
rf.plot.overturning_map(found)
