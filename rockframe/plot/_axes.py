"""Shared by all figures: labels with units, colours, a light grid.

The colours have the hues of Okabe and Ito, which people with any colour vision can distinguish.
Their lightness differs too, so that they differ in print without colours. The first ones are
legible on white and on black. Text and axes have the colours of matplotlib's style.
"""

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final

import numpy as np
import xarray as xr

from rockframe.studies.intensities import PERIOD_ATTRIBUTE, measure_words
from rockframe.units import ANGLE, LENGTH, Measure
from rockframe.units.display import DisplayUnit as DisplayUnit
from rockframe.units.display import DisplayUnits, display_unit, display_units

if TYPE_CHECKING:
    from matplotlib.axes import Axes


BLUE: Final = "#00598b"
VERMILLION: Final = "#d45e00"
GREEN: Final = "#007a59"
PURPLE: Final = "#cd7da9"
ORANGE: Final = "#e69f00"
SKY: Final = "#8cccf0"
COLOURS: Final = (BLUE, VERMILLION, GREEN, PURPLE, ORANGE, SKY)
STYLES: Final[tuple[Any, ...]] = ("-", "--", "-.", (0, (1, 1)))
"""Dashes of lines that are compared, so that they differ without colours too."""
PALE_BLUE: Final = "#dfe7ef"
PEAK_CAP: Final = 1.0
"""Peaks over the overturning angle above this are drawn at this value."""
_MIN_TICKS: Final = 3
"""Least number of labels of an axis."""
_EMPTY_LIMITS: Final = (1.0, 10.0)
"""Ends of a logarithmic axis without data."""
_WIDE_RATIO: Final = 200.0
"""Ratio of the ends of an axis above which only powers of ten have room as labels."""
GREY: Final = "0.5"
"""Colour of the background of a figure's data, legible on white and on black."""


_LETTER_WIDTH, LINE_HEIGHT, _HANDLE_WIDTH = 0.07, 0.19, 0.55
"""Sizes of a legend in small letters: width of a letter, height of a line, and width of the handle
before the words [in]."""


_MAX_LABEL_LENGTH: Final = 52
"""Of names in legends."""
_MIN_LABEL_LENGTH: Final = 12
_MAX_FULL_LABELS: Final = 4
"""Number of labels up to which all are written in full."""


