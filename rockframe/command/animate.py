"""``rockframe animate``: an animation of a run."""

import argparse
from pathlib import Path
from typing import Final

import xarray as xr

from rockframe.command.answer import Answer
from rockframe.command.arguments import RUN_OPTIONS
from rockframe.command.run import is_finished
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
from rockframe.errors import ComponentError, FileError
from rockframe.plot import Animation, Player, animation, player

_PAGES: Final = (".html", ".htm")
_FILMS: Final = (".gif", ".mp4")


def execute(arguments: argparse.Namespace, answer: Answer) -> int:
    """Write a run as a page or a film."""
    check_format(arguments)
    path = arguments.output
    ending = f".{arguments.format or 'html'}" if path == STREAM else Path(path).suffix.lower()
    if ending not in (*_PAGES, *_FILMS):
        words = f"that of an animation ends in {' or '.join((_PAGES[0], *_FILMS))}"
        raise FileError(path, f"the name ends in {ending!r}; {words}")
    run = _run_of(arguments, answer)
    outputs = Outputs(arguments, [arguments.dataset], answer)
    options = typed_options(arguments, "window", "magnify", "title")
    if ending in _PAGES and arguments.speed is not None:
        msg = "--speed is for films; a page has a choice of speeds"
        raise ComponentError(msg)
    moving: Animation | Player = (
        player(run, **options)
        if ending in _PAGES
        else animation(run, **options, **typed_options(arguments, "speed"))
    )
    try:
        outputs.save_by(
            path, ending, "Page" if ending in _PAGES else "Film",
            lambda place: moving.save(place, overwrite=arguments.overwrite),
        )  # fmt: skip
    finally:
        if isinstance(moving, Animation):
            moving.close()
    return 0 if is_result(arguments.dataset) or is_finished(run) else 1


def _run_of(arguments: argparse.Namespace, answer: Answer) -> xr.Dataset:
    """Read a run, or simulate a scene."""
    if is_result(arguments.dataset):
        typed = [one for one in RUN_OPTIONS if getattr(arguments, one.attribute) is not None]
        if typed:
            words = f"this is a result, which has run; {typed[0].names[-1]} goes with a scene"
            raise FileError(arguments.dataset, words)
        run = read_result(arguments.dataset)
    else:
        arguments.scene = arguments.dataset
        run = simulate_scene(scene_from(arguments))
    answer.add_result("Verdict", str(run.attrs.get("verdict", "")))
    return run
