"""Figures of the shake-table tests, drawn from numbers that are kept in ``docs/data``."""

import json
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

DATA = Path(__file__).parents[1] / "data" / "granite.json"
INK, OTHER = "#1f3a5f", "#cc6677"


def granite_fit() -> Figure:
    """Draw how well blocks of all sizes and restitutions explain the outcomes."""
    data = json.loads(DATA.read_text())
    radii, restitutions = np.array(data["pairs"]).T
    figure = Figure(figsize=(9.0, 3.6), layout="constrained")
    grid = figure.subplots(1, 2, sharey=True)
    dots = None
    for axes, (specimen, found) in zip(grid, data["specimens"].items(), strict=True):
        losses = np.array(found["log_loss_of_pairs"])
        order = np.argsort(-losses)
        dots = axes.scatter(
            radii[order], restitutions[order], c=losses[order],
            s=36, cmap="viridis_r", vmin=0.15, vmax=0.45,
        )  # fmt: skip
        drawn = np.array(found["ensemble"])
        axes.plot(drawn[:, 0], drawn[:, 2], "o", ms=10, mfc="none", mec=OTHER, mew=1.1)
        axes.set(xscale="log", xlabel="$R_0$ [m]")
        ticks = (0.1, 0.2, 0.4, 0.8)
        axes.set_xticks(ticks, [f"{tick:g}" for tick in ticks])
        axes.minorticks_off()
        axes.set_title(f"specimen {specimen}", fontsize="medium")
    grid[0].set_ylabel(r"restitution $\varepsilon$")
    figure.colorbar(dots, ax=grid, label="log-loss, all tests", extend="max")
    return figure


def granite_calibration() -> Figure:
    """Draw observed over predicted shares of tests held out."""
    data = json.loads(DATA.read_text())
    figure = Figure(figsize=(9.0, 4.0), layout="constrained")
    grid = figure.subplots(1, 2, sharey=True)
    for axes, (name, title, colour) in zip(
        grid,
        (("ensemble", "ensembles of 50 blocks", INK), ("regressed", "regression", OTHER)),
        strict=True,
    ):
        bins = data[name]
        predicted = np.array([one["predicted"] for one in bins])
        observed = np.array([one["observed"] for one in bins])
        below = observed - [one["low"] for one in bins]
        above = np.array([one["high"] for one in bins]) - observed
        axes.plot([0.0, 1.0], [0.0, 1.0], "--", lw=0.9, color="0.6")
        axes.errorbar(
            predicted, observed, (below, above), fmt="o-", ms=4.5, lw=1.3, capsize=3, color=colour
        )
        for one, high in zip(bins, above + observed, strict=True):
            axes.annotate(
                f"{one['tests']}", (one["predicted"], high), (0, 3),
                textcoords="offset points", ha="center", fontsize="small", color="0.35",
            )  # fmt: skip
        axes.set(xlim=(-0.04, 1.04), ylim=(-0.03, 1.1), xlabel="predicted share")
        axes.set_title(title, fontsize="medium")
        axes.grid(visible=True, lw=0.4, color="0.88")
        axes.set_axisbelow(True)
    grid[0].set_ylabel("share that overturned")
    return figure
