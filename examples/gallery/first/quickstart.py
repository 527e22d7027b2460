"""
A six-storey frame under an earthquake
======================================

The script of the quick start (:doc:`/guide/quickstart`): parts, a motion, a run, its verdict and
its figure.
"""

import rockframe as rf

system = rf.System(
    rf.FrameEquivalent(width="4 m", height="18 m", mass="99 t", shape_factor=2.92),
    rf.TwoSpringSupport(frequency_ratio=40, damping_ratio=0.10),
    rf.CushionCap(height="0.9 m", mass="36 t"),
    rf.WinklerSoil(stiffness="9 MPa", damping_ratio=0.20),
)
motion = rf.GroundMotion.stochastic(7.5, "5 km", seed=8, stress_drop="20 MPa")
response = system.simulate(motion, free_vibration="10 s")
print(response.attrs["verdict"])
rf.plot.response(response)
