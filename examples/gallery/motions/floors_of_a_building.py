"""
On the floors of a building
===========================

Spectra of one earthquake on the ground and on the floors of six storeys: a building amplifies the
motion at its own periods (:doc:`/theory/floor_motion`).
"""

import matplotlib.pyplot as plt
import numpy as np

import rockframe as rf

ground = rf.GroundMotion.stochastic(7.2, "5 km", seed=3)
periods = (np.geomspace(0.05, 4.0, 80), "s")
figure, axes = plt.subplots(figsize=(6.6, 4.0), layout="constrained")
for floor in (0, 2, 4, 6):
    motion = ground.through_storeys(storeys=6, floor=floor, period="0.9 s") if floor else ground
    spectrum = rf.response_spectrum(motion, periods).squeeze()
    axes.semilogx(
        spectrum.period,
        spectrum.pseudo_spectral_acceleration / 9.80665,
        color=plt.cm.viridis(0.15 * floor),
        label=f"floor {floor}" if floor else "ground",
    )
    print(f"floor {floor}: peak {motion.peak_acceleration.m_as('g_0'):.2f} g")
ticks = [0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 4.0]
axes.set_xticks(ticks, [f"{tick:g}" for tick in ticks])
axes.set(xlabel="period [s]", ylabel="spectral acceleration [g], damping 5 %")
axes.legend(frameon=False)
plt.show()
