"""
An anchored block that falls
============================

Makris and Zhang found that anchors which break may overturn a block that would remain standing
without them. The block has p = 2.14 rad/s and theta = 0.349; the pulse is one sine of six times p
that starts as the block uplifts. Without anchors the block withstands pulses of up to 3.6 g.
Anchored at both corners with a strength of its own weight, which is reached at a tenth of theta, it
overturns at 1 g: the anchors break, and the block rocks back at the wrong instant. Beyond theta it
may come back while the pulse lasts; it has overturned if it is beyond theta long after the pulse.
"""

import math
import warnings

import matplotlib.pyplot as plt
import numpy as np

import rockframe as rf

theta, p, gravity = 0.349, 2.14, 9.81
radius = 0.75 * gravity / p**2
half_width, half_height = radius * math.sin(theta), radius * math.cos(theta)
mass = 1000.0
block = rf.Block(width=f"{2 * half_width} m", height=f"{2 * half_height} m", mass=f"{mass} kg")

strength = mass * gravity
stretch = 4.0 * half_width * math.sin(0.05 * theta)  # of a corner at a tenth of theta
anchors = [
    rf.Restrainer(
        on=(f"{x} m", "0 m"), to=(f"{x} m", "0 m"), stiffness=f"{strength / stretch} N/m",
        strength=f"{strength} N", name=name,
    )
    for name, x in (("left", -half_width), ("right", half_width))
]  # fmt: skip

free = rf.System(block, gravity=f"{gravity} m/s^2")
anchored = rf.System(block, *anchors, gravity=f"{gravity} m/s^2")
circular = 6.0 * p


def sine(amplitude):
    """Return one sine of an amplitude in g, which starts as the block uplifts."""
    phase = math.asin(math.tan(theta) / amplitude)
    time = np.linspace(0.0, (2.0 * math.pi - phase) / circular, 401)
    acceleration = amplitude * gravity * np.sin(circular * time + phase)
    return rf.GroundMotion.from_arrays((acceleration, "m/s^2"), time_step=f"{time[1]} s")


def run_of(system, amplitude):
    """Run a system under the sine."""
    with warnings.catch_warnings():  # of a corner that pulls far beyond theta, of swings at the end
        warnings.simplefilter("ignore")
        return system.simulate(sine(amplitude), free_vibration="2 s", overturning="continue")


amplitudes = [0.9, 1.0, 1.04, 1.1, 2.0, 3.0, 3.6, 3.7, 4.0]
fallen = {
    name: [abs(float(run_of(system, one).rotation[-1])) > theta for one in amplitudes]
    for name, system in (("free", free), ("anchored", anchored))
}
for name, each in fallen.items():
    listed = ", ".join(f"{a:g} g" for a, one in zip(amplitudes, each, strict=True) if one)
    print(f"{name}: falls at {listed}")

figure, (left, right) = plt.subplots(1, 2, figsize=(9.0, 3.4), layout="constrained")
for name, system, colour in (("free", free, "tab:blue"), ("anchored", anchored, "tab:red")):
    run = run_of(system, 1.02)
    left.plot(run.time, run.rotation / theta, color=colour, label=name)
    level = 1.0 if name == "anchored" else 0.0
    for amplitude, one in zip(amplitudes, fallen[name], strict=True):
        right.plot(amplitude, level, "X" if one else "o", color=colour, markersize=8)
left.axhline(0.0, color="grey", linewidth=0.5)
left.set(
    xlim=(0.0, 3.0),
    ylim=(-1.1, 1.1),
    xlabel="time [s]",
    ylabel="rotation over theta",
    title="under a sine of 1.02 g",
)
left.legend()
right.set(
    xlabel="amplitude of the sine [g]", yticks=[0.0, 1.0], yticklabels=["free", "anchored"],
    ylim=(-0.7, 1.7), title="stands (o) or falls (x)",
)  # fmt: skip