def add_legend(axes: "Axes", entries: tuple[Any, Any] | None = None, **style: Any) -> None:
    """Write a legend above the data, and extend the axis to make room for it."""
    handles, words = axes.get_legend_handles_labels() if entries is None else entries
    if not words:
        return
    width, height = np.divide(axes.get_window_extent().size, axes.figure.dpi)
    if len(words) > _MAX_FULL_LABELS and "title" not in style:
        common, words = split_common_parts(words)
        style |= {"title": common, "title_fontsize": "small"} if common else {}
    title = str(style.get("title", ""))
    length = int((0.95 * width - _HANDLE_WIDTH) / _LETTER_WIDTH)
    words = [
        word if "$" in word else as_label(word, max(length, _MIN_LABEL_LENGTH)) for word in words
    ]
    entry = _HANDLE_WIDTH + _LETTER_WIDTH * max(map(len, words))
    columns = int(np.clip((0.95 * width) // entry, 1, max(1, len(words))))
    handles, words = fitting_entries(
        handles, words, columns * int((0.95 * height - 0.1) / LINE_HEIGHT)
    )
    rows = -(-len(words) // columns) + bool(title)
    legend_share = min(0.6, (0.08 + LINE_HEIGHT * rows) / height)
    linear = axes.get_yscale() == "linear"
    low, top = axes.get_ylim()
    # data beyond the end of the axis stay outside
    high = min(top, axes.dataLim.y1 + (0.05 * axes.dataLim.height if linear else 0.0))
    if linear and high > low:
        axes.set_ylim(low, low + (high - low) / (1.0 - legend_share))
    elif high > low > 0.0:
        axes.set_ylim(low, low * (1.05 * high / low) ** (1.0 / (1.0 - legend_share)))
    axes.legend(
        handles, words, loc="upper right", ncols=columns, fontsize="small",
        frameon=True, edgecolor="none", borderaxespad=0.2, handlelength=1.8, columnspacing=1.2,
        **style,
    )  # fmt: skip


def fitting_entries(
    handles: Sequence[Any], words: Sequence[str], most: int
) -> tuple[list[Any], list[str]]:
    """Return the entries of a legend; of more than fit the first ones and the number of others."""
    if len(words) <= most:
        return list(handles), list(words)
    from matplotlib.lines import Line2D

    shown = max(most - 1, 1)
    others = f"and {len(words) - shown} more"
    return [*handles[:shown], Line2D([], [], linestyle="none")], [*words[:shown], others]


def split_common_parts(words: list[str]) -> tuple[str, list[str]]:
    """Split labels at commas into the parts that they have in common, and the other parts."""
    parts = [word.split(", ") for word in words]
    common = [part for part in parts[0] if all(part in label_parts for label_parts in parts)]
    remainders = [
        ", ".join(part for part in label_parts if part not in common) for label_parts in parts
    ]
    return (", ".join(common), remainders) if all(remainders) else ("", words)


def escape_mathtext(text: str) -> str:
    """Return a text so that matplotlib writes it letter by letter."""
    return text.replace("$", r"\$")


def as_label(name: str, max_length: int = _MAX_LABEL_LENGTH) -> str:
    """Return a name as matplotlib writes it letter by letter; a long one without its middle."""
    if len(name) > max_length:
        name = f"{name[: max_length - max_length // 3 - 3]}...{name[-(max_length // 3) :]}"
    # legends omit names that begin with an underscore
    return escape_mathtext(f" {name}" if name.startswith("_") else name)


def unique_labels(names: Iterable[str], max_length: int = _MAX_LABEL_LENGTH) -> list[str]:
    """Return names as :func:`as_label` does, numbered if they would be equal."""
    labels = [as_label(name, max_length) for name in names]
    has_duplicates = len(set(labels)) < len(labels)
    return [f"{k}: {label}" for k, label in enumerate(labels, 1)] if has_duplicates else labels


def text_colour() -> Any:
    """Return the colour of text in matplotlib's style."""
    from matplotlib import rcParams

    return rcParams["text.color"]


def line_colour(number: int) -> str:
    """Return the colour of a line by its number."""
    return COLOURS[number % len(COLOURS)]


def line_style(number: int) -> Any:
    """Return the dashes of a line by its number."""
    return STYLES[number % len(STYLES)]


def variable_label(values: xr.DataArray) -> str:
    """Return the name and unit of values, for an axis."""
    return axis_label(str(values.name).replace("_", " "), str(values.attrs.get("units", "1")))


def value_label(value: xr.DataArray) -> str:
    """Return a value along an axis with its unit, for a legend."""
    unit = str(value.attrs.get("units", "1"))
    text = f"{value.item():.4g}" if value.dtype.kind == "f" else as_label(str(value.item()))
    return text if unit == "1" else f"{text} {superscript_powers(unit)}"


def intensity_label(values: xr.DataArray, study: xr.Dataset) -> str:
    """Return the name, period and unit of an intensity measure of a study, for an axis."""
    words = measure_words(str(values.name), study.attrs.get(PERIOD_ATTRIBUTE))
    return axis_label(words, str(values.attrs.get("units", "1")))


def limit_state_label(state: xr.Dataset) -> str:
    """Return the name of the limit state of a dataset, for a legend."""
    if "limit_state" not in state.coords:
        return "counted"
    return as_label(str(state["limit_state"].item()))


def axis_label(words: str, unit: str) -> str:
    """Append a unit to words, for an axis."""
    blank = "" if words.endswith("\n") else " "
    return f"{words}{blank}[{'-' if unit == '1' else superscript_powers(unit)}]"


def superscript_powers(unit: str) -> str:
    """Write the powers of a unit as superscripts of mathtext."""
    return re.sub(r"\^(-?\d+)", r"$^{\1}$", unit)


def grid(axes: "Axes") -> None:
    """Draw a light grid behind the data."""
    axes.grid(visible=True, which="major", color=GREY, alpha=0.25, linewidth=0.6)
    axes.set_axisbelow(True)


def zero_line(axes: "Axes") -> None:
    """Draw a thin line at zero behind the data."""
    axes.axhline(0.0, color=GREY, alpha=0.6, linewidth=0.5, zorder=0)


def label_log_ticks(axes: "Axes", which: str = "xy") -> None:
    """Label logarithmic axes at powers of ten; short ones at more numbers, at least three."""
    from matplotlib.ticker import FuncFormatter, LogLocator, MaxNLocator, NullLocator

    scales = (("x", axes.xaxis, axes.get_xscale()), ("y", axes.yaxis, axes.get_yscale()))
    for name, axis, scale in scales:
        if scale == "log" and name in which:
            low, high = axis.get_view_interval()
            if not low > 0.0:  # nothing is drawn, such as the intensities of what never overturns
                low, high = _EMPTY_LIMITS
                axis.set_view_interval(low, high, ignore=True)
            choices = ((1.0,), (1.0, 2.0, 5.0), tuple(range(1, 10)), ())
            for subs in choices if high > _WIDE_RATIO * low else choices[1:]:
                locator = LogLocator(subs=subs) if subs else MaxNLocator(5)
                axis.set_major_locator(locator)
                ticks = np.asarray(locator.tick_values(low, high))
                if np.count_nonzero((ticks >= low) & (ticks <= high)) >= _MIN_TICKS:
                    break
            axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
            axis.set_minor_locator(NullLocator())


METRES: Final = DisplayUnit(str(LENGTH.unit), 1.0)


def set_length_unit(axes: "Axes", length: DisplayUnit) -> None:
    """Label axes drawn in metres in another unit of length."""
    from matplotlib.ticker import FuncFormatter, MaxNLocator

    class Places(MaxNLocator):
        """Ticks at round numbers in the unit."""

        def tick_values(self, vmin: float, vmax: float) -> Any:
            ticks = super().tick_values(vmin / length.size, vmax / length.size)
            return length.size * np.asarray(ticks)

    if length.size != 1.0:
        for axis in (axes.xaxis, axes.yaxis):
            axis.set_major_locator(Places("auto", steps=[1, 2, 2.5, 5, 10]))
            axis.set_major_formatter(FuncFormatter(lambda place, _: f"{place / length.size:.6g}"))
    axes.set(xlabel=f"[{length.words}]", ylabel=f"[{length.words}]")


@dataclass(frozen=True)
class FigureUnits:
    """Units of a figure's axes: by the axis's own argument, else by `units`, else the default."""

    owner: str
    reader: DisplayUnits

    def axis_unit(self, measure: Measure, default: str = "", **values: object) -> DisplayUnit:
        """Return the unit of an axis; `values` has the axis's own argument by its name."""
        for name, unit in values.items():
            if unit is not None:
                return display_unit(unit, measure, owner=self.owner, name=name)
        default = default or str(measure.unit)
        return self.reader.chosen_unit(measure) or display_unit(
            default, measure, owner=self.owner, name=""
        )

    def unit_or_relative(self, measure: Measure, **items: object) -> DisplayUnit | None:
        """Return the unit of an axis; None where values are relative to a scale of the body."""
        (unit,) = items.values()
        if unit is None and self.reader.chosen_unit(measure) is None:
            return None
        is_relative = isinstance(unit, str) and unit == "relative"
        return None if is_relative else self.axis_unit(measure, "", **items)

    def rotation_unit(self, rotation: str | None) -> str | None:
        """Return the unit of a history of rotations: the given one, that of `units`, or degrees."""
        return "deg" if rotation is None and self.reader.chosen_unit(ANGLE) is None else rotation


def figure_units(units: object, function: str) -> FigureUnits:
    """Read the units of a figure."""
    owner = f"rf.plot.{function}"
    return FigureUnits(owner, display_units(units, owner=owner))
