"""Time and error: the work-precision diagram and the comparison of models."""

from typing import TYPE_CHECKING, Any, Final

import numpy as np
import xarray as xr

from rockframe.motion.display import motion_words
from rockframe.plot._axes import GREY, grid, label_log_ticks, text_colour, unique_labels
from rockframe.plot._checks import draws, figure_data
from rockframe.plot._panels import Axes, AxesLike, Panels, make_sheet
from rockframe.units.display import UnitsLike

if TYPE_CHECKING:
    from matplotlib.lines import Line2D


_MIN_ERROR: Final = 1e-14
"""Smaller errors of the integration are rounding, and drawn at this value."""
_MIN_MODEL_ERROR: Final = 1e-6
"""Smaller errors of model and integration are drawn in one band: no model is that accurate."""
_BAND_POSITION: Final = 0.1 * _MIN_MODEL_ERROR
_SPREAD: Final = 0.4
"""Height over which the accuracies of a model are spread, over the distance between models."""
_MARKERS: Final = "osD^vP*h"
_SMALL_ROTATIONS: Final = "small rotations"
_ERROR_LABEL: Final = "largest error of the rotation\nover its peak [-]"


@draws(
    "a comparison of models",
    "rf.tradeoff(system, motion)",
    ("run_time", "verdict_agrees"),
    ("numerical_history_error", "history_error", "model", "accuracy"),
    along=("accuracy", "model"),
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

    figure_data(dataset, "tradeoff", units)
    models = [str(name) for name in dataset["model"].to_numpy()]
    sheet = make_sheet(
        ax, "tradeoff", ("integration", "model and integration"),
        (11.0, max(3.4, 2.4 + 0.4 * len(models))), ncols=2,
    )  # fmt: skip
    axes = sheet.panels
    colours = colormaps["viridis"](np.linspace(0.1, 0.8, len(models)))
    for place, (model, colour) in enumerate(zip(models, colours, strict=True)):
        row = dataset.sel(model=model)
        time = 1e3 * row["run_time"].to_numpy()
        error = np.maximum(row["numerical_history_error"].to_numpy(), _MIN_ERROR)
        _draw_line(axes[0], time, error, row, colour)
        total = row["history_error"].to_numpy()
        total = np.where(total < _MIN_MODEL_ERROR, _BAND_POSITION, total)
        middle = 0.5 * (total.size - 1)
        heights = place + _SPREAD * (middle - np.arange(total.size)) / max(total.size - 1, 1)
        _draw_line(axes[1], total, heights, row, colour)
    for panel in axes:
        panel.set(xscale="log")
        grid(panel)
    axes[0].set(yscale="log", xlabel="time of a run [ms]", ylabel=_ERROR_LABEL)
    axes[0].set_title("integration: low and left is better")
    label_log_ticks(axes[0], "x")
    axes[1].set(
        yticks=range(len(models)),
        yticklabels=unique_labels(models),
        ylim=(-0.7, len(models) - 0.3),
        xlabel=_ERROR_LABEL,
        title="with that of the model: left is better",
    )
    _mark_small_errors(axes[1], dataset["history_error"].to_numpy())
    keys = _legend_handles(dataset, models)
    sheet.add_legend(keys, [str(key.get_label()) for key in keys])
    sheet.set_title(f"{dataset.attrs.get('scene', '')}: {motion_words(dataset.attrs)}", title)
    return sheet.panels


def _draw_line(axes: Axes, x: Any, y: Any, row: xr.Dataset, colour: Any) -> None:
    axes.plot(x, y, "-", color=colour, lw=1.0)
    face = axes.get_facecolor() if _SMALL_ROTATIONS in str(row["model"].item()) else colour
    agrees = row["verdict_agrees"].to_numpy()
    for k in range(len(x)):
        marker = _MARKERS[k % len(_MARKERS)]
        axes.plot(x[k], y[k], marker, color=colour, mfc=face, ms=7)
        if not agrees[k]:
            axes.plot(x[k], y[k], "x", color=text_colour(), ms=11)


def _mark_small_errors(axes: Axes, errors: Any) -> None:
    """Set the ends of the axis of errors, and mark the band of the smallest ones."""
    from matplotlib.ticker import LogLocator, NullLocator

    drawn = errors[np.isfinite(errors)]
    right = 2.0 * max(1.0, np.max(drawn, initial=0.0))
    any_below = bool((drawn < _MIN_MODEL_ERROR).any())
    left = 0.25 * _BAND_POSITION if any_below else _MIN_MODEL_ERROR
    axes.set_xlim(left, right)
    axes.xaxis.set_major_locator(LogLocator(numticks=20))
    axes.xaxis.set_minor_locator(NullLocator())
    if not any_below:
        return
    axes.axvspan(left, _MIN_MODEL_ERROR, color=GREY, alpha=0.12, zorder=0)
    ticks = [tick for tick in axes.get_xticks() if _MIN_MODEL_ERROR <= tick <= right]
    ticks = ticks[::2]  # the labels of all would overlap
    names = [f"$10^{{{round(np.log10(tick))}}}$" for tick in ticks]
    axes.set_xticks([_BAND_POSITION, *ticks], ["below", *names])


def _legend_handles(dataset: xr.Dataset, models: list[str]) -> "list[Line2D]":
    """Return the legend: the accuracies, hollow markers and crosses."""
    from matplotlib import rcParams
    from matplotlib.lines import Line2D

    keys = [
        Line2D([], [], marker=_MARKERS[k % len(_MARKERS)], color=GREY, ls="none", label=str(name))
        for k, name in enumerate(dataset["accuracy"].to_numpy())
    ]
    if any(_SMALL_ROTATIONS in model for model in models):
        style: Any = {"marker": "o", "color": GREY, "ls": "none", "mfc": rcParams["axes.facecolor"]}
        keys.append(Line2D([], [], **style, label=f"hollow: {_SMALL_ROTATIONS}"))
    return [*keys, Line2D([], [], marker="x", color=GREY, ls="none", ms=10, label="other verdict")]
