"""Strips of contact states along time."""

from typing import TYPE_CHECKING, Any, Final

import numpy as np
import xarray as xr

if TYPE_CHECKING:
    from matplotlib.axes import Axes

COLOURS: Final = {"full": "0.85", "left": "#4477aa", "right": "#cc6677", "flight": "#ddcc77"}
"""Of each state, by its name in the schema."""

_COLUMNS: Final = 1 << 14
"""More than a figure has pixels, so that what is narrower than a pixel is averaged twice only."""


def draw_contact(axes: "Axes", state: xr.DataArray, name: str) -> None:
    """Draw which corner bears, in the colour of the state.

    Where states change faster than the figure can show, the colours are mixed by the shares
    of time: bars would show whichever was painted last.
    """
    time = state["time"].to_numpy()
    axes.imshow(
        mixed_colours(state, _COLUMNS)[np.newaxis],
        extent=(time[0], time[-1], 0.0, 1.0),
        aspect="auto",
        interpolation="antialiased",
    )
    axes.set_ylim(0.0, 1.0)
    axes.set_yticks([])
    axes.set_ylabel(name, rotation=0, ha="right", va="center")


def draw_contact_legend(axes: "Axes", state: xr.DataArray) -> None:
    """Name the colours below the strip."""
    from matplotlib.patches import Patch

    names = [name for _, name in _states(state)]
    axes.legend(
        handles=[Patch(facecolor=COLOURS[name], label=name) for name in names],
        loc="upper center", bbox_to_anchor=(0.5, -1.6), ncols=len(names),
        fontsize="small", frameon=False,
    )  # fmt: skip


def mixed_colours(state: xr.DataArray, columns: int) -> Any:
    """Give the mean colour of equal parts of the time."""
    from matplotlib.colors import to_rgb

    time, values = state["time"].to_numpy(), state.to_numpy()
    edges = np.linspace(time[0], time[-1], columns + 1)
    colours = np.zeros((columns, 3))
    for value, name in _states(state):
        held = np.concatenate([[0.0], np.cumsum(np.diff(time) * (values[:-1] == value))])
        share = np.diff(np.interp(edges, time, held)) / np.diff(edges)
        colours += share[:, np.newaxis] * np.array(to_rgb(COLOURS[name]))
    return np.clip(colours, 0.0, 1.0)


def _states(state: xr.DataArray) -> list[tuple[int, str]]:
    meanings = str(state.attrs["flag_meanings"]).split()
    return list(zip(state.attrs["flag_values"], meanings, strict=True))
