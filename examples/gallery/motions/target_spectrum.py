"""
Motions that fit the spectrum of a code
=======================================

The ten of forty motions whose scaled spectra are closest to Eurocode 8 on average.
"""

import rockframe as rf

suite = rf.MotionSuite(
    {
        f"motion {seed}": rf.GroundMotion.stochastic(6.2 + 0.02 * seed, f"{8 + seed % 7} km", seed)
        for seed in range(40)
    }
)
target = rf.TargetSpectrum.eurocode_8("0.3 g_0", "B")
found = suite.selection_for(target, 10)
print(f"{target.name}: misfit of the set {float(found.set_misfit):.3f}")
rf.plot.selection(found)
