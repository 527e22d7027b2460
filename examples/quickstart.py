"""A six-storey frame on pads, a cap and soil under a strong earthquake.

Usage: python examples/quickstart.py [record] [--folder results]

The record is a file as agencies give it out; without one the motion is drawn from a model
of an earthquake of magnitude 6.8 at 5 km. Prints what became of the frame, and writes
quickstart.nc (all results, labelled) and quickstart.png (rotation, vertical displacement
and contact along time).
"""

import argparse
from pathlib import Path

import rockframe as rf


def main() -> None:
    """Build the scene, simulate it, and show the result."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("record", nargs="?", help="ground-motion file; a synthetic one if none")
    parser.add_argument("--folder", default=".", help="where the results are written")
    arguments = parser.parse_args()

    system = rf.System(
        rf.FrameEquivalent(width="4 m", height="18 m", mass="99 t", shape_factor=2.92),
        rf.TwoSpringSupport(frequency_ratio=40, damping_ratio=0.10),
        rf.CushionCap(height="0.9 m", mass="36 t"),
        rf.WinklerSoil(stiffness="9 MPa", damping_ratio=0.20),
    )
    print(system.describe(), end="\n\n")

    if arguments.record:
        motion = rf.GroundMotion.read(arguments.record)
    else:
        motion = rf.GroundMotion.stochastic(6.8, "5 km", seed=29, stress_drop="20 MPa")
    print(motion)
    response = system.simulate(motion, free_vibration="10 s")
    print(response.attrs["verdict"])

    folder = Path(arguments.folder)
    response.to_netcdf(folder / "quickstart.nc")
    rf.plot.response(response).savefig(folder / "quickstart.png", dpi=150)
    print(f"Results: {folder / 'quickstart.nc'}, figure: {folder / 'quickstart.png'}")


if __name__ == "__main__":
    main()
