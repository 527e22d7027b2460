"""
A statue on its plinth
======================

A statue of marble, 1.8 m high, may stand on the floor or on a plinth of 1 m. Does the plinth help
or harm, and where does anything slide? Statue and plinth on thin joints with a friction of 0.5,
under one sine of 1.5 Hz that grows; and the same plinth on a sheet with a friction of 0.15, less
than the statue's width over its height, so that the plinth slides before the statue lifts.
"""

import matplotlib.pyplot as plt
import numpy as np

import rockframe as rf

statue = rf.Block(width="0.5 m", height="1.8 m", mass="900 kg")
plinth = rf.Block(width="0.9 m", height="1 m", mass="2200 kg")
joint = rf.TwoSpringSupport(frequency_ratio=25, damping_ratio=0.1, friction=0.5)
sheet = joint.replace(friction=0.15)
raised = rf.Stack(statue, plinth, interfaces=[joint])
scenes = {
    "on the floor": rf.System(statue, joint),
    "on a plinth": rf.System(raised, joint),
    "on a plinth that slides": rf.System(raised, sheet),
}
pulse = rf.GroundMotion.sine_pulse(amplitude="1 m/s^2", frequency="1.5 Hz")
peaks = np.arange(1.5, 6.1, 0.25)
theta = statue.overturning_angle.m_as("rad")

figure, (rotation, slip) = plt.subplots(1, 2, figsize=(9.0, 3.6), layout="constrained")
for name, scene in scenes.items():
    runs = [
        scene.simulate(pulse.scaled(peak), free_vibration="2 s", accuracy="fast") for peak in peaks
    ]
    fallen = np.array([bool(run.overturned) for run in runs])
    share = np.array([float(run.peak_rotation) / theta for run in runs])
    lowest = [float(np.atleast_1d(run.get("peak_body_slip", run.peak_slip))[-1]) for run in runs]
    (line,) = rotation.plot(peaks[~fallen], share[~fallen], "o-", label=name)
    slip.plot(peaks[~fallen], np.array(lowest)[~fallen], "o-", color=line.get_color())
    if fallen.any():
        rotation.plot(peaks[fallen], share[fallen], "x", color=line.get_color())
    there = peaks == 3.0
    print(
        f"{name} it stands up to {peaks[~fallen].max():g} m/s². At 3 m/s² it rocks by "
        f"{share[there][0]:.2f} theta; what stands on the floor slides by "
        f"{1e3 * lowest[there.argmax()]:.0f} mm."
    )
rotation.set(
    xlabel="peak of the ground [m/s²]", ylabel="peak rotation of the statue over theta",
    ylim=(0.0, 1.5),
)  # fmt: skip
slip.set(xlabel="peak of the ground [m/s²]", ylabel="slip on the floor [m]")
rotation.legend(frameon=False, loc="upper left", fontsize=9)
plt.show()
