"""``rockframe plot``: the figure of a result."""

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from rockframe import plot
from rockframe.command.given import check_folder, opened
from rockframe.errors import ComponentError
from rockframe.plot._given import drawn_by
from rockframe.reports.figures import close, figure_of

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def execute(arguments: argparse.Namespace) -> int:
    """Draw what a file holds."""
    check_folder(arguments.output)
    dataset = opened(arguments.dataset)
    function = getattr(plot, drawn_by(dataset))
    named = {} if arguments.title is None else {"title": arguments.title}
    save(figure_of(function(dataset, **named)), arguments.output)
    return 0


def save(figure: "Figure", path: str | Path) -> None:
    """Write a figure, and say so.

    Raises
    ------
    ComponentError
        The ending of the file names no format.
    """
    place = Path(path).expanduser()
    try:
        figure.savefig(place, dpi=150)
    except ValueError as problem:
        msg = f"{path}: {problem}"
        raise ComponentError(msg) from problem
    finally:
        close(figure)
    print(f"Figure: {path}")
