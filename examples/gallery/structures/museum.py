"""
Contents of a museum
====================

A marble statue by its outline, a vase on a plinth and a tall showcase, on the second floor of a
museum, under earthquakes of increasing strength. A low centre of mass helps more than a wide base.
"""

import matplotlib.pyplot as plt
import numpy as np

import rockframe as rf

objects = {
    "statue": rf.Block.from_outline(
        [
            (0.0, 0.0), (0.8, 0.0), (0.8, 0.35), (0.66, 0.45), (0.62, 1.1), (0.7, 1.45),
            (0.58, 1.62), (0.56, 2.1), (0.32, 2.1), (0.3, 1.62), (0.2, 1.4), (0.22, 0.5),
            (0.0, 0.35),
        ],
        unit="m", density="2700 kg/m^3", depth="0.25 m",
    ),
    "vase on its plinth": rf.Block.from_parts(
        {
            "plinth": {"width": "0.35 m", "height": "1.0 m", "mass": "45 kg"},
            "vase": {"width": "0.25 m", "height": "0.5 m", "mass": "12 kg", "at": ("0 m", "1 m")},
        }
    ),
    "the same, sand in the plinth": rf.Block.from_parts(
        {
            "plinth": {"width": "0.35 m", "height": "1.0 m", "mass": "45 kg"},
            "sand": {"width": "0.30 m", "height": "0.25 m", "mass": "40 kg"},
            "vase": {"width": "0.25 m", "height": "0.5 m", "mass": "12 kg", "at": ("0 m", "1 m")},
        }
    ),
    "showcase": rf.Block(width="0.45 m", height="2.0 m", mass="180 kg"),
}  # fmt: skip
floors = {
    f"seed {seed}": rf.GroundMotion.stochastic(6.8, "12 km", seed=seed).through_storeys(
        storeys=3, floor=2, period="0.35 s"
    )
    for seed in range(6)
}
figure, axes = plt.subplots(figsize=(7.0, 3.2), layout="constrained")
for place, (name, block) in enumerate(objects.items()):
    analysis = rf.incremental_dynamic_analysis(
        rf.System(block), floors, scale=np.geomspace(0.2, 16.0, 16), intensity="PGA",
        free_vibration="3 s", accuracy="fast", progress=False,
    )  # fmt: skip
    peaks = [float(floor.peak_acceleration.m_as("g_0")) for floor in floors.values()]
    least = peaks * analysis.capacity_scale.sel(limit_state="overturning")
    axes.plot(least, np.full(least.size, place), "o", color="#0072b2", alpha=0.6)
    axes.plot(least.median(), place, "|", ms=22, mew=2.5, color="#d55e00")
    print(f"{name:<30} falls at a peak of {float(least.median()):.2f} g on its floor (median)")
axes.set_yticks(range(len(objects)), objects)
axes.set(xlabel="peak floor acceleration that overturns [g]; bar: median", xscale="log")
ticks = [0.3, 0.5, 1.0, 2.0, 3.0]
axes.set_xticks(ticks, [f"{tick:g}" for tick in ticks])
axes.tick_params(axis="x", which="minor", labelbottom=False)
axes.set_ylim(len(objects) - 0.5, -0.5)
plt.show()
