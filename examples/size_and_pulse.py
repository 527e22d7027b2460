"""Which blocks of one shape a pulse overturns: a map over their size and its amplitude.

Usage: python examples/size_and_pulse.py [--sizes 30] [--amplitudes 40] [--store study]
       [--folder results]

Prints how many of the blocks overturned, the least amplitude for some sizes, and one case run
alone; writes size_and_pulse.nc (all runs, labelled) and size_and_pulse.png (the map). With --store
finished runs are kept in that folder, and the same call continues from there.
"""

import argparse
import sys
from pathlib import Path

import numpy as np
import xarray as xr
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure
from matplotlib.patches import Patch

import rockframe as rf

SLENDERNESS = 4.0
COLOURS = {
    "stands": "#e8eef4",
    "overturns without an impact": "#cc6677",
    "overturns after an impact": "#1f3a5f",
}


def main() -> int:
    """Read the arguments and run the study; print errors in one line."""
    parser = argparse.ArgumentParser(description=str(__doc__).partition("\n")[0])
    parser.add_argument("--sizes", type=int, default=30, help="number of sizes")
    parser.add_argument("--amplitudes", type=int, default=40, help="number of amplitudes")
    parser.add_argument("--store", help="folder in which the runs are kept")
    parser.add_argument("--folder", default=".", help="where the results are written")
    arguments = parser.parse_args()
    try:
        folder = Path(arguments.folder)
        folder.mkdir(parents=True, exist_ok=True)
        runs = study(arguments.sizes, arguments.amplitudes, arguments.store)
        print_summary(runs)
        runs.to_netcdf(folder / "size_and_pulse.nc")
        draw(runs).savefig(folder / "size_and_pulse.png", dpi=150)
        print(f"Result: {folder / 'size_and_pulse.nc'}, map: {folder / 'size_and_pulse.png'}")
    except (rf.errors.RockframeError, OSError) as problem:
        print(f"size_and_pulse: {' '.join(str(problem).split())}", file=sys.stderr)
        return 1
    return 0


def rigid_block(radius: str) -> rf.System:
    """Return a block with a half diagonal, on rigid ground."""
    return rf.System(rf.Block.from_size(radius=radius, slenderness=SLENDERNESS, mass="10 t"))


def study(sizes: int, amplitudes: int, store: str | None) -> xr.Dataset:
    """Run all sizes under all amplitudes of one cycle of a sine."""
    return rf.sweep(
        rigid_block,
        rf.GroundMotion.sine_pulse("1 m/s^2", "1 Hz"),
        radius=(np.geomspace(0.5, 20.0, sizes), "m"),
        peak_ground_acceleration=(np.linspace(2.5, 20.0, amplitudes), "m/s^2"),
        free_vibration="20 s",
        overturning="continue",
        accuracy="fast",
        store=store,
    ).isel(motion=0)


def is_toppled(runs: xr.Dataset) -> xr.DataArray:
    """Return which blocks lie flat in the end; a moving ground may right a block again."""
    return runs.status == runs.status.flag_meanings.split().index("toppled")


def print_summary(runs: xr.Dataset) -> None:
    """Print the numbers of blocks, the least amplitudes, and one case."""
    toppled = is_toppled(runs)
    print(runs.attrs["verdict"])
    print(f"{int(toppled.sum())} lie flat in the end. Least amplitude of those, by size:")
    amplitude = runs.peak_ground_acceleration
    least = amplitude.where(toppled).min("peak_ground_acceleration")
    for radius in runs.radius[:: max(1, runs.radius.size // 6)]:
        amplitude_found = least.sel(radius=radius).item()
        words = "none" if np.isnan(amplitude_found) else f"{amplitude_found:.1f} m/s^2"
        print(f"  R = {radius.item():5.2f} m: {words}")
    case = rf.case(
        runs, radius=runs.radius[0].item(), peak_ground_acceleration=amplitude[-1].item()
    )
    print(f"The smallest under the strongest: {case.simulate(outputs=None).attrs['verdict']}")


def draw(runs: xr.Dataset) -> Figure:
    """Draw the map."""
    kind = xr.where(is_toppled(runs), xr.where(runs.impact_count > 0, 2, 1), 0)
    figure = Figure(figsize=(6.4, 4.2), layout="constrained")
    axes = figure.subplots()
    axes.pcolormesh(
        runs.radius,
        runs.peak_ground_acceleration,
        kind.transpose("peak_ground_acceleration", "radius"),
        cmap=ListedColormap(list(COLOURS.values())),
        vmin=0,
        vmax=2,
        shading="nearest",
    )
    sizes = [0.5, 1, 2, 5, 10, 20]
    axes.set(
        xscale="log",
        xlabel="half diagonal of the block [m]",
        ylabel=r"amplitude of the pulse [m s$^{-2}$]",
        title=f"Blocks of H/B = {SLENDERNESS:g} under one sine of 1 Hz",
    )
    axes.set_xticks(sizes, [f"{size:g}" for size in sizes])
    axes.tick_params(axis="x", which="minor", labelbottom=False)
    patches = [Patch(color=colour, label=words) for words, colour in COLOURS.items()]
    figure.legend(handles=patches, loc="outside lower center", ncols=len(patches), frameon=False)
    return figure


if __name__ == "__main__":
    sys.exit(main())
