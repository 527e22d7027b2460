"""
Cloud analysis
==============

Sixty unscaled motions, with a line through the runs that rock; runs that overturn are treated
separately (:doc:`/guide/clouds_and_hazard`).
"""

import numpy as np

import rockframe as rf

cabinet = rf.System(rf.Block(width="0.3 m", height="1.5 m", mass="200 kg"))
rng = np.random.default_rng(1)
magnitudes, distances = rng.uniform(6.0, 7.5, 60), rng.uniform(2, 30, 60)
suite = {
    f"seed {k}": rf.GroundMotion.stochastic(m, f"{d} km", seed=k, stress_drop="30 MPa")
    for k, (m, d) in enumerate(zip(magnitudes, distances, strict=True))
}
runs = rf.sweep(cabinet, suite, free_vibration="4 s", progress=False)
found = rf.cloud_analysis(runs, "PGV", limits=[0.1, 0.4], least=0.01)
print(found.verdict)
rf.plot.cloud(found)
