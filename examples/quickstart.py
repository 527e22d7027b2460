"""A block on two pads under a recorded ground motion, or under the paper's pulse.

Usage: python examples/quickstart.py [record.AT2]

Prints what became of the block, and writes quickstart.nc (all results, labelled)
and quickstart.png (rotation, vertical displacement and contact along time).
"""

import argparse
from pathlib import Path

import rockframe as rf


def main() -> None:
    """Build the scene, simulate it, and show the result."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument(
        "record", nargs="?", help="ground-motion file; the pulse of Eq. (17) if none"
    )
    parser.add_argument("--folder", default=".", help="where the results are written")
    arguments = parser.parse_args()

    block = rf.Block(width="4.85 m", height="19.4 m", mass="600 t")
    pads = rf.TwoSpringSupport(frequency_ratio=20, damping_ratio=0.10)
    system = rf.System(block, pads)
    print(system.describe(), end="\n\n")

    if arguments.record:
        motion = rf.GroundMotion.read(arguments.record)
    else:
        motion = rf.GroundMotion.sine_pulse()  # 1 g, 1 Hz
    print(motion)
    response = system.simulate(motion, free_vibration="5 s")
    print(response.attrs["verdict"])

    folder = Path(arguments.folder)
    response.to_netcdf(folder / "quickstart.nc")
    rf.plot.response(response).savefig(folder / "quickstart.png", dpi=150)
    print(f"Results: {folder / 'quickstart.nc'}, figure: {folder / 'quickstart.png'}")


if __name__ == "__main__":
    main()
