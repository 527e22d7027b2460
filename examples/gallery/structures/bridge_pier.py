"""
A bridge pier that may rock
===========================

A pier with its share of the deck, which may lift off the ground, under a near-fault pulse of
increasing strength. Rocking limits the forces in the pier: once it lifts off, its base shear
increases more slowly than the ground acceleration.
"""

import matplotlib.pyplot as plt
import numpy as np

import rockframe as rf

pier = rf.Block.from_parts(
    {
        "footing": {"width": "6 m", "height": "1.5 m", "mass": "110 t"},
        "column": {"width": "1.8 m", "height": "9 m", "mass": "60 t", "at": ("0 m", "1.5 m")},
        "deck": {"width": "5.6 m", "height": "1.8 m", "mass": "300 t", "at": ("0 m", "10.5 m")},
    }
)
print(
    f"{pier.mass.m_as('t'):.0f} t, overturning angle {pier.overturning_angle.m_as('deg'):.1f} deg"
)
bases = {
    "rigid ground": rf.RigidGround(),
    "soil, 60 MPa": rf.WinklerSoil(stiffness="60 MPa", damping_ratio=0.15),
}
peaks = np.linspace(1.0, 8.0, 15)
figure, (rotation, shear) = plt.subplots(1, 2, figsize=(8.6, 3.6), layout="constrained")
for name, base in bases.items():
    system = rf.System(pier, base)
    runs = [
        system.simulate(
            rf.GroundMotion.type_a_pulse("1 m/s", "1.5 s").scaled(peak=f"{peak} m/s^2"),
            free_vibration="10 s",
            outputs=("base_shear",),
        )
        for peak in peaks
    ]
    rotation.plot(peaks, [np.degrees(float(run.peak_rotation)) for run in runs], "o-", label=name)
    shear.plot(peaks, [float(abs(run.base_shear).max()) / 1e6 for run in runs], "o-", label=name)
shear.plot(
    peaks, pier.mass.m_as("t") / 1e3 * peaks, ":", color="0.4", label="mass times acceleration"
)
rotation.set(xlabel="peak of the ground [m/s²]", ylabel="peak rotation [deg]")
shear.set(xlabel="peak of the ground [m/s²]", ylabel="base shear [MN]")
shear.legend(frameon=False)
plt.show()
