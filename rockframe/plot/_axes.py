"""What axes of figures of studies share: labels with units, colours, a light grid."""

from typing import TYPE_CHECKING, Any, Final

import numpy as np
import xarray as xr

if TYPE_CHECKING:
    from matplotlib.axes import Axes

COLOURS: Final = ("#222255", "#ddaa33", "#cc6677", "#117733", "#88ccee", "#aa4499")
STANDS: Final = "#e8eef4"


def label_of(values: xr.DataArray) -> str:
    """Give name and unit of values, for an axis."""
    unit = str(values.attrs.get("units", "1"))
    words = str(values.name).replace("_", " ")
    return f"{words} [{'-' if unit == '1' else _raised(unit)}]"


def grid(axes: "Axes") -> None:
    """Draw a light grid behind what is drawn."""
    axes.grid(visible=True, which="major", color="0.9", linewidth=0.6)
    axes.set_axisbelow(True)


def plain_ticks(axes: "Axes") -> None:
    """Write 1, 2, 5 and their powers of ten beside logarithmic axes."""
    from matplotlib.ticker import FuncFormatter, LogLocator, NullLocator

    for axis, scale in ((axes.xaxis, axes.get_xscale()), (axes.yaxis, axes.get_yscale())):
        if scale == "log":
            axis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
            axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
            axis.set_minor_locator(NullLocator())


def steps_of(along: xr.DataArray) -> Any:
    """Give values for colours from dark to light, one for each label."""
    from matplotlib import colormaps

    return colormaps["viridis"](np.linspace(0.0, 0.85, along.size))


def _raised(unit: str) -> str:
    """Write powers of a unit as powers."""
    parts = [
        f"{name}$^{{{power}}}$" if power else name
        for name, _, power in (word.partition("^") for word in unit.split(" "))
    ]
    return " ".join(parts)
