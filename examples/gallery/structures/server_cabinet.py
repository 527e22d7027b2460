"""
A server cabinet: batteries below or above
==========================================

The same cabinet with its batteries in the lowest and in the highest place, on the roof of a
building.
"""

import rockframe as rf


def cabinet(height_of_batteries: str) -> rf.System:
    """Stand the cabinet on rubber feet."""
    block = rf.Block.from_parts(
        {
            "cabinet": {"width": "0.6 m", "height": "2.0 m", "mass": "120 kg"},
            "batteries": {
                "width": "0.5 m",
                "height": "0.4 m",
                "mass": "180 kg",
                "at": ("0 m", height_of_batteries),
            },
        }
    )
    return rf.System(block, rf.TwoSpringSupport(stiffness="400 kN/m", damping_ratio=0.1))


roof = rf.GroundMotion.stochastic(6.5, "10 km", seed=4).through_storeys(
    storeys=4, floor=4, period="0.4 s"
)
runs = {}
for name, height in (("batteries below", "0.1 m"), ("batteries above", "1.5 m")):
    system = cabinet(height)
    runs[name] = system.simulate(roof.scaled(3.5), free_vibration="3 s")
    least = rf.critical_scale(system, roof, largest=12.0, scales=60).critical_scale
    print(f"{name}: falls at {float(least):.1f} times the motion. 3.5 times the motion:", end=" ")
    print(runs[name].attrs["verdict"])
rf.plot.response(runs, panels=("ground", "rotation"), rotation="deg", acceleration="g_0")
