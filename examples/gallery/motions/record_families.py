"""
Motions of each family
======================

A recorded earthquake at some distance, a near one, a distant large one, a small one at a short
distance, and a pulse, with what each of them means for a block.
"""

import matplotlib.pyplot as plt
import numpy as np

import rockframe as rf

motions = {
    "recorded, magnitude 6.9 at 73 km": rf.GroundMotion.example("loma-prieta"),
    "recorded, magnitude 4.2": rf.GroundMotion.example("waipukurau"),
    "synthetic, 6.8 at 5 km": rf.GroundMotion.stochastic(6.8, "5 km", seed=3),
    "synthetic, 8 at 80 km": rf.GroundMotion.stochastic(8.0, "80 km", seed=3),
    "near-fault pulse, type B": rf.GroundMotion.type_b_pulse("60 cm/s", "1.5 s"),
}
figure, grid = plt.subplots(len(motions), 1, figsize=(7.6, 7.0), layout="constrained")
print(f"{'':34}PGA [g]  PGV [cm/s]  PGV/PGA [s]  duration 5-95 % [s]")
for (name, motion), axes in zip(motions.items(), grid, strict=True):
    measures = rf.intensity_measures(motion)
    acceleration = float(measures.peak_ground_acceleration)
    velocity = float(measures.peak_ground_velocity)
    print(
        f"{name:34}{acceleration / 9.80665:7.3f}{100.0 * velocity:12.1f}"
        f"{velocity / acceleration:13.2f}{float(measures.significant_duration_5_95):21.1f}"
    )
    samples = motion.si.horizontal.samples
    axes.plot(motion.si.time_step * np.arange(samples.size), samples, color="#0072b2", lw=0.6)
    axes.set(ylabel="[m/s²]")
    axes.set_title(name, fontsize="medium", loc="left")
grid[-1].set_xlabel("time [s]")
plt.show()
