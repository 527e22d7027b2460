"""
Time against error
==================

Time and error of all simpler models and all accuracies of one scene (:doc:`/guide/tradeoff`).
"""

import rockframe as rf

system = rf.System(
    rf.FrameEquivalent(width="4 m", height="18 m", mass="99 t", shape_factor=2.92),
    rf.TwoSpringSupport(frequency_ratio=40, damping_ratio=0.10),
    rf.CushionCap(height="0.9 m", mass="36 t"),
    rf.WinklerSoil(stiffness="9 MPa", damping_ratio=0.20),
)
motion = rf.GroundMotion.stochastic(7.5, "5 km", seed=29, stress_drop="20 MPa")
rungs = rf.tradeoff(system, motion, repeats=3)
print(rf.recommend(rungs, 0.05, error="history_error"))
rf.plot.tradeoff(rungs)
