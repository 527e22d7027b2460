"""Unanchored bookcases and filing cabinets: when they overturn, compared with FEMA P-58.

Usage: python examples/office_contents.py [--motions 6] [--store study] [--folder results]

Prints, for the nine unanchored contents of FEMA P-58 whose demand is the peak floor velocity, the
median velocity at which they overturn and that of FEMA P-58; writes office_contents.csv (the
table), office_contents.png (the medians with their bounds) and damage_library.csv (rows for
pelicun). With --store finished runs are kept in that folder.

Sizes and medians are those that pelicun's library of FEMA P-58 gives (components E.20.22.102a to
125a; NHERI SimCenter). There the dispersion is 0.5 for all of them.
"""

import argparse
import sys
from pathlib import Path

import numpy as np
import pandas as pd
import xarray as xr
from matplotlib.figure import Figure

import rockframe as rf

CONTENTS = {
    # component: (what it is, depth [inch], height [inch], median peak floor velocity [m/s])
    "E.20.22.102a": ("bookcase, 2 shelves", 12.625, 29.0, 0.724),
    "E.20.22.103a": ("bookcase, 3 shelves", 12.625, 41.0, 0.493),
    "E.20.22.104a": ("bookcase, 4 shelves", 12.625, 56.0, 0.361),
    "E.20.22.105a": ("bookcase, 5 shelves", 12.625, 71.0, 0.290),
    "E.20.22.106a": ("bookcase, 6 shelves", 12.625, 81.25, 0.251),
    "E.20.22.112a": ("vertical file, 2 drawers", 15.0, 24.0, 1.229),
    "E.20.22.114a": ("vertical file, 4 drawers", 15.0, 52.0, 0.498),
    "E.20.22.124a": ("lateral file, 4 drawers", 18.6, 52.5, 0.688),
    "E.20.22.125a": ("lateral file, 5 drawers", 18.6, 67.75, 0.526),
}
VELOCITY = "peak_ground_velocity"


def main() -> int:
    """Read the arguments and run the analyses; print errors in one line."""
    parser = argparse.ArgumentParser(description=str(__doc__).partition("\n")[0])
    parser.add_argument("--motions", type=int, default=6, help="number of synthetic earthquakes")
    parser.add_argument("--store", help="folder in which the runs are kept")
    parser.add_argument("--folder", default=".", help="where the results are written")
    arguments = parser.parse_args()
    try:
        folder = Path(arguments.folder)
        folder.mkdir(parents=True, exist_ok=True)
        found = fragilities(synthetic_motions(arguments.motions), arguments.store)
        table = comparison_table(found)
        print(table.to_string())
        table.to_csv(folder / "office_contents.csv")
        draw(table).savefig(folder / "office_contents.png", dpi=150)
        rows = [
            rf.export.to_pelicun(one, name, demand="Peak Floor Velocity")
            for name, one in found.items()
        ]
        pd.concat(rows).to_csv(folder / "damage_library.csv")
        print(f"Table: {folder / 'office_contents.csv'}, rows: {folder / 'damage_library.csv'}")
    except (rf.errors.RockframeError, OSError) as problem:
        print(f"office_contents: {' '.join(str(problem).split())}", file=sys.stderr)
        return 1
    return 0


def synthetic_motions(count: int) -> dict[str, rf.GroundMotion]:
    """Draw shallow earthquakes of magnitude 6.5 to 7 at 10 km, all with a peak of 1 m/s."""
    return {
        f"seed {seed}": rf.GroundMotion.stochastic(
            magnitude, "10 km", seed=seed, stress_drop="10 MPa"
        ).scaled(peak_velocity="1 m/s")
        for seed, magnitude in enumerate(np.linspace(6.5, 7.0, count))
    }


def fragilities(motions: dict[str, rf.GroundMotion], store: str | None) -> dict[str, xr.Dataset]:
    """Scale all motions until each of the contents overturns; fit its capacity."""
    found = {}
    for name, (_, depth, height, _) in CONTENTS.items():
        block = rf.Block(width=f"{depth} inch", height=f"{height} inch", mass="100 kg")
        analysis = rf.incremental_dynamic_analysis(
            rf.System(block),
            motions,
            scale=np.geomspace(0.1, 6.4, 19),
            free_vibration="3 s",
            accuracy="fast",
            bracket_width=0.01,
            store=None if store is None else f"{store}/{name}",
        )
        found[name] = rf.fragility(analysis, "PGV", trials="capacities").isel(limit_state=-1)
    return found


def comparison_table(found: dict[str, xr.Dataset]) -> pd.DataFrame:
    """Compare the medians with those of FEMA P-58."""
    rows = {
        name: {
            "what": CONTENTS[name][0],
            "FEMA P-58 [m/s]": CONTENTS[name][3],
            "computed [m/s]": round(one.median_intensity.item(), 3),
            "from [m/s]": round(one.median_intensity_lower_bound.item(), 3),
            "to [m/s]": round(one.median_intensity_upper_bound.item(), 3),
            "ratio": round(one.median_intensity.item() / CONTENTS[name][3], 2),
            "dispersion": round(one.dispersion.item(), 2),
        }
        for name, one in found.items()
    }
    return pd.DataFrame.from_dict(rows, orient="index").rename_axis("component")


def draw(table: pd.DataFrame) -> Figure:
    """Draw both medians, the computed one with its bounds."""
    figure = Figure(figsize=(6.8, 4.0), layout="constrained")
    axes = figure.subplots()
    position = np.arange(len(table))[::-1]
    computed = table["computed [m/s]"]
    errors = [computed - table["from [m/s]"], table["to [m/s]"] - computed]
    axes.errorbar(computed, position, xerr=errors, fmt="o", color="#1f3a5f", label="computed")
    axes.plot(table["FEMA P-58 [m/s]"], position, "D", color="#cc6677", label="FEMA P-58")
    axes.set_yticks(position, table["what"])
    axes.set(xscale="log", xlabel="median peak floor velocity [m s$^{-1}$]")
    ticks = [0.2, 0.3, 0.5, 1.0, 2.0, 3.0]
    axes.set_xticks(ticks, [f"{tick:g}" for tick in ticks])
    axes.tick_params(axis="x", which="minor", labelbottom=False)
    axes.grid(visible=True, which="major", axis="x", color="0.9")
    axes.legend(frameon=False)
    return figure


if __name__ == "__main__":
    sys.exit(main())
