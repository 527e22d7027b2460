"""
Rocking in the plane of rotation and rate
=========================================

Free motion from several initial rates. Within the boundary curves spiral to rest, with a jump at
each impact; outside of it the block overturns.
"""

import matplotlib.pyplot as plt
import numpy as np

import rockframe as rf

block = rf.Block(width="0.5 m", height="2 m", mass="400 kg")
theta = block.overturning_angle.m_as("rad")
system = rf.System(block)

figure, axes = plt.subplots(figsize=(6.0, 4.6), layout="constrained")
for rate in np.arange(0.1, 0.9, 0.1):
    run = system.simulate(
        duration="6 s",
        initial=rf.InitialState(angular_velocity=f"{rate} rad/s"),
        output_step="0.002 s",
    )
    colour = "#d55e00" if run.overturned else "#0072b2"
    axes.plot(run.rotation / theta, run.angular_velocity, color=colour, lw=0.9)
axes.axvline(0.0, color="0.7", lw=0.6)
axes.set(xlabel=r"rotation $\alpha/\theta$", ylabel="rate [rad/s]", xlim=(-1.05, 1.05))
plt.show()
