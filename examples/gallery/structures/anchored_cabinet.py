"""
A cabinet: does it need anchors?
================================

An electrical cabinet of 400 kg stands on an upper floor, whose motion is one sine of 2 Hz. Does it
need anchors, and how strong must they be? The figure is for brittle anchors at both edges of its
base, of increasing strength, under an increasing motion. Weak anchors break as the cabinet lifts,
and it overturns under the same motion as a free one, or a weaker one. Anchors that hold it must
carry more than its weight.
"""

import matplotlib.pyplot as plt
import numpy as np

import rockframe as rf

cabinet = rf.Block(width="0.6 m", height="2 m", mass="400 kg")
weight = 400.0 * 9.80665
floor = rf.GroundMotion.sine_pulse(amplitude="9.80665 m/s^2", frequency="2 Hz")
levels = np.arange(0.5, 1.35, 0.1)
strengths = np.array([0.25, 0.75, 1.0, 1.25, 1.5, 1.75, 2.0, 2.5])


def anchored(strength):
    """Return the cabinet with anchors of a strength, over its weight."""
    at = {"left": "-0.3 m", "right": "0.3 m"}
    anchors = [
        rf.Restrainer(
            on=(place, "0 m"), to=(place, "0 m"), stiffness="4 MN/m",
            strength=f"{strength * weight} N", name=name,
        )
        for name, place in at.items()
    ]  # fmt: skip
    return rf.System(cabinet, *anchors)


def falls_of(cabinets, **axes):
    """Return whether each cabinet falls, at each level of its floor's motion."""
    runs = rf.sweep(
        cabinets, [floor], scale=levels, free_vibration="2 s", accuracy="fast", progress=False,
        **axes,
    )  # fmt: skip
    return runs.overturned.squeeze()


free = falls_of(rf.System(cabinet)).to_numpy()
falls = falls_of(anchored, strength=strengths).transpose("scale", "strength").to_numpy()
free_stands = levels[~free].max()
needed = strengths[~falls[np.isclose(levels, 1.0)].any(axis=0)].min()
worse = ", ".join(f"{one:g}" for one in strengths[(falls & ~free[:, None]).any(axis=0)])
print(f"Free it stands {free_stands:.1f} g; on a floor of 1 g it needs anchors.")
print(f"They hold from {needed:g} times its weight on, {needed * weight / 1e3:.1f} kN each.")
print(f"With anchors of {worse} times its weight it falls where a free one stands.")

figure, axes = plt.subplots(figsize=(6.4, 4.0), layout="constrained")
x, y = np.meshgrid(strengths, levels)
axes.scatter(x[falls], y[falls], marker="X", s=60, color="tab:red", label="falls")
axes.scatter(x[~falls], y[~falls], marker="o", s=45, color="tab:blue", label="stands")
axes.axhline(free_stands + 0.05, color="0.4", linestyle="--", label="a free one falls above")
axes.set(xlabel="strength of each anchor over the weight", ylabel="peak of the floor [g]")
axes.set_ylim(0.4, 1.5)
axes.legend(ncols=3, loc="upper center", frameon=False)
plt.show()
