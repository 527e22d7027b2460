"""The panels of figures: those of a new pyplot figure, or given ones."""

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from textwrap import wrap
from typing import TYPE_CHECKING, Any, Final, TypeAlias, cast

import numpy as np

from rockframe.arguments import checked_text
from rockframe.errors import ComponentError, did_you_mean, short_repr
from rockframe.plot._axes import LINE_HEIGHT, add_legend, escape_mathtext, fitting_entries, grid
from rockframe.plot._fonts import add_fallback_fonts
from rockframe.suggestions import suggests_names

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure, SubFigure

    AxesLike: TypeAlias = Axes | Figure | SubFigure | Iterable[Any] | None
else:  # matplotlib is imported when something is drawn, not for type hints
    Axes = AxesLike = Figure = Any


_LETTERS_PER_INCH: Final = 12.0
"""At matplotlib's default size of letters, with a margin of about a fifteenth on both sides."""
_DEFAULT_FONT_SIZE: Final = 10.0


NO_BREAK: Final = "\N{NO-BREAK SPACE}"
_UNIT_FACTOR: Final = (
    r"(?:[kMGmc]?(?:m|N|Pa|J|g|rad|Hz|s)|t|°|%|deg|mm|ft|lbf)(?:\^-?\d+)?(?![\w^])"
)
_NUMBER_WITH_UNIT: Final = re.compile(
    rf"(?<![\w.])-?\d[\d.e+-]*(?: {_UNIT_FACTOR}(?:/{_UNIT_FACTOR})?)+"
)
"""A number with its unit, which lines of a title do not separate."""


def set_figure_title(figure: "Figure | SubFigure", words: str) -> None:
    """Write a title above a figure, in as many lines as it needs."""
    from matplotlib import rcParams

    letters = _LETTERS_PER_INCH * _DEFAULT_FONT_SIZE / float(rcParams["font.size"])
    width = int(letters * figure.bbox.width / figure.get_dpi())
    lines = [
        line.replace(NO_BREAK, " ")
        for given in words.splitlines()
        for line in _broken_lines(given, width)
    ]
    # matplotlib breaks lines that still do not fit, as those of wide letters
    figure.suptitle("\n".join(lines), fontsize="medium", wrap=True)


