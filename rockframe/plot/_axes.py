"""What the axes of all figures share: labels with units, colours, a light grid.

The colours are those of Okabe and Ito, which people with any colour vision tell apart, in an order
in which the first ones are legible on white and on black. Text and axes have the colours of
matplotlib's style.
"""

import re
from typing import TYPE_CHECKING, Any, Final

import numpy as np
import xarray as xr

from rockframe.studies.intensities import PERIOD_OF, measure_words
from rockframe.units import Measure
from rockframe.units.shown import Shown as Shown
from rockframe.units.shown import shown_unit

if TYPE_CHECKING:
    from matplotlib.axes import Axes


BLUE: Final = "#0072b2"
VERMILLION: Final = "#d55e00"
GREEN: Final = "#009e73"
PURPLE: Final = "#cc79a7"
ORANGE: Final = "#e69f00"
SKY: Final = "#56b4e9"
COLOURS: Final = (BLUE, VERMILLION, GREEN, PURPLE, ORANGE, SKY)
STYLES: Final[tuple[Any, ...]] = ("-", "--", "-.", (0, (1, 1)))
"""Of lines that are compared, so that they are told apart without colours too."""
_SLOW_TO_PLACE: Final = 20_000
"""Samples of lines between which matplotlib looks for a place for long."""
STANDS: Final = "#dfe7ef"
_MANY_DECADES: Final = 200.0
"""End over start of axes that have no room for more than powers of ten."""
GREY: Final = "0.5"
"""Of what stands behind, legible on white and on black."""


def key(axes: "Axes", **style: Any) -> None:
    """Write a legend where it hides least."""
    samples = sum(len(np.atleast_1d(line.get_xdata())) for line in axes.get_lines())
    place = "best" if samples < _SLOW_TO_PLACE else "upper right"
    axes.legend(loc=place, fontsize="small", **style)


def ink() -> Any:
    """Give the colour of text in matplotlib's style."""
    from matplotlib import rcParams

    return rcParams["text.color"]


def colour_of(number: int) -> str:
    """Give the colour of a line by its number."""
    return COLOURS[number % len(COLOURS)]


def style_of(number: int) -> Any:
    """Give the dashes of a line by its number."""
    return STYLES[number % len(STYLES)]


def label_of(values: xr.DataArray) -> str:
    """Give name and unit of values, for an axis."""
    return axis_label(str(values.name).replace("_", " "), str(values.attrs.get("units", "1")))


def label_of_intensity(values: xr.DataArray, study: xr.Dataset) -> str:
    """Give name, period and unit of an intensity measure of a study, for an axis."""
    words = measure_words(str(values.name), study.attrs.get(PERIOD_OF))
    return axis_label(words, str(values.attrs.get("units", "1")))


def axis_label(words: str, unit: str) -> str:
    """Put a unit behind words, for an axis."""
    return f"{words} [{'-' if unit == '1' else powers_in_mathtext(unit)}]"


def powers_in_mathtext(unit: str) -> str:
    """Write powers of a unit as powers."""
    return re.sub(r"\^(-?\d+)", r"$^{\1}$", unit)


def grid(axes: "Axes") -> None:
    """Draw a light grid behind what is drawn."""
    axes.grid(visible=True, which="major", color=GREY, alpha=0.25, linewidth=0.6)
    axes.set_axisbelow(True)


def zero_line(axes: "Axes") -> None:
    """Draw a thin line at zero behind what is drawn."""
    axes.axhline(0.0, color=GREY, alpha=0.6, linewidth=0.5, zorder=0)


def plain_ticks(axes: "Axes", which: str = "xy") -> None:
    """Write powers of ten, and 2 and 5 of them where there is room, beside logarithmic axes."""
    from matplotlib.ticker import FuncFormatter, LogLocator, NullLocator

    both = (("x", axes.xaxis, axes.get_xscale()), ("y", axes.yaxis, axes.get_yscale()))
    for name, axis, scale in both:
        if scale == "log" and name in which:
            low, high = axis.get_view_interval()
            wide = high > _MANY_DECADES * low
            axis.set_major_locator(LogLocator(subs=(1.0,) if wide else (1.0, 2.0, 5.0)))
            axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
            axis.set_minor_locator(NullLocator())


def colour_steps(along: xr.DataArray) -> Any:
    """Give values for colours from dark to light, one for each label."""
    from matplotlib import colormaps

    return colormaps["viridis"](np.linspace(0.1, 0.85, along.size))


RELATIVE: Final = "relative"
"""The word for values that are made relative to a scale of the body."""


def unit_of(given: object, measure: Measure, *, function: str, name: str) -> Shown:
    """Read the unit of an axis."""
    return shown_unit(given, measure, owner=f"rf.plot.{function}", name=name)


def unit_unless_relative(
    given: object, measure: Measure, *, function: str, name: str
) -> Shown | None:
    """Read the unit of an axis; None where values are shown relative to a scale of the body."""
    if isinstance(given, str) and given == RELATIVE:
        return None
    return unit_of(given, measure, function=function, name=name)
