"""Acceleration, velocity and displacement of the ground along time."""

from typing import TYPE_CHECKING, Any, Final

import numpy as np
import xarray as xr

from rockframe.plot._axes import BLUE, GREEN, GREY, axis_label, ink, zero_line
from rockframe.plot._motions import columns_of, drawn_motions, motions_title
from rockframe.plot._panels import Panels, sheet
from rockframe.plot._runs import window_of
from rockframe.plot._units import Shown, unit_of
from rockframe.units import ACCELERATION, LENGTH, VELOCITY

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from rockframe.plot._motions import MotionsLike
    from rockframe.plot._panels import AxesLike
    from rockframe.plot._runs import Window

_ROWS: Final = ("acceleration", "velocity", "displacement")


def motion(
    motion: "MotionsLike",
    *,
    window: "Window" = None,
    acceleration: str = "m/s^2",
    velocity: str = "m/s",
    displacement: str = "m",
    ax: "AxesLike" = None,
    title: str | None = None,
) -> "Panels":
    """Draw acceleration, velocity and displacement of the ground along time.

    Parameters
    ----------
    motion : GroundMotion, or sequence or mapping of them
        The motion, or several to compare, of which the horizontal components are drawn. The ground
        starts from rest; nothing is corrected. A vertical component is drawn behind the horizontal
        one.
    window : (str or Quantity or None, str or Quantity or None), optional
        Start and end of what is drawn; all of it unless given [s].
    acceleration, velocity, displacement : str, optional
        Units, such as ``"g_0"``, ``"cm/s"`` and ``"cm"``.
    ax : three Axes, optional
        What is drawn in; a new figure unless given.
    title : str, optional
        Title of the figure; the motion's name unless given.

    Returns
    -------
    Panels
        The three of them. Peaks of what is drawn are marked.

    Raises
    ------
    ComponentError
        Not a ground motion, or not three Axes.
    UnitsError
        A unit of another kind.
    """
    from rockframe.measures import velocity_and_displacement

    given = drawn_motions(motion, "motion")
    cut = window_of(window, "motion")
    units = [
        unit_of(unit, measure, function="motion", name=name)
        for unit, measure, name in zip(
            (acceleration, velocity, displacement),
            (ACCELERATION, VELOCITY, LENGTH),
            _ROWS,
            strict=True,
        )
    ]
    found = [_part(velocity_and_displacement(one.motion), cut) for one in given]
    upwards = None
    if len(given) == 1 and given[0].motion.si.vertical is not None:
        upwards = _part(velocity_and_displacement(given[0].motion, component="vertical"), cut)
    on = sheet(ax, "motion", _ROWS, (7.2, 5.4), lambda figure: figure.subplots(3, 1, sharex=True))
    colours = (ink(), BLUE, GREEN)
    for axes, name, unit, colour in zip(on.panels, _ROWS, units, colours, strict=True):
        if upwards is not None:
            _line(axes, upwards, f"vertical_ground_{name}", unit, GREY, "vertical")
        for one, history in zip(given, found, strict=True):
            single = one.label is None
            label = one.label or "horizontal"
            _line(axes, history, f"ground_{name}", unit, colour if single else one.colour, label,
                  one.style)  # fmt: skip
            if single:
                _mark_peak(axes, history, f"ground_{name}", unit, colour)
        zero_line(axes)
        axes.set_ylabel(axis_label(f"{name}\n", unit.words).replace("\n ", "\n"))
        axes.margins(y=0.15)
        axes.set_xlim(
            min(float(history["time"][0]) for history in found),
            max(float(history["time"][-1]) for history in found),
        )
    if upwards is not None:
        on.axes.legend(loc="upper right", fontsize="small", ncols=2, frameon=False)
    elif len(given) > 1:
        on.legend(*on.axes.get_legend_handles_labels(), ncols=columns_of(given))
    on.panels[-1].set_xlabel("time [s]")
    if on.own is not None:
        on.own.align_ylabels(on.panels)
    on.entitle(motions_title(given), title)
    return on.panels


def _part(history: xr.Dataset, cut: tuple[float, float]) -> xr.Dataset:
    return history.sel(time=slice(*cut)) if np.isfinite(cut).any() else history


def _line(
    axes: "Axes", dataset: xr.Dataset, name: str, unit: Shown, colour: Any, label: str,
    style: Any = "-",
) -> None:  # fmt: skip
    values = unit.of(dataset[name])
    axes.plot(dataset["time"], values, color=colour, linestyle=style, linewidth=0.8, label=label)


def _mark_peak(axes: "Axes", dataset: xr.Dataset, name: str, unit: Shown, colour: Any) -> None:
    values = unit.of(dataset[name])
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