def _broken_lines(words: str, width: int) -> list[str]:
    """Break lines after semicolons and sentences, and otherwise between words."""
    if len(words) <= width:
        return [words]
    words = _NUMBER_WITH_UNIT.sub(lambda match: match[0].replace(" ", NO_BREAK), words)
    for mark in ("; ", ". "):
        for place in range(width - 1, width // 3, -1):
            if words.startswith(mark, place):
                return [words[: place + 1], *_broken_lines(words[place + 2 :], width)]
    return wrap(words, width)


_HANDLE_LETTERS: Final = 7
_MAX_LEGEND_SHARE: Final = 0.4
"""Largest share of the height of a figure for the legend below it."""


@suggests_names
class Panels(tuple[Any, ...]):
    """The panels of one figure, in the order in which they were drawn.

    A tuple of :class:`matplotlib.axes.Axes`, which can be passed as ``ax=`` to draw something else
    in the same panels.

    Examples
    --------
    >>> import rockframe as rf
    >>> panels = rf.plot.motion(rf.GroundMotion.sine_pulse("2.5 m/s^2", "1 Hz"))
    >>> len(panels), panels.figure is panels[0].figure
    (3, True)
    >>> again = rf.plot.motion(rf.GroundMotion.sine_pulse("2 m/s^2", "2 Hz"), ax=panels)
    >>> again[0] is panels[0]
    True
    """

    __slots__ = ()

    @property
    def figure(self) -> "Figure":
        """The figure to which the panels belong."""
        # the figure of a panel may be a subfigure
        return self[0].figure.figure

    def __repr__(self) -> str:
        titles = (axes.get_ylabel() or axes.get_title() or axes.get_xlabel() for axes in self)
        names = ", ".join(repr(" ".join(title.split())) for title in titles)
        return f"<{len(self)} panels: {names}>"


@dataclass(frozen=True)
class Sheet:
    """Panels to draw in, and their figure if the panels were made here."""

    panels: Panels
    own_figure: "Figure | SubFigure | None"

    @property
    def axes(self) -> "Axes":
        """The panel, or the first of several."""
        return self.panels[0]

    def set_title(self, default: str, title: str | None) -> None:
        """Write the title above a new figure; above given panels only if the caller set one."""
        if title is not None:
            checked_text(title, owner="rf.plot", name="title")
        for axes in self.panels:
            for axis in (axes.xaxis, axes.yaxis):
                axis.label.set_wrap(True)
        if self.own_figure is not None:
            set_figure_title(self.own_figure, title or escape_mathtext(default))
        elif title:
            self.axes.set_title(title, fontsize="medium", wrap=True)
        add_fallback_fonts(self.panels if self.own_figure is None else [self.own_figure])

    def add_legend(
        self, handles: Sequence[Any], labels: Sequence[str], *, columns: int = 12, **style: Any
    ) -> None:
        """Write a legend below a new figure, as wide as it, or above the data of the last panel."""
        if self.own_figure is None or not labels:
            add_legend(self.panels[-1], (handles, labels))
            return
        width, height = np.divide(self.own_figure.bbox.size, self.panels.figure.get_dpi())
        letters = width * _LETTERS_PER_INCH * (1.2 if style.get("fontsize") == "small" else 1.0)
        fitting = int(letters // (_HANDLE_LETTERS + max(map(len, labels))))
        columns = max(1, min(len(labels), columns, fitting))
        rows = int(_MAX_LEGEND_SHARE * height / LINE_HEIGHT)
        entries = fitting_entries(handles, labels, rows * columns)
        style |= {"loc": "outside lower center", "frameon": False, "ncols": columns}
        self.own_figure.legend(*entries, **style)

    def finish(self, default: str, title: str | None) -> "Axes":
        """Draw the grid, the legend of all panels and the title; return the first panel."""
        for axes in self.panels:
            grid(axes)
        self.add_common_legend()
        self.set_title(default, title)
        return self.axes

    def add_common_legend(self) -> None:
        """Write one legend of the labels of all panels."""
        named = {
            label: handle
            for axes in self.panels
            for handle, label in zip(*axes.get_legend_handles_labels(), strict=True)
        }
        self.add_legend(list(named.values()), list(named), fontsize="small")


def make_sheet(
    ax: "AxesLike",
    function: str,
    names: Sequence[str],
    size: tuple[float, float],
    *,
    choice: bool = False,
    **layout: Any,
) -> Sheet:
    """Take the given panels, or make new ones in the given figure or in a new one.

    With `choice`, the function has the argument `panels`, which messages then mention. A new figure
    is one of pyplot, so that a notebook shows it and ``show()`` opens a window. The layout is that
    of :meth:`matplotlib.figure.Figure.subplots`, or a mosaic.
    """
    from matplotlib.figure import FigureBase

    figure: Any = ax
    if ax is None:
        from matplotlib import pyplot

        figure = pyplot.figure(figsize=size, layout="constrained")
    elif len(names) == 1 or not isinstance(ax, FigureBase):
        return Sheet(Panels(_checked_axes(ax, function, names, choice=choice)), None)
    if "mosaic" in layout:
        return Sheet(Panels(figure.subplot_mosaic(**layout).values()), figure)
    return Sheet(Panels(np.ravel(figure.subplots(**layout))), figure)


def chosen_panels(panels: object, known: Iterable[str], function: str) -> tuple[str, ...]:
    """Read the choice of panels of a figure; all unless given."""
    names = list(known)
    if panels is None:
        return tuple(names)
    chosen: list[Any] = list(panels) if isinstance(panels, tuple | list) else [panels]
    wrong = [panel for panel in chosen if not isinstance(panel, str) or panel not in names]
    if wrong or not chosen or len(set(chosen)) < len(chosen):
        invalid = wrong[0] if wrong else panels
        msg = (
            f"rf.plot.{function}: panels are one or more of {', '.join(map(repr, names))}, each "
            f"once, got {short_repr(invalid)}{did_you_mean(invalid, names)}"
        )
        raise ComponentError(msg)
    return tuple(chosen)


def make_single_panel(ax: "AxesLike", function: str, size: tuple[float, float]) -> Sheet:
    """Take the given panel, or make a figure with one; see :func:`make_sheet`."""
    return make_sheet(ax, function, ("the figure",), size)


def _checked_axes(ax: Any, function: str, names: Sequence[str], *, choice: bool) -> "list[Axes]":
    from matplotlib.axes import Axes

    is_sequence = isinstance(ax, Sequence | np.ndarray) and not isinstance(ax, str | Axes)
    panels = list(np.ravel(np.array(ax, dtype=object))) if is_sequence else [ax]
    expected = "one Axes" if len(names) == 1 else f"{len(names)} Axes, for {', '.join(names)}"
    for panel in panels:
        if not isinstance(panel, Axes):
            msg = f"rf.plot.{function}: ax must be {expected}, got {short_repr(panel)}"
            raise ComponentError(msg)
    if len(panels) != len(names):
        msg = f"rf.plot.{function}: ax must be {expected}, got {len(panels)} Axes"
        if choice and len(names) > 1:
            msg += f"; panels={names[0]!r} draws one of them"
        raise ComponentError(msg)
    return cast("list[Axes]", panels)
