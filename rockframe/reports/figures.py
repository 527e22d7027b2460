"""Figures of what functions of `rockframe.plot` return, and closing them."""

import sys
from typing import TYPE_CHECKING, Any, cast

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def figure_of(drawn: Any) -> "Figure":
    """Give the figure of what was drawn: itself, or that of an axes or of several."""
    while not hasattr(drawn, "savefig"):
        drawn = drawn.figure if hasattr(drawn, "figure") else next(iter(drawn))
    return cast("Figure", drawn)


def close(figure: "Figure") -> None:
    """Close a figure, which pyplot would otherwise keep."""
    pyplot = sys.modules.get("matplotlib.pyplot")
    if pyplot is not None:
        pyplot.close(figure)
