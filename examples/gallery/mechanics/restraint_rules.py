"""
Which point is held: three rules of restraint
=============================================

On pads one point of the base is held horizontally, and a rule chooses it. The rule hardly matters
for a tall tower; its effect on a squat block is visible. The rules are described in
:doc:`/theory/impact_and_restraint`.
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
