"""
Figure 21: the record TCU128
============================

Chi-Chi, 1999, component N, from 30 to 60 s: the time history and its spectrum. The text does not
say which component it uses; this one comes first in the databases.
"""

import matplotlib.pyplot as plt
import numpy as np
import worked_example

import rockframe as rf

motion = worked_example.tcu128()
spectrum = rf.response_spectrum(motion, (np.geomspace(0.05, 6.0, 80), "s")).squeeze()
peak = spectrum.pseudo_spectral_acceleration.idxmax("period")
print(f"Peak {motion.peak_acceleration.m_as('g_0'):.3f} g; largest spectral value", end=" ")
print(
    f"{float(spectrum.pseudo_spectral_acceleration.max()) / 9.80665:.2f} g at {float(peak):.2f} s."
)

figure, (history, response) = plt.subplots(2, 1, figsize=(7.0, 5.0), layout="constrained")
acceleration = motion.si.horizontal.samples / 9.80665
history.plot(motion.si.time_step * np.arange(acceleration.size), acceleration, "#1f3a5f", lw=0.7)
history.set(xlabel="time [s]", ylabel="acceleration [g]", xlim=(0.0, 30.0))
response.semilogx(spectrum.period, spectrum.pseudo_spectral_acceleration / 9.80665, "#1f3a5f")
ticks = [0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 5.0]
response.set_xticks(ticks, [f"{tick:g}" for tick in ticks])
response.set(xlabel="period [s], damping 5 %", ylabel="spectral acceleration [g]")
plt.show()
