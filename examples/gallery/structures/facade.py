"""
A façade that has come loose
============================

A masonry wall, 0.6 m thick, has separated from the walls behind it and stands by its weight alone.
The figure shows the least pulse that overturns it, over the period of the pulse, for several
heights. Taller walls are more slender, and larger.
"""

import matplotlib.pyplot as plt
import numpy as np

import rockframe as rf

periods = np.linspace(0.4, 2.0, 15)
figure, axes = plt.subplots(figsize=(6.6, 4.0), layout="constrained")
for height, marker in zip((4, 7, 10, 13), "osD^", strict=True):
    wall = rf.Block(width="0.6 m", height=f"{height} m", mass=f"{1.1 * height} t")
    found = rf.overturning_map(
        rf.System(wall),
        rf.GroundMotion.sine_pulse,
        amplitude=(np.linspace(0.2, 9.0, 36), "m/s^2"),
        frequency=(1.0 / periods[::-1], "Hz"),
        impacts=1,
        free_vibration="20 s",
        accuracy="fast",
        progress=False,
    )
    least = found.amplitude_above.min("boundary")
    axes.plot(1.0 / found.frequency, least / 9.80665, f"{marker}-", ms=4, label=f"{height} m high")
    print(f"{height:>2} m high: {float(least.min()) / 9.80665:.2f} g in a pulse of 2 s")
axes.set(xlabel="period of the pulse [s]", ylabel="least peak that overturns [g]", ylim=(0.0, None))
axes.legend(frameon=False)
plt.show()
