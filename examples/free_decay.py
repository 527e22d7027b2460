"""The restitution of a block, from a record of its free rocking after release.

Usage: python examples/free_decay.py [--folder results]

The test is synthetic, of a block whose restitution is known, with the noise and the offset of a
gauge. Writes the record to free_decay.csv like a data logger, reads it back, and fits the
restitution. Prints the result, and writes free_decay.nc (measured and fitted rotation over time,
and the fitted parameters).
"""

import argparse
from pathlib import Path

import numpy as np
import pandas as pd

import rockframe as rf

BLOCK = rf.Block(width="0.3 m", height="1.2 m", mass="200 kg")
RESTITUTION = 0.87
NOISE = 0.03  # deg
OFFSET = 0.12  # deg


def write_test(path: Path) -> None:
    """Write a synthetic test: half a second before the release, then four seconds of rocking."""
    system = rf.System(BLOCK, rf.RigidGround(restitution=RESTITUTION))
    run = system.simulate(
        duration="4 s", initial=rf.InitialState(rotation="7 deg"), output_step="0.01 s"
    )
    rocking = np.degrees(run.rotation.to_numpy())
    rotation = np.concatenate([np.full(50, rocking[0]), rocking]) + OFFSET
    rotation += NOISE * np.random.default_rng(1).normal(size=rotation.size)
    table = pd.DataFrame({"time": 0.01 * np.arange(rotation.size), "rotation": rotation})
    table.round(4).to_csv(path, index=False)


def main() -> None:
    """Write the test, read it back, and fit the restitution."""
    parser = argparse.ArgumentParser(description=str(__doc__).partition("\n")[0])
    parser.add_argument("--folder", default=".", help="where the results are written")
    folder = Path(parser.parse_args().folder)
    folder.mkdir(parents=True, exist_ok=True)
    write_test(folder / "free_decay.csv")

    table = pd.read_csv(folder / "free_decay.csv")
    measured = ((table["time"].to_numpy(), "s"), (table["rotation"].to_numpy(), "deg"))
    found = rf.fit_free_decay(rf.System(BLOCK), measured, "restitution")
    print(found.attrs["verdict"])
    print(f"The record was made with a restitution of {RESTITUTION}.")
    found.to_netcdf(folder / "free_decay.nc")


if __name__ == "__main__":
    main()
