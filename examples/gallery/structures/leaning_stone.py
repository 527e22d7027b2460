"""
A standing stone that leans
===========================

A menhir whose top is beside its foot, on stiff soil, under the same pulse in both directions. It
overturns more easily to the side to which it leans.
"""

import numpy as np

import rockframe as rf

lean = 0.35  # of the top [m]
stone = rf.Block.from_outline(
    [(0.0, 0.0), (0.9, 0.0), (0.8 + lean, 4.2), (0.1 + lean, 4.2)],
    unit="m",
    density="2650 kg/m^3",
    depth="0.7 m",
)
system = rf.System(stone, rf.WinklerSoil(stiffness="60 MPa", damping_ratio=0.1))
rest = system.equilibrium()
print(f"At rest it leans {np.degrees(float(rest.rest_rotation)):.2f} degrees further.")
pulse = rf.GroundMotion.sine_pulse("3 m/s^2", "0.8 Hz")
runs = {
    f"starts to the {side}": system.simulate(motion, free_vibration="5 s")
    for side, motion in (("right", pulse), ("left", pulse.scaled(-1.0)))
}
for name, run in runs.items():
    print(f"{name:<20}{run.attrs['verdict']}")
rf.plot.response(runs, panels=("ground", "rotation"), rotation="deg")
