"""
On sloping ground
=================

A block on pads, on level ground and on ground that rises by two and four degrees to the right,
under the same pulse. The steeper the ground is, the smaller is the overturning angle downhill.
"""

import rockframe as rf

block = rf.Block(width="1 m", height="4 m", mass="8 t")
pads = rf.TwoSpringSupport(frequency_ratio=25, damping_ratio=0.10)
pulse = rf.GroundMotion.sine_pulse("2.2 m/s^2", "1 Hz")
runs = {
    f"slope of {slope} deg": rf.System(block, pads, inclination=f"{slope} deg").simulate(
        pulse, free_vibration="4 s"
    )
    for slope in (0, 2, 4)
}
for name, run in runs.items():
    print(f"{name:<16}{run.attrs['verdict']}")
rf.plot.response(runs, panels=("rotation", "contact"), rotation="deg")
