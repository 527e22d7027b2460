"""Time and error: the work-precision diagram and the comparison of models."""

from typing import TYPE_CHECKING, Any, Final

import numpy as np
import xarray as xr

from rockframe.plot._axes import GREY, grid, ink, labels_of_names
from rockframe.plot._checks import drawable, draws
from rockframe.plot._panels import Axes, AxesLike, Panels, sheet
from rockframe.units.display import UnitsLike

if TYPE_CHECKING:
    from matplotlib.lines import Line2D


_LEAST: Final = 1e-14
"""Smaller errors of the integration are rounding, and drawn at this value."""
_TOLD_APART: Final = 1e-6
"""Smaller errors of model and integration are drawn in one band: no model is that accurate."""
_BELOW: Final = 0.1 * _TOLD_APART
_SPREAD: Final = 0.4
"""Height over which the accuracies of a model are spread, over the distance between models."""
_MARKERS: Final = "osD^vP*h"
_SMALL: Final = "small rotations"
_ERROR: Final = "largest error of the rotation{}over its peak [-]"


@draws(
    "a comparison of models",
    "rf.tradeoff(system, motion)",
    ("run_time", "verdict_agrees"),
    ("numerical_history_error", "history_error", "model", "accuracy"),
    ax="two Axes",
    title="scene and motion",
)
def tradeoff(
    dataset: xr.Dataset, *, units: UnitsLike = None, ax: AxesLike = None, title: str | None = None
) -> Panels:
    """Draw a comparison of models and accuracies.

    The left panel shows the error of the integration over the time of a run, with a line for each
    model. The right one shows the error of model and integration together; errors below 1e-6 are
    in one band. Each accuracy has its marker, hollow for small rotations. A cross marks a verdict
    that differs from that of the scene itself.

    Examples
    --------
    >>> import rockframe as rf
    >>> system = rf.System(rf.Block(width="0.8 m", height="4 m", mass="2 t"))
    >>> pulse = rf.GroundMotion.sine_pulse("2.5 m/s^2", "1 Hz")
    >>> found = rf.tradeoff(system, pulse, models="rigid ground", accuracies="standard", repeats=1)
    >>> [axes.get_title() for axes in rf.plot.tradeoff(found)]
    ['integration: low and left is better', 'with that of the model: left is better']
    """
    from matplotlib import colormaps
    from matplotlib.ticker import LogLocator, NullLocator, StrMethodFormatter

    drawable(dataset, "tradeoff", units)
    models = [str(name) for name in dataset["model"].to_numpy()]
    on = sheet(
        ax, "tradeoff", ("integration", "model and integration"),
        (11.0, max(3.4, 2.4 + 0.4 * len(models))),
        lambda figure: figure.subplots(1, 2),
    )  # fmt: skip
    axes = on.panels
    colours = colormaps["viridis"](np.linspace(0.1, 0.8, len(models)))
    for place, (model, colour) in enumerate(zip(models, colours, strict=True)):
        row = dataset.sel(model=model)
        time = 1e3 * row["run_time"].to_numpy()
        error = np.maximum(row["numerical_history_error"].to_numpy(), _LEAST)
        _line(axes[0], time, error, row, colour)
        total = row["history_error"].to_numpy()
        total = np.where(total < _TOLD_APART, _BELOW, total)
        middle = 0.5 * (total.size - 1)
        heights = place + _SPREAD * (middle - np.arange(total.size)) / max(total.size - 1, 1)
        _line(axes[1], total, heights, row, colour)
    for panel in axes:
        panel.set(xscale="log")
        grid(panel)
    axes[0].set(yscale="log", xlabel="time of a run [ms]", ylabel=_ERROR.format("\n"))
    axes[0].set_title("integration: low and left is better")
    axes[0].xaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
    axes[0].xaxis.set_major_formatter(StrMethodFormatter("{x:g}"))
    axes[0].xaxis.set_minor_locator(NullLocator())
    axes[1].set(
        yticks=range(len(models)),
        yticklabels=labels_of_names(models),
        ylim=(-0.7, len(models) - 0.3),
        xlabel=_ERROR.format("\n"),
        title="with that of the model: left is better",
    )
    _mark_below(axes[1], dataset["history_error"].to_numpy())
    keys = _keys(dataset, models)
    on.legend(keys, [str(key.get_label()) for key in keys])
    on.entitle(f"{dataset.attrs.get('scene', '')}: {dataset.attrs.get('motion', '')}", title)
    return on.panels


def _line(axes: Axes, x: Any, y: Any, row: xr.Dataset, colour: Any) -> None:
    axes.plot(x, y, "-", color=colour, lw=1.0)
    face = "white" if _SMALL in str(row["model"].item()) else colour
    agrees = row["verdict_agrees"].to_numpy()
    for k in range(len(x)):
        marker = _MARKERS[k % len(_MARKERS)]
        axes.plot(x[k], y[k], marker, color=colour, mfc=face, ms=7)
        if not agrees[k]:
            axes.plot(x[k], y[k], "x", color=ink(), ms=11)


def _mark_below(axes: Axes, errors: Any) -> None:
    """Set the ends of the axis of errors, and mark the band of the smallest ones."""
    from matplotlib.ticker import LogLocator, NullLocator

    drawn = errors[np.isfinite(errors)]
    right = 2.0 * max(1.0, np.max(drawn, initial=0.0))
    below = bool((drawn < _TOLD_APART).any())
    left = 0.25 * _BELOW if below else _TOLD_APART
    axes.set_xlim(left, right)
    axes.xaxis.set_major_locator(LogLocator(numticks=20))
    axes.xaxis.set_minor_locator(NullLocator())
    if not below:
        return
    axes.axvspan(left, _TOLD_APART, color=GREY, alpha=0.12, zorder=0)
    ticks = [tick for tick in axes.get_xticks() if _TOLD_APART <= tick <= right]
    ticks = ticks[::2]  # the labels of all would overlap
    names = [f"$10^{{{round(np.log10(tick))}}}$" for tick in ticks]
    axes.set_xticks([_BELOW, *ticks], ["below", *names])


def _keys(dataset: xr.Dataset, models: list[str]) -> "list[Line2D]":
    """Return the legend: the accuracies, hollow markers and crosses."""
    from matplotlib.lines import Line2D

    keys = [
        Line2D([], [], marker=_MARKERS[k % len(_MARKERS)], color=GREY, ls="none", label=str(name))
        for k, name in enumerate(dataset["accuracy"].to_numpy())
    ]
    if any(_SMALL in model for model in models):
        style: Any = {"marker": "o", "color": GREY, "mfc": "white", "ls": "none"}
        keys.append(Line2D([], [], **style, label=f"hollow: {_SMALL}"))
    return [*keys, Line2D([], [], marker="x", color=GREY, ls="none", ms=10, label="other verdict")]
