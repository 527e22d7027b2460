"""
Figure 6: the excitation
========================

Eq. (17), one sine with the amplitude of gravity, from 0 to 1 s. After the pulse the ground is at
rest, at another place: its velocity is zero again, its displacement is not.
"""

import matplotlib.pyplot as plt

import rockframe as rf

pulse = rf.GroundMotion.sine_pulse("-9.81 m/s^2", "1 Hz")
ground = rf.measures.velocity_and_displacement(pulse)
print(f"Peak {pulse.peak_acceleration:.2f~P}, {float(ground.time[-1]):.0f} s;", end=" ")
print(f"the ground ends {float(ground.ground_displacement[-1]):.2f} m from where it was.")

figure, grid = plt.subplots(3, 1, figsize=(6.0, 5.0), sharex=True, layout="constrained")
for axes, name in zip(grid, ("acceleration", "velocity", "displacement"), strict=True):
    column = ground[f"ground_{name}"]
    axes.plot(ground.time, column, color="#1f3a5f")
    axes.set_ylabel(f"{name}\n[{column.units}]")
    axes.axhline(0.0, color="0.8", lw=0.6, zorder=0)
grid[-1].set_xlabel("time [s]")
plt.show()
