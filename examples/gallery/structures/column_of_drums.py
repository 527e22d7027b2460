"""
A column of drums
=================

A column of five drums of 1 m by 1.2 m, stone on stone with a coefficient of friction of 0.4, under
one sine of 0.6 g and 1.5 Hz. Which joints open, which drums slip, and how far are they from their
places in the end? The lower joints open and the column rocks in pieces. Each drum slips while it
stands on an edge, and the slips remain visible after the earthquake.
"""

import matplotlib.pyplot as plt
import numpy as np

import rockframe as rf

drum = rf.Block.cylinder(diameter="1 m", height="1.2 m", mass="2.4 t")
joint = rf.TwoSpringSupport(frequency_ratio=60, damping_ratio=0.1, friction=0.4)
column = rf.System(rf.Stack(*[drum] * 5, interfaces=[joint] * 4), joint)
pulse = rf.GroundMotion.sine_pulse(amplitude="6 m/s^2", frequency="1.5 Hz")
run = column.simulate(pulse, free_vibration="8 s", accuracy="fast", second_look=False)

joints = np.arange(5, 0, -1)  # from the ground up, as the results' bodies are from the top down
opened = 1e3 * np.sin(abs(run.body_rotation_on_base).max("time").to_numpy())  # of 1 m of width
slipped = 1e3 * run.peak_body_slip.to_numpy()
left = 1e3 * run.body_slip.isel(time=-1).to_numpy()
away = np.cumsum(left[::-1])[::-1]  # of each drum, by its own slip and those below
print(run.attrs["verdict"])
print(
    f"Joint {joints[opened.argmax()]} from the ground opens most, by {opened.max():.0f} mm; drums "
    f"slip by up to {slipped.max():.0f} mm, and are {abs(away).max():.0f} mm off in the end."
)

figure, axes = plt.subplots(1, 3, figsize=(9.0, 4.2), layout="constrained", sharey=True)
for axis, numbers, title in zip(
    axes,
    (opened, slipped, away),
    ("largest opening [mm]", "largest slip [mm]", "left at the end [mm]"),
    strict=True,
):
    axis.barh(joints, numbers, color="tab:brown", height=0.6)
    axis.axvline(0.0, color="0.3", linewidth=0.8)
    axis.set_xlabel(title)
axes[0].set(ylabel="joint, from the ground up", yticks=joints)
plt.show()
