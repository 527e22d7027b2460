"""``rockframe report``: a page on a run or a study."""

import argparse
from collections.abc import Iterable
from pathlib import Path

import xarray as xr

from rockframe.command.answer import Answer
from rockframe.command.shared import Outputs, read_result
from rockframe.command.streams import INPUT, STREAM
from rockframe.errors import ComponentError, FileError
from rockframe.motion import GroundMotion
from rockframe.reports import report
from rockframe.studies import case, open_study


def execute(arguments: argparse.Namespace, answer: Answer) -> int:
    """Write the page."""
    path = arguments.output
    if path is None and arguments.dataset == STREAM:
        words = "a result from the standard input has no name; name the report with -o report.html"
        raise FileError(INPUT, [(None, words)])
    folder = Path(arguments.dataset).expanduser().is_dir()
    dataset = open_study(arguments.dataset) if folder else read_result(arguments.dataset)
    if path is None:
        path = str(Path(arguments.dataset).with_suffix(".html"))
    if arguments.case is not None:
        dataset = _case_of(dataset, arguments)
    outputs = Outputs(arguments, [arguments.dataset], answer)
    outputs.written_by(path, ".html", "Report", lambda place: _write(dataset, place, arguments))
    return 0


def _write(dataset: xr.Dataset, place: Path, arguments: argparse.Namespace) -> None:
    motion = None if arguments.motion is None else GroundMotion.read(arguments.motion)
    report(
        dataset,
        place,
        title=arguments.title,
        units=_pairs(arguments.units or (), "--units", "force=kN"),
        motion=motion,
        certify=not arguments.no_certificate,
        overwrite=arguments.overwrite,
    )


def _pairs(words: Iterable[str], option: str, example: str) -> dict[str, str] | None:
    """Read NAME=VALUE; None where there is none."""
    found = [word.partition("=") for word in words]
    for name, _, value in found:
        if not (name and value):
            msg = f"{option}: expected NAME=VALUE, such as {example}, got {name!r}"
            raise ComponentError(msg)
    return {name: value for name, _, value in found} or None


def _case_of(dataset: xr.Dataset, arguments: argparse.Namespace) -> xr.Dataset:
    """Simulate the case of a study that is asked for."""
    pairs = [word.partition("=") for word in arguments.case or ()]
    if "axes_json" not in dataset.attrs or not all(name and value for name, _, value in pairs):
        words = f"found --case {' '.join(arguments.case)}; expected NAME=VALUE, of a study's axes"
        raise FileError(arguments.dataset, [(None, words)])
    found = case(dataset, **{name: value for name, _, value in pairs})
    again = found.simulate()
    again.encoding["source"] = str(Path(arguments.dataset).expanduser())
    return again
