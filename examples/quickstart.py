"""A six-storey frame on pads, a cap and soil under a strong earthquake.

Usage: python examples/quickstart.py [record] [--component NS] [--folder results]

The record is a file in the format of an agency; of several components in it name one. Without a
record the motion is a sample of a stochastic model of an earthquake of magnitude 7.5 at 5 km.
Prints the verdict, and writes quickstart.nc (all results, labelled) and quickstart.png (rotation,
vertical displacement and contact over time).
"""

import argparse
import sys
from pathlib import Path

import rockframe as rf


def main() -> int:
    """Read the arguments and run; print errors in one line."""
    parser = argparse.ArgumentParser(description=str(__doc__).partition("\n")[0])
    parser.add_argument("record", nargs="?", help="ground-motion file; a synthetic one if none")
    parser.add_argument("--component", help="component of the record, such as NS or 090")
    parser.add_argument("--folder", default=".", help="where the results are written")
    arguments = parser.parse_args()
    if arguments.component and not arguments.record:
        parser.error("--component is one of a record; none is given")
    try:
        folder = Path(arguments.folder)
        folder.mkdir(parents=True, exist_ok=True)  # fails before the run, not after it
        simulate(arguments.record, arguments.component, folder)
    except (rf.errors.RockframeError, OSError) as problem:
        print(f"quickstart: {' '.join(str(problem).split())}", file=sys.stderr)
        return 1
    return 0


def simulate(record: str | None, component: str | None, folder: Path) -> None:
    """Build the scene, simulate it, and show the result."""
    system = rf.System(
        rf.FrameEquivalent(width="4 m", height="18 m", mass="99 t", shape_factor=2.92),
        rf.TwoSpringSupport(frequency_ratio=40, damping_ratio=0.10),
        rf.CushionCap(height="0.9 m", mass="36 t"),
        rf.WinklerSoil(stiffness="9 MPa", damping_ratio=0.20),
    )
    print(system.describe(), end="\n\n")

    if record:
        motion = rf.GroundMotion.read(record, component=component)
    else:
        motion = rf.GroundMotion.stochastic(7.5, "5 km", seed=8, stress_drop="20 MPa")
    print(motion)
    response = system.simulate(motion, free_vibration="10 s")
    print(response.attrs["verdict"])

    response.to_netcdf(folder / "quickstart.nc")
    rf.plot.response(response).figure.savefig(folder / "quickstart.png", dpi=150)
    print(f"Results: {folder / 'quickstart.nc'}, figure: {folder / 'quickstart.png'}")


if __name__ == "__main__":
    sys.exit(main())
