"""How to load a cabinet: the same contents in its base, or on its upper shelf.

Usage: python examples/cabinet.py [--folder results]

An unanchored cabinet, 0.45 m deep and 1.9 m high, holds 120 kg on an upper floor.
Prints the peak floor acceleration at which it overturns, loaded low and loaded high; writes
cabinet.csv.
"""

import argparse
import math
from pathlib import Path

import rockframe as rf


def cabinet(height_of_load: str) -> rf.Block:
    """Return the cabinet with its load at a height."""
    return rf.Block.from_parts(
        {
            "case": {"width": "0.45 m", "height": "1.9 m", "mass": "60 kg"},
            "load": {
                "width": "0.35 m",
                "height": "0.3 m",
                "mass": "120 kg",
                "at": ("0.03 m", height_of_load),
            },
        }
    )


def main() -> None:
    """Compare the cabinet with its load low and high."""
    parser = argparse.ArgumentParser(description=str(__doc__).partition("\n")[0])
    parser.add_argument("--folder", default=".", help="where the results are written")
    folder = Path(parser.parse_args().folder)
    motion = rf.GroundMotion.stochastic(magnitude=6.5, distance="10 km", seed=4)
    floor = motion.through_storeys(periods=["0.4 s"], damping_ratio=0.05)
    runs, peaks = [], {}
    for name, height in (("low", "0.1 m"), ("high", "1.5 m")):
        system = rf.System(cabinet(height), rf.RigidGround())
        found = rf.critical_scale(
            system, floor, largest=12.0, scales=60, intensity="peak_ground_acceleration"
        )
        runs.append(found)
        peaks[name] = found.peak_ground_acceleration.item() / 9.80665
        rest = system.equilibrium()
        print(
            f"Loaded {name}: overturns at a tilt of "
            f"{math.degrees(rest.overturning_angle):.1f} degrees, or at a floor acceleration "
            f"of {peaks[name]:.2f} g."
        )
    rf.table(runs).to_csv(folder / "cabinet.csv")
    print(
        "With its load at the bottom the cabinet withstands "
        f"{peaks['low'] / peaks['high']:.1f} times the acceleration that overturns it with the "
        "load at the top."
    )


if __name__ == "__main__":
    main()
