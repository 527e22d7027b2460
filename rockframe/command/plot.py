"""``rockframe plot``: the figure of a result."""

import argparse
from io import BytesIO
from pathlib import Path
from typing import Any, Final

import xarray as xr

from rockframe import plot
from rockframe.command.answer import Answer
from rockframe.command.run import is_finished
from rockframe.command.shared import Outputs, check_format, read_result
from rockframe.command.streams import STREAM
from rockframe.command.typed_calls import values_by_name
from rockframe.errors import ComponentError, FileError
from rockframe.plot._checks import figure_function_name
from rockframe.reports.page import close_figure, figure_of
from rockframe.version import __version__
from rockframe.writing import FileKind

_SIGNATURE: Final = "figure by rockframe "
_MAX_AXES: Final = 2
"""Largest number of axes of a study that a figure shows."""
_METADATA_KEYS: Final = {
    # ending: the entry of its metadata for the name of the program
    ".png": "Software",
    ".svg": "Creator",
    ".pdf": "Creator",
}
PICTURE_KIND: Final = FileKind.marked("a picture", tuple(_METADATA_KEYS), _SIGNATURE)


def execute(arguments: argparse.Namespace, answer: Answer) -> int:
    """Draw the result in a file."""
    check_format(arguments)
    outputs = Outputs(arguments, [arguments.dataset], answer, output=PICTURE_KIND)
    dataset = read_result(arguments.dataset)
    name = figure_function_name(dataset)
    named: dict[str, Any] = {} if arguments.title is None else {"title": arguments.title}
    if arguments.units:
        named["units"] = values_by_name(arguments.units, "--units", "force=kN")
    if arguments.panels:
        if name != plot.response.__name__:
            msg = "--panels: only a run over time has panels to choose from"
            raise ComponentError(msg)
        named["panels"] = tuple(arguments.panels)
    sizes = dataset["status"].sizes if "status" in dataset else {}
    drawn_over = [str(dim) for dim, size in sizes.items() if size > 1]
    if name == plot.sweep.__name__ and len(drawn_over) > _MAX_AXES:
        axes = ", ".join(drawn_over)
        words = (
            f"found a study with more than {_MAX_AXES} axes ({axes}), which "
            "no figure shows; 'rockframe report' lists its cases in a table"
        )
        raise FileError(arguments.dataset, words)
    save_figure(getattr(plot, name)(dataset, **named), arguments.output, outputs, arguments.format)
    return 0


def finish_analysis(
    dataset: xr.Dataset,
    arguments: argparse.Namespace,
    answer: Answer,
    outputs: Outputs,
    runs: xr.Dataset | None = None,
) -> int:
    """Report the numbers of an analysis, write its result and picture, and return the exit code.

    `runs` are those that were analysed, unless `dataset` has their status itself.
    """
    answer.add_numbers(dataset)
    outputs.write_result(dataset)
    if arguments.picture is not None:
        save_figure(
            getattr(plot, figure_function_name(dataset))(dataset), arguments.picture, outputs
        )
    return 0 if is_finished(dataset if runs is None else runs) else 1


def save_figure(
    drawn: Any, path: str | Path, outputs: Outputs, stream_format: str | None = None
) -> None:
    """Write a figure to a file, or to the standard output in the format `of_stream`."""
    figure = figure_of(drawn)
    ending = f".{stream_format or 'png'}" if str(path) == STREAM else Path(path).suffix.lower()
    buffer = BytesIO()
    try:
        metadata = {_METADATA_KEYS[ending]: f"{_SIGNATURE}{__version__}"}
        figure.savefig(buffer, format=ending.removeprefix("."), dpi=150, metadata=metadata)
    except ValueError as problem:  # a formula in the title cannot be read
        words = "found a title that cannot be drawn; expected one whose '$' enclose formulas"
        msg = f"{path}: {words} ({problem})"
        raise ComponentError(msg) from problem
    finally:
        close_figure(figure)
    outputs.write(path, PICTURE_KIND, "Figure", buffer.getvalue())
