"""
Which point is held: three rules of restraint
=============================================

On pads the model needs to know which point of the base does not move sideways. The rule hardly
matters for a tall tower, and is seen for a squat block; :doc:`/theory/impact_and_restraint` tells
them apart.
"""

import rockframe as rf

block = rf.Block.from_size(radius="2 m", slenderness=2.5, mass="10 t")
pads = rf.TwoSpringSupport(frequency_ratio=15, damping_ratio=0.10)
pulse = rf.GroundMotion.sine_pulse("4.5 m/s^2", "1.2 Hz")
runs = {
    rule: rf.System(block, pads, restraint=rule).simulate(pulse, free_vibration="4 s")
    for rule in ("contact-state", "leading-corner", "centre")
}
for rule, run in runs.items():
    print(f"{rule:<16} peak {float(run.peak_relative_rotation):.4f} of the overturning angle")
rf.plot.response(runs, panels=("rotation", "vertical", "contact"), rotation="deg")
