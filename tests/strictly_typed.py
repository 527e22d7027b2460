# pyright: strict
"""A script of a user who checks types strictly: pyright reads it, nothing runs it."""

from typing import assert_type

import rockframe as rf

block = rf.Block(width="2 m", height=(8.0, "m"), mass="4 t")
wider = block.replace(width=1.5 * block.width)
height: float = block.height.magnitude
statue = rf.Block.from_outline(
    [(-0.2, 0.0), (0.2, 0.0), (0.1, 1.8), (-0.1, 1.8)], unit="m", mass="400 kg"
)
drum = rf.Block.cylinder(diameter="1 m", height="2 m", density="2.6 t/m^3")
assert_type([statue, drum], list[rf.Block])
pads = rf.TwoSpringSupport(frequency_ratio=40, damping_ratio=0.10)
system = rf.System(wider, pads, gravity="9.81 m/s^2")
motion = rf.GroundMotion.sine_pulse("4 m/s^2", "1 Hz").scaled(2.0)
record = rf.GroundMotion.from_arrays(([0.0, 1.0, 0.0], "m/s^2"), time_step="0.1 s")
assert_type(record, rf.GroundMotion)
longest: float = motion.duration.magnitude
target = rf.TargetSpectrum.eurocode_8("0.3 g_0", "B").scaled(2.0)
response = system.simulate(motion, free_vibration="2 s")
runs = rf.sweep(system, motion, scale=[0.5, 1.0])
print(record, height, longest, target, response, runs)
