"""What the scripts of Figs. 19 and 20 share: frames released from 0.10 rad, and their drawing."""

from itertools import product

import matplotlib.pyplot as plt
import numpy as np
import worked_example
import xarray as xr
from matplotlib.figure import Figure

import rockframe as rf

WAYS: dict[tuple[worked_example.Coupling, int], str] = {
    ("coupled", 3): "#cc6677", ("coupled", 12): "#1f3a5f", ("cascade", 9): "0.55",
}  # fmt: skip
NAMES = {"rotation": r"rotation $\alpha$ [rad]", "vertical_displacement": "vertical $y$ [m]"}


def released(
    storeys: int, seconds: int
) -> dict[tuple[int, worked_example.Coupling, int], xr.Dataset]:
    """Release a frame, on three pads, by cascade and coupled on soft and on stiff soil."""
    return {
        (ratio, coupling, soil): worked_example.scene(storeys, ratio, coupling, soil=soil).simulate(
            duration=f"{seconds} s",
            initial=rf.InitialState(rotation="0.1 rad"),
            output_step="0.02 s",
            accuracy="fast",
        )
        for ratio, (coupling, soil) in product(worked_example.FREQUENCY_RATIOS, WAYS)
    }


def second_peak(run: xr.Dataset) -> float:
    """Return the largest rotation after the first passage of the upright position [rad]."""
    rotation = run.rotation.to_numpy()
    return float(np.abs(rotation[np.argmax(rotation < 0.0) :]).max())


def draw(runs: dict[tuple[int, worked_example.Coupling, int], xr.Dataset]) -> Figure:
    """Draw rotation and vertical displacement over time, a column for each of the pads."""
    figure, grid = plt.subplots(
        2, 3, figsize=(9.0, 4.6), sharex=True, sharey="row", layout="constrained"
    )
    for (ratio, coupling, soil), run in runs.items():
        column = worked_example.FREQUENCY_RATIOS.index(ratio)
        cascade = coupling == "cascade"
        label = "cascade, any $k_0$" if cascade else f"coupled, $k_0={soil}$ MPa"
        for axes, name in zip(grid[:, column], NAMES, strict=True):
            axes.plot(
                run.time, run[name], "--" if cascade else "-",
                color=WAYS[coupling, soil], lw=1.0, label=label,
            )  # fmt: skip
            axes.axhline(0.0, color="0.8", lw=0.5, zorder=0)
        grid[0, column].set_title(rf"$\beta={ratio}$", fontsize="medium")
        grid[1, column].set(xlabel="time [s]", xlim=(0.0, float(run.time[-1])))
    for axes, label in zip(grid[:, 0], NAMES.values(), strict=True):
        axes.set_ylabel(label)
    handles, labels = grid[0, 0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=3, frameon=False)
    return figure
