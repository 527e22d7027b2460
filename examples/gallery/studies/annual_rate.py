"""
Annual rates
============

The contribution of each intensity to the annual rate at which a cabinet overturns at a site
(:doc:`/guide/clouds_and_hazard`).
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
cloud = rf.cloud_analysis(runs, "PGV", limits=[0.1, 0.4], least=0.01)
hazard = {
    "intensity": ([0.02, 0.05, 0.1, 0.2, 0.4, 0.8, 1.6, 3.2], "m/s"),
    "rate": [0.2, 0.06, 0.02, 5e-3, 1e-3, 1.5e-4, 1.5e-5, 1e-6],
}
rates = rf.annual_rate(cloud, hazard)
print(rates.verdict)
rf.plot.annual_rate(rates)
