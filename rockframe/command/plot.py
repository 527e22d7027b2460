"""``rockframe plot``: the figure of a result."""

import argparse
from io import BytesIO
from pathlib import Path
from typing import Any, Final

import xarray as xr

from rockframe import plot
from rockframe.command.answer import Answer
from rockframe.command.run import finished
from rockframe.command.shared import Outputs, check_format, read_result
from rockframe.command.streams import STREAM
from rockframe.command.typed_calls import values_by_name
from rockframe.errors import ComponentError, FileError
from rockframe.plot._checks import drawn_by
from rockframe.reports.page import close, figure_of
from rockframe.version import __version__
from rockframe.writing import FileKind

_MARK: Final = "figure by rockframe "
_MOST_AXES: Final = 2
"""Largest number of axes of a study that a figure shows."""
_SIGNED: Final = {
    # ending: the entry of its metadata for the name of the program
    ".png": "Software",
    ".svg": "Creator",
    ".pdf": "Creator",
}
PICTURE: Final = FileKind.marked("a picture", tuple(_SIGNED), _MARK)


def execute(arguments: argparse.Namespace, answer: Answer) -> int:
    """Draw the result in a file."""
    check_format(arguments)
    outputs = Outputs(arguments, [arguments.dataset], answer, output=PICTURE)
    dataset = read_result(arguments.dataset)
    name = drawn_by(dataset)
    named: dict[str, Any] = {} if arguments.title is None else {"title": arguments.title}
    if arguments.units:
        named["units"] = values_by_name(arguments.units, "--units", "force=kN")
    if arguments.panels:
        if name != plot.response.__name__:
            msg = "--panels: only a run over time has panels to choose from"
            raise ComponentError(msg)
        named["panels"] = tuple(arguments.panels)
    if name == plot.sweep.__name__ and "status" in dataset and dataset["status"].ndim > _MOST_AXES:
        axes = ", ".join(str(dim) for dim in dataset["status"].dims)
        words = (
            f"found a study with more than {_MOST_AXES} axes ({axes}), which "
            "no figure shows; 'rockframe report' lists its cases in a table"
        )
        raise FileError(arguments.dataset, words)
    save(getattr(plot, name)(dataset, **named), arguments.output, outputs, arguments.format)
    return 0


def concluded(
    dataset: xr.Dataset,
    arguments: argparse.Namespace,
    answer: Answer,
    outputs: Outputs,
    runs: xr.Dataset | None = None,
) -> int:
    """Tell the numbers of an analysis, write its result and its picture, and give the exit code.

    `runs` are those that it is of, unless it has their status itself.
    """
    answer.numbers(dataset)
    outputs.result(dataset)
    if arguments.picture is not None:
        save(getattr(plot, drawn_by(dataset))(dataset), arguments.picture, outputs)
    return 0 if finished(dataset if runs is None else runs) else 1


def save(drawn: Any, path: str | Path, outputs: Outputs, of_stream: str | None = None) -> None:
    """Write a figure to a file, or to the standard output in the format `of_stream`."""
    figure = figure_of(drawn)
    kind = f".{of_stream or 'png'}" if str(path) == STREAM else Path(path).suffix.lower()
    written = BytesIO()
    try:
        signed = {_SIGNED[kind]: f"{_MARK}{__version__}"}
        figure.savefig(written, format=kind.removeprefix("."), dpi=150, metadata=signed)
    except ValueError as problem:  # a formula in the title cannot be read
        words = "found a title that cannot be drawn; expected one whose '$' enclose formulas"
        msg = f"{path}: {words} ({problem})"
        raise ComponentError(msg) from problem
    finally:
        close(figure)
    outputs.write(path, PICTURE, "Figure", written.getvalue())
