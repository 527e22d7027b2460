"""
A rocking cabinet, moving
=========================

``rf.plot.animation`` moves the block to scale above the trace of its rotation. In a notebook it is
a player; here a GIF and one instant.
"""

import rockframe as rf

cabinet = rf.Block(width="0.5 m", height="1.8 m", mass="200 kg")
pulse = rf.GroundMotion.sine_pulse("3.4 m/s^2", "1.2 Hz")
run = rf.System(cabinet).simulate(pulse, free_vibration="2 s")
print(run.attrs["verdict"])

# %%
# ``rf.plot.animation(run).save("cabinet.gif")`` writes the file; at its largest rotation it shows

largest = float(abs(run.rotation).idxmax("time"))
rf.plot.state(run, time=f"{largest} s")
