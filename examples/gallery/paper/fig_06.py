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

rf.plot.motion(pulse)
plt.show()
