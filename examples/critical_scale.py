"""How much of an earthquake it takes to overturn a tower on pads.

Usage: python examples/critical_scale.py [record] [--largest 4] [--folder results]

The record is a file in the format of an agency. Without one the motion is a sample of a
stochastic model of an earthquake of magnitude 7.2 at 5 km. Prints the least scale at which the
tower overturns, the scales above it at which the verdict changes again, and the spectral
acceleration at the critical scale, and writes critical_scale.nc (all scales tried and all changes
of the verdict, labelled).
"""

import argparse
import sys
from pathlib import Path

import rockframe as rf


def main() -> int:
    """Read the arguments and search; print errors in one line."""
    parser = argparse.ArgumentParser(description=str(__doc__).partition("\n")[0])
    parser.add_argument("record", nargs="?", help="ground-motion file; a synthetic one if none")
    parser.add_argument("--largest", type=float, default=4.0, help="largest scale of the motion")
    parser.add_argument("--folder", default=".", help="where the result is written")
    arguments = parser.parse_args()
    try:
        folder = Path(arguments.folder)
        folder.mkdir(parents=True, exist_ok=True)
        search(arguments.record, arguments.largest, folder)
    except (rf.errors.RockframeError, OSError) as problem:
        print(f"critical_scale: {' '.join(str(problem).split())}", file=sys.stderr)
        return 1
    return 0


def search(record: str | None, largest: float, folder: Path) -> None:
    """Build the tower, find its critical scale, and print the result."""
    tower = rf.System(
        rf.Block(width="1.2 m", height="6 m", mass="20 t"),
        rf.TwoSpringSupport(frequency_ratio=20, damping_ratio=0.10),
    )
    if record:
        motion = rf.GroundMotion.read(record)
    else:
        motion = rf.GroundMotion.stochastic(7.2, "5 km", seed=0, stress_drop="20 MPa")
    print(motion)
    found = rf.critical_scale(
        tower,
        motion,
        largest=largest,
        free_vibration="10 s",
        intensity="pseudo_spectral_acceleration",
        period="1 s",
    )
    print(found.attrs["verdict"])
    if found.critical_scale.notnull():
        acceleration = float(found.pseudo_spectral_acceleration)
        print(f"At that scale the spectral acceleration at 1 s is {acceleration:.3g} m/s^2.")
    flips = ["scale_below", "scale_above", "overturns_above"]
    print(found[flips].to_dataframe()[flips].to_string())

    found.to_netcdf(folder / "critical_scale.nc")
    print(f"Result: {folder / 'critical_scale.nc'}")


if __name__ == "__main__":
    sys.exit(main())
