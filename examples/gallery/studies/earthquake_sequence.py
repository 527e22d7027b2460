"""
A main shock and its aftershocks
================================

The same three earthquakes in both orders, with five seconds of rest between them. A block on rigid
ground that has come to rest does not depend on earlier earthquakes; the figure shows the largest
rotation so far.
"""

import matplotlib.pyplot as plt

import rockframe as rf

cabinet = rf.System(rf.Block(width="0.5 m", height="2 m", mass="400 kg"))
shock = rf.GroundMotion.stochastic(7.0, "5 km", seed=0, stress_drop="20 MPa")
shares = {"falling": (1.5, 1.3, 1.1), "rising": (1.1, 1.3, 1.5)}
found = rf.earthquake_sequences(
    cabinet,
    {name: [shock.scaled(share) for share in row] for name, row in shares.items()},
    pause="5 s",
)
print(found.verdict)
figure, axes = plt.subplots(figsize=(6.0, 3.4), layout="constrained")
for number, (name, row) in enumerate(shares.items()):
    peaks = found.peak_relative_rotation.isel(sequence=number)
    axes.plot(range(1, 4), peaks, "o-", label=f"{name}: " + ", ".join(map(str, row)))
axes.set(xlabel="earthquake", ylabel="peak rotation so far, of $\\theta$", xticks=(1, 2, 3))
axes.legend(title="times the motion", frameon=False)
plt.show()
