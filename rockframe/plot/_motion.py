"""Acceleration, velocity and displacement of the ground along time."""

from typing import TYPE_CHECKING, Any

import numpy as np
import xarray as xr

from rockframe.plot._given import check_motion
from rockframe.plot._title import set_title

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from rockframe.motion import GroundMotion

_ROWS = (
    ("ground_acceleration", "acceleration\n[m s$^{-2}$]", "#333333"),
    ("ground_velocity", "velocity\n[m s$^{-1}$]", "#222255"),
    ("ground_displacement", "displacement\n[m]", "#225522"),
)
_VERTICAL_COLOUR = "#aaaaaa"


def motion(motion: "GroundMotion", *, title: str | None = None) -> "Figure":
    """Draw acceleration, velocity and displacement of the ground along time.

    Parameters
    ----------
    motion : GroundMotion
        The motion. The ground starts from rest; nothing is corrected. A vertical component
        is drawn behind the horizontal one.
    title : str, optional
        Title of the figure; the motion's name unless given.

    Returns
    -------
    matplotlib.figure.Figure
        Not yet shown nor saved.

    Raises
    ------
    ComponentError
        Not a ground motion.
    """
    from matplotlib.figure import Figure

    from rockframe.measures import velocity_and_displacement

    check_motion(motion, "motion")
    across = velocity_and_displacement(motion)
    upwards = None
    if motion.si.vertical is not None:
        upwards = velocity_and_displacement(motion, component="vertical")
    figure = Figure(figsize=(8.0, 6.0), layout="constrained")
    axes: Any = figure.subplots(3, 1, sharex=True)
    for row, (name, label, colour) in zip(axes, _ROWS, strict=True):
        if upwards is not None:
            _line(row, upwards, f"vertical_{name}", _VERTICAL_COLOUR, "vertical")
        _line(row, across, name, colour, "horizontal")
        _mark_peak(row, across, name, colour)
        row.axhline(0.0, color="0.8", linewidth=0.5, zorder=0)
        row.set_ylabel(label)
        row.margins(y=0.15)
    if upwards is not None:
        axes[0].legend(loc="upper right", fontsize="small", ncols=2, frameon=False)
    time = across["time"].to_numpy()
    axes[0].set_xlim(time[0], time[-1])
    axes[-1].set_xlabel("time [s]")
    figure.align_ylabels(axes)
    set_title(figure, title or motion.name)
    return figure


def _line(axes: "Axes", dataset: xr.Dataset, name: str, colour: str, label: str) -> None:
    axes.plot(dataset["time"], dataset[name], color=colour, linewidth=0.8, label=label)


def _mark_peak(axes: "Axes", dataset: xr.Dataset, name: str, colour: str) -> None:
    values = dataset[name].to_numpy()
    place = int(np.argmax(np.abs(values)))
    time, peak = float(dataset["time"][place]), float(values[place])
    axes.plot([time], [peak], marker="o", markersize=4.0, color=colour)
    late = place > 0.8 * values.size
    axes.annotate(
        f"{abs(peak):.3g}",
        (time, peak),
        xytext=(-6.0 if late else 6.0, 0.0),
        textcoords="offset points",
        ha="right" if late else "left",
        va="bottom" if peak > 0.0 else "top",
        fontsize="small",
        color=colour,
    )
