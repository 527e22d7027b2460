"""What the scripts of Figs. 7 to 15 share: their runs, their drawing, what the text says of them.

The paper's section 2.4: blocks of one size, 2, 4 and 6 times as high as wide, on pads of one
stiffness and four damping ratios, under one sine of the acceleration of gravity, Eq. (17).
"""

import matplotlib.pyplot as plt
import numpy as np
import xarray as xr
from matplotlib.figure import Figure

import rockframe as rf

SLENDERNESS = (2, 4, 6)
DAMPING_RATIOS = (0.05, 0.10, 0.20, 0.40)
COLOURS = ("#88ccee", "#44aa99", "#332288", "#cc6677")
BROWN = "#8c564b"
PULSE = rf.GroundMotion.sine_pulse("-9.81 m/s^2", "1 Hz")
ROWS = {
    "relative_rotation": r"rotation $\alpha/\theta$",
    "relative_vertical_displacement": r"vertical $y/\delta$",
}


def study(radius: str, frequency_ratio: float) -> xr.Dataset:
    """Run the twelve blocks of a figure."""

    def scene(slenderness: int, damping_ratio: float) -> rf.System:
        return rf.System(
            rf.Block.from_size(radius=radius, slenderness=slenderness, mass="1 t"),
            rf.TwoSpringSupport(frequency_ratio=frequency_ratio, damping_ratio=damping_ratio),
            gravity="9.81 m/s^2",
        )

    runs = rf.sweep(
        scene,
        PULSE,
        slenderness=SLENDERNESS,
        damping_ratio=DAMPING_RATIOS,
        duration="10 s",
        outputs=["rotation", "relative_vertical_displacement"],
        output_step="0.01 s",
        progress=False,
    ).isel(motion=0)
    return runs.assign(relative_rotation=runs.rotation / np.arctan(1.0 / runs.slenderness))


def draw(runs: xr.Dataset) -> Figure:
    """Draw rotation and vertical displacement for each slenderness, as the paper does."""
    figure, grid = plt.subplots(2, 3, figsize=(9.0, 4.8), sharex=True, layout="constrained")
    for column, slenderness in enumerate(SLENDERNESS):
        for colour, damping_ratio in zip(COLOURS, DAMPING_RATIOS, strict=True):
            run = runs.sel(slenderness=slenderness, damping_ratio=damping_ratio)
            for axes, name in zip(grid[:, column], ROWS, strict=True):
                axes.plot(
                    run.time, run[name], color=colour, lw=1.1, label=rf"$\xi={damping_ratio:.2f}$"
                )
                if run.overturned:
                    end = run[name].dropna("time")
                    axes.plot(end.time[-1], end[-1], "x", color=colour, ms=6)
        lifts_at = float(runs.sel(slenderness=slenderness).uplift_angle[0])
        uplift = lifts_at / np.arctan(1.0 / slenderness)
        for side in (-uplift, uplift):
            grid[0, column].axhline(side, color=BROWN, lw=0.8)
        grid[0, column].set(title=f"H/B = {slenderness}", xlim=(0.0, 10.0))
        grid[1, column].set_xlabel("time [s]")
    for axes, label in zip(grid[:, 0], ROWS.values(), strict=True):
        axes.set_ylabel(label)
    handles, labels = grid[0, 0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=4, frameon=False)
    return figure


def tell(runs: xr.Dataset) -> None:
    """Print what became of the blocks, and the statements of the text beside it."""
    print("Peak rotation over the overturning angle, or when the block overturns:")
    print("H/B   " + "".join(f"xi = {ratio:.2f}   " for ratio in DAMPING_RATIOS))
    for slenderness in SLENDERNESS:
        row = runs.sel(slenderness=slenderness)
        cells = (
            f"{time:.2f} s" if fell else f"{peak:.3f}"
            for time, fell, peak in zip(
                row.overturning_time.values,
                row.overturned.values,
                row.peak_relative_rotation.values,
                strict=True,
            )
        )
        print(f"{slenderness:<6}" + "".join(f"{cell:<12}" for cell in cells))
    fallen = runs.overturned.astype(bool)
    standing = runs.peak_relative_rotation.where(~fallen, 1.0).transpose("slenderness", ...)
    times = runs.overturning_time.transpose("slenderness", ...).values
    both = ~np.isnan(times[:-1]) & ~np.isnan(times[1:])
    alike = (fallen.sum("damping_ratio") % len(DAMPING_RATIOS) == 0).values
    sooner = bool((np.diff(times, axis=0)[both] < 0.0).all()) if both.any() else None
    print("\nThe text says                                              here")
    for words, found in (
        ("the relative rotation grows with H/B", bool((np.diff(standing, axis=0) >= 0.0).all())),
        ("overturning comes sooner with H/B", sooner),
        ("whether it overturns does not depend on the damping", bool(alike.all())),
    ):
        print(f"{words:<59}{_verdict(found)}")


def _verdict(found: bool | None) -> str:
    if found is None:
        return "fewer than two ratios H/B overturn"
    return "holds" if found else "does not hold"
