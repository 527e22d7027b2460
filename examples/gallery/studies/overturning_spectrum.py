"""
Larger blocks are safer
=======================

The least intensity that overturns blocks of all sizes and two shapes, under three motions: of two
blocks of the same shape the larger one withstands more.
"""

import warnings

import numpy as np

import rockframe as rf

cabinet = rf.System(rf.Block(width="0.5 m", height="2 m", mass="400 kg"))
suite = {
    f"seed {k}": rf.GroundMotion.stochastic(7.0, "5 km", seed=k, stress_drop="20 MPa")
    for k in range(3)
}
with warnings.catch_warnings():
    # a few of 2000 runs are less exact than the others, by less than a line is wide
    warnings.simplefilter("ignore", rf.errors.ModelWarning)
    found = rf.overturning_spectrum(
        cabinet,
        suite,
        periods=(np.geomspace(1.0, 8.0, 15), "s"),
        slenderness=[4, 6],
        scale=np.geomspace(0.3, 16.0, 15),
        bracket_width=0.01,
        free_vibration="4 s",
        accuracy="fast",
        progress=False,
    )
rf.plot.overturning_spectrum(found)
