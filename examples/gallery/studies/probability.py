"""
What matters when little is known
=================================

Width, height and the strength of the earthquake are uncertain. How probable is it that a cabinet
overturns, and which of them matters most?
"""

import rockframe as rf

cabinet = rf.System(rf.Block(width="0.5 m", height="2 m", mass="400 kg"))
suite = {
    f"seed {k}": rf.GroundMotion.stochastic(7.0, "5 km", seed=k, stress_drop="20 MPa")
    for k in range(8)
}
drawn = rf.probability_of_overturning(
    cabinet,
    suite,
    spread={
        "width": ("normal", "0.5 m", "0.03 m"),
        "height": ("uniform", "1.8 m", "2.2 m"),
        "scale": ("lognormal", 1.5, 0.4),
    },
    cases=600,
    free_vibration="4 s",
    progress=False,
)
print(drawn.verdict)
rf.plot.probability(drawn)
