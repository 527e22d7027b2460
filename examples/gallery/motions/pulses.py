"""
Pulses, and what they do to a block
===================================

Five pulses of the same peak velocity, and the response of the same block to each of them.
"""

import matplotlib.pyplot as plt
import numpy as np

import rockframe as rf

given = "80 cm/s", "1.1 s"
pulses = {
    "type A": rf.GroundMotion.type_a_pulse(*given),
    "type B": rf.GroundMotion.type_b_pulse(*given),
    "type C1": rf.GroundMotion.type_c_pulse(*given),
    "Mavroeidis": rf.GroundMotion.mavroeidis_papageorgiou_pulse("80 cm/s", "0.9 Hz", 2, "90 deg"),
    "Ricker": rf.GroundMotion.ricker_wavelet("3 m/s^2", "1.1 s").scaled(peak_velocity="80 cm/s"),
}
system = rf.System(rf.Block(width="0.5 m", height="2.4 m", mass="500 kg"))
figure, grid = plt.subplots(
    2, len(pulses), figsize=(10.0, 4.2), sharex="col", sharey="row", layout="constrained"
)
for (name, pulse), (above, below) in zip(pulses.items(), grid.T, strict=True):
    run = system.simulate(pulse, free_vibration="3 s")
    above.plot(run.time, run.ground_acceleration, color="#009e73", lw=1.0)
    below.plot(
        run.time, np.degrees(run.rotation), color="#d55e00" if run.overturned else "#0072b2", lw=1.0
    )
    above.set_title(name, fontsize="medium")
    below.set_xlabel("time [s]")
    print(f"{name:<12}{run.attrs['verdict']}")
grid[0, 0].set_ylabel("ground [m/s²]")
grid[1, 0].set_ylabel("rotation [deg]")
plt.show()
