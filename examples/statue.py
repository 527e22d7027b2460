"""Does a statue overturn: a marble figure with a low, eccentric centre of mass.

Usage: python examples/statue.py [--folder results]

The outline of the figure, 2.1 m high and 0.25 m deep on the average, gives mass, centre of mass
and moment of inertia. Prints the overturning angle to either side and the peak acceleration at
which an earthquake and its mirror image overturn it; writes statue.csv.
"""

import argparse
import math
from pathlib import Path

import rockframe as rf

OUTLINE = [
    (0.0, 0.0), (0.8, 0.0), (0.8, 0.35), (0.66, 0.45), (0.62, 1.1), (0.7, 1.45), (0.58, 1.62),
    (0.56, 2.1), (0.32, 2.1), (0.3, 1.62), (0.2, 1.4), (0.22, 0.5), (0.0, 0.35),
]  # fmt: skip


def main() -> None:
    """Find the peak ground acceleration at which the statue overturns."""
    parser = argparse.ArgumentParser(description=str(__doc__).partition("\n")[0])
    parser.add_argument("--folder", default=".", help="where the results are written")
    folder = Path(parser.parse_args().folder)
    statue = rf.Block.from_outline(OUTLINE, unit="m", density="2700 kg/m^3", depth="0.25 m")
    height, eccentricity = statue.centre_of_mass
    print(
        f"The statue weighs {statue.mass.m_as('kg'):.0f} kg; its centre of mass is "
        f"{height.m_as('cm'):.0f} cm high and {eccentricity.m_as('cm'):+.1f} cm beside the middle "
        "of its base."
    )
    system = rf.System(statue)
    rest = system.equilibrium()
    for side in ("left", "right"):
        angle = rest[f"{side}_overturning_angle"].item()
        print(f"It overturns to the {side} at a tilt of {math.degrees(angle):.1f} degrees.")
    motion = rf.GroundMotion.stochastic(magnitude=7.0, distance="5 km", seed=11)
    found = {
        name: rf.critical_scale(
            system, shaking, largest=8.0, scales=40, intensity="peak_ground_acceleration"
        )
        for name, shaking in (("this way", motion), ("the other way round", motion.scaled(-1.0)))
    }
    rf.table(list(found.values())).to_csv(folder / "statue.csv")
    peaks = {name: each.peak_ground_acceleration.item() / 9.80665 for name, each in found.items()}
    name = min(peaks, key=lambda way: peaks[way])
    print(
        "In an earthquake like this one the statue stands up to a peak ground acceleration of "
        f"{peaks[name]:.2f} g, whichever way it faces, if its base does not slide."
    )


if __name__ == "__main__":
    main()
