"""
A tower on two pads, from the soft to the stiff
===============================================

The same tower under the same pulse. The stiffer the pads are, the closer the response is to that of
a block on rigid ground (Housner).
"""

import rockframe as rf

block = rf.Block(width="4.85 m", height="19.4 m", mass="600 t")
pulse = rf.GroundMotion.sine_pulse("-9.81 m/s^2", "1 Hz")
runs = {
    f"pads, beta = {ratio}": rf.System(
        block, rf.TwoSpringSupport(frequency_ratio=ratio, damping_ratio=0.10)
    ).simulate(pulse, free_vibration="5 s")
    for ratio in (20, 40, 100)
}
runs["rigid ground"] = rf.System(block).simulate(pulse, free_vibration="5 s")
for name, run in runs.items():
    print(f"{name:<18}{run.attrs['verdict']}")
rf.plot.response(runs, panels=("rotation", "contact"), rotation="deg")
