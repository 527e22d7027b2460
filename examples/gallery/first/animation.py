"""
A rocking cabinet, moving
=========================

``rf.plot.player`` makes a page that plays a run: the cabinet to scale, above the histories of its
rotation and of the ground acceleration. The browser draws the page from the numbers; it is some 15
kB large.
"""

import rockframe as rf

cabinet = rf.Block(width="0.5 m", height="1.8 m", mass="200 kg")
pulse = rf.GroundMotion.sine_pulse("3.4 m/s^2", "1.2 Hz")
run = rf.System(cabinet).simulate(pulse, free_vibration="2 s")
print(run.attrs["verdict"])

# %%
# Press "Play", or move the pointer over the histories; a notebook shows the same.
# ``run.rockframe.player("cabinet.html")`` writes it into a file, and
# ``rf.plot.animation(run).save("cabinet.gif")`` makes a film of pictures.

rf.plot.player(run)

# %%
# At its largest rotation the cabinet stands as far over as

largest = float(abs(run.rotation).idxmax("time"))
rf.plot.state(run, time=f"{largest} s")
