"""A tower on pads of several dampings, under a motion at several scales, in one table.

Usage: python examples/study_to_csv.py [--folder results]

Prints which of the runs overturned, and writes study.csv (a row for each run, with units in
the heads of the columns) and study.nc (the same, labelled).
"""

import argparse
from pathlib import Path

import rockframe as rf

DAMPING_RATIOS = (0.05, 0.10, 0.20)
SCALES = (1.0, 2.0, 3.0, 4.0)


def main() -> None:
    """Run the study and write its table."""
    parser = argparse.ArgumentParser(description=str(__doc__).partition("\n")[0])
    parser.add_argument("--folder", default=".", help="where the results are written")
    folder = Path(parser.parse_args().folder)
    folder.mkdir(parents=True, exist_ok=True)

    block = rf.Block(width="1.2 m", height="6 m", mass="20 t")
    motion = rf.GroundMotion.stochastic(7.2, "5 km", seed=0, stress_drop="20 MPa")
    rows = []
    for damping_ratio in DAMPING_RATIOS:
        pads = rf.TwoSpringSupport(frequency_ratio=20, damping_ratio=damping_ratio)
        tower = rf.System(block, pads)
        runs = [
            tower.simulate(motion.scaled(scale), free_vibration="20 s", outputs=None)
            for scale in SCALES
        ]
        rows.append(rf.concat(runs, "scale", SCALES))
    study = rf.concat(rows, "damping_ratio", DAMPING_RATIOS)

    table = rf.table(study)
    print("Peak rotation over the overturning angle (1: overturned):")
    print(table["peak_relative_rotation"].unstack("scale").round(3))
    print(f"{table.overturned.sum()} of {len(table)} runs overturned.")
    table.to_csv(folder / "study.csv")
    study.to_netcdf(folder / "study.nc")
    print(f"Table: {folder / 'study.csv'}, dataset: {folder / 'study.nc'}")


if __name__ == "__main__":
    main()
