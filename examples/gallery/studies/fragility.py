"""
Fragility of a cabinet
======================

A lognormal capacity for each limit state, from twelve motions at seven scales
(:doc:`/guide/fragility`).
"""

import rockframe as rf

cabinet = rf.System(rf.Block(width="0.5 m", height="2 m", mass="400 kg"))
suite = {
    f"seed {k}": rf.GroundMotion.stochastic(7.0, "5 km", seed=k, stress_drop="20 MPa")
    for k in range(12)
}
runs = rf.sweep(
    cabinet, suite, scale=[0.5, 1, 1.5, 2, 3, 4, 6], free_vibration="4 s", progress=False
)
found = rf.fragility(runs, "PGA", limits=["uplift", 0.3])
print(found.verdict)
rf.plot.fragility(found)
