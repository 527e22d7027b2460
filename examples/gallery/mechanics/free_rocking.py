"""
Free rocking, and Housner's closed form
=======================================

A block is released from half its overturning angle. Each impact reduces its speed by the same
factor; for small rotations the peaks have a closed form (Housner 1963,
:doc:`/theory/rigid_ground`).
"""

import matplotlib.pyplot as plt
import numpy as np

import rockframe as rf

block = rf.Block.from_size(radius="1 m", slenderness=1.0 / np.tan(0.2), mass="1 t")
theta = block.overturning_angle.m_as("rad")
run = rf.System(block, rotation="small").simulate(
    duration="6 s", initial=rf.InitialState(rotation=f"{0.5 * theta} rad"), output_step="0.005 s"
)

restitution = 1.0 - 1.5 * np.sin(theta) ** 2
number = np.arange(7)
closed_form = 1.0 - np.sqrt(1.0 - restitution ** (2 * number) * (1.0 - 0.5**2))
share = run.rotation.to_numpy() / theta
crossings = np.flatnonzero(np.diff(np.sign(share)))
peaks = [np.abs(part).max() for part in np.split(share, crossings + 1)][: number.size]
print("peak   closed form   computed")
for which, (expected, found) in enumerate(zip(closed_form, peaks, strict=True)):
    print(f"{which:<6} {expected:.4f}        {found:.4f}")

figure, axes = plt.subplots(figsize=(7.0, 3.4), layout="constrained")
axes.plot(run.time, share, color="#0072b2")
for sign in (1, -1):
    axes.plot(run.time[[0, -1]], [0.0, 0.0], color="0.7", lw=0.6)
    for which, level in zip(number, closed_form, strict=True):
        if sign == (-1) ** which:
            axes.axhline(sign * level, color="#d55e00", lw=0.7, ls="--")
axes.set(xlabel="time [s]", ylabel=r"$\alpha/\theta$", xlim=(0.0, 6.0))
plt.show()
