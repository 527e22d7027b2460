"""
Incremental dynamic analysis
============================

Eight motions at increasing scales, in grey, with the fractiles of their peaks. Solid dots: the
cabinet overturns for the first time; hollow dots: it stands again, or overturns again
(:doc:`/guide/analyses`).
"""

import numpy as np

import rockframe as rf

cabinet = rf.System(rf.Block(width="0.5 m", height="2 m", mass="400 kg"))
suite = {
    f"seed {k}": rf.GroundMotion.stochastic(7.0, "5 km", seed=k, stress_drop="20 MPa")
    for k in range(8)
}
analysis = rf.incremental_dynamic_analysis(
    cabinet,
    suite,
    scale=np.arange(0.2, 6.1, 0.2),
    limits=["uplift", 0.4],
    intensity="PGA",
    free_vibration="4 s",
    progress=False,
)
print(analysis.verdict)
rf.plot.dynamic_analysis(analysis)
