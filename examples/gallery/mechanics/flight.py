"""
A squat block that bounces
==========================

A corner that lands hard on a stiff pad bounces, so that for some moments neither corner is in
contact. The paper says that this state should be avoided; rockframe computes it.
"""

import rockframe as rf

block = rf.Block.from_size(radius="5 m", slenderness=2, mass="200 t")
system = rf.System(block, rf.TwoSpringSupport(frequency_ratio=40, damping_ratio=0.05))
run = system.simulate(rf.GroundMotion.sine_pulse("-9.81 m/s^2", "1 Hz"), free_vibration="4 s")
print(run.attrs["verdict"])
print(f"In the air for {float(run.flight_time):.2f} s, the most of the paper's 108 cases.")
rf.plot.response(run, rotation="deg", vertical="mm")
