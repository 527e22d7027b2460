"""``rockframe report``: a page on a run."""

import argparse
from pathlib import Path

import xarray as xr

from rockframe.command.shared import read_result
from rockframe.errors import FileError
from rockframe.reports import report
from rockframe.studies import case


def execute(arguments: argparse.Namespace) -> int:
    """Write the page."""
    dataset = read_result(arguments.dataset)
    if "axes_json" in dataset.attrs or arguments.case is not None:
        dataset = _case_of(dataset, arguments)
    path = arguments.output
    if path is None:
        path = str(Path(arguments.dataset).with_suffix(".html"))
    asked = {"certify": not arguments.no_certificate, "overwrite": arguments.overwrite}
    report(dataset, path, title=arguments.title, **asked)
    print(f"Report: {path}")
    return 0


def _case_of(dataset: xr.Dataset, arguments: argparse.Namespace) -> xr.Dataset:
    """Simulate the case of a study that is asked for."""
    axes = ", ".join(
        f"{name} ({size})" for name, size in dataset.sizes.items() if name != "message"
    )
    pairs = [word.partition("=") for word in arguments.case or ()]
    if "axes_json" not in dataset.attrs or not all(name and value for name, _, value in pairs):
        words = f"found --case {' '.join(arguments.case)}; expected NAME=VALUE, of a study's axes"
        raise FileError(arguments.dataset, [(None, words)])
    if not pairs and any(size > 1 for size in dataset.sizes.values()):
        words = (
            f"found a study over {axes}; expected one of its cases, as in --case scale=2. "
            f"'rockframe plot {arguments.dataset} -o study.png' draws all of them"
        )
        raise FileError(arguments.dataset, [(None, words)])
    found = case(dataset, **{name: value for name, _, value in pairs})
    again = found.simulate()
    again.encoding["source"] = str(Path(arguments.dataset).expanduser())
    return again
