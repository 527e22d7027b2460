"""The response along time, laid out as in Figs. 7-15 of the paper."""

from typing import TYPE_CHECKING, Any

import numpy as np
import xarray as xr

from rockframe.plot._contact import draw_contact, draw_contact_legend
from rockframe.plot._given import check_run, overturning_angles
from rockframe.plot._title import set_title

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_UPLIFT_COLOUR = "#8c510a"
_CAP_COLOUR = "#999933"
CONTACTS = {"contact_state": "pads", "soil_contact_state": "soil"}
"""Strips of contact states, and what they are called where there are two."""


def response(dataset: xr.Dataset, *, title: str | None = None) -> "Figure":
    """Draw rotation, vertical displacement and contact states along time.

    Parameters
    ----------
    dataset : xarray.Dataset
        A result with histories.
    title : str, optional
        Title of the figure; the verdict unless given.

    Returns
    -------
    matplotlib.figure.Figure
        Not yet shown nor saved. Where contact changes faster than the figure can show, the
        strip has the mean colour of the states, by their shares of time.

    Raises
    ------
    SchemaError
        Not the result of one run, or of one without histories; the message names the
        function that draws what was given.
    """
    from matplotlib.figure import Figure

    check_run(dataset)
    strips = [name for name in CONTACTS if name in dataset]
    if "rotation_on_cap" not in dataset:
        strips = strips[:1]  # one body: the soil's contact is the only one
    figure = Figure(figsize=(8.0, 7.0 + 0.4 * (len(strips) - 1)), layout="constrained")
    heights = [1.0, 2.0, 2.0, *[0.35] * len(strips)]
    axes: Any = figure.subplots(
        len(heights), 1, sharex=True, gridspec_kw={"height_ratios": heights}
    )
    time = dataset["time"].to_numpy()
    _ground(axes[0], dataset, time)
    _rotation(axes[1], dataset, time)
    _vertical(axes[2], dataset, time)
    for strip, name in zip(axes[3:], strips, strict=True):
        draw_contact(strip, dataset[name], CONTACTS[name] if len(strips) > 1 else "contact")
    draw_contact_legend(axes[-1], dataset[strips[0]])
    axes[-1].set_xlabel("time [s]")
    axes[0].set_xlim(time[0], time[-1])
    set_title(figure, title or str(dataset.attrs.get("verdict", "")))
    return figure


def _ground(axes: "Axes", dataset: xr.Dataset, time: Any) -> None:
    axes.plot(time, dataset["ground_acceleration"], color="0.3", linewidth=0.8)
    if "vertical_ground_acceleration" in dataset:
        vertical = dataset["vertical_ground_acceleration"]
        axes.plot(time, vertical, color="0.65", linewidth=0.6, label="vertical")
        axes.legend(loc="upper right", fontsize="small")
    axes.set_ylabel("ground\n[m s$^{-2}$]")


def _rotation(axes: "Axes", dataset: xr.Dataset, time: Any) -> None:
    left, right = overturning_angles(dataset)
    axes.plot(time, dataset["relative_rotation"], color="#222255", linewidth=1.0, label="block")
    uplift = float(dataset["uplift_angle"])
    if "rotation_on_cap" in dataset:  # the uplift angle is that of the block on the cap
        cap = dataset["cap_rotation"]
        cap = cap / np.where(cap < 0.0, left, right)
        axes.plot(time, cap, color=_CAP_COLOUR, linewidth=0.8, label="cap")
        axes.legend(loc="upper right", fontsize="small")
    elif np.isfinite(uplift) and uplift > 0.0:
        for side, theta in ((-1.0, left), (1.0, right)):
            axes.axhline(
                side * uplift / theta,
                color=_UPLIFT_COLOUR,
                linewidth=0.7,
                label="uplift" if side > 0.0 else None,
            )
        axes.legend(loc="upper right", fontsize="small")
    if bool(dataset["overturned"]):
        axes.axvline(float(dataset["overturning_time"]), color="#cc3311", linestyle=":")
    axes.axhline(0.0, color="0.8", linewidth=0.5, zorder=0)
    axes.set_ylabel(r"rotation $\alpha/\theta$ [-]")


def _vertical(axes: "Axes", dataset: xr.Dataset, time: Any) -> None:
    if "relative_vertical_displacement" in dataset:
        axes.plot(time, dataset["relative_vertical_displacement"], color="#225522", linewidth=1.0)
        stacked = "rotation_on_cap" in dataset  # two settlements, so say which
        whose = "\n($\\delta$ of the pads)" if stacked else ""
        axes.set_ylabel(rf"vertical $y/\delta$ [-]{whose}")
    else:
        axes.plot(time, dataset["vertical_displacement"], color="#225522", linewidth=1.0)
        axes.set_ylabel("vertical $y$ [m]")
    axes.axhline(0.0, color="0.8", linewidth=0.5, zorder=0)
