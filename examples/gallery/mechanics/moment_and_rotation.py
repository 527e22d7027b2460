"""
Moment over rotation
====================

The moment that holds a tower at a rotation, on each base, by
:py:meth:`rockframe.System.moment_rotation`. This is quasi-static: no time passes.
"""

import matplotlib.pyplot as plt
import numpy as np

import rockframe as rf

tower = rf.Block(width="4 m", height="12 m", mass="200 t")
bases = {
    "rigid ground": (),
    "two pads": (rf.TwoSpringSupport(frequency_ratio=20, damping_ratio=0.1),),
    "soil, 10 MPa": (rf.WinklerSoil(stiffness="10 MPa", damping_ratio=0.1),),
    "soil, 40 MPa": (rf.WinklerSoil(stiffness="40 MPa", damping_ratio=0.1),),
}
angles = np.linspace(0.0, 0.3, 150)
figure, axes = plt.subplots(figsize=(6.4, 4.0), layout="constrained")
for (name, base), dashes in zip(bases.items(), ("-", "--", "-.", ":"), strict=True):
    held = rf.System(tower, *base).moment_rotation((angles, "rad"))
    axes.plot(np.degrees(held.angle), held.restoring_moment / 1e6, dashes, label=name)
axes.axhline(0.0, color="0.7", lw=0.6)
axes.set(xlabel="rotation [deg]", ylabel="restoring moment [MN m]")
axes.legend(frameon=False)
plt.show()
