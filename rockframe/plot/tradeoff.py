"""Time against error: the work-precision diagram and the ladder of models."""

from typing import TYPE_CHECKING, Any, Final

import numpy as np
import xarray as xr

from rockframe.errors import SchemaError

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_LEAST: Final = 1e-14
"""Errors below are drawn here: they are rounding."""
_MARKERS: Final = "osD^vP*h"


def tradeoff(dataset: xr.Dataset, *, title: str | None = None) -> "Figure":
    """Draw a comparison of models and accuracies.

    Left, the error of the integration against the time of a run, a line for each model; right,
    the error of model and integration together. Each accuracy has its marker, hollow for
    small rotations; a cross marks a rung whose verdict is not that of the scene itself.

    Parameters
    ----------
    dataset : xarray.Dataset
        Of :func:`rockframe.tradeoff`.
    title : str, optional
        Title of the figure; scene and motion unless given.

    Returns
    -------
    matplotlib.figure.Figure
        Not yet shown nor saved.

    Raises
    ------
    SchemaError
        The dataset is no comparison of rungs.
    """
    from matplotlib import colormaps
    from matplotlib.figure import Figure
    from matplotlib.lines import Line2D

    if "run_time" not in dataset or "numerical_history_error" not in dataset:
        msg = "the dataset holds no rungs to draw; expected one of tradeoff()"
        raise SchemaError(msg)
    models = [str(name) for name in dataset["model"].to_numpy()]
    figure = Figure(figsize=(11.0, 2.6 + 0.4 * len(models)), layout="constrained")
    axes: Any = figure.subplots(1, 2)
    colours = colormaps["viridis"](np.linspace(0.0, 0.85, len(models)))
    for place, (model, colour) in enumerate(zip(models, colours, strict=True)):
        row = dataset.sel(model=model)
        time = 1e3 * row["run_time"].to_numpy()
        error = np.maximum(row["numerical_history_error"].to_numpy(), _LEAST)
        axes[0].plot(time, error, "-", color=colour, lw=1.0)
        _markers(axes[0], time, error, row, colour)
        total = np.maximum(row["history_error"].to_numpy(), _LEAST)
        axes[1].plot(total, np.full(total.size, place), "-", color=colour, lw=1.0)
        _markers(axes[1], total, np.full(total.size, place), row, colour)
    for panel in axes:
        panel.set(xscale="log")
        panel.grid(visible=True, which="major", color="0.9")
    axes[0].set(
        yscale="log",
        xlabel="time of a run [ms]",
        ylabel="largest error of the rotation over its peak [-]",
        title="integration",
    )
    axes[1].set(
        yticks=range(len(models)),
        yticklabels=models,
        ylim=(-0.7, len(models) - 0.3),
        xlabel="largest error of the rotation over its peak [-]",
        title="model and integration",
    )
    for text, colour in zip(axes[1].get_yticklabels(), colours, strict=True):
        text.set_color(colour)
    keys = [
        Line2D([], [], marker=_MARKERS[k % len(_MARKERS)], color="0.3", ls="none", label=str(name))
        for k, name in enumerate(dataset["accuracy"].to_numpy())
    ]
    keys.append(Line2D([], [], marker="x", color="0.3", ls="none", ms=10, label="another verdict"))
    figure.legend(handles=keys, loc="outside lower center", ncols=len(keys), frameon=False)
    words = f"{dataset.attrs.get('scene', '')}: {dataset.attrs.get('motion', '')}"
    figure.suptitle(words if title is None else title)
    return figure


def _markers(axes: "Axes", x: Any, y: Any, row: xr.Dataset, colour: Any) -> None:
    face = "white" if "small" in str(row["model"].item()) else colour
    agrees = row["verdict_agrees"].to_numpy()
    for k in range(len(x)):
        marker = _MARKERS[k % len(_MARKERS)]
        axes.plot(x[k], y[k], marker, color=colour, mfc=face, ms=7)
        if not agrees[k]:
            axes.plot(x[k], y[k], "x", color="black", ms=11)
