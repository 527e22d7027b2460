"""
Where the energy goes
=====================

Every run computes its energies, and states how well they balance.
"""

import matplotlib.pyplot as plt

import rockframe as rf

system = rf.System(
    rf.Block(width="0.8 m", height="4 m", mass="5 t"),
    rf.TwoSpringSupport(frequency_ratio=25, damping_ratio=0.10),
)
motion = rf.GroundMotion.sine_pulse("2.6 m/s^2", "1.6 Hz")
run = system.simulate(motion, free_vibration="6 s", outputs="energy")
print(f"Out of balance: {float(run.energy_residual):.1e} of the largest energy.")

figure, axes = plt.subplots(figsize=(7.0, 4.0), layout="constrained")
for name in map(str, run.data_vars):
    if name.endswith("_energy") and run[name].dims == ("time",):
        axes.plot(run.time, run[name] / 1e3, lw=1.2, label=name.replace("_", " "))
axes.set(xlabel="time [s]", ylabel="energy [kJ]", xlim=(0.0, float(run.time[-1])))
figure.legend(loc="outside lower center", fontsize="small", ncols=4, frameon=False)
plt.show()
