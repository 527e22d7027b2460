"""
A statue on its plinth
======================

A statue of marble, 1.8 m high, stands on a plinth of stone that is 0.2 m wider on either side. Does
the surface between them matter? The coefficient of friction is 0.6 on rough stone, 0.3 on polished
stone, and 0.2 on a sheet; the motion is one sine of 1.5 Hz of increasing strength. From rest a
block slides if the friction is less than its width over its height, here 0.28. With more friction
it rocks, and with slightly more it rocks and slides. The statue is lost if it overturns or slides
off. Polished stone does not help, since a rocking statue keeps its corner nearly at the same place;
on a sheet the statue slides.
"""

import matplotlib.pyplot as plt
import numpy as np

import rockframe as rf

statue = rf.Block(width="0.5 m", height="1.8 m", mass="900 kg")
plinth = rf.Block(width="0.9 m", height="1 m", mass="2200 kg")
free = 0.2  # from the statue to the edge of the plinth [m]
floor = rf.RigidGround(friction=0.6)
beds = {"rough stone": 0.6, "polished stone": 0.3, "a sheet": 0.2}
pulse = rf.GroundMotion.sine_pulse(amplitude="1 m/s^2", frequency="1.5 Hz")
peaks = np.arange(1.5, 6.6, 0.5)
theta = statue.overturning_angle.m_as("rad")

figure, (rotation, slip) = plt.subplots(1, 2, figsize=(9.0, 3.6), layout="constrained")
for name, friction in beds.items():
    bed = rf.RigidGround(friction=friction)
    scene = rf.System(rf.Stack(statue, plinth, interfaces=[bed]), floor)
    runs = [
        scene.simulate(pulse.scaled(peak), free_vibration="2 s", accuracy="fast") for peak in peaks
    ]
    fallen = np.array([bool(run.overturned) for run in runs])
    share = np.array([float(run.peak_rotation) / theta for run in runs])
    slid = np.array([float(run.peak_body_slip[0]) for run in runs])
    (line,) = rotation.plot(peaks[~fallen], share[~fallen], "o-", label=f"on {name}")
    slip.plot(peaks[~fallen], slid[~fallen], "o-", color=line.get_color())
    rotation.plot(peaks[fallen], share[fallen], "x", color=line.get_color())
    last = np.flatnonzero(~fallen & (slid < free))[-1]
    print(
        f"On {name} the statue stays on its plinth up to {peaks[last]:g} m/s²: it rocks by "
        f"{share[last]:.2f} theta there and slides by {1e3 * slid[last]:.0f} mm."
    )
slip.axhline(free, color="0.6", linewidth=1)
slip.annotate("edge of the plinth", (peaks[0], free), (2, 3), textcoords="offset points")
rotation.set(
    xlabel="peak of the ground [m/s²]", ylabel="peak rotation of the statue over theta",
    ylim=(0.0, 1.5),
)  # fmt: skip
slip.set(xlabel="peak of the ground [m/s²]", ylabel="slip on the plinth [m]", ylim=(-0.01, 0.23))
rotation.plot([], [], "kx", label="falls")
rotation.legend(frameon=False, loc="upper left", fontsize=9)
plt.show()
