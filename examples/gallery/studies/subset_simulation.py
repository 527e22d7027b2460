"""
One in several thousand
=========================

The probability that a very safe block overturns: samples come closer to overturning level by level,
and the product of their shares is the probability. Counting would need a million runs.
"""

import rockframe as rf

column = rf.System(rf.Block(width="0.8 m", height="4 m", mass="5 t"))
pulse = rf.GroundMotion.sine_pulse("1.4 m/s^2", "1 Hz")
found = rf.subset_simulation(
    column,
    pulse,
    spread={
        "width": ("normal", "0.8 m", "0.02 m"),
        "height": ("normal", "4 m", "0.05 m"),
        "scale": ("lognormal", 1.0, 0.2),
    },
    free_vibration="5 s",
    cases=400,
    accuracy="fast",
    progress=False,
)
print(found.verdict)
rf.plot.subset_simulation(found)
