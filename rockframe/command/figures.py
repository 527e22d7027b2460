"""``rockframe plot`` and ``animate``: the figure of a result, and the animation of a run."""

import argparse
from io import BytesIO
from pathlib import Path
from typing import Any, Final

from rockframe import plot
from rockframe.command.answer import Answer
from rockframe.command.arguments import RUN_OPTIONS
from rockframe.command.files.scenes import SceneDescription
from rockframe.command.runs import is_finished
from rockframe.command.shared import (
    Outputs,
    check_format,
    is_result,
    read_result,
    scene_from,
    simulate_scene,
    typed_options,
)
from rockframe.command.streams import STREAM
from rockframe.command.typed_calls import values_by_name
from rockframe.errors import ComponentError, FileError
from rockframe.plot import Animation, Player, animation, player
from rockframe.plot._animation import FILM_KIND, check_film_program
from rockframe.plot._checks import figure_function_name
from rockframe.plot._player import FILE_KIND as PAGE_KIND
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


def execute_plot(arguments: argparse.Namespace, answer: Answer) -> int:
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


def save_figure(
    drawn: Any, path: str | Path, outputs: Outputs, stream_format: str | None = None
) -> None:
    """Write a figure to a file, or to the standard output in the format `stream_format`."""
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


def execute_animate(arguments: argparse.Namespace, answer: Answer) -> int:
    """Write a run as a page or a film."""
    check_format(arguments)
    path = arguments.output
    ending = f".{arguments.format or 'html'}" if path == STREAM else Path(path).suffix.lower()
    is_page = ending in PAGE_KIND.suffixes
    if is_page and arguments.speed is not None:
        msg = "--speed is for films; a page has a choice of speeds"
        raise ComponentError(msg)
    scene = _scene_to_run(arguments)
    kind = PAGE_KIND if is_page else FILM_KIND
    read = [arguments.dataset] if scene is None else scene.files
    outputs = Outputs(arguments, read, answer, output=kind)
    check_film_program(ending, path)
    run = read_result(arguments.dataset) if scene is None else simulate_scene(scene)
    answer.add_result("Verdict", str(run.attrs.get("verdict", "")))
    options = typed_options(arguments, "window", "magnify", "title")
    moving: Animation | Player = (
        player(run, **options)
        if is_page
        else animation(run, **options, **typed_options(arguments, "speed"))
    )
    try:
        outputs.save_by(
            path, kind, ending, "Page" if is_page else "Film",
            lambda place: moving.save(place, overwrite=arguments.overwrite),
        )  # fmt: skip
    finally:
        if isinstance(moving, Animation):
            moving.close()
    return 0 if scene is None or is_finished(run) else 1


def _scene_to_run(arguments: argparse.Namespace) -> SceneDescription | None:
    """Read a scene; return None where a result is named, which has run."""
    if not is_result(arguments.dataset):
        arguments.scene = arguments.dataset
        return scene_from(arguments)
    typed = [option for option in RUN_OPTIONS if getattr(arguments, option.attribute) is not None]
    if typed:
        words = f"this is a result, which has run; {typed[0].name} goes with a scene"
        raise FileError(arguments.dataset, words)
    return None
