"""
Cascade and coupled
===================

Pads on a cap on soil, computed by the coupled equations and in the paper's two stages, Eq. (20), in
which the block has no effect on the soil.
"""

import rockframe as rf

parts = (
    rf.FrameEquivalent(width="4 m", height="18 m", mass="99 t", shape_factor=2.92),
    rf.TwoSpringSupport(frequency_ratio=40, damping_ratio=0.10),
    rf.CushionCap(height="0.9 m", mass="36 t"),
    rf.WinklerSoil(stiffness="9 MPa", damping_ratio=0.20),
)
pulse = rf.GroundMotion.sine_pulse("-3 m/s^2", "0.5 Hz")
runs = {
    coupling: rf.System(*parts, coupling=coupling).simulate(pulse, free_vibration="10 s")
    for coupling in ("coupled", "cascade")
}
for coupling, run in runs.items():
    print(f"{coupling}: {run.attrs['verdict']}")
rf.plot.response(runs, panels=("rotation", "vertical"), rotation="deg", vertical="mm")
