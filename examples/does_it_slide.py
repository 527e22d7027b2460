"""Does it slide before it rocks: friction, reactions and accelerations of a display case.

Usage: python examples/does_it_slide.py [--folder results]

A case of 0.6 m by 1.8 m stands on a stone floor with a coefficient of friction of 0.4, under a
synthetic earthquake. Prints the friction that rocking needs, the friction demand of the run and its
duration, and the peak acceleration of the upper shelf; writes does_it_slide.csv.
"""

import argparse
import warnings
from pathlib import Path

import numpy as np

import rockframe as rf


def main() -> None:
    """Simulate the case, and print friction and accelerations."""
    parser = argparse.ArgumentParser(description=str(__doc__).partition("\n")[0])
    parser.add_argument("--folder", default=".", help="where the results are written")
    folder = Path(parser.parse_args().folder)
    case = rf.Block(width="0.6 m", height="1.8 m", mass="180 kg")
    floor = rf.RigidGround(friction=0.4)
    motion = rf.GroundMotion.stochastic(magnitude=6.8, distance="8 km", seed=3)
    system = rf.System(case, floor, sliding="checked")
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        response = system.simulate(
            motion.scaled(3.5), free_vibration="5 s",
            outputs=("acceleration", "reaction", "friction_demand"),
            points={"upper shelf": ("0 m", "1.5 m")},
        )  # fmt: skip
    print(response.attrs["verdict"])
    print(f"Rocking needs a friction of {1.0 / case.slenderness:.2f} at least.")
    for warning in caught:
        print(f"Warning: {warning.message}.")
    shelf = response.sel(point="upper shelf")
    peak = float(np.abs(shelf.point_horizontal_acceleration).max()) / 9.80665
    ground = float(np.abs(response.ground_acceleration).max()) / 9.80665
    print(f"Peak acceleration: upper shelf {peak:.2f} g, floor {ground:.2f} g.")
    columns = ["rotation", "horizontal_reaction", "vertical_reaction", "friction_demand"]
    response[columns].to_dataframe().to_csv(folder / "does_it_slide.csv")


if __name__ == "__main__":
    main()
