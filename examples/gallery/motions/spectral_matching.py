"""
A motion matched to the spectrum of a code
==========================================

Scaling keeps the peaks and troughs of a spectrum; wavelets added at the right times fill them
(:doc:`/theory/spectral_matching`). The accelerations grow over time as before, and the ground comes
to rest at the same place. The matched periods are grey.
"""

import warnings

import matplotlib.pyplot as plt
import numpy as np

import rockframe as rf

record = rf.GroundMotion.example("loma-prieta").resampled("0.02 s")
target = rf.TargetSpectrum.eurocode_8("0.3 g_0", "B")
with warnings.catch_warnings(record=True) as said:
    warnings.simplefilter("always")
    matched = record.matched(target, periods=("0.2 s", "2 s"))
about = matched.metadata
scaled = record.scaled(about["scale_factor"])
print(matched.history[-1])
print(*(one.message for one in said), sep="\n")

periods = (np.geomspace(0.2, 3.0, 150), "s")
figure, panels = plt.subplot_mosaic(
    [["spectrum", "acceleration"], ["spectrum", "velocity"], ["spectrum", "displacement"]],
    figsize=(9.2, 5.0),
    layout="constrained",
    width_ratios=[1.0, 1.15],
)
for label, motion, colour in (("scaled", scaled, "0.55"), ("matched", matched, "C0")):
    spectrum = rf.response_spectrum(motion, periods).squeeze()
    panels["spectrum"].plot(
        spectrum.period,
        spectrum.pseudo_spectral_acceleration / 9.80665,
        color=colour,
        label=label,
    )
    path = rf.measures.velocity_and_displacement(motion)
    for name, history, unit in (
        ("acceleration", motion.to_dataset().acceleration / 9.80665, "g"),
        ("velocity", 100.0 * path.ground_velocity, "cm/s"),
        ("displacement", 100.0 * path.ground_displacement, "cm"),
    ):
        panels[name].plot(history.time, history, color=colour, linewidth=0.8)
        panels[name].set_ylabel(f"{name} [{unit}]")
wanted = target.at(periods) / 9.80665
panels["spectrum"].plot(periods[0], wanted, color="C3", linewidth=1.8, label="Eurocode 8")
panels["spectrum"].axvspan(0.2, 2.0, color="0.92", zorder=-1)
ticks = [0.2, 0.5, 1.0, 2.0, 3.0]
panels["spectrum"].set(
    xscale="log",
    xlim=(0.2, 3.0),
    ylim=(0.0, None),
    xlabel="period [s]",
    ylabel="pseudo-spectral acceleration [g], damping 5 %",
)
panels["spectrum"].set_xticks(ticks, [f"{tick:g}" for tick in ticks])
panels["spectrum"].minorticks_off()
panels["spectrum"].legend(frameon=False)
panels["displacement"].set_xlabel("time [s]")
figure.align_ylabels([panels[name] for name in ("acceleration", "velocity", "displacement")])
plt.show()
